/* SPDX-License-Identifier: GPL-2.0-only */
/*
 * ring.h - which faces of a set meet at a vertex or at an edge.
 *
 * By vertex number: phantom_patch.vertex is the same for all faces that meet there, whichever of
 * them the set has, and says more than a list of neighbours (non-manifold edges, vertices).
 */
#ifndef PHANTOM_FLOAT_RING_H
#define PHANTOM_FLOAT_RING_H

#include "block.h"

/* Where on its triangle a point lies: PHANTOM_PATCH_NONE twice, one vertex twice, or an edge's two. */
struct feature {
	u32 vertex[2];
};

LANES_INLINE bool feature_is_face(struct feature feature)
{
	return feature.vertex[0] == PHANTOM_PATCH_NONE;
}

/* Half a row of a block's integers. */
typedef u32 index_quad __attribute__((vector_size(16), may_alias));
typedef float index_sign __attribute__((vector_size(16)));

LANES_INLINE index_quad ring_has(const struct block *block, u32 half, u32 vertex)
{
	index_quad all = (index_quad){} + vertex, has = {};
	u32 i;

	for (i = 0; i < 3; i++)
		has |= (index_quad)(*(const index_quad *)&block->vertex[i][4 * half] == all);
	return has;
}

/* One bit for each lane. */
LANES_INLINE u32 ring_lanes(index_quad low, index_quad high)
{
	return (u32)__builtin_ia32_movmskps((index_sign)low) |
	       (u32)__builtin_ia32_movmskps((index_sign)high) << 4;
}

/* Bit per lane of a block: the patch has one of those vertices. */
static inline u32 ring_touches(const struct block *block, const u32 vertex[3])
{
	index_quad has[2] = {};
	u32 half, i;

	for (half = 0; half < 2; half++)
		for (i = 0; i < 3; i++)
			has[half] |= ring_has(block, half, vertex[i]);
	return ring_lanes(has[0], has[1]);
}

/* Bit per lane of a block: the patch is part of the surface and has both vertices of the feature. */
static inline u32 ring_bits(const struct block *block, struct feature feature)
{
	u32 half, bits, out = 0;
	index_quad has[2];

	for (half = 0; half < 2; half++)
		has[half] = ring_has(block, half, feature.vertex[0]) &
			    ring_has(block, half, feature.vertex[1]);
	for (bits = ring_lanes(has[0], has[1]); bits; bits &= bits - 1) {
		u32 lane = (u32)__builtin_ctz(bits);

		if (row_lane(block->radius, lane) > 0)
			out |= 1u << lane;
	}
	return out;
}

#endif /* PHANTOM_FLOAT_RING_H */
