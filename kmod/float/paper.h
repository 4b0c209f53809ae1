/* SPDX-License-Identifier: GPL-2.0-only */
/*
 * paper.h - model `paper`: Kabelac 2001, Algorithm 1, for the patches of one step.
 *
 *   d = g . (P - x0)                                  skip unless 0 < d < R
 *   for each edge e from x_i, with q = P - x_i:
 *     t  = clamp(e . q / |e|^2, 0, 1)
 *     n' = m_i + t (m_(i+1) - m_i)                    n_i = n' / |n'|
 *     w' = n' x e / |e|                               w_i = w' / |w'|, points inward
 *     d_i = w_i . (q - t e)                           skip if any d_i < 0
 *   n  = n_0 d_1 d_2 + n_1 d_0 d_2 + n_2 d_0 d_1, normalised
 *   c  = g . n, |DP| = d / c                          skip unless c > 0 and |DP| < R
 *   s  = k (R - |DP|) n
 *
 * Departures from the print, each with its reason:
 *  - n_i enters with d_i |n'| in place of d_i, which is the same direction without a division.
 *  - The d_i are divided by their maximum first, and one below VANISHING of it is 0: no product
 *    underflows. Where two vanish (the tip above a vertex) all three products would be 0; the
 *    limit is that vertex's normal, taken by weighting with (d_i == 0).
 *  - The tests d > 0 and d_i >= 0 give way by rounding_mm(): a tip on a plane or on a wall is in
 *    contact with every patch that meets there. The combination never adds beyond max |s|.
 *  - c > 0 is c > GRAZING: the VCP of a smaller c would lie anywhere in the plane.
 */
#ifndef PHANTOM_FLOAT_PAPER_H
#define PHANTOM_FLOAT_PAPER_H

#include "block.h"

/* Relative to the largest wall distance; its square is still a normal float32. */
#define VANISHING REAL_VANISHING

/* In units of rounding_mm(): walls give way by one, at a sharp corner several times that. */
#define PAPER_MARGIN 64

/* Cosine between n and g. */
#define GRAZING REAL(1e-4)

/* P - B, for the distance from a wall, which stands across e: what q has along e counts for nothing. */
LANES_INLINE struct lanes3 beyond_foot(struct lanes3 q, struct lanes3 along, lanes t)
{
#ifdef PHANTOM_REAL_FIXED
	/* and adds nothing to what is off: sums are as precise as small ones */
	(void)along;
	(void)t;
	return q;
#else
	return lanes3_sub(q, lanes3_scale(along, t));
#endif
}

LANES_INLINE struct paper_wall paper_wall(const struct paper_edge *edge, u32 step, struct lanes3 q)
{
	struct lanes3 along = row3_step(&edge->along, step);
	lanes t = mul(lanes3_dot_small(along, q), edge->inverse_length2[step]);
	struct paper_wall out;
	struct lanes3 wall;

	t = lanes_min(lanes_max(t, lanes_all(0)), lanes_all(REAL(1)));
	out.normal = lanes3_add(row3_step(&edge->normal, step),
				lanes3_scale_small(row3_step(&edge->normal_along, step), t));
	wall = lanes3_add(row3_step(&edge->wall, step),
			  lanes3_scale_small(row3_step(&edge->wall_along, step), t));
	out.distance = mul(
		lanes3_dot_small(wall, beyond_foot(q, along, t)),
		lanes_root_of_ratio(lanes3_dot_small(out.normal, out.normal),
				    lanes_max(lanes3_dot_small(wall, wall), lanes_all(REAL_TINY))));
	return out;
}

/* n (of any length) from the three walls; distances are not negative. */
LANES_INLINE struct lanes3 paper_normal(const struct paper_wall wall[3])
{
	const lanes zero = lanes_all(0), one = lanes_all(REAL(1));
	lanes d[3] = {wall[0].distance, wall[1].distance, wall[2].distance}, weight[3];
	mask_lanes vanished;
	struct lanes3 n;
	u32 i;

	lanes_bring_to_one(&d[0], &d[1], &d[2]);
	for (i = 0; i < 3; i++)
		d[i] = lanes_keep(d[i] >= VANISHING, d[i]);
	weight[0] = mul_small(d[1], d[2]);
	weight[1] = mul_small(d[0], d[2]);
	weight[2] = mul_small(d[0], d[1]);
	vanished = (weight[0] == zero) & (weight[1] == zero) & (weight[2] == zero);
	for (i = 0; i < 3; i++)
		weight[i] = lanes_select(vanished, lanes_keep(d[i] == zero, one), weight[i]);
	n.x = mul_sum_small(wall[0].normal.x, weight[0], wall[1].normal.x, weight[1],
			    wall[2].normal.x, weight[2]);
	n.y = mul_sum_small(wall[0].normal.y, weight[0], wall[1].normal.y, weight[1],
			    wall[2].normal.y, weight[2]);
	n.z = mul_sum_small(wall[0].normal.z, weight[0], wall[1].normal.z, weight[1],
			    wall[2].normal.z, weight[2]);
	return n;
}

