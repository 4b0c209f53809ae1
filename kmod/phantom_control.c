// SPDX-License-Identifier: GPL-2.0-only
/*
 * phantom_control.c - what the ioctls do to the servo: start, stop, rate, model, sets, faults.
 *
 * All of it is "control" (phantom_servo.h) but submitting, which has a mutex of its own: a set is
 * taken while STOP waits for its ramp, and a submitter that waits for its own memory holds up no
 * STOP. While the servo runs it is reached only by words and requests; while it does not, its state
 * is ours.
 */
#include <phantom_platform.h>
#include "phantom_context.h"
#include "phantom_servo.h"
#include "phantom_touch.h"
#include <phantom_trace.h>

/* What STOP grants beyond the ramp: the slew limit's tail, and a late thread. */
#define PHANTOM_STOP_SLACK_NS 1000000000ULL

/* The default of a machine nobody has told anything. */
static const struct phantom_model phantom_model_default = {
	.model = PHANTOM_MODEL_PROJECTED,
	.newton_steps = 2,
	.combine = PHANTOM_COMBINE_BOUNDED,
	.proxy = PHANTOM_PROXY_CONSTRAINED,
	.arith = PHANTOM_ARITH_FLOAT,
};

#define PHANTOM_RATE_DEFAULT_HZ 1000

static bool phantom_control_idle(const struct phantom_servo *servo)
{
	return READ_ONCE(servo->state) == PHANTOM_STATE_IDLE;
}

static void phantom_control_wake(struct phantom_servo *servo)
{
	if (wq_has_sleeper(&servo->wait))
		wake_up_interruptible(&servo->wait);
}

/* The feature bit of each arithmetic. */
static const u64 phantom_control_ariths[PHANTOM_ARITHS] = {
	PHANTOM_FEATURE_ARITH_FLOAT, PHANTOM_FEATURE_ARITH_FIXED, PHANTOM_FEATURE_ARITH_DOUBLE};

int phantom_servo_init(struct phantom_servo *servo, struct phantom_clock *clock,
		       struct phantom_device *device,
		       const struct phantom_float_ops *const ops[PHANTOM_ARITHS], u32 patches_max)
{
	u32 arith;
	int error;

	might_sleep();
	memset(servo, 0, sizeof(*servo));
	servo->clock = clock;
	servo->device = device;
	servo->features = PHANTOM_FEATURE_MODEL_PAPER | PHANTOM_FEATURE_MODEL_PROJECTED |
			  PHANTOM_FEATURE_PROXY_PAPER | PHANTOM_FEATURE_PROXY_CONSTRAINED |
			  PHANTOM_FEATURE_FANS | PHANTOM_FEATURE_CROSSFADE | PHANTOM_FEATURE_RIMS |
			  PHANTOM_FEATURE_MOVING_OBJECTS;
	for (arith = 0; arith < PHANTOM_ARITHS; arith++) {
		servo->ops[arith] = ops[arith];
		if (ops[arith])
			servo->features |= phantom_control_ariths[arith];
	}
	if (device && device->ops->move)
		servo->features |= PHANTOM_FEATURE_SIM_MOVE;
	error = phantom_stats_init(&servo->stats);
	if (error)
		return error;
	mutex_init(&servo->control);
	phantom_set_init(&servo->sets, patches_max);
	init_waitqueue_head(&servo->wait);
	servo->rate_hz = PHANTOM_RATE_DEFAULT_HZ;
	servo->model = phantom_model_pack(&phantom_model_default);
	servo->active_model = servo->model;
	servo->job.model = phantom_model_default;
	mutex_lock(&servo->control);
	phantom_touch_forget(servo);
	mutex_unlock(&servo->control);
	servo->stats.next.rate_hz = servo->rate_hz;
	servo->stats.next.model = phantom_model_default;
	servo->stats.next.isa = ops[PHANTOM_ARITH_FLOAT]->isa;
	phantom_stats_publish(&servo->stats);
	return 0;
}

void phantom_servo_destroy(struct phantom_servo *servo)
{
	might_sleep();
	phantom_set_destroy(&servo->sets);
	phantom_stats_destroy(&servo->stats);
	mutex_destroy(&servo->control);
}

static int phantom_control_check_start(const struct phantom_servo *servo,
				       const struct phantom_start *start,
				       struct phantom_limits *limits)
{
	if ((start->flags & ~PHANTOM_START_FLAGS_KNOWN) ||
	    start->crossfade_ms > PHANTOM_RAMP_MAX_MS)
		return -EINVAL;
	if (!servo->device)
		return -ENODEV;
	if ((start->flags & PHANTOM_START_LIMITS_OFF) &&
	    servo->device->ops->kind != PHANTOM_DEVICE_SIM)
		return -EPERM;
	return phantom_safety_limits(limits, start, servo->device->max_force_un);
}

