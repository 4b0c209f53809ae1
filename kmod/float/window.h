/* SPDX-License-Identifier: GPL-2.0-only */
/*
 * window.h - how much of a tip that lies on walls of the shells a patch takes.
 *
 * Rounding would let a tip on a common wall count twice or not at all. So the tip is a little window,
 * an octagon in the plane across n, and a patch has the part of it that lies in its offset triangle.
 * On a wall both neighbours see the same line, at the same distance, from its two sides; round the
 * line of a vertex normal all patches see the same rays. So the parts of unfolded patches add up to
 * 1, wherever in the window the walls meet, and those of patches of which some have folded over, each
 * with its sign, to how often the surface goes round the tip: what they would without rounding.
 *
 * Lengths in units of the window's inner radius. The part is found by clipping (Sutherland, Hodgman
 * 1974).
 */
#ifndef PHANTOM_FLOAT_WINDOW_H
#define PHANTOM_FLOAT_WINDOW_H

#include "block.h"

/* Inner radius of the window, in units of rounding_mm(). */
#define SOFT_WALL 8

/*
 * The distance from a wall counts for at least that part of the distance within the offset triangle:
 * at a fold A.N = 0, and without it a root would lie on every wall there, however far from it in b.
 */
#define IN_PLANE REAL(1.0 / 32)

#define WINDOW_CORNERS 8
#define WINDOW_WALLS 4 /* of a triangle; the fourth is a fan's end */

/* Outside by more than that, the window is all on one side of a wall: 1 / cos 22.5 degrees. */
#define WINDOW_REACH REAL(1.0824)

#define WINDOW_TANGENT 0.41421356237309503 /* tan 22.5 degrees */
#define WINDOW_AREA REAL(8 * WINDOW_TANGENT)

struct window_point {
	real x, y;
};

/* A half-plane: the points p with distance + inward . p >= 0. */
struct window_wall {
	real distance;
	struct window_point inward; /* of length 1 */
};

struct window {
	struct window_point corner[WINDOW_CORNERS + WINDOW_WALLS];
	u32 count;
};

static inline void window_clip(struct window *window, const struct window_wall *wall)
{
	struct window out = {.count = 0};
	struct window_point last;
	real last_in;
	u32 i;

	if (!window->count)
		return;
	last = window->corner[window->count - 1];
	last_in = wall->distance + mul(wall->inward.x, last.x) + mul(wall->inward.y, last.y);
	for (i = 0; i < window->count; i++) {
		struct window_point at = window->corner[i];
		real in = wall->distance + mul(wall->inward.x, at.x) + mul(wall->inward.y, at.y);

		if ((in >= 0) != (last_in >= 0)) {
			real part = divide(last_in, last_in - in);

			out.corner[out.count].x = last.x + mul(part, at.x - last.x);
			out.corner[out.count++].y = last.y + mul(part, at.y - last.y);
		}
		if (in >= 0)
			out.corner[out.count++] = at;
		last = at;
		last_in = in;
	}
	*window = out;
}

/* Twice the area. */
static inline real window_area2(const struct window *window)
{
	real area = 0;
	u32 i;

	for (i = 0; i < window->count; i++) {
		struct window_point a = window->corner[i];
		struct window_point b = window->corner[i + 1 < window->count ? i + 1 : 0];

		area += mul_sub(a.x, b.y, a.y, b.x);
	}
	return area;
}

/* The part of the window on the inner side of all walls, 0 ... 1. */
LANES_NOINLINE real window_part(const struct window_wall *walls, u32 count)
{
	static const struct window_point octagon[WINDOW_CORNERS] = {
		{REAL(1), REAL(WINDOW_TANGENT)},   {REAL(WINDOW_TANGENT), REAL(1)},
		{REAL(-WINDOW_TANGENT), REAL(1)},  {REAL(-1), REAL(WINDOW_TANGENT)},
		{REAL(-1), REAL(-WINDOW_TANGENT)}, {REAL(-WINDOW_TANGENT), REAL(-1)},
		{REAL(WINDOW_TANGENT), REAL(-1)},  {REAL(1), REAL(-WINDOW_TANGENT)},
	};
	struct window window = {.count = WINDOW_CORNERS};
	bool whole = true;
	u32 i;

	for (i = 0; i < WINDOW_CORNERS; i++)
		window.corner[i] = octagon[i];
	for (i = 0; i < count; i++) {
		if (walls[i].distance >= WINDOW_REACH)
			continue;
		if (walls[i].distance <= -WINDOW_REACH)
			return 0;
		window_clip(&window, &walls[i]);
		whole = false;
	}
	if (whole)
		return REAL(1);
	return real_clamp(divide(window_area2(&window), 2 * WINDOW_AREA), 0, REAL(1));
}

/*
 * Two directions across n, for everyone who has that n the same. An axis that is not along n gives the
 * first; which one it is changes where |n_x| = 0.75, and the octagon hardly shows that it has turned.
 */
static inline void window_axes(struct real3 n, struct real3 *x, struct real3 *y)
{
	bool along_x = real_abs(n.x) > REAL(0.75);

	*x = real3_unit(
		real3_cross(n, (struct real3){along_x ? 0 : REAL(1), along_x ? REAL(1) : 0, 0}));
	*y = real3_cross(n, *x);
}

/*
 * The factor that all parts in a tick are taken times. Without rounding they add up to a whole number,
 * but at the rim of a surface; with it, and where a sliver too thin for a plane is left out, to nearly
 * one. Nearly is WINDOW_NEARLY; up to twice that the factor goes over to 1.
 */
#define WINDOW_NEARLY REAL(0.25)

static inline real window_share(real sum)
{
	real whole = sum < REAL(1.5) ? REAL(1) : sum < REAL(2.5) ? REAL(2) : REAL(3);
	real off = real_abs(sum - whole);

	if (off >= 2 * WINDOW_NEARLY)
		return REAL(1);
	off = real_min(REAL(1), divide(2 * WINDOW_NEARLY - off, WINDOW_NEARLY));
	return REAL(1) + mul(divide(whole, sum) - REAL(1), off);
}

#endif /* PHANTOM_FLOAT_WINDOW_H */
