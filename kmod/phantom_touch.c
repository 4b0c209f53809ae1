// SPDX-License-Identifier: GPL-2.0-only
/*
 * phantom_touch.c - contact in every frame of the set in use.
 *
 *     for each frame       tip and what contact remembers <- that frame's, integers
 *     covered              does the set promise all that contact needs, in every frame?
 *     for each frame       float section (contact, proxy, effects) -> force, turned into the scene
 *     target               their sum
 *
 * LOSS OF COVERAGE. Contact is evaluated only where the promise of the set reaches. While it does
 * not, the state (inside, proxy, tip of the last evaluation) is kept for PHANTOM_MEMORY_NS: when
 * coverage comes back in time, the path from that last tip to the present one is searched for a
 * crossing of the surface, so a tip that went through meanwhile is found inside and not let fall.
 * After that the state is dropped, inside = 0: better no force than a full one at a depth nobody
 * felt coming. A fast tip may start its path outside the new set's coverage; a crossing that the
 * set does know is a crossing all the same.
 *
 * MOTION. State and path are the frame's: a resting tip that a surface comes over has a path through it.
 */
#include <phantom_platform.h>
#include "phantom_carry.h"
#include "phantom_context.h"
#include "phantom_touch.h"

/* Where the geometry changes, surfaces that ought to be the same may lie this far apart. */
#define PHANTOM_CARRY_NM 10000

void phantom_touch_forget(struct phantom_servo *servo)
{
	u32 b;

	phantom_context_run(servo);
	for (b = 0; b < PHANTOM_BODIES; b++)
		phantom_body_forget(&servo->body[b]);
}

void phantom_touch_settle(struct phantom_servo *servo)
{
	const struct phantom_slot *slot = servo->active;
	u32 f;

	for (f = 0; f < slot->frame_count; f++) {
		struct phantom_touch *touch = &servo->body[slot->body[f]].touch;

		if (!(slot->frame[f].effects & PHANTOM_EFFECT_FRICTION))
			touch->stuck = false;
		if (!(slot->frame[f].effects & PHANTOM_EFFECT_IMPACT))
			memset(&touch->ring, 0, sizeof(touch->ring));
	}
}

/* What is kept too long without an evaluation. */
static void phantom_touch_age(struct phantom_servo *servo, u64 now_ns)
{
	u32 b;

	for (b = 0; b < PHANTOM_BODIES; b++) {
		struct phantom_touch *touch = &servo->body[b].touch;

		if (touch->valid && now_ns - touch->evaluated_ns > PHANTOM_MEMORY_NS)
			phantom_body_forget(&servo->body[b]);
	}
}

/* ---- one frame ----------------------------------------------------------- */

/*
 * What follows is written once for all frames and compiled twice, hence always inline: for the scene's,
 * f = 0, which most sets have alone, and for those that move.
 */
static struct phantom_body *phantom_touch_body(struct phantom_servo *servo,
					       const struct phantom_slot *slot, u32 f)
{
	return &servo->body[f ? slot->body[f] : 0];
}

/* Fills in the job's positions. False: the set does not cover what contact needs there. */
static __always_inline bool phantom_touch_place(struct phantom_servo *servo,
						const struct phantom_slot *slot, u32 f,
						struct phantom_pass *pass)
{
	const struct phantom_frame *frame = &slot->frame[f];
	const struct phantom_body *body = phantom_touch_body(servo, slot, f);
	const struct phantom_touch *touch = &body->touch;
	struct phantom_float_job *job = &servo->job;

	if ((f && !body->near) ||
	    !phantom_frame_relative(frame, f ? body->tip_nm : pass->tip_nm, job->tip_nm))
		return false;
	job->path_valid =
		touch->valid && phantom_frame_relative(frame, touch->previous_nm, job->previous_nm);
	if (!job->path_valid)
		memcpy(job->previous_nm, job->tip_nm, sizeof(job->previous_nm));
	job->inside = touch->inside;
	job->proxy_face = touch->proxy_face;
	if (touch->inside)
		return phantom_frame_relative(frame, touch->proxy_nm, job->proxy_nm) &&
		       phantom_frame_covers(frame, job->proxy_nm, 0) &&
		       phantom_frame_covers(frame, job->tip_nm, 0);
	memcpy(job->proxy_nm, job->tip_nm, sizeof(job->proxy_nm));
	if (!phantom_frame_covers(frame, job->tip_nm, slot->reach_nm))
		return false;
	if (!servo->warned &&
	    !phantom_frame_covers(frame, job->tip_nm,
				  slot->reach_nm + (frame->radius_nm - slot->reach_nm) / 2))
		pass->low |= 1U << f;
	return true;
}