static void phantom_control_set_state(struct phantom_servo *servo, u32 state)
{
	if (state != servo->state)
		trace_phantom_state(servo->unit, servo->state, state);
	WRITE_ONCE(servo->state, state);
	servo->stats.next.state = state;
	phantom_stats_publish(&servo->stats);
}

/* The tick that comes next knows nothing of the last one. Latched faults stay. */
static void phantom_control_reset(struct phantom_servo *servo)
{
	phantom_safety_begin(&servo->safety, &servo->limits);
	phantom_fade_reset(&servo->fade);
	phantom_touch_forget(servo);
	phantom_servo_set_clock(servo);
	servo->reached = false;
	servo->warned = false;
	servo->stop_wanted = 0;
	servo->clear_wanted = 0;
	WRITE_ONCE(servo->ended, 0);
	WRITE_ONCE(servo->causes, 0);
}

/* A run begins here; what the last one left of sets and model stays. */
static void phantom_control_begin(struct phantom_servo *servo, const struct phantom_start *start)
{
	u32 stale_ms = start->stale_ms ? start->stale_ms : PHANTOM_STALE_DEFAULT_MS;

	phantom_stats_begin(&servo->stats);
	phantom_control_reset(servo);
	servo->stale_ns = (u64)stale_ms * NSEC_PER_MSEC;
	servo->crossfade_ns =
		start->crossfade_ms ? (u64)start->crossfade_ms * NSEC_PER_MSEC : PHANTOM_FADE_NS;
	WRITE_ONCE(servo->prepare_max_ns, 0);
	phantom_control_set_state(servo, PHANTOM_STATE_RUNNING);
}

/* Force and flags of a servo without ticks. */
static void phantom_control_still(struct phantom_servo *servo)
{
	struct phantom_status *next = &servo->stats.next;

	next->flags = 0;
	memset(next->force_un, 0, sizeof(next->force_un));
	memset(next->velocity_nm_s, 0, sizeof(next->velocity_nm_s));
}

static void phantom_control_end(struct phantom_servo *servo)
{
	phantom_control_still(servo);
	WRITE_ONCE(servo->runs, servo->runs + 1);
	phantom_control_set_state(servo, PHANTOM_STATE_IDLE);
	phantom_control_wake(servo);
}

/* Device and thread on. Nothing is left of either when that fails. */
static int phantom_control_launch(struct phantom_servo *servo)
{
	int error = servo->device->ops->start(servo->device);

	if (error)
		return error;
	error = servo->clock->ops->start(servo->clock, servo);
	if (error)
		servo->device->ops->stop(servo->device);
	return error;
}

/* Ramps to zero, then thread and device off. */
static void phantom_control_halt(struct phantom_servo *servo, u32 wish)
{
	static const s32 zero[3];

	smp_store_release(&servo->stop_wanted, wish); /* pairs with phantom_servo_act() */
	servo->clock->ops->stop(servo->clock, servo, servo->limits.ramp_ns + PHANTOM_STOP_SLACK_NS);
	/* again, for the case that the thread had to be ended before its ramp was */
	servo->device->ops->write(servo->device, zero);
	servo->device->ops->stop(servo->device);
}

int phantom_servo_start(struct phantom_servo *servo, const struct phantom_start *start)
{
	struct phantom_limits limits;
	int error;

	phantom_context_control(servo);
	error = phantom_control_check_start(servo, start, &limits);
	if (error)
		return error;
	if (!phantom_control_idle(servo) || servo->asleep)
		return -EBUSY;
	if (READ_ONCE(servo->faults))
		return -EIO;
	servo->limits = limits;
	phantom_control_begin(servo, start);
	error = phantom_control_launch(servo);
	if (error)
		phantom_control_end(servo);
	return error;
}

void phantom_servo_stop(struct phantom_servo *servo, u32 wish)
{
	phantom_context_control(servo);
	if (phantom_control_idle(servo))
		return;
	if (!servo->asleep)
		phantom_control_halt(servo, wish);
	phantom_control_end(servo);
}

void phantom_servo_suspend(struct phantom_servo *servo)
{
	phantom_context_control(servo);
	if (servo->asleep)
		return;
	servo->asleep = true;
	if (phantom_control_idle(servo))
		return;
	phantom_control_halt(servo, PHANTOM_WISH_ABANDON);
	phantom_control_still(servo);
	servo->safety.faults |= PHANTOM_FAULT_SUSPENDED;
	servo->stats.next.faults = servo->safety.faults;
	WRITE_ONCE(servo->faults, servo->safety.faults);
	WRITE_ONCE(servo->events, servo->events + 1);
	trace_phantom_fault(servo->unit, servo->safety.faults);
	phantom_control_set_state(servo, PHANTOM_STATE_FAULT);
	phantom_control_wake(servo);
}

