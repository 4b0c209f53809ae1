/* SPDX-License-Identifier: GPL-2.0-only */
/*
 * walk.h - the proxy V goes down the surface to the point nearest to the tip P1 (proxy=constrained).
 *
 *   f = V's face; at most WALK_FACES_MAX times:
 *     foot = the point of f nearest to P1
 *     a face c not next to f lies across the way V -> foot     -> V is held by f and c, see below
 *     V = foot; inside f                                       -> settled
 *     of the faces that meet at V's edge or vertex, f = the one on which V could go farthest;
 *     on none farther than `still`                             -> settled
 *   held by f and c:
 *     P1 pulls V along c and off f's plane                     -> f = c
 *     V = the point of f nearest to P1 that is `lift` over c's plane; no farther than f reaches;
 *     another face e across that way                           -> held by f, c and e: V stays there,
 *                                                                 or goes on along e's plane alone
 *
 * Every piece of the way lies in one face and brings V nearer to P1, so V never jumps from sheet to
 * sheet: it stays on the front of a thin plate whose back is nearer, goes round an edge only when it
 * has come to it, and ends in a local minimum of the distance. That the pieces lie in faces is also
 * why a face across one of them is another surface (a second object, a self-intersection), which no
 * proxy may enter (Zilles, Salisbury 1995: at most three planes hold it).
 *
 * Nothing but V and its face is kept. A walk that has settled, begun again for the same P1, finds
 * the same foot on the same face and no face to go on to: the V of a tip at rest is a fixed point.
 * The distance falls by what V moves (nearest.h) and `still` is above rounding: no cycle.
 *
 * The nearest point is no continuous function of P1 on the medial axis of the inside. There V slides
 * down the far side: over the lip of an edge that the tip was pushed out through, or round a ball
 * past whose centre it went; at most WALK_FACES_MAX faces a tick.
 */
#ifndef PHANTOM_FLOAT_WALK_H
#define PHANTOM_FLOAT_WALK_H

#include "crossing.h"
#include "nearest.h"

/*
 * Faces in a tick. Across the disc of 64 triangles that a set of that size covers there are about 10
 * of them, so V comes from one end of it to the other; a walk that is not done goes on in the next
 * tick.
 */
#define WALK_FACES_MAX 16

/* Planes that can hold V: a plane, a crease, a corner. */
#define WALK_HELD_MAX 3

/* Planes whose normals are less than 1 mrad apart have no line in common to speak of. */
#define WALK_PARALLEL ((real)1e-6) /* sin^2 */

struct walk {
	struct phantom_float_job *job;
	struct nm_point tip;
	real still; /* mm; a shorter way is rounding */
	real lift; /* mm; how far V stays off a face it is held by */
	u32 patch; /* that V lies on */
	s32 proxy_nm[3]; /* V */
	struct real3 way; /* V - P1, mm */
	struct feature at; /* where on its patch V lies; a face's inside while held */
	u32 held[WALK_HELD_MAX]; /* patches: V's own first */
	u32 held_count;
	bool settled; /* V has come as near as it can */
};

/* The point of one patch that is nearest to the tip. */
struct foot {
	struct real3 way; /* from the tip, mm */
	struct feature at;
};

static inline struct foot walk_foot(const struct walk *walk, u32 patch)
{
	const struct block *block = &walk->job->set->blocks[patch / PHANTOM_BLOCK];
	u32 lane = patch % PHANTOM_BLOCK;
	struct nearest_step at;

	nearest_evaluate(block, lane / PHANTOM_LANES, &walk->tip, &at);
	return (struct foot){lanes3_lane(at.way, lane % PHANTOM_LANES),
			     nearest_feature(block, lane, &at)};
}

static inline struct real3 walk_face_normal(const struct walk *walk, u32 patch)
{
	return row3_lane(&walk->job->set->blocks[patch / PHANTOM_BLOCK].face_normal,
			 patch % PHANTOM_BLOCK);
}

/*
 * Moves V within its face towards `way` from the tip, as far as nothing but the patch `except` lies
 * across. Returns what does, NONE if V has come there.
 */
