/* SPDX-License-Identifier: GPL-2.0-only */
/*
 * constrained.h - below the surface with proxy=constrained: when the state is `inside`, and the
 * force there. V goes down the surface as walk.h says.
 *
 *   outside: path P0 P1 crosses a face inward at X  -> V = X, V walks
 *              P1 over the surface at V               -> a ridge was clipped: the next crossing
 *              else                                   -> inside
 *   inside:  V walks
 *              P1 over the surface at V               -> outside; then P0 P1 as above, from where
 *                                                        it crossed a face outward for the last time
 *   force inside: F = k (R n(V) + (V - P1))
 *
 * What counts is V's own sheet: a tip pushed through a plate is in front of its back and still
 * inside, held by the front. So the state is decided each tick anew by where P1 is, not by adding up
 * crossings: no crossing that rounding lost or invented stays in it.
 *
 * "Over the surface at V": with w = P1 - V, on a face g . w >= 0. Where V lies on an edge it may be
 * over one face and under the other; the one with the larger |g . w| decides. (V is nearest to P1,
 * so w = a g_0 + b g_1 with a, b of one sign, the side's; g_0 . w = a + b c, g_1 . w = a c + b.) At a
 * vertex the two faces that decide are those of the edge nearest to w: from there on w's side no
 * face lies between. Held by several surfaces the tip is over them when it is over each.
 *
 * n(V) is the model's normal at V, interpolated: continuous from face to face where the faces share
 * the normals. Where they do not (a crease, V in its bottom, or two surfaces that hold V), it is
 * a n_0 + b n_1 with w = -(a g_0 + b g_1), which goes from n_0 to n_1 as P1 goes from under the one
 * face to under the other; and where more than two meet, w's own direction, which flat faces give.
 */
#ifndef PHANTOM_FLOAT_CONSTRAINED_H
#define PHANTOM_FLOAT_CONSTRAINED_H

#include "penetration.h"
#include "walk.h"

/* Crossings of one tick's path that are looked at: fine ridges, passed over fast. */
#define CONSTRAINED_CROSSINGS_MAX 4

/* Faces round a vertex whose normals at it are compared. */
#define CONSTRAINED_RING_MAX 12

/* Normals at one point that differ by less than that are the same. */
#define CONSTRAINED_SAME_NORMAL REAL(1e-3)

/* Does the set promise that V's surroundings are in it? */
static inline bool constrained_covered(const struct phantom_float_job *job)
{
	struct real3 away = nm_way(job->centre_nm, job->proxy_nm);

	return real3_length(away) < real_from_nm(job->radius_nm);
}

/* The largest cosine between w and an edge of that patch that ends at the vertex. */
static inline real constrained_towards(const struct block *block, u32 lane, u32 vertex,
				       struct real3 w)
{
	real most = -REAL_MOST;
	u32 i;

	for (i = 0; i < 3; i++) {
		const struct paper_edge *edge = &block->edge[i];
		real along = mul(real3_dot(row3_lane(&edge->along, lane), w),
				 real_sqrt(row_lane(edge->inverse_length2, lane)));

		if (block->vertex[i][lane] == vertex)
			most = real_max(most, along);
		else if (block->vertex[(i + 1) % 3][lane] == vertex)
			most = real_max(most, -along);
	}
	return most;
}

/* Is the tip over the surface at V, on it included? Rows of the comment above. */
static inline bool constrained_over(const struct walk *walk)
{
	const struct phantom_float_set *set = walk->job->set;
	struct real3 w = real3_scale(walk->way, REAL(-1));
	real towards = -REAL_MOST, height = 0;
	u32 i;

	if (walk->held_count > 1) {
		for (i = 0; i < walk->held_count; i++)
			if (real3_dot(walk_face_normal(walk, walk->held[i]), w) < 0)
				return false;
		return true;
	}
	if (feature_is_face(walk->at)) {
		const struct block *block = &set->blocks[walk->patch / PHANTOM_BLOCK];
		u32 lane = walk->patch % PHANTOM_BLOCK;

		/* as crossing.h takes it, to the last bit */
		return real3_dot(row3_lane(&block->face_normal, lane),
				 from_corner_lane(block, lane, 0, walk->job->tip_nm)) >= 0;
	}
	for (i = 0; i < set->block_count; i++) {
		const struct block *block = &set->blocks[i];
		u32 bits;

		for (bits = ring_bits(block, walk->at); bits; bits &= bits - 1) {
			u32 lane = (u32)__builtin_ctz(bits);
			real h = real3_dot(row3_lane(&block->face_normal, lane), w);
			real t = walk->at.vertex[0] != walk->at.vertex[1]
					 ? 0
					 : constrained_towards(block, lane, walk->at.vertex[0], w);

			if (t < towards || (t == towards && real_abs(h) <= real_abs(height)))
				continue;
			towards = t;
			height = h;
		}
	}
	return height >= 0;
}

