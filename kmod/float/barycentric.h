/* SPDX-License-Identifier: GPL-2.0-only */
/*
 * barycentric.h - where on a patch's offset triangle the tip is.
 *
 * At height h the corners are X_i = x_i + h m_i, the edges E1 = X1 - X0, E2 = X2 - X0, the area vector
 * A = E1 x E2. With w = P - X0, w0 = P - X1:
 *
 *   b1 = (w x E2) . A / |A|^2     b2 = (E1 x w) . A / |A|^2     b0 = ((E2 - E1) x w0) . A / |A|^2
 *
 * b0 is not 1 - b1 - b2, which would be nothing but rounding at the end of a long edge.
 *
 * P lies in the triangle's plane (c(h) = 0), so any component of those cross products gives the same
 * over the same component of A. Of a lane alone the largest one is taken; a vector of lanes would have
 * to look for it lane by lane, and takes the dot product, which needs no branch.
 */
#ifndef PHANTOM_FLOAT_BARYCENTRIC_H
#define PHANTOM_FLOAT_BARYCENTRIC_H

#include "block.h"

#if PHANTOM_LANES == 1

/* mm^2. Between them one inverse does for all; that of less might not fit, that of more is coarse. */
#define BARYCENTRIC_SMALL REAL(1e-6)
#define BARYCENTRIC_LARGE REAL(100)

/* Above that, 1 - b1 - b2 is as good as b0. */
#define BARYCENTRIC_INNER REAL(1.0 / 32)

/* Farther outside than that is far outside, whatever the size; m0 + b1 (m1 - m0) - b2 (m0 - m2) stays small. */
#define BARYCENTRIC_MOST REAL(1024)

/* E or m along one axis. */
LANES_INLINE lanes row3_axis(const struct row3 *row, u32 step, u32 axis)
{
	const real_row *rows = (const real_row *)row;

	return rows[axis][step];
}

/* Edge i of the offset triangle along one axis. */
LANES_INLINE lanes offset_edge(const struct block *block, u32 step, u32 i, u32 axis, lanes h)
{
	return row3_axis(&block->edge[i].along, step, axis) +
	       mul_small(row3_axis(&block->edge[i].normal_along, step, axis), h);
}

/* P - X_i along one axis. */
LANES_INLINE lanes offset_corner(const struct block *block, u32 step, u32 i,
				 const struct nm_point *tip, u32 axis, lanes h)
{
	return nm_difference(tip->axis[axis], block->corner[i][axis][step]) -
	       mul_small(row3_axis(&block->edge[i].normal, step, axis), h);
}

/* Of the cross product of edge i and P - X_corner the component across u and v. */
LANES_INLINE lanes offset_cross(const struct block *block, u32 step, u32 i, u32 corner,
				const struct nm_point *tip, u32 u, u32 v, lanes h)
{
	return mul_sub_small(
		offset_edge(block, step, i, u, h), offset_corner(block, step, corner, tip, v, h),
		offset_edge(block, step, i, v, h), offset_corner(block, step, corner, tip, u, h));
}

/* P - sum b_i X_i along one axis. */
LANES_INLINE lanes offset_away(const struct block *block, u32 step, const struct nm_point *tip,
			       lanes h, const lanes b[3], u32 axis)
{
	return offset_corner(block, step, 0, tip, axis, h) +
	       mul_sub(offset_edge(block, step, 2, axis, h), b[2],
		       offset_edge(block, step, 0, axis, h), b[1]);
}

/*
 * b0 b1 b2. `area` is A / |A0|, with a fan's power of h taken out of it. Returns the lanes of `valid` whose
 * A is not 0 and whose b are of some size.
 */
