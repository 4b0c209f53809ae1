/* SPDX-License-Identifier: GPL-2.0-only */
/*
 * prepare.h - from validated patches (integers) to blocks: everything that can be computed once
 * per set. Scalar float64 (`wide`: in software where there is no float) with exact integer cross
 * products, so that a sliver's plane is as good as its nm coordinates allow, and the same bits in
 * every unit.
 */
#ifndef PHANTOM_FLOAT_PREPARE_H
#define PHANTOM_FLOAT_PREPARE_H

#include "block.h"
#include "effects/convert.h"
#include "wide3.h"

/*
 * A triangle lower than this has no plane to speak of: the nm grid of the border alone turns its
 * normal by 5 degrees.
 */
#define SLIVER_HEIGHT_NM 16

/* Of such a triangle's three normals, added up, that much must stand across its longest edge. */
#define SLIT_NORMAL_MIN WIDE(1e-3)

/*
 * A fan with less between its normals is too narrow to have a shell: over an edge, radians; over a
 * vertex, their square. What is left open at R is below a nm.
 */
#define FAN_EDGE_MIN WIDE(1e-8)
#define FAN_CORNER_MIN WIDE(1e-14)

/* Least |N| that is reckoned with: h <= R / |N| (normals of a patch more than 160 degrees apart). */
#define NORMAL_LENGTH_MIN WIDE(0.15)

static inline void row_set(lanes *row, u32 lane, wide value)
{
	row[lane / PHANTOM_LANES][lane % PHANTOM_LANES] = real_from_wide(value);
}

static inline void row3_set(struct row3 *row, u32 lane, struct wide3 value)
{
	row_set(row->x, lane, value.x);
	row_set(row->y, lane, value.y);
	row_set(row->z, lane, value.z);
}

/* A patch in float64, mm. */
struct patch_geometry {
	struct wide3 normal[3]; /* m */
	struct wide3 edge[3]; /* e_i = x_(i+1) - x_i */
	wide length2[3]; /* |e_i|^2 */
	/*
	 * A(h) of projected.h from its first term that does not vanish on: h^order lead size, then
	 * the terms after it, divided by size. A face has order 0, lead = g and size = |A0|, twice
	 * its area in mm^2.
	 */
	u32 order;
	wide size;
	struct wide3 lead, area1, area2;
	wide radius; /* R, mm */
};

static inline struct wide3 edge_nm(const struct phantom_patch *patch, u32 from, u32 to)
{
	const s32 *a = patch->vertex_nm[from], *b = patch->vertex_nm[to];

	return wide3_from_integers((s64)b[0] - a[0], (s64)b[1] - a[1], (s64)b[2] - a[2]);
}

/* (x1 - x0) x (x2 - x0) in nm^2. Exact in integers: differences are below 2^31 for +-1 m. */
static inline struct wide3 cross_nm2(const struct phantom_patch *patch)
{
	const s32 *x0 = patch->vertex_nm[0], *x1 = patch->vertex_nm[1], *x2 = patch->vertex_nm[2];
	s64 a[3], b[3];
	u32 axis;

	for (axis = 0; axis < 3; axis++) {
		a[axis] = (s64)x1[axis] - x0[axis];
		b[axis] = (s64)x2[axis] - x0[axis];
	}
	return wide3_from_integers(a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2],
				   a[0] * b[1] - a[1] * b[0]);
}

/* Normals and edges; returns the square of the longest edge, nm^2. */
static inline wide patch_corners(const struct phantom_patch *patch, struct patch_geometry *out)
{
	wide longest2_nm2 = WIDE(0);
	u32 i;

	for (i = 0; i < 3; i++) {
		const s32 *m = patch->normal_q30[i];
		struct wide3 edge = edge_nm(patch, i, (i + 1) % 3);
		wide length2 = wide3_dot(edge, edge);

		if (wide_less(longest2_nm2, length2))
			longest2_nm2 = length2;
		out->edge[i] = wide3_scale(edge, WIDE(1e-6));
		out->length2[i] = wide_mul(length2, WIDE(1e-12));
		out->normal[i] = wide3_scale(wide3_from_integers(m[0], m[1], m[2]),
					     WIDE(1.0 / PHANTOM_Q30_ONE));
	}
	return longest2_nm2;
}

