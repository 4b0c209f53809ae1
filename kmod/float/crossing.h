/* SPDX-License-Identifier: GPL-2.0-only */
/*
 * crossing.h - where a segment passes through the faces of a set.
 *
 * Watertight at shared edges and vertices. The corners are seen from the segment's begin, sheared
 * so that the segment runs along one axis (Woop, Benthin, Wald 2013, "Watertight Ray/Triangle
 * Intersection"), and the segment passes inside where the three 2-D edge functions have one sign,
 * zero included. A corner gives the same two numbers in every face that has it, and the sign of
 * b_x c_y - b_y c_x is never wrong in floating point, only possibly zero: so no path slips
 * between faces, not even exactly through an edge or a vertex.
 *
 * Which side a point is on is decided by its height over the face, not by the place of the
 * crossing on the segment: the end of one tick's path is the begin of the next one's, both get the
 * same height, and no crossing falls between two ticks. A begin up to rounding_mm() on the wrong
 * side counts as on the plane.
 */
#ifndef PHANTOM_FLOAT_CROSSING_H
#define PHANTOM_FLOAT_CROSSING_H

#include "ring.h"

enum crossing_way {
	CROSSING_INWARD, /* from the front of a face to its back */
	CROSSING_OUTWARD,
};

struct segment {
	struct nm_point begin, end;
	s32 begin_nm[3];
	s64 way_nm[3]; /* end - begin */
	real length; /* mm */
	u32 x, y, z; /* axes: z is the longest of the way */
	real shear_x, shear_y; /* way_x / way_z, way_y / way_z */
	real inverse_z; /* 1 / way_z, 1 / mm */
};

struct crossing {
	real along; /* 0 at the segment's begin, 1 at its end */
	u32 patch; /* PHANTOM_PATCH_NONE: nothing is crossed */
};

/* False for a segment without length. */
static inline bool segment_set(struct segment *segment, const s32 begin_nm[3], const s32 end_nm[3])
{
	real way[3];
	u32 axis;

	segment->begin = nm_point(begin_nm);
	segment->end = nm_point(end_nm);
	segment->z = 0;
	for (axis = 0; axis < 3; axis++) {
		segment->begin_nm[axis] = begin_nm[axis];
		segment->way_nm[axis] = (s64)end_nm[axis] - begin_nm[axis];
		way[axis] = real_from_nm(segment->way_nm[axis]);
		if (real_abs(way[axis]) > real_abs(way[segment->z]))
			segment->z = axis;
	}
	segment->x = (segment->z + 1) % 3;
	segment->y = (segment->z + 2) % 3;
	if (way[segment->z] == 0)
		return false;
	segment->inverse_z = divide(REAL(1), way[segment->z]);
	segment->shear_x =
		real_ratio_of_nm(segment->way_nm[segment->x], segment->way_nm[segment->z]);
	segment->shear_y =
		real_ratio_of_nm(segment->way_nm[segment->y], segment->way_nm[segment->z]);
	segment->length = real3_length((struct real3){way[0], way[1], way[2]});
	return true;
}

static inline s32 nm_saturate(s64 value)
{
	if (value > 0x7fffffff)
		return 0x7fffffff;
	if (value < -0x7fffffffLL - 1)
		return -0x7fffffff - 1;
	return (s32)value;
}

/*
 * Places that a section makes stay as near to the set's origin as the servo lets the tip be, so that the
 * distance to a vertex, at most PHANTOM_COORDINATE_MAX_NM from it, fits s32.
 */
#define NM_PLACE_MAX (0x7fffffffLL - PHANTOM_COORDINATE_MAX_NM)

static inline s32 nm_place(s64 value)
{
	if (value > NM_PLACE_MAX)
		return (s32)NM_PLACE_MAX;
	if (value < -NM_PLACE_MAX)
		return (s32)-NM_PLACE_MAX;
	return (s32)value;
}

/* from + (by in mm), nm. */
static inline void nm_offset(const s32 from[3], struct real3 by, s32 out[3])
{
	const real way[3] = {by.x, by.y, by.z};
	u32 axis;

	for (axis = 0; axis < 3; axis++)
		out[axis] = nm_place(from[axis] + real_to_nm(way[axis]));
}

/* to - from, mm. */
static inline struct real3 nm_way(const s32 from[3], const s32 to[3])
{
	return (struct real3){
		real_from_nm((s64)to[0] - from[0]),
		real_from_nm((s64)to[1] - from[1]),
		real_from_nm((s64)to[2] - from[2]),
	};
}

