/* SPDX-License-Identifier: GPL-2.0-only */
/*
 * wide_soft.h - float64 in integers, for preparing a set where there is no float.
 *
 * IEEE 754 binary64, rounded to nearest even, bit for bit what the FPU gives, but for what no
 * preparation needs: below 2^-1022 is 0, above the largest number is that number, and there is no
 * infinity and nothing that is no number: a division by 0 gives the largest number.
 */
#ifndef PHANTOM_FLOAT_WIDE_SOFT_H
#define PHANTOM_FLOAT_WIDE_SOFT_H

typedef struct {
	u64 bits; /* of the double */
} wide;

#define WIDE_SIGN (1ULL << 63)
#define WIDE_HIDDEN (1ULL << 52)
#define WIDE_LARGEST 0x7fefffffffffffffULL

/* A constant; the compiler forms the double, and its bytes are copied. */
#define WIDE(x)                                                                                    \
	({                                                                                         \
		const double wide_constant = (x);                                                  \
		wide wide_bits;                                                                    \
		__builtin_memcpy(&wide_bits, &wide_constant, sizeof(wide_bits));                   \
		wide_bits;                                                                         \
	})

/* |a| = mantissa 2^exponent; a mantissa of 53 bits, 0 for 0. */
LANES_INLINE u64 wide_mantissa(wide a)
{
	return a.bits << 1 >> 53 ? (a.bits & (WIDE_HIDDEN - 1)) | WIDE_HIDDEN : 0;
}

LANES_INLINE s32 wide_exponent(wide a)
{
	return (s32)(a.bits << 1 >> 53) - 1075;
}

/* The number nearest to mantissa 2^exponent; bit 0 stands for all that was cut off below it. */
static inline wide wide_round(u64 sign, u64 mantissa, s32 exponent)
{
	u32 shift;
	u64 below;

	if (!mantissa)
		return (wide){0};
	shift = (u32)__builtin_clzll(mantissa);
	mantissa <<= shift;
	exponent += 11 + 1075 - (s32)shift;
	below = mantissa & 0x7ff;
	mantissa >>= 11;
	if (below > 0x400 || (below == 0x400 && (mantissa & 1)))
		mantissa++;
	if (mantissa >> 53) {
		mantissa >>= 1;
		exponent++;
	}
	if (exponent <= 0)
		return (wide){0};
	if (exponent >= 2047)
		return (wide){sign | WIDE_LARGEST};
	return (wide){sign | (u64)exponent << 52 | (mantissa & (WIDE_HIDDEN - 1))};
}

static inline wide wide_from_integer(s64 a)
{
	return wide_round(a < 0 ? WIDE_SIGN : 0, fixed_magnitude(a), 0);
}

static inline wide wide_add(wide a, wide b)
{
	u64 large, small, lost;
	u32 apart;

	if ((a.bits & ~WIDE_SIGN) < (b.bits & ~WIDE_SIGN)) {
		wide swap = a;

		a = b;
		b = swap;
	}
	large = wide_mantissa(a) << 10;
	small = wide_mantissa(b) << 10;
	if (!small)
		return a;
	apart = (u32)(wide_exponent(a) - wide_exponent(b));
	lost = apart > 63 ? small : small & ((1ULL << apart) - 1);
	small = apart > 63 ? 0 : small >> apart;
	small |= lost != 0;
	large = (a.bits ^ b.bits) & WIDE_SIGN ? large - small : large + small;
	return wide_round(a.bits & WIDE_SIGN, large, wide_exponent(a) - 10);
}

static inline wide wide_sub(wide a, wide b)
{
	return wide_add(a, (wide){b.bits ^ WIDE_SIGN});
}

static inline wide wide_mul(wide a, wide b)
{
	__uint128_t product = (__uint128_t)(wide_mantissa(a) << 11) * (wide_mantissa(b) << 11);
	u64 high = (u64)(product >> 64) | ((u64)product != 0);

	return wide_round((a.bits ^ b.bits) & WIDE_SIGN, high,
			  wide_exponent(a) + wide_exponent(b) - 22 + 64);
}

static inline wide wide_div(wide a, wide b)
{
	u64 over = wide_mantissa(a) << 10, under = wide_mantissa(b) << 11, rest, quotient;
	u64 sign = (a.bits ^ b.bits) & WIDE_SIGN;

	if (!under)
		return (wide){sign | WIDE_LARGEST};
	quotient = fixed_divide_wide(over, 0, under, &rest);
	return wide_round(sign, quotient | (rest != 0), wide_exponent(a) - wide_exponent(b) - 63);
}

/* 0 of what is negative. */
static inline wide wide_sqrt(wide a)
{
	s32 exponent = wide_exponent(a);
	__uint128_t square;
	u64 root;

	if (!wide_mantissa(a) || a.bits & WIDE_SIGN)
		return (wide){0};
	/* mantissa 2^(72 or 73), so that what is left of the exponent is even; 2^124 ... 2^126 */
	square = (__uint128_t)wide_mantissa(a) << (exponent & 1 ? 73 : 72);
	exponent -= exponent & 1 ? 73 : 72;
	root = fixed_root((u64)(square >> 64));
	/* one more Newton step, then to the last bit */
	root = root / 2 + fixed_divide_wide((u64)(square >> 64), (u64)square, root, NULL) / 2;
	while ((__uint128_t)root * root > square)
		root--;
	while ((__uint128_t)(root + 1) * (root + 1) <= square)
		root++;
	return wide_round(0, root | ((__uint128_t)root * root != square), exponent / 2);
}

LANES_INLINE bool wide_less(wide a, wide b)
{
	/* the order of their bits, turned round below zero; -0 does not occur */
	s64 left = a.bits >> 63 ? -(s64)(a.bits & ~WIDE_SIGN) : (s64)a.bits;
	s64 right = b.bits >> 63 ? -(s64)(b.bits & ~WIDE_SIGN) : (s64)b.bits;

	return left < right;
}

/* Q36, to nearest, saturated. */
static inline real real_from_wide(wide a)
{
	s32 shift = wide_exponent(a) + FIXED_BITS;
	u64 magnitude = wide_mantissa(a);

	if (shift > 61 - 53)
		magnitude = magnitude ? FIXED_LIMIT : 0;
	else if (shift >= 0)
		magnitude <<= shift;
	else if (shift > -55)
		magnitude = (magnitude + (1ULL << (-shift - 1))) >> -shift;
	else
		magnitude = 0;
	return a.bits >> 63 ? -(real)magnitude : (real)magnitude;
}

/* Leaves room for products with distances of some mm. */
LANES_INLINE bool wide_fits(wide a)
{
	return fixed_magnitude(real_from_wide(a)) < (u64)REAL(1.6e7);
}

#endif /* PHANTOM_FLOAT_WIDE_SOFT_H */
