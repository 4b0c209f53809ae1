// SPDX-License-Identifier: GPL-2.0-only
/*
 * phantom_servo.c - the tick, and the only place that opens float sections.
 *
 * ONE TICK, at an absolute deadline
 *
 *     take the waiting set, the model, a wish to stop or to clear a fault
 *     tip      <- device                      an error is a fault
 *     velocity <- low pass of tip             too fast is a fault
 *     covered  <- integers: does the set promise all that contact needs here?
 *     target   <- covered and fresh: float section (contact, proxy, effects); else 0
 *     target   <- blend, where covered, fresh, model or geometry changed
 *     force    <- safety: clamp, ramp, slew; any fault: 0
 *     device   <- force                       an error is a fault
 *     record, status page, wake-ups
 *
 * LOSS OF COVERAGE. Contact is evaluated only where the promise of the set reaches. While it does
 * not, the state (inside, proxy, tip of the last evaluation) is kept for PHANTOM_MEMORY_NS: when
 * coverage comes back in time, the path from that last tip to the present one is searched for a
 * crossing of the surface, so a tip that went through meanwhile is found inside and not let fall.
 * After that the state is dropped, inside = 0: better no force than a full one at a depth nobody
 * felt coming. A fast tip may start its path outside the new set's coverage; a crossing that the
 * set does know is a crossing all the same.
 *
 * CONTEXT RULES stand in phantom_servo.h. Here: everything is the servo thread's but prepare(),
 * which is a submitter's, and what says "run state". Float sections run with preemption off: no
 * sleeping lock, no allocation, no copy from user, no print between begin and end, and nothing but
 * float/ is called there.
 */
#include <phantom_platform.h>
#include "phantom_carry.h"
#include "phantom_context.h"
#include "phantom_servo.h"
#include <phantom_trace.h>

/* Readers of records are woken at most this often: at 10 kHz ten records cost one wake-up. */
#define PHANTOM_WAKE_NS 1000000

/* Where the geometry changes, surfaces that ought to be the same may lie this far apart. */
#define PHANTOM_CARRY_NM 10000

static u64 phantom_servo_now(const struct phantom_servo *servo)
{
	return servo->clock->ops->now_ns(servo->clock);
}

/* ---- float sections ------------------------------------------------------ */

/* Sections of the tick. Servo thread. Between the two: one call into float/. */
static u64 phantom_servo_open_section(struct phantom_servo *servo)
{
	u64 begin;

	phantom_context_servo(servo);
	begin = phantom_servo_now(servo);
	kernel_fpu_begin();
	phantom_context_section();
	return begin;
}

static void phantom_servo_close_section(struct phantom_servo *servo, u64 begin)
{
	struct phantom_stats *stats = &servo->stats;
	u64 length;

	kernel_fpu_end();
	length = phantom_servo_now(servo) - begin;
	phantom_stats_count(&stats->page->section, length);
	stats->next.sections++;
	stats->next.section_max_ns =
		max_t(u64, stats->next.section_max_ns, min_t(u64, length, U32_MAX));
}

void phantom_servo_float_tick(struct phantom_servo *servo, const struct phantom_float_ops *ops)
{
	bool more;

	servo->job.more = 0;
	do {
		u64 begin = ops->integer ? 0 : phantom_servo_open_section(servo);

		more = ops->tick(&servo->job);
		if (!ops->integer)
			phantom_servo_close_section(servo, begin);
	} while (more);
}

/* A device with joints: where its encoders say that the tip is. */
static void phantom_servo_float_pose(struct phantom_servo *servo, struct phantom_linkage *linkage,
				     s64 tip_nm[3])
{
	u64 begin = phantom_servo_open_section(servo);
	int axis;

	linkage->ops->pose(linkage);
	phantom_servo_close_section(servo, begin);
	for (axis = 0; axis < 3; axis++)
		tip_nm[axis] = linkage->tip_nm[axis];
}

