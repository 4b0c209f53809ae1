// SPDX-License-Identifier: GPL-2.0-only
/*
 * phantom_space_check.c - tables of space effects, against their structs in phantom_abi.h. Integers only.
 */
#include <phantom_platform.h>
#include "phantom_effects_check.h"

static bool phantom_check_unused(const s32 vector[3])
{
	return !vector[0] && !vector[1] && !vector[2];
}

bool phantom_check_constant(struct phantom_set_copy *copy, struct phantom_table_walk *walk)
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

bool phantom_check_viscosity(struct phantom_set_copy *copy, struct phantom_table_walk *walk)
{
	u32 count = phantom_table_count(walk), i;
	const struct phantom_viscosity *regions = phantom_table_take(walk, count, sizeof(*regions));

	if (!regions)
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

bool phantom_check_guides(struct phantom_set_copy *copy, struct phantom_table_walk *walk)
{
	u32 count = phantom_table_count(walk), i;
	const struct phantom_guide *guide = phantom_table_take(walk, count, sizeof(*guide));

	if (!guide)
		return false;
	for (i = 0; i < count; i++)
		if (!phantom_check_guide(&copy->header, &guide[i]))
			return false;
	copy->effects.guide = guide;
	copy->effects.guide_count = count;
	return true;
}

/* Steps that a field may have along each axis. */
static bool phantom_check_nodes(const struct phantom_field *field, const s32 (*force_un)[3])
{
	const u32 stride[3] = {1, field->nodes[0], field->nodes[0] * field->nodes[1]};
	u32 count = stride[2] * field->nodes[2], i;
	int axis, part;

	for (i = 0; i < count; i++) {
		for (part = 0; part < 3; part++)
			if (force_un[i][part] > PHANTOM_EFFECT_FORCE_MAX_UN ||
			    force_un[i][part] < -PHANTOM_EFFECT_FORCE_MAX_UN)
				return false;
		for (axis = 0; axis < 3; axis++) {
			/* mN/mm are 1e-3 uN/nm */
			u64 most = (u64)field->spacing_nm[axis] *
				   (PHANTOM_EFFECT_STIFFNESS_MAX_MN_MM / 1000);

			if (i / stride[axis] % field->nodes[axis] + 1 == field->nodes[axis])
				continue;
			for (part = 0; part < 3; part++) {
				s64 step =
					(s64)force_un[i + stride[axis]][part] - force_un[i][part];

				if ((u64)(step < 0 ? -step : step) > most)
					return false;
			}
		}
	}
	return true;
}

bool phantom_check_field(struct phantom_set_copy *copy, struct phantom_table_walk *walk)
{
	const struct phantom_field *field = phantom_table_take(walk, 1, sizeof(*field));
	const s32(*force_un)[3];
	const s32 *odd;
	u32 count = 1;
	int axis;

	if (!field || field->reserved || field->border_nm < PHANTOM_BORDER_MIN_NM ||
	    !phantom_check_place(&copy->header, field->corner_nm))
		return false;
	for (axis = 0; axis < 3; axis++) {
		u64 nodes = field->nodes[axis];

		if (nodes < 2 || count * nodes > PHANTOM_FIELD_NODES_MAX ||
		    field->spacing_nm[axis] < PHANTOM_FIELD_SPACING_MIN_NM ||
		    (nodes - 1) * field->spacing_nm[axis] > PHANTOM_EFFECT_REACH_MAX_NM ||
		    2 * (u64)field->border_nm > (nodes - 1) * field->spacing_nm[axis])
			return false;
		count *= nodes;
	}
	force_un = phantom_table_take(walk, count, sizeof(*force_un));
	if (!force_un || !phantom_check_nodes(field, force_un))
		return false;
	if (count % 2) {
		odd = phantom_table_take(walk, 1, sizeof(*odd));
		if (!odd || *odd)
			return false;
	}
	copy->effects.field = field;
	return true;
}
