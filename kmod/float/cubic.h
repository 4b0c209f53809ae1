/* SPDX-License-Identifier: GPL-2.0-only */
/*
 * cubic.h - c(h) = 0: at which heights the tip is in the plane of a patch's offset triangle (projected.h).
 *
 * Where c' keeps its sign on [0, H] and varies less than MONOTONE_PARTS fold there is one root or none, found
 * by all lanes at once in a given number of Halley's steps. Elsewhere the interval is split at the critical
 * points and each part that changes sign is solved by Newton kept in its bracket, one at a time.
 */
#ifndef PHANTOM_FLOAT_CUBIC_H
#define PHANTOM_FLOAT_CUBIC_H

#include "block.h"

#define MONOTONE_PARTS 4

/* Bisection alone needs that many steps for float32's 24 bits; float64 ends as near as Newton gets. */
#define BRACKET_STEPS 32

/*
 * A(h) = 0 solves the cubic as well, with b that mean nothing. It happens only where the interval is
 * split; there P must be found again from its b and h, up to that part of R.
 */
#define FOUND_AGAIN REAL(1e-3)

struct cubic {
	lanes c0, c1, c2, c3;
};

struct fine_cubic {
	fine c0, c1, c2, c3;
};

struct fine_roots {
	fine h[PROJECTED_ROOTS];
	bool falling[PROJECTED_ROOTS]; /* the cubic, there: the shell has not folded over */
	u32 count;
};

/* Of a cubic whose terms are small: see cubic_tame(). */
LANES_INLINE lanes cubic_at(const struct cubic *c, lanes h)
{
	return mul_small(mul_small(mul_small(c->c3, h) + c->c2, h) + c->c1, h) + c->c0;
}

LANES_INLINE lanes cubic_slope(const struct cubic *c, lanes h)
{
	return mul_small(mul_small(3 * c->c3, h) + 2 * c->c2, h) + c->c1;
}

static inline fine fine_cubic_at(const struct fine_cubic *c, fine h)
{
	return fine_mul(fine_mul(fine_mul(c->c3, h) + c->c2, h) + c->c1, h) + c->c0;
}

/* The root in [low, high]; the cubic is negative at one end only and monotone between. */
static inline fine bracket_solve(const struct fine_cubic *c, fine low, fine high, bool falling)
{
	fine h = (low + high) / 2;
	u32 i;

	for (i = 0; i < BRACKET_STEPS; i++) {
		fine value = fine_cubic_at(c, h);
		fine slope = fine_mul(fine_mul(3 * c->c3, h) + 2 * c->c2, h) + c->c1;
		fine next;

		if ((value < 0) == falling)
			high = h;
		else
			low = h;
		next = h - fine_divide(value, slope);
		/* written so that a step which is no number is refused as well */
		if (!(next > low && next < high))
			next = (low + high) / 2;
		if (next == h)
			break;
		h = next;
	}
	return h;
}

/* Critical points of the cubic inside (low, high), ascending; returns how many. */
static inline u32 critical_points(const struct fine_cubic *c, fine low, fine high, fine out[2])
{
	fine discriminant = fine_mul_sub(c->c2, c->c2, 3 * c->c1, c->c3);
	fine both, first, second;
	u32 count = 0;

	if (!(discriminant > 0))
		return 0;
	/* the stable form: no difference of nearly equal numbers */
	both = c->c2 < 0 ? -c->c2 + fine_sqrt(discriminant) : -c->c2 - fine_sqrt(discriminant);
	first = fine_divide(both, 3 * c->c3);
	second = fine_divide(c->c1, both);
	if (second < first) {
		fine swap = first;

		first = second;
		second = swap;
	}
	if (first > low && first < high)
		out[count++] = first;
	if (second > low && second < high)
		out[count++] = second;
	return count;
}

/* All roots in [low, high], by splitting at the critical points. */
LANES_NOINLINE void split_roots(const struct fine_cubic *c, fine low, fine high,
				struct fine_roots *roots)
{
	fine ends[4], points[2];
	u32 parts = 0, count = critical_points(c, low, high, points), i;

	ends[parts++] = low;
	for (i = 0; i < count; i++)
		ends[parts++] = points[i];
	ends[parts] = high;
	roots->count = 0;
	for (i = 0; i < parts; i++) {
		bool negative = fine_cubic_at(c, ends[i]) < 0;

		if (negative == (fine_cubic_at(c, ends[i + 1]) < 0))
			continue;
		roots->h[roots->count] = bracket_solve(c, ends[i], ends[i + 1], !negative);
		roots->falling[roots->count++] = !negative;
	}
}

/* The cubics of a step. */
LANES_INLINE struct cubic shell_cubic(const struct block *block, u32 step, struct lanes3 q,
				      lanes height)
{
	struct cubic c;

	c.c0 = height;
	c.c1 = lanes3_dot(q, row3_step(&block->area1, step)) - block->normal_area0[step];
	c.c2 = lanes3_dot(q, row3_step(&block->area2, step)) - block->normal_area1[step];
	c.c3 = -block->normal_area2[step];
	return c;
}

/*
 * The cubic of a patch of which no term on [0, H] is too large for a product, wherever the tip is in reach.
 * Of others 0, which is not monotone: their roots are found as those are that need care.
 */
LANES_INLINE struct cubic cubic_tame(const struct block *block, u32 step, const struct cubic *c)
{
#ifdef PHANTOM_REAL_FIXED
	mask_lanes tame = block->tame[step];

	return (struct cubic){lanes_keep(tame, c->c0), lanes_keep(tame, c->c1),
			      lanes_keep(tame, c->c2), lanes_keep(tame, c->c3)};
#else
	(void)block;
	(void)step;
	return *c;
#endif
}

/*
 * Has the cubic different signs at the ends of [low, high]? `slopes` is the sum of the Bernstein coefficients
 * of c' on [0, high], whose mean is that of c'; low is so near to 0 that the cubic is straight there.
 */
LANES_INLINE mask_lanes cubic_crosses(const struct cubic *c, lanes low, lanes high, lanes slopes)
{
#ifdef PHANTOM_REAL_FIXED
	return (c->c0 + mul_small(c->c1, low) < 0) ^ (3 * c->c0 + mul_fitting(slopes, high) < 0);
#else
	(void)slopes;
	return (cubic_at(c, low) < lanes_all(0)) ^ (cubic_at(c, high) < lanes_all(0));
#endif
}

/* What Halley's method takes off h in the lanes of the mask: c c' / (c'^2 - c c''/2). */
LANES_INLINE lanes cubic_correction(const struct cubic *c, lanes h, mask_lanes usual)
{
	lanes value = cubic_at(c, h);
	lanes slope = lanes_select(usual, cubic_slope(c, h), lanes_all(REAL(1)));
	lanes square = mul_small(slope, slope);
	lanes under = square - mul_small(value, mul_small(3 * c->c3, h) + c->c2);
	/* bent too much for it: Newton's */
	mask_lanes near = under > lanes_part(square, 4);

	return divide(mul_small(value, lanes_select(near, slope, lanes_all(REAL(1)))),
		      lanes_select(near, under, slope));
}

#endif /* PHANTOM_FLOAT_CUBIC_H */
