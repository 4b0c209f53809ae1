// SPDX-License-Identifier: GPL-2.0-only
/* The float section in float32 for AVX-512 (F, DQ): sixteen patches at a time. The same bits as SSE2. */
#define PHANTOM_LANES 16
#define PHANTOM_SECTION_OPS phantom_float_avx512
#define PHANTOM_SECTION_NAME "avx512"
#define PHANTOM_SECTION_ISA PHANTOM_ISA_AVX512

#include "section.h"
