/* SPDX-License-Identifier: GPL-2.0-only */
/*
 * lanes.h - the arithmetic of a float section: native vectors of PHANTOM_LANES reals.
 *
 * A unit (contact_*.c) chooses the real type and the width; everything above this file is one
 * description for all of them. Patches are kept in blocks of sixteen; a unit with fewer lanes
 * takes a block in several steps. Every operation here works lane by lane and is exactly rounded
 * (IEEE 754 add, multiply, divide, square root, convert), so the width never changes a bit.
 *
 * GCC vector extensions and builtins only: the kernel has no intrinsic headers and no libm.
 */
#ifndef PHANTOM_FLOAT_LANES_H
#define PHANTOM_FLOAT_LANES_H

#include "phantom_float.h"

#define PHANTOM_BLOCK 16 /* patches in a block */
#define PHANTOM_STEPS (PHANTOM_BLOCK / PHANTOM_LANES)

#define LANES_INLINE static inline __attribute__((always_inline))

/* Functions kept apart, so that no stack frame grows beyond the kernel's 2 KB. */
#define LANES_NOINLINE static __attribute__((__noinline__))

#ifdef PHANTOM_REAL_DOUBLE
typedef double real;
typedef s64 mask_element;
typedef double coordinate; /* a nm integer, exact in float64 */
#else
typedef float real;
typedef s32 mask_element;
typedef s32 coordinate;
#endif

typedef real lanes __attribute__((vector_size(PHANTOM_LANES * sizeof(real))));
typedef mask_element mask_lanes __attribute__((vector_size(PHANTOM_LANES * sizeof(real))));
typedef coordinate nm_lanes __attribute__((vector_size(PHANTOM_LANES * sizeof(coordinate))));

typedef double double_pair __attribute__((vector_size(16)));

/* Component-wise vectors; lanes3 holds one 3-vector per lane. */
struct lanes3 {
	lanes x, y, z;
};

struct real3 {
	real x, y, z;
};

#define MM_PER_NM ((real)1e-6)
#define NM_PER_MM ((real)1e6)

#if defined(PHANTOM_REAL_DOUBLE)
LANES_INLINE lanes lanes_sqrt(lanes a)
{
	return __builtin_ia32_sqrtpd(a);
}

/* a where a < b, else b: with an operand that is no number, b. */
LANES_INLINE lanes lanes_min(lanes a, lanes b)
{
	return __builtin_ia32_minpd(a, b);
}

LANES_INLINE lanes lanes_max(lanes a, lanes b)
{
	return __builtin_ia32_maxpd(a, b);
}

/* Bit l is set where lane l of the mask is. */
LANES_INLINE u32 mask_bits(mask_lanes mask)
{
	return (u32)__builtin_ia32_movmskpd((lanes)mask);
}
#elif PHANTOM_LANES == 16
#define LANES_ALL_ON ((unsigned short)-1)
#define LANES_NEAREST 4 /* rounding as the control register says: to nearest */

LANES_INLINE lanes lanes_sqrt(lanes a)
{
	return __builtin_ia32_sqrtps512_mask(a, a, LANES_ALL_ON, LANES_NEAREST);
}

LANES_INLINE lanes lanes_min(lanes a, lanes b)
{
	return __builtin_ia32_minps512_mask(a, b, a, LANES_ALL_ON, LANES_NEAREST);
}

LANES_INLINE lanes lanes_max(lanes a, lanes b)
{
	return __builtin_ia32_maxps512_mask(a, b, a, LANES_ALL_ON, LANES_NEAREST);
}

LANES_INLINE u32 mask_bits(mask_lanes mask)
{
	return __builtin_ia32_cvtd2mask512(mask);
}
#elif PHANTOM_LANES == 8
LANES_INLINE lanes lanes_sqrt(lanes a)
{
	return __builtin_ia32_sqrtps256(a);
}

LANES_INLINE lanes lanes_min(lanes a, lanes b)
{
	return __builtin_ia32_minps256(a, b);
}

LANES_INLINE lanes lanes_max(lanes a, lanes b)
{
	return __builtin_ia32_maxps256(a, b);
}

LANES_INLINE u32 mask_bits(mask_lanes mask)
{
	return (u32)__builtin_ia32_movmskps256((lanes)mask);
}
#else
LANES_INLINE lanes lanes_sqrt(lanes a)
{
	return __builtin_ia32_sqrtps(a);
}

LANES_INLINE lanes lanes_min(lanes a, lanes b)
{
	return __builtin_ia32_minps(a, b);
}

LANES_INLINE lanes lanes_max(lanes a, lanes b)
{
	return __builtin_ia32_maxps(a, b);
}

LANES_INLINE u32 mask_bits(mask_lanes mask)
{
	return (u32)__builtin_ia32_movmskps((lanes)mask);
}
#endif

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
	return __builtin_convertvector(a - b, lanes) * lanes_all(MM_PER_NM);
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
	return (struct lanes3){a.x * s, a.y * s, a.z * s};
}

LANES_INLINE lanes lanes3_dot(struct lanes3 a, struct lanes3 b)
{
	return a.x * b.x + a.y * b.y + a.z * b.z;
}

LANES_INLINE struct lanes3 lanes3_cross(struct lanes3 a, struct lanes3 b)
{
	return (struct lanes3){a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

LANES_INLINE struct lanes3 lanes3_all(struct real3 a)
{
	return (struct lanes3){lanes_all(a.x), lanes_all(a.y), lanes_all(a.z)};
}

LANES_INLINE struct real3 lanes3_lane(struct lanes3 a, u32 lane)
{
	return (struct real3){a.x[lane], a.y[lane], a.z[lane]};
}

LANES_INLINE real real_sqrt(real a)
{
	return lanes_sqrt(lanes_all(a))[0];
}

LANES_INLINE double double_sqrt(double a)
{
	return __builtin_ia32_sqrtpd((double_pair){a, a})[0];
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
	return (struct real3){a.x * s, a.y * s, a.z * s};
}

LANES_INLINE real real3_dot(struct real3 a, struct real3 b)
{
	return a.x * b.x + a.y * b.y + a.z * b.z;
}

LANES_INLINE struct real3 real3_cross(struct real3 a, struct real3 b)
{
	return (struct real3){a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

LANES_INLINE real real3_length(struct real3 a)
{
	return real_sqrt(real3_dot(a, a));
}

#endif /* PHANTOM_FLOAT_LANES_H */
