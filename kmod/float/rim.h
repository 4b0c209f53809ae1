/* SPDX-License-Identifier: GPL-2.0-only */
/*
 * rim.h - open surfaces: the force fades before the rim.
 *
 * Where an open surface ends so do the shells over it, and a tip that slides off would lose its whole
 * force at once. So each contact is multiplied by
 *
 *   f = clamp(|D - nearest rim| / R, 0, 1)
 *
 * D its foot (V, when inside) and R its contact radius. D moves as the tip does, f with D by at most
 * 1 / R per mm, and at the rim f = 0: the force stays continuous. Damping fades with it.
 *
 * Only rims of D's own surface count (phantom_patch.surface): one that lies over another's rim is not
 * touched by it. Where f = 1 it changes no bit, so it does not matter which farther rims are in a set.
 *
 * The least squared distance is taken before its root: the least of a number of reals is the same in
 * any order, hence at any width.
 */
#ifndef PHANTOM_FLOAT_RIM_H
#define PHANTOM_FLOAT_RIM_H

#include "combine.h"

_Static_assert(sizeof(struct rim_block) <= sizeof(struct block),
	       "section_set_bytes() counts on it");

/* The square of the distance from the foot, at + way, to the nearest rim of that surface, mm^2. */
LANES_NOINLINE real rim_distance2(const struct phantom_float_set *set, u32 surface,
				  const s32 at_nm[3], struct real3 way)
{
	const struct rim_block *rims = set_rims(set);
	const nm_lanes own = nm_all((s32)surface);
	struct nm_point at = nm_point(at_nm);
	struct lanes3 foot = lanes3_all(way);
	lanes least = lanes_all(REAL_MOST);
	real nearest = REAL_MOST;
	u32 i, step, l;

	for (i = 0; i < set->rim_block_count; i++) {
		for (step = 0; step < PHANTOM_STEPS; step++) {
			struct lanes3 u = row3_step(&rims[i].along, step), q, away;
			lanes t, distance2;

			q.x = nm_difference(at.axis[0], rims[i].from[0][step]) + foot.x;
			q.y = nm_difference(at.axis[1], rims[i].from[1][step]) + foot.y;
			q.z = nm_difference(at.axis[2], rims[i].from[2][step]) + foot.z;
			t = lanes_min(lanes_max(lanes3_dot(u, q), lanes_all(0)),
				      rims[i].length[step]);
			away = lanes3_sub(q, lanes3_scale(u, t));
			distance2 = lanes_min(lanes3_dot(away, away), least);
			least = lanes_select(rims[i].surface[step] == own, distance2, least);
		}
	}
	for (l = 0; l < PHANTOM_LANES; l++)
		nearest = real_min(nearest, least[l]);
	return nearest;
}

/* f of a contact with that patch, whose foot is at + way (nm, mm). */
static inline real rim_fade(const struct phantom_float_set *set, u32 patch, const s32 at_nm[3],
			    struct real3 way)
{
	const struct block *block = &set->blocks[patch / PHANTOM_BLOCK];
	u32 lane = patch % PHANTOM_BLOCK, surface = block->surface[lane];
	real distance;

	if (!set->rim_block_count || !surface)
		return REAL(1);
	distance = real_sqrt(rim_distance2(set, surface, at_nm, way));
	return real_min(REAL(1), divide(distance, row_lane(block->radius, lane)));
}

/* The force inside, V on that patch. */
static inline void rim_fade_held(const struct phantom_float_set *set, u32 patch,
				 const s32 proxy_nm[3], struct contact_force *out)
{
	real fade = rim_fade(set, patch, proxy_nm, (struct real3){0, 0, 0});

	out->force = real3_scale(out->force, fade);
	out->damping = mul(out->damping, fade);
}

#endif /* PHANTOM_FLOAT_RIM_H */
