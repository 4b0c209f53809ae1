/* SPDX-License-Identifier: GPL-2.0-only */
/*
 * damping.h - effect: normal damping, PHANTOM_EFFECT_DAMPING.
 *
 *   a = F . n                     what the contact gives along its normal, N
 *   F += -n clamp(b v . n, -a, a)
 *
 * b in N per mm/s, v in mm/s. The surface pushes harder while the tip moves in, less while it
 * moves out. What is added is never more than a: so the surface never pulls, and where contact
 * begins or ends the force has no step (as with Hunt & Crossley 1975, whose damping grows with depth;
 * here it is whole from a depth of b |v . n| / k on). In a sampled loop contact may be twice as stiff.
 * An a that was negative before (no contact law gives one) is left as it is.
 */
#ifndef PHANTOM_FLOAT_DAMPING_H
#define PHANTOM_FLOAT_DAMPING_H

#include "../combine.h"

static inline struct real3 damping_apply(struct real3 force, struct real3 normal, real damping,
					 const s32 velocity_nm_s[3])
{
	struct real3 velocity = {real_from_nm(velocity_nm_s[0]), real_from_nm(velocity_nm_s[1]),
				 real_from_nm(velocity_nm_s[2])};
	real along = real3_dot(force, normal);
	real against = mul(damping, real3_dot(velocity, normal));

	if (along < 0)
		return force;
	return real3_sub(force, real3_scale(normal, real_clamp(against, -along, along)));
}

#endif /* PHANTOM_FLOAT_DAMPING_H */