LANES_INLINE mask_lanes barycentric_solve(const struct block *block, u32 step,
					  const struct nm_point *tip, lanes h, struct lanes3 area,
					  const lanes *power, mask_lanes valid, lanes b[3])
{
	lanes x = lanes_abs(area.x), y = lanes_abs(area.y), z = lanes_abs(area.z);
	u32 axis = x[0] > y[0] ? (x[0] > z[0] ? 0 : 2) : (y[0] > z[0] ? 1 : 2);
	u32 u = axis < 2 ? axis + 1 : 0, v = axis ? axis - 1 : 2;
	real size;
	lanes under = mul(axis ? axis == 1 ? area.y : area.z : area.x, block->area[step]), inverse;

	if (power)
		under = mul(under, *power);
	valid &= under != 0;
	b[1] = offset_cross(block, step, 2, 0, tip, u, v, h);
	b[2] = offset_cross(block, step, 0, 0, tip, u, v, h);
	size = lanes_abs(under)[0];
	if (__builtin_expect(size < BARYCENTRIC_SMALL || size > BARYCENTRIC_LARGE, 0)) {
		b[1] = divide(b[1], under);
		b[2] = divide(b[2], under);
		b[0] = divide(offset_cross(block, step, 1, 1, tip, u, v, h), under);
	} else {
		inverse = divide(lanes_all(REAL(1)), under);
		b[1] = mul(b[1], inverse);
		b[2] = mul(b[2], inverse);
		b[0] = REAL(1) - b[1] - b[2];
		if (b[0][0] < BARYCENTRIC_INNER)
			b[0] = mul(offset_cross(block, step, 1, 1, tip, u, v, h), inverse);
	}
	return valid & (lanes_abs(b[1]) < BARYCENTRIC_MOST) & (lanes_abs(b[2]) < BARYCENTRIC_MOST);
}

/* P - sum b_i X_i */
LANES_INLINE struct lanes3 barycentric_away(const struct block *block, u32 step,
					    const struct nm_point *tip, lanes h, const lanes b[3])
{
	struct lanes3 away;

	away.x = offset_away(block, step, tip, h, b, 0);
	away.y = offset_away(block, step, tip, h, b, 1);
	away.z = offset_away(block, step, tip, h, b, 2);
	return away;
}

#else

/* Edge i of the offset triangle. */
LANES_INLINE struct lanes3 offset_edge(const struct block *block, u32 step, u32 i, lanes h)
{
	return lanes3_add(row3_step(&block->edge[i].along, step),
			  lanes3_scale(row3_step(&block->edge[i].normal_along, step), h));
}

/* P - X_i */
LANES_INLINE struct lanes3 offset_corner(const struct block *block, u32 step, u32 i,
					 const struct nm_point *tip, lanes h)
{
	return lanes3_sub(from_corner(block, step, i, tip),
			  lanes3_scale(row3_step(&block->edge[i].normal, step), h));
}

LANES_INLINE mask_lanes barycentric_solve(const struct block *block, u32 step,
					  const struct nm_point *tip, lanes h, struct lanes3 area,
					  const lanes *power, mask_lanes valid, lanes b[3])
{
	const lanes one = lanes_all(REAL(1));
	/* e2 = -E2 */
	struct lanes3 e0 = offset_edge(block, step, 1, h), e1 = offset_edge(block, step, 0, h);
	struct lanes3 e2 = offset_edge(block, step, 2, h);
	struct lanes3 w = offset_corner(block, step, 0, tip, h);
	struct lanes3 w0 = offset_corner(block, step, 1, tip, h);
	lanes size = mul(block->area[step], lanes3_dot(area, area)), inverse;

	if (power)
		size = mul(size, *power);
	valid &= size > 0;
	inverse = divide(one, lanes_select(valid, size, one));
	b[1] = mul(lanes3_dot(lanes3_cross(e2, w), area), inverse);
	b[2] = mul(lanes3_dot(lanes3_cross(e1, w), area), inverse);
	b[0] = mul(lanes3_dot(lanes3_cross(e0, w0), area), inverse);
	return valid;
}

LANES_INLINE struct lanes3 barycentric_away(const struct block *block, u32 step,
					    const struct nm_point *tip, lanes h, const lanes b[3])
{
	struct lanes3 e1 = offset_edge(block, step, 0, h), e2 = offset_edge(block, step, 2, h);

	return lanes3_add(offset_corner(block, step, 0, tip, h),
			  lanes3_sub(lanes3_scale(e2, b[2]), lanes3_scale(e1, b[1])));
}

#endif

#endif /* PHANTOM_FLOAT_BARYCENTRIC_H */
