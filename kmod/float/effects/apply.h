/* SPDX-License-Identifier: GPL-2.0-only */
/*
 * apply.h - the effects of a tick, after contact and in this order:
 *
 *     magnet -> friction -> relief -> damping       where there is contact
 *     impact                                        from there on
 *     constant, viscosity, guide, field             wherever the tip is
 *
 * The tick comes here only if its set names an effect, and each is tested for once. Not in pieces:
 * 16 materials and twice 8 regions are a few thousand instructions at most.
 */
#ifndef PHANTOM_FLOAT_EFFECTS_APPLY_H
#define PHANTOM_FLOAT_EFFECTS_APPLY_H

#include "damping.h"
#include "friction.h"
#include "guide.h"
#include "constant.h"
#include "field.h"
#include "height_map.h"
#include "impact.h"
#include "magnet.h"
#include "texture.h"
#include "viscosity.h"

/* What the surface's materials make of its relief. */
static inline struct real3 effects_of_relief(const struct phantom_float_job *job,
					     const struct float_effects *effects,
					     struct surface *surface)
{
	const struct float_texture *texture = effect_block(effects, EFFECT_TEXTURE);
	const struct float_height_map *map = effect_block(effects, EFFECT_HEIGHT_MAP);
	struct relief relief = {.amplitude = 0};
	s32 foot_nm[3];
	u32 m;

	relief_foot(job, surface, foot_nm);
	for (m = 0; m < surface->materials; m++) {
		real weight = surface->weight[m];

		if (!(weight > 0))
			continue;
		if ((job->effects & PHANTOM_EFFECT_TEXTURE) && texture[m].amplitude > 0)
			texture_add(job, &texture[m], foot_nm, weight, &relief);
		if ((job->effects & PHANTOM_EFFECT_HEIGHT_MAP) && map[m].height_nm)
			height_map_add(job, &map[m], surface->direction, foot_nm, weight, &relief);
	}
	return relief_force(&relief, surface);
}

/* Effects that change the force of contact along its normal, and those that add to it across. */
static inline void effects_on_contact(struct phantom_float_job *job,
				      const struct float_effects *effects, struct surface *surface,
				      struct contact_force *contact)
{
	struct real3 across = {0, 0, 0};

	if (job->effects & PHANTOM_EFFECT_MAGNET)
		magnet_apply(effect_block(effects, EFFECT_MAGNET), surface);
	/* what the tip is pressed on with, before the relief plays on it */
	if ((job->effects & PHANTOM_EFFECT_FRICTION) && surface->load > 0)
		across = friction_force(job, effect_block(effects, EFFECT_FRICTION), surface);
	if (job->effects & (PHANTOM_EFFECT_TEXTURE | PHANTOM_EFFECT_HEIGHT_MAP))
		across = real3_add(across, effects_of_relief(job, effects, surface));
	contact->force = real3_scale(surface->direction, surface->load);
	if ((job->effects & PHANTOM_EFFECT_DAMPING) && contact->damping > 0)
		contact->force = damping_apply(contact->force, contact->normal, contact->damping,
					       job->velocity_nm_s);
	contact->force = real3_add(contact->force, across);
}

static inline void effects_on_surface(struct phantom_float_job *job, struct contact_force *contact)
{
	const struct float_effects *effects = set_effects(job->set);
	struct surface surface;
	bool touched;

	job->stick_next.held = 0;
	touched = surface_begin(job, contact, &surface);
	if (touched)
		effects_on_contact(job, effects, &surface, contact);
	if (job->effects & PHANTOM_EFFECT_IMPACT)
		contact->force =
			real3_add(contact->force,
				  /* in its range a magnet is not hit */
				  impact_force(job, effect_block(effects, EFFECT_IMPACT),
					       touched && surface.load > 0 ? &surface : 0));
}

static inline void effects_in_space(const struct phantom_float_job *job, struct real3 *force)
{
	const struct float_effects *effects = set_effects(job->set);

	if (job->effects & PHANTOM_EFFECT_CONSTANT)
		*force = real3_add(*force, constant_force(effect_block(effects, EFFECT_CONSTANT)));
	if (job->effects & PHANTOM_EFFECT_VISCOSITY)
		*force = real3_add(*force, viscosity_force(effect_block(effects, EFFECT_VISCOSITY),
							   effects->viscosity_count, job));
	if (job->effects & PHANTOM_EFFECT_GUIDE)
		*force = real3_add(*force, guide_force(effect_block(effects, EFFECT_GUIDE),
						       effects->guide_count, job->tip_nm));
	if (job->effects & PHANTOM_EFFECT_FIELD)
		*force = real3_add(*force,
				   field_force(effect_block(effects, EFFECT_FIELD), job->tip_nm));
}

LANES_NOINLINE void effects_apply(struct phantom_float_job *job, struct contact_force *contact)
{
	if (job->effects & EFFECTS_TOUCH)
		effects_on_surface(job, contact);
	else if ((job->effects & PHANTOM_EFFECT_DAMPING) && contact->damping > 0)
		contact->force = damping_apply(contact->force, contact->normal, contact->damping,
					       job->velocity_nm_s);
	if (job->effects & PHANTOM_EFFECTS_SPACE)
		effects_in_space(job, &contact->force);
}

#endif /* PHANTOM_FLOAT_EFFECTS_APPLY_H */
