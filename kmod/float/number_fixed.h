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

#include "root_table.h"

#define FIXED_BITS 36
#define FIXED_ONE (1LL << FIXED_BITS)
#define FIXED_LIMIT (1LL << 61)

/* With the address sanitizer, of either compiler, what is said to fit is looked at. */
#ifdef __SANITIZE_ADDRESS__
#define FIXED_CHECKED
#elif defined(__has_feature)
#if __has_feature(address_sanitizer)
#define FIXED_CHECKED
#endif
#endif

typedef s64 real;
typedef s64 fine; /* with FINE_BITS behind the point */
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

/*
 * a b: one multiplication. The compiler, where it knows the sign of a factor, would take it for one of
 * 128 bits and multiply three times.
 */
LANES_INLINE __int128 fixed_product(s64 a, s64 b)
{
	u64 low, high;

	asm("imulq %3" : "=a"(low), "=d"(high) : "%a"(a), "rm"(b) : "cc");
	return (__int128)((__uint128_t)high << 64 | low);
}

/* Shifts and an or: shrd takes AMD's cores three times as long. */
LANES_INLINE real fixed_shift(__int128 product)
{
	u64 high = (u64)(product >> 64), low = (u64)product;

	/* fits below the limit when nothing but the sign is above bit 61 + FIXED_BITS */
	if (__builtin_expect((high + (1ULL << (FIXED_BITS - 3))) >> (FIXED_BITS - 2) != 0, 0))
		return high >> 63 ? -FIXED_LIMIT : FIXED_LIMIT;
	return (real)(high << (64 - FIXED_BITS) | low >> FIXED_BITS);
}

/* The same where the caller knows that it fits, below 2^63: a trap, where tests look for that. */
LANES_INLINE real fixed_shift_fitting(__int128 product)
{
#ifdef FIXED_CHECKED
	if (product >> (63 + FIXED_BITS) != 0 && product >> (63 + FIXED_BITS) != -1)
		__builtin_trap();
#endif
	return (real)((u64)(product >> 64) << (64 - FIXED_BITS) | (u64)product >> FIXED_BITS);
}

LANES_INLINE real real_mul(real a, real b)
{
	return fixed_shift(fixed_product(a, b));
}

LANES_INLINE real real_mul_sub(real a, real b, real c, real d)
{
	return fixed_shift(fixed_product(a, b) - fixed_product(c, d));
}

LANES_INLINE real real_mul_sum(real a, real b, real c, real d, real e, real f)
{
	return fixed_shift(fixed_product(a, b) + fixed_product(c, d) + fixed_product(e, f));
}

LANES_INLINE real real_mul_fitting(real a, real b)
{
	return fixed_shift_fitting(fixed_product(a, b));
}

LANES_INLINE real real_mul_sub_fitting(real a, real b, real c, real d)
{
	return fixed_shift_fitting(fixed_product(a, b) - fixed_product(c, d));
}

LANES_INLINE real real_mul_sum_fitting(real a, real b, real c, real d, real e, real f)
{
	return fixed_shift_fitting(fixed_product(a, b) + fixed_product(c, d) + fixed_product(e, f));
}

/* The upper half of a b. */
LANES_INLINE s64 fixed_product_high(s64 a, s64 b)
{
	s64 low, high;

	asm("imulq %3" : "=a"(low), "=d"(high) : "%a"(a), "rm"(b) : "cc");
	return high;
}

/*
 * Half of what is to be shifted out of a product, for either factor in advance: then its upper half is the
 * result, and where several products have a factor in common, that one is shifted once.
 */
#define FIXED_SMALL_BITS ((64 - FIXED_BITS) / 2)

/* A factor below 2^13. */
LANES_INLINE s64 fixed_small(s64 a)
{
#ifdef FIXED_CHECKED
	if ((a >> (63 - FIXED_SMALL_BITS)) + 1UL > 1)
		__builtin_trap();
#endif
	return (s64)((u64)a << FIXED_SMALL_BITS);
}

LANES_INLINE real real_mul_small(real a, real b)
{
	return fixed_product_high(fixed_small(a), fixed_small(b));
}

LANES_INLINE real real_mul_sub_small(real a, real b, real c, real d)
{
	return real_mul_small(a, b) - real_mul_small(c, d);
}

