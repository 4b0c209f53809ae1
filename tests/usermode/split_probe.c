// SPDX-License-Identifier: GPL-2.0-or-later
#include "phantom_set.h"
#include <phantom_platform.h>

#include "split_probe.h"

int split_probe(const struct phantom_set* set, struct phantom_patch out[],
                struct split_part part[1 + PHANTOM_MOVING_MAX])
{
    static struct phantom_set_copy copy;
    int error;
    u32 f;

    memset(&copy, 0, sizeof(copy));
    copy.header = *set;
    memcpy(copy.materials, u64_to_user_ptr(set->materials), set->material_count * sizeof(copy.materials[0]));
    memcpy(copy.objects, u64_to_user_ptr(set->objects), set->object_count * sizeof(copy.objects[0]));
    copy.patches = u64_to_user_ptr(set->patches);
    copy.capacity = set->patch_count;
    error = phantom_set_check_arrays(&copy);
    if (!error)
        error = phantom_set_split(&copy);
    if (!error) {
        memcpy(out, copy.sorted, set->patch_count * sizeof(out[0]));
        for (f = 0; f < PHANTOM_FRAMES; f++)
            part[f] = (struct split_part){copy.part[f].first, copy.part[f].patch_count,
                                          copy.part[f].face_count, copy.part[f].rim_count};
    }
    vfree(copy.room);
    return error;
}
