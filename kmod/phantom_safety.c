// SPDX-License-Identifier: GPL-2.0-only
/*
 * phantom_safety.c - limits, ramps and latched faults. Integers only, nothing here can fail.
 */
#include <phantom_platform.h>
#include "phantom_safety.h"

/* 1.0 of the ramp's gain; |force| < 2^31, so the product stays within s64. */
#define PHANTOM_GAIN_SHIFT 30

/* Differences of positions beyond this count as this: 4 m in a tick is an overspeed anyhow. */
#define PHANTOM_JUMP_MAX_NM 4000000000LL

/* Ticks farther apart than this count as this far apart: by then a stall has cut the force. */
#define PHANTOM_TRACK_MAX_NS 100000000ULL

int phantom_safety_limits(struct phantom_limits *limits, const struct phantom_start *start,
			  u32 device_force_un)
{
	if (start->max_force_un > device_force_un || start->ramp_ms > PHANTOM_RAMP_MAX_MS)
		return -EINVAL;
	limits->off = start->flags & PHANTOM_START_LIMITS_OFF;
	limits->max_force_un = start->max_force_un ? start->max_force_un : device_force_un;
	limits->slew_un_per_ms =
		start->slew_un_per_ms ? start->slew_un_per_ms : PHANTOM_SLEW_DEFAULT_UN_PER_MS;
	limits->ramp_ns =
		(u64)(start->ramp_ms ? start->ramp_ms : PHANTOM_RAMP_DEFAULT_MS) * NSEC_PER_MSEC;
	limits->max_speed_nm_s =
		(u64)(start->max_speed_um_s ? start->max_speed_um_s : PHANTOM_SPEED_DEFAULT_UM_S) *
		1000;
	limits->stall_ns =
		(u64)(start->stall_us ? start->stall_us : PHANTOM_STALL_DEFAULT_US) * NSEC_PER_USEC;
	return 0;
}

void phantom_safety_begin(struct phantom_safety *safety, const struct phantom_limits *limits)
{
	u32 faults = safety->faults;

	memset(safety, 0, sizeof(*safety));
	safety->limits = *limits;
	safety->faults = faults;
	if (limits->off)
		safety->ramp_ns = limits->ramp_ns;
}

void phantom_safety_watch(struct phantom_safety *safety, u64 latency_ns, u64 elapsed_ns,
			  u64 busy_ns, u64 period_ns)
{
	u64 patience_ns = PHANTOM_OVERLOAD_STALLS * safety->limits.stall_ns;
	u64 allowed_ns = elapsed_ns / 8 * PHANTOM_OVERLOAD_PART;

	safety->causes = 0;
	safety->excess_ns += busy_ns;
	safety->excess_ns -= min_t(u64, safety->excess_ns, allowed_ns);
	if (elapsed_ns < 2 * period_ns)
		safety->behind_ns = 0;
	else
		safety->behind_ns += elapsed_ns;
	if (safety->limits.off)
		return;
	if (safety->behind_ns > patience_ns ||
	    safety->excess_ns > patience_ns / 8 * (8 - PHANTOM_OVERLOAD_PART)) {
		safety->overloaded = true;
		phantom_safety_raise(safety, PHANTOM_FAULT_STALL);
	}
	if (latency_ns > safety->limits.stall_ns)
		phantom_safety_raise(safety, PHANTOM_FAULT_STALL);
}

void phantom_safety_track(struct phantom_safety *safety, const s64 tip_nm[3], u64 elapsed_ns,
			  u64 period_ns)
{
	s64 dt = clamp_t(u64, elapsed_ns, period_ns, PHANTOM_TRACK_MAX_NS);
	u64 sum = 0;
	int axis;

	for (axis = 0; axis < 3; axis++) {
		s64 jump = clamp_t(s64, tip_nm[axis] - safety->tip_nm[axis], -PHANTOM_JUMP_MAX_NM,
				   PHANTOM_JUMP_MAX_NM);
		s64 raw = safety->tracking ? jump * NSEC_PER_SEC / dt : 0;
		s64 velocity = safety->velocity_nm_s[axis];

		/* |raw|, |velocity| <= 4e13 nm/s: in um/s times dt both stay within s64 */
		velocity += (raw - velocity) / 1000 * dt / (PHANTOM_VELOCITY_TAU_NS + dt) * 1000;
		safety->velocity_nm_s[axis] = velocity;
		safety->tip_nm[axis] = tip_nm[axis];
		velocity = clamp_t(s64, velocity / 1000, -S32_MAX, S32_MAX);
		sum += (u64)(velocity * velocity);
	}
	safety->tracking = true;
	if (!safety->limits.off && (u64)int_sqrt64(sum) * 1000 > safety->limits.max_speed_nm_s)
		phantom_safety_raise(safety, PHANTOM_FAULT_OVERSPEED);
}

