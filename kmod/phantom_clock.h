/* SPDX-License-Identifier: GPL-2.0-only */
/*
 * phantom_clock.h - time and thread of a servo, injected.
 *
 * The kernel's clock (phantom_clock.c) is a SCHED_FIFO thread pinned to a CPU that sleeps to
 * absolute deadlines. User mode has the same with pthreads, and a virtual one without a thread:
 * whoever steps it is the servo thread for that long.
 */
#ifndef PHANTOM_CLOCK_H
#define PHANTOM_CLOCK_H

#include <phantom_platform.h>

struct phantom_clock;
struct phantom_servo;

struct phantom_clock_ops {
	/* ns, CLOCK_MONOTONIC or a clock like it. Any context. */
	u64 (*now_ns)(struct phantom_clock *clock);
	/* Begins to run phantom_servo_run(servo). 0 or -errno. Process context. */
	int (*start)(struct phantom_clock *clock, struct phantom_servo *servo);
	/* Sleeps until then; false when the thread has to end at once. Servo thread. */
	bool (*sleep_until)(struct phantom_clock *clock, u64 deadline_ns);
	/*
	 * The servo has been asked to stop: gives it timeout_ns to ramp down, then ends the run
	 * whether it has or not. On return nothing of the servo runs. Process context, sleeps.
	 */
	void (*stop)(struct phantom_clock *clock, struct phantom_servo *servo, u64 timeout_ns);
};

struct phantom_clock {
	const struct phantom_clock_ops *ops;
};

#endif /* PHANTOM_CLOCK_H */
