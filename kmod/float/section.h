/* SPDX-License-Identifier: GPL-2.0-only */
/*
 * section.h - the entry points of a float section: the table that a unit (contact_*.c) exports.
 */
#ifndef PHANTOM_FLOAT_SECTION_H
#define PHANTOM_FLOAT_SECTION_H

#include "prepare.h"
#include "paper.h"
#include "overlap.h"
#include "combine.h"
#include "projected.h"
#include "paper_fans.h"
#include "crossing.h"
#include "penetration.h"
#include "constrained.h"
#include "effects/damping.h"

/* Model `paper`: evaluate, remove overlap, combine. */
static inline void contact_paper(const struct phantom_float_job *job, struct contact_force *out)
{
	const struct phantom_float_set *set = job->set;
	struct paper_step *steps = scratch_paper(set);
	struct nm_point tip = nm_point(job->tip_nm);
	struct columns columns = {0};
	real rounding = rounding_mm(set), forces = 0, damping = 0, most;
	struct real3 total;
	u32 count = 0, fans = 0, block, step, i, l;

	for (block = 0; block < set->block_count; block++) {
		for (step = 0; step < PHANTOM_STEPS; step++) {
			struct paper_step *at = &steps[count];

			if (!paper_evaluate(&set->blocks[block], step, &tip, rounding, at))
				continue;
			at->block = block;
			at->step = step;
			out->contacts += mask_count(at->contact);
			count++;
		}
	}
	if (set->fan_block_count)
		fans = paper_fans(set, steps, count, &tip);
	if (!count && !fans)
		return;
	out->contacts = overlap_remove(set, steps, count, out->contacts, &tip, job->tip_nm) + fans;
	for (i = 0; i < count; i++) {
		struct paper_step *at = &steps[i];
		const struct block *in = &set->blocks[at->block];

		columns_add(&columns, at->step, at->normal, at->magnitude);
		for (l = 0; l < PHANTOM_LANES; l++) {
			u32 lane = at->step * PHANTOM_LANES + l;

			if (!(at->magnitude[l] > 0))
				continue;
			if (at->height[l] < out->deepest) {
				out->deepest = at->height[l];
				out->deepest_patch = at->block * PHANTOM_BLOCK + lane;
			}
			forces += at->magnitude[l];
			damping += at->magnitude[l] * set->materials[in->material[lane]].damping;
		}
	}
	total = columns_total(&columns);
	most = columns_most(&columns);
	for (i = 0; i < fans; i++) {
		const struct projected_root *at = &scratch_fans(set)[i];
		const struct block *in = &set->blocks[at->patch / PHANTOM_BLOCK];
		real magnitude = at->magnitude;

		total = real3_add(total, real3_scale(at->normal, magnitude));
		most = real_max(most, magnitude);
		forces += magnitude;
		damping +=
			magnitude * set->materials[in->material[at->patch % PHANTOM_BLOCK]].damping;
	}
	out->force = combine_paper(total, most, job->model.combine);
	if (forces > 0)
		out->damping = damping / forces;
	contact_direction(out);
}

static inline void contact_shell(const struct phantom_float_job *job, struct contact_force *out)
{
	if (job->model.model == PHANTOM_MODEL_PAPER)
		contact_paper(job, out);
	else if (job->model.model == PHANTOM_MODEL_PROJECTED)
		contact_projected(job, out);
}

/* Contact outside; the state is outside. */
static inline void section_outside(struct phantom_float_job *job, struct contact_force *out)
{
	u32 axis;

	contact_shell(job, out);
	if (job->model.proxy == PHANTOM_PROXY_OFF || !job->path_valid ||
	    !(out->deepest < -rounding_mm(job->set) / 2))
		return;
	/* under its face although no crossing was found: the tip is on the surface, V is there */
	job->inside = 1;
	for (axis = 0; axis < 3; axis++)
		job->proxy_nm[axis] = job->tip_nm[axis];
	job->proxy_face = job->set->blocks[out->deepest_patch / PHANTOM_BLOCK]
				  .face[out->deepest_patch % PHANTOM_BLOCK];
}