static inline u32 walk_along(struct walk *walk, struct real3 way, u32 except)
{
	const struct phantom_float_job *job = walk->job;
	const struct block *block = &job->set->blocks[walk->patch / PHANTOM_BLOCK];
	u32 lane = walk->patch % PHANTOM_BLOCK, i;
	struct beside beside = {.patch = except};
	struct segment segment;
	struct crossing at = {0, PHANTOM_PATCH_NONE};
	s32 target[3];

	for (i = 0; i < 3; i++)
		beside.vertex[i] = block->vertex[i][lane];
	nm_offset(job->tip_nm, way, target);
	if (segment_set(&segment, walk->proxy_nm, target)) {
		at = crossing_find_beside(job->set, &segment, CROSSING_INWARD, false, -1, &beside);
		if (at.patch == PHANTOM_PATCH_NONE)
			for (i = 0; i < 3; i++)
				walk->proxy_nm[i] = target[i];
		else if (at.along * segment.length > walk->still)
			segment_point(&segment, at.along, walk->proxy_nm);
	}
	walk->way = at.patch == PHANTOM_PATCH_NONE ? way : nm_way(job->tip_nm, walk->proxy_nm);
	return at.patch;
}

/*
 * From the tip to the point on the plane of f and `lift` over that of c that is nearest to it:
 * way = a g_f + b g_c. False for planes that are parallel.
 */
static inline bool walk_crease(const struct walk *walk, u32 f, u32 c, struct real3 *way)
{
	const struct phantom_float_set *set = walk->job->set;
	struct real3 gf = walk_face_normal(walk, f), gc = walk_face_normal(walk, c);
	real hf = -real3_dot(gf, from_corner_lane(&set->blocks[f / PHANTOM_BLOCK],
						  f % PHANTOM_BLOCK, 0, walk->job->tip_nm));
	real hc = -real3_dot(gc, from_corner_lane(&set->blocks[c / PHANTOM_BLOCK],
						  c % PHANTOM_BLOCK, 0, walk->job->tip_nm));
	struct real3 line = real3_cross(gf, gc);
	real sine2 = real3_dot(line, line), cosine = real3_dot(gf, gc);

	if (!(sine2 > WALK_PARALLEL))
		return false;
	hc += walk->lift;
	*way = real3_add(real3_scale(gf, (hf - cosine * hc) / sine2),
			 real3_scale(gc, (hc - cosine * hf) / sine2));
	return true;
}

/* Shortens the way's end to where V would leave its face; true if it would, over the edge *edge. */
static inline bool walk_clip(const struct walk *walk, struct real3 *way, u32 *edge)
{
	const struct block *block = &walk->job->set->blocks[walk->patch / PHANTOM_BLOCK];
	u32 lane = walk->patch % PHANTOM_BLOCK, i;
	struct real3 g = row3_lane(&block->face_normal, lane);
	struct real3 go = real3_sub(*way, walk->way);
	real part = 1;
	bool clipped = false;

	for (i = 0; i < 3; i++) {
		struct real3 inward = real3_cross(g, row3_lane(&block->edge[i].along, lane));
		struct real3 q = from_corner_lane(block, lane, i, walk->proxy_nm);
		real begin = real_max(real3_dot(inward, q), 0);
		real fall = -real3_dot(inward, go);

		if (!(fall > 0) || !(begin < part * fall))
			continue;
		part = begin / fall;
		*edge = i;
		clipped = true;
	}
	*way = real3_add(walk->way, real3_scale(go, part));
	return clipped;
}

/*
 * Another surface c lies across V's way, which began at `start_nm`. True if V has come to rest: then
 * it is where it began, to the last nm.
 */
