// SPDX-License-Identifier: GPL-2.0-only
/*
 * phantom_control.c - what the ioctls do to the servo: start, stop, rate, model, sets, faults.
 *
 * All of it runs in process context under the character device's control mutex. While the servo
 * runs it is reached only by words and requests (phantom_servo.h); while it does not, its state
 * is ours.
 */
#include <phantom_platform.h>
#include "phantom_servo.h"

/* What STOP grants beyond the ramp: the slew limit's tail, and a late thread. */
#define PHANTOM_STOP_SLACK_NS 1000000000ULL

/* The default of a machine nobody has told anything. */
static const struct phantom_model phantom_model_default = {
	.model = PHANTOM_MODEL_PROJECTED,
	.newton_steps = 2,
	.combine = PHANTOM_COMBINE_BOUNDED,
	.proxy = PHANTOM_PROXY_PAPER,
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

int phantom_servo_init(struct phantom_servo *servo, struct phantom_clock *clock,
		       struct phantom_device *device, const struct phantom_float_ops *float_ops,
		       const struct phantom_float_ops *double_ops, u32 patches_max)
{
	int error;

	memset(servo, 0, sizeof(*servo));
	servo->clock = clock;
	servo->device = device;
	servo->float_ops = float_ops;
	servo->double_ops = double_ops;
	servo->features = PHANTOM_FEATURE_MODEL_PAPER | PHANTOM_FEATURE_MODEL_PROJECTED |
			  PHANTOM_FEATURE_PROXY_PAPER | PHANTOM_FEATURE_ARITH_FLOAT |
			  PHANTOM_FEATURE_FANS;
	if (double_ops)
		servo->features |= PHANTOM_FEATURE_ARITH_DOUBLE;
	if (device && device->ops->move)
		servo->features |= PHANTOM_FEATURE_SIM_MOVE;
	error = phantom_stats_init(&servo->stats);
	if (error)
		return error;
	phantom_set_init(&servo->sets, patches_max);
	init_waitqueue_head(&servo->wait);
	servo->rate_hz = PHANTOM_RATE_DEFAULT_HZ;
	servo->model = phantom_model_pack(&phantom_model_default);
	servo->active_model = servo->model;
	servo->job.model = phantom_model_default;
	phantom_servo_forget_touch(servo);
	servo->stats.next.rate_hz = servo->rate_hz;
	servo->stats.next.model = phantom_model_default;
	servo->stats.next.isa = float_ops->isa;
	phantom_stats_publish(&servo->stats);
	return 0;
}

void phantom_servo_destroy(struct phantom_servo *servo)
{
	phantom_set_destroy(&servo->sets);
	phantom_stats_destroy(&servo->stats);
}

static int phantom_control_check_start(const struct phantom_servo *servo,
				       const struct phantom_start *start,
				       struct phantom_limits *limits)
{
	if (start->reserved || (start->flags & ~PHANTOM_START_FLAGS_KNOWN))
		return -EINVAL;
	if (!servo->device)
		return -ENODEV;
	if ((start->flags & PHANTOM_START_LIMITS_OFF) &&
	    servo->device->ops->kind != PHANTOM_DEVICE_SIM)
		return -EPERM;
	return phantom_safety_limits(limits, start, servo->device->max_force_un);
}

/* A run begins here; what the last one left of sets and model stays. */
static void phantom_control_begin(struct phantom_servo *servo, const struct phantom_start *start,
				  const struct phantom_limits *limits)
{
	u32 stale_ms = start->stale_ms ? start->stale_ms : PHANTOM_STALE_DEFAULT_MS;

	phantom_safety_begin(&servo->safety, limits);
	phantom_fade_reset(&servo->fade);
	phantom_servo_forget_touch(servo);
	phantom_stats_begin(&servo->stats);
	servo->stats.next.state = PHANTOM_STATE_RUNNING;
	servo->stale_ns = (u64)stale_ms * NSEC_PER_MSEC;
	phantom_servo_set_clock(servo);
	servo->reached = false;
	servo->warned = false;
	servo->prepare_max_ns = 0;
	servo->stop_wanted = 0;
	servo->clear_wanted = 0;
	servo->causes = 0;
	WRITE_ONCE(servo->state, PHANTOM_STATE_RUNNING);
	phantom_stats_publish(&servo->stats);
}

static void phantom_control_end(struct phantom_servo *servo)
{
	struct phantom_status *next = &servo->stats.next;

	WRITE_ONCE(servo->state, PHANTOM_STATE_IDLE);
	WRITE_ONCE(servo->runs, servo->runs + 1);
	next->state = PHANTOM_STATE_IDLE;
	next->flags = 0;
	memset(next->force_un, 0, sizeof(next->force_un));
	phantom_stats_publish(&servo->stats);
	phantom_control_wake(servo);
}

int phantom_servo_start(struct phantom_servo *servo, const struct phantom_start *start)
{
	struct phantom_limits limits;
	int error = phantom_control_check_start(servo, start, &limits);

	if (error)
		return error;
	if (!phantom_control_idle(servo))
		return -EBUSY;
	if (READ_ONCE(servo->faults))
		return -EIO;
	error = servo->device->ops->start(servo->device);
	if (error)
		return error;
	phantom_control_begin(servo, start, &limits);
	error = servo->clock->ops->start(servo->clock, servo);
	if (error) {
		servo->device->ops->stop(servo->device);
		phantom_control_end(servo);
	}
	return error;
}

void phantom_servo_stop(struct phantom_servo *servo, u32 wish)
{
	static const s32 zero[3];
	u64 patience;

	if (phantom_control_idle(servo))
		return;
	/* before the wish: with it the servo may shorten its ramp */
	patience = servo->safety.limits.ramp_ns + PHANTOM_STOP_SLACK_NS;
	smp_store_release(&servo->stop_wanted, wish);
	servo->clock->ops->stop(servo->clock, servo, patience);
	/* again, for the case that the thread had to be ended before its ramp was */
	servo->device->ops->write(servo->device, zero);
	servo->device->ops->stop(servo->device);
	phantom_control_end(servo);
}

int phantom_servo_clear_fault(struct phantom_servo *servo)
{
	u32 faults = READ_ONCE(servo->faults);

	if (!faults)
		return 0;
	if (!phantom_control_idle(servo)) {
		if (READ_ONCE(servo->causes) & faults)
			return -EAGAIN;
		smp_store_release(&servo->clear_wanted, 1);
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
	static const u64 ariths[] = {PHANTOM_FEATURE_ARITH_FLOAT, PHANTOM_FEATURE_ARITH_FIXED,
				     PHANTOM_FEATURE_ARITH_DOUBLE};

	if (model->model >= ARRAY_SIZE(models) || model->proxy >= ARRAY_SIZE(proxies) ||
	    model->arith >= ARRAY_SIZE(ariths) || model->combine > PHANTOM_COMBINE_BOUNDED ||
	    model->newton_steps > PHANTOM_NEWTON_STEPS_MAX)
		return 0;
	return models[model->model] | proxies[model->proxy] | ariths[model->arith];
}

int phantom_servo_set_model(struct phantom_servo *servo, const struct phantom_model *model)
{
	u64 needs = phantom_control_needs(model);
	int i;

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
	const struct phantom_float_ops *ops =
		arith == PHANTOM_ARITH_DOUBLE ? servo->double_ops : servo->float_ops;
	struct phantom_slot *slot = phantom_set_fill(&servo->sets, user, ops);

	if (IS_ERR(slot))
		return PTR_ERR(slot);
	phantom_servo_prepare(servo, slot);
	phantom_set_hand_over(&servo->sets, slot);
	return 0;
}

void phantom_servo_forget(struct phantom_servo *servo)
{
	struct phantom_status *next = &servo->stats.next;

	phantom_set_forget(&servo->sets);
	if (servo->active)
		phantom_set_release(servo->active);
	servo->active = NULL;
	phantom_servo_forget_touch(servo);
	next->set_id = 0;
	next->set_patches = 0;
	next->set_time_ns = 0;
	next->set_level = 0;
	next->set_level_error_nm = 0;
	phantom_stats_publish(&servo->stats);
}
