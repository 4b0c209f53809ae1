/* SPDX-License-Identifier: GPL-2.0-only */
/*
 * projected.h - model `projected`: the tip in the shell over a triangle.
 *
 * Between a triangle and its offset by h along the vertex normals lies a shell; each of its
 * points is P = sum b_i (x_i + h m_i). Neighbours share an edge and its two normals, hence the
 * wall of their shells, so the shells of a mesh leave no gap and N = sum b_i m_i is continuous.
 * With e1 = x1 - x0, e2 = x2 - x0, f1 = m1 - m0, f2 = m2 - m0, q = P - x0:
 *
 *   A(h) = (e1 + h f1) x (e2 + h f2) = A0 + h A1 + h^2 A2
 *   c(h) = (q - h m0) . A(h) = 0
 *   c0 = q.A0   c1 = q.A1 - m0.A0   c2 = q.A2 - m0.A1   c3 = -m0.A2      (all divided by |A0|)
 *
 * A root counts if all b_i >= 0 and 0 < h|N| < R; n = N / |N|, sign s = sign(A.N) = -sign(c'):
 * +1, or -1 where the shell has folded over (concave, R beyond the radius of curvature). Roots
 * come and go in pairs of either sign with the same h and n, or at h|N| = R where the force is 0,
 * so the signed sum is continuous:
 *
 *   S = sum s k (R - h|N|) n        F = S min(1, kR / |S|)
 *
 * Roots. Where c' keeps its sign on [0, H], h = R/|N| <= H, and varies less than MONOTONE_PARTS
 * fold (its Bernstein coefficients say so), there is one root or none, and from -c0/c1 it is found in
 * model.newton_steps steps: the accuracy knob. They are Halley's, a Newton step with the curvature in
 * it: an error of e becomes e^3, not e^2, for the same one division. Elsewhere the interval is split
 * at the critical points and each part that changes sign is solved by Newton kept in its bracket (cubic.h);
 * float32 does that in float64, from the corners on (folded.h).
 *
 * Fans. Over an edge with two normals at an end, and over a vertex with three and more, the shell
 * is that of a triangle whose corners coincide: A0 = 0, and over a vertex A1 = 0 too. Divided by h,
 * or by h^2, A(h) has the same form with the terms moved up by one or two; so has c(h), and its root
 * h = 0 is gone. What follows is the same code with `order` 1 or 2 in place of 0. There is no
 * surface below: h <= 0 is no contact. (The paper's fig. 1: two empty triangles at a fake edge.)
 * The two triangles over an edge are as narrow as h. Beyond the end where such a triangle has only
 * one corner, its two long walls stay within rounding of one another, so a fourth wall stands
 * across that end: (1 - b0) |e| from it.
 *
 * Walls are soft: a root next to one has the weight that window.h gives it. For each wall, with E_i
 * the offset edge, s the sign and w_i the distance from it,
 *
 *   w_i = b_i |A.N| / |N x E_i|        inward: s N x E_i / |N x E_i|
 *
 * which are the same from both sides. The window is a few rounding errors wide (nm).
 */
#ifndef PHANTOM_FLOAT_PROJECTED_H
#define PHANTOM_FLOAT_PROJECTED_H

#include "paper.h"
#include "combine.h"
#include "barycentric.h"
#include "cubic.h"
#include "cubic_fixed.h"
#include "folded.h"
#include "window.h"

/* Roots of the patches of a step: h and sign by [root][lane]; a patch has `count` of them. */
struct step_roots {
	lanes h[PROJECTED_ROOTS], sign[PROJECTED_ROOTS];
	mask_lanes valid[PROJECTED_ROOTS];
	mask_lanes split; /* lanes whose interval was split */
};

/* Where a root lies in its shell. */
struct shell_point {
	mask_lanes accepted;
	struct lanes3 normal; /* n */
	lanes height, magnitude;
	mask_lanes near_wall;
	lanes part[3]; /* b |A.n| of each corner's b */
	lanes beyond; /* 1 - b0 */
};

/* The patches of a step that are monotone: each has one root at most. */
struct usual_roots {
	struct cubic c;
	mask_lanes valid; /* has one */
	mask_lanes split; /* is not monotone */
	lanes sign, h;
};