/* A device with joints: the motor currents that give this force there. */
static void phantom_servo_float_drive(struct phantom_servo *servo, struct phantom_linkage *linkage,
				      const s32 force_un[3])
{
	u64 begin;

	memcpy(linkage->force_un, force_un, sizeof(linkage->force_un));
	begin = phantom_servo_open_section(servo);
	linkage->ops->drive(linkage);
	phantom_servo_close_section(servo, begin);
}

void phantom_servo_prepare(struct phantom_servo *servo, struct phantom_slot *slot)
{
	const struct phantom_set_copy *copy = &servo->sets.copy;
	struct phantom_float_prepare prepare = {
		.set = slot->floats,
		.patches = copy->patches,
		.materials = copy->materials,
		.patch_count = slot->patch_count,
		.face_count = copy->face_count,
		.rim_count = copy->rim_count,
		.material_count = copy->header.material_count,
		.effects = copy->header.effect_bytes ? &copy->effects : NULL,
	};

	phantom_context_submitter(&servo->sets);
	memcpy(prepare.origin_nm, slot->origin_nm, sizeof(prepare.origin_nm));
	do {
		u64 begin = phantom_servo_now(servo);
		u64 length;

		prepare.count =
			min_t(u32, slot->patch_count - prepare.first, PHANTOM_FLOAT_PREPARE_MAX);
		if (!slot->ops->integer) {
			kernel_fpu_begin();
			phantom_context_section();
		}
		slot->ops->prepare(&prepare);
		if (!slot->ops->integer)
			kernel_fpu_end();
		length = min_t(u64, phantom_servo_now(servo) - begin, U32_MAX);
		if (length > READ_ONCE(servo->prepare_max_ns))
			WRITE_ONCE(servo->prepare_max_ns, (u32)length);
		prepare.first += prepare.count;
	} while (prepare.first < slot->patch_count);
	slot->refused = prepare.refused;
}

/* ---- contact ------------------------------------------------------------- */

void phantom_servo_forget_touch(struct phantom_servo *servo)
{
	phantom_context_run(servo);
	memset(&servo->touch, 0, sizeof(servo->touch));
	servo->touch.proxy_face = PHANTOM_PATCH_NONE;
}

static void phantom_servo_take_set(struct phantom_servo *servo, struct phantom_pass *pass)
{
	struct phantom_slot *before = servo->active;
	struct phantom_slot *slot = phantom_set_take(&servo->sets);
	struct phantom_status *next = &servo->stats.next;

	if (!slot)
		return;
	if (before) {
		/* a scene that became empty here is no mere swap */
		if (before->patch_count && !slot->patch_count)
			pass->blend_ns = PHANTOM_FADE_NS;
		/* another feel */
		if (before->effect_print != slot->effect_print)
			pass->blend_ns = PHANTOM_FADE_NS;
		if (phantom_set_reshaped(before, slot))
			pass->outgoing = before; /* phantom_servo_depart() releases it */
		else
			phantom_set_release(before);
	}
	servo->active = slot;
	servo->warned = false;
	if (!(slot->effects & PHANTOM_EFFECT_FRICTION))
		servo->touch.stuck = false;
	if (!(slot->effects & PHANTOM_EFFECT_IMPACT))
		memset(&servo->touch.ring, 0, sizeof(servo->touch.ring));
	next->set_time_ns = pass->now_ns;
	next->isa = slot->ops->isa;
	next->set_id = slot->id;
	next->set_patches = slot->patch_count;
	next->set_level = slot->level;
	next->set_level_error_nm = slot->level_error_nm;
	next->sets++;
	next->refused += slot->refused;
	trace_phantom_set(servo->unit, slot->id, slot->patch_count, slot->refused, slot->radius_nm);
}

