/* SPDX-License-Identifier: GPL-2.0-only */
/*
 * block.h - a set of patches as the tick reads it: blocks of sixteen, one row per quantity.
 *
 * Notation: corners x0 x1 x2 counter-clockwise from outside, unit vertex normals m0 m1 m2, unit
 * face normal g, contact radius R, stiffness k. Edge i goes from corner i to corner i + 1.
 * Lengths in mm, forces in N, stiffness in N/mm; corners stay integer nm, so that the distance
 * from the tip is formed exactly (nm_difference()).
 *
 * Lanes that can never be in contact (patches that cannot be computed, and the padding of the last
 * block) have R = -1, a bounding sphere of no size and three equal corners. Of a face that cannot be
 * computed corners, sphere and a plane are kept: it is in nobody's way but of a path through it.
 */
#ifndef PHANTOM_FLOAT_BLOCK_H
#define PHANTOM_FLOAT_BLOCK_H

#include "lanes.h"

/* A row: one value for each of the sixteen patches of a block. */
typedef lanes real_row[PHANTOM_STEPS];
typedef nm_lanes nm_row[PHANTOM_STEPS];
typedef u32 index_row[PHANTOM_BLOCK];

struct row3 {
	real_row x, y, z;
};

/* What Algorithm 1 needs of an edge. */
struct paper_edge {
	struct row3 along; /* e = x_(i+1) - x_i */
	real_row inverse_length2; /* 1 / |e|^2 */
	struct row3 normal; /* m_i */
	struct row3 normal_along; /* m_(i+1) - m_i */
	struct row3 wall; /* m_i x e / |e| */
	struct row3 wall_along; /* (m_(i+1) - m_i) x e / |e| */
};

/* A shell that leans farther outward than that, per height, is not followed. */
#define LEAN_MOST 32

struct block {
	/* read for every patch on every tick */
	nm_row corner[3][3]; /* [corner][axis] */
	struct row3 face_normal; /* g */
	real_row radius; /* R of the patch's material */
	struct row3 centre; /* centroid - x0 */
	real_row extent; /* largest distance of a corner from the centroid */
	/* how far the shell leans outward, per height over the plane; LEAN_MOST: anywhere in reach */
	real_row lean; /* of projected */
	real_row lean_paper; /* of paper, at the sharpest corner */

	/* read where the tip is near */
	real_row stiffness; /* k */
	struct paper_edge edge[3];

	/*
	 * projected: the cubic of projected.h, divided by |A0|, so that its constant term is the
	 * height above the plane.
	 */
	real_row area; /* |A0|, twice the area, mm^2 */
	struct row3 area1, area2; /* A1 / |A0|, A2 / |A0| */
	real_row normal_area0, normal_area1, normal_area2; /* m0 . A0, A1, A2, each / |A0| */
	/* fans: 1 over an edge (x1 = x2), 2 over a vertex; A0 is A1 or A2 there. See projected.h */
	real_row order;
	real_row height_limit; /* no contact has a larger h */
#ifdef PHANTOM_REAL_FIXED
	mask_lanes tame[PHANTOM_STEPS]; /* see cubic_tame() */
#endif

	index_row face; /* phantom_patch.face */
	index_row vertex[3]; /* phantom_patch.vertex */
	index_row material;
	index_row surface; /* phantom_patch.surface */
};

/* Sixteen edges at which open surfaces end. Lanes without one have surface 0, which is none's. */
struct rim_block {
	nm_row from[3]; /* [axis], one end */
	struct row3 along; /* unit, towards the other end */
	real_row length; /* mm */
	nm_row surface; /* phantom_patch.surface; to be compared only */
};

/* What a tick of 64 patches reads stays in the first-level cache (32 kB), its own stack beside it. */
_Static_assert(sizeof(real) > sizeof(float) ||
		       sizeof(struct block) * (64 / PHANTOM_BLOCK) <= 24 * 1024,
	       "64 patches take 24 kB at most");

struct float_material {
	real stiffness; /* N/mm */
	real radius; /* mm */
	real most; /* k R, N, as far as forces are added up */
	real damping; /* N per mm/s; 0 unless the material names the effect */
};

