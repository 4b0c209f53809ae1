// SPDX-License-Identifier: GPL-2.0-or-later
// The float section of AVX2 without a single effect in it: what contact alone is held against.
#define PHANTOM_SECTION_BARE
#define PHANTOM_LANES 8
#define PHANTOM_SECTION_OPS phantom_bare_avx2
#define PHANTOM_SECTION_NAME "avx2 bare"
#define PHANTOM_SECTION_ISA PHANTOM_ISA_AVX2

#include "section.h"
