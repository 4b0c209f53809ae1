/* SPDX-License-Identifier: GPL-2.0-only */
/*
 * paper_fans.h - `paper` over edges and corners where neighbours disagree about the normals.
 *
 * Algorithm 1 asks whether the tip is over a triangle's plane, and the paper's two empty triangles
 * at a fake edge (fig. 1) have none. Their shell is that of projected.h, and where the tip is in
 * it, D is the point of the edge that it is over and n its direction from there:
 *
 *   s = k (R - |DP|) n        |DP| = h |N|
 *
 * Shells that have folded over lie on the far side of a concave edge, where the faces have their
 * own contacts: they count for nothing here. Walls are not soft: two contacts that are the same one
 * are bounded as one when they are combined. A contact whose open segment D-P is crossed by the
 * triangle of a face in contact is dropped, as among faces, unless that triangle has D's edge or
 * vertex.
 */
#ifndef PHANTOM_FLOAT_PAPER_FANS_H
#define PHANTOM_FLOAT_PAPER_FANS_H

#include "overlap.h"
#include "projected.h"

/* Behind the steps of the faces, which take one union of scratch for each of their blocks. */
LANES_INLINE struct projected_root *scratch_fans(const struct phantom_float_set *set)
{
	return (struct projected_root *)((u8 *)set + set->scratch_offset +
					 (u64)set->block_count * sizeof(union scratch));
}

/* Does the other patch have every vertex of the fan? */
static inline bool paper_fan_shares(const struct block *fan, u32 fan_lane,
				    const struct block *other, u32 other_lane)
{
	u32 i;

	for (i = 0; i < 3; i++)
		if (!overlap_has_vertex(other, other_lane, fan->vertex[i][fan_lane]))
			return false;
	return true;
}

/* Is the contact over a fan crossed by the triangle of a face in contact? */
static inline bool paper_fan_crossed(const struct phantom_float_set *set, struct paper_step *steps,
				     u32 count, const struct nm_point *tip,
				     const struct projected_root *root)
{
	const struct block *fan = &set->blocks[root->patch / PHANTOM_BLOCK];
	struct lanes3 way = lanes3_all(real3_scale(root->normal, -root->height));
	u32 i, l;

	for (i = 0; i < count; i++) {
		u32 crossed = mask_bits(overlap_crossed(set, &steps[i], tip, way));

		for (l = 0; crossed >> l; l++)
			if ((crossed >> l & 1) &&
			    !paper_fan_shares(fan, root->patch % PHANTOM_BLOCK,
					      &set->blocks[steps[i].block],
					      steps[i].step * PHANTOM_LANES + l))
				return true;
	}
	return false;
}

#endif /* PHANTOM_FLOAT_PAPER_FANS_H */
