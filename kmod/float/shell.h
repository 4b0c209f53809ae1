/* SPDX-License-Identifier: GPL-2.0-only */
/*
 * shell.h - contact from outside, of either model, in pieces.
 *
 * A float section keeps preemption off, so it must be short whatever the set holds: 512 patches all in
 * contact take some 0.1 M instructions with `projected` and millions with `paper`, whose overlap
 * test grows with the square. So the work is done in pieces of bounded length; a section does
 * pieces until it has spent SHELL_WORK, and what it has found so far waits in the set's scratch for
 * the next section. Pieces are always done in the same order: where sections end changes no bit.
 *
 *   projected   BLOCKS  roots over faces and fans      paper   BLOCKS   contacts with faces, over fans
 *               SUM                                            FANS     overlapped by faces
 *                                                              OVERLAP  among faces
 *                                                              SUM
 *
 * Costs are in instructions of the narrowest unit, measured with everything in contact and rounded up.
 */
#ifndef PHANTOM_FLOAT_SHELL_H
#define PHANTOM_FLOAT_SHELL_H

#include "paper.h"
#include "overlap.h"
#include "combine.h"
#include "projected.h"
#include "paper_fans.h"
#include "rim.h"

#define SHELL_WORK 30000U /* after which a section ends */
#define SHELL_PIECE 4000U /* a piece of small steps goes on for that long */

#define SHELL_COST_BLOCK 500U /* of sixteen patches out of reach */
#define SHELL_COST_ROOT 300U /* beside that, for each found */
#define SHELL_COST_SPLIT 3000U /* and for each patch whose interval is split */
#define SHELL_COST_SOFT 2000U /* of a root next to a wall: the window, clipped four times */
#define SHELL_COST_SUM 30U /* of a root or contact */
#define SHELL_COST_RIMS 250U /* of sixteen rims, for a root or contact of an open surface */
#define SHELL_COST_PLANES 40U /* of a step, once */
#define SHELL_COST_CROSSED 80U /* a contact against a step */

/* What comes next. */
#define SHELL_BLOCKS 0U
#define SHELL_FANS 1U
#define SHELL_OVERLAP 2U
#define SHELL_SUM 3U
#define SHELL_DONE 4U
#define SHELL_WEIGHED 5U /* effects/weigh.h */

/* Between two sections of a tick; in the set's scratch. */
struct shell_state {
	struct contact_force out;
	struct columns columns; /* paper: faces */
	struct real3 sum; /* projected: roots; paper: fans */
	real most, forces, damping;
	real shared; /* projected: what the parts of roots next to walls add up to */
	real share; /* and what makes a whole number of it */
	u32 phase;
	u32 cursor; /* in whatever the phase goes through */
	u32 count; /* projected: roots; paper: steps with a contact */
	u32 fans; /* paper: contacts over fans found, then left */
	u32 fans_looked_at;
	u32 spent; /* of the section in which the shell was done */
};

_Static_assert(sizeof(struct shell_state) <= SHELL_SCRATCH_BYTES, "grow SHELL_SCRATCH_BYTES");

static inline struct shell_state *shell_state(const struct phantom_float_set *set)
{
	return (struct shell_state *)((u8 *)scratch_paper(set) +
				      (u64)(set->block_count + set->fan_block_count) *
					      sizeof(union scratch));
}

static inline void shell_next(struct shell_state *state, u32 phase)
{
	state->phase = phase;
	state->cursor = 0;
}

static inline void shell_begin(const struct phantom_float_set *set, struct shell_state *state)
{
	*state = (struct shell_state){.phase = SHELL_BLOCKS};
	if (!(set->block_count + set->fan_block_count))
		shell_next(state, SHELL_DONE);
}

/* Material of a lane that is counted through all blocks. */
static inline const struct float_material *shell_material(const struct phantom_float_set *set,
							  u32 patch)
{
	const struct block *block = &set->blocks[patch / PHANTOM_BLOCK];

	return &set->materials[block->material[patch % PHANTOM_BLOCK]];
}

