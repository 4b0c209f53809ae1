// SPDX-License-Identifier: GPL-2.0-only
/* The float section in float32 for SSE2, which every x86-64 has: four patches at a time. */
#define PHANTOM_LANES 4
#define PHANTOM_SECTION_OPS phantom_float_sse2
#define PHANTOM_SECTION_NAME "sse2"
#define PHANTOM_SECTION_ISA PHANTOM_ISA_SSE2

#include "section.h"
