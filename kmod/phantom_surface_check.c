// SPDX-License-Identifier: GPL-2.0-only
/*
 * phantom_surface_check.c - tables of surface effects, against their structs in phantom_abi.h. Integers
 * only.
 */
#include <phantom_platform.h>
#include "phantom_effects_check.h"

/* Materials that name it. */
static u32 phantom_effect_users(const struct phantom_set_copy *copy, u32 effect)
{
	u32 i, users = 0;

	for (i = 0; i < copy->header.material_count; i++)
		users += (copy->materials[i].effects & effect) != 0;
	return users;
}

bool phantom_check_magnets(struct phantom_set_copy *copy, struct phantom_table_walk *walk)
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

bool phantom_check_friction(struct phantom_set_copy *copy, struct phantom_table_walk *walk)
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

bool phantom_check_textures(struct phantom_set_copy *copy, struct phantom_table_walk *walk)
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

static bool phantom_check_map_size(u32 samples)
{
	return samples >= PHANTOM_MAP_SIZE_MIN && samples <= PHANTOM_MAP_SIZE_MAX &&
	       !(samples & (samples - 1));
}

static u64 phantom_step(s32 a, s32 b)
{
	s64 step = (s64)a - b;

	return step < 0 ? -step : step;
}

/* Heights within the amplitude, and no steeper than the header of phantom_height_map says. */
static bool phantom_check_heights(const struct phantom_height_map *map, const s32 *height_nm)
{
	u64 most_along = 0, most_across = 0;
	u32 row, column;

	for (row = 0; row < map->rows; row++) {
		const s32 *line = height_nm + row * map->columns;
		const s32 *next = height_nm + (row + 1) % map->rows * map->columns;

		for (column = 0; column < map->columns; column++) {
			s32 after = line[(column + 1) % map->columns];

			if (phantom_step(line[column], 0) > map->amplitude_nm)
				return false;
			most_along = max(most_along, phantom_step(line[column], after));
			most_across = max(most_across, phantom_step(line[column], next[column]));
		}
	}
	return most_along + most_across <= map->spacing_nm;
}

bool phantom_check_height_maps(struct phantom_set_copy *copy, struct phantom_table_walk *walk)
{
	u32 i;

	for (i = 0; i < copy->header.material_count; i++) {
		const struct phantom_height_map *map;
		const s32 *height_nm;

		if (!(copy->materials[i].effects & PHANTOM_EFFECT_HEIGHT_MAP))
			continue;
		map = phantom_table_take(walk, 1, sizeof(*map));
		if (!map || !phantom_check_map_size(map->columns) ||
		    !phantom_check_map_size(map->rows) ||
		    map->spacing_nm < PHANTOM_MAP_SPACING_MIN_NM)
			return false;
		height_nm = phantom_table_take(walk, map->columns * map->rows, sizeof(*height_nm));
		if (!height_nm || !phantom_check_heights(map, height_nm))
			return false;
		copy->effects.height_map[i] = map;
	}
	return true;
}

bool phantom_check_impacts(struct phantom_set_copy *copy, struct phantom_table_walk *walk)
{
	u32 count = phantom_effect_users(copy, PHANTOM_EFFECT_IMPACT), i;
	const struct phantom_impact *impact = phantom_table_take(walk, count, sizeof(*impact));

	if (!impact)
		return false;
	for (i = 0; i < count; i++)
		if (impact[i].frequency_hz < PHANTOM_IMPACT_FREQUENCY_MIN_HZ ||
		    impact[i].frequency_hz > PHANTOM_IMPACT_FREQUENCY_MAX_HZ ||
		    impact[i].gain_mns_m >
			    PHANTOM_IMPACT_GAIN_MAX_MNS_M_PER_HZ * impact[i].frequency_hz ||
		    impact[i].decay_us < PHANTOM_IMPACT_DECAY_MIN_US ||
		    impact[i].decay_us > PHANTOM_IMPACT_DECAY_MAX_US ||
		    impact[i].force_un > PHANTOM_EFFECT_FORCE_MAX_UN)
			return false;
	copy->effects.impact = impact;
	return true;
}
