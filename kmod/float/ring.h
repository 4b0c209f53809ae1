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

/* Four of a row of integers: they are compared at once in every unit. */
#define RING_QUADS (PHANTOM_BLOCK / 4)

/* Bit i: patch i of the quad has the vertex. */
LANES_INLINE u32 ring_has(const struct block *block, u32 quad, u32 vertex)
{
	return index_equals(&block->vertex[0][4 * quad], vertex) |
	       index_equals(&block->vertex[1][4 * quad], vertex) |
	       index_equals(&block->vertex[2][4 * quad], vertex);
}

/* Bit per lane of a block: the patch has one of those vertices. */
static inline u32 ring_touches(const struct block *block, const u32 vertex[3])
{
	u32 quad, i, bits = 0;

	for (quad = 0; quad < RING_QUADS; quad++) {
		u32 has = 0;

		for (i = 0; i < 3; i++)
			has |= ring_has(block, quad, vertex[i]);
		bits |= has << 4 * quad;
	}
	return bits;
}

/* Bit per lane of a block: the patch is part of the surface and has both vertices of the feature. */
static inline u32 ring_bits(const struct block *block, struct feature feature)
{
	u32 quad, bits = 0, out = 0;

	for (quad = 0; quad < RING_QUADS; quad++)
		bits |= (ring_has(block, quad, feature.vertex[0]) &
			 ring_has(block, quad, feature.vertex[1]))
			<< 4 * quad;
	for (; bits; bits &= bits - 1) {
		u32 lane = (u32)__builtin_ctz(bits);

		if (row_lane(block->radius, lane) > 0)
			out |= 1u << lane;
	}
	return out;
}

#endif /* PHANTOM_FLOAT_RING_H */
