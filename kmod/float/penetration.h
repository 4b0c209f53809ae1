/* SPDX-License-Identifier: GPL-2.0-only */
/*
 * penetration.h - below the surface: the state `inside` and the proxy V (proxy=paper).
 *
 *   P0, P1: the tip before and now
 *   outside: path P0 P1 crosses a face inward at X       -> inside, V = X
 *            ... and outward again later, with no surface over P1 as seen along X's face normal
 *                                                         -> outside (a ridge was clipped)
 *            a shell contact below its face by rounding   -> inside, V = its foot
 *   inside:  path crosses a face outward at Y             -> outside
 *            ... and inward again after Y, at X           -> inside, V = X
 *            else V' = V + (P1 - P0); of the outward crossings of P1 V' the one nearest to V' is
 *            the new V; if there is none, V stays
 *            ... unless P1 is on a face from outside, by rounding  -> outside
 *   force inside: F = k (R n(V) + (V - P1)), k and R of V's face, n(V) the model's own normal at
 *   the surface: it meets the shell's force at height 0.
 *
 * A path that goes in and out within one tick either ran through a thin plate, which must hold
 * it, or clipped a ridge, which must not: what tells them apart is whether a surface still stands
 * over the tip. The two rules "by rounding" catch paths so flat that no crossing is found.
 *
 * V is kept in whole nm, so P1 V' is prolonged until it ends twice rounding_mm() higher over V's
 * face: a V that rounding put under its face is found again. The direction is kept, or V would
 * creep by some nm a tick.
 */
#ifndef PHANTOM_FLOAT_PENETRATION_H
#define PHANTOM_FLOAT_PENETRATION_H

#include "crossing.h"
#include "paper.h"
#include "combine.h"
#include "rim.h"

/* V's face is looked for again within this distance if the set has lost its number, mm. */
#define PROXY_REFIND_MM REAL(1e-3)

/* How far after an outward crossing an inward one must come to be another one, mm. */
#define CROSSING_APART REAL(1e-5)

static inline void penetration_enter(struct phantom_float_job *job, const struct segment *segment,
				     struct crossing at)
{
	job->inside = 1;
	segment_point(segment, at.along, job->proxy_nm);
	job->proxy_face = job->set->blocks[at.patch / PHANTOM_BLOCK].face[at.patch % PHANTOM_BLOCK];
}

static inline void penetration_leave(struct phantom_float_job *job)
{
	job->inside = 0;
	job->proxy_face = PHANTOM_PATCH_NONE;
}

/* Does a surface stand over the tip, up to the plane of that patch, along its face normal? */
static inline bool penetration_covered(const struct phantom_float_job *job, u32 patch)
{
	const struct block *block = &job->set->blocks[patch / PHANTOM_BLOCK];
	u32 lane = patch % PHANTOM_BLOCK;
	struct real3 g = row3_lane(&block->face_normal, lane);
	real depth = -real3_dot(g, from_corner_lane(block, lane, 0, job->tip_nm));
	struct segment over;
	s32 top[3];

	nm_offset(job->tip_nm, real3_scale(g, depth + 2 * rounding_mm(job->set)), top);
	if (!segment_set(&over, job->tip_nm, top))
		return false;
	return crossing_find(job->set, &over, CROSSING_OUTWARD, false, REAL(-1)).patch !=
	       PHANTOM_PATCH_NONE;
}

/* Outside: true if this tick's path ends inside. */
static inline bool penetration_from_outside(struct phantom_float_job *job)
{
	struct segment path;
	struct crossing in, out;

	if (!job->path_valid || !segment_set(&path, job->previous_nm, job->tip_nm))
		return false;
	in = crossing_find(job->set, &path, CROSSING_INWARD, false, REAL(-1));
	if (in.patch == PHANTOM_PATCH_NONE)
		return false;
	out = crossing_find(job->set, &path, CROSSING_OUTWARD, false, in.along);
	if (out.patch != PHANTOM_PATCH_NONE && !penetration_covered(job, in.patch))
		return false;
	penetration_enter(job, &path, in);
	return true;
}

