// SPDX-License-Identifier: GPL-2.0-only
/*
 * phantom_set_check.c - every field of a submitted set, against the table in phantom_abi.h. What is
 * checked is the module's own copy: the caller cannot change it meanwhile.
 */
#include <phantom_platform.h>
#include "phantom_set.h"

/* |n| = 1 to 2^-10, compared as squares in Q2.60. */
#define PHANTOM_UNIT_LENGTH (1ULL << 30)
#define PHANTOM_UNIT_SLACK (1ULL << 20)
#define PHANTOM_UNIT_LOW (PHANTOM_UNIT_LENGTH - PHANTOM_UNIT_SLACK)
#define PHANTOM_UNIT_HIGH (PHANTOM_UNIT_LENGTH + PHANTOM_UNIT_SLACK)

static bool phantom_check_coordinates(const s32 point_nm[3])
{
	int axis;

	for (axis = 0; axis < 3; axis++)
		if (point_nm[axis] > PHANTOM_COORDINATE_MAX_NM ||
		    point_nm[axis] < -PHANTOM_COORDINATE_MAX_NM)
			return false;
	return true;
}

static bool phantom_check_length(const s32 components_q30[], u32 count)
{
	u64 sum = 0;
	u32 i;

	for (i = 0; i < count; i++) {
		s64 component = components_q30[i];

		sum += (u64)(component * component); /* <= 2^62 each: four wrap at most to 0 */
	}
	return sum >= PHANTOM_UNIT_LOW * PHANTOM_UNIT_LOW &&
	       sum <= PHANTOM_UNIT_HIGH * PHANTOM_UNIT_HIGH;
}

bool phantom_check_unit(const s32 vector_q30[3])
{
	return phantom_check_length(vector_q30, 3);
}

int phantom_set_check_header(const struct phantom_set *header, u64 last_id, u32 patches_max)
{
	int axis;

	if (header->flags || header->effect_bytes > PHANTOM_EFFECT_BYTES_MAX)
		return -EINVAL;
	if (header->id <= last_id)
		return -EINVAL;
	if (header->patch_count > patches_max || header->material_count > PHANTOM_MATERIALS_MAX ||
	    header->object_count > PHANTOM_OBJECTS_MAX)
		return -EINVAL;
	if (header->effects & ~PHANTOM_EFFECTS_KNOWN)
		return -EINVAL;
	/* Before memory is looked at that the caller need not have. */
	if (header->effect_bytes && !(header->effects & ~PHANTOM_EFFECT_DAMPING))
		return -EINVAL;
	for (axis = 0; axis < 3; axis++)
		if (header->origin_nm[axis] > PHANTOM_POSITION_MAX_NM ||
		    header->origin_nm[axis] < -PHANTOM_POSITION_MAX_NM)
			return -EINVAL;
	if (!phantom_check_coordinates(header->centre_nm))
		return -EINVAL;
	return 0;
}

static bool phantom_check_same(const s32 a_nm[3], const s32 b_nm[3])
{
	return a_nm[0] == b_nm[0] && a_nm[1] == b_nm[1] && a_nm[2] == b_nm[2];
}

/* A face may have neighbours among the faces; a fan or rim coincides where its kind says, and has none. */
static bool phantom_check_kind(const struct phantom_patch *patch, u32 face_count)
{
	const s32(*vertex_nm)[3] = patch->vertex_nm;
	int i, same = 0;

	if (patch->kind == PHANTOM_PATCH_FACE) {
		for (i = 0; i < 3; i++)
			if (patch->neighbour[i] >= face_count &&
			    patch->neighbour[i] != PHANTOM_PATCH_NONE)
				return false;
		return true;
	}
	for (i = 0; i < 3; i++) {
		same += phantom_check_same(vertex_nm[i], vertex_nm[(i + 1) % 3]);
		if (patch->neighbour[i] != PHANTOM_PATCH_NONE)
			return false;
	}
	if (patch->face != PHANTOM_PATCH_NONE)
		return false;
	switch (patch->kind) {
	case PHANTOM_PATCH_EDGE:
		return same == 1;
	case PHANTOM_PATCH_CORNER:
		return same == 3;
	case PHANTOM_PATCH_RIM:
		return same == 1 && phantom_check_same(vertex_nm[1], vertex_nm[2]) &&
		       patch->surface;
	default:
		return false;
	}
}

static bool phantom_check_patch(const struct phantom_patch *patch, const struct phantom_set *header)
{
	int i;

	for (i = 0; i < 3; i++) {
		if (!phantom_check_coordinates(patch->vertex_nm[i]) ||
		    !phantom_check_unit(patch->normal_q30[i]))
			return false;
	}
	return patch->object < header->object_count && patch->material < header->material_count &&
	       !patch->reserved;
}

