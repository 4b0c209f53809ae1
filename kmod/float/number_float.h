/* SPDX-License-Identifier: GPL-2.0-only */
/*
 * number_float.h - reals are float32 or float64. Included by lanes.h.
 *
 * Every operation here works lane by lane and is exactly rounded (IEEE 754 add, multiply, divide,
 * square root, convert), so the width never changes a bit. GCC vector extensions and builtins only:
 * the kernel has no intrinsic headers and no libm.
 */
#ifndef PHANTOM_FLOAT_NUMBER_FLOAT_H
#define PHANTOM_FLOAT_NUMBER_FLOAT_H

#ifdef PHANTOM_REAL_DOUBLE
typedef double real;
typedef s64 mask_element;
typedef double coordinate; /* a nm integer, exact in float64 */
#else
#define PHANTOM_REAL_SINGLE
typedef float real;
typedef s32 mask_element;
typedef s32 coordinate;
#endif

typedef real lanes __attribute__((vector_size(PHANTOM_LANES * sizeof(real))));
typedef mask_element mask_lanes __attribute__((vector_size(PHANTOM_LANES * sizeof(real))));
typedef coordinate nm_lanes __attribute__((vector_size(PHANTOM_LANES * sizeof(coordinate))));

typedef double double_pair __attribute__((vector_size(16)));

/* A real of which one at a time is worked on, where float32 would not do. */
typedef double fine;

/* A constant. */
#define REAL(x) ((real)(x))

#define fine_mul mul
#define fine_divide divide
#define fine_mul_sub mul_sub

/* Larger than any squared distance, mm^2. */
#define REAL_MOST REAL(1e30)

/* Keeps a division by what may be zero finite. */
#define REAL_TINY REAL(1e-30)

/* Relative to the largest of three factors: smaller ones are 0, so that no product underflows. */
#define REAL_VANISHING REAL(1e-18)

/* A length whose square is above float32's smallest normal number. */
#define REAL_SMALLEST REAL(3e-19)

/* Forces may be added up by the thousand: nothing to limit here. */
#define real_limit_force(n) (n)
#define lanes_limit_force(n) (n)

/* Nor is a shell too high. */
#define real_limit_height(mm) (mm)

/* Both real, or both lanes. */
#define mul(a, b) ((a) * (b))
#define divide(a, b) ((a) / (b))

/* a b - c d, and a b + c d + e f */
#define mul_sub(a, b, c, d) ((a) * (b) - (c) * (d))
#define mul_sum(a, b, c, d, e, f) ((a) * (b) + (c) * (d) + (e) * (f))

/* The same; in fixed point without a look at the size of the result. */
#define mul_fitting mul
#define mul_sub_fitting mul_sub
#define mul_sum_fitting mul_sum

/* And of factors that are small, below 2^13 (mm, or of any unit): in fixed point the fastest. */
#define mul_small mul
#define mul_sub_small mul_sub
#define mul_sum_small mul_sum

/* a b; `small` where the caller knows that both are. */
LANES_INLINE lanes mul_known(bool small, lanes a, lanes b)
{
	(void)small;
	return mul(a, b);
}

/* a / parts; a power of two. */
#define lanes_part(a, parts) ((a) * (REAL(1) / (parts)))

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

LANES_INLINE lanes lanes_length(lanes x, lanes y, lanes z)
{
	return lanes_sqrt(x * x + y * y + z * z);
}

/* sqrt(a / b) */
LANES_INLINE lanes lanes_root_of_ratio(lanes a, lanes b)
{
	return lanes_sqrt(a / b);
}

LANES_INLINE real real_sqrt(real a)
{
	return lanes_sqrt((lanes){} + a)[0];
}

/* x, y and z, each over s. */
LANES_INLINE void lanes_over(lanes *x, lanes *y, lanes *z, lanes s)
{
	lanes inverse = 1 / s;

	*x *= inverse;
	*y *= inverse;
	*z *= inverse;
}

/* a, b and c, none of them negative, over the largest: to be compared with one another. */
LANES_INLINE void lanes_bring_to_one(lanes *a, lanes *b, lanes *c)
{
	lanes most = lanes_max(lanes_max(*a, *b), *c);

	lanes_over(a, b, c, lanes_max(most, (lanes){} + REAL_TINY));
}

