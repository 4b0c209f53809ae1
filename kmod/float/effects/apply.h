/* SPDX-License-Identifier: GPL-2.0-only */
/*
 * apply.h - the effects of a tick, after contact and in this order:
 *
 *     magnet -> texture -> damping -> friction      where there is contact
 *     constant, viscosity, guide                    wherever the tip is
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
#include "magnet.h"
#include "texture.h"
#include "viscosity.h"

/* Effects that change the force of contact along its normal, and the one that adds to it across. */
static inline void effects_on_surface(struct phantom_float_job *job, struct contact_force *contact)
{
	const struct float_effects *effects = set_effects(job->set);
	struct real3 across = {0, 0, 0};
	struct surface surface;

	job->stick_next.held = 0;
	if (!surface_begin(job, contact, &surface))
		return;
	if (job->effects & PHANTOM_EFFECT_MAGNET)
		magnet_apply(effect_block(effects, EFFECT_MAGNET), &surface);
	/* what the tip is pressed on with, before the relief plays on it */
	if ((job->effects & PHANTOM_EFFECT_FRICTION) && surface.load > 0)
		across = friction_force(job, effect_block(effects, EFFECT_FRICTION), &surface);
	if (job->effects & PHANTOM_EFFECT_TEXTURE)
		across = real3_add(across, texture_force(job, effect_block(effects, EFFECT_TEXTURE),
							 &surface));
	contact->force = real3_scale(surface.direction, surface.load);
	if ((job->effects & PHANTOM_EFFECT_DAMPING) && contact->damping > 0)
		contact->force = damping_apply(contact->force, contact->normal, contact->damping,
					       job->velocity_nm_s);
	contact->force = real3_add(contact->force, across);
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
