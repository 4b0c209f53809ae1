/* SPDX-License-Identifier: GPL-2.0-only */
/*
 * phantom_servo.h - the fast task: one tick per period turns the tip's position into a force.
 *
 * WHAT MAY BE CALLED WHERE (asserted, see phantom_context.h)
 *
 *   servo       The servo thread, or whoever steps a virtual clock. Calls the device's read and
 *               write, takes and releases sets, opens float sections, writes statistics, wakes
 *               readers. Takes no mutex of the module, allocates nothing, touches no user memory,
 *               waits for the clock only. (A wake-up takes the wait queue's own lock, which is held
 *               for a few instructions and has priority inheritance.)
 *   section     Between kernel_fpu_begin() and kernel_fpu_end(), preemption off. Nothing but float/.
 *   control     Process context, servo->control held. Everything under "control" below. Sleeps.
 *   submitter   Process context, sets.submitting held. phantom_set_fill() ... forget(). Sleeps, also
 *               on the caller's memory; keeps neither servo nor control waiting.
 *   file        Process context, neither mutex held. read, poll, mmap, GET_INFO, SIM_MOVE: words,
 *               the ring and the page.
 *   atomic      Interrupts, timers, a driver's raw_event: phantom_mailbox_post(), nothing else.
 *
 *   Mutexes are taken in this order: file->reading, servo->control, sets.submitting.
 *
 * WHO MAY TOUCH WHAT
 *
 *   fixed      set by init, read by all
 *   control    the holder's of servo->control
 *   word       one aligned word, READ_ONCE/WRITE_ONCE; written by the side named, read by any
 *   request    set by control with a release store, taken by the servo with xchg
 *   run        the servo's while it runs, control's while it does not. start() and stop() of the
 *              clock hand it over: they order all memory, as creating and joining a thread does
 *   own        has a protocol of its own, in its header
 */
#ifndef PHANTOM_SERVO_H
#define PHANTOM_SERVO_H

#include <phantom_platform.h>
#include "device/phantom_device.h"
#include "float/phantom_float.h"
#include "phantom_abi.h"
#include "phantom_body.h"
#include "phantom_clock.h"
#include "phantom_fade.h"
#include "phantom_safety.h"
#include "phantom_set.h"
#include "phantom_stats.h"

/* What a tick finds out on its way. */
struct phantom_pass {
	u64 now_ns;
	u64 due_ns; /* the period's begin */
	u64 elapsed_ns; /* since the last tick */
	u64 period_ns;
	s64 tip_nm[3];
	s64 proxy_nm[3];
	s32 target_un[3]; /* by contact */
	s32 force_un[3]; /* as sent */
	s32 normal_q30[3];
	u32 contacts;
	u32 flags; /* PHANTOM_TICK_... */
	u64 blend_ns; /* something changed that needs a fade of that length; 0 = nothing */
	struct phantom_slot *outgoing; /* the set before, of another geometry; else NULL */
	u32 reshaped; /* the frames in which it was another: phantom_set_reshaped() */
	u32 low; /* frames in which the tip outside has used up half of the coverage's slack */
	u64 most; /* the largest force of a frame, squared, and the body that it is of: */
	u32 leader;
};

struct phantom_servo {
	/* fixed */
	u32 unit; /* N of /dev/phantom_rtN, for traces; the owner's to set after init */
	struct phantom_clock *clock;
	struct phantom_device *device; /* NULL: there is none */
	/* NULL: not offered; FLOAT always is */
	const struct phantom_float_ops *ops[PHANTOM_ARITHS];
	u64 features; /* PHANTOM_FEATURE_... */

	struct mutex control; /* one at a time changes the servo */

	/* control */
	struct phantom_limits limits; /* of this run, as START asked for them */
	bool asleep; /* between suspend() and resume(): a run has no thread */

	/* word, control */
	u32 rate_hz;
	u64 model; /* packed, one byte a field: phantom_model_pack() */

	/* word, submitter */
	u32 prepare_max_ns; /* longest float section of a submission */

	/* word, anyone, once */
	u32 unplugged; /* the device is gone for good */

	/* request */
	u32 stop_wanted; /* 0 or PHANTOM_WISH_... */
	u32 clear_wanted;

	/* word, servo while it runs, else control */
	struct task_struct *thread; /* the servo thread; NULL while there is none */
	u32 state; /* PHANTOM_STATE_... */
	u32 faults; /* latched */
	u32 causes; /* of the last tick */
	u32 ended; /* the run is over without STOP: unplugged. Release/acquire */
	u32 events; /* counts what POLLPRI tells */
	u32 runs; /* runs ended */

	/* own */
	struct phantom_sets sets;
	struct phantom_stats stats;
	wait_queue_head_t wait; /* woken by records, events, the end of a run */