static inline void shell_finish(struct shell_state *state, struct real3 force)
{
	struct contact_force *out = &state->out;

	out->force = force;
	if (state->forces > 0)
		out->damping = divide(state->damping, state->forces);
	contact_direction(out);
	shell_next(state, SHELL_DONE);
}

/* What to multiply a contact by whose foot is that way from the tip. */
static inline real shell_fade(const struct phantom_float_job *job, u32 patch, struct real3 normal,
			      real height)
{
	return rim_fade(job->set, patch, job->tip_nm, real3_scale(normal, -height));
}

static inline real shell_root_fade(const struct phantom_float_job *job,
				   const struct projected_root *root)
{
	return shell_fade(job, root->patch, root->normal, root->height);
}

static inline u32 shell_fade_cost(const struct phantom_float_set *set)
{
	return SHELL_COST_RIMS * set->rim_block_count;
}

/* ---- projected ------------------------------------------------------------ */

static inline u32 shell_projected_blocks(const struct phantom_float_job *job,
					 struct shell_state *state)
{
	const struct phantom_float_set *set = job->set;
	struct projected_root *roots = scratch_projected(set);
	struct nm_point tip = nm_point(job->tip_nm);
	u32 steps = job->model.newton_steps, blocks = set->block_count + set->fan_block_count;
	u32 spent = 0;

	if (steps > PHANTOM_NEWTON_STEPS_MAX)
		steps = PHANTOM_NEWTON_STEPS_MAX;
	while (state->cursor < blocks && spent < SHELL_PIECE) {
		u32 first = state->count, splits = 0;

		state->count +=
			projected_block(set, state->cursor++, &tip, steps, &roots[first], &splits);
		spent += SHELL_COST_BLOCK + SHELL_COST_SPLIT * splits;
		for (; first < state->count; first++) {
			spent += SHELL_COST_ROOT;
			if (roots[first].weight < REAL(1)) {
				spent += SHELL_COST_SOFT;
				state->shared += mul(roots[first].sign, roots[first].weight);
			}
		}
	}
	if (state->cursor == blocks) {
		state->out.contacts = state->count;
		state->share = window_share(state->shared);
		shell_next(state, state->count ? SHELL_SUM : SHELL_DONE);
	}
	return spent;
}

/* S and F from the list of roots, in its order. */
static inline u32 shell_projected_sum(const struct phantom_float_job *job,
				      struct shell_state *state)
{
	const struct phantom_float_set *set = job->set;
	struct contact_force *out = &state->out;
	u32 spent = 0;
	real length;

	for (; state->cursor < state->count && spent < SHELL_PIECE; state->cursor++) {
		const struct projected_root *root = &scratch_projected(set)[state->cursor];
		const struct float_material *material = shell_material(set, root->patch);
		real magnitude = root->magnitude, fade = REAL(1);

		if (root->weight < REAL(1))
			magnitude = mul(mul(root->weight, state->share), magnitude);
		if (set->rim_block_count) {
			fade = shell_root_fade(job, root);
			magnitude = mul(magnitude, fade);
		}
		state->sum = real3_add(
			state->sum,
			real3_scale_fitting(root->normal, root->sign < 0 ? -magnitude : magnitude));
		state->most = real_max(state->most, material->most);
		state->forces += magnitude;
		if (material->damping > 0)
			state->damping += mul(mul(magnitude, material->damping), fade);
		if (root->sign < 0) {
			out->folded++;
		} else if (root->height < out->deepest) {
			out->deepest = root->height;
			out->deepest_patch = root->patch;
		}
		spent += SHELL_COST_SUM + shell_fade_cost(set);
	}
	if (state->cursor == state->count) {
		length = real3_length(state->sum);
		shell_finish(state, length > state->most
					    ? real3_scale(state->sum, divide(state->most, length))
					    : state->sum);
	}
	return spent;
}

/* ---- paper ---------------------------------------------------------------- */