/* begin_nm + along (end - begin), to the nearest nm. */
static inline void segment_point(const struct segment *segment, real along, s32 out_nm[3])
{
	u32 axis;

	for (axis = 0; axis < 3; axis++) {
		out_nm[axis] = nm_place(segment->begin_nm[axis] +
					real_part_of_nm(along, segment->way_nm[axis]));
	}
}

/* A corner in the sheared frame of the segment. */
struct sheared {
	lanes x, y, z;
};

LANES_INLINE struct sheared crossing_corner(const struct block *block, u32 step, u32 corner,
					    const struct segment *segment)
{
	u32 x = segment->x, y = segment->y, z = segment->z;
	struct sheared out;

	out.z = nm_difference(block->corner[corner][z][step], segment->begin.axis[z]);
	out.x = nm_difference(block->corner[corner][x][step], segment->begin.axis[x]) -
		mul(lanes_all(segment->shear_x), out.z);
	out.y = nm_difference(block->corner[corner][y][step], segment->begin.axis[y]) -
		mul(lanes_all(segment->shear_y), out.z);
	return out;
}

/*
 * Lanes of the step that the segment crosses in that way; *along is valid there. The caller has
 * ruled out lanes that are out of reach or on the wrong sides.
 */
LANES_INLINE mask_lanes crossing_inside(const struct block *block, u32 step,
					const struct segment *segment, enum crossing_way way,
					lanes *along)
{
	struct sheared a = crossing_corner(block, step, 0, segment);
	struct sheared b = crossing_corner(block, step, 1, segment);
	struct sheared c = crossing_corner(block, step, 2, segment);
	lanes u = mul_sub(b.x, c.y, b.y, c.x);
	lanes v = mul_sub(c.x, a.y, c.y, a.x);
	lanes w = mul_sub(a.x, b.y, a.y, b.x);
	lanes low = lanes_min(lanes_min(u, v), w), high = lanes_max(lanes_max(u, v), w);
	/* twice the area as seen along +z: positive where the way goes out of the front */
	lanes area = u + v + w;
	lanes outward = segment->inverse_z > 0 ? area : -area;
	mask_lanes right_way = way == CROSSING_OUTWARD ? outward > 0 : outward < 0;

	*along = mul(divide(mul_sum(u, a.z, v, b.z, w, c.z),
			    lanes_select(right_way, area, lanes_all(REAL(1)))),
		     lanes_all(segment->inverse_z));
	*along = lanes_min(lanes_max(*along, lanes_all(0)), lanes_all(REAL(1)));
	return right_way & ((low >= 0) | (high <= 0));
}

/* Lanes within reach of the segment whose sides its two ends are on. */
LANES_INLINE mask_lanes crossing_candidates(const struct block *block, u32 step,
					    const struct segment *segment, enum crossing_way way,
					    real rounding)
{
	struct lanes3 g = row3_step(&block->face_normal, step);
	struct lanes3 q = from_corner(block, step, 0, &segment->end);
	lanes end = lanes3_dot_small(g, q), begin;
	mask_lanes candidates = way == CROSSING_INWARD ? end < 0 : end >= 0;

	/* the usual tick: a tip that is over all of them */
	if (!mask_bits(candidates))
		return candidates;
	candidates &= within_reach(block, step, q, lanes_all(segment->length));
	if (!mask_bits(candidates))
		return candidates;
	q = from_corner(block, step, 0, &segment->begin);
	begin = lanes3_dot_small(g, q);
	return candidates & (way == CROSSING_INWARD ? begin >= -rounding : begin <= rounding);
}

/* A segment that runs along a face meets the faces round it without passing through them. */
struct beside {
	u32 vertex[3]; /* of that face: whoever has one of them is not looked at */
	u32 patch; /* nor is this one */
};

LANES_INLINE bool crossing_has(const struct block *block, u32 lane, u32 vertex)
{
	return block->vertex[0][lane] == vertex || block->vertex[1][lane] == vertex ||
	       block->vertex[2][lane] == vertex;
}

/* The edge of the patch that is longest. */
static inline u32 crossing_longest(const struct block *block, u32 lane)
{
	static const s32 origin[3] = {0, 0, 0};
	real most = 0;
	u32 longest = 0, i;

	for (i = 0; i < 3; i++) {
		real length =
			real3_length(real3_sub(from_corner_lane(block, lane, i, origin),
					       from_corner_lane(block, lane, (i + 1) % 3, origin)));

		if (length > most) {
			most = length;
			longest = i;
		}
	}
	return longest;
}