/*
 * What only effects ask for: the velocity against the surface, and what they remember, which goes into the
 * job in the frame's coordinates and comes back out of it. `mover`: NULL in the scene's frame.
 */
static void phantom_touch_give_effects(struct phantom_servo *servo,
				       const struct phantom_frame *frame,
				       const struct phantom_body *mover,
				       const struct phantom_touch *touch,
				       const struct phantom_pass *pass)
{
	const s64 *velocity_nm_s = servo->safety.velocity_nm_s;
	struct phantom_float_job *job = &servo->job;
	int axis;

	for (axis = 0; axis < 3 && !mover; axis++)
		job->velocity_nm_s[axis] = clamp_t(s64, velocity_nm_s[axis], -S32_MAX, S32_MAX);
	if (mover)
		phantom_body_velocity(mover, pass->tip_nm, velocity_nm_s, job->velocity_nm_s);
	if (!(frame->effects & ~PHANTOM_EFFECT_DAMPING))
		return;
	job->period_ns = pass->period_ns;
	job->ring = touch->ring;
	job->stick.coefficient_q24 = touch->coefficient_q24;
	job->stick.held = touch->stuck &&
			  phantom_frame_relative(frame, touch->anchor_nm, job->stick.anchor_nm);
}

static void phantom_touch_take_stick(const struct phantom_servo *servo,
				     const struct phantom_frame *frame, struct phantom_touch *touch)
{
	const struct phantom_stick *stick = &servo->job.stick_next;
	int axis;

	touch->stuck = stick->held;
	touch->coefficient_q24 = stick->coefficient_q24;
	for (axis = 0; axis < 3; axis++)
		touch->anchor_nm[axis] = frame->origin_nm[axis] + stick->anchor_nm[axis];
}

static u64 phantom_touch_square(const s32 force_un[3])
{
	return (u64)((s64)force_un[0] * force_un[0]) + (u64)((s64)force_un[1] * force_un[1]) +
	       (u64)((s64)force_un[2] * force_un[2]);
}

/* The job's force is a moving frame's: into the scene, and on top of what is there. */
static void phantom_touch_add(struct phantom_servo *servo, u32 b, struct phantom_pass *pass)
{
	const struct phantom_float_job *job = &servo->job;
	const struct phantom_pose *pose = &servo->body[b].pose;
	s64 force_un[3] = {job->force_un[0], job->force_un[1], job->force_un[2]};
	s64 normal[3] = {job->normal_q30[0], job->normal_q30[1], job->normal_q30[2]};
	u64 square = phantom_touch_square(job->force_un);
	int axis;

	phantom_pose_turn_out(pose, force_un, force_un);
	for (axis = 0; axis < 3; axis++) {
		s64 sum = pass->target_un[axis] + force_un[axis];

		pass->target_un[axis] = clamp_t(s64, sum, -S32_MAX, S32_MAX);
		if (pass->target_un[axis] != sum) {
			pass->flags |= PHANTOM_TICK_SATURATED;
			servo->stats.next.saturated++;
		}
	}
	pass->contacts += job->contacts;
	if (square <= pass->most)
		return;
	pass->most = square;
	pass->leader = b;
	phantom_pose_turn_out(pose, normal, normal);
	for (axis = 0; axis < 3; axis++)
		pass->normal_q30[axis] = normal[axis];
}

/* Runs the job; what comes out goes to the body and into the pass. False: it was no number. */
static __always_inline bool phantom_touch_evaluate(struct phantom_servo *servo,
						   const struct phantom_slot *slot, u32 f,
						   struct phantom_pass *pass)
{
	const struct phantom_frame *frame = &slot->frame[f];
	struct phantom_body *body = phantom_touch_body(servo, slot, f);
	struct phantom_touch *touch = &body->touch;
	struct phantom_float_job *job = &servo->job;
	int axis;

