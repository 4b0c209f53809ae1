/* SPDX-License-Identifier: GPL-2.0-only */
/*
 * number_fixed.h - reals are fixed-point integers: no float register is touched, so the unit may run
 * where the FPU may not. Included by lanes.h.
 *
 * A real is Q36 in 64 bits, one to a lane: steps of 1.5e-11 (of a mm, a N, a unit normal), up to
 * 3.3e7. Products are formed in 128 bits, shifted once and saturated there, so nothing wraps: four
 * saturated values add up to less than 2^63.
 *
 * What it is worth: 1.5e-11 is 1/70,000 nm, but a number is as precise as it is large, not 24 bits
 * at any size. Patches whose cubic does not fit (below some 0.3 um across) are refused.
 */
#ifndef PHANTOM_FLOAT_NUMBER_FIXED_H
#define PHANTOM_FLOAT_NUMBER_FIXED_H

#define FIXED_BITS 36
#define FIXED_ONE (1LL << FIXED_BITS)
#define FIXED_LIMIT (1LL << 61)

typedef s64 real;
typedef s64 mask_element;
typedef s64 coordinate;

typedef real lanes __attribute__((vector_size(PHANTOM_LANES * sizeof(real))));
typedef lanes mask_lanes;
typedef lanes nm_lanes;

_Static_assert(PHANTOM_LANES == 1, "one fixed-point number to a lane");

/* A constant; the compiler forms the double. */
#define REAL(x) ((real)((x) * (double)FIXED_ONE))

#define REAL_MOST FIXED_LIMIT
#define REAL_TINY REAL(1e-7)
#define REAL_VANISHING REAL(8e-6)

/* ---- products and quotients ------------------------------------------------ */

LANES_INLINE real fixed_shift(__int128 product)
{
	s64 high = (s64)(product >> 64);

	/* fits below the limit when nothing but the sign is above bit 61 + FIXED_BITS */
	if ((u64)(high >> (FIXED_BITS - 3)) + 1 > 1)
		return high < 0 ? -FIXED_LIMIT : FIXED_LIMIT;
	return (real)(product >> FIXED_BITS);
}

LANES_INLINE real real_mul(real a, real b)
{
	return fixed_shift((__int128)a * b);
}

LANES_INLINE real real_mul_sub(real a, real b, real c, real d)
{
	return fixed_shift((__int128)a * b - (__int128)c * d);
}

LANES_INLINE real real_mul_sum(real a, real b, real c, real d, real e, real f)
{
	return fixed_shift((__int128)a * b + (__int128)c * d + (__int128)e * f);
}

/* high 2^64 / divisor, rounded down; *remainder may be NULL. high < divisor. */
LANES_INLINE u64 fixed_divide_wide(u64 high, u64 low, u64 divisor, u64 *remainder)
{
	u64 quotient, rest;

	asm("divq %4" : "=a"(quotient), "=d"(rest) : "a"(low), "d"(high), "r"(divisor) : "cc");
	if (remainder)
		*remainder = rest;
	return quotient;
}

LANES_INLINE u64 fixed_magnitude(s64 a)
{
	return a < 0 ? -(u64)a : (u64)a;
}

LANES_INLINE real real_divide(real a, real b)
{
	u64 over = fixed_magnitude(a), under = fixed_magnitude(b), quotient;

	if (over >> (61 - FIXED_BITS) >= under)
		quotient = over ? FIXED_LIMIT : 0;
	else
		quotient = fixed_divide_wide(over >> (64 - FIXED_BITS), over << FIXED_BITS, under,
					     NULL);
	return (a < 0) != (b < 0) ? -(real)quotient : (real)quotient;
}

LANES_INLINE lanes lanes_mul(lanes a, lanes b)
{
	return (lanes){real_mul(a[0], b[0])};
}

LANES_INLINE lanes lanes_divide(lanes a, lanes b)
{
	return (lanes){real_divide(a[0], b[0])};
}

