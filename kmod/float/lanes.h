/* SPDX-License-Identifier: GPL-2.0-only */
/*
 * lanes.h - what the contact mathematics is written in: vectors of PHANTOM_LANES reals.
 *
 * A unit (contact_*.c) chooses what a real is and how many are worked on at once; everything above
 * this file is one description for all of them. Patches are kept in blocks of sixteen; a unit with
 * fewer lanes takes a block in several steps.
 *
 * Reals may be fixed-point integers (number_fixed.h), for which C has no operators: products and
 * quotients are written mul() and divide(), constants REAL(). Sums, differences, comparisons and
 * products with small integers are C's own.
 */
#ifndef PHANTOM_FLOAT_LANES_H
#define PHANTOM_FLOAT_LANES_H

#include "phantom_float.h"

#define PHANTOM_BLOCK 16 /* patches in a block */
#define PHANTOM_STEPS (PHANTOM_BLOCK / PHANTOM_LANES)

#define LANES_INLINE static inline __attribute__((always_inline))

/* Functions kept apart, so that no stack frame grows beyond the kernel's 2 KB. */
#define LANES_NOINLINE static __attribute__((__noinline__))

#ifdef PHANTOM_REAL_FIXED
#include "number_fixed.h"
#else
#include "number_float.h"
#endif

/* Component-wise vectors; lanes3 holds one 3-vector per lane. */
struct lanes3 {
	lanes x, y, z;
};

struct real3 {
	real x, y, z;
};

/* How many lanes of the mask are set. */
LANES_INLINE u32 mask_count(mask_lanes mask)
{
	u32 bits = mask_bits(mask), count = 0;

	for (; bits; bits &= bits - 1)
		count++;
	return count;
}

LANES_INLINE lanes lanes_all(real a)
{
	return (lanes){} + a;
}

LANES_INLINE nm_lanes nm_all(s32 a)
{
	return (nm_lanes){} + (coordinate)a;
}

/* a where the mask is set, else b. */
LANES_INLINE lanes lanes_select(mask_lanes mask, lanes a, lanes b)
{
	return (lanes)((mask & (mask_lanes)a) | (~mask & (mask_lanes)b));
}

/* a where the mask is set, else 0. */
LANES_INLINE lanes lanes_keep(mask_lanes mask, lanes a)
{
	return (lanes)(mask & (mask_lanes)a);
}

LANES_INLINE lanes lanes_abs(lanes a)
{
	return lanes_max(a, -a);
}

/*
 * a - b in mm. The difference of nm integers is exact (+-1 m round the origin fits), so neither
 * the place of a set nor its size costs precision: only the distance between the two points does.
 */
LANES_INLINE lanes nm_difference(nm_lanes a, nm_lanes b)
{
	return lanes_from_nm(a - b);
}

LANES_INLINE struct lanes3 lanes3_add(struct lanes3 a, struct lanes3 b)
{
	return (struct lanes3){a.x + b.x, a.y + b.y, a.z + b.z};
}

LANES_INLINE struct lanes3 lanes3_sub(struct lanes3 a, struct lanes3 b)
{
	return (struct lanes3){a.x - b.x, a.y - b.y, a.z - b.z};
}

LANES_INLINE struct lanes3 lanes3_scale(struct lanes3 a, lanes s)
{
	return (struct lanes3){mul(a.x, s), mul(a.y, s), mul(a.z, s)};
}

LANES_INLINE lanes lanes3_dot(struct lanes3 a, struct lanes3 b)
{
	return mul_sum(a.x, b.x, a.y, b.y, a.z, b.z);
}

/* Of components below 2^13 (mm, or of any unit): in fixed point there is nothing to saturate. */
LANES_INLINE struct lanes3 lanes3_scale_small(struct lanes3 a, lanes s)
{
	return (struct lanes3){mul_small(a.x, s), mul_small(a.y, s), mul_small(a.z, s)};
}

/* The same, what comes out below 2^26, too. */
LANES_INLINE struct lanes3 lanes3_scale_fitting(struct lanes3 a, lanes s)
{
	return (struct lanes3){mul_fitting(a.x, s), mul_fitting(a.y, s), mul_fitting(a.z, s)};
}

