/* SPDX-License-Identifier: GPL-2.0-only */
/*
 * weigh.h - how much of a contact from outside each material has, for effects between materials.
 *
 * Once the shell is done, what it has found is gone through once more and added up by material: contact
 * without effects pays nothing for it. In pieces, like the shell's own (shell.h).
 */
#ifndef PHANTOM_FLOAT_WEIGH_H
#define PHANTOM_FLOAT_WEIGH_H

#include "../shell.h"
#include "table.h"

static inline u32 weigh_step(const struct phantom_float_job *job, const struct paper_step *at,
			     real weight[])
{
	const struct block *block = &job->set->blocks[at->block];
	u32 l;

	for (l = 0; l < PHANTOM_LANES; l++) {
		u32 lane = at->step * PHANTOM_LANES + l;

		if (at->magnitude[l] > 0)
			weight[block->material[lane]] +=
				mul(at->magnitude[l],
				    shell_fade(job, at->block * PHANTOM_BLOCK + lane,
					       lanes3_lane(at->normal, l), at->length[l]));
	}
	return (SHELL_COST_SUM + shell_fade_cost(job->set)) * PHANTOM_LANES;
}

static inline u32 weigh_root(const struct phantom_float_job *job, const struct shell_state *state,
			     const struct projected_root *root, real weight[])
{
	const struct block *block = &job->set->blocks[root->patch / PHANTOM_BLOCK];
	real magnitude = mul(root->magnitude, shell_root_fade(job, root));

	if (root->weight < REAL(1) && job->model.model != PHANTOM_MODEL_PAPER)
		magnitude = mul(mul(root->weight, state->share), magnitude);
	weight[block->material[root->patch % PHANTOM_BLOCK]] += magnitude;
	return SHELL_COST_SUM + shell_fade_cost(job->set);
}

/* One piece; what it may have cost. */
LANES_NOINLINE u32 weigh_piece(const struct phantom_float_job *job, struct shell_state *state)
{
	const struct phantom_float_set *set = job->set;
	bool paper = job->model.model == PHANTOM_MODEL_PAPER;
	real *weight = effect_block(set_effects(set), EFFECT_WEIGHTS);
	u32 end = state->count + state->fans, spent = 0, m;

	if (!state->cursor)
		for (m = 0; m < set->material_count; m++)
			weight[m] = 0;
	for (; state->cursor < end && spent < SHELL_PIECE; state->cursor++) {
		if (!paper)
			spent += weigh_root(job, state, &scratch_projected(set)[state->cursor],
					    weight);
		else if (state->cursor < state->count)
			spent += weigh_step(job, &scratch_paper(set)[state->cursor], weight);
		else
			spent += weigh_root(job, state,
					    &scratch_fans(set)[state->cursor - state->count],
					    weight);
	}
	if (state->cursor == end)
		shell_next(state, SHELL_WEIGHED);
	return spent;
}

/* True: there is more to weigh than this section may do. */
static inline bool weigh_more(const struct phantom_float_job *job, struct shell_state *state)
{
	u32 spent = state->spent;

	if (!(job->effects & EFFECTS_TOUCH) || job->set->material_count < 2)
		return false;
	while (state->phase != SHELL_WEIGHED) {
		if (spent >= SHELL_WORK)
			return true;
		spent += weigh_piece(job, state);
	}
	return false;
}

#endif /* PHANTOM_FLOAT_WEIGH_H */
