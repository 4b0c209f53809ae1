/* SPDX-License-Identifier: GPL-2.0-only */
/*
 * overlap.h - `paper`: drops a contact whose open segment D-P is crossed by the triangle of
 * another contact: that triangle stands between the tip and the point it is pushed from.
 *
 * All segments share P, so the plane through P and each edge of a triangle is formed once, when a
 * segment first meets the triangle's plane; a pair then costs four dot products. Crossings within
 * OVERLAP_ENDS of the segment's ends do not count, nor do triangles that share the edge or vertex on
 * which D lies (D lies on them as well).
 */
#ifndef PHANTOM_FLOAT_OVERLAP_H
#define PHANTOM_FLOAT_OVERLAP_H

#include "paper.h"

/* Of the segment's length. */
#define OVERLAP_ENDS REAL(1e-6)

/* The planes through the tip and the edges of a step's triangles. */
LANES_NOINLINE void overlap_planes(const struct phantom_float_set *set, struct paper_step *at,
				   const struct nm_point *tip)
{
	const struct block *block = &set->blocks[at->block];
	struct lanes3 q = from_corner(block, at->step, 0, tip);
	u32 i;

	for (i = 0; i < 3; i++) {
		if (i)
			q = from_next_corner(block, at->step, i, tip, q);
		/* (x_i - P) x (x_(i+1) - P) = e x q */
		at->plane[i] = lanes3_cross_small(row3_step(&block->edge[i].along, at->step), q);
	}
	at->planes = true;
}

/* Lanes of `at` whose triangle is crossed by the open segment from the tip along `way` (D - P). */
LANES_INLINE mask_lanes overlap_crossed(const struct phantom_float_set *set, struct paper_step *at,
					const struct nm_point *tip, struct lanes3 way)
{
	const struct block *block = &set->blocks[at->block];
	/* the plane of the triangle is met at d / -(g . way) of the segment */
	lanes down = -lanes3_dot_small(row3_step(&block->face_normal, at->step), way);
	mask_lanes met = (at->height > mul_small(lanes_all(OVERLAP_ENDS), down)) &
			 (at->height < mul_small(lanes_all(REAL(1) - OVERLAP_ENDS), down)) &
			 at->contact;
	lanes u, v, w, low, high;

	if (!mask_bits(met))
		return met;
	if (!at->planes)
		overlap_planes(set, at, tip);
	u = lanes3_dot(at->plane[0], way);
	v = lanes3_dot(at->plane[1], way);
	w = lanes3_dot(at->plane[2], way);
	low = lanes_min(lanes_min(u, v), w);
	high = lanes_max(lanes_max(u, v), w);

	return ((low >= 0) | (high <= 0)) & met;
}

/* The edges of its triangle on which D lies, as bits 0 ... 2. */
static inline u32 overlap_edges_of_foot(const struct block *block, u32 lane, struct real3 foot,
					real rounding)
{
	struct real3 g = row3_lane(&block->face_normal, lane);
	struct real3 from[3];
	u32 i, edges = 0;

	from[0] = foot;
	from[1] = real3_sub(from[0], row3_lane(&block->edge[0].along, lane));
	from[2] = real3_sub(from[1], row3_lane(&block->edge[1].along, lane));
	for (i = 0; i < 3; i++) {
		struct real3 e = row3_lane(&block->edge[i].along, lane);
		real away = real3_dot(real3_cross(g, e), from[i]);

		if (mul(away, away) <= mul(mul(rounding, rounding), real3_dot(e, e)))
			edges |= 1U << i;
	}
	return edges;
}

static inline bool overlap_has_vertex(const struct block *block, u32 lane, u32 vertex)
{
	return block->vertex[0][lane] == vertex || block->vertex[1][lane] == vertex ||
	       block->vertex[2][lane] == vertex;
}

/* Do they have a vertex in common? */
static inline bool overlap_touches(const struct block *own, u32 own_lane, const struct block *other,
				   u32 other_lane)
{
	return overlap_has_vertex(other, other_lane, own->vertex[0][own_lane]) ||
	       overlap_has_vertex(other, other_lane, own->vertex[1][own_lane]) ||
	       overlap_has_vertex(other, other_lane, own->vertex[2][own_lane]);
}

/* Does the other patch share the edge or vertex on which the foot lies? */
static inline bool overlap_shares(const struct block *own, u32 own_lane, u32 edges,
				  const struct block *other, u32 other_lane)
{
	u32 i;

	for (i = 0; i < 3; i++) {
		u32 next = (i + 1) % 3, previous = (i + 2) % 3;
		bool a = overlap_has_vertex(other, other_lane, own->vertex[i][own_lane]);
		bool b = overlap_has_vertex(other, other_lane, own->vertex[next][own_lane]);

		if ((edges >> i & 1) && a && b)
			return true;
		/* corner i: where edges i and i - 1 meet */
		if ((edges >> i & 1) && (edges >> previous & 1) && a)
			return true;
	}
	return false;
}

/* Is the contact of that lane crossed by the triangle of any other? */
static inline bool overlap_dropped(const struct phantom_float_set *set, struct paper_step *steps,
				   u32 count, const struct paper_step *own, u32 lane,
				   const struct nm_point *tip)
{
	const struct block *block = &set->blocks[own->block];
	u32 own_lane = own->step * PHANTOM_LANES + lane;
	struct real3 way = real3_scale(lanes3_lane(own->normal, lane), -own->length[lane]);
	struct lanes3 ways = lanes3_all(way);
	u32 edges = 0;
	bool edges_known = false;
	u32 i, l;

	for (i = 0; i < count; i++) {
		u32 crossed = mask_bits(overlap_crossed(set, &steps[i], tip, ways));

		if (&steps[i] == own)
			crossed &= ~(1U << lane);
		for (l = 0; crossed >> l; l++) {
			const struct block *other = &set->blocks[steps[i].block];
			u32 other_lane = steps[i].step * PHANTOM_LANES + l;

			if (!(crossed >> l & 1))
				continue;
			/* wherever D lies */
			if (!overlap_touches(block, own_lane, other, other_lane))
				return true;
			if (!edges_known) {
				struct real3 q =
					lanes3_lane(from_corner(block, own->step, 0, tip), lane);

				edges = overlap_edges_of_foot(block, own_lane, real3_add(q, way),
							      rounding_mm(set));
				edges_known = true;
			}
			if (!overlap_shares(block, own_lane, edges, other, other_lane))
				return true;
		}
	}
	return false;
}

#endif /* PHANTOM_FLOAT_OVERLAP_H */