LANES_INLINE struct lanes3 lanes3_scale_known(bool small, struct lanes3 a, lanes s)
{
	return (struct lanes3){mul_known(small, a.x, s), mul_known(small, a.y, s),
			       mul_known(small, a.z, s)};
}

LANES_INLINE lanes lanes3_dot_small(struct lanes3 a, struct lanes3 b)
{
	return mul_sum_small(a.x, b.x, a.y, b.y, a.z, b.z);
}

LANES_INLINE struct lanes3 lanes3_cross_small(struct lanes3 a, struct lanes3 b)
{
	return (struct lanes3){mul_sub_small(a.y, b.z, a.z, b.y), mul_sub_small(a.z, b.x, a.x, b.z),
			       mul_sub_small(a.x, b.y, a.y, b.x)};
}

LANES_INLINE struct lanes3 lanes3_cross(struct lanes3 a, struct lanes3 b)
{
	return (struct lanes3){mul_sub(a.y, b.z, a.z, b.y), mul_sub(a.z, b.x, a.x, b.z),
			       mul_sub(a.x, b.y, a.y, b.x)};
}

/* Precise for short vectors too. */
LANES_INLINE lanes lanes3_length(struct lanes3 a)
{
	return lanes_length(a.x, a.y, a.z);
}

/* Of length 1; of no length stays so. */
LANES_INLINE struct lanes3 lanes3_unit(struct lanes3 a)
{
	lanes_unit(&a.x, &a.y, &a.z);
	return a;
}

/* The length, and what the direction follows from. */
LANES_INLINE struct measured lanes3_measure(struct lanes3 a)
{
	return lanes_measure(a.x, a.y, a.z);
}

/* Of length 1, of the vector that was measured; in lanes of the mask, where it is not 0. */
LANES_INLINE struct lanes3 lanes3_unit_measured(struct lanes3 a, const struct measured *measured,
						mask_lanes mask)
{
	lanes_unit_measured(&a.x, &a.y, &a.z, measured, mask);
	return a;
}

LANES_INLINE struct lanes3 lanes3_all(struct real3 a)
{
	return (struct lanes3){lanes_all(a.x), lanes_all(a.y), lanes_all(a.z)};
}

LANES_INLINE struct real3 lanes3_lane(struct lanes3 a, u32 lane)
{
	return (struct real3){a.x[lane], a.y[lane], a.z[lane]};
}

LANES_INLINE real real_min(real a, real b)
{
	return a < b ? a : b;
}

LANES_INLINE real real_max(real a, real b)
{
	return a > b ? a : b;
}

LANES_INLINE real real_abs(real a)
{
	return a < 0 ? -a : a;
}

LANES_INLINE real real_clamp(real a, real low, real high)
{
	return real_min(real_max(a, low), high);
}

LANES_INLINE struct real3 real3_add(struct real3 a, struct real3 b)
{
	return (struct real3){a.x + b.x, a.y + b.y, a.z + b.z};
}

LANES_INLINE struct real3 real3_sub(struct real3 a, struct real3 b)
{
	return (struct real3){a.x - b.x, a.y - b.y, a.z - b.z};
}

LANES_INLINE struct real3 real3_scale(struct real3 a, real s)
{
	return (struct real3){mul(a.x, s), mul(a.y, s), mul(a.z, s)};
}

/* Of what comes out below 2^26. */
LANES_INLINE struct real3 real3_scale_fitting(struct real3 a, real s)
{
	return (struct real3){mul_fitting(a.x, s), mul_fitting(a.y, s), mul_fitting(a.z, s)};
}

LANES_INLINE real real3_dot(struct real3 a, struct real3 b)
{
	return mul_sum(a.x, b.x, a.y, b.y, a.z, b.z);
}

LANES_INLINE struct real3 real3_cross(struct real3 a, struct real3 b)
{
	return (struct real3){mul_sub(a.y, b.z, a.z, b.y), mul_sub(a.z, b.x, a.x, b.z),
			      mul_sub(a.x, b.y, a.y, b.x)};
}

LANES_INLINE real real3_length(struct real3 a)
{
	return lanes3_length(lanes3_all(a))[0];
}

/* Of length 1; of no length stays so. */
LANES_INLINE struct real3 real3_unit(struct real3 a)
{
	return lanes3_lane(lanes3_unit(lanes3_all(a)), 0);
}

#endif /* PHANTOM_FLOAT_LANES_H */