static void phantom_servo_take_model(struct phantom_servo *servo, struct phantom_pass *pass)
{
	u64 model = READ_ONCE(servo->model);

	if (model == servo->active_model)
		return;
	servo->active_model = model;
	phantom_model_unpack(model, &servo->job.model);
	servo->stats.next.model = servo->job.model;
	pass->blend_ns = PHANTOM_FADE_NS;
	if (servo->job.model.model == PHANTOM_MODEL_OFF ||
	    servo->job.model.proxy == PHANTOM_PROXY_OFF)
		phantom_servo_forget_touch(servo);
}

/* Fills in the job's positions. False: the set in use does not cover what contact needs. */
static bool phantom_servo_place(struct phantom_servo *servo, const struct phantom_pass *pass)
{
	const struct phantom_slot *slot = servo->active;
	struct phantom_float_job *job = &servo->job;
	struct phantom_touch *touch = &servo->touch;

	if (!slot || !phantom_set_relative(slot, pass->tip_nm, job->tip_nm))
		return false;
	job->path_valid =
		touch->valid && phantom_set_relative(slot, touch->previous_nm, job->previous_nm);
	if (!job->path_valid)
		memcpy(job->previous_nm, job->tip_nm, sizeof(job->previous_nm));
	job->inside = touch->inside;
	job->proxy_face = touch->proxy_face;
	if (!touch->inside) {
		memcpy(job->proxy_nm, job->tip_nm, sizeof(job->proxy_nm));
		return phantom_set_covers(slot, job->tip_nm, slot->reach_nm);
	}
	return phantom_set_relative(slot, touch->proxy_nm, job->proxy_nm) &&
	       phantom_set_covers(slot, job->proxy_nm, 0) &&
	       phantom_set_covers(slot, job->tip_nm, 0);
}

/* What effects remember goes into the job in the set's coordinates, and comes back out of it. */
static void phantom_servo_give_stick(struct phantom_servo *servo, const struct phantom_pass *pass)
{
	struct phantom_float_job *job = &servo->job;
	struct phantom_touch *touch = &servo->touch;

	job->period_ns = pass->period_ns;
	job->ring = touch->ring;
	job->stick.coefficient_q24 = touch->coefficient_q24;
	job->stick.held = touch->stuck && phantom_set_relative(servo->active, touch->anchor_nm,
							       job->stick.anchor_nm);
}

static void phantom_servo_take_stick(struct phantom_servo *servo)
{
	const struct phantom_stick *stick = &servo->job.stick_next;
	struct phantom_touch *touch = &servo->touch;
	int axis;

	touch->stuck = stick->held;
	touch->coefficient_q24 = stick->coefficient_q24;
	for (axis = 0; axis < 3; axis++)
		touch->anchor_nm[axis] = servo->active->origin_nm[axis] + stick->anchor_nm[axis];
}

static void phantom_servo_evaluate(struct phantom_servo *servo, struct phantom_pass *pass)
{
	const struct phantom_slot *slot = servo->active;
	struct phantom_float_job *job = &servo->job;
	struct phantom_touch *touch = &servo->touch;
	int axis;

	if (!slot->patch_count) {
		touch->inside = false;
		job->inside = 0;
		if (!(slot->effects & PHANTOM_EFFECTS_SPACE))
			return;
	}
	job->set = slot->floats;
	job->effects = slot->effects;
	memcpy(job->centre_nm, slot->centre_nm, sizeof(job->centre_nm));
	job->radius_nm = slot->radius_nm;
	for (axis = 0; axis < 3; axis++)
		job->velocity_nm_s[axis] =
			clamp_t(s64, servo->safety.velocity_nm_s[axis], -S32_MAX, S32_MAX);
	if (slot->effects & ~PHANTOM_EFFECT_DAMPING)
		phantom_servo_give_stick(servo, pass);
	if (touch->carry_nm && touch->valid)
		phantom_carry(servo);
	else
		phantom_servo_float_tick(servo, slot->ops);

	touch->carry_nm = 0;
	touch->moved_nm = 0;
	touch->inside = job->inside;
	touch->proxy_face = job->inside ? job->proxy_face : PHANTOM_PATCH_NONE;
	for (axis = 0; axis < 3; axis++)
		touch->proxy_nm[axis] = slot->origin_nm[axis] + job->proxy_nm[axis];
	if (slot->effects & PHANTOM_EFFECT_FRICTION)
		phantom_servo_take_stick(servo);
	if (slot->effects & PHANTOM_EFFECT_IMPACT)
		touch->ring = job->ring_next;
	memcpy(touch->normal_q30, job->normal_q30, sizeof(touch->normal_q30));
	memcpy(pass->target_un, job->force_un, sizeof(pass->target_un));
	memcpy(pass->normal_q30, job->normal_q30, sizeof(pass->normal_q30));
	pass->contacts = job->contacts;
	if (job->saturated) {
		pass->flags |= PHANTOM_TICK_SATURATED;
		servo->stats.next.saturated += job->saturated;
	}
	if (job->invalid) {
		memset(pass->target_un, 0, sizeof(pass->target_un));
		phantom_servo_forget_touch(servo);
		phantom_safety_raise(&servo->safety, PHANTOM_FAULT_NUMERIC);
	}
}