/* As in projected_block(), each stage is done for all steps before the next one. */
static inline u32 shell_paper_faces(const struct phantom_float_set *set, u32 index,
				    const struct nm_point *tip, struct shell_state *state)
{
	const struct block *block = &set->blocks[index];
	const real rounding = rounding_mm(set);
	struct paper_step *steps = &scratch_paper(set)[state->count];
	u32 before = state->out.contacts, walled = 0, count = 0, i;
	struct near_steps near;

	paper_near(block, tip, rounding, &near);
	for (; near.steps; near.steps &= near.steps - 1) {
		struct paper_step *at = &steps[walled];

		at->block = index;
		at->step = (u32)__builtin_ctz(near.steps);
		walled += paper_walls(block, at->step, tip, near.height[at->step],
				      near.mask[at->step], rounding, at);
	}
	for (i = 0; i < walled; i++) {
		if (!paper_contact(block, steps[i].step, &steps[i]))
			continue;
		state->out.contacts += mask_count(steps[i].contact);
		if (count < i)
			steps[count] = steps[i];
		count++;
	}
	state->count += count;
	return SHELL_COST_BLOCK + SHELL_COST_ROOT * (state->out.contacts - before);
}

static inline u32 shell_paper_blocks(const struct phantom_float_job *job, struct shell_state *state)
{
	const struct phantom_float_set *set = job->set;
	struct nm_point tip = nm_point(job->tip_nm);
	u32 blocks = set->block_count + set->fan_block_count, spent = 0;

	while (state->cursor < blocks && spent < SHELL_PIECE) {
		u32 block = state->cursor++, found, splits = 0;

		if (block < set->block_count) {
			spent += shell_paper_faces(set, block, &tip, state);
			continue;
		}
		found = projected_block(set, block, &tip, PHANTOM_NEWTON_STEPS_MAX,
					&scratch_fans(set)[state->fans], &splits);
		state->fans += found;
		spent += SHELL_COST_BLOCK + SHELL_COST_ROOT * found + SHELL_COST_SPLIT * splits;
	}
	if (state->cursor == blocks)
		shell_next(state, state->count || state->fans ? SHELL_FANS : SHELL_DONE);
	return spent;
}

/* Contacts over fans that have not folded and that no face in contact overlaps move to the front. */
static inline u32 shell_fans(const struct phantom_float_job *job, struct shell_state *state)
{
	const struct phantom_float_set *set = job->set;
	struct projected_root *roots = scratch_fans(set);
	struct nm_point tip = nm_point(job->tip_nm);
	u32 spent = 0;

	while (state->fans_looked_at < state->fans && spent < SHELL_PIECE) {
		const struct projected_root *root = &roots[state->fans_looked_at++];

		spent += SHELL_COST_SUM + SHELL_COST_CROSSED * state->count;
		/* the first may need the planes of all */
		if (state->fans_looked_at == 1)
			spent += SHELL_COST_PLANES * state->count;
		if (root->sign > 0 &&
		    !paper_fan_crossed(set, scratch_paper(set), state->count, &tip, root))
			roots[state->cursor++] = *root;
	}
	if (state->fans_looked_at == state->fans) {
		state->fans = state->cursor;
		shell_next(state, state->out.contacts > 1 ? SHELL_OVERLAP : SHELL_SUM);
	}
	return spent;
}

/*
 * Clears the magnitude of every face's contact that is overlapped. Which contacts cross is asked of
 * all of them, dropped or not. The cursor counts lanes of steps.
 */
