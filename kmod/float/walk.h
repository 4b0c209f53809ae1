/* SPDX-License-Identifier: GPL-2.0-only */
/*
 * walk.h - the proxy V goes down the surface to the point nearest to the tip P1 (proxy=constrained).
 *
 *   f = V's face; at most WALK_FACES_MAX times:
 *     foot = the point of f nearest to P1
 *     a face c not next to f lies across the way V -> foot     -> V is held by f and c, see below
 *     V = foot; inside f                                       -> settled
 *     of the faces that meet at V's edge or vertex, f = the one on which V could go farthest
 *     on none farther than `still`: f = the face beside it that comes nearest to P1, nearer than V,
 *     over a low lip (WALK_LIP); V = its foot
 *     none                                                     -> settled
 *   held by f and c:
 *     P1 pulls V along c and off f's plane                     -> f = c
 *     V = the point of f nearest to P1 that is `lift` over c's plane; no farther than f reaches;
 *     another face e across that way                           -> held by f, c and e: V stays there,
 *                                                                 or goes on along e's plane alone
 *
 * Every piece of the way lies in one face, and but for low lips each brings V nearer to P1, so V
 * never jumps from sheet to sheet: it stays on the front of a thin plate whose back is nearer, goes
 * round an edge only when it has come to it, and ends in a local minimum of the distance. That the
 * pieces lie in faces is also why a face across one of them is another surface (a second object, a
 * self-intersection), which no proxy may enter (Zilles, Salisbury 1995: at most three planes).
 *
 * Lips: seen from inside, a round surface that is made of flat faces has a local minimum on each of
 * several faces, and a proxy that goes down only stays behind by one or two of them.
 *
 * Nothing but V and its face is kept. A walk that has settled, begun again for the same P1, finds
 * the same foot on the same face and no face to go on to: the V of a tip at rest is a fixed point.
 * The distance falls with what V moves (nearest.h), if only by rounding, and by more than that over
 * a lip: no cycle.
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
#define WALK_PARALLEL REAL(1e-6) /* sin^2 */

/*
 * A lip is low if the faces on either side are less than 30 degrees apart, and it is no farther from
 * the tip than V by more than this: what faces 20 degrees apart have, at equal distance from it.
 */
#define WALK_LIP_COSINE REAL(0.866)
#define WALK_LIP REAL(1.0154) /* 1 / cos 10 degrees */

/*
 * Nearer by less than this part of the distance is rounding. It is small because at a lip V goes far
 * for little: 20 um for 4 nm on facets of 0.2 mm, 3 mm deep.
 */
#define WALK_NEARER REAL(4e-7)

/* The lanes of one step. */
#define WALK_STEP_BITS ((1u << PHANTOM_LANES) - 1)

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
		at = crossing_find_beside(job->set, &segment, CROSSING_INWARD, false, REAL(-1),
					  &beside);
		if (at.patch == PHANTOM_PATCH_NONE)
			for (i = 0; i < 3; i++)
				walk->proxy_nm[i] = target[i];
		else if (mul(at.along, segment.length) > walk->still)
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
	*way = real3_add(real3_scale(gf, divide(hf - mul(cosine, hc), sine2)),
			 real3_scale(gc, divide(hc - mul(cosine, hf), sine2)));
	return true;
}