/* The patches that hold V: its own first. */
static inline u32 constrained_round(const struct walk *walk, u32 patch[CONSTRAINED_RING_MAX])
{
	const struct phantom_float_set *set = walk->job->set;
	u32 count = 1, i;

	patch[0] = walk->patch;
	if (walk->held_count > 1) {
		for (i = 1; i < walk->held_count; i++)
			patch[count++] = walk->held[i];
		return count;
	}
	if (feature_is_face(walk->at))
		return count;
	for (i = 0; i < set->block_count; i++) {
		u32 bits = ring_bits(&set->blocks[i], walk->at);

		for (; bits && count < CONSTRAINED_RING_MAX; bits &= bits - 1) {
			u32 found = i * PHANTOM_BLOCK + (u32)__builtin_ctz(bits);

			if (found != walk->patch)
				patch[count++] = found;
		}
	}
	return count;
}

/* n(V), of unit length. */
static inline struct real3 constrained_normal(const struct walk *walk)
{
	const struct phantom_float_job *job = walk->job;
	u32 patch[CONSTRAINED_RING_MAX], count = constrained_round(walk, patch), i;
	struct real3 n = penetration_normal(job, patch[0]), sum = n, other = n;
	bool same = true;
	real a, b;

	for (i = 1; i < count; i++) {
		struct real3 away;

		other = penetration_normal(job, patch[i]);
		away = real3_sub(other, n);
		sum = real3_add(sum, other);
		if (real3_dot(away, away) > mul(CONSTRAINED_SAME_NORMAL, CONSTRAINED_SAME_NORMAL))
			same = false;
	}
	if (same)
		return n;
	if (count == 2) {
		struct real3 g0 = walk_face_normal(walk, patch[0]);
		struct real3 g1 = walk_face_normal(walk, patch[1]);
		real c = real3_dot(g0, g1), w0 = real3_dot(g0, walk->way);
		real w1 = real3_dot(g1, walk->way);

		a = real_max(w0 - mul(c, w1), 0);
		b = real_max(w1 - mul(c, w0), 0);
		if (a + b > 0)
			sum = real3_add(real3_scale(n, divide(a, a + b)),
					real3_scale(other, divide(b, a + b)));
	} else if (real3_length(walk->way) > 4 * walk->still) {
		sum = walk->way;
	}
	a = real3_length(sum);
	return a > 0 ? real3_unit(sum) : n;
}

/* The walk is over, and the tip over the surface it ended on. */
static inline bool constrained_leaves(const struct walk *walk)
{
	return walk->settled && constrained_covered(walk->job) && constrained_over(walk);
}

/* Outside: true if the path after `after` of it ends inside. */
static inline bool constrained_enter(struct walk *walk, struct phantom_float_job *job,
				     const struct segment *path, real after)
{
	u32 crossing;

	for (crossing = 0; crossing < CONSTRAINED_CROSSINGS_MAX; crossing++) {
		struct crossing in = crossing_find(job->set, path, CROSSING_INWARD, false, after);

		if (in.patch == PHANTOM_PATCH_NONE)
			break;
		penetration_enter(job, path, in);
		walk_down(walk, job, in.patch);
		if (!constrained_leaves(walk))
			return true;
		after = in.along + divide(CROSSING_APART, path->length);
	}
	penetration_leave(job);
	return false;
}

/* The state after this tick; true if it is inside: `walk` has then led to V. */
static inline bool constrained_settle(struct walk *walk, struct phantom_float_job *job)
{
	struct segment path;
	struct crossing out;
	real after = REAL(-1);

	if (job->inside) {
		u32 patch = penetration_find_patch(job);

		if (patch != PHANTOM_PATCH_NONE) {
			walk_down(walk, job, patch);
			if (!constrained_leaves(walk))
				return true;
		}
		penetration_leave(job);
		if (!job->path_valid || !segment_set(&path, job->previous_nm, job->tip_nm))
			return false;
		out = crossing_find(job->set, &path, CROSSING_OUTWARD, true, REAL(-1));
		if (out.patch != PHANTOM_PATCH_NONE)
			after = out.along + divide(CROSSING_APART, path.length);
	} else if (!job->path_valid || !segment_set(&path, job->previous_nm, job->tip_nm)) {
		return false;
	}
	return constrained_enter(walk, job, &path, after);
}

/* One tick's state; true if it is inside, with the force there. */
LANES_NOINLINE bool constrained_tick(struct phantom_float_job *job, struct contact_force *out)
{
	struct walk walk;

	if (!constrained_settle(&walk, job))
		return false;
	penetration_force(job, walk.patch, constrained_normal(&walk), out);
	return true;
}

#endif /* PHANTOM_FLOAT_CONSTRAINED_H */