/* Inside: true if the path crossed a face outward; the state is then settled. */
static inline bool penetration_from_inside(struct phantom_float_job *job)
{
	struct segment path;
	struct crossing out, in;

	if (!job->path_valid || !segment_set(&path, job->previous_nm, job->tip_nm))
		return false;
	out = crossing_find(job->set, &path, CROSSING_OUTWARD, false, REAL(-1));
	if (out.patch == PHANTOM_PATCH_NONE)
		return false;
	penetration_leave(job);
	in = crossing_find(job->set, &path, CROSSING_INWARD, false,
			   out.along + divide(CROSSING_APART, path.length));
	if (in.patch != PHANTOM_PATCH_NONE)
		penetration_enter(job, &path, in);
	return true;
}

/* The patch V lies on: by number, else the nearest face within PROXY_REFIND_MM, else NONE. */
static inline u32 penetration_find_patch(struct phantom_float_job *job)
{
	const struct phantom_float_set *set = job->set;
	struct nm_point proxy = nm_point(job->proxy_nm);
	struct paper_step at;
	u32 found = PHANTOM_PATCH_NONE, i, step, lane;
	real nearest = PROXY_REFIND_MM;

	for (i = 0; i < set->block_count; i++)
		for (lane = 0; lane < PHANTOM_BLOCK; lane++)
			if (set->blocks[i].face[lane] == job->proxy_face &&
			    row_lane(set->blocks[i].radius, lane) > 0)
				return i * PHANTOM_BLOCK + lane;
	for (i = 0; i < set->block_count; i++) {
		for (step = 0; step < PHANTOM_STEPS; step++) {
			const struct block *block = &set->blocks[i];
			u32 near;

			if (!paper_evaluate(block, step, &proxy, PROXY_REFIND_MM, &at))
				continue;
			near = mask_bits(at.contact);
			for (lane = 0; lane < PHANTOM_LANES; lane++) {
				if (!(near >> lane & 1) || !(real_abs(at.height[lane]) < nearest))
					continue;
				nearest = real_abs(at.height[lane]);
				found = i * PHANTOM_BLOCK + step * PHANTOM_LANES + lane;
			}
		}
	}
	if (found != PHANTOM_PATCH_NONE)
		job->proxy_face = set->blocks[found / PHANTOM_BLOCK].face[found % PHANTOM_BLOCK];
	return found;
}

/* Is the tip on some face from outside, but for rounding? */
static inline bool penetration_surfaced(const struct phantom_float_job *job)
{
	const struct phantom_float_set *set = job->set;
	struct nm_point tip = nm_point(job->tip_nm);
	real rounding = rounding_mm(set);
	u32 i, step;

	for (i = 0; i < set->block_count; i++) {
		for (step = 0; step < PHANTOM_STEPS; step++) {
			const struct block *block = &set->blocks[i];
			struct lanes3 q = from_corner(block, step, 0, &tip);
			lanes height = lanes3_dot(row3_step(&block->face_normal, step), q);
			struct paper_step at;
			u32 l, near = mask_bits((height > 0) & (height <= 2 * rounding) &
						within_reach(block, step, q, lanes_all(rounding)));

			if (!near || !paper_evaluate(block, step, &tip, rounding, &at))
				continue;
			near &= mask_bits(at.contact);
			for (l = 0; l < PHANTOM_LANES; l++)
				if (near >> l & 1)
					return true;
		}
	}
	return false;
}

/* Moves the end of P1 V' twice rounding_mm() up over a face with normal g. */
static inline void penetration_prolong(const struct phantom_float_job *job, struct real3 g,
				       s32 target[3])
{
	real rounding = rounding_mm(job->set), length, rise;
	struct real3 way = {
		real_from_nm((s64)target[0] - job->tip_nm[0]),
		real_from_nm((s64)target[1] - job->tip_nm[1]),
		real_from_nm((s64)target[2] - job->tip_nm[2]),
	};

	length = real3_length(way);
	rise = real3_dot(way, g);
	/* a way without direction, or one that hardly rises: along the normal instead */
	if (length < 16 * rounding || rise < mul(REAL(0.01), length))
		nm_offset(target, real3_scale(g, 2 * rounding), target);
	else
		nm_offset(target, real3_scale(way, divide(2 * rounding, rise)), target);
}

