// SPDX-License-Identifier: GPL-2.0-only
/*
 * phantom_effects_check.c - the effect tables of a submitted set, one after the other. What is checked is
 * the module's own copy. Integers only.
 */
#include <phantom_platform.h>
#include "phantom_effects_check.h"

/* Contact then knows nothing of it: its radii are larger (phantom_abi.h, EFFECTS). */
static bool phantom_check_tip(struct phantom_set_copy *copy, struct phantom_table_walk *walk)
{
	const struct phantom_tip *tip = phantom_table_take(walk, 1, sizeof(*tip));
	u32 i;

	if (!tip || tip->reserved || !tip->radius_nm || tip->radius_nm > PHANTOM_TIP_RADIUS_MAX_NM)
		return false;
	for (i = 0; i < copy->header.material_count; i++) {
		if (copy->materials[i].radius_nm > U32_MAX - tip->radius_nm)
			return false;
		copy->materials[i].radius_nm += tip->radius_nm;
	}
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
	{PHANTOM_EFFECT_HEIGHT_MAP, phantom_check_height_maps},
	{PHANTOM_EFFECT_IMPACT, phantom_check_impacts},
	{PHANTOM_EFFECT_CONSTANT, phantom_check_constant},
	{PHANTOM_EFFECT_VISCOSITY, phantom_check_viscosity},
	{PHANTOM_EFFECT_GUIDE, phantom_check_guides},
	{PHANTOM_EFFECT_FIELD, phantom_check_field},
	{PHANTOM_EFFECT_TIP, phantom_check_tip},
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