	if (!frame->patch_count) {
		touch->inside = false;
		job->inside = 0;
		if (!(frame->effects & PHANTOM_EFFECTS_SPACE))
			return true;
	}
	job->set = frame->floats;
	job->effects = frame->effects;
	memcpy(job->centre_nm, frame->centre_nm, sizeof(job->centre_nm));
	job->radius_nm = frame->radius_nm;
	if (frame->effects)
		phantom_touch_give_effects(servo, frame, f ? body : NULL, touch, pass);
	if (touch->carry_nm && touch->valid)
		phantom_carry(servo, slot, f);
	else
		phantom_servo_float_tick(servo, slot->ops);

	touch->carry_nm = 0;
	touch->moved_nm = 0;
	touch->inside = job->inside;
	touch->proxy_face = job->inside ? job->proxy_face : PHANTOM_PATCH_NONE;
	for (axis = 0; axis < 3; axis++)
		touch->proxy_nm[axis] = frame->origin_nm[axis] + job->proxy_nm[axis];
	if (frame->effects & PHANTOM_EFFECT_FRICTION)
		phantom_touch_take_stick(servo, frame, touch);
	/* of two evaluations in a tick the second counts */
	if ((frame->effects & PHANTOM_EFFECT_IMPACT) && slot != pass->outgoing)
		touch->ring = job->ring_next;
	memcpy(touch->normal_q30, job->normal_q30, sizeof(touch->normal_q30));
	if (job->saturated) {
		pass->flags |= PHANTOM_TICK_SATURATED;
		servo->stats.next.saturated += job->saturated;
	}
	if (f) {
		phantom_touch_add(servo, slot->body[f], pass);
	} else {
		memcpy(pass->target_un, job->force_un, sizeof(pass->target_un));
		memcpy(pass->normal_q30, job->normal_q30, sizeof(pass->normal_q30));
		pass->contacts = job->contacts;
	}
	return !job->invalid;
}

/* ---- all of them --------------------------------------------------------- */

static bool phantom_touch_cover_movers(struct phantom_servo *servo, const struct phantom_slot *slot,
				       struct phantom_pass *pass)
{
	bool covered = true;
	u32 f;

	for (f = 1; f < slot->frame_count; f++)
		covered &= phantom_touch_place(servo, slot, f, pass);
	return covered;
}

static __always_inline bool phantom_touch_covered(struct phantom_servo *servo,
						  const struct phantom_slot *slot,
						  struct phantom_pass *pass)
{
	bool covered = phantom_touch_place(servo, slot, 0, pass);

	if (slot->frame_count > 1)
		covered &= phantom_touch_cover_movers(servo, slot, pass);
	return covered;
}

static void phantom_touch_remember(struct phantom_touch *touch, const s64 tip_nm[3], u64 now_ns)
{
	memcpy(touch->previous_nm, tip_nm, sizeof(touch->previous_nm));
	touch->evaluated_ns = now_ns;
	touch->valid = true;
}

/* On top of what the scene's frame gave; there is one job for all, so each is placed once more. */
static bool phantom_touch_feel_movers(struct phantom_servo *servo, const struct phantom_slot *slot,
				      struct phantom_pass *pass)
{
	bool valid = true;
	u32 f;

	pass->most = phantom_touch_square(pass->target_un);
	for (f = 1; f < slot->frame_count; f++) {
		struct phantom_body *body = phantom_touch_body(servo, slot, f);

		phantom_touch_place(servo, slot, f, pass);
		valid &= phantom_touch_evaluate(servo, slot, f, pass);
		phantom_touch_remember(&body->touch, body->tip_nm, pass->now_ns);
	}
	return valid;
}

/* Evaluates contact where it is covered, and remembers where that was. */
static __always_inline void phantom_touch_feel(struct phantom_servo *servo,
					       const struct phantom_slot *slot,
					       struct phantom_pass *pass)
{
	bool valid;

	if (slot->frame_count > 1)
		phantom_touch_place(servo, slot, 0, pass);
	valid = phantom_touch_evaluate(servo, slot, 0, pass);
	phantom_touch_remember(&servo->body[0].touch, pass->tip_nm, pass->now_ns);
	if (slot->frame_count > 1)
		valid &= phantom_touch_feel_movers(servo, slot, pass);
	if (valid)
		return;
	memset(pass->target_un, 0, sizeof(pass->target_un));
	phantom_touch_forget(servo);
	phantom_safety_raise(&servo->safety, PHANTOM_FAULT_NUMERIC);
}

