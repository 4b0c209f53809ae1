// SPDX-License-Identifier: GPL-2.0-only
/*
 * phantom_set_split.c - the patches of a checked set, frame by frame. Process context, `submitting` held.
 *
 * A set in which nothing moves is used as it came. Else each frame gets its patches in the order that
 * they came in, so faces, fans and rims still follow each other, and a neighbour is counted from the
 * frame's first patch.
 */
#include <phantom_platform.h>
#include "phantom_set.h"

static int phantom_split_reserve(struct phantom_set_copy *copy)
{
	u32 capacity = copy->capacity;

	if (copy->room_capacity >= capacity)
		return 0;
	vfree(copy->room);
	WRITE_ONCE(copy->room_capacity, 0);
	copy->room = vzalloc(capacity * PHANTOM_SPLIT_BYTES);
	if (!copy->room)
		return -ENOMEM;
	WRITE_ONCE(copy->room_capacity, capacity);
	return 0;
}

static void phantom_split_count(struct phantom_set_copy *copy)
{
	u32 i, f, first = 0;

	for (i = 0; i < copy->header.patch_count; i++) {
		struct phantom_part *part = &copy->part[copy->frame[copy->patches[i].object]];

		part->patch_count++;
		part->face_count += copy->patches[i].kind == PHANTOM_PATCH_FACE;
		part->rim_count += copy->patches[i].kind == PHANTOM_PATCH_RIM;
	}
	for (f = 0; f < copy->frame_count; f++) {
		copy->part[f].first = first;
		first += copy->part[f].patch_count;
	}
}

int phantom_set_split(struct phantom_set_copy *copy)
{
	u32 count = copy->header.patch_count, next[PHANTOM_FRAMES] = {0};
	u32 *place; /* of each patch in its frame */
	u32 i, edge;
	int error;

	copy->sorted = copy->patches;
	memset(copy->part, 0, sizeof(copy->part));
	if (copy->frame_count == 1 || !count) {
		copy->part[0] = (struct phantom_part){0, count, copy->face_count, copy->rim_count};
		return 0;
	}
	error = phantom_split_reserve(copy);
	if (error)
		return error;
	phantom_split_count(copy);
	place = (u32 *)(copy->room + copy->room_capacity);
	for (i = 0; i < count; i++)
		place[i] = next[copy->frame[copy->patches[i].object]]++;
	for (i = 0; i < count; i++) {
		u32 frame = copy->frame[copy->patches[i].object];
		struct phantom_patch *patch = &copy->room[copy->part[frame].first + place[i]];

		*patch = copy->patches[i];
		for (edge = 0; edge < 3; edge++)
			if (patch->neighbour[edge] != PHANTOM_PATCH_NONE)
				patch->neighbour[edge] = place[patch->neighbour[edge]];
	}
	copy->sorted = copy->room;
	return 0;
}