int phantom_servo_resume(struct phantom_servo *servo)
{
	int error;

	phantom_context_control(servo);
	if (!servo->asleep)
		return 0;
	servo->asleep = false;
	if (phantom_control_idle(servo))
		return 0;
	phantom_control_reset(servo);
	error = phantom_control_launch(servo);
	if (error)
		phantom_control_end(servo);
	return error;
}

int phantom_servo_clear_fault(struct phantom_servo *servo)
{
	u32 faults = READ_ONCE(servo->faults);

	phantom_context_control(servo);
	if (!faults)
		return 0;
	if (!phantom_control_idle(servo)) {
		if (servo->asleep || (READ_ONCE(servo->causes) & faults))
			return -EAGAIN;
		smp_store_release(&servo->clear_wanted, 1); /* pairs with phantom_servo_act() */
		return 0;
	}
	servo->safety.faults = 0;
	WRITE_ONCE(servo->faults, 0);
	servo->stats.next.faults = 0;
	phantom_stats_publish(&servo->stats);
	return 0;
}

int phantom_servo_set_rate(struct phantom_servo *servo, u32 rate_hz)
{
	phantom_context_control(servo);
	if (rate_hz < PHANTOM_RATE_MIN_HZ || rate_hz > PHANTOM_RATE_MAX_HZ)
		return -EINVAL;
	WRITE_ONCE(servo->rate_hz, rate_hz);
	if (phantom_control_idle(servo)) {
		servo->stats.next.rate_hz = rate_hz;
		phantom_stats_publish(&servo->stats);
	}
	return 0;
}

/* The feature bits that a model needs; 0: it has a value that this ABI does not know. */
static u64 phantom_control_needs(const struct phantom_model *model)
{
	static const u64 models[] = {0, PHANTOM_FEATURE_MODEL_PAPER,
				     PHANTOM_FEATURE_MODEL_PROJECTED};
	static const u64 proxies[] = {0, PHANTOM_FEATURE_PROXY_PAPER,
				      PHANTOM_FEATURE_PROXY_CONSTRAINED};

	if (model->model >= ARRAY_SIZE(models) || model->proxy >= ARRAY_SIZE(proxies) ||
	    model->arith >= PHANTOM_ARITHS || model->combine > PHANTOM_COMBINE_BOUNDED ||
	    model->newton_steps > PHANTOM_NEWTON_STEPS_MAX)
		return 0;
	return models[model->model] | proxies[model->proxy] | phantom_control_ariths[model->arith];
}

int phantom_servo_set_model(struct phantom_servo *servo, const struct phantom_model *model)
{
	u64 needs = phantom_control_needs(model);
	int i;

	phantom_context_control(servo);
	for (i = 0; i < 3; i++)
		if (model->reserved[i])
			return -EINVAL;
	if (!needs)
		return -EINVAL;
	if (needs & ~servo->features)
		return -EOPNOTSUPP;
	WRITE_ONCE(servo->model, phantom_model_pack(model));
	if (phantom_control_idle(servo)) {
		servo->stats.next.model = *model;
		phantom_stats_publish(&servo->stats);
	}
	return 0;
}

int phantom_servo_submit(struct phantom_servo *servo, const void __user *user)
{
	u32 arith = READ_ONCE(servo->model) >> 32 & 0xff;
	const struct phantom_float_ops *ops = servo->ops[arith];
	struct phantom_slot *slot;

	phantom_context_file(servo);
	mutex_lock(&servo->sets.submitting);
	slot = phantom_set_fill(&servo->sets, user, ops);
	if (!IS_ERR(slot)) {
		phantom_servo_prepare(servo, slot);
		phantom_set_hand_over(&servo->sets, slot);
	}
	mutex_unlock(&servo->sets.submitting);
	return IS_ERR(slot) ? PTR_ERR(slot) : 0;
}

void phantom_servo_forget(struct phantom_servo *servo)
{
	struct phantom_status *next = &servo->stats.next;

	phantom_context_control(servo);
	mutex_lock(&servo->sets.submitting);
	phantom_set_forget(&servo->sets);
	mutex_unlock(&servo->sets.submitting);
	if (servo->active)
		phantom_set_release(servo->active);
	servo->active = NULL;
	phantom_touch_forget(servo);
	next->set_id = 0;
	next->set_patches = 0;
	next->set_time_ns = 0;
	next->set_level = 0;
	next->set_level_error_nm = 0;
	phantom_stats_publish(&servo->stats);
}

void phantom_servo_unplug(struct phantom_servo *servo)
{
	WRITE_ONCE(servo->unplugged, 1);
	phantom_control_wake(servo);
}
