// SPDX-License-Identifier: GPL-2.0-only
/*
 * phantom_servo.c - the tick, and the only place that opens float sections.
 *
 * ONE TICK, at an absolute deadline
 *
 *     take the waiting set, the model, a wish to stop or to clear a fault
 *     tip      <- device                      an error is a fault
 *     velocity <- low pass of tip             too fast is a fault
 *     target   <- phantom_touch.c: where the set covers the tip and is fresh, contact, proxy and
 *                 effects in every frame, added up; else 0
 *     target   <- blend, where covered, fresh, model or geometry changed
 *     force    <- safety: clamp, ramp, slew; any fault: 0
 *     device   <- force                       an error is a fault
 *     record, status page, wake-ups
 *
 * CONTEXT RULES stand in phantom_servo.h. Here: everything is the servo thread's but prepare(),
 * which is a submitter's, and what says "run state". Float sections run with preemption off: no
 * sleeping lock, no allocation, no copy from user, no print between begin and end, and nothing but
 * float/ is called there.
 */
#include <phantom_platform.h>
#include "phantom_context.h"
#include "phantom_servo.h"
#include "phantom_touch.h"
#include <phantom_trace.h>

/* Readers of records are woken at most this often: at 10 kHz ten records cost one wake-up. */
#define PHANTOM_WAKE_NS 1000000

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

/* One float section for each PHANTOM_FLOAT_PREPARE_MAX patches. */
static void phantom_servo_prepare_frame(struct phantom_servo *servo, struct phantom_slot *slot,
					u32 frame)
{
	const struct phantom_set_copy *copy = &servo->sets.copy;
	const struct phantom_part *part = &copy->part[frame];
	struct phantom_effects effects;
	struct phantom_float_prepare prepare = {
		.set = slot->frame[frame].floats,
		.patches = part->patch_count ? copy->sorted + part->first : NULL,
		.materials = copy->materials,
		.patch_count = part->patch_count,
		.face_count = part->face_count,
		.rim_count = part->rim_count,
		.material_count = copy->header.material_count,
		.effects = copy->header.effect_bytes ? &effects : NULL,
	};

	phantom_set_effects(copy, frame, &effects);
	memcpy(prepare.origin_nm, slot->frame[frame].origin_nm, sizeof(prepare.origin_nm));
	do {
		u64 begin = phantom_servo_now(servo);
		u64 length;

		prepare.count =
			min_t(u32, part->patch_count - prepare.first, PHANTOM_FLOAT_PREPARE_MAX);
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
	} while (prepare.first < part->patch_count);
	slot->refused += prepare.refused;
}

void phantom_servo_prepare(struct phantom_servo *servo, struct phantom_slot *slot)
{
	u32 frame;

	phantom_context_submitter(&servo->sets);
	phantom_servo_prepare_frame(servo, slot, 0);
	for (frame = 1; frame < slot->frame_count; frame++)
		if (slot->frame[frame].patch_count)
			phantom_servo_prepare_frame(servo, slot, frame);
}

/* ---- what comes to the tick from outside --------------------------------- */

static void phantom_servo_take_set(struct phantom_servo *servo, struct phantom_pass *pass)
{
	struct phantom_slot *before = servo->active;
	struct phantom_slot *slot = phantom_set_take(&servo->sets);
	struct phantom_status *next = &servo->stats.next;

	if (!slot)
		return;
	if (before) {
		/* a scene that became empty here is no mere swap */
		if (before->frame[0].patch_count && !slot->frame[0].patch_count)
			pass->blend_ns = PHANTOM_FADE_NS;
		/* another feel */
		if (before->effect_print != slot->effect_print)
			pass->blend_ns = PHANTOM_FADE_NS;
	}
	if (slot->frame_count > 1 || (before && before->frame_count > 1))
		phantom_bodies_swap(servo, before, slot, pass);
	if (before) {
		pass->reshaped = phantom_set_reshaped(before, slot);
		if (pass->reshaped)
			pass->outgoing = before; /* phantom_touch_contact() releases it */
		else
			phantom_set_release(before);
	}
	servo->active = slot;
	servo->warned = false;
	phantom_touch_settle(servo);
	next->set_time_ns = pass->now_ns;
	next->isa = slot->ops->isa;
	next->set_id = slot->id;
	next->set_patches = slot->patch_count;
	next->set_level = slot->level;
	next->set_level_error_nm = slot->level_error_nm;
	next->sets++;
	next->refused += slot->refused;
	trace_phantom_set(servo->unit, slot->id, slot->patch_count, slot->refused,
			  slot->frame[0].radius_nm);
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
		phantom_touch_forget(servo);
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
	if (pass->flags & (PHANTOM_TICK_UNCOVERED | PHANTOM_TICK_STALE)) {
		if (!servo->warned || pass->now_ns - servo->reminded_ns >= PHANTOM_REMIND_NS) {
			servo->warned = true;
			servo->reminded_ns = pass->now_ns;
			return true;
		}
		return false;
	}
	if (servo->warned || !phantom_touch_running_out(servo, pass))
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

static __always_inline void phantom_servo_tick(struct phantom_servo *servo, u64 now_ns,
					       u64 period_ns)
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
	phantom_touch_contact(servo, &pass);
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