/* A1 and A2 of A(h). */
static inline void patch_turns(const struct patch_geometry *p, struct wide3 *area1,
			       struct wide3 *area2)
{
	struct wide3 e1 = p->edge[0], e2 = wide3_scale(p->edge[2], WIDE(-1));
	struct wide3 f1 = wide3_sub(p->normal[1], p->normal[0]);
	struct wide3 f2 = wide3_sub(p->normal[2], p->normal[0]);

	*area1 = wide3_add(wide3_cross(e1, f2), wide3_cross(f1, e2));
	*area2 = wide3_cross(f1, f2);
}

/* False where the face has no trustworthy plane. */
static inline bool face_measure(const struct phantom_patch *patch, struct patch_geometry *out)
{
	struct wide3 cross = cross_nm2(patch), area1, area2;
	wide size_nm2 = wide3_length(cross);
	wide longest2_nm2 = patch_corners(patch, out);

	/* height over the longest edge = size / that edge */
	if (wide_less(wide_mul(size_nm2, size_nm2),
		      wide_mul(WIDE(SLIVER_HEIGHT_NM * SLIVER_HEIGHT_NM), longest2_nm2)) ||
	    !wide_less(WIDE(0), size_nm2))
		return false;
	patch_turns(out, &area1, &area2);
	out->order = 0;
	out->size = wide_mul(size_nm2, WIDE(1e-12));
	out->lead = wide3_scale(cross, wide_inverse(size_nm2));
	out->area1 = wide3_scale(area1, wide_inverse(out->size));
	out->area2 = wide3_scale(area2, wide_inverse(out->size));
	return true;
}

/* False where its normals are too near to one another for a shell. */
static inline bool fan_measure(const struct phantom_patch *patch, struct patch_geometry *out)
{
	wide longest_nm = wide_sqrt(patch_corners(patch, out)), least;
	struct wide3 area1, area2;

	patch_turns(out, &area1, &area2);
	if (patch->kind == PHANTOM_PATCH_EDGE) {
		out->order = 1;
		out->lead = area1;
		out->area1 = area2;
		least = wide_mul(wide_mul(FAN_EDGE_MIN, longest_nm), WIDE(1e-6));
	} else {
		out->order = 2;
		out->lead = area2;
		out->area1 = wide3_from_integers(0, 0, 0);
		least = FAN_CORNER_MIN;
	}
	out->area2 = wide3_from_integers(0, 0, 0);
	out->size = wide3_length(out->lead);
	if (!wide_less(least, out->size))
		return false;
	out->lead = wide3_scale(out->lead, wide_inverse(out->size));
	out->area1 = wide3_scale(out->area1, wide_inverse(out->size));
	return true;
}

/* False where a term of the cubic is too large for a real. */
static inline bool patch_fits(const struct patch_geometry *p)
{
	return wide_fits(wide3_length(p->area1)) && wide_fits(wide3_length(p->area2));
}

static inline void prepare_edges(struct block *block, u32 lane, const struct patch_geometry *p)
{
	u32 i;

	for (i = 0; i < 3; i++) {
		struct paper_edge *edge = &block->edge[i];
		struct wide3 along = wide3_sub(p->normal[(i + 1) % 3], p->normal[i]);
		/* an edge that is a point: only a fan has one, and no use for the rest */
		wide length2 = wide_less(WIDE(0), p->length2[i]) ? p->length2[i] : WIDE(1);
		wide inverse_length = wide_inverse(wide_sqrt(length2));

		row3_set(&edge->along, lane, p->edge[i]);
		row_set(edge->inverse_length2, lane, wide_inverse(length2));
		row3_set(&edge->normal, lane, p->normal[i]);
		row3_set(&edge->normal_along, lane, along);
		row3_set(&edge->wall, lane,
			 wide3_scale(wide3_cross(p->normal[i], p->edge[i]), inverse_length));
		row3_set(&edge->wall_along, lane,
			 wide3_scale(wide3_cross(along, p->edge[i]), inverse_length));
	}
}

/* A lower bound of |N| over the patch: N . u >= min m_i . u, with u along m0 + m1 + m2. */
static inline wide normal_length_min(const struct patch_geometry *p)
{
	struct wide3 sum = wide3_add(wide3_add(p->normal[0], p->normal[1]), p->normal[2]);
	wide length = wide3_length(sum);
	wide least = WIDE(1);
	u32 i;

	for (i = 0; i < 3; i++) {
		wide along = wide3_dot(p->normal[i], sum);

		if (wide_less(along, wide_mul(least, length)))
			least = wide_less(WIDE(0), length) ? wide_div(along, length) : WIDE(0);
	}
	return wide_less(NORMAL_LENGTH_MIN, least) ? least : NORMAL_LENGTH_MIN;
}

