// SPDX-License-Identifier: GPL-2.0-or-later
#include "phantom_motion.h"
#include <phantom_platform.h>

#include "motion_probe.h"

static struct phantom_motion motion;
static struct phantom_offset offset;
static struct phantom_pose pose;

void motion_probe_begin(const struct phantom_object* object, uint64_t time_ns)
{
    phantom_motion_init(&motion, object, time_ns);
    memset(&offset, 0, sizeof(offset));
    motion_probe_at(time_ns);
}

bool motion_probe_next(const struct phantom_object* object, uint64_t time_ns, uint64_t now_ns,
                       uint64_t length_ns, const int64_t tip_nm[3])
{
    struct phantom_pose shall;
    s64 tip[3];

    memcpy(tip, tip_nm, sizeof(tip));
    motion_probe_at(now_ns);
    phantom_motion_init(&motion, object, time_ns);
    phantom_motion_at(&motion, NULL, now_ns, &shall);
    return phantom_motion_offset(&pose, &shall, tip, now_ns, length_ns, &offset);
}

void motion_probe_at(uint64_t now_ns)
{
    phantom_motion_at(&motion, &offset, now_ns, &pose);
}

bool motion_probe_enter(const int64_t place_nm[3], int64_t inner_nm[3])
{
    s64 place[3], inner[3] = {0};
    bool fits;

    memcpy(place, place_nm, sizeof(place));
    fits = phantom_pose_enter(&pose, place, inner);
    memcpy(inner_nm, inner, sizeof(inner));
    return fits;
}

void motion_probe_leave(const int64_t inner_nm[3], int64_t place_nm[3])
{
    s64 inner[3], place[3];

    memcpy(inner, inner_nm, sizeof(inner));
    phantom_pose_leave(&pose, inner, place);
    memcpy(place_nm, place, sizeof(place));
}

void motion_probe_velocity(const int64_t place_nm[3], int64_t velocity_nm_s[3])
{
    s64 place[3], velocity[3];

    memcpy(place, place_nm, sizeof(place));
    phantom_motion_velocity(&motion, &pose, place, velocity);
    memcpy(velocity_nm_s, velocity, sizeof(velocity));
}