/* Where the root in [-rounding, H] is by a first guess, of the candidate lanes; false if none has one. */
LANES_INLINE bool guess_roots(const struct block *block, u32 step, mask_lanes candidates,
			      real rounding, struct usual_roots *roots)
{
	const lanes low = lanes_all(-rounding), zero = lanes_all(0);
	lanes high = block->height_limit[step];
	struct cubic c = cubic_tame(block, step, &roots->c);
	/* Bernstein coefficients of c' on [0, H] */
	lanes first = c.c1, middle = c.c1 + mul_small(c.c2, high), last = cubic_slope(&c, high);
	lanes least = lanes_min(lanes_min(first, middle), last);
	lanes most = lanes_max(lanes_max(first, middle), last);
	mask_lanes falling = (most < zero) & (lanes_part(least, MONOTONE_PARTS) >= most);
	mask_lanes rising = (least > zero) & (lanes_part(most, MONOTONE_PARTS) <= least);
	mask_lanes usual = candidates & (falling | rising);

	roots->split = candidates & ~usual;
	roots->valid = usual & cubic_crosses(&c, low, high, first + middle + last);
	if (!mask_bits(roots->valid))
		return false;
	roots->sign = lanes_select(falling, lanes_all(REAL(1)), lanes_all(REAL(-1)));
	roots->h = divide(-c.c0, lanes_select(usual, c.c1, lanes_all(REAL(1))));
	roots->h = lanes_min(lanes_max(roots->h, low), high);
	return true;
}

/* One of Halley's steps. */
LANES_INLINE void improve_roots(const struct block *block, u32 step, real rounding,
				struct usual_roots *roots)
{
	lanes better = roots->h - cubic_correction(&roots->c, roots->h, roots->valid);

	roots->h = lanes_min(lanes_max(better, lanes_all(-rounding)), block->height_limit[step]);
}

#ifndef PHANTOM_REAL_SINGLE
/* The roots of one lane whose interval is split, from `low` on, mm. */
static inline void split_lane(const struct block *block, u32 step, u32 l,
			      const struct nm_point *tip, const struct cubic *c, real low,
			      struct fine_roots *found)
{
	real high = block->height_limit[step][l];
#ifdef PHANTOM_REAL_FIXED
	(void)c;
	exact_roots(block, step, tip, low, high, found);
#else
	struct fine_cubic one = {c->c0[l], c->c1[l], c->c2[l], c->c3[l]};

	(void)tip;
	split_roots(&one, low, high, found);
#endif
}

/* Beside them the roots of the lanes whose interval is split; `rounds` of them are there already. */
static inline u32 find_split_roots(const struct block *block, u32 step, const struct nm_point *tip,
				   const struct cubic *c, real rounding, u32 rounds,
				   struct step_roots *roots)
{
	u32 split = mask_bits(roots->split), l, i;

	for (i = rounds; i < PROJECTED_ROOTS; i++) {
		roots->h[i] = lanes_all(0);
		roots->sign[i] = lanes_all(0);
		roots->valid[i] = (mask_lanes){};
	}
	for (l = 0; l < PHANTOM_LANES; l++) {
		struct fine_roots found;

		if (!(split >> l & 1))
			continue;
		split_lane(block, step, l, tip, c, -rounding, &found);
		for (i = 0; i < found.count; i++) {
			roots->h[i][l] = found.h[i];
			roots->sign[i][l] = found.falling[i] ? REAL(1) : REAL(-1);
			roots->valid[i][l] = -1;
		}
	}
	while (rounds < PROJECTED_ROOTS && mask_bits(roots->valid[rounds]))
		rounds++;
	return rounds;
}
#endif

/*
 * Is the tip where b and h say, which is so far from it? Floating point may be off by as much as
 * FOUND_AGAIN; fixed point is no farther off than the window is wide, and must not be: next to where
 * shells shrink to a point such roots are as near.
 */
LANES_INLINE mask_lanes found_again(struct lanes3 away, lanes radius, real soft)
{
#ifdef PHANTOM_REAL_FIXED
	(void)radius;
	return lanes_max(lanes_max(lanes_abs(away.x), lanes_abs(away.y)), lanes_abs(away.z)) <=
	       lanes_all(soft);
#else
	(void)soft;
	return lanes3_dot(away, away) <=
	       mul(mul(lanes_all(mul(FOUND_AGAIN, FOUND_AGAIN)), radius), radius);
#endif
}

