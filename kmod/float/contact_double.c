// SPDX-License-Identifier: GPL-2.0-only
/* The float section in float64, for reference runs in user mode. Not part of the module. */
#define PHANTOM_REAL_DOUBLE
#define PHANTOM_LANES 2
#define PHANTOM_SECTION_OPS phantom_float_double
#define PHANTOM_SECTION_NAME "double"
#define PHANTOM_SECTION_ISA PHANTOM_ISA_DOUBLE

#include "section.h"
