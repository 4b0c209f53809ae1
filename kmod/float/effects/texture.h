/* SPDX-License-Identifier: GPL-2.0-only */
/*
 * texture.h - effect: gratings on the surface, PHANTOM_EFFECT_TEXTURE.
 *
 *   h(x) += sum A_i sin(2 pi f_i . x)       the law of h: relief.h
 *
 * BAND LIMIT. A wave felt at f . v Hz is full up to 1/8 of the servo's rate and gone at 1/4, each grating
 * by itself.
 *
 * A relief is stiff: k p A (2 pi f)^2 on top of k; in a sampled loop that sum counts.
 */
#ifndef PHANTOM_FLOAT_TEXTURE_H
#define PHANTOM_FLOAT_TEXTURE_H

#include "relief.h"
#include "sine.h"

/* Part of a grating that the servo's rate can carry. */
static inline real texture_band(const struct phantom_float_job *job,
				const struct float_grating *grating)
{
	struct real3 way = {
		mul(real_from_nm(job->velocity_nm_s[0]), real_from_nm(job->period_ns)),
		mul(real_from_nm(job->velocity_nm_s[1]), real_from_nm(job->period_ns)),
		mul(real_from_nm(job->velocity_nm_s[2]), real_from_nm(job->period_ns)),
	};
	/* ns as nm are 1e-6 s: 1000 of what is meant */
	real waves = mul(real_abs(real3_dot(grating->per_mm, way)), REAL(1e-3));

	return phase_band(waves);
}

static inline void texture_grating(const struct phantom_float_job *job,
				   const struct float_grating *grating, const s32 foot_nm[3],
				   real weight, struct relief *relief)
{
	u64 phase = grating->phase;
	real part = mul(weight, texture_band(job, grating));
	u32 axis;

	if (!(part > 0))
		return;
	for (axis = 0; axis < 3; axis++)
		phase += (u64)(s64)foot_nm[axis] * grating->wave[axis];
	relief->height += mul(part, mul(grating->amplitude, phase_sine(phase)));
	relief->slope =
		real3_add(relief->slope, real3_scale(grating->slope,
						     mul(part, phase_sine(phase + PHASE_QUARTER))));
}

/* Adds those of that part of the contact which the material has. */
static inline void texture_add(const struct phantom_float_job *job,
			       const struct float_texture *texture, const s32 foot_nm[3],
			       real weight, struct relief *relief)
{
	relief->amplitude += mul(weight, texture->amplitude);
	texture_grating(job, &texture->grating[0], foot_nm, weight, relief);
	texture_grating(job, &texture->grating[1], foot_nm, weight, relief);
}

#endif /* PHANTOM_FLOAT_TEXTURE_H */