/* One of Algorithm 1's walls, as the tip sees it. */
struct paper_wall {
	struct lanes3 normal; /* n' */
	lanes distance; /* d_i |n'| */
};

/* Found by `paper` in one step of a block; kept for the overlap test. */
struct paper_step {
	mask_lanes contact;
	lanes height; /* d */
	struct lanes3 normal; /* n */
	lanes length; /* |DP| */
	lanes magnitude; /* |s| */
	union {
		struct paper_wall wall[3]; /* until n is known */
		struct lanes3 plane[3]; /* normal of the plane through the tip and edge i */
	};
	u32 block, step;
	bool planes; /* are they there yet? */
};

/* One root of `projected`. */
struct projected_root {
	struct real3 normal; /* n */
	real height; /* h |N| */
	real magnitude; /* k (R - h |N|) */
	real weight; /* 0 ... 1: less than 1 next to a wall, window.h */
	real sign; /* +1, or -1 where the shell has folded over */
	u32 patch;
};

#define PROJECTED_ROOTS 3 /* a patch has at most that many: its equation is a cubic */

/*
 * What a tick writes, for each block. The set is read-only but for this: one tick at a time may
 * use a set.
 */
union scratch {
	struct paper_step paper[PHANTOM_STEPS];
	struct projected_root projected[PHANTOM_BLOCK * PROJECTED_ROOTS];
};

/* Of struct shell_state. */
#define SHELL_SCRATCH_BYTES 2048

struct phantom_float_set {
	u32 patch_count;
	u32 block_count; /* of faces */
	u32 fan_block_count; /* they follow; only the shell has a use for them */
	u32 rim_block_count; /* struct rim_block, they follow */
	u32 material_count;
	u32 refused;
	u64 scratch_offset; /* from the set's begin, bytes: union scratch of each block, shell_state */
	/*
	 * Largest extent of a patch and largest contact radius, mm: they bound every distance
	 * that is computed, hence every rounding error. See rounding_mm().
	 */
	real extent;
	real radius;
	struct float_material materials[PHANTOM_MATERIALS_MAX];
	struct block blocks[] __attribute__((aligned(PHANTOM_FLOAT_SET_ALIGN)));
};

/*
 * What rounding can do to a height or a wall distance: a few units in the last place of float32
 * over the largest distance involved, and the nm grid of the border. Positions closer to a plane
 * than that count as on it. 4 nm for patches of a mm with R = 2 mm.
 */
LANES_INLINE real rounding_mm(const struct phantom_float_set *set)
{
	return mul(REAL(1e-6), REAL(1) + set->extent + set->radius);
}

LANES_INLINE struct rim_block *set_rims(const struct phantom_float_set *set)
{
	return (struct rim_block *)&set->blocks[set->block_count + set->fan_block_count];
}

LANES_INLINE struct paper_step *scratch_paper(const struct phantom_float_set *set)
{
	return (struct paper_step *)((u8 *)set + set->scratch_offset);
}

LANES_INLINE struct projected_root *scratch_projected(const struct phantom_float_set *set)
{
	return (struct projected_root *)((u8 *)set + set->scratch_offset);
}

LANES_INLINE struct lanes3 row3_step(const struct row3 *row, u32 step)
{
	return (struct lanes3){row->x[step], row->y[step], row->z[step]};
}

LANES_INLINE real row_lane(const lanes *row, u32 lane)
{
	return row[lane / PHANTOM_LANES][lane % PHANTOM_LANES];
}

LANES_INLINE struct real3 row3_lane(const struct row3 *row, u32 lane)
{
	return (struct real3){row_lane(row->x, lane), row_lane(row->y, lane),
			      row_lane(row->z, lane)};
}

/*
 * Is the patch one whose cubic may be reckoned with without saturation (patch_tame() of prepare.h)? Floating
 * point needs no such promise, and keeps no row of it.
 */
LANES_INLINE void block_set_tame(struct block *block, u32 lane, bool tame)
{
#ifdef PHANTOM_REAL_FIXED
	block->tame[lane] = (mask_lanes){tame ? -1 : 0};
#else
	(void)block;
	(void)lane;
	(void)tame;
#endif
}

/* A point in nm, once per lane. */
struct nm_point {
	nm_lanes axis[3];
};

