// SPDX-License-Identifier: GPL-2.0-only
/*
 * phantom_effects_check.c - the effect tables of a submitted set, against their structs in phantom_abi.h.
 * What is checked is the module's own copy. Integers only.
 */
#include <phantom_platform.h>
#include "phantom_set.h"

/* Where the next table begins. */
struct phantom_table_walk {
	const u8 *at;
	u32 left;
};

/* The table of that many entries, or NULL: the tables end before it does. */
static const void *phantom_table_take(struct phantom_table_walk *walk, u32 count, size_t bytes)
{
	const void *table = walk->at;

	/* count is a material's or PHANTOM_REGIONS_MAX at most: no product wraps */
	if (count * bytes > walk->left)
		return NULL;
	walk->at += count * bytes;
	walk->left -= count * bytes;
	return table;
}

/* Materials that name it. */
static u32 phantom_effect_users(const struct phantom_set_copy *copy, u32 effect)
{
	u32 i, users = 0;

	for (i = 0; i < copy->header.material_count; i++)
		users += (copy->materials[i].effects & effect) != 0;
	return users;
}

static bool phantom_check_unused(const s32 vector[3])
{
	return !vector[0] && !vector[1] && !vector[2];
}

/* ---- surface ------------------------------------------------------------- */

static bool phantom_check_magnets(struct phantom_set_copy *copy, struct phantom_table_walk *walk)
{
	u32 count = phantom_effect_users(copy, PHANTOM_EFFECT_MAGNET), i, entry = 0;
	const struct phantom_magnet *magnet = phantom_table_take(walk, count, sizeof(*magnet));

	if (!magnet)
		return false;
	for (i = 0; i < copy->header.material_count; i++) {
		if (!(copy->materials[i].effects & PHANTOM_EFFECT_MAGNET))
			continue;
		if (!magnet[entry].range_nm ||
		    magnet[entry].range_nm >= copy->materials[i].radius_nm ||
		    magnet[entry].force_un > PHANTOM_EFFECT_FORCE_MAX_UN)
			return false;
		entry++;
	}
	copy->effects.magnet = magnet;
	return true;
}

static bool phantom_check_friction(struct phantom_set_copy *copy, struct phantom_table_walk *walk)
{
	u32 count = phantom_effect_users(copy, PHANTOM_EFFECT_FRICTION), i;
	const struct phantom_friction *friction =
		phantom_table_take(walk, count, sizeof(*friction));

	if (!friction)
		return false;
	for (i = 0; i < count; i++)
		if (friction[i].static_ppm > PHANTOM_FRICTION_MAX_PPM ||
		    friction[i].dynamic_ppm > friction[i].static_ppm ||
		    !friction[i].stiffness_mn_mm ||
		    friction[i].stiffness_mn_mm > PHANTOM_EFFECT_STIFFNESS_MAX_MN_MM ||
		    friction[i].stribeck_um_s > PHANTOM_FRICTION_SPEED_MAX_UM_S)
			return false;
	copy->effects.friction = friction;
	return true;
}

/* amplitude (|x| + |y| + |z|) of one grating; negative: the grating is none. */
static s64 phantom_grating_slope(u32 amplitude_nm, const s32 wave_per_km[3])
{
	s64 sum = 0;
	int axis;

	for (axis = 0; axis < 3; axis++) {
		s64 wave = wave_per_km[axis];

		if (wave > PHANTOM_WAVE_MAX_PER_KM || wave < -PHANTOM_WAVE_MAX_PER_KM)
			return -1;
		sum += wave < 0 ? -wave : wave;
	}
	if (!amplitude_nm != !sum)
		return -1;
	return sum * amplitude_nm; /* below 2^61 */
}

static bool phantom_check_textures(struct phantom_set_copy *copy, struct phantom_table_walk *walk)
{
	u32 count = phantom_effect_users(copy, PHANTOM_EFFECT_TEXTURE), i;
	const struct phantom_texture *texture = phantom_table_take(walk, count, sizeof(*texture));

	if (!texture)
		return false;
	for (i = 0; i < count; i++) {
		const u32 *amplitude_nm = texture[i].amplitude_nm;
		s64 first = phantom_grating_slope(amplitude_nm[0], texture[i].wave_per_km[0]);
		s64 second = phantom_grating_slope(amplitude_nm[1], texture[i].wave_per_km[1]);

		if (first < 0 || second < 0 || first + second > PHANTOM_WAVE_SLOPE_MAX)
			return false;
	}
	copy->effects.texture = texture;
	return true;
}

/* ---- space --------------------------------------------------------------- */

static bool phantom_check_constant(struct phantom_set_copy *copy, struct phantom_table_walk *walk)
{
	const struct phantom_constant *constant = phantom_table_take(walk, 1, sizeof(*constant));
	int axis;

	if (!constant || constant->reserved)
		return false;
	for (axis = 0; axis < 3; axis++)
		if (constant->force_un[axis] > PHANTOM_EFFECT_FORCE_MAX_UN ||
		    constant->force_un[axis] < -PHANTOM_EFFECT_FORCE_MAX_UN)
			return false;
	copy->effects.constant = constant;
	return true;
}

