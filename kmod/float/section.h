/* SPDX-License-Identifier: GPL-2.0-only */
/*
 * section.h - the entry points of a float section: the table that a unit (contact_*.c) exports.
 */
#ifndef PHANTOM_FLOAT_SECTION_H
#define PHANTOM_FLOAT_SECTION_H

#ifdef PHANTOM_REAL_FIXED
#define PHANTOM_SECTION_INTEGER true
#else
#define PHANTOM_SECTION_INTEGER false
#endif

#include "prepare.h"
#include "shell.h"
#include "crossing.h"
#include "penetration.h"
#include "constrained.h"
#include "effects/apply.h"
#include "effects/weigh.h"

/* What a tick's first piece may cost beside the shell: the path against every patch, twice. */
#define SECTION_COST_PATH 800U /* of a block */

#define UN_PER_N 1000000

/*
 * Effects that the tick is to run. With PHANTOM_SECTION_BARE there are none at compile time: what a bench
 * holds a tick of contact alone against.
 */
static inline u32 section_effects(const struct phantom_float_job *job)
{
#ifdef PHANTOM_SECTION_BARE
	(void)job;
	return 0;
#else
	return job->effects;
#endif
}

/* Settles whether the tip is inside, and the force there. True: outside, the shell is to follow. */
static inline bool section_settle(struct phantom_float_job *job, struct contact_force *out)
{
	u32 patch;

	if (job->model.proxy == PHANTOM_PROXY_OFF) {
		penetration_leave(job);
		return true;
	}
	if (job->model.proxy == PHANTOM_PROXY_CONSTRAINED)
		return !constrained_tick(job, out);
	if (job->inside) {
		bool settled = penetration_from_inside(job);

		if (!settled || job->inside) {
			patch = settled ? penetration_find_patch(job) : penetration_follow(job);
			if (patch != PHANTOM_PATCH_NONE)
				penetration_force(job, patch, penetration_normal(job, patch), out);
			return !job->inside;
		}
		return true;
	}
	if (!penetration_from_outside(job))
		return true;
	patch = penetration_find_patch(job);
	if (patch != PHANTOM_PATCH_NONE)
		penetration_force(job, patch, penetration_normal(job, patch), out);
	return false;
}

/* After the shell: under its face although no crossing was found, the tip is on the surface. */
static inline void section_sink(struct phantom_float_job *job, const struct contact_force *out)
{
	u32 axis;

	if (job->model.proxy == PHANTOM_PROXY_OFF || !job->path_valid ||
	    !(out->deepest < -rounding_mm(job->set) / 2))
		return;
	job->inside = 1;
	for (axis = 0; axis < 3; axis++)
		job->proxy_nm[axis] = job->tip_nm[axis];
	job->proxy_face = job->set->blocks[out->deepest_patch / PHANTOM_BLOCK]
				  .face[out->deepest_patch % PHANTOM_BLOCK];
}

/* Contact, in pieces. True: it is not done. */
LANES_NOINLINE bool section_contact(struct phantom_float_job *job, struct shell_state *state)
{
	u32 spent = 0;

	if (!job->more) {
		job->saturated = 0;
		job->invalid = 0;
		shell_begin(job->set, state);
		spent = SECTION_COST_PATH * job->set->block_count;
		if (job->model.model == PHANTOM_MODEL_OFF || !section_settle(job, &state->out)) {
			/* what follows leaves it alone */
			shell_next(state, SHELL_WEIGHED);
			return false;
		}
	}
	while (state->phase < SHELL_DONE) {
		job->more = spent >= SHELL_WORK;
		if (job->more)
			return true;
		spent += shell_piece(job, state);
	}
	job->more = 0;
	state->spent = spent;
	section_sink(job, &state->out);
	return false;
}

/* The way back to integers. */
static inline void section_finish(struct phantom_float_job *job, struct contact_force *contact)
{
	if (!real_finite(contact->force.x) || !real_finite(contact->force.y) ||
	    !real_finite(contact->force.z) || !real_finite(contact->normal.x) ||
	    !real_finite(contact->normal.y) || !real_finite(contact->normal.z)) {
		*contact = (struct contact_force){.deepest = 0};
		job->invalid = 1;
	}
	job->force_un[0] = real_to_integer(contact->force.x, UN_PER_N, &job->saturated);
	job->force_un[1] = real_to_integer(contact->force.y, UN_PER_N, &job->saturated);
	job->force_un[2] = real_to_integer(contact->force.z, UN_PER_N, &job->saturated);
	job->normal_q30[0] = real_to_integer(contact->normal.x, PHANTOM_Q30_ONE, &job->saturated);
	job->normal_q30[1] = real_to_integer(contact->normal.y, PHANTOM_Q30_ONE, &job->saturated);
	job->normal_q30[2] = real_to_integer(contact->normal.z, PHANTOM_Q30_ONE, &job->saturated);
	job->contacts = contact->contacts;
	job->folded = contact->folded;
}

/*
 * The end of a tick with effects. Apart from the other, and nothing is left to do after it: contact alone
 * pays for one test of the mask.
 */
LANES_NOINLINE bool section_feel(struct phantom_float_job *job)
{
	struct shell_state *state = shell_state(job->set);

	job->more = weigh_more(job, state);
	if (job->more)
		return true;
	effects_apply(job, &state->out);
	section_finish(job, &state->out);
	return false;
}

static bool section_tick(struct phantom_float_job *job)
{
	struct shell_state *state = shell_state(job->set);

	if (section_contact(job, state))
		return true;
	if (__builtin_expect(section_effects(job) != 0, 0))
		return section_feel(job);
	section_finish(job, &state->out);
	return false;
}

extern const struct phantom_float_ops PHANTOM_SECTION_OPS;
const struct phantom_float_ops PHANTOM_SECTION_OPS = {
	.name = PHANTOM_SECTION_NAME,
	.isa = PHANTOM_SECTION_ISA,
	.integer = PHANTOM_SECTION_INTEGER,
	.set_bytes = section_set_bytes,
	.effect_bytes = section_effect_bytes,
	.prepare = section_prepare,
	.tick = section_tick,
};

#endif /* PHANTOM_FLOAT_SECTION_H */
