/* SPDX-License-Identifier: GPL-2.0-only */
/*
 * nearest.h - the point of a triangle nearest to the tip, for the patches of one step.
 *
 *   with q_i = P - x_i, e_i the edge from x_i, g the face normal
 *   over the face:  (g x e_i) . q_i >= 0 for all i      nearest - P = -(g . q_0) g
 *   else on edge i: t = clamp(e_i . q_i / |e_i|^2, 0, 1)  nearest - P = t e_i - q_i, of the shortest
 *
 * A triangle is convex: on the straight way from any of its points to the nearest one the distance
 * falls all along, and its square by at least that way's. So a way says what a difference of two
 * distances would lose in rounding.
 */
#ifndef PHANTOM_FLOAT_NEAREST_H
#define PHANTOM_FLOAT_NEAREST_H

#include "ring.h"

/* The nearest points of the patches of one step. */
struct nearest_step {
	struct lanes3 way; /* from the tip to the point, mm */
	lanes edge; /* 0, 1, 2; -1 over the face */
	lanes along; /* t on that edge */
};

static inline void nearest_evaluate(const struct block *block, u32 step, const struct nm_point *tip,
				    struct nearest_step *out)
{
	struct lanes3 g = row3_step(&block->face_normal, step);
	struct lanes3 q = from_corner(block, step, 0, tip);
	lanes height = lanes3_dot(g, q), least = lanes_all(REAL_MOST);
	mask_lanes over = (mask_lanes){} == 0;
	u32 i;

	out->way = lanes3_scale(q, lanes_all(REAL(-1)));
	out->edge = lanes_all(0);
	out->along = lanes_all(0);
	for (i = 0; i < 3; i++) {
		struct lanes3 e = row3_step(&block->edge[i].along, step), way;
		lanes t, length2;
		mask_lanes nearer;

		if (i)
			q = from_corner(block, step, i, tip);
		over &= lanes3_dot(lanes3_cross(g, e), q) >= lanes_all(0);
		t = mul(lanes3_dot(e, q), block->edge[i].inverse_length2[step]);
		t = lanes_min(lanes_max(t, lanes_all(0)), lanes_all(REAL(1)));
		way = lanes3_sub(lanes3_scale(e, t), q);
		length2 = lanes3_dot(way, way);
		nearer = length2 < least;
		least = lanes_select(nearer, length2, least);
		out->way.x = lanes_select(nearer, way.x, out->way.x);
		out->way.y = lanes_select(nearer, way.y, out->way.y);
		out->way.z = lanes_select(nearer, way.z, out->way.z);
		out->edge = lanes_select(nearer, lanes_all((s32)i), out->edge);
		out->along = lanes_select(nearer, t, out->along);
	}
	out->way.x = lanes_select(over, mul(g.x, -height), out->way.x);
	out->way.y = lanes_select(over, mul(g.y, -height), out->way.y);
	out->way.z = lanes_select(over, mul(g.z, -height), out->way.z);
	out->edge = lanes_select(over, lanes_all(REAL(-1)), out->edge);
}

/* On which feature of its patch the nearest point of one lane lies. */
static inline struct feature nearest_feature(const struct block *block, u32 lane,
					     const struct nearest_step *at)
{
	struct feature out = {{PHANTOM_PATCH_NONE, PHANTOM_PATCH_NONE}};
	u32 l = lane % PHANTOM_LANES, edge, from, to;

	if (at->edge[l] < 0)
		return out;
	edge = (u32)at->edge[l];
	from = block->vertex[edge][lane];
	to = block->vertex[(edge + 1) % 3][lane];
	out.vertex[0] = at->along[l] < REAL(1) ? from : to;
	out.vertex[1] = at->along[l] > 0 ? to : from;
	return out;
}

#endif /* PHANTOM_FLOAT_NEAREST_H */