LANES_INLINE struct nm_point nm_point(const s32 nm[3])
{
	return (struct nm_point){{nm_all(nm[0]), nm_all(nm[1]), nm_all(nm[2])}};
}

/* point - x_corner, mm. */
LANES_INLINE struct lanes3 from_corner(const struct block *block, u32 step, u32 corner,
				       const struct nm_point *point)
{
	return (struct lanes3){
		nm_difference(point->axis[0], block->corner[corner][0][step]),
		nm_difference(point->axis[1], block->corner[corner][1][step]),
		nm_difference(point->axis[2], block->corner[corner][2][step]),
	};
}

/* The same of the corner after that of which it is q. */
LANES_INLINE struct lanes3 from_next_corner(const struct block *block, u32 step, u32 corner,
					    const struct nm_point *point, struct lanes3 q)
{
#ifdef PHANTOM_REAL_FIXED
	(void)point;
	return lanes3_sub(q, row3_step(&block->edge[corner - 1].along, step));
#else
	/* which would cancel there */
	(void)q;
	return from_corner(block, step, corner, point);
#endif
}

/* The same for one patch. */
LANES_INLINE struct real3 from_corner_lane(const struct block *block, u32 lane, u32 corner,
					   const s32 nm[3])
{
	u32 step = lane / PHANTOM_LANES, l = lane % PHANTOM_LANES;

	return (struct real3){
		real_from_nm((s64)nm[0] - (s64)block->corner[corner][0][step][l]),
		real_from_nm((s64)nm[1] - (s64)block->corner[corner][1][step][l]),
		real_from_nm((s64)nm[2] - (s64)block->corner[corner][2][step][l]),
	};
}

/* Lanes whose triangle may lie within `reach` of the point q = point - x0. */
LANES_INLINE mask_lanes within_reach(const struct block *block, u32 step, struct lanes3 q,
				     lanes reach)
{
	struct lanes3 away = lanes3_sub(q, row3_step(&block->centre, step));
	lanes far = reach + block->extent[step];

	return (lanes3_dot(away, away) <= mul(far, far)) & (far >= 0);
}

/* The square of what of `away` is beside the direction g, when away2 = |away|^2 and height = g . away. */
LANES_INLINE lanes beside2(struct lanes3 away, lanes away2, struct lanes3 g, lanes height)
{
#ifdef PHANTOM_REAL_FIXED
	/* a difference of squares loses nothing there that a patch's margin does not hold a hundred times */
	(void)away;
	(void)g;
	return away2 - mul_fitting(height, height);
#else
	struct lanes3 beside = lanes3_sub(away, lanes3_scale(g, height));

	(void)away2;
	return lanes3_dot(beside, beside);
#endif
}

/*
 * Lanes whose shell may hold the point that is q from x0 and `height` over the plane: those in reach
 * with no more beside the face than its extent and what the shell leans outward at that height; all in
 * reach if it may not be told by that.
 */
LANES_INLINE mask_lanes within_shell(const struct block *block, u32 step, struct lanes3 q,
				     lanes height, lanes lean, bool leans, lanes margin)
{
	struct lanes3 away = lanes3_sub(q, row3_step(&block->centre, step));
	lanes away2 = lanes3_dot_small(away, away);
	lanes far = block->radius[step] + block->extent[step];
	lanes side = block->extent[step] + margin + mul_fitting(lanes_abs(height), lean);

	return (away2 <= mul_fitting(far, far)) & (far >= 0) &
	       ((beside2(away, away2, row3_step(&block->face_normal, step), height) <=
		 mul(side, side)) |
		(leans ? lean >= REAL(LEAN_MOST) : lean >= REAL(0)));
}

/* The steps of a block that are in reach: looked for at once, before any is worked on. */
struct near_steps {
	u32 steps; /* bits */
	mask_lanes mask[PHANTOM_STEPS];
	lanes height[PHANTOM_STEPS]; /* over the planes */
};

LANES_INLINE void near_add(struct near_steps *near, u32 step, mask_lanes mask, lanes height)
{
	near->mask[step] = mask;
	near->height[step] = height;
	near->steps |= (u32)(mask_bits(mask) != 0) << step;
}

#endif /* PHANTOM_FLOAT_BLOCK_H */