	/* run */
	struct phantom_safety safety;
	struct phantom_fade fade;
	struct phantom_body body[PHANTOM_BODIES];
	struct phantom_slot *active; /* the set in use */
	u64 active_model; /* packed */
	u64 stale_ns;
	u64 crossfade_ns; /* from one geometry to another */
	u64 next_ns; /* begin of the next period */
	u64 last_ns; /* time of the last tick */
	u64 busy_ns; /* what the last tick took */
	u64 woken_ns; /* when readers were woken last */
	u64 reminded_ns; /* when POLLPRI was raised last for want of a set */
	bool reached; /* the last tick's force was computed, not faded out */
	bool warned; /* half of the set's slack is used up, and was told */
	struct phantom_float_job job;
};

/*
 * patches_max: PHANTOM_PATCHES_MAX, or more in user mode. ops: by arithmetic; all but FLOAT's may be
 * NULL. 0 or -errno.
 * The servo owns neither clock nor device. Process context, as destroy().
 */
int phantom_servo_init(struct phantom_servo *servo, struct phantom_clock *clock,
		       struct phantom_device *device,
		       const struct phantom_float_ops *const ops[PHANTOM_ARITHS], u32 patches_max);
/* Not running. */
void phantom_servo_destroy(struct phantom_servo *servo);

/* ---- control; errors as phantom_abi.h says ------------------------------- */
int phantom_servo_start(struct phantom_servo *servo, const struct phantom_start *start);
/*
 * Sleeps until the force has ramped to zero and nothing of the servo runs. ABANDON is for a feeder
 * that closed or died: nobody chooses triangles any more, so the ramp is PHANTOM_ABANDON_NS at most.
 */
#define PHANTOM_WISH_STOP 1
#define PHANTOM_WISH_ABANDON 2
void phantom_servo_stop(struct phantom_servo *servo, u32 wish);
int phantom_servo_clear_fault(struct phantom_servo *servo);
int phantom_servo_set_rate(struct phantom_servo *servo, u32 rate_hz);
int phantom_servo_set_model(struct phantom_servo *servo, const struct phantom_model *model);
/*
 * The device is gone for good: a run latches PHANTOM_FAULT_UNPLUGGED, sends zero and ends by itself;
 * STOP or close still has to end it for control. Waiting readers and pollers wake. Any context.
 */
void phantom_servo_unplug(struct phantom_servo *servo);
/* The feeder has gone: no set, no contact state. Not running. */
void phantom_servo_forget(struct phantom_servo *servo);
/*
 * The machine goes to sleep: ramps down as ABANDON does, ends the thread, switches the device off and
 * latches PHANTOM_FAULT_SUSPENDED; nothing to do in IDLE. It has woken up: device and thread are
 * there again, the force stays zero until CLEAR_FAULT. Neither counts as missed ticks.
 */
void phantom_servo_suspend(struct phantom_servo *servo);
/* 0; -errno: device or thread could not be started again, the run is over (IDLE, fault latched). */
int phantom_servo_resume(struct phantom_servo *servo);

/* ---- file ---------------------------------------------------------------- */
/* `user` points to a struct phantom_set in the caller's memory. Becomes submitter. */
int phantom_servo_submit(struct phantom_servo *servo, const void __user *user);

/* ---- between phantom_control.c and phantom_servo.c ----------------------- */
static inline u64 phantom_model_pack(const struct phantom_model *model)
{
	return (u64)model->model | (u64)model->newton_steps << 8 | (u64)model->combine << 16 |
	       (u64)model->proxy << 24 | (u64)model->arith << 32;
}

static inline void phantom_model_unpack(u64 packed, struct phantom_model *model)
{
	memset(model, 0, sizeof(*model));
	model->model = packed & 0xff;
	model->newton_steps = packed >> 8 & 0xff;
	model->combine = packed >> 16 & 0xff;
	model->proxy = packed >> 24 & 0xff;
	model->arith = packed >> 32 & 0xff;
}

/* Converts sets.copy into the slot, one float section per PHANTOM_FLOAT_PREPARE_MAX. Submitter. */
void phantom_servo_prepare(struct phantom_servo *servo, struct phantom_slot *slot);
/* The contact that the job asks for, in as many float sections as it takes. Servo thread. */
void phantom_servo_float_tick(struct phantom_servo *servo, const struct phantom_float_ops *ops);
/* Time begins now, the first tick comes one period later. Run state. */
void phantom_servo_set_clock(struct phantom_servo *servo);

/* ---- for clocks only ----------------------------------------------------- */
/* The calling thread is the servo thread until leave(). run() does both. */
void phantom_servo_enter(struct phantom_servo *servo);
void phantom_servo_leave(struct phantom_servo *servo);
/* Becomes the servo thread and ticks until stopped. */
void phantom_servo_run(struct phantom_servo *servo);
/* One tick and the choice of the next period, at servo->next_ns. False: the run is over. Servo. */
bool phantom_servo_step(struct phantom_servo *servo);

#endif /* PHANTOM_SERVO_H */
