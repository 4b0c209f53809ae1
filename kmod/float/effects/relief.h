/* SPDX-License-Identifier: GPL-2.0-only */
/*
 * relief.h - the law of a surface with a relief, PHANTOM_EFFECT_TEXTURE and PHANTOM_EFFECT_HEIGHT_MAP.
 *
 *   h    height of the relief at the contact's foot x, mm: texture.h and height_map.h, added up
 *   q    = p + g(p) h,   g(p) = p / (p + 2 A)      A the most that |h| may be; depth in the relief
 *   F    = k q ((1 + g'(p) h) u - g(p) grad h)     grad along the surface
 *
 * F is the gradient of k q^2 / 2, the contact's own energy at the relief's depth (the bump mapping of
 * Ho, Basdogan & Srinivasan 1999, made conservative): on a flat surface no energy is made, on a curved
 * one of curvature c some c A of it. g lets the relief rise with p, so that F is continuous where contact
 * begins, and keeps q between p/2 and 3p/2: |F| <= 3/2 N sqrt(9/4 + slope^2), each of both adds 1 at most.
 * What a band limit fades takes at most k q^2 / 2 with it.
 *
 * x is a place in the scene to the nm, so the set that it is told in does not matter; between materials h
 * is mixed.
 */
#ifndef PHANTOM_FLOAT_RELIEF_H
#define PHANTOM_FLOAT_RELIEF_H

#include "surface.h"

struct relief {
	real amplitude; /* A, mm */
	real height; /* h, mm */
	struct real3 slope; /* grad h, its part along u included */
};

/* The contact's foot: x relative to the set's origin. */
static inline void relief_foot(const struct phantom_float_job *job, const struct surface *surface,
			       s32 foot_nm[3])
{
	nm_offset(job->tip_nm, real3_scale(surface->direction, -surface->raised), foot_nm);
}

/* Changes the load and gives the force along the surface. */
static inline struct real3 relief_force(const struct relief *relief, struct surface *surface)
{
	struct real3 u = surface->direction, slope;
	real depth = surface->depth + 2 * relief->amplitude, rise, rising, load;

	if (!(relief->amplitude > 0) || !(surface->depth > 0))
		return (struct real3){0, 0, 0};
	rise = divide(surface->depth, depth); /* g */
	/* g' h */
	rising = mul(divide(2 * relief->amplitude, depth), divide(relief->height, depth));
	/* k q */
	load = mul(surface->load, REAL(1) + divide(relief->height, depth));
	slope = real3_sub(relief->slope, real3_scale(u, real3_dot(relief->slope, u)));
	surface->load = mul(load, REAL(1) + rising);
	return real3_scale(slope, -mul(load, rise));
}

#endif /* PHANTOM_FLOAT_RELIEF_H */
