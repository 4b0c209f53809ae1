// SPDX-License-Identifier: GPL-2.0-or-later
#include <phantom_platform.h>

#include "border.h"
#include "phantom_set.h"

static int border_copy(struct phantom_set_copy* copy)
{
    const struct phantom_set* header = &copy->header;

    if (copy_from_user(copy->materials, u64_to_user_ptr(header->materials),
                       header->material_count * sizeof(copy->materials[0])) ||
        copy_from_user(copy->objects, u64_to_user_ptr(header->objects),
                       header->object_count * sizeof(copy->objects[0])) ||
        copy_from_user(copy->tables, u64_to_user_ptr(phantom_set_tables(header)), header->effect_bytes) ||
        (header->patch_count && u64_to_user_ptr(header->patches) == NULL))
        return -EFAULT;
    copy->patches = u64_to_user_ptr(header->patches);
    return 0;
}

/* The tables of the set that was accepted last are kept: float sets refer to them. */
static u64* border_tables(bool accepted)
{
    static u64 tables[2][PHANTOM_EFFECT_BYTES_MAX / sizeof(u64)];
    static unsigned int next;

    next ^= accepted;
    return tables[next];
}

int border_check(const struct phantom_set* set, uint64_t last_id, struct border_set* out)
{
    static struct phantom_set_copy copy;
    int error;
    u32 i;

    memset(&copy, 0, sizeof(copy));
    copy.header = *set;
    copy.tables = border_tables(false);
    error = phantom_set_check_header(&copy.header, last_id, PHANTOM_PATCHES_MAX);
    if (!error)
        error = border_copy(&copy);
    if (!error)
        error = phantom_set_check_arrays(&copy);
    if (error)
        return error;
    border_tables(true);
    memcpy(out->origin_nm, set->origin_nm, sizeof(out->origin_nm));
    memcpy(out->centre_nm, set->centre_nm, sizeof(out->centre_nm));
    out->radius_nm = min_t(u32, set->radius_nm, PHANTOM_COVERAGE_MAX_NM);
    out->face_count = copy.face_count;
    out->rim_count = copy.rim_count;
    out->materials = copy.materials;
    out->effects = set->effect_bytes ? &copy.effects : NULL;
    out->reach_nm = 0;
    for (i = 0; i < set->material_count; i++)
        out->reach_nm = max_t(u32, out->reach_nm, copy.materials[i].radius_nm);
    return 0;
}

static void border_frame(const struct border_set* set, struct phantom_frame* frame)
{
    memcpy(frame->origin_nm, set->origin_nm, sizeof(frame->origin_nm));
    memcpy(frame->centre_nm, set->centre_nm, sizeof(frame->centre_nm));
    frame->radius_nm = set->radius_nm;
}

bool border_relative(const struct border_set* set, const int64_t position_nm[3], int32_t relative_nm[3])
{
    struct phantom_frame frame;
    s64 position[3];

    border_frame(set, &frame);
    memcpy(position, position_nm, sizeof(position));
    return phantom_frame_relative(&frame, position, relative_nm);
}

bool border_covers(const struct border_set* set, const int32_t point_nm[3], uint32_t ball_nm)
{
    struct phantom_frame frame;

    border_frame(set, &frame);
    return phantom_frame_covers(&frame, point_nm, ball_nm);
}
