/* SPDX-License-Identifier: GPL-2.0-only */
/*
 * folded.h - float32: the roots of a patch whose shell has folded over within R, or nearly so.
 *
 * At a fold c' goes to 0, and an error of c moves the root by 1 / |c'| times as much; where the shells of a
 * ring shrink to a point (the axis of a dent, the centre of a hollow ball) all their walls are next to the
 * tip as well. There float32's c, off by some 1e-7 of the distances, puts roots farther from where they are
 * than the window is wide, neighbours disagree, and a tip is lost between them. So these patches, those
 * whose interval is split, are worked on in float64 from what neighbours have in common to the last bit:
 * corners in whole nm and normals. What is off then is off by 1e-16 in place of 1e-7.
 *
 * It is projected.h's own mathematics, with A(h) not divided by |A0|, and one root at a time.
 */
#ifndef PHANTOM_FLOAT_FOLDED_H
#define PHANTOM_FLOAT_FOLDED_H

#ifdef PHANTOM_REAL_SINGLE

#include "cubic.h"
#include "wide3.h"
#include "window.h"

struct folded_shell {
	struct wide3 q[3]; /* P - x_i, mm */
	struct wide3 m[3];
	struct wide3 along[3], turn[3]; /* x_(i+1) - x_i, m_(i+1) - m_i */
	struct wide3 area[3]; /* A(h) = h^order (area[0] + area[1] h + area[2] h^2), mm^2 */
	u32 order; /* 0 of a face, 1 of a fan over an edge, 2 over a vertex */
};

/* A root and where the tip is in the offset triangle there. */
struct folded_point {
	wide h, b[3];
	struct wide3 edge[3]; /* E_i */
	struct wide3 area; /* A(h) */
	struct wide3 normal; /* n */
	wide away; /* of P from where b and h say that it is */
	wide length; /* |N| */
	wide turned; /* |A . N| */
	bool falling;
};

LANES_INLINE struct wide3 wide3_of(struct real3 a)
{
	return (struct wide3){a.x, a.y, a.z};
}

static inline void folded_shell(const struct block *block, u32 lane, const struct nm_point *tip,
				struct folded_shell *out)
{
	const struct wide3 none = {0, 0, 0};
	struct wide3 e1, e2, f1, f2, area[3];
	u32 step = lane / PHANTOM_LANES, l = lane % PHANTOM_LANES, i;

	for (i = 0; i < 3; i++) {
		const nm_row *x = block->corner[i];

		out->q[i] = wide3_scale(wide3_from_integers(tip->axis[0][l] - x[0][step][l],
							    tip->axis[1][l] - x[1][step][l],
							    tip->axis[2][l] - x[2][step][l]),
					WIDE(1e-6));
		out->m[i] = wide3_of(row3_lane(&block->edge[i].normal, lane));
	}
	for (i = 0; i < 3; i++) {
		out->along[i] = wide3_sub(out->q[i], out->q[(i + 1) % 3]);
		out->turn[i] = wide3_sub(out->m[(i + 1) % 3], out->m[i]);
	}
	e1 = out->along[0];
	e2 = wide3_sub(none, out->along[2]);
	f1 = out->turn[0];
	f2 = wide3_sub(none, out->turn[2]);
	area[0] = wide3_cross(e1, e2);
	area[1] = wide3_add(wide3_cross(e1, f2), wide3_cross(f1, e2));
	area[2] = wide3_cross(f1, f2);
	out->order = (u32)row_lane(block->order, lane);
	for (i = 0; i < 3; i++)
		out->area[i] = i + out->order < 3 ? area[i + out->order] : none;
}

/* b0 b1 b2 at out->h, and A and the edges there; false where A is 0. */
static inline bool folded_place(const struct folded_shell *shell, struct folded_point *out)
{
	wide h = out->h, power = shell->order ? shell->order > 1 ? h * h : h : 1, size;
	struct wide3 w[3];
	u32 i;

	for (i = 0; i < 3; i++) {
		out->edge[i] = wide3_add(shell->along[i], wide3_scale(shell->turn[i], h));
		w[i] = wide3_sub(shell->q[i], wide3_scale(shell->m[i], h));
	}
	out->area = wide3_add(shell->area[1], wide3_scale(shell->area[2], h));
	out->area = wide3_scale(wide3_add(shell->area[0], wide3_scale(out->area, h)), power);
	size = wide3_dot(out->area, out->area);
	if (!(size > 0))
		return false;
	/* b of the corner opposite to edge i */
	for (i = 0; i < 3; i++)
		out->b[(i + 2) % 3] = wide3_dot(wide3_cross(out->edge[i], w[i]), out->area) / size;
	/* A = 0 solves the cubic too: P must be found again */
	w[0] = wide3_sub(w[0], wide3_scale(out->edge[0], out->b[1]));
	w[0] = wide3_add(w[0], wide3_scale(out->edge[2], out->b[2]));
	out->away = wide3_length(w[0]);
	return true;
}