static bool phantom_check_material(const struct phantom_material *material)
{
	int i;

	for (i = 0; i < 4; i++)
		if (material->reserved[i])
			return false;
	if (!material->radius_nm || (material->effects & ~PHANTOM_EFFECTS_SURFACE))
		return false;
	return !material->damping_mns_m || (material->effects & PHANTOM_EFFECT_DAMPING);
}

/* In the scene's coordinates: the pose is the identity. */
static bool phantom_check_resting(const struct phantom_object *object)
{
	int i;

	for (i = 0; i < 3; i++)
		if (object->translation_nm[i] || object->velocity_nm_s[i] ||
		    object->angular_velocity_urad_s[i] || object->rotation_q30[i + 1] ||
		    object->origin_nm[i])
			return false;
	return object->rotation_q30[0] == PHANTOM_Q30_ONE;
}

static bool phantom_check_moving(const struct phantom_object *object)
{
	u64 turn = 0;
	int i;

	for (i = 0; i < 3; i++) {
		s64 about = object->angular_velocity_urad_s[i];

		turn += (u64)(about * about); /* <= 2^62 each */
		if (object->translation_nm[i] > PHANTOM_POSITION_MAX_NM ||
		    object->translation_nm[i] < -PHANTOM_POSITION_MAX_NM ||
		    object->origin_nm[i] > PHANTOM_OBJECT_REACH_NM ||
		    object->origin_nm[i] < -PHANTOM_OBJECT_REACH_NM)
			return false;
	}
	return turn <= (u64)PHANTOM_OBJECT_TURN_MAX_URAD_S * PHANTOM_OBJECT_TURN_MAX_URAD_S &&
	       phantom_check_length(object->rotation_q30, 4);
}

static bool phantom_check_object(const struct phantom_object *object)
{
	if ((object->flags & ~PHANTOM_OBJECT_FLAGS_KNOWN) || object->reserved)
		return false;
	return object->flags & PHANTOM_OBJECT_MOVES ? phantom_check_moving(object)
						    : phantom_check_resting(object);
}

/* Each object on its own, no number twice, and which frame each has: in the objects' order, 0 the scene's. */
static bool phantom_check_objects(struct phantom_set_copy *copy)
{
	u32 i, j;

	copy->frame_count = 1;
	for (i = 0; i < copy->header.object_count; i++) {
		const struct phantom_object *object = &copy->objects[i];

		if (!phantom_check_object(object))
			return false;
		for (j = 0; j < i; j++)
			if (copy->objects[j].object == object->object)
				return false;
		copy->frame[i] = 0;
		if (!(object->flags & PHANTOM_OBJECT_MOVES))
			continue;
		if (copy->frame_count == PHANTOM_FRAMES)
			return false;
		copy->frame[i] = copy->frame_count++;
	}
	return true;
}

/* A face and its neighbours are in one frame. The patch has been checked on its own. */
static bool phantom_check_frame(const struct phantom_set_copy *copy,
				const struct phantom_patch *patch)
{
	int i;

	for (i = 0; i < 3; i++) {
		u32 beside = patch->neighbour[i];

		/* the neighbour's own check may come yet */
		if (beside != PHANTOM_PATCH_NONE &&
		    (copy->patches[beside].object >= copy->header.object_count ||
		     copy->frame[copy->patches[beside].object] != copy->frame[patch->object]))
			return false;
	}
	return true;
}

/* Faces first, then fans, then rims. */
static bool phantom_check_patches(struct phantom_set_copy *copy)
{
	const struct phantom_set *header = &copy->header;
	u32 i, faces = 0, rims = 0;

	while (faces < header->patch_count && copy->patches[faces].kind == PHANTOM_PATCH_FACE)
		faces++;
	while (rims < header->patch_count - faces &&
	       copy->patches[header->patch_count - 1 - rims].kind == PHANTOM_PATCH_RIM)
		rims++;
	copy->face_count = faces;
	copy->rim_count = rims;
	for (i = 0; i < header->patch_count; i++) {
		const struct phantom_patch *patch = &copy->patches[i];

		if (!phantom_check_patch(patch, header) || !phantom_check_kind(patch, faces))
			return false;
		if (i >= faces && patch->kind == PHANTOM_PATCH_FACE)
			return false;
		if (i < header->patch_count - rims && patch->kind == PHANTOM_PATCH_RIM)
			return false;
		if (copy->frame_count > 1 && !phantom_check_frame(copy, patch))
			return false;
	}
	return true;
}

int phantom_set_check_arrays(struct phantom_set_copy *copy)
{
	const struct phantom_set *header = &copy->header;
	u32 effects = 0;
	u32 i;

	for (i = 0; i < header->material_count; i++) {
		if (!phantom_check_material(&copy->materials[i]))
			return -EINVAL;
		effects |= copy->materials[i].effects;
	}
	if (effects != (header->effects & PHANTOM_EFFECTS_SURFACE) || phantom_effects_check(copy))
		return -EINVAL;
	return phantom_check_objects(copy) && phantom_check_patches(copy) ? 0 : -EINVAL;
}
