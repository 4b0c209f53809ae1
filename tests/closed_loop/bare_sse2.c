// SPDX-License-Identifier: GPL-2.0-or-later
// The float section of SSE2 without a single effect in it: what contact alone is held against.
#define PHANTOM_SECTION_BARE
#define PHANTOM_LANES 4
#define PHANTOM_SECTION_OPS phantom_bare_sse2
#define PHANTOM_SECTION_NAME "sse2 bare"
#define PHANTOM_SECTION_ISA PHANTOM_ISA_SSE2

#include "section.h"