/* V follows the tip. Returns the patch V lies on, NONE if it is not in the set. */
static inline u32 penetration_follow(struct phantom_float_job *job)
{
	u32 patch = penetration_find_patch(job);
	const struct block *block;
	struct real3 g;
	struct segment over;
	struct crossing at;
	s32 target[3];
	u32 axis;

	if (patch == PHANTOM_PATCH_NONE)
		return patch;
	block = &job->set->blocks[patch / PHANTOM_BLOCK];
	g = row3_lane(&block->face_normal, patch % PHANTOM_BLOCK);
	for (axis = 0; axis < 3; axis++) {
		s64 moved = job->path_valid ? (s64)job->tip_nm[axis] - job->previous_nm[axis] : 0;

		target[axis] = nm_place(job->proxy_nm[axis] + moved);
	}
	penetration_prolong(job, g, target);
	if (!segment_set(&over, job->tip_nm, target))
		return patch;
	at = crossing_find(job->set, &over, CROSSING_OUTWARD, true, REAL(-1));
	if (at.patch != PHANTOM_PATCH_NONE) {
		penetration_enter(job, &over, at);
		return at.patch;
	}
	if (penetration_surfaced(job)) {
		penetration_leave(job);
		return PHANTOM_PATCH_NONE;
	}
	return patch;
}

/* Barycentric interpolation of the vertex normals at a point of the face: `projected` at h = 0. */
static inline struct real3 surface_normal_barycentric(const struct block *block, u32 lane,
						      const s32 point_nm[3])
{
	struct real3 q = from_corner_lane(block, lane, 0, point_nm);
	struct real3 e1 = row3_lane(&block->edge[0].along, lane);
	struct real3 e2 = real3_scale(row3_lane(&block->edge[2].along, lane), REAL(-1));
	struct real3 g = row3_lane(&block->face_normal, lane);
	struct real3 n;
	real b0, b1, b2, area = real3_dot(real3_cross(e1, e2), g);

	b1 = real_clamp(divide(real3_dot(real3_cross(q, e2), g), area), 0, REAL(1));
	b2 = real_clamp(divide(real3_dot(real3_cross(e1, q), g), area), 0, REAL(1) - b1);
	b0 = REAL(1) - b1 - b2;
	n = real3_scale(row3_lane(&block->edge[0].normal, lane), b0);
	n = real3_add(n, real3_scale(row3_lane(&block->edge[1].normal, lane), b1));
	return real3_add(n, real3_scale(row3_lane(&block->edge[2].normal, lane), b2));
}

/* Step 3 of Algorithm 1 at a point of the face. */
static inline struct real3 surface_normal_paper(const struct block *block, u32 lane,
						const s32 point_nm[3])
{
	struct nm_point point = nm_point(point_nm);
	u32 step = lane / PHANTOM_LANES, i;
	struct paper_wall wall[3];

	for (i = 0; i < 3; i++) {
		wall[i] = paper_wall(&block->edge[i], step, from_corner(block, step, i, &point));
		wall[i].distance = lanes_max(wall[i].distance, lanes_all(0));
	}
	return lanes3_lane(paper_normal(wall), lane % PHANTOM_LANES);
}

/* n(V) of the patch that V lies on, of unit length. */
static inline struct real3 penetration_normal(const struct phantom_float_job *job, u32 patch)
{
	const struct block *block = &job->set->blocks[patch / PHANTOM_BLOCK];
	u32 lane = patch % PHANTOM_BLOCK;
	struct real3 normal = job->model.model == PHANTOM_MODEL_PAPER
				      ? surface_normal_paper(block, lane, job->proxy_nm)
				      : surface_normal_barycentric(block, lane, job->proxy_nm);
	real length = real3_length(normal);

	if (!(length > 0))
		return row3_lane(&block->face_normal, lane);
	return real3_unit(normal);
}

/* F = k (R n(V) + (V - P1)) */
static inline void penetration_force(const struct phantom_float_job *job, u32 patch,
				     struct real3 normal, struct contact_force *out)
{
	const struct block *block = &job->set->blocks[patch / PHANTOM_BLOCK];
	const struct float_material *material =
		&job->set->materials[block->material[patch % PHANTOM_BLOCK]];

	out->normal = normal;
	out->force = real3_add(real3_scale(normal, material->radius),
			       nm_way(job->tip_nm, job->proxy_nm));
	out->force = real3_scale(out->force, material->stiffness);
	out->damping = material->damping;
	out->deepest_patch = patch;
	out->contacts = 1;
	rim_fade_held(job->set, patch, job->proxy_nm, out);
}

#endif /* PHANTOM_FLOAT_PENETRATION_H */