void phantom_safety_raise(struct phantom_safety *safety, u32 cause)
{
	safety->causes |= cause;
	safety->faults |= cause;
}

void phantom_safety_clear(struct phantom_safety *safety)
{
	safety->faults &= safety->causes;
	if (!(safety->faults & PHANTOM_FAULT_STALL))
		safety->overloaded = false;
	safety->ramp_ns = safety->limits.off ? safety->limits.ramp_ns : 0;
}

void phantom_safety_stop(struct phantom_safety *safety, bool abandoned)
{
	struct phantom_limits *limits = &safety->limits;
	u32 slew = limits->max_force_un / (PHANTOM_ABANDON_NS / NSEC_PER_MSEC) + 1;

	safety->stopping = true;
	if (!abandoned || limits->off)
		return;
	if (limits->ramp_ns > PHANTOM_ABANDON_NS) {
		/* the same gain on a shorter ramp: no step */
		safety->ramp_ns = safety->ramp_ns * PHANTOM_ABANDON_NS / limits->ramp_ns;
		limits->ramp_ns = PHANTOM_ABANDON_NS;
	}
	limits->slew_un_per_ms = max_t(u32, limits->slew_un_per_ms, slew);
}

/* |vector| rounded up, so that dividing by it never leaves more than was asked for. */
static u64 phantom_safety_norm(const s64 vector[3])
{
	u64 sum = 0;
	int axis;

	for (axis = 0; axis < 3; axis++)
		sum += (u64)(vector[axis] * vector[axis]);
	return sum ? (u64)int_sqrt64(sum - 1) + 1 : 0;
}

static u32 phantom_safety_ramp(struct phantom_safety *safety, s64 force[3], u64 elapsed_ns)
{
	u64 top = safety->limits.ramp_ns;
	s64 gain;
	int axis;

	if (safety->stopping)
		safety->ramp_ns -= min_t(u64, safety->ramp_ns, elapsed_ns);
	else
		safety->ramp_ns += min_t(u64, top - safety->ramp_ns, elapsed_ns);
	if (safety->ramp_ns == top)
		return 0;
	gain = (safety->ramp_ns << PHANTOM_GAIN_SHIFT) / top;
	for (axis = 0; axis < 3; axis++)
		force[axis] = force[axis] * gain / (1LL << PHANTOM_GAIN_SHIFT);
	return PHANTOM_TICK_RAMPING;
}

static u32 phantom_safety_clamp(const struct phantom_safety *safety, s64 force[3])
{
	u64 norm = phantom_safety_norm(force);
	u32 most = safety->limits.max_force_un;
	int axis;

	if (norm <= most)
		return 0;
	for (axis = 0; axis < 3; axis++)
		force[axis] = force[axis] * most / (s64)norm;
	return PHANTOM_TICK_CLAMPED;
}

static u32 phantom_safety_slew(const struct phantom_safety *safety, s64 force[3], u64 step_ns)
{
	u64 most = (u64)safety->limits.slew_un_per_ms * step_ns / NSEC_PER_MSEC;
	s64 change[3];
	u64 norm;
	int axis;

	for (axis = 0; axis < 3; axis++)
		change[axis] = force[axis] - safety->force_un[axis];
	norm = phantom_safety_norm(change);
	if (norm <= most)
		return 0;
	for (axis = 0; axis < 3; axis++)
		force[axis] = safety->force_un[axis] + change[axis] * (s64)most / (s64)norm;
	return PHANTOM_TICK_SLEWED;
}

u32 phantom_safety_apply(struct phantom_safety *safety, const s32 target_un[3], u64 elapsed_ns,
			 u64 period_ns, s32 force_un[3])
{
	s64 force[3];
	u32 flags = 0;
	int axis;

	for (axis = 0; axis < 3; axis++)
		force[axis] = target_un[axis];
	if (safety->faults || (safety->limits.off && safety->stopping)) {
		memset(force, 0, sizeof(force));
		safety->ramp_ns = safety->stopping ? 0 : safety->ramp_ns;
	} else if (!safety->limits.off) {
		flags |= phantom_safety_clamp(safety, force);
		flags |= phantom_safety_ramp(safety, force, elapsed_ns);
		flags |= phantom_safety_slew(safety, force, min_t(u64, elapsed_ns, 2 * period_ns));
	}
	for (axis = 0; axis < 3; axis++)
		safety->force_un[axis] = force[axis];
	memcpy(force_un, safety->force_un, sizeof(safety->force_un));
	return flags;
}

bool phantom_safety_stopped(const struct phantom_safety *safety)
{
	return safety->stopping && !safety->ramp_ns && !safety->force_un[0] &&
	       !safety->force_un[1] && !safety->force_un[2];
}
