/* SPDX-License-Identifier: GPL-2.0-only */
/*
 * field.h - effect: forces on a grid, PHANTOM_EFFECT_FIELD.
 *
 *   F += w f(P)           f trilinear between the eight nodes round the tip P
 *   w  = product over the axes of s^2 (3 - 2 s),  s = clamp(way to the nearer side / border, 0, 1)
 *
 * F is continuous: f from cell to cell, w with its gradient, and 0 at the box's sides.
 *
 * ENERGY is what the nodes say: a field with curl gives some on every lap, curl times the lap's area. On any
 * path it is at most the largest force at a node times the path's length. A linear field is met
 * exactly, and a potential's forces to the second order of the spacing; in the border w adds grad w x f, at
 * most 1.5 |f| / border, unless f falls to 0 there by itself. Name VISCOSITY where a field may give more
 * than the arm takes.
 *
 * STIFFNESS. Up to PHANTOM_EFFECT_STIFFNESS_MAX_MN_MM along each axis by the nodes, and 1.5 |f| / border.
 */
#ifndef PHANTOM_FLOAT_FIELD_H
#define PHANTOM_FLOAT_FIELD_H

#include "../crossing.h"
#include "table.h"

/* Where the tip is along an axis. False: outside the box. */
static inline bool field_place(const struct float_field *field, u32 axis, s32 tip_nm, u32 *node,
			       real *after, real *part)
{
	s64 way = tip_nm - field->corner_nm[axis];
	u32 spacing = field->spacing_nm[axis], last = field->nodes[axis] - 1;
	s64 size = (s64)last * spacing, near = way < size - way ? way : size - way;
	real s;

	if (near <= 0)
		return false;
	*node = (u32)way / spacing; /* size is below 2^32 */
	*after = real_ratio_of_nm((u32)way - *node * spacing, spacing);
	s = real_min(REAL(1), mul(real_from_nm(near), field->inverse_border));
	*part = mul(*part, mul(mul(s, s), REAL(3) - 2 * s));
	return true;
}

static inline struct real3 field_between(struct real3 a, struct real3 b, real part)
{
	return real3_add(a, real3_scale(real3_sub(b, a), part));
}

/* From that node to the next along x. */
static inline struct real3 field_row(const s32 (*force_un)[3], real part)
{
	/* uN are to N as nm to mm */
	struct real3 a = {real_from_nm(force_un[0][0]), real_from_nm(force_un[0][1]),
			  real_from_nm(force_un[0][2])};
	struct real3 b = {real_from_nm(force_un[1][0]), real_from_nm(force_un[1][1]),
			  real_from_nm(force_un[1][2])};

	return field_between(a, b, part);
}

static inline struct real3 field_force(const struct float_field *field, const s32 tip_nm[3])
{
	u32 row = field->nodes[0], layer = row * field->nodes[1], node[3], axis;
	const s32(*at)[3];
	struct real3 low, high;
	real after[3], part = REAL(1);

	for (axis = 0; axis < 3; axis++)
		if (!field_place(field, axis, tip_nm[axis], &node[axis], &after[axis], &part))
			return (struct real3){0, 0, 0};
	at = field->force_un + node[0] + node[1] * row + node[2] * layer;
	low = field_between(field_row(at, after[0]), field_row(at + row, after[0]), after[1]);
	at += layer;
	high = field_between(field_row(at, after[0]), field_row(at + row, after[0]), after[1]);
	return real3_scale(field_between(low, high, after[2]), part);
}

#endif /* PHANTOM_FLOAT_FIELD_H */
