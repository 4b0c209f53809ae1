/* SPDX-License-Identifier: GPL-2.0-only */
/*
 * texture.h - effect: gratings on the surface, PHANTOM_EFFECT_TEXTURE.
 *
 *   h(x) = sum A_i sin(2 pi f_i . x)       height of the relief at the contact's foot x, mm
 *   q    = p + g(p) h,   g(p) = p / (p + 2 A)      A = sum A_i; depth in the relief
 *   F    = k q ((1 + g'(p) h) u - g(p) grad h)     grad along the surface
 *
 * F is the gradient of k q^2 / 2, the contact's own energy at the relief's depth (the bump mapping of
 * Ho, Basdogan & Srinivasan 1999, made conservative): on a flat surface no energy is made, on a curved
 * one of curvature c some c A of it. g lets the relief rise with p, so that F is continuous where contact
 * begins, and keeps q between p/2 and 3p/2: |F| <= 3/2 N sqrt(9/4 + slope^2), slope <= 1.
 *
 * BAND LIMIT. A wave felt at f . v Hz is full up to 1/8 of the servo's rate and gone at 1/4: less than
 * four samples a wave are a buzz of another pitch. What fades takes at most k q^2 / 2 with it.
 *
 * A relief is stiff: k p A (2 pi f)^2 on top of k; in a sampled loop that sum counts. x is a place in the
 * scene to the nm, so the set that it is told in does not matter; between materials h is mixed.
 */
#ifndef PHANTOM_FLOAT_TEXTURE_H
#define PHANTOM_FLOAT_TEXTURE_H

#include "surface.h"

/* Waves per tick; the band limit's slope and where it ends. */
#define TEXTURE_BAND REAL(8)
#define TEXTURE_BAND_END REAL(2)

/* 1/4 of a wave as a phase. */
#define PHASE_QUARTER (1ULL << 62)

/*
 * sin(2 pi phase 2^-64), within 4e-6: Taylor to the ninth order up to a quarter of a wave, the rest is
 * mirrored.
 */
static inline real texture_sine(u64 phase)
{
	s32 turn = (s32)(phase >> 32);
	real x, x2, sum;

	if (turn > (1 << 30) || turn < -(1 << 30))
		turn = (s32)((1U << 31) - (u32)turn);
	x = mul(real_ratio_of_nm(turn, 1LL << 32), REAL(6.283185307179586));
	x2 = mul(x, x);
	sum = REAL(1.0 / 362880);
	sum = mul(sum, x2) - REAL(1.0 / 5040);
	sum = mul(sum, x2) + REAL(1.0 / 120);
	sum = mul(sum, x2) - REAL(1.0 / 6);
	sum = mul(sum, x2) + REAL(1);
	return mul(sum, x);
}

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

	return real_clamp(TEXTURE_BAND_END - mul(TEXTURE_BAND, waves), 0, REAL(1));
}

/* Adds h and its gradient. */
static inline void texture_grating(const struct phantom_float_job *job,
				   const struct float_grating *grating, const s32 foot_nm[3],
				   real weight, real *height, struct real3 *slope)
{
	u64 phase = grating->phase;
	real part = mul(weight, texture_band(job, grating));
	u32 axis;

	if (!(part > 0))
		return;
	for (axis = 0; axis < 3; axis++)
		phase += (u64)(s64)foot_nm[axis] * grating->wave[axis];
	*height += mul(part, mul(grating->amplitude, texture_sine(phase)));
	*slope = real3_add(*slope, real3_scale(grating->slope,
					       mul(part, texture_sine(phase + PHASE_QUARTER))));
}

/* Changes the load and gives the force along the surface. */
static inline struct real3 texture_force(const struct phantom_float_job *job,
					 const struct float_texture *table, struct surface *surface)
{
	struct real3 u = surface->direction, slope = {0, 0, 0};
	real amplitude = 0, height = 0, rise, rising, depth, load;
	s32 foot_nm[3];
	u32 m;

	nm_offset(job->tip_nm, real3_scale(u, -surface->raised), foot_nm);
	for (m = 0; m < surface->materials; m++) {
		real weight = surface->weight[m];

		if (!(weight > 0) || !(table[m].amplitude > 0))
			continue;
		amplitude += mul(weight, table[m].amplitude);
		texture_grating(job, &table[m].grating[0], foot_nm, weight, &height, &slope);
		texture_grating(job, &table[m].grating[1], foot_nm, weight, &height, &slope);
	}
	depth = surface->depth + 2 * amplitude;
	if (!(amplitude > 0) || !(surface->depth > 0))
		return (struct real3){0, 0, 0};
	rise = divide(surface->depth, depth); /* g */
	rising = mul(divide(2 * amplitude, depth), divide(height, depth)); /* g' h */
	load = mul(surface->load, REAL(1) + divide(height, depth)); /* k q */
	slope = real3_sub(slope, real3_scale(u, real3_dot(slope, u)));
	surface->load = mul(load, REAL(1) + rising);
	return real3_scale(slope, -mul(load, rise));
}

#endif /* PHANTOM_FLOAT_TEXTURE_H */
