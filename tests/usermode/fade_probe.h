/* SPDX-License-Identifier: GPL-2.0-or-later */
/* fade_probe.h - one fade of phantom_fade.h: from a force to a target that moves on. All in uN. */
#ifndef PHANTOM_TEST_FADE_PROBE_H
#define PHANTOM_TEST_FADE_PROBE_H

#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

/* What comes out at the begin, with the target `target`, and after elapsed_ns, with `later`. */
void fade_probe(const int32_t from[3], const int32_t target[3], const int32_t later[3], uint64_t length_ns,
                uint64_t elapsed_ns, int32_t at_begin[3], int32_t out[3]);

#ifdef __cplusplus
}
#endif

#endif /* PHANTOM_TEST_FADE_PROBE_H */