LANES_INLINE lanes lanes_mul_sub(lanes a, lanes b, lanes c, lanes d)
{
	return (lanes){real_mul_sub(a[0], b[0], c[0], d[0])};
}

LANES_INLINE lanes lanes_mul_sum(lanes a, lanes b, lanes c, lanes d, lanes e, lanes f)
{
	return (lanes){real_mul_sum(a[0], b[0], c[0], d[0], e[0], f[0])};
}

/* Both real, or both lanes. */
#define mul(a, b) _Generic((a), lanes : lanes_mul, default : real_mul)(a, b)
#define divide(a, b) _Generic((a), lanes : lanes_divide, default : real_divide)(a, b)
#define mul_sub(a, b, c, d) _Generic((a), lanes : lanes_mul_sub, default : real_mul_sub)(a, b, c, d)
#define mul_sum(a, b, c, d, e, f)                                                                  \
	_Generic((a), lanes : lanes_mul_sum, default : real_mul_sum)(a, b, c, d, e, f)

/* ---- roots ------------------------------------------------------------------ */

#define FIXED_Q62(x) ((u64)((x)*4611686018427387904.0))

LANES_INLINE u64 fixed_high(u64 a, u64 b)
{
	return (u64)((__uint128_t)a * b >> 64);
}

/*
 * sqrt(a) 2^32, within 2e-12 of it. With x = a 2^n in [1/4, 1) of 2^64: y = 1/sqrt(x) by Newton,
 * y (3 - x y^2) / 2, from the straight line that is nowhere off by more than 2.4 % on the octave.
 */
static inline u64 fixed_root(u64 a)
{
	u32 shift, i;
	u64 x, y;

	if (!a)
		return 0;
	shift = (u32)__builtin_clzll(a) & ~1U;
	x = a << shift;
	y = x >> 63 ? FIXED_Q62(1.780888) - fixed_high(x, FIXED_Q62(0.799432))
		    : FIXED_Q62(2.518556) - fixed_high(x, FIXED_Q62(2.261136));
	for (i = 0; i < 3; i++) {
		u64 one = fixed_high(x, fixed_high(y, y)); /* Q60 */

		y = fixed_high(y, (3ULL << 60) - one) << 3;
	}
	/* x y = sqrt(x), Q62 */
	return fixed_high(x, y) << 2 >> shift / 2;
}

/* 0 of what is negative. */
LANES_INLINE real real_sqrt(real a)
{
	return a > 0 ? (real)(fixed_root((u64)a) >> (32 - FIXED_BITS / 2)) : 0;
}

LANES_INLINE lanes lanes_sqrt(lanes a)
{
	return (lanes){real_sqrt(a[0])};
}

/* |(x, y, z)|, as precise for nm as for m: squared when the largest is next to 2^60. */
static inline real real_length(real x, real y, real z)
{
	u64 a = fixed_magnitude(x), b = fixed_magnitude(y), c = fixed_magnitude(z);
	u64 most = a | b | c;
	s32 shift;
	__uint128_t sum;

	if (!most)
		return 0;
	shift = __builtin_clzll(most) - 3;
	if (shift < 0)
		return FIXED_LIMIT;
	a <<= shift;
	b <<= shift;
	c <<= shift;
	sum = (__uint128_t)a * a + (__uint128_t)b * b + (__uint128_t)c * c;
	return (real)(fixed_root((u64)(sum >> 64)) >> shift);
}

LANES_INLINE lanes lanes_length(lanes x, lanes y, lanes z)
{
	return (lanes){real_length(x[0], y[0], z[0])};
}

/* ---- lane by lane ----------------------------------------------------------- */

LANES_INLINE lanes lanes_min(lanes a, lanes b)
{
	return (lanes){a[0] < b[0] ? a[0] : b[0]};
}

LANES_INLINE lanes lanes_max(lanes a, lanes b)
{
	return (lanes){a[0] > b[0] ? a[0] : b[0]};
}

