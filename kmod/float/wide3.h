/* SPDX-License-Identifier: GPL-2.0-only */
/*
 * wide3.h - vectors of float64 (`wide`: in software where there is no float).
 */
#ifndef PHANTOM_FLOAT_WIDE3_H
#define PHANTOM_FLOAT_WIDE3_H

#include "lanes.h"

struct wide3 {
	wide x, y, z;
};

LANES_INLINE struct wide3 wide3_sub(struct wide3 a, struct wide3 b)
{
	return (struct wide3){wide_sub(a.x, b.x), wide_sub(a.y, b.y), wide_sub(a.z, b.z)};
}

LANES_INLINE struct wide3 wide3_add(struct wide3 a, struct wide3 b)
{
	return (struct wide3){wide_add(a.x, b.x), wide_add(a.y, b.y), wide_add(a.z, b.z)};
}

LANES_INLINE struct wide3 wide3_scale(struct wide3 a, wide s)
{
	return (struct wide3){wide_mul(a.x, s), wide_mul(a.y, s), wide_mul(a.z, s)};
}

static inline wide wide3_dot(struct wide3 a, struct wide3 b)
{
	return wide_add(wide_add(wide_mul(a.x, b.x), wide_mul(a.y, b.y)), wide_mul(a.z, b.z));
}

static inline struct wide3 wide3_cross(struct wide3 a, struct wide3 b)
{
	return (struct wide3){wide_sub(wide_mul(a.y, b.z), wide_mul(a.z, b.y)),
			      wide_sub(wide_mul(a.z, b.x), wide_mul(a.x, b.z)),
			      wide_sub(wide_mul(a.x, b.y), wide_mul(a.y, b.x))};
}

static inline wide wide3_length(struct wide3 a)
{
	return wide_sqrt(wide3_dot(a, a));
}

LANES_INLINE struct wide3 wide3_from_integers(s64 x, s64 y, s64 z)
{
	return (struct wide3){wide_from_integer(x), wide_from_integer(y), wide_from_integer(z)};
}

LANES_INLINE wide wide_inverse(wide a)
{
	return wide_div(WIDE(1), a);
}

#endif /* PHANTOM_FLOAT_WIDE3_H */
