// SPDX-License-Identifier: GPL-2.0-only
/*
 * phantom_body.c - which frame is whose, and where it is.
 */
#include <phantom_platform.h>
#include "phantom_body.h"
#include "phantom_servo.h"

/* An offset takes one tick at least; with sets that come more often than ticks it is that one. */
#define PHANTOM_OFFSET_MIN_NS 1000000

/* Differences of velocities beyond this count as this: the float sections' s32 ends before. */
#define PHANTOM_SPEED_MAX_NM_S 4000000000LL

void phantom_body_forget(struct phantom_body *body)
{
	memset(&body->touch, 0, sizeof(body->touch));
	body->touch.proxy_face = PHANTOM_PATCH_NONE;
}

/* The slot's frame of that object, or 0. */
static u32 phantom_body_frame(const struct phantom_slot *slot, u32 object)
{
	u32 f;

	for (f = 1; slot && f < slot->frame_count; f++)
		if (slot->frame[f].object == object)
			return f;
	return 0;
}

static u32 phantom_body_find(const struct phantom_servo *servo, u32 object)
{
	u32 b;

	for (b = 1; b < PHANTOM_BODIES; b++)
		if (servo->body[b].known && servo->body[b].object == object)
			return b;
	return 0;
}

/* One that neither set has, and nobody knows or that was touched longest ago. */
static u32 phantom_body_pick(const struct phantom_servo *servo, const struct phantom_slot *before,
			     const struct phantom_slot *slot)
{
	u32 b, oldest = 0;

	for (b = 1; b < PHANTOM_BODIES; b++) {
		const struct phantom_body *body = &servo->body[b];

		if (!body->known)
			return b;
		if (phantom_body_frame(before, body->object) ||
		    phantom_body_frame(slot, body->object))
			continue;
		if (!oldest || body->touch.evaluated_ns < servo->body[oldest].touch.evaluated_ns)
			oldest = b;
	}
	return oldest;
}

/* The body goes on from where it is by another motion. False: it jumps. */
static bool phantom_body_turn_to(struct phantom_servo *servo, struct phantom_body *body,
				 const struct phantom_motion *motion, u64 now_ns)
{
	u64 length_ns = clamp_t(u64, now_ns - servo->stats.next.set_time_ns, PHANTOM_OFFSET_MIN_NS,
				PHANTOM_FADE_NS);
	struct phantom_pose is, shall;

	phantom_motion_at(&body->motion, &body->offset, now_ns, &is);
	phantom_motion_at(motion, NULL, now_ns, &shall);
	body->motion = *motion;
	return phantom_motion_offset(&is, &shall, servo->safety.tip_nm, now_ns, length_ns,
				     &body->offset);
}

void phantom_bodies_swap(struct phantom_servo *servo, const struct phantom_slot *before,
			 struct phantom_slot *slot, struct phantom_pass *pass)
{
	bool changed = before && before->frame_count != slot->frame_count;
	u32 f;

	slot->body[0] = 0;
	for (f = 1; f < slot->frame_count; f++) {
		const struct phantom_frame *frame = &slot->frame[f];
		u32 was = phantom_body_frame(before, frame->object);
		u32 b = phantom_body_find(servo, frame->object);
		struct phantom_body *body;

		if (!b)
			b = phantom_body_pick(servo, before, slot);
		body = &servo->body[b];
		slot->body[f] = b;
		if (was) {
			if (before->frame[was].patch_count && !frame->patch_count)
				changed = true;
			if (phantom_body_turn_to(servo, body, &frame->motion, pass->now_ns))
				continue;
			phantom_body_forget(body);
			changed = true;
			continue;
		}
		changed = true;
		if (!body->known || body->object != frame->object ||
		    pass->now_ns - body->touch.evaluated_ns > PHANTOM_MEMORY_NS)
			phantom_body_forget(body);
		body->known = true;
		body->object = frame->object;
		body->motion = frame->motion;
		memset(&body->offset, 0, sizeof(body->offset));
	}
	if (before && changed)
		pass->blend_ns = PHANTOM_FADE_NS;
}

void phantom_bodies_move(struct phantom_servo *servo, const struct phantom_slot *slot,
			 const struct phantom_pass *pass)
{
	u32 f;

	for (f = 1; f < slot->frame_count; f++) {
		struct phantom_body *body = &servo->body[slot->body[f]];

		phantom_motion_at(&body->motion, &body->offset, pass->now_ns, &body->pose);
		body->near = phantom_pose_enter(&body->pose, pass->tip_nm, body->tip_nm);
	}
}

void phantom_body_velocity(const struct phantom_body *body, const s64 tip_nm[3],
			   const s64 velocity_nm_s[3], s32 relative_nm_s[3])
{
	s64 against[3];
	int axis;

	phantom_motion_velocity(&body->motion, &body->pose, tip_nm, against);
	for (axis = 0; axis < 3; axis++)
		against[axis] = clamp_t(s64, velocity_nm_s[axis] - against[axis],
					-PHANTOM_SPEED_MAX_NM_S, PHANTOM_SPEED_MAX_NM_S);
	phantom_pose_turn_in(&body->pose, against, against);
	for (axis = 0; axis < 3; axis++)
		relative_nm_s[axis] = clamp_t(s64, against[axis], -S32_MAX, S32_MAX);
}