LANES_INLINE u32 mask_bits(mask_lanes mask)
{
	return (u32)mask[0] & 1;
}

/* x, y and z, each over s. */
LANES_INLINE void lanes_over(lanes *x, lanes *y, lanes *z, lanes s)
{
	*x = lanes_divide(*x, s);
	*y = lanes_divide(*y, s);
	*z = lanes_divide(*z, s);
}

/* Of length 1, to the last bit of the direction: made long before it is measured. No length stays so. */
LANES_INLINE void lanes_unit(lanes *x, lanes *y, lanes *z)
{
	u64 most = fixed_magnitude((*x)[0]) | fixed_magnitude((*y)[0]) | fixed_magnitude((*z)[0]);
	s32 shift;

	if (!most)
		return;
	/* 2^42: as long as quotients and the square of the length have room for */
	shift = __builtin_clzll(most) - (64 - 42);
	*x = shift > 0 ? *x << shift : *x;
	*y = shift > 0 ? *y << shift : *y;
	*z = shift > 0 ? *z << shift : *z;
	lanes_over(x, y, z, lanes_length(*x, *y, *z));
}

/* There is no infinity, and all is a number. */
LANES_INLINE bool real_finite(real a)
{
	(void)a;
	return true;
}

/*
 * N: three roots of each of 512 patches add up to less than 2^63. The border's integers end at 2,147 N.
 */
#define FIXED_FORCE_MAX REAL(32768)

LANES_INLINE real real_limit_force(real n)
{
	return n < FIXED_FORCE_MAX ? n : FIXED_FORCE_MAX;
}

LANES_INLINE lanes lanes_limit_force(lanes n)
{
	return (lanes){real_limit_force(n[0])};
}

/* ---- nm and the border ------------------------------------------------------- */

/* 2^36 / 1e6 2^12: mm are 1e-9 of themselves long, all of them alike. |nm| < 2^33. */
#define FIXED_MM_PER_NM 281474977LL

LANES_INLINE real real_from_nm(s64 nm)
{
	return nm * FIXED_MM_PER_NM >> 12;
}

LANES_INLINE lanes lanes_from_nm(nm_lanes nm)
{
	return (lanes){real_from_nm(nm[0])};
}

LANES_INLINE s64 fixed_round(__int128 product)
{
	return (s64)((product + FIXED_ONE / 2) >> FIXED_BITS);
}

/* mm to whole nm, no farther than 4 m. */
LANES_INLINE s64 real_to_nm(real mm)
{
	s64 nm = fixed_round((__int128)mm * 1000000);

	return nm < -4000000000LL ? -4000000000LL : nm > 4000000000LL ? 4000000000LL : nm;
}

/* part (0 ... 1) of a way, to the nearest nm. */
LANES_INLINE s64 real_part_of_nm(real part, s64 way_nm)
{
	return fixed_round((__int128)part * way_nm);
}

/* a / b of two ways in nm. */
LANES_INLINE real real_ratio_of_nm(s64 a_nm, s64 b_nm)
{
	return real_divide(a_nm, b_nm);
}

/* value * scale as an integer of the border, saturated and counted. */
LANES_INLINE s32 real_to_integer(real value, s32 scale, u32 *saturated)
{
	s64 scaled = fixed_round((__int128)value * scale);

	if (scaled > -2147483648LL && scaled < 2147483648LL)
		return (s32)scaled;
	(*saturated)++;
	return scaled > 0 ? 0x7fffffff : -0x7fffffff - 1;
}

/* Bit i is set where row[i] is the value; i = 0 ... 3. */
LANES_INLINE u32 index_equals(const u32 *row, u32 value)
{
	return (u32)(row[0] == value) | (u32)(row[1] == value) << 1 | (u32)(row[2] == value) << 2 |
	       (u32)(row[3] == value) << 3;
}

#include "wide_soft.h"

#endif /* PHANTOM_FLOAT_NUMBER_FIXED_H */