/*
 * How far the shell leans outward: P = sum b_i (x_i + h m_i) is h sum b_i m_i beside the face, at a
 * height of h sum b_i m_i.g; so no more than max |m_i beside g| / min m_i.g times its height.
 * paper's walls lean as much, each on its own: at a corner of angle a two of them meet 1 / sin(a / 2)
 * times as far out.
 */
static inline void prepare_lean(struct block *block, u32 lane, const struct patch_geometry *p)
{
	wide least = WIDE(1), most = WIDE(0), sharpest = WIDE(-1), lean = WIDE(LEAN_MOST), half;
	u32 i;

	for (i = 0; i < 3; i++) {
		const struct wide3 *e = &p->edge[i], *before = &p->edge[(i + 2) % 3];
		wide along = wide3_dot(p->normal[i], p->lead), beside, cosine;

		beside = wide3_length(wide3_sub(p->normal[i], wide3_scale(p->lead, along)));
		/* of the angle at corner i */
		cosine = wide_div(wide_sub(WIDE(0), wide3_dot(*e, *before)),
				  wide_sqrt(wide_mul(p->length2[i], p->length2[(i + 2) % 3])));
		least = wide_less(along, least) ? along : least;
		most = wide_less(most, beside) ? beside : most;
		sharpest = wide_less(sharpest, cosine) ? cosine : sharpest;
	}
	if (!p->order && wide_less(WIDE(1.0 / LEAN_MOST), least))
		lean = wide_add(wide_div(most, least), WIDE(1e-5));
	row_set(block->lean, lane, lean);
	/* sin^2(a / 2) = (1 - cos a) / 2 */
	half = wide_sqrt(wide_mul(wide_sub(WIDE(1), sharpest), WIDE(0.5)));
	if (!p->order && wide_less(lean, wide_mul(half, WIDE(LEAN_MOST))))
		row_set(block->lean_paper, lane, wide_div(lean, half));
	else
		row_set(block->lean_paper, lane, WIDE(LEAN_MOST));
}

/*
 * Where no term of c, c' and c'' on [0, H] is larger than TAME_MOST, nor any product of two of them than
 * TAME_PRODUCT_MOST, with the tip in reach: |q| <= R + 2 extent. 1 mm and a doubled m0 are for rounding
 * and for the grid of normals.
 */
#define TAME_MOST WIDE(1 << 12)
#define TAME_PRODUCT_MOST WIDE(1 << 24)

static inline bool patch_tame(const struct patch_geometry *p, wide height, wide extent)
{
	wide away = wide_add(wide_add(p->radius, wide_mul(WIDE(2), extent)), WIDE(1));
	wide area1 = wide3_length(p->area1), area2 = wide3_length(p->area2);
	wide c1 = wide_add(wide_mul(away, area1), WIDE(2));
	wide c2 = wide_add(wide_mul(away, area2), wide_mul(WIDE(2), area1));
	wide c3 = wide_mul(WIDE(2), area2);
	wide curve = wide_add(c2, wide_mul(WIDE(3), wide_mul(c3, height)));
	wide slope = wide_add(c1, wide_mul(wide_add(c2, curve), height));
	wide value = wide_add(away, wide_mul(slope, height));

	return wide_less(slope, TAME_MOST) && wide_less(curve, TAME_MOST) &&
	       wide_less(c3, TAME_MOST) && wide_less(value, TAME_MOST) &&
	       wide_less(wide_mul(value, wide_add(slope, curve)), TAME_PRODUCT_MOST);
}

static inline void prepare_shell(struct block *block, u32 lane, const struct patch_geometry *p,
				 wide extent)
{
	wide height = wide_div(p->radius, normal_length_min(p));

	row3_set(&block->face_normal, lane, p->lead);
	row_set(block->area, lane, p->size);
	row_set(block->order, lane, wide_from_integer(p->order));
	row3_set(&block->area1, lane, p->area1);
	row3_set(&block->area2, lane, p->area2);
	row_set(block->normal_area0, lane, wide3_dot(p->normal[0], p->lead));
	row_set(block->normal_area1, lane, wide3_dot(p->normal[0], p->area1));
	row_set(block->normal_area2, lane, wide3_dot(p->normal[0], p->area2));
	block->height_limit[lane / PHANTOM_LANES][lane % PHANTOM_LANES] =
		real_limit_height(real_from_wide(height));
	block_set_tame(block, lane, patch_tame(p, height, extent));
}

