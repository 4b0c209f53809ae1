// SPDX-License-Identifier: GPL-2.0-only
/*
 * phantom_carry.c - the tick on a geometry that has just changed: the proxy is carried over.
 */
#include <phantom_platform.h>
#include "phantom_carry.h"

/* From one round of phantom_carry_search() to the next: 3 rounds for a surface that moved by 1 mm. */
#define PHANTOM_SEARCH_WIDER 8

/* What is carried: the job's contact in one frame of a set. */
struct phantom_carried {
	struct phantom_servo *servo;
	const struct phantom_slot *slot;
	const struct phantom_frame *frame;
	const struct phantom_touch *touch;
};

/*
 * The place lift_nm over the proxy, or over where the tip was, and aside_nm from there, relative to
 * the frame's origin. False: it does not fit.
 */
static bool phantom_carry_lift(const struct phantom_carried *carried, s64 lift_nm,
			       const s64 aside_nm[3], s32 relative_nm[3])
{
	const struct phantom_touch *touch = carried->touch;
	const s64 *base_nm = touch->inside ? touch->proxy_nm : touch->previous_nm;
	s64 place_nm[3];
	int axis;

	for (axis = 0; axis < 3; axis++)
		place_nm[axis] = base_nm[axis] + aside_nm[axis] +
				 lift_nm * touch->normal_q30[axis] / PHANTOM_Q30_ONE;
	return phantom_frame_relative(carried->frame, place_nm, relative_nm);
}

/* The tick of a tip that comes from the job's previous_nm, outside, if there is a path. */
static void phantom_carry_arrive(const struct phantom_carried *carried, bool path)
{
	struct phantom_float_job *job = &carried->servo->job;

	job->inside = 0;
	job->proxy_face = PHANTOM_PATCH_NONE;
	memcpy(job->proxy_nm, job->tip_nm, sizeof(job->proxy_nm));
	job->path_valid = path;
	phantom_servo_float_tick(carried->servo, carried->slot->ops);
}

/*
 * The proxy's place on a surface that lies beside the old proxy on all sides: a crease that has
 * moved up. Looked for on short paths through the old place, along the normal, shifted to each side;
 * from where one goes in the proxy walks down to the tip. False: there is none.
 */
static bool phantom_carry_search(const struct phantom_carried *carried, s64 reach_nm)
{
	struct phantom_float_job *job = &carried->servo->job;
	s32 tip_nm[3];
	int side;

	memcpy(tip_nm, job->tip_nm, sizeof(tip_nm));
	for (side = 0; side < 27; side++) {
		const s64 aside_nm[3] = {(side % 3 - 1) * reach_nm, (side / 3 % 3 - 1) * reach_nm,
					 (side / 9 - 1) * reach_nm};
		bool fits = phantom_carry_lift(carried, reach_nm, aside_nm, job->previous_nm) &&
			    phantom_carry_lift(carried, -reach_nm, aside_nm, job->tip_nm);

		if (fits)
			phantom_carry_arrive(carried, true);
		memcpy(job->tip_nm, tip_nm, sizeof(tip_nm));
		memcpy(job->previous_nm, tip_nm, sizeof(tip_nm));
		if (!fits || !job->inside)
			continue;
		phantom_servo_float_tick(carried->servo, carried->slot->ops);
		if (job->inside)
			return true;
	}
	return false;
}

void phantom_carry(struct phantom_servo *servo, const struct phantom_slot *slot, u32 frame)
{
	static const s64 straight_nm[3];
	const struct phantom_touch *touch = &servo->body[slot->body[frame]].touch;
	const struct phantom_carried carried = {servo, slot, &slot->frame[frame], touch};
	struct phantom_float_job *job = &servo->job;
	s64 lift_nm = touch->carry_nm;
	int attempt;

	job->ring.force_un =
		0; /* no way from here on is the tip's own: an impact does no work on it */
	for (attempt = 0; attempt < 2; attempt++) {
		bool path = phantom_carry_lift(&carried, lift_nm, straight_nm, job->previous_nm);

		phantom_carry_arrive(&carried, path);
		if (job->inside || job->contacts)
			return;
		lift_nm += slot->reach_nm;
	}
	if (!touch->inside)
		return;
	for (lift_nm = touch->carry_nm; lift_nm <= touch->moved_nm; lift_nm *= PHANTOM_SEARCH_WIDER)
		if (phantom_carry_search(&carried, lift_nm))
			return;
	phantom_carry_arrive(&carried, false);
}
