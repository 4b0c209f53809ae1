/* SPDX-License-Identifier: GPL-2.0-only */
/*
 * phantom_safety.h - what stands between a computed force and a person's hand. Integers only.
 *
 * Order of a tick: causes are looked for and latched as faults; a fault cuts the force to zero at
 * once. Without one: clamp of the magnitude (direction kept) -> ramp -> slew limit. The slew limit
 * comes last, so that nothing above it can step the force.
 *
 *   clamp   |F| <= max_force_un
 *   ramp    F g, g from 0 to 1 in ramp_ms after START and CLEAR_FAULT, back to 0 after STOP;
 *           STOP in mid-ramp turns round where it is; an abandoned servo's ramp takes
 *           PHANTOM_ABANDON_NS at most, and its slew limit gives way to that
 *   slew    |F - F_last| <= slew_un_per_ms dt, dt at most two periods however late the tick
 *
 * Velocity is the low-passed difference of positions (time constant PHANTOM_VELOCITY_TAU_NS):
 *
 *     v += ((P - P_last) / dt - v) dt / (tau + dt),   dt = max(time between ticks, period)
 *
 * so encoder steps and a tick that comes right behind a late one do not look like speed. A jump of
 * max_speed (tau + dt) or more in one tick is an overspeed: 15 mm with the defaults at 1 kHz.
 */
#ifndef PHANTOM_SAFETY_H
#define PHANTOM_SAFETY_H

#include <phantom_platform.h>
#include "phantom_abi.h"

#define PHANTOM_SLEW_DEFAULT_UN_PER_MS 1000000 /* 1 N per ms */
#define PHANTOM_RAMP_DEFAULT_MS 250
#define PHANTOM_SPEED_DEFAULT_UM_S 5000000 /* 5 m/s: faster than a hand */
#define PHANTOM_STALL_DEFAULT_US 20000
#define PHANTOM_STALE_DEFAULT_MS 100

/* 80 Hz: above what a hand does, below what makes an encoder's steps loud. */
#define PHANTOM_VELOCITY_TAU_NS 2000000

/*
 * A servo that skips periods, or computes all the time, for that many stall limits on end cannot do
 * the work it is asked for. A thread of its priority would leave nothing of its CPU to anyone. What it
 * computes beyond PHANTOM_OVERLOAD_PART parts of 8 of the time adds up, and quieter ticks pay it back.
 */
#define PHANTOM_OVERLOAD_STALLS 10
#define PHANTOM_OVERLOAD_PART 7

/* Ramp of a servo whose feeder is gone. With the way there it stays within PHANTOM_FADE_NS. */
#define PHANTOM_ABANDON_NS 15000000

/* Constant while the servo runs, until it is abandoned. */
struct phantom_limits {
	bool off; /* PHANTOM_START_LIMITS_OFF */
	u32 max_force_un;
	u32 slew_un_per_ms;
	u64 ramp_ns;
	u64 max_speed_nm_s;
	u64 stall_ns;
};

/* The servo's alone while it runs, the control mutex's while it does not. */
struct phantom_safety {
	struct phantom_limits limits;
	u32 faults; /* latched */
	u32 causes; /* of this tick */
	bool stopping; /* the ramp goes down */
	bool overloaded; /* until CLEAR_FAULT: contact is not worth the time it takes */
	u64 behind_ns; /* how long every tick has skipped periods */
	u64 excess_ns; /* computed beyond the part that is allowed */
	u64 ramp_ns; /* how far up the ramp is, 0 ... limits.ramp_ns */
	s32 force_un[3]; /* sent last */
	bool tracking; /* tip_nm is known */
	s64 tip_nm[3];
	s64 velocity_nm_s[3];
};

/* 0; -EINVAL: above the device's force or the ramp's limit. Zero fields become defaults. */
int phantom_safety_limits(struct phantom_limits *limits, const struct phantom_start *start,
			  u32 device_force_un);
/* A run begins: zero force, ramp at its foot. Latched faults stay. */
void phantom_safety_begin(struct phantom_safety *safety, const struct phantom_limits *limits);

/* ---- once a tick, in this order ------------------------------------------ */
/*
 * elapsed_ns: since the last tick, which took busy_ns; latency_ns: wake-up after the period's begin.
 */
void phantom_safety_watch(struct phantom_safety *safety, u64 latency_ns, u64 elapsed_ns,
			  u64 busy_ns, u64 period_ns);
void phantom_safety_track(struct phantom_safety *safety, const s64 tip_nm[3], u64 elapsed_ns,
			  u64 period_ns);
/* Anyone's finding in this tick: PHANTOM_FAULT_... */
void phantom_safety_raise(struct phantom_safety *safety, u32 cause);
/* Unlatches what has no cause in this tick; the force ramps up again when nothing is left. */
void phantom_safety_clear(struct phantom_safety *safety);
/* The ramp goes down from here; abandoned: within PHANTOM_ABANDON_NS. */
void phantom_safety_stop(struct phantom_safety *safety, bool abandoned);
/* The force to send, and PHANTOM_TICK_CLAMPED, SLEWED and RAMPING. */
u32 phantom_safety_apply(struct phantom_safety *safety, const s32 target_un[3], u64 elapsed_ns,
			 u64 period_ns, s32 force_un[3]);
/* STOP was asked for and the force has reached zero. */
bool phantom_safety_stopped(const struct phantom_safety *safety);

#endif /* PHANTOM_SAFETY_H */