/* Is the root in the shell, and what does it give? `tame`: in fixed point, a patch that is. */
LANES_INLINE void shell_evaluate_as(const struct block *block, u32 step, const struct nm_point *tip,
				    lanes h, mask_lanes valid, mask_lanes split, real rounding,
				    bool fan, bool tame, struct shell_point *out)
{
	const lanes one = lanes_all(REAL(1));
	const real soft = SOFT_WALL * rounding;
	/* A(h) / |A0| */
	struct lanes3 area =
		lanes3_add(row3_step(&block->area1, step),
			   lanes3_scale_known(tame, row3_step(&block->area2, step), h));
	lanes turned, reach, least, radius = block->radius[step];
	lanes power = one; /* h^order */
	lanes b[3];
	struct measured measured;
	struct lanes3 n;
	mask_lanes near_wall;

	area = lanes3_add(row3_step(&block->face_normal, step), lanes3_scale_known(tame, area, h));
	if (fan) {
		power = lanes_select(block->order[step] > REAL(1), mul(h, h), h);
		valid &= h > 0;
	}
	valid = barycentric_solve(block, step, tip, h, area, fan ? &power : NULL, valid, b);
	/* b may be of any size there */
	if (PHANTOM_LANES == 1 && !mask_bits(valid)) {
		out->accepted = valid;
		return;
	}
	/* m0 + b1 (m1 - m0) - b2 (m0 - m2) */
	n = lanes3_add(row3_step(&block->edge[0].normal, step),
		       lanes3_scale_small(row3_step(&block->edge[0].normal_along, step), b[1]));
	n = lanes3_sub(n, lanes3_scale_small(row3_step(&block->edge[2].normal_along, step), b[2]));
	turned = mul(lanes_abs(lanes3_dot(area, n)), block->area[step]);
	if (fan)
		turned = mul(turned, power);
	/* |N x E_i| is at most the length of an offset edge */
	reach = mul_small(lanes_all(2 * soft), block->extent[step] + h + soft);
	least = mul(lanes_min(lanes_min(b[0], b[1]), b[2]), turned);
	valid &= least >= -reach;
	out->accepted = valid;
	if (!mask_bits(valid))
		return;
	if (mask_bits(split)) {
		struct lanes3 away = barycentric_away(block, step, tip, h, b);

		valid &= ~split | found_again(away, radius, soft);
	}
	measured = lanes3_measure(n);
	out->height = mul_small(h, measured.length);
	valid &= (measured.length > 0) & (out->height < radius) & (out->height > -rounding);
	out->accepted = valid;
	if (!mask_bits(valid))
		return;
	out->normal = lanes3_unit_measured(n, &measured, valid);
	out->magnitude = lanes_limit_force(mul(block->stiffness[step], radius - out->height));
	near_wall = valid & (least <= reach);
	out->near_wall = near_wall;
	if (!mask_bits(near_wall))
		return;
	reach = mul(lanes3_length(area), block->area[step]);
	if (fan)
		reach = mul(reach, power);
	turned = lanes_max(turned, mul(reach, lanes_all(IN_PLANE)));
	out->part[0] = divide(mul(b[0], turned), measured.length);
	out->part[1] = divide(mul(b[1], turned), measured.length);
	out->part[2] = divide(mul(b[2], turned), measured.length);
	out->beyond = one - b[0];
}

LANES_NOINLINE void shell_evaluate(const struct block *block, u32 step, const struct nm_point *tip,
				   lanes h, mask_lanes valid, mask_lanes split, real rounding,
				   bool fan, struct shell_point *out)
{
	/* roots of others are found by splitting */
	if (PHANTOM_LANES == 1 && !mask_bits(split))
		shell_evaluate_as(block, step, tip, h, valid, split, rounding, fan, true, out);
	else
		shell_evaluate_as(block, step, tip, h, valid, split, rounding, fan, false, out);
}

/* The part of the window that a root next to a wall has. */
LANES_NOINLINE real shell_weight(const struct block *block, u32 lane, const struct shell_point *at,
				 real h, real sign, real soft, bool fan)
{
	u32 l = lane % PHANTOM_LANES, count = 0, i;
	struct real3 n = lanes3_lane(at->normal, l), x, y;
	struct window_wall wall[WINDOW_WALLS];

	window_axes(n, &x, &y);
	for (i = 0; i < 3; i++) {
		const struct paper_edge *edge = &block->edge[i];
		struct real3 across = real3_cross(
			n, real3_add(row3_lane(&edge->along, lane),
				     real3_scale(row3_lane(&edge->normal_along, lane), h)));
		real length = real_max(real3_length(across), REAL_TINY);
		struct real3 inward = real3_scale(real3_unit(across), sign);

		/* edge i lies opposite to corner i + 2 */
		wall[count].distance = divide(divide(at->part[(i + 2) % 3][l], length), soft);
		wall[count].inward.x = real3_dot(inward, x);
		wall[count++].inward.y = real3_dot(inward, y);
	}
	if (fan && row_lane(block->order, lane) < REAL(2)) {
		struct real3 along = row3_lane(&block->edge[0].along, lane);
		struct real3 inward = real3_unit(along);

		wall[count].distance = divide(mul(at->beyond[l], real3_length(along)), soft);
		wall[count].inward.x = real3_dot(inward, x);
		wall[count++].inward.y = real3_dot(inward, y);
	}
	return window_part(wall, count);
}

/* A monotone cubic has one root; split ones are worked on with the others but in float32, see folded.h. */
#ifdef PHANTOM_REAL_SINGLE
#define PROJECTED_ROUNDS 1
#else
#define PROJECTED_ROUNDS PROJECTED_ROOTS
#endif