/* Evaluates contact where it is covered, and remembers where that was. */
static void phantom_servo_feel(struct phantom_servo *servo, struct phantom_pass *pass)
{
	struct phantom_touch *touch = &servo->touch;

	phantom_servo_evaluate(servo, pass);
	memcpy(touch->previous_nm, pass->tip_nm, sizeof(touch->previous_nm));
	touch->evaluated_ns = pass->now_ns;
	touch->valid = true;
}

/* A last tick on the set that goes, nothing of which is sent. */
static void phantom_servo_depart(struct phantom_servo *servo, struct phantom_pass *pass)
{
	struct phantom_touch *touch = &servo->touch;
	struct phantom_slot *slot = servo->active, *outgoing = pass->outgoing;
	/* along the normal it is somewhat farther than to the nearest point */
	u64 apart = 2 * ((u64)outgoing->level_error_nm + slot->level_error_nm) + PHANTOM_CARRY_NM;
	s32 unsent_un[3];

	servo->active = outgoing;
	if (servo->reached && phantom_servo_place(servo, pass)) {
		phantom_servo_feel(servo, pass);
		phantom_fade_blend(&servo->fade, pass->target_un, pass->now_ns, unsent_un);
		memset(pass->target_un, 0, sizeof(pass->target_un));
		memset(pass->normal_q30, 0, sizeof(pass->normal_q30));
		pass->contacts = 0;
	}
	servo->active = slot;
	touch->carry_nm = max_t(u32, touch->carry_nm, min_t(u64, apart, PHANTOM_COVERAGE_MAX_NM));
	touch->moved_nm = max_t(u32, touch->moved_nm, touch->carry_nm);
	if (outgoing->level == slot->level)
		touch->moved_nm = max_t(u32, touch->moved_nm, slot->reach_nm);
	if (!pass->blend_ns)
		pass->blend_ns = servo->crossfade_ns;
	phantom_set_release(outgoing);
}

/* The force that contact asks for at the pass's tip, or zero where nothing is promised. */
static void phantom_servo_contact(struct phantom_servo *servo, struct phantom_pass *pass)
{
	struct phantom_touch *touch = &servo->touch;
	bool off = servo->job.model.model == PHANTOM_MODEL_OFF;
	bool reached;

	if (pass->outgoing)
		phantom_servo_depart(servo, pass);
	if (!phantom_servo_place(servo, pass))
		pass->flags |= PHANTOM_TICK_UNCOVERED;
	if (servo->active && pass->now_ns - servo->stats.next.set_time_ns > servo->stale_ns)
		pass->flags |= PHANTOM_TICK_STALE;
	reached = !(pass->flags & (PHANTOM_TICK_UNCOVERED | PHANTOM_TICK_STALE)) && !off &&
		  !servo->safety.overloaded;
	if (reached)
		phantom_servo_feel(servo, pass);
	else if (touch->valid && pass->now_ns - touch->evaluated_ns > PHANTOM_MEMORY_NS)
		phantom_servo_forget_touch(servo);
	if (reached != servo->reached)
		pass->blend_ns = PHANTOM_FADE_NS;
	servo->reached = reached;
	if (touch->inside)
		pass->flags |= PHANTOM_TICK_INSIDE;
	memcpy(pass->proxy_nm, touch->inside ? touch->proxy_nm : pass->tip_nm,
	       sizeof(pass->proxy_nm));
}

