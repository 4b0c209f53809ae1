/* SPDX-License-Identifier: GPL-2.0-only */
/*
 * viscosity.h - effect: viscosity and drag in a region, PHANTOM_EFFECT_VISCOSITY.
 *
 *   F += -w min(b + c |v|, b_max) v
 *   w = s^2 (3 - 2 s),  s = clamp((radius - |P - centre|) / border, 0, 1);  1 everywhere without a radius
 *
 * b viscosity in N per mm/s, c drag in N per (mm/s)^2, v the filtered velocity in mm/s. Regions add up,
 * and b_max holds for their sum. F never points along v: it takes energy. Filtered and sampled, that
 * is true as long as the loop is stable: with the velocity's time constant tau and the period T it is
 * while b < m / (tau + T), m the arm's mass, and somewhat beyond; b_max = PHANTOM_VISCOSITY_MAX_MNS_M
 * keeps 1 kHz stable for arms of 45 g with the factor of three that encoder steps ask for.
 */
#ifndef PHANTOM_FLOAT_VISCOSITY_H
#define PHANTOM_FLOAT_VISCOSITY_H

#include "../crossing.h"
#include "table.h"

/* b_max, N per mm/s */
#define VISCOSITY_MOST REAL(PHANTOM_VISCOSITY_MAX_MNS_M * 1e-6)

/* P - place in mm; the difference is exact. */
static inline struct real3 effect_way(const s64 place_nm[3], const s32 tip_nm[3])
{
	return (struct real3){
		real_from_nm(tip_nm[0] - place_nm[0]),
		real_from_nm(tip_nm[1] - place_nm[1]),
		real_from_nm(tip_nm[2] - place_nm[2]),
	};
}

/* w */
static inline real viscosity_part(const struct float_viscosity *region, const s32 tip_nm[3])
{
	real s;

	if (!(region->radius > 0))
		return REAL(1);
	s = region->radius - real3_length(effect_way(region->centre_nm, tip_nm));
	s = real_clamp(divide(s, region->border), 0, REAL(1));
	return mul(mul(s, s), REAL(3) - 2 * s);
}

static inline struct real3 viscosity_force(const struct float_viscosity *regions, u32 count,
					   const struct phantom_float_job *job)
{
	struct real3 v = {real_from_nm(job->velocity_nm_s[0]), real_from_nm(job->velocity_nm_s[1]),
			  real_from_nm(job->velocity_nm_s[2])};
	real speed = real3_length(v), sum = 0;
	u32 i;

	for (i = 0; i < count; i++)
		sum += mul(viscosity_part(&regions[i], job->tip_nm),
			   real_min(regions[i].viscosity + mul(regions[i].drag, speed),
				    VISCOSITY_MOST));
	return real3_scale(v, -real_min(sum, VISCOSITY_MOST));
}

#endif /* PHANTOM_FLOAT_VISCOSITY_H */
