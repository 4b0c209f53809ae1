/* SPDX-License-Identifier: GPL-2.0-only */
/*
 * guide.h - effect: springs and guides, PHANTOM_EFFECT_GUIDE: to a point, a line, a plane.
 *
 *   e  = the way from the tip to the nearest place of the guide, |e| its distance
 *   F += e/|e| min(k |e|, f) r,  r = clamp(4 (1 - |e| / reach), 0, 1), or 1 without a reach
 *
 * k N/mm, f the most it pulls, N. F is a function of the distance alone: a potential, continuous with
 * its border (r = 0 at the reach), no energy is made. It pulls with f at most however far the tip is. A
 * spring has no damping of its own: name viscosity where the arm has too little. In a sampled loop
 * k counts as any stiffness: k T / 2 < the arm's damping.
 */
#ifndef PHANTOM_FLOAT_GUIDE_H
#define PHANTOM_FLOAT_GUIDE_H

#include "viscosity.h"

static inline struct real3 guide_one(const struct float_guide *guide, const s32 tip_nm[3])
{
	struct real3 away = effect_way(guide->point_nm, tip_nm);
	struct real3 along = real3_scale(guide->direction, real3_dot(away, guide->direction));
	real distance, pull, part = REAL(1);

	if (guide->kind == PHANTOM_GUIDE_LINE)
		away = real3_sub(away, along);
	else if (guide->kind == PHANTOM_GUIDE_PLANE)
		away = along;
	distance = real3_length(away);
	pull = real_min(mul(guide->stiffness, distance), guide->most);
	if (guide->reach > 0)
		part = real_clamp(4 * (REAL(1) - divide(distance, guide->reach)), 0, REAL(1));
	return real3_scale(real3_unit(away), -mul(pull, part));
}

static inline struct real3 guide_force(const struct float_guide *guides, u32 count,
				       const s32 tip_nm[3])
{
	struct real3 sum = {0, 0, 0};
	u32 i;

	for (i = 0; i < count; i++)
		sum = real3_add(sum, guide_one(&guides[i], tip_nm));
	return sum;
}

#endif /* PHANTOM_FLOAT_GUIDE_H */