/* Corners and bounding sphere; returns its radius. */
static inline wide prepare_place(struct phantom_float_set *set, struct block *block, u32 lane,
				 const struct phantom_patch *patch, const struct patch_geometry *p)
{
	/* x1 - x0 and x2 - x0 as seen from the centroid */
	struct wide3 e1 = p->edge[0], e2 = wide3_scale(p->edge[2], WIDE(-1));
	struct wide3 centre = wide3_scale(wide3_add(e1, e2), WIDE(1.0 / 3));
	struct wide3 away[3] = {centre, wide3_sub(e1, centre), wide3_sub(e2, centre)};
	wide extent2 = WIDE(0), extent;
	u32 i, axis;

	for (i = 0; i < 3; i++) {
		wide away2 = wide3_dot(away[i], away[i]);

		if (wide_less(extent2, away2))
			extent2 = away2;
		for (axis = 0; axis < 3; axis++)
			block->corner[i][axis][lane / PHANTOM_LANES][lane % PHANTOM_LANES] =
				(coordinate)patch->vertex_nm[i][axis];
	}
	/* a little larger, so that rounding in the tick never rules out a patch in reach */
	extent = wide_add(wide_mul(wide_sqrt(extent2), WIDE(1 + 1e-5)), WIDE(1e-5));
	set->extent = real_max(set->extent, real_from_wide(extent));
	row3_set(&block->centre, lane, centre);
	row_set(block->extent, lane, extent);
	return extent;
}

static inline void prepare_patch(struct phantom_float_set *set, struct block *block, u32 lane,
				 const struct phantom_patch *patch, const struct patch_geometry *p)
{
	const struct float_material *material = &set->materials[patch->material];
	wide extent = prepare_place(set, block, lane, patch, p);

	block->radius[lane / PHANTOM_LANES][lane % PHANTOM_LANES] = material->radius;
	block->stiffness[lane / PHANTOM_LANES][lane % PHANTOM_LANES] = material->stiffness;
	prepare_edges(block, lane, p);
	prepare_lean(block, lane, p);
	prepare_shell(block, lane, p, extent);
}

/* Farther than a tip can come from a patch, mm; its square is below 2^27. */
#define IDLE_MM 1e4

/* A lane that can never be in contact. */
static inline void prepare_idle(struct block *block, u32 lane)
{
	const struct wide3 zero = wide3_from_integers(0, 0, 0);
	struct patch_geometry p = {.size = WIDE(1), .radius = WIDE(-1)};
	u32 i, axis;

	for (i = 0; i < 3; i++) {
		p.edge[i] = zero;
		p.normal[i] = zero;
		p.length2[i] = WIDE(1);
		for (axis = 0; axis < 3; axis++)
			block->corner[i][axis][lane / PHANTOM_LANES][lane % PHANTOM_LANES] = 0;
	}
	p.lead = zero;
	p.area1 = zero;
	p.area2 = zero;
	row_set(block->radius, lane, WIDE(-1));
	row3_set(&block->centre, lane, zero);
	row_set(block->extent, lane, WIDE(-IDLE_MM));
	row_set(block->stiffness, lane, WIDE(0));
	prepare_edges(block, lane, &p);
	row_set(block->lean, lane, WIDE(0));
	row_set(block->lean_paper, lane, WIDE(0));
	prepare_shell(block, lane, &p, WIDE(0));
}

/*
 * The plane of a face too low to have one: through its longest edge, towards the mean of its normals. False
 * for a face that is a point, and for normals along that edge.
 */
static inline bool slit_plane(const struct patch_geometry *p, struct wide3 *plane)
{
	struct wide3 normal = wide3_add(wide3_add(p->normal[0], p->normal[1]), p->normal[2]);
	u32 longest = 0, i;
	wide length;

	for (i = 1; i < 3; i++)
		if (wide_less(p->length2[longest], p->length2[i]))
			longest = i;
	if (!wide_less(WIDE(0), p->length2[longest]))
		return false;
	length = wide_div(wide3_dot(normal, p->edge[longest]), p->length2[longest]);
	normal = wide3_sub(normal, wide3_scale(p->edge[longest], length));
	length = wide3_length(normal);
	if (!wide_less(SLIT_NORMAL_MIN, length))
		return false;
	*plane = wide3_scale(normal, wide_inverse(length));
	return true;
}