/* Lanes of a step within reach of the shell: a cheap test that rules out most of a set. */
LANES_INLINE mask_lanes shell_candidates(const struct block *block, u32 step, struct lanes3 q,
					 lanes height, real rounding)
{
	lanes radius = block->radius[step];

	return (height > -rounding) & (height < radius) &
	       within_shell(block, step, q, height, block->lean_paper[step], true,
			    lanes_all(PAPER_MARGIN * rounding));
}

static inline void paper_near(const struct block *block, const struct nm_point *tip, real rounding,
			      struct near_steps *near)
{
	u32 step;

	near->steps = 0;
	for (step = 0; step < PHANTOM_STEPS; step++) {
		struct lanes3 q = from_corner(block, step, 0, tip);
		lanes height = lanes3_dot_small(row3_step(&block->face_normal, step), q);

		near_add(near, step, shell_candidates(block, step, q, height, rounding), height);
	}
}

/*
 * First of two stages: the walls, of the patches of the mask, which are `height` over their planes.
 * False if the tip is outside one of each of them.
 */
static inline bool paper_walls(const struct block *block, u32 step, const struct nm_point *tip,
			       lanes height, mask_lanes contact, real rounding,
			       struct paper_step *out)
{
	struct lanes3 q = from_corner(block, step, 0, tip);
	u32 i;

	/* one lane after the other leaves early, and the compiler does not unroll that by itself */
#pragma GCC unroll 3
	for (i = 0; i < 3; i++) {
		struct paper_wall *wall = &out->wall[i];

		if (i)
			q = from_next_corner(block, step, i, tip, q);
		*wall = paper_wall(&block->edge[i], step, q);
		contact &= wall->distance >= -rounding;
		if (PHANTOM_LANES == 1 && !mask_bits(contact))
			return false;
		wall->distance = lanes_max(wall->distance, lanes_all(0));
	}
	out->contact = contact;
	out->height = height;
	return mask_bits(contact);
}

/*
 * The second stage: fills `out` and returns true if any patch of the step is in contact. `out` is
 * valid in the lanes of out->contact only.
 */
static inline bool paper_contact(const struct block *block, u32 step, struct paper_step *out)
{
	struct lanes3 n = lanes3_unit(paper_normal(out->wall));
	lanes cosine = lanes3_dot_small(row3_step(&block->face_normal, step), n);
	lanes radius = block->radius[step];
	mask_lanes contact = out->contact & (cosine > GRAZING);

	/* under the plane by rounding is on it: a small cosine would make a length of that */
	out->length =
		divide(lanes_max(out->height, lanes_all(0)), lanes_max(cosine, lanes_all(GRAZING)));
	contact &= out->length < radius;
	if (!mask_bits(contact))
		return false;
	out->contact = contact;
	/* 0 elsewhere: those lanes take part in sums, and may hold what is no number */
	out->normal.x = lanes_keep(contact, n.x);
	out->normal.y = lanes_keep(contact, n.y);
	out->normal.z = lanes_keep(contact, n.z);
	out->magnitude = lanes_keep(
		contact, lanes_limit_force(mul(block->stiffness[step], radius - out->length)));
	out->planes = false;
	return true;
}

/* The same, of all patches of a step. */
static inline bool paper_evaluate(const struct block *block, u32 step, const struct nm_point *tip,
				  real rounding, struct paper_step *out)
{
	struct lanes3 q = from_corner(block, step, 0, tip);
	lanes height = lanes3_dot_small(row3_step(&block->face_normal, step), q);
	mask_lanes near = shell_candidates(block, step, q, height, rounding);

	return mask_bits(near) && paper_walls(block, step, tip, height, near, rounding, out) &&
	       paper_contact(block, step, out);
}

#endif /* PHANTOM_FLOAT_PAPER_H */