/* The part of the window that a root next to a wall has. */
LANES_NOINLINE real folded_weight(const struct folded_shell *shell, const struct folded_point *at,
				  wide soft)
{
	struct real3 normal = {(real)at->normal.x, (real)at->normal.y, (real)at->normal.z}, x, y;
	wide turned = at->turned, least = wide3_length(at->area) * IN_PLANE;
	struct window_wall wall[WINDOW_WALLS];
	struct wide3 inward;
	u32 count = 0, i;

	if (turned < least)
		turned = least;
	window_axes(normal, &x, &y);
	for (i = 0; i < 3; i++) {
		wide length;

		inward = wide3_cross(at->normal, at->edge[i]);
		length = wide3_length(inward);
		length = length > REAL_TINY ? length : REAL_TINY;
		inward = wide3_scale(inward, (at->falling ? 1 : -1) / length);
		wall[count].distance =
			(real)(at->b[(i + 2) % 3] * turned / at->length / length / soft);
		wall[count].inward.x = (real)wide3_dot(inward, wide3_of(x));
		wall[count++].inward.y = (real)wide3_dot(inward, wide3_of(y));
	}
	if (shell->order == 1) {
		wide length = wide3_length(shell->along[0]);

		inward = wide3_scale(shell->along[0], 1 / length);
		wall[count].distance = (real)((1 - at->b[0]) * length / soft);
		wall[count].inward.x = (real)wide3_dot(inward, wide3_of(x));
		wall[count++].inward.y = (real)wide3_dot(inward, wide3_of(y));
	}
	return window_part(wall, count);
}

/* Is the root in the shell, and what does it give? */
static inline bool folded_root(const struct folded_shell *shell, const struct block *block,
			       u32 lane, real rounding, struct folded_point *at,
			       struct projected_root *out)
{
	wide soft = SOFT_WALL * (wide)rounding, radius = row_lane(block->radius, lane), reach,
	     least;
	struct wide3 n;
	wide height;

	if ((shell->order && !(at->h > 0)) || !folded_place(shell, at))
		return false;
	n = wide3_add(shell->m[0], wide3_scale(shell->turn[0], at->b[1]));
	n = wide3_sub(n, wide3_scale(shell->turn[2], at->b[2]));
	at->length = wide3_length(n);
	at->turned = wide3_dot(at->area, n);
	at->turned = at->turned < 0 ? -at->turned : at->turned;
	height = at->h * at->length;
	least = at->b[0] < at->b[1] ? at->b[0] : at->b[1];
	least = (least < at->b[2] ? least : at->b[2]) * at->turned;
	reach = 2 * soft * (row_lane(block->extent, lane) + at->h + soft);
	if (!(least >= -reach) || !(at->away <= FOUND_AGAIN * radius) || !(at->length > 0) ||
	    !(height < radius) || !(height > -rounding))
		return false;
	at->normal = wide3_scale(n, 1 / at->length);
	out->normal = (struct real3){(real)at->normal.x, (real)at->normal.y, (real)at->normal.z};
	out->height = (real)height;
	out->magnitude = row_lane(block->stiffness, lane) * (real)(radius - height);
	out->sign = at->falling ? 1 : -1;
	out->weight = least <= reach ? folded_weight(shell, at, soft) : 1;
	return out->weight > 0;
}

/* Appends the roots of one patch to `list`; returns how many. */
LANES_NOINLINE u32 folded_roots(const struct block *block, u32 lane, const struct nm_point *tip,
				real rounding, u32 patch, struct projected_root *list)
{
	struct folded_shell shell;
	struct folded_point at;
	struct fine_roots roots;
	struct fine_cubic c;
	u32 count = 0, i;

	folded_shell(block, lane, tip, &shell);
	c.c0 = wide3_dot(shell.q[0], shell.area[0]);
	c.c1 = wide3_dot(shell.q[0], shell.area[1]) - wide3_dot(shell.m[0], shell.area[0]);
	c.c2 = wide3_dot(shell.q[0], shell.area[2]) - wide3_dot(shell.m[0], shell.area[1]);
	c.c3 = -wide3_dot(shell.m[0], shell.area[2]);
	split_roots(&c, -(wide)rounding, row_lane(block->height_limit, lane), &roots);
	for (i = 0; i < roots.count; i++) {
		at.h = roots.h[i];
		at.falling = roots.falling[i];
		if (!folded_root(&shell, block, lane, rounding, &at, &list[count]))
			continue;
		list[count++].patch = patch;
	}
	return count;
}

#endif /* PHANTOM_REAL_SINGLE */

#endif /* PHANTOM_FLOAT_FOLDED_H */
