// SPDX-License-Identifier: GPL-2.0-only
/*
 * clock_virtual.c - no thread, and no time but what stepping adds: each tick sees the begin of
 * its own period, latencies and durations are 0, and the same calls give the same records.
 */
#include <phantom_platform.h>
#include "clocks.h"
#include "phantom_servo.h"

static struct phantom_virtual_clock *virtual_of(struct phantom_clock *clock)
{
	return container_of(clock, struct phantom_virtual_clock, clock);
}

static u64 virtual_now(struct phantom_clock *clock)
{
	return READ_ONCE(virtual_of(clock)->now_ns);
}

static int virtual_start(struct phantom_clock *clock, struct phantom_servo *servo)
{
	struct phantom_virtual_clock *virtual = virtual_of(clock);

	mutex_lock(&virtual->stepping);
	virtual->servo = servo;
	mutex_unlock(&virtual->stepping);
	return 0;
}

static bool virtual_sleep_until(struct phantom_clock *clock, u64 deadline_ns)
{
	struct phantom_virtual_clock *virtual = virtual_of(clock);

	WRITE_ONCE(virtual->now_ns, deadline_ns + xchg(&virtual->stall_ns, 0));
	return true;
}

/* One tick at the present time. Stepping held. False: the run is over. */
static bool virtual_tick(struct phantom_virtual_clock *virtual)
{
	struct phantom_servo *servo = virtual->servo;
	bool goes_on;

	phantom_servo_enter(servo);
	goes_on = phantom_servo_step(servo);
	phantom_servo_leave(servo);
	if (!goes_on)
		virtual->servo = NULL;
	return goes_on;
}

/* Stepping held. False: the run is over. */
static bool virtual_step(struct phantom_virtual_clock *virtual)
{
	struct phantom_servo *servo = virtual->servo;

	virtual_sleep_until(&virtual->clock, servo->next_ns);
	return virtual_tick(virtual);
}

/* Nobody else moves this clock on: the ramp is stepped here, as many ticks as the timeout has. */
static void virtual_stop(struct phantom_clock *clock, struct phantom_servo *servo, u64 timeout_ns)
{
	struct phantom_virtual_clock *virtual = virtual_of(clock);
	u64 deadline;

	mutex_lock(&virtual->stepping);
	deadline = virtual->now_ns + timeout_ns;
	while (virtual->servo && servo->next_ns <= deadline)
		virtual_step(virtual);
	virtual->servo = NULL;
	mutex_unlock(&virtual->stepping);
}

int phantom_virtual_clock_step(struct phantom_virtual_clock *virtual, u32 ticks)
{
	u32 done = 0;

	mutex_lock(&virtual->stepping);
	while (done < ticks && virtual->servo) {
		virtual_step(virtual);
		done++;
	}
	mutex_unlock(&virtual->stepping);
	return done || !ticks ? (int)done : -EAGAIN;
}

void phantom_virtual_clock_set(struct phantom_virtual_clock *virtual, u64 now_ns)
{
	mutex_lock(&virtual->stepping);
	WRITE_ONCE(virtual->now_ns, now_ns);
	mutex_unlock(&virtual->stepping);
}

/* Periods that the other machine skipped before this one are counted as skipped here. */
int phantom_virtual_clock_replay(struct phantom_virtual_clock *virtual, u64 tick, u64 now_ns,
				 u64 due_ns)
{
	struct phantom_servo *servo;

	mutex_lock(&virtual->stepping);
	servo = virtual->servo;
	if (servo) {
		WRITE_ONCE(virtual->now_ns, now_ns);
		servo->next_ns = due_ns;
		servo->stats.next.missed += tick - 1 - servo->stats.next.tick;
		servo->stats.next.tick = tick - 1;
		virtual_tick(virtual);
	}
	mutex_unlock(&virtual->stepping);
	return servo ? 1 : -EAGAIN;
}

static const struct phantom_clock_ops virtual_clock_ops = {
	.now_ns = virtual_now,
	.start = virtual_start,
	.sleep_until = virtual_sleep_until,
	.stop = virtual_stop,
};

void phantom_virtual_clock_init(struct phantom_virtual_clock *virtual)
{
	memset(virtual, 0, sizeof(*virtual));
	virtual->clock.ops = &virtual_clock_ops;
	mutex_init(&virtual->stepping);
}

void phantom_virtual_clock_destroy(struct phantom_virtual_clock *virtual)
{
	mutex_destroy(&virtual->stepping);
}