/* Of length 1; of no length stays so. */
LANES_INLINE void lanes_unit(lanes *x, lanes *y, lanes *z)
{
	lanes_over(x, y, z, lanes_max(lanes_length(*x, *y, *z), (lanes){} + REAL_SMALLEST));
}

struct measured {
	lanes length;
};

LANES_INLINE struct measured lanes_measure(lanes x, lanes y, lanes z)
{
	return (struct measured){lanes_length(x, y, z)};
}

/* Of length 1, of the vector that was measured; in lanes of the mask, where it is not 0. */
LANES_INLINE void lanes_unit_measured(lanes *x, lanes *y, lanes *z, const struct measured *measured,
				      mask_lanes mask)
{
	lanes one = (lanes){} + 1;

	lanes_over(x, y, z,
		   (lanes)((mask & (mask_lanes)measured->length) | (~mask & (mask_lanes)one)));
}

/* False for an infinity or what is no number. */
LANES_INLINE bool real_finite(real a)
{
	return a - a == 0;
}

/* A coordinate or a distance in nm, as mm. */
LANES_INLINE real real_from_nm(s64 nm)
{
	return (real)nm * REAL(1e-6);
}

LANES_INLINE lanes lanes_from_nm(nm_lanes nm)
{
	return __builtin_convertvector(nm, lanes) * REAL(1e-6);
}

LANES_INLINE s64 real_round(real a)
{
	return (s64)(a + (a < 0 ? REAL(-0.5) : REAL(0.5)));
}

/* mm to whole nm, no farther than 4 m. */
LANES_INLINE s64 real_to_nm(real mm)
{
	real nm = mm * REAL(1e6);

	return real_round(nm < REAL(-4e9) ? REAL(-4e9) : nm > REAL(4e9) ? REAL(4e9) : nm);
}

/* part (0 ... 1) of a way, to the nearest nm. */
LANES_INLINE s64 real_part_of_nm(real part, s64 way_nm)
{
	return real_round(part * (real)way_nm);
}

/* a / b of two ways in nm. */
LANES_INLINE real real_ratio_of_nm(s64 a_nm, s64 b_nm)
{
	return (real)a_nm / (real)b_nm;
}

/* value * scale as an integer of the border, saturated and counted. */
LANES_INLINE s32 real_to_integer(real value, s32 scale, u32 *saturated)
{
	real scaled = value * (real)scale;

	if (scaled > REAL(-2147483648.0) && scaled < REAL(2147483648.0)) {
		s64 rounded = real_round(scaled);

		return rounded > 0x7fffffff ? 0x7fffffff : (s32)rounded;
	}
	(*saturated)++;
	return scaled > 0 ? 0x7fffffff : -0x7fffffff - 1;
}

/* ---- four integers at once ------------------------------------------------ */

typedef u32 index_quad __attribute__((vector_size(16), may_alias));
typedef float index_sign __attribute__((vector_size(16)));

/* Bit i is set where row[i] is the value; i = 0 ... 3. */
LANES_INLINE u32 index_equals(const u32 *row, u32 value)
{
	index_quad all = (index_quad){} + value;

	return (u32)__builtin_ia32_movmskps((index_sign)(*(const index_quad *)row == all));
}

/* ---- wide: what a set is prepared in -------------------------------------- */

typedef double wide;

#define WIDE(x) ((double)(x))

LANES_INLINE wide wide_from_integer(s64 a)
{
	return (double)a;
}

LANES_INLINE wide wide_add(wide a, wide b)
{
	return a + b;
}

LANES_INLINE wide wide_sub(wide a, wide b)
{
	return a - b;
}

LANES_INLINE wide wide_mul(wide a, wide b)
{
	return a * b;
}

LANES_INLINE wide wide_div(wide a, wide b)
{
	return a / b;
}

LANES_INLINE wide wide_sqrt(wide a)
{
	return __builtin_ia32_sqrtpd((double_pair){a, a})[0];
}

LANES_INLINE fine fine_sqrt(fine a)
{
	return wide_sqrt(a);
}

LANES_INLINE bool wide_less(wide a, wide b)
{
	return a < b;
}

LANES_INLINE real real_from_wide(wide a)
{
	return (real)a;
}

/* Can it be reckoned with as a real? */
LANES_INLINE bool wide_fits(wide a)
{
	(void)a;
	return true;
}

#endif /* PHANTOM_FLOAT_NUMBER_FLOAT_H */