/* 0: there is none, or not a number of entries. */
static u32 phantom_table_count(struct phantom_table_walk *walk)
{
	const struct phantom_effect_count *count = phantom_table_take(walk, 1, sizeof(*count));

	return !count || count->reserved || count->count > PHANTOM_REGIONS_MAX ? 0 : count->count;
}

/* Positions are below PHANTOM_POSITION_MAX_NM: no difference wraps. */
static bool phantom_check_place(const struct phantom_set *header, const s64 place_nm[3])
{
	int axis;

	for (axis = 0; axis < 3; axis++) {
		s64 way;

		if (place_nm[axis] > PHANTOM_POSITION_MAX_NM ||
		    place_nm[axis] < -PHANTOM_POSITION_MAX_NM)
			return false;
		way = place_nm[axis] - header->origin_nm[axis];
		if (way > PHANTOM_EFFECT_REACH_MAX_NM || way < -PHANTOM_EFFECT_REACH_MAX_NM)
			return false;
	}
	return true;
}

static bool phantom_check_region(const struct phantom_set *header,
				 const struct phantom_viscosity *region)
{
	const s64 *centre_nm = region->centre_nm;

	if (region->viscosity_mns_m > PHANTOM_VISCOSITY_MAX_MNS_M ||
	    region->drag_mns2_m2 > PHANTOM_DRAG_MAX_MNS2_M2)
		return false;
	if (!region->radius_nm)
		return !region->border_nm && !centre_nm[0] && !centre_nm[1] && !centre_nm[2];
	return region->border_nm >= PHANTOM_BORDER_MIN_NM &&
	       region->border_nm <= region->radius_nm && phantom_check_place(header, centre_nm);
}

static bool phantom_check_viscosity(struct phantom_set_copy *copy, struct phantom_table_walk *walk)
{
	u32 count = phantom_table_count(walk), i;
	const struct phantom_viscosity *regions = phantom_table_take(walk, count, sizeof(*regions));

	if (!count || !regions)
		return false;
	for (i = 0; i < count; i++)
		if (!phantom_check_region(&copy->header, &regions[i]))
			return false;
	copy->effects.viscosity = regions;
	copy->effects.viscosity_count = count;
	return true;
}

static bool phantom_check_guide(const struct phantom_set *header, const struct phantom_guide *guide)
{
	if (guide->kind > PHANTOM_GUIDE_PLANE || guide->reserved || !guide->stiffness_mn_mm ||
	    guide->stiffness_mn_mm > PHANTOM_EFFECT_STIFFNESS_MAX_MN_MM || !guide->force_un ||
	    guide->force_un > PHANTOM_EFFECT_FORCE_MAX_UN)
		return false;
	if (guide->kind == PHANTOM_GUIDE_POINT ? !phantom_check_unused(guide->direction_q30)
					       : !phantom_check_unit(guide->direction_q30))
		return false;
	return phantom_check_place(header, guide->point_nm);
}

static bool phantom_check_guides(struct phantom_set_copy *copy, struct phantom_table_walk *walk)
{
	u32 count = phantom_table_count(walk), i;
	const struct phantom_guide *guide = phantom_table_take(walk, count, sizeof(*guide));

	if (!count || !guide)
		return false;
	for (i = 0; i < count; i++)
		if (!phantom_check_guide(&copy->header, &guide[i]))
			return false;
	copy->effects.guide = guide;
	copy->effects.guide_count = count;
	return true;
}

/* In the order of the bits, which is that of the tables. */
static const struct {
	u32 effect;
	bool (*check)(struct phantom_set_copy *copy, struct phantom_table_walk *walk);
} phantom_effect_checks[] = {
	{PHANTOM_EFFECT_MAGNET, phantom_check_magnets},
	{PHANTOM_EFFECT_FRICTION, phantom_check_friction},
	{PHANTOM_EFFECT_TEXTURE, phantom_check_textures},
	{PHANTOM_EFFECT_CONSTANT, phantom_check_constant},
	{PHANTOM_EFFECT_VISCOSITY, phantom_check_viscosity},
	{PHANTOM_EFFECT_GUIDE, phantom_check_guides},
};

int phantom_effects_check(struct phantom_set_copy *copy)
{
	struct phantom_table_walk walk = {(const u8 *)copy->tables, copy->header.effect_bytes};
	size_t i;

	memset(&copy->effects, 0, sizeof(copy->effects));
	copy->effects.mask = copy->header.effects;
	for (i = 0; i < ARRAY_SIZE(phantom_effect_checks); i++)
		if ((copy->header.effects & phantom_effect_checks[i].effect) &&
		    !phantom_effect_checks[i].check(copy, &walk))
			return -EINVAL;
	return walk.left ? -EINVAL : 0;
}
