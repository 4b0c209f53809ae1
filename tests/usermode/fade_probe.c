// SPDX-License-Identifier: GPL-2.0-or-later
#include "phantom_fade.h"
#include <phantom_platform.h>

#include "fade_probe.h"

void fade_probe(const int32_t from[3], const int32_t target[3], const int32_t later[3], uint64_t length_ns,
                uint64_t elapsed_ns, int32_t at_begin[3], int32_t out[3])
{
    const u64 begin_ns = 1000000000;
    struct phantom_fade fade;

    phantom_fade_reset(&fade);
    phantom_fade_blend(&fade, from, begin_ns, out);
    phantom_fade_begin(&fade, target, begin_ns, length_ns);
    phantom_fade_blend(&fade, target, begin_ns, at_begin);
    phantom_fade_blend(&fade, later, begin_ns + elapsed_ns, out);
}
