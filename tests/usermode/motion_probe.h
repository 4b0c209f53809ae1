/* SPDX-License-Identifier: GPL-2.0-or-later */
/* motion_probe.h - one moving frame of phantom_motion.h, as sets and ticks use it. nm, ns. */
#ifndef PHANTOM_TEST_MOTION_PROBE_H
#define PHANTOM_TEST_MOTION_PROBE_H

#include <stdbool.h>
#include <stdint.h>

#include "phantom_abi.h"

#ifdef __cplusplus
extern "C" {
#endif

/* The frame is as that object says, at time_ns; it has no offset. */
void motion_probe_begin(const struct phantom_object* object, uint64_t time_ns);
/* At now_ns a set says something else of it. False: it jumps. */
bool motion_probe_next(const struct phantom_object* object, uint64_t time_ns, uint64_t now_ns,
                       uint64_t length_ns, const int64_t tip_nm[3]);
/* Later calls are of this time. */
void motion_probe_at(uint64_t now_ns);
bool motion_probe_enter(const int64_t place_nm[3], int64_t inner_nm[3]);
void motion_probe_leave(const int64_t inner_nm[3], int64_t place_nm[3]);
void motion_probe_velocity(const int64_t place_nm[3], int64_t velocity_nm_s[3]);

#ifdef __cplusplus
}
#endif

#endif /* PHANTOM_TEST_MOTION_PROBE_H */