/* Shortens the way's end to where V would leave its face; true if it would, over the edge *edge. */
static inline bool walk_clip(const struct walk *walk, struct real3 *way, u32 *edge)
{
	const struct block *block = &walk->job->set->blocks[walk->patch / PHANTOM_BLOCK];
	u32 lane = walk->patch % PHANTOM_BLOCK, i;
	struct real3 g = row3_lane(&block->face_normal, lane);
	struct real3 go = real3_sub(*way, walk->way);
	real part = REAL(1);
	bool clipped = false;

	for (i = 0; i < 3; i++) {
		struct real3 inward = real3_cross(g, row3_lane(&block->edge[i].along, lane));
		struct real3 q = from_corner_lane(block, lane, i, walk->proxy_nm);
		real begin = real_max(real3_dot(inward, q), 0);
		real fall = -real3_dot(inward, go);

		if (!(fall > 0) || !(begin < mul(part, fall)))
			continue;
		part = divide(begin, fall);
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
	if (clipped || real3_dot(moved, moved) > mul(4 * walk->still, walk->still))
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
	real farthest = mul(walk->still, walk->still);
	u32 found = PHANTOM_PATCH_NONE, i, step, l;

	if (feature_is_face(walk->at))
		return found;
	for (i = 0; i < set->block_count; i++) {
		const struct block *block = &set->blocks[i];
		u32 bits = ring_bits(block, walk->at);

		for (step = 0; bits >> step * PHANTOM_LANES; step++) {
			u32 here = bits >> step * PHANTOM_LANES & WALK_STEP_BITS;
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

/*
 * The way to the lowest place of the lip between V's face and that patch: the point of what the two
 * share that is nearest to the tip. False if they share nothing.
 */
static inline bool walk_lip(const struct walk *walk, u32 patch, struct real3 *way)
{
	const struct phantom_float_set *set = walk->job->set;
	const struct block *from = &set->blocks[walk->patch / PHANTOM_BLOCK];
	const struct block *to = &set->blocks[patch / PHANTOM_BLOCK];
	u32 lane = walk->patch % PHANTOM_BLOCK, other = patch % PHANTOM_BLOCK, i, j;
	u32 shared[3] = {0}, first = 3, count = 0;
	struct real3 q, e;

	for (i = 0; i < 3; i++) {
		for (j = 0; j < 3; j++)
			shared[i] |= from->vertex[i][lane] == to->vertex[j][other];
		count += shared[i];
		if (shared[i] && first == 3)
			first = i;
	}
	if (!count)
		return false;
	/* an edge i to i + 1 begins where the vertex before is not shared */
	if (count == 2 && first == 0 && shared[2])
		first = 2;
	q = from_corner_lane(from, lane, first, walk->job->tip_nm);
	*way = real3_scale(q, REAL(-1));
	if (count == 1)
		return true;
	e = row3_lane(&from->edge[first].along, lane);
	*way = real3_add(
		*way,
		real3_scale(e, real_clamp(mul(real3_dot(e, q),
					      row_lane(from->edge[first].inverse_length2, lane)),
					  0, REAL(1))));
	return true;
}

/* Does no other surface lie across a way within that patch? */
static inline bool walk_clear(const struct walk *walk, u32 patch, struct real3 begin,
			      struct real3 end)
{
	const struct phantom_float_job *job = walk->job;
	const struct block *block = &job->set->blocks[patch / PHANTOM_BLOCK];
	struct beside beside = {.patch = patch};
	struct segment segment;
	s32 from[3], to[3];
	u32 i;

	for (i = 0; i < 3; i++)
		beside.vertex[i] = block->vertex[i][patch % PHANTOM_BLOCK];
	nm_offset(job->tip_nm, begin, from);
	nm_offset(job->tip_nm, end, to);
	return !segment_set(&segment, from, to) ||
	       crossing_find_beside(job->set, &segment, CROSSING_INWARD, false, REAL(-1), &beside)
			       .patch == PHANTOM_PATCH_NONE;
}

/*
 * V goes on to the face beside its own that comes nearest to the tip, nearer than V, over a low lip.
 * False if there is none.
 */
static inline bool walk_over_lip(struct walk *walk)
{
	const struct phantom_float_set *set = walk->job->set;
	const struct block *own = &set->blocks[walk->patch / PHANTOM_BLOCK];
	const struct lanes3 g = lanes3_all(walk_face_normal(walk, walk->patch));
	real distance = real3_length(walk->way), lip_max = mul(distance, WALK_LIP);
	real nearest = real_max(distance - mul(WALK_NEARER, distance + set->extent), 0);
	struct real3 lip, across = walk->way, end = walk->way;
	u32 found = PHANTOM_PATCH_NONE, vertex[3], i, step, l;

	nearest = mul(nearest, nearest);
	for (i = 0; i < 3; i++)
		vertex[i] = own->vertex[i][walk->patch % PHANTOM_BLOCK];
	for (i = 0; i < set->block_count; i++) {
		const struct block *block = &set->blocks[i];
		u32 bits = ring_touches(block, vertex);

		for (step = 0; bits >> step * PHANTOM_LANES; step++) {
			u32 here = bits >> step * PHANTOM_LANES & WALK_STEP_BITS;
			struct nearest_step at;
			lanes distance2;

			if (!here)
				continue;
			nearest_evaluate(block, step, &walk->tip, &at);
			distance2 = lanes3_dot(at.way, at.way);
			here &= mask_bits((distance2 < nearest) & (block->radius[step] > 0) &
					  (lanes3_dot(row3_step(&block->face_normal, step), g) >
					   WALK_LIP_COSINE));
			for (l = 0; here >> l; l++) {
				u32 patch = i * PHANTOM_BLOCK + step * PHANTOM_LANES + l;

				if (!(here >> l & 1) || !(distance2[l] < nearest) ||
				    patch == walk->patch || !walk_lip(walk, patch, &lip) ||
				    real3_length(lip) > lip_max)
					continue;
				nearest = distance2[l];
				found = patch;
				across = lip;
				end = lanes3_lane(at.way, l);
			}
		}
	}
	if (found == PHANTOM_PATCH_NONE || !walk_clear(walk, walk->patch, walk->way, across) ||
	    !walk_clear(walk, found, across, end))
		return false;
	walk->patch = found;
	walk->way = end;
	nm_offset(walk->job->tip_nm, end, walk->proxy_nm);
	return true;
}

/* On one face, and on to the next one. */
static inline void walk_step(struct walk *walk)
{
	const s32 start[3] = {walk->proxy_nm[0], walk->proxy_nm[1], walk->proxy_nm[2]};
	struct foot foot = walk_foot(walk, walk->patch);
	u32 across = walk_along(walk, foot.way, walk->patch), next;

	if (across != PHANTOM_PATCH_NONE) {
		walk->settled = walk_held(walk, across, start);
		next = walk->settled ? PHANTOM_PATCH_NONE : walk_next(walk);
		if (next != PHANTOM_PATCH_NONE)
			walk->patch = next;
		return;
	}
	walk->at = foot.at;
	walk->held[0] = walk->patch;
	walk->held_count = 1;
	next = walk_next(walk);
	if (next != PHANTOM_PATCH_NONE)
		walk->patch = next;
	else
		walk->settled = !walk_over_lip(walk);
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
	walk->still = 2 * (rounding + mul(REAL(5e-7), real3_length(walk->way)));
	walk->lift = walk->still;
	walk->patch = patch;
	walk->settled = false;
	for (faces = 0; faces < WALK_FACES_MAX && !walk->settled; faces++)
		walk_step(walk);
	for (i = 0; i < 3; i++)
		job->proxy_nm[i] = walk->proxy_nm[i];
	job->proxy_face =
		job->set->blocks[walk->patch / PHANTOM_BLOCK].face[walk->patch % PHANTOM_BLOCK];
}

#endif /* PHANTOM_FLOAT_WALK_H */