/* A last tick on the set that goes, nothing of which is sent. */
static void phantom_touch_depart(struct phantom_servo *servo, struct phantom_pass *pass)
{
	struct phantom_slot *slot = servo->active, *outgoing = pass->outgoing;
	/* along the normal it is somewhat farther than to the nearest point */
	u64 apart = 2 * ((u64)outgoing->level_error_nm + slot->level_error_nm) + PHANTOM_CARRY_NM;
	s32 unsent_un[3];
	u32 f;

	phantom_bodies_move(servo, outgoing, pass);
	if (servo->reached && phantom_touch_covered(servo, outgoing, pass)) {
		phantom_touch_feel(servo, outgoing, pass);
		phantom_fade_blend(&servo->fade, pass->target_un, pass->now_ns, unsent_un);
		memset(pass->target_un, 0, sizeof(pass->target_un));
		memset(pass->normal_q30, 0, sizeof(pass->normal_q30));
		pass->contacts = 0;
		pass->most = 0;
		pass->leader = 0;
	}
	pass->low = 0;
	for (f = 0; f < slot->frame_count; f++) {
		struct phantom_touch *touch = &servo->body[slot->body[f]].touch;

		if (!(pass->reshaped & 1U << f))
			continue;
		touch->carry_nm =
			max_t(u32, touch->carry_nm, min_t(u64, apart, PHANTOM_COVERAGE_MAX_NM));
		touch->moved_nm = max_t(u32, touch->moved_nm, touch->carry_nm);
		if (outgoing->level == slot->level)
			touch->moved_nm = max_t(u32, touch->moved_nm, slot->reach_nm);
	}
	if (!pass->blend_ns)
		pass->blend_ns = servo->crossfade_ns;
	phantom_set_release(outgoing);
}

/* Of the body that pushes most; if that is outside, of another that is not. */
static const struct phantom_body *phantom_touch_leader(const struct phantom_servo *servo,
						       const struct phantom_pass *pass)
{
	const struct phantom_slot *slot = servo->active;
	u32 f, b = pass->leader;

	for (f = 0; f < slot->frame_count && !servo->body[b].touch.inside; f++)
		b = slot->body[f];
	return &servo->body[b];
}

/* Inside and proxy, in the scene. */
static void phantom_touch_show(const struct phantom_servo *servo, struct phantom_pass *pass)
{
	const struct phantom_body *body = &servo->body[0];

	if (servo->active && servo->active->frame_count > 1)
		body = phantom_touch_leader(servo, pass);
	if (!body->touch.inside) {
		memcpy(pass->proxy_nm, pass->tip_nm, sizeof(pass->proxy_nm));
		return;
	}
	pass->flags |= PHANTOM_TICK_INSIDE;
	if (body != &servo->body[0])
		phantom_pose_leave(&body->pose, body->touch.proxy_nm, pass->proxy_nm);
	else
		memcpy(pass->proxy_nm, body->touch.proxy_nm, sizeof(pass->proxy_nm));
}

void phantom_touch_contact(struct phantom_servo *servo, struct phantom_pass *pass)
{
	struct phantom_slot *slot = servo->active;
	bool off = servo->job.model.model == PHANTOM_MODEL_OFF;
	bool reached;

	if (pass->outgoing)
		phantom_touch_depart(servo, pass);
	if (slot && slot->frame_count > 1)
		phantom_bodies_move(servo, slot, pass);
	if (!slot || !phantom_touch_covered(servo, slot, pass))
		pass->flags |= PHANTOM_TICK_UNCOVERED;
	if (slot && pass->now_ns - servo->stats.next.set_time_ns > servo->stale_ns)
		pass->flags |= PHANTOM_TICK_STALE;
	reached = !(pass->flags & (PHANTOM_TICK_UNCOVERED | PHANTOM_TICK_STALE)) && !off &&
		  !servo->safety.overloaded;
	if (reached)
		phantom_touch_feel(servo, slot, pass);
	else
		phantom_touch_age(servo, pass->now_ns);
	if (reached != servo->reached)
		pass->blend_ns = PHANTOM_FADE_NS;
	servo->reached = reached;
	phantom_touch_show(servo, pass);
}

bool phantom_touch_running_out(const struct phantom_servo *servo, const struct phantom_pass *pass)
{
	const struct phantom_slot *slot = servo->active;
	u32 f;

	for (f = 0; pass->low >> f; f++)
		if ((pass->low >> f & 1) && !servo->body[slot->body[f]].touch.inside)
			return true;
	return false;
}
