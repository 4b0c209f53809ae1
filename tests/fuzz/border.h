/* SPDX-License-Identifier: GPL-2.0-or-later */
/*
 * border.h - what a set has to pass before a float section sees it, and where a tip may be then: the
 * module's own functions, below the API that hides them.
 */
#ifndef PHANTOM_FUZZ_BORDER_H
#define PHANTOM_FUZZ_BORDER_H

#include <stdbool.h>
#include <stdint.h>

#include "phantom_abi.h"

#ifdef __cplusplus
extern "C" {
#endif

/* Of an accepted set. */
struct border_set {
    int64_t origin_nm[3];
    int32_t centre_nm[3];
    uint32_t radius_nm; /* as the servo takes it */
    uint32_t reach_nm;
    uint32_t face_count;
    uint32_t rim_count;
    const struct phantom_material* materials; /* as contact has them, until the next check */
    /* NULL: no tables. Until the next check; its tables until the second set that is accepted after it */
    const struct phantom_effects* effects;
};

/* 0, or the negative errno with which SUBMIT_SET refuses it after a set with that id. */
int border_check(const struct phantom_set* set, uint64_t last_id, struct border_set* out);

/* Relative to the set's origin; false where it does not fit. */
bool border_relative(const struct border_set* set, const int64_t position_nm[3], int32_t relative_nm[3]);

/* Is that ball promised to be covered? */
bool border_covers(const struct border_set* set, const int32_t point_nm[3], uint32_t ball_nm);

#ifdef __cplusplus
}
#endif

#endif /* PHANTOM_FUZZ_BORDER_H */
