/* SPDX-License-Identifier: GPL-2.0-only */
/*
 * cubic_fixed.h - fixed point: the cubic of a patch whose shell has folded over, or nearly so, exactly.
 *
 * Where the shells round a point shrink to it (the centre of a hollow ball) c has three roots next to one
 * another, and an error of c moves them by its cube root: Q36's 1.5e-11 by half a um. But all that c is made
 * of are integers: ways in nm, normals in 2^-30, so its four terms are sums of products of three of those,
 * below 2^98. They are formed exactly, then scaled to 56 bits: by one power of two for all of them, and with
 * heights in units of 2^unit nm, in which no height is above 1.
 */
#ifndef PHANTOM_FLOAT_CUBIC_FIXED_H
#define PHANTOM_FLOAT_CUBIC_FIXED_H

#ifdef PHANTOM_REAL_FIXED

#include "cubic.h"

struct exact3 {
	s64 x, y, z;
};

struct exact_area {
	__int128 x, y, z;
};

static inline struct exact3 exact3_sub(struct exact3 a, struct exact3 b)
{
	return (struct exact3){a.x - b.x, a.y - b.y, a.z - b.z};
}

static inline struct exact_area exact3_cross(struct exact3 a, struct exact3 b)
{
	return (struct exact_area){fixed_product(a.y, b.z) - fixed_product(a.z, b.y),
				   fixed_product(a.z, b.x) - fixed_product(a.x, b.z),
				   fixed_product(a.x, b.y) - fixed_product(a.y, b.x)};
}

static inline __int128 exact3_dot(struct exact3 a, struct exact_area b)
{
	return a.x * b.x + a.y * b.y + a.z * b.z;
}

/* P - x_corner, nm. */
static inline struct exact3 exact_way(const struct block *block, u32 lane, u32 corner,
				      const struct nm_point *tip)
{
	const nm_row *x = block->corner[corner];

	return (struct exact3){tip->axis[0][0] - x[0][lane][0], tip->axis[1][0] - x[1][lane][0],
			       tip->axis[2][0] - x[2][lane][0]};
}

/* m of a corner, Q30: a row is Q36 of that. */
static inline struct exact3 exact_normal(const struct block *block, u32 lane, u32 corner)
{
	struct real3 m = row3_lane(&block->edge[corner].normal, lane);

	return (struct exact3){m.x >> (FIXED_BITS - 30), m.y >> (FIXED_BITS - 30),
			       m.z >> (FIXED_BITS - 30)};
}

/* How many bits |a| has. */
static inline s32 exact_bits(__int128 a)
{
	__uint128_t magnitude = a < 0 ? -(__uint128_t)a : (__uint128_t)a;
	u64 high = (u64)(magnitude >> 64), low = (u64)magnitude;

	if (high)
		return 128 - __builtin_clzll(high);
	return low ? 64 - __builtin_clzll(low) : 0;
}

static inline u64 exact_most(struct exact3 a)
{
	return fixed_magnitude(a.x) | fixed_magnitude(a.y) | fixed_magnitude(a.z);
}

/* a 2^shift, rounded down; below 2^62, so 0 is 0 however far it is shifted. */
static inline s64 exact_shift(__int128 a, s32 shift)
{
	if (!a)
		return 0;
	if (shift >= 0)
		return (s64)((u64)a << shift);
	return shift > -128 ? (s64)(a >> -shift) : 0;
}

/* nm of a number of mm, rounded down. */
static inline s64 exact_nm(real mm)
{
	return (s64)((__int128)mm * 1000000 >> FIXED_BITS);
}

/*
 * The cubic of projected.h, of any size; returns the unit of its heights, the power of two of so many nm that
 * none of the lengths is longer, nor `high`.
 */
static inline u32 exact_cubic(const struct block *block, u32 lane, const struct nm_point *tip,
			      real high, struct fine_cubic *out)
{
	struct exact3 q[3], m[3], e1, e2, f1, f2;
	struct exact_area turned, back, area[3];
	__int128 term[4] = {0, 0, 0, 0};
	u32 order = (u32)(row_lane(block->order, lane) >> FIXED_BITS), unit, i;
	s32 shift[4], most = -128;

	for (i = 0; i < 3; i++) {
		q[i] = exact_way(block, lane, i, tip);
		m[i] = exact_normal(block, lane, i);
	}
	e1 = exact3_sub(q[0], q[1]);
	e2 = exact3_sub(q[0], q[2]);
	f1 = exact3_sub(m[1], m[0]);
	f2 = exact3_sub(m[2], m[0]);
	unit = 64 - (u32)__builtin_clzll(exact_most(q[0]) | exact_most(e1) | exact_most(e2) |
					 (u64)exact_nm(high) | 1);
	turned = exact3_cross(e1, f2);
	back = exact3_cross(f1, e2);
	area[0] = exact3_cross(e1, e2);
	area[1] = (struct exact_area){turned.x + back.x, turned.y + back.y, turned.z + back.z};
	area[2] = exact3_cross(f1, f2);
	for (i = 0; i + order < 3; i++) {
		term[i] += exact3_dot(q[0], area[i + order]);
		term[i + 1] -= exact3_dot(m[0], area[i + order]);
	}
	/* each has a length less than the one before, in nm, and a normal more */
	for (i = 0; i < 4; i++) {
		s32 bits = exact_bits(term[i]);

		shift[i] = (s32)i * ((s32)unit - 30);
		if (bits && bits + shift[i] > most)
			most = bits + shift[i];
	}
	out->c0 = exact_shift(term[0], FINE_BITS + shift[0] - most);
	out->c1 = exact_shift(term[1], FINE_BITS + shift[1] - most);
	out->c2 = exact_shift(term[2], FINE_BITS + shift[2] - most);
	out->c3 = exact_shift(term[3], FINE_BITS + shift[3] - most);
	return unit;
}

/* A height in those units, and back. */
static inline fine fine_from_real(real mm, u32 unit)
{
	return (fine)((__int128)mm * (1000000LL << (FINE_BITS - FIXED_BITS)) >> unit);
}

static inline real real_from_fine(fine height, u32 unit)
{
	return (real)(fixed_product(height, FIXED_MM_PER_NM) >> (FINE_BITS + 12 - unit));
}

/* All roots of one patch in [low, high], mm. */
LANES_NOINLINE void exact_roots(const struct block *block, u32 lane, const struct nm_point *tip,
				real low, real high, struct fine_roots *roots)
{
	struct fine_cubic c;
	u32 unit = exact_cubic(block, lane, tip, high, &c), i;

	split_roots(&c, fine_from_real(low, unit), fine_from_real(high, unit), roots);
	for (i = 0; i < roots->count; i++)
		roots->h[i] = real_from_fine(roots->h[i], unit);
}

#endif /* PHANTOM_REAL_FIXED */

#endif /* PHANTOM_FLOAT_CUBIC_FIXED_H */