/* ---- the rest of the tick ------------------------------------------------ */

static u32 phantom_servo_device_fault(int error)
{
	return error == -ENODEV ? PHANTOM_FAULT_UNPLUGGED : PHANTOM_FAULT_DEVICE;
}

static int phantom_servo_read(struct phantom_servo *servo, s64 tip_nm[3])
{
	struct phantom_device *device = servo->device;
	int error = READ_ONCE(servo->unplugged) ? -ENODEV : device->ops->read(device, tip_nm);

	if (!error && device->linkage)
		phantom_servo_float_pose(servo, device->linkage, tip_nm);
	return error;
}

static int phantom_servo_write(struct phantom_servo *servo, const s32 force_un[3])
{
	struct phantom_device *device = servo->device;

	if (device->linkage)
		phantom_servo_float_drive(servo, device->linkage, force_un);
	return device->ops->write(device, force_un);
}

static void phantom_servo_sense(struct phantom_servo *servo, struct phantom_pass *pass)
{
	struct phantom_safety *safety = &servo->safety;
	s64 tip_nm[3];
	int error = phantom_servo_read(servo, tip_nm);
	int axis;

	if (error) {
		phantom_safety_raise(safety, phantom_servo_device_fault(error));
		pass->flags |= PHANTOM_TICK_UNREAD;
		memcpy(pass->tip_nm, safety->tip_nm, sizeof(pass->tip_nm));
		return;
	}
	for (axis = 0; axis < 3; axis++)
		pass->tip_nm[axis] = clamp_t(s64, tip_nm[axis], -PHANTOM_POSITION_MAX_NM,
					     PHANTOM_POSITION_MAX_NM);
	phantom_safety_track(safety, pass->tip_nm, pass->elapsed_ns, pass->period_ns);
}

static void phantom_servo_act(struct phantom_servo *servo, struct phantom_pass *pass)
{
	struct phantom_safety *safety = &servo->safety;
	u32 wish;
	int error;

	if (pass->blend_ns &&
	    phantom_fade_begin(&servo->fade, pass->target_un, pass->now_ns, pass->blend_ns))
		servo->stats.next.fades++;
	if (phantom_fade_blend(&servo->fade, pass->target_un, pass->now_ns, pass->target_un))
		pass->flags |= PHANTOM_TICK_FADING;
	if (xchg(&servo->clear_wanted, 0)) {
		phantom_safety_clear(safety);
		pass->flags |= PHANTOM_TICK_CLEARED;
	}
	wish = xchg(&servo->stop_wanted, 0);
	if (wish) {
		phantom_safety_stop(safety, wish == PHANTOM_WISH_ABANDON);
		pass->flags |= wish == PHANTOM_WISH_ABANDON ? PHANTOM_TICK_ABANDONED
							    : PHANTOM_TICK_STOPPED;
	}
	pass->flags |= phantom_safety_apply(safety, pass->target_un, pass->elapsed_ns,
					    pass->period_ns, pass->force_un);
	error = phantom_servo_write(servo, pass->force_un);
	if (error) {
		phantom_safety_raise(safety, phantom_servo_device_fault(error));
		pass->flags |= PHANTOM_TICK_UNSENT;
		memset(safety->force_un, 0, sizeof(safety->force_un));
		memset(pass->force_un, 0, sizeof(pass->force_un));
	}
	if (pass->flags & PHANTOM_TICK_CLAMPED)
		servo->stats.next.clamped++;
	if (safety->faults)
		phantom_fade_reset(&servo->fade);
}