static inline u32 shell_overlap(const struct phantom_float_job *job, struct shell_state *state)
{
	const struct phantom_float_set *set = job->set;
	struct paper_step *steps = scratch_paper(set);
	struct nm_point tip = nm_point(job->tip_nm);
	const u32 end = state->count * PHANTOM_LANES, cost = SHELL_COST_CROSSED * state->count;
	/* the first contacts need the planes of all; a piece goes on by one contact at least */
	const u32 planes = state->cursor ? 0 : SHELL_COST_PLANES * state->count;
	u32 cursor = state->cursor, spent = 0;

	for (; cursor < end && spent < SHELL_PIECE; cursor++) {
		struct paper_step *at = &steps[cursor / PHANTOM_LANES];
		u32 lane = cursor % PHANTOM_LANES;

		if (!at->contact[lane])
			continue;
		spent += cost;
		if (overlap_dropped(set, steps, state->count, at, lane, &tip)) {
			at->magnitude[lane] = 0;
			state->out.contacts--;
		}
	}
	state->cursor = cursor;
	if (cursor == end)
		shell_next(state, SHELL_SUM);
	return spent + planes;
}

/* Returns what its rims cost. */
static inline u32 shell_paper_add(const struct phantom_float_job *job, const struct paper_step *at,
				  struct shell_state *state)
{
	const struct phantom_float_set *set = job->set;
	struct contact_force *out = &state->out;
	lanes magnitude = at->magnitude;
	u32 spent = 0, l;

	for (l = 0; l < PHANTOM_LANES; l++) {
		u32 patch = at->block * PHANTOM_BLOCK + at->step * PHANTOM_LANES + l;
		real fade = REAL(1), damping;

		if (!(magnitude[l] > 0))
			continue;
		if (at->height[l] < out->deepest) {
			out->deepest = at->height[l];
			out->deepest_patch = patch;
		}
		if (set->rim_block_count) {
			fade = shell_fade(job, patch, lanes3_lane(at->normal, l), at->length[l]);
			magnitude[l] = mul(magnitude[l], fade);
			spent += shell_fade_cost(set);
		}
		state->forces += magnitude[l];
		damping = shell_material(set, patch)->damping;
		if (damping > 0)
			state->damping += mul(mul(magnitude[l], damping), fade);
	}
	columns_add(&state->columns, at->step, at->normal, magnitude);
	return spent;
}

/* Faces, then fans: the cursor goes through both. */
static inline u32 shell_paper_sum(const struct phantom_float_job *job, struct shell_state *state)
{
	const struct phantom_float_set *set = job->set;
	u32 end = state->count + state->fans, spent = 0;

	for (; state->cursor < end && spent < SHELL_PIECE; state->cursor++) {
		const struct projected_root *root;
		real fade, magnitude;

		spent += SHELL_COST_SUM * PHANTOM_LANES;
		if (state->cursor < state->count) {
			spent += shell_paper_add(job, &scratch_paper(set)[state->cursor], state);
			continue;
		}
		root = &scratch_fans(set)[state->cursor - state->count];
		fade = shell_root_fade(job, root);
		magnitude = mul(root->magnitude, fade);
		state->sum = real3_add(state->sum, real3_scale(root->normal, magnitude));
		state->most = real_max(state->most, magnitude);
		state->forces += magnitude;
		state->damping +=
			mul(mul(magnitude, shell_material(set, root->patch)->damping), fade);
		spent += shell_fade_cost(set);
	}
	if (state->cursor == end) {
		state->out.contacts += state->fans;
		shell_finish(state,
			     combine_paper(real3_add(columns_total(&state->columns), state->sum),
					   real_max(columns_most(&state->columns), state->most),
					   job->model.combine));
	}
	return spent;
}

/* ---- pieces --------------------------------------------------------------- */

/* One piece; what it may have cost. Not when the phase is SHELL_DONE. */
static inline u32 shell_piece(const struct phantom_float_job *job, struct shell_state *state)
{
	bool paper = job->model.model == PHANTOM_MODEL_PAPER;

	switch (state->phase) {
	case SHELL_BLOCKS:
		return paper ? shell_paper_blocks(job, state) : shell_projected_blocks(job, state);
	case SHELL_FANS:
		return shell_fans(job, state);
	case SHELL_OVERLAP:
		return shell_overlap(job, state);
	default:
		return paper ? shell_paper_sum(job, state) : shell_projected_sum(job, state);
	}
}

#endif /* PHANTOM_FLOAT_SHELL_H */