/* A face that has no shell: never in contact, but no tip gets through it. See crossing_hand_over(). */
static inline void prepare_slit(struct phantom_float_set *set, struct block *block, u32 lane,
				const struct phantom_patch *patch, const struct patch_geometry *p,
				struct wide3 plane)
{
	prepare_idle(block, lane);
	prepare_place(set, block, lane, patch, p);
	row3_set(&block->face_normal, lane, plane);
}

static inline u32 blocks_for(u32 patch_count)
{
	return (patch_count + PHANTOM_BLOCK - 1) / PHANTOM_BLOCK;
}

static inline u32 fan_count(const struct phantom_float_prepare *prepare)
{
	return prepare->patch_count - prepare->face_count - prepare->rim_count;
}

/* Fans begin a block of their own. */
static inline u32 lane_of_patch(const struct phantom_float_prepare *prepare, u32 index)
{
	u32 faces = prepare->face_count;

	return index < faces ? index : index - faces + blocks_for(faces) * PHANTOM_BLOCK;
}

static inline real real_scaled(u32 value, wide unit)
{
	return real_from_wide(wide_mul(wide_from_integer(value), unit));
}

static inline void prepare_header(const struct phantom_float_prepare *prepare)
{
	struct phantom_float_set *set = prepare->set;
	u32 i;

	set->patch_count = prepare->patch_count;
	set->block_count = blocks_for(prepare->face_count);
	set->fan_block_count = blocks_for(fan_count(prepare));
	set->rim_block_count = blocks_for(prepare->rim_count);
	set->material_count = prepare->material_count;
	set->scratch_offset =
		sizeof(*set) +
		(u64)(set->block_count + set->fan_block_count) * sizeof(struct block) +
		(u64)set->rim_block_count * sizeof(struct rim_block);
	set->extent = 0;
	set->radius = 0;
	for (i = 0; i < prepare->material_count; i++) {
		const struct phantom_material *in = &prepare->materials[i];
		struct float_material *material = &set->materials[i];
		bool damped = in->effects & PHANTOM_EFFECT_DAMPING;

		material->stiffness = real_scaled(in->stiffness_mn_mm, WIDE(1e-3));
		material->radius = real_scaled(in->radius_nm, WIDE(1e-6));
		material->most = real_limit_force(mul(material->stiffness, material->radius));
		/* mN s/m = 1e-6 N per mm/s */
		material->damping = damped ? real_scaled(in->damping_mns_m, WIDE(1e-6)) : 0;
		set->radius = real_max(set->radius, material->radius);
	}
	if (prepare->effects)
		effects_prepare(prepare);
}

/* The same fan over an edge, begun with the corner that stands alone: x1 = x2. */
static inline void turn_edge_fan(const struct phantom_patch *patch, struct phantom_patch *out)
{
	u32 alone = 0, i, axis;

	for (i = 0; i < 3; i++) {
		const s32 *a = patch->vertex_nm[(i + 1) % 3], *b = patch->vertex_nm[(i + 2) % 3];

		if (a[0] == b[0] && a[1] == b[1] && a[2] == b[2])
			alone = i;
	}
	*out = *patch;
	for (i = 0; i < 3; i++) {
		u32 from = (i + alone) % 3;

		out->vertex[i] = patch->vertex[from];
		for (axis = 0; axis < 3; axis++) {
			out->vertex_nm[i][axis] = patch->vertex_nm[from][axis];
			out->normal_q30[i][axis] = patch->normal_q30[from][axis];
		}
	}
}

/* A patch, in the lane that is its own. */
static inline void prepare_one(struct phantom_float_prepare *prepare, u32 index)
{
	struct phantom_float_set *set = prepare->set;
	const struct phantom_patch *patch = &prepare->patches[index];
	struct phantom_patch turned;
	u32 at = lane_of_patch(prepare, index), lane = at % PHANTOM_BLOCK, i;
	struct block *block = &set->blocks[at / PHANTOM_BLOCK];
	bool face = patch->kind == PHANTOM_PATCH_FACE, measured;
	struct patch_geometry geometry;
	struct wide3 plane;

	if (patch->kind == PHANTOM_PATCH_EDGE) {
		turn_edge_fan(patch, &turned);
		patch = &turned;
	}
	geometry.radius = wide_mul(wide_from_integer(prepare->materials[patch->material].radius_nm),
				   WIDE(1e-6));
	block->face[lane] = patch->face;
	block->material[lane] = patch->material;
	block->surface[lane] = patch->surface;
	for (i = 0; i < 3; i++)
		block->vertex[i][lane] = patch->vertex[i];
	measured = face ? face_measure(patch, &geometry) : fan_measure(patch, &geometry);
	if (measured && patch_fits(&geometry)) {
		prepare_patch(set, block, lane, patch, &geometry);
		return;
	}
	prepare->refused++;
	if (measured)
		plane = geometry.lead;
	if (face && (measured || slit_plane(&geometry, &plane)))
		prepare_slit(set, block, lane, patch, &geometry, plane);
	else
		prepare_idle(block, lane);
}