static void phantom_servo_record(struct phantom_servo *servo, const struct phantom_pass *pass,
				 u64 latency_ns, u64 duration_ns)
{
	const struct phantom_status *next = &servo->stats.next;
	struct phantom_tick record = {
		.tick = next->tick,
		.time_ns = pass->now_ns,
		.set_id = next->set_id,
		.contacts = pass->contacts,
		.flags = pass->flags,
		.faults = servo->safety.faults,
		.latency_ns = min_t(u64, latency_ns, U32_MAX),
		.duration_ns = min_t(u64, duration_ns, U32_MAX),
		.rate_hz = next->rate_hz,
		.model = PHANTOM_TICK_MODEL(&servo->job.model),
	};

	memcpy(record.tip_nm, pass->tip_nm, sizeof(record.tip_nm));
	memcpy(record.proxy_nm, pass->proxy_nm, sizeof(record.proxy_nm));
	memcpy(record.force_un, pass->force_un, sizeof(record.force_un));
	phantom_stats_record(&servo->stats, &record);
	trace_phantom_tick(servo->unit, &record);
}

static void phantom_servo_publish(struct phantom_servo *servo, const struct phantom_pass *pass)
{
	struct phantom_stats *stats = &servo->stats;
	struct phantom_status *next = &stats->next;
	u64 duration = phantom_servo_now(servo) - pass->now_ns;
	u64 latency = pass->now_ns - pass->due_ns;
	int axis;

	next->time_ns = pass->now_ns;
	next->busy_ns += duration;
	servo->busy_ns = duration;
	memcpy(next->tip_nm, pass->tip_nm, sizeof(next->tip_nm));
	memcpy(next->proxy_nm, pass->proxy_nm, sizeof(next->proxy_nm));
	memcpy(next->normal_q30, pass->normal_q30, sizeof(next->normal_q30));
	memcpy(next->force_un, pass->force_un, sizeof(next->force_un));
	for (axis = 0; axis < 3; axis++)
		next->velocity_nm_s[axis] =
			clamp_t(s64, servo->safety.velocity_nm_s[axis], -S32_MAX, S32_MAX);
	next->contacts = pass->contacts;
	next->flags = pass->flags;
	next->state = servo->state;
	next->faults = servo->safety.faults;
	next->section_max_ns = max_t(u32, next->section_max_ns, READ_ONCE(servo->prepare_max_ns));
	phantom_stats_count(&stats->page->latency, latency);
	phantom_stats_count(&stats->page->duration, duration);
	phantom_stats_publish(stats);
	phantom_servo_record(servo, pass, latency, duration);
}

/* True when POLLPRI has something new to tell: phantom_abi.h, POLL. */
static bool phantom_servo_needs_set(struct phantom_servo *servo, const struct phantom_pass *pass)
{
	const struct phantom_slot *slot = servo->active;
	u32 half;

	if (pass->flags & (PHANTOM_TICK_UNCOVERED | PHANTOM_TICK_STALE)) {
		if (!servo->warned || pass->now_ns - servo->reminded_ns >= PHANTOM_REMIND_NS) {
			servo->warned = true;
			servo->reminded_ns = pass->now_ns;
			return true;
		}
		return false;
	}
	if (servo->warned || servo->touch.inside)
		return false;
	half = slot->reach_nm + (slot->radius_nm - slot->reach_nm) / 2;
	if (phantom_set_covers(slot, servo->job.tip_nm, half))
		return false;
	servo->warned = true;
	servo->reminded_ns = pass->now_ns;
	return true;
}