static inline void projected_near(const struct block *block, const struct nm_point *tip,
				  real rounding, u32 newton_steps, struct near_steps *near)
{
	const lanes margin = lanes_all(4 * SOFT_WALL * rounding);
	u32 step;

	near->steps = 0;
	for (step = 0; step < PHANTOM_STEPS; step++) {
		struct lanes3 q = from_corner(block, step, 0, tip);
		lanes height = lanes3_dot_small(row3_step(&block->face_normal, step), q);

		/* a first guess alone, without a step, may take a tip beside the shell for one in it */
		near_add(near, step,
			 (lanes_abs(height) < block->radius[step]) &
				 within_shell(block, step, q, height, block->lean[step],
					      newton_steps > 0, margin),
			 height);
	}
}

/*
 * Appends the roots over the patches of a step to `list`, patch by patch; returns how many. `found`: of
 * those that are monotone there are any.
 */
static inline u32 projected_step(const struct block *block, u32 step, const struct nm_point *tip,
				 real rounding, u32 first_patch, bool fan,
				 const struct usual_roots *usual, bool found,
				 struct projected_root *list)
{
	const real soft = SOFT_WALL * rounding;
	struct shell_point point[PROJECTED_ROUNDS];
	struct step_roots roots;
	u32 rounds = found, split = mask_bits(usual->split), any = 0, count = 0, i;

	if (found) {
		roots.h[0] = usual->h;
		roots.sign[0] = usual->sign;
		roots.valid[0] = usual->valid;
	}
	roots.split = usual->split;
#ifndef PHANTOM_REAL_SINGLE
	if (split)
		rounds = find_split_roots(block, step, tip, &usual->c, rounding, rounds, &roots);
	split = 0;
#endif
	for (i = 0; i < rounds; i++) {
		shell_evaluate(block, step, tip, roots.h[i], roots.valid[i], roots.split, rounding,
			       fan, &point[i]);
		any |= mask_bits(point[i].accepted);
	}
	for (any |= split; any; any &= any - 1) {
		u32 l = (u32)__builtin_ctz(any), lane = step * PHANTOM_LANES + l;

#ifdef PHANTOM_REAL_SINGLE
		if (split >> l & 1) {
			count += folded_roots(block, lane, tip, rounding, first_patch + l,
					      &list[count]);
			continue;
		}
#endif
		for (i = 0; i < rounds; i++) {
			struct projected_root *root = &list[count];

			if (!point[i].accepted[l])
				continue;
			root->normal = lanes3_lane(point[i].normal, l);
			root->height = point[i].height[l];
			root->magnitude = point[i].magnitude[l];
			root->sign = roots.sign[i][l];
			root->weight = REAL(1);
			root->patch = first_patch + l;
			if (point[i].near_wall[l])
				root->weight = shell_weight(block, lane, &point[i], roots.h[i][l],
							    roots.sign[i][l], soft, fan);
			count += root->weight > 0;
		}
	}
	return count;
}

/*
 * The roots over a block, patch by patch; returns how many. Adds up the patches whose interval is split.
 *
 * Each stage is done for all steps before the next one: within a stage they do not wait for one another,
 * from one to the next they do.
 */
static inline u32 projected_block(const struct phantom_float_set *set, u32 index,
				  const struct nm_point *tip, u32 newton_steps,
				  struct projected_root *list, u32 *splits)
{
	const struct block *block = &set->blocks[index];
	const real rounding = rounding_mm(set);
	struct usual_roots roots[PHANTOM_STEPS];
	struct near_steps near;
	u32 found = 0, count = 0, left, step, i;

	projected_near(block, tip, rounding, newton_steps, &near);
	for (left = near.steps; left; left &= left - 1) {
		step = (u32)__builtin_ctz(left);
		roots[step].c = shell_cubic(block, step, from_corner(block, step, 0, tip),
					    near.height[step]);
		found |= (u32)guess_roots(block, step, near.mask[step], rounding, &roots[step])
			 << step;
		*splits += mask_count(roots[step].split);
	}
	for (i = 0; i < newton_steps; i++)
		for (left = found; left; left &= left - 1) {
			step = (u32)__builtin_ctz(left);
			improve_roots(block, step, rounding, &roots[step]);
		}
	for (left = near.steps; left; left &= left - 1) {
		step = (u32)__builtin_ctz(left);
		count += projected_step(
			block, step, tip, rounding, index * PHANTOM_BLOCK + step * PHANTOM_LANES,
			index >= set->block_count, &roots[step], found >> step & 1, &list[count]);
	}
	return count;
}

#endif /* PHANTOM_FLOAT_PROJECTED_H */