/* The rest of the block in which lane `at` - 1 is the last one used. */
static inline void prepare_padding(struct phantom_float_set *set, u32 at)
{
	u32 i;

	for (; at % PHANTOM_BLOCK; at++) {
		struct block *block = &set->blocks[at / PHANTOM_BLOCK];
		u32 lane = at % PHANTOM_BLOCK;

		prepare_idle(block, lane);
		block->face[lane] = PHANTOM_PATCH_NONE;
		block->material[lane] = 0;
		block->surface[lane] = 0;
		for (i = 0; i < 3; i++)
			block->vertex[i][lane] = PHANTOM_PATCH_NONE;
	}
}

static inline void rim_set(struct rim_block *block, u32 lane, const s32 from_nm[3], u32 surface)
{
	u32 step = lane / PHANTOM_LANES, l = lane % PHANTOM_LANES, axis;

	for (axis = 0; axis < 3; axis++)
		block->from[axis][step][l] = (coordinate)from_nm[axis];
	block->surface[step][l] = (coordinate)(s32)surface;
}

/* A rim, in the lane that is its own; no kind of patch is computed so easily: none is refused. */
static inline void prepare_rim(const struct phantom_float_prepare *prepare, u32 index)
{
	const struct phantom_patch *patch = &prepare->patches[index];
	u32 at = index - (prepare->patch_count - prepare->rim_count), lane = at % PHANTOM_BLOCK;
	struct rim_block *block = &set_rims(prepare->set)[at / PHANTOM_BLOCK];
	struct wide3 edge = edge_nm(patch, 0, 1);
	wide length_nm = wide3_length(edge);
	wide inverse = wide_less(WIDE(0), length_nm) ? wide_inverse(length_nm) : WIDE(0);

	rim_set(block, lane, patch->vertex_nm[0], patch->surface);
	row3_set(&block->along, lane, wide3_scale(edge, inverse));
	row_set(block->length, lane, wide_mul(length_nm, WIDE(1e-6)));
}

/* The rest of the last block of rims. */
static inline void prepare_rim_padding(const struct phantom_float_prepare *prepare)
{
	static const s32 nowhere[3] = {0, 0, 0};
	u32 at;

	for (at = prepare->rim_count; at % PHANTOM_BLOCK; at++) {
		struct rim_block *block = &set_rims(prepare->set)[at / PHANTOM_BLOCK];
		u32 lane = at % PHANTOM_BLOCK;

		rim_set(block, lane, nowhere, 0);
		row3_set(&block->along, lane, wide3_from_integers(0, 0, 0));
		row_set(block->length, lane, WIDE(0));
	}
}

static void section_prepare(struct phantom_float_prepare *prepare)
{
	u32 index, end = prepare->first + prepare->count;
	u32 rims = prepare->patch_count - prepare->rim_count;

	if (prepare->first == 0)
		prepare_header(prepare);
	for (index = prepare->first; index < end; index++) {
		if (index < rims)
			prepare_one(prepare, index);
		else
			prepare_rim(prepare, index);
	}
	if (end == prepare->patch_count) {
		prepare_padding(prepare->set, prepare->face_count);
		prepare_padding(prepare->set, blocks_for(prepare->face_count) * PHANTOM_BLOCK +
						      fan_count(prepare));
		prepare_rim_padding(prepare);
	}
}

static size_t section_set_bytes(u32 patch_count)
{
	/* faces, fans and rims each fill their last block up */
	size_t blocks = (size_t)blocks_for(patch_count) + 2;
	size_t bytes = sizeof(struct phantom_float_set) + blocks * sizeof(struct block) +
		       blocks * sizeof(union scratch) + SHELL_SCRATCH_BYTES;

	return (bytes + PHANTOM_FLOAT_SET_ALIGN - 1) & ~(size_t)(PHANTOM_FLOAT_SET_ALIGN - 1);
}

#endif /* PHANTOM_FLOAT_PREPARE_H */