/* State, events and wake-ups. */
static void phantom_servo_tell(struct phantom_servo *servo, const struct phantom_pass *pass)
{
	u32 faults = servo->safety.faults;
	u32 state = faults ? PHANTOM_STATE_FAULT : PHANTOM_STATE_RUNNING;
	bool event = phantom_servo_needs_set(servo, pass);

	if (faults & ~servo->faults) {
		event = true;
		trace_phantom_fault(servo->unit, faults);
	}
	if (state != servo->state)
		trace_phantom_state(servo->unit, servo->state, state);
	WRITE_ONCE(servo->causes, servo->safety.causes);
	WRITE_ONCE(servo->faults, faults);
	WRITE_ONCE(servo->state, state);
	if (event)
		WRITE_ONCE(servo->events, servo->events + 1);
	if (!event && pass->now_ns - servo->woken_ns < PHANTOM_WAKE_NS)
		return;
	servo->woken_ns = pass->now_ns;
	if (wq_has_sleeper(&servo->wait))
		wake_up_interruptible(&servo->wait);
}

static void phantom_servo_tick(struct phantom_servo *servo, u64 now_ns, u64 period_ns)
{
	struct phantom_pass pass = {
		.now_ns = now_ns,
		.due_ns = servo->next_ns,
		.elapsed_ns = now_ns - servo->last_ns,
		.period_ns = period_ns,
	};

	servo->last_ns = now_ns;
	phantom_servo_take_set(servo, &pass);
	phantom_servo_take_model(servo, &pass);
	phantom_safety_watch(&servo->safety, now_ns - servo->next_ns, pass.elapsed_ns,
			     servo->busy_ns, period_ns);
	phantom_servo_sense(servo, &pass);
	phantom_servo_contact(servo, &pass);
	phantom_servo_act(servo, &pass);
	phantom_servo_tell(servo, &pass);
	phantom_servo_publish(servo, &pass);
}

bool phantom_servo_step(struct phantom_servo *servo)
{
	struct phantom_status *next = &servo->stats.next;
	u32 rate_hz = READ_ONCE(servo->rate_hz);
	u64 period = NSEC_PER_SEC / rate_hz;
	u64 now = phantom_servo_now(servo);
	u64 skipped;

	phantom_context_servo(servo);
	next->rate_hz = rate_hz;
	next->tick++;
	phantom_servo_tick(servo, now, period);

	/* Whole periods that went by unserved are skipped and counted, never run in a burst. */
	servo->next_ns += period;
	now = phantom_servo_now(servo);
	if (now >= servo->next_ns + period) {
		skipped = (now - servo->next_ns) / period;
		servo->next_ns += skipped * period;
		next->tick += skipped;
		next->missed += skipped;
	}
	if ((servo->safety.causes & PHANTOM_FAULT_UNPLUGGED) && READ_ONCE(servo->unplugged)) {
		smp_store_release(&servo->ended, 1); /* after the last record */
		if (wq_has_sleeper(&servo->wait))
			wake_up_interruptible(&servo->wait);
		return false;
	}
	return !phantom_safety_stopped(&servo->safety);
}

void phantom_servo_set_clock(struct phantom_servo *servo)
{
	u64 now = phantom_servo_now(servo);

	phantom_context_run(servo);
	/* a run that goes on after the machine slept began when it began */
	if (!servo->stats.next.tick)
		servo->stats.next.start_ns = now;
	servo->next_ns = now + NSEC_PER_SEC / READ_ONCE(servo->rate_hz);
	servo->last_ns = now;
	servo->busy_ns = 0;
	servo->woken_ns = now;
	servo->reminded_ns = now;
}

void phantom_servo_enter(struct phantom_servo *servo)
{
	WRITE_ONCE(servo->thread, current);
	phantom_context_servo(servo);
}

void phantom_servo_leave(struct phantom_servo *servo)
{
	WRITE_ONCE(servo->thread, NULL);
}

void phantom_servo_run(struct phantom_servo *servo)
{
	struct phantom_clock *clock = servo->clock;

	lockdep_assert_not_held(&servo->control);
	phantom_servo_enter(servo);
	/* again: making this thread may have taken many periods, and none of them is a missed tick */
	phantom_servo_set_clock(servo);
	while (clock->ops->sleep_until(clock, servo->next_ns))
		if (!phantom_servo_step(servo))
			break;
	phantom_servo_leave(servo);
}
