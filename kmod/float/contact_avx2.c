// SPDX-License-Identifier: GPL-2.0-only
/* The float section in float32 for AVX2: eight patches at a time. The same bits as SSE2. */
#define PHANTOM_LANES 8
#define PHANTOM_SECTION_OPS phantom_float_avx2
#define PHANTOM_SECTION_NAME "avx2"
#define PHANTOM_SECTION_ISA PHANTOM_ISA_AVX2

#include "section.h"