LANES_INLINE real real_mul_sum_small(real a, real b, real c, real d, real e, real f)
{
	return real_mul_small(a, b) + real_mul_small(c, d) + real_mul_small(e, f);
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

/*
 * Of a cubic whose terms and heights are scaled so that none is above 1: 2^-56 of that. Nothing in it
 * comes near to the end, 128.
 */
#define FINE_BITS 56

LANES_INLINE fine fine_mul(fine a, fine b)
{
	return (fine)(fixed_product(a, b) >> FINE_BITS);
}

LANES_INLINE fine fine_mul_sub(fine a, fine b, fine c, fine d)
{
	return (fine)((fixed_product(a, b) - fixed_product(c, d)) >> FINE_BITS);
}

LANES_INLINE fine fine_divide(fine a, fine b)
{
	u64 over = fixed_magnitude(a), under = fixed_magnitude(b), quotient;

	if (over >> (61 - FINE_BITS) >= under)
		quotient = over ? FIXED_LIMIT : 0;
	else
		quotient =
			fixed_divide_wide(over >> (64 - FINE_BITS), over << FINE_BITS, under, NULL);
	return (a < 0) != (b < 0) ? -(fine)quotient : (fine)quotient;
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

LANES_INLINE lanes lanes_mul_fitting(lanes a, lanes b)
{
	return (lanes){real_mul_fitting(a[0], b[0])};
}

LANES_INLINE lanes lanes_mul_sub_fitting(lanes a, lanes b, lanes c, lanes d)
{
	return (lanes){real_mul_sub_fitting(a[0], b[0], c[0], d[0])};
}

LANES_INLINE lanes lanes_mul_sum_fitting(lanes a, lanes b, lanes c, lanes d, lanes e, lanes f)
{
	return (lanes){real_mul_sum_fitting(a[0], b[0], c[0], d[0], e[0], f[0])};
}

LANES_INLINE lanes lanes_mul_small(lanes a, lanes b)
{
	return (lanes){real_mul_small(a[0], b[0])};
}

LANES_INLINE lanes lanes_mul_sub_small(lanes a, lanes b, lanes c, lanes d)
{
	return (lanes){real_mul_sub_small(a[0], b[0], c[0], d[0])};
}

LANES_INLINE lanes lanes_mul_sum_small(lanes a, lanes b, lanes c, lanes d, lanes e, lanes f)
{
	return (lanes){real_mul_sum_small(a[0], b[0], c[0], d[0], e[0], f[0])};
}

/* Both real, or both lanes. */
#define mul(a, b) _Generic((a), lanes : lanes_mul, default : real_mul)(a, b)
#define divide(a, b) _Generic((a), lanes : lanes_divide, default : real_divide)(a, b)
#define mul_sub(a, b, c, d) _Generic((a), lanes : lanes_mul_sub, default : real_mul_sub)(a, b, c, d)
#define mul_sum(a, b, c, d, e, f)                                                                  \
	_Generic((a), lanes : lanes_mul_sum, default : real_mul_sum)(a, b, c, d, e, f)
#define mul_fitting(a, b) _Generic((a), lanes : lanes_mul_fitting, default : real_mul_fitting)(a, b)
#define mul_sub_fitting(a, b, c, d)                                                                \
	_Generic((a), lanes : lanes_mul_sub_fitting, default : real_mul_sub_fitting)(a, b, c, d)
#define mul_sum_fitting(a, b, c, d, e, f)                                                          \
	_Generic((a), lanes                                                                        \
		 : lanes_mul_sum_fitting, default                                                  \
		 : real_mul_sum_fitting)(a, b, c, d, e, f)

#define mul_small(a, b) _Generic((a), lanes : lanes_mul_small, default : real_mul_small)(a, b)
#define mul_sub_small(a, b, c, d)                                                                  \
	_Generic((a), lanes : lanes_mul_sub_small, default : real_mul_sub_small)(a, b, c, d)
#define mul_sum_small(a, b, c, d, e, f)                                                            \
	_Generic((a), lanes : lanes_mul_sum_small, default : real_mul_sum_small)(a, b, c, d, e, f)

/* a b; `small` where the caller knows that both are. */
LANES_INLINE lanes mul_known(bool small, lanes a, lanes b)
{
	return small ? lanes_mul_small(a, b) : lanes_mul(a, b);
}

/* a / parts, rounded down; a power of two. */
#define lanes_part(a, parts) ((a) >> __builtin_ctz(parts))

/* ---- roots ------------------------------------------------------------------ */

LANES_INLINE u64 fixed_high(u64 a, u64 b)
{
	return (u64)((__uint128_t)a * b >> 64);
}

/*
 * 1 / sqrt(x), Q62, within 1e-12 of it, of an x in [1/4, 1) of 2^64: y from the table, then one step of third
 * order, y (1 + e / 2 + 3 e^2 / 8) with e = 1 - x y^2.
 */
LANES_INLINE u64 fixed_inverse_root(u64 x)
{
	const u32 *line = root_table[(x >> (64 - ROOT_TABLE_BITS)) - ROOT_TABLE_FIRST];
	u64 beyond = x << ROOT_TABLE_BITS >> 32;
	u64 y = ((u64)line[0] << 31) - (line[1] * beyond >> 1);
	/* Q60, below 2^47 */
	s64 e = (s64)((1ULL << 60) - fixed_high(x, fixed_high(y, y)));
	s64 e16 = e >> 16;
	s64 step = (e >> 1) + ((e16 * e16 >> 28) * 3 >> 3);

	return y + ((u64)(fixed_product((s64)(y >> 1), step) >> 64) << 5);
}

/* sqrt(a) 2^32, within 2e-12 of it. */
static inline u64 fixed_root(u64 a)
{
	u32 shift;
	u64 x;

	if (!a)
		return 0;
	/* a 2^shift in [1/4, 1) of 2^64; its root is x / sqrt(x), Q62 */
	shift = (u32)__builtin_clzll(a) & ~1U;
	x = a << shift;
	return fixed_high(x, fixed_inverse_root(x)) << 2 >> shift / 2;
}

/* 0 of what is negative. */
LANES_INLINE real real_sqrt(real a)
{
	return a > 0 ? (real)(fixed_root((u64)a) >> (32 - FIXED_BITS / 2)) : 0;
}

LANES_INLINE fine fine_sqrt(fine a)
{
	return a > 0 ? (fine)(fixed_root((u64)a) >> (32 - FINE_BITS / 2)) : 0;
}

LANES_INLINE lanes lanes_sqrt(lanes a)
{
	return (lanes){real_sqrt(a[0])};
}

/* A vector made as long as fits, with what its length and its direction follow from. */
struct fixed_vector {
	s64 x, y, z; /* times 2^shift: the largest has 63 bits with its sign, or one less */
	u64 inverse; /* Q61, of the root of its square's upper half, made one of [1/4, 1) by 4^even */
	u64 square;
	u32 shift, even;
};

LANES_INLINE struct fixed_vector fixed_vector(real x, real y, real z)
{
	u64 most = fixed_magnitude(x) | fixed_magnitude(y) | fixed_magnitude(z);
	struct fixed_vector out;

	/* a vector of no length stays so */
	out.shift = (u32)__builtin_clzll(most | 1) - (most != 0);
	out.x = (s64)((u64)x << out.shift);
	out.y = (s64)((u64)y << out.shift);
	out.z = (s64)((u64)z << out.shift);
	/* 2^60 ... 2^64 */
	out.square = (u64)(fixed_product_high(out.x, out.x) + fixed_product_high(out.y, out.y)) +
		     (u64)fixed_product_high(out.z, out.z);
	if (!most)
		out.square = 1ULL << 60;
	out.even = (u32)(out.square >> 62 == 0);
	out.square <<= 2 * out.even;
	out.inverse = fixed_inverse_root(out.square) >> 1;
	return out;
}

/* |(x, y, z)|, as precise for nm as for m. */
LANES_INLINE real fixed_vector_length(const struct fixed_vector *v)
{
	/* the root is square inverse, Q61, of 2^64 */
	u64 length = fixed_high(v->square, v->inverse) << 3 >> v->even >> v->shift;

	/* of saturated numbers up to 2^61.8 */
	return length >> 62 ? 1LL << 62 : (real)length;
}

LANES_INLINE real real_length(real x, real y, real z)
{
	struct fixed_vector v = fixed_vector(x, y, z);

	return fixed_vector_length(&v);
}

LANES_INLINE lanes lanes_length(lanes x, lanes y, lanes z)
{
	return (lanes){real_length(x[0], y[0], z[0])};
}

/* Of length 1. No length stays so. */
LANES_INLINE void fixed_vector_unit(const struct fixed_vector *v, lanes *x, lanes *y, lanes *z)
{
	/* a / |(a, b, c)| 2^36 = a inverse 2^-61 2^even 2^-64 2^36 */
	u32 shift = 25 - v->even;

	*x = (lanes){fixed_product_high(v->x, (s64)v->inverse) >> shift};
	*y = (lanes){fixed_product_high(v->y, (s64)v->inverse) >> shift};
	*z = (lanes){fixed_product_high(v->z, (s64)v->inverse) >> shift};
}

LANES_INLINE void lanes_unit(lanes *x, lanes *y, lanes *z)
{
	struct fixed_vector v = fixed_vector((*x)[0], (*y)[0], (*z)[0]);

	fixed_vector_unit(&v, x, y, z);
}

struct measured {
	struct fixed_vector vector;
	lanes length;
};

LANES_INLINE struct measured lanes_measure(lanes x, lanes y, lanes z)
{
	struct measured out = {.vector = fixed_vector(x[0], y[0], z[0])};

	out.length = (lanes){fixed_vector_length(&out.vector)};
	return out;
}

/* Of length 1, of the vector that was measured. */
LANES_INLINE void lanes_unit_measured(lanes *x, lanes *y, lanes *z, const struct measured *measured,
				      mask_lanes mask)
{
	(void)mask;
	fixed_vector_unit(&measured->vector, x, y, z);
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

/* product 2^-bits, saturated; bits = 27 ... 126. */
LANES_INLINE real fixed_shift_by(__int128 product, u32 bits)
{
	s64 high = (s64)(product >> 64);
	u64 low = (u64)product;

	if (bits >= 64)
		high >>= bits - 64;
	else if ((u64)(high >> (bits - 3)) + 1 > 1)
		return high < 0 ? -FIXED_LIMIT : FIXED_LIMIT;
	else
		return (real)((u64)high << (64 - bits) | low >> bits);
	return high > FIXED_LIMIT ? FIXED_LIMIT : high < -FIXED_LIMIT ? -FIXED_LIMIT : high;
}

/* sqrt(a / b) of what is not negative, b > 0, of any size: a / sqrt(a b). */
LANES_NOINLINE real fixed_root_of_any_ratio(real a, real b)
{
	__uint128_t product = (__uint128_t)(u64)a * (u64)b;
	u64 high = (u64)(product >> 64), low = (u64)product, inverse;
	u32 shift;

	if (!product)
		return 0;
	shift = (u32)(high ? __builtin_clzll(high) : 64 + __builtin_clzll(low)) & ~1U;
	/* Q61 */
	inverse = fixed_inverse_root((u64)(product << shift >> 64)) >> 1;
	return fixed_shift_by(fixed_product(a, (s64)inverse), 89 - shift / 2);
}

/* 2^64 / sqrt(2) */
#define FIXED_ROOT_HALF 0xb504f333f9de6484ULL

/* The same; fast where both are below 2 and their product is from 1/2 to below 2. */
LANES_INLINE lanes lanes_root_of_ratio(lanes a, lanes b)
{
	u64 over = (u64)a[0] << (63 - FIXED_BITS), under = (u64)b[0] << (63 - FIXED_BITS);
	/* a b / 4 of 2^64 */
	u64 half = fixed_high(over, under);

	if (__builtin_expect(
		    (u64)(a[0] | b[0]) >> (FIXED_BITS + 1) || half - (1ULL << 61) >= 3ULL << 61, 0))
		return (lanes){fixed_root_of_any_ratio(a[0], b[0])};
	half <<= 1;
	/* a / sqrt(a b / 2), Q61 */
	half = fixed_high(over, fixed_inverse_root(half));
	return (lanes){(s64)(fixed_high(half, FIXED_ROOT_HALF) >> (61 - FIXED_BITS))};
}

/* a, b and c, none of them negative, with the largest brought to [1/2, 1]: to be compared. */
LANES_INLINE void lanes_bring_to_one(lanes *a, lanes *b, lanes *c)
{
	u64 all = (u64)((*a)[0] | (*b)[0] | (*c)[0] | 1);
	u32 shift = (u32)__builtin_clzll(all);

	*a = (lanes){(s64)((u64)(*a)[0] << shift >> (64 - FIXED_BITS))};
	*b = (lanes){(s64)((u64)(*b)[0] << shift >> (64 - FIXED_BITS))};
	*c = (lanes){(s64)((u64)(*c)[0] << shift >> (64 - FIXED_BITS))};
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

/* mm: with it, and edges of some m, all that is reckoned with in a shell is small. */
#define FIXED_HEIGHT_MAX REAL(2000)

LANES_INLINE real real_limit_height(real mm)
{
	return mm < FIXED_HEIGHT_MAX ? mm : FIXED_HEIGHT_MAX;
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