static inline void section_contact(struct phantom_float_job *job, struct contact_force *out)
{
	u32 patch;

	if (job->model.proxy == PHANTOM_PROXY_OFF)
		penetration_leave(job);
	if (job->model.proxy == PHANTOM_PROXY_CONSTRAINED) {
		if (!constrained_tick(job, out))
			section_outside(job, out);
		return;
	}
	if (job->inside) {
		bool settled = penetration_from_inside(job);

		if (!settled || job->inside) {
			patch = settled ? penetration_find_patch(job) : penetration_follow(job);
			if (patch != PHANTOM_PATCH_NONE)
				penetration_force(job, patch, penetration_normal(job, patch), out);
			if (job->inside)
				return;
		}
		section_outside(job, out);
		return;
	}
	if (job->model.proxy != PHANTOM_PROXY_OFF && penetration_from_outside(job)) {
		patch = penetration_find_patch(job);
		if (patch != PHANTOM_PATCH_NONE)
			penetration_force(job, patch, penetration_normal(job, patch), out);
		return;
	}
	section_outside(job, out);
}

/* False for an infinity or what is no number. */
LANES_INLINE bool real_finite(real a)
{
	return a - a == 0;
}

/* value * scale, rounded to nearest, saturated and counted. */
static inline s32 section_integer(real value, real scale, u32 *saturated)
{
	real scaled = value * scale;

	if (scaled >= (real)2147483648.0) {
		(*saturated)++;
		return 0x7fffffff;
	}
	if (scaled <= (real)-2147483648.0) {
		(*saturated)++;
		return -0x7fffffff - 1;
	}
	return (s32)nm_saturate((s64)(scaled + (scaled < 0 ? (real)-0.5 : (real)0.5)));
}

static void section_tick(struct phantom_float_job *job)
{
	struct contact_force contact = {.deepest = 0};
	const real q30 = (real)PHANTOM_Q30_ONE;

	job->contacts = 0;
	job->folded = 0;
	job->saturated = 0;
	job->invalid = 0;
	if (job->model.model != PHANTOM_MODEL_OFF)
		section_contact(job, &contact);
	if ((job->effects & PHANTOM_EFFECT_DAMPING) && contact.damping > 0)
		contact.force = damping_apply(contact.force, contact.normal, contact.damping,
					      job->velocity_nm_s);
	if (!real_finite(contact.force.x) || !real_finite(contact.force.y) ||
	    !real_finite(contact.force.z) || !real_finite(contact.normal.x) ||
	    !real_finite(contact.normal.y) || !real_finite(contact.normal.z)) {
		contact = (struct contact_force){.deepest = 0};
		job->invalid = 1;
	}
	job->force_un[0] = section_integer(contact.force.x, (real)1e6, &job->saturated);
	job->force_un[1] = section_integer(contact.force.y, (real)1e6, &job->saturated);
	job->force_un[2] = section_integer(contact.force.z, (real)1e6, &job->saturated);
	job->normal_q30[0] = section_integer(contact.normal.x, q30, &job->saturated);
	job->normal_q30[1] = section_integer(contact.normal.y, q30, &job->saturated);
	job->normal_q30[2] = section_integer(contact.normal.z, q30, &job->saturated);
	job->contacts = contact.contacts;
	job->folded = contact.folded;
}

extern const struct phantom_float_ops PHANTOM_SECTION_OPS;
const struct phantom_float_ops PHANTOM_SECTION_OPS = {
	.name = PHANTOM_SECTION_NAME,
	.isa = PHANTOM_SECTION_ISA,
	.set_bytes = section_set_bytes,
	.prepare = section_prepare,
	.tick = section_tick,
};

#endif /* PHANTOM_FLOAT_SECTION_H */
