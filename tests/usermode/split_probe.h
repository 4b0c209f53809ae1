/* SPDX-License-Identifier: GPL-2.0-or-later */
/* split_probe.h - the patches of a set, frame by frame, as phantom_set_split() leaves them. */
#ifndef PHANTOM_TEST_SPLIT_PROBE_H
#define PHANTOM_TEST_SPLIT_PROBE_H

#include <stdint.h>

#include "phantom_abi.h"

#ifdef __cplusplus
extern "C" {
#endif

struct split_part {
    uint32_t first, patch_count, face_count, rim_count;
};

/* At most PHANTOM_PATCHES_MAX patches without tables, to `out`. 0, or the set is refused. */
int split_probe(const struct phantom_set* set, struct phantom_patch out[],
                struct split_part part[1 + PHANTOM_MOVING_MAX]);

#ifdef __cplusplus
}
#endif

#endif /* PHANTOM_TEST_SPLIT_PROBE_H */