/*
 * The neighbour of a face without a shell, over its longest edge, which all of it lies at, or else whichever
 * has most vertices of it; NONE if none has a shell.
 */
static inline u32 crossing_neighbour(const struct phantom_float_set *set, u32 patch)
{
	const struct block *own = &set->blocks[patch / PHANTOM_BLOCK];
	u32 lane = patch % PHANTOM_BLOCK, longest = crossing_longest(own, lane);
	u32 from = own->vertex[longest][lane], to = own->vertex[(longest + 1) % 3][lane];
	u32 beside = own->vertex[(longest + 2) % 3][lane];
	u32 found = PHANTOM_PATCH_NONE, most = 0, i, l;

	for (i = 0; i < set->block_count; i++) {
		const struct block *block = &set->blocks[i];

		for (l = 0; l < PHANTOM_BLOCK; l++) {
			u32 shared = 2U * crossing_has(block, l, from) +
				     2U * crossing_has(block, l, to) +
				     crossing_has(block, l, beside);

			if (shared <= most || !(row_lane(block->radius, l) > 0))
				continue;
			most = shared;
			found = i * PHANTOM_BLOCK + l;
		}
	}
	return found;
}

/*
 * A crossing of a face without a shell, which is as good as an edge, becomes one of its neighbour: where the
 * segment meets the neighbour's plane, since so low a face does not say where.
 */
static inline void crossing_hand_over(const struct phantom_float_set *set,
				      const struct segment *segment, struct crossing *at)
{
	const struct block *block;
	struct real3 g, begin;
	real down;
	u32 lane;

	if (row_lane(set->blocks[at->patch / PHANTOM_BLOCK].radius, at->patch % PHANTOM_BLOCK) > 0)
		return;
	at->patch = crossing_neighbour(set, at->patch);
	if (at->patch == PHANTOM_PATCH_NONE)
		return;
	block = &set->blocks[at->patch / PHANTOM_BLOCK];
	lane = at->patch % PHANTOM_BLOCK;
	g = row3_lane(&block->face_normal, lane);
	begin = from_corner_lane(block, lane, 0, segment->begin_nm);
	down = -real3_dot(g, (struct real3){real_from_nm(segment->way_nm[0]),
					    real_from_nm(segment->way_nm[1]),
					    real_from_nm(segment->way_nm[2])});
	if (down != 0)
		at->along = real_clamp(divide(real3_dot(g, begin), down), 0, REAL(1));
}

/*
 * The first crossing (or the last one) with along > after; of equals the patch with the lowest
 * index. `beside` may be NULL.
 */
static inline struct crossing crossing_find_beside(const struct phantom_float_set *set,
						   const struct segment *segment,
						   enum crossing_way way, bool last, real after,
						   const struct beside *beside)
{
	struct crossing found = {0, PHANTOM_PATCH_NONE};
	real rounding = rounding_mm(set);
	u32 block_index, step, lane;

	for (block_index = 0; block_index < set->block_count; block_index++) {
		const struct block *block = &set->blocks[block_index];

		for (step = 0; step < PHANTOM_STEPS; step++) {
			mask_lanes candidates =
				crossing_candidates(block, step, segment, way, rounding);
			lanes along;
			u32 crossed;

			if (!mask_bits(candidates))
				continue;
			crossed = mask_bits(candidates &
					    crossing_inside(block, step, segment, way, &along));
			if (crossed && beside)
				crossed &= mask_bits(block->radius[step] > 0) &
					   ~(ring_touches(block, beside->vertex) >>
					     step * PHANTOM_LANES);
			for (lane = 0; crossed >> lane; lane++) {
				if (!(crossed >> lane & 1) || !(along[lane] > after))
					continue;
				if (beside && beside->patch == block_index * PHANTOM_BLOCK +
								       step * PHANTOM_LANES + lane)
					continue;
				if (found.patch != PHANTOM_PATCH_NONE &&
				    !(last ? along[lane] > found.along : along[lane] < found.along))
					continue;
				found.along = along[lane];
				found.patch =
					block_index * PHANTOM_BLOCK + step * PHANTOM_LANES + lane;
			}
		}
	}
	if (found.patch != PHANTOM_PATCH_NONE)
		crossing_hand_over(set, segment, &found);
	return found;
}

static inline struct crossing crossing_find(const struct phantom_float_set *set,
					    const struct segment *segment, enum crossing_way way,
					    bool last, real after)
{
	return crossing_find_beside(set, segment, way, last, after, NULL);
}

#endif /* PHANTOM_FLOAT_CROSSING_H */
