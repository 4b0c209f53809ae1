// SPDX-License-Identifier: GPL-2.0-only
/* The same section in fixed-point integers, compiled without any float register. */
#define PHANTOM_REAL_FIXED
#define PHANTOM_LANES 1
#define PHANTOM_SECTION_OPS phantom_float_fixed
#define PHANTOM_SECTION_NAME "fixed"
#define PHANTOM_SECTION_ISA PHANTOM_ISA_FIXED

#include "section.h"