static inline bool walk_held(struct walk *walk, u32 c, const s32 start_nm[3])
{
	const struct block *block = &walk->job->set->blocks[walk->patch / PHANTOM_BLOCK];
	struct real3 gf = walk_face_normal(walk, walk->patch), moved;
	struct foot foot = walk_foot(walk, c);
	u32 tries, edge = 0, lane = walk->patch % PHANTOM_BLOCK;
	bool clipped = false;

	walk->at = (struct feature){{PHANTOM_PATCH_NONE, PHANTOM_PATCH_NONE}};
	walk->held[0] = walk->patch;
	walk->held_count = 1;
	if (real3_dot(real3_sub(foot.way, walk->way), gf) > 2 * walk->lift) {
		walk->patch = c;
		return false;
	}
	for (tries = 1; tries < WALK_HELD_MAX; tries++) {
		struct real3 way;

		walk->held[walk->held_count++] = c;
		if (!walk_crease(walk, walk->patch, c, &way))
			break;
		clipped = walk_clip(walk, &way, &edge);
		c = walk_along(walk, way, c);
		if (c == PHANTOM_PATCH_NONE)
			break;
		clipped = false;
	}
	if (clipped) {
		walk->at.vertex[0] = block->vertex[edge][lane];
		walk->at.vertex[1] = block->vertex[(edge + 1) % 3][lane];
	}
	moved = nm_way(start_nm, walk->proxy_nm);
	if (clipped || real3_dot(moved, moved) > 4 * walk->still * walk->still)
		return false;
	for (tries = 0; tries < 3; tries++)
		walk->proxy_nm[tries] = start_nm[tries];
	walk->way = nm_way(walk->job->tip_nm, start_nm);
	return true;
}

/* Of the faces that meet at V's feature the one on which V could go farthest; NONE: on none. */
static inline u32 walk_next(const struct walk *walk)
{
	const struct phantom_float_set *set = walk->job->set;
	real farthest = walk->still * walk->still;
	u32 found = PHANTOM_PATCH_NONE, i, step, l;

	for (i = 0; i < set->block_count; i++) {
		const struct block *block = &set->blocks[i];
		u32 bits = ring_bits(block, walk->at);

		for (step = 0; bits >> step * PHANTOM_LANES; step++) {
			u32 here = bits >> step * PHANTOM_LANES & ((1u << PHANTOM_LANES) - 1);
			struct nearest_step at;
			struct lanes3 go;
			lanes way2;

			if (!here)
				continue;
			nearest_evaluate(block, step, &walk->tip, &at);
			go = lanes3_sub(at.way, lanes3_all(walk->way));
			way2 = lanes3_dot(go, go);
			for (l = 0; l < PHANTOM_LANES; l++) {
				u32 patch = i * PHANTOM_BLOCK + step * PHANTOM_LANES + l;

				if (!(here >> l & 1) || !(way2[l] > farthest) ||
				    patch == walk->patch)
					continue;
				farthest = way2[l];
				found = patch;
			}
		}
	}
	return found;
}

/* V, on that patch, goes down to the tip. */
static inline void walk_down(struct walk *walk, struct phantom_float_job *job, u32 patch)
{
	real rounding = rounding_mm(job->set);
	u32 faces, i;

	walk->job = job;
	walk->tip = nm_point(job->tip_nm);
	for (i = 0; i < 3; i++)
		walk->proxy_nm[i] = job->proxy_nm[i];
	walk->way = nm_way(job->tip_nm, job->proxy_nm);
	/* what float32 makes of positions that far from the tip, and the nm grid that V is put on */
	walk->still = 2 * (rounding + (real)5e-7 * real3_length(walk->way));
	walk->lift = walk->still;
	walk->patch = patch;
	walk->settled = false;
	for (faces = 0; faces < WALK_FACES_MAX && !walk->settled; faces++) {
		const s32 start[3] = {walk->proxy_nm[0], walk->proxy_nm[1], walk->proxy_nm[2]};
		struct foot foot = walk_foot(walk, walk->patch);
		u32 across = walk_along(walk, foot.way, walk->patch), next;

		if (across != PHANTOM_PATCH_NONE) {
			walk->settled = walk_held(walk, across, start);
			if (walk->settled || feature_is_face(walk->at))
				continue;
		} else {
			walk->at = foot.at;
			walk->held[0] = walk->patch;
			walk->held_count = 1;
		}
		next = feature_is_face(walk->at) ? PHANTOM_PATCH_NONE : walk_next(walk);
		if (next == PHANTOM_PATCH_NONE)
			walk->settled = true;
		else
			walk->patch = next;
	}
	for (i = 0; i < 3; i++)
		job->proxy_nm[i] = walk->proxy_nm[i];
	job->proxy_face =
		job->set->blocks[walk->patch / PHANTOM_BLOCK].face[walk->patch % PHANTOM_BLOCK];
}

#endif /* PHANTOM_FLOAT_WALK_H */
