// SPDX-License-Identifier: GPL-2.0-only
/*
 * clock_real.c - a pthread on CLOCK_MONOTONIC: SCHED_FIFO and pinned where the system allows it.
 */
#define _GNU_SOURCE
#include <sched.h>
#include <time.h>

#include <phantom_platform.h>
#include "clocks.h"
#include "phantom_servo.h"

/* Above threaded interrupt handlers (50), below what keeps the machine alive (99). */
#define REAL_CLOCK_PRIORITY 80

static struct phantom_real_clock *real_of(struct phantom_clock *clock)
{
	return container_of(clock, struct phantom_real_clock, clock);
}

static u64 real_now(struct phantom_clock *clock)
{
	(void)clock;
	return ktime_get_ns();
}

static bool real_sleep_until(struct phantom_clock *clock, u64 deadline_ns)
{
	struct phantom_real_clock *real = real_of(clock);
	u64 until = deadline_ns + xchg(&real->stall_ns, 0);
	struct timespec deadline = {
		.tv_sec = (time_t)(until / NSEC_PER_SEC),
		.tv_nsec = (long)(until % NSEC_PER_SEC),
	};

	while (clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &deadline, NULL) == EINTR)
		;
	return !READ_ONCE(real->abandon);
}

/* The scheduling that the servo wants; without the right to it the machine still works. */
static s32 real_become_realtime(void)
{
	struct sched_param parameters = {.sched_priority = REAL_CLOCK_PRIORITY};

	return pthread_setschedparam(pthread_self(), SCHED_FIFO, &parameters) == 0;
}

static void *real_thread(void *argument)
{
	struct phantom_real_clock *real = argument;

	pthread_setname_np(pthread_self(), "phantom-servo");
	WRITE_ONCE(real->fifo, real_become_realtime());
	phantom_servo_run(real->servo);
	WRITE_ONCE(real->over, 1U);
	if (wq_has_sleeper(&real->wait))
		wake_up_interruptible(&real->wait);
	return NULL;
}

static int real_pin(const struct phantom_real_clock *real, pthread_attr_t *attributes)
{
	cpu_set_t cpus;

	if (real->cpu < 0)
		return 0;
	if (real->cpu >= CPU_SETSIZE)
		return -EINVAL;
	CPU_ZERO(&cpus);
	CPU_SET(real->cpu, &cpus);
	return -pthread_attr_setaffinity_np(attributes, sizeof(cpus), &cpus);
}

static int real_start(struct phantom_clock *clock, struct phantom_servo *servo)
{
	struct phantom_real_clock *real = real_of(clock);
	pthread_attr_t attributes;
	int error;

	real->servo = servo;
	real->over = 0;
	real->abandon = 0;
	pthread_attr_init(&attributes);
	error = real_pin(real, &attributes);
	if (!error)
		error = -pthread_create(&real->thread, &attributes, real_thread, real);
	pthread_attr_destroy(&attributes);
	if (error)
		WRITE_ONCE(real->fifo, error);
	return error;
}

static void real_stop(struct phantom_clock *clock, struct phantom_servo *servo, u64 timeout_ns)
{
	struct phantom_real_clock *real = real_of(clock);
	u64 deadline = ktime_get_ns() + timeout_ns;

	(void)servo;
	phantom_platform_wait_begin(&real->wait);
	while (!READ_ONCE(real->over))
		if (!phantom_platform_wait(&real->wait, deadline))
			break;
	phantom_platform_wait_end(&real->wait);
	WRITE_ONCE(real->abandon, 1U);
	pthread_join(real->thread, NULL);
}

static const struct phantom_clock_ops real_clock_ops = {
	.now_ns = real_now,
	.start = real_start,
	.sleep_until = real_sleep_until,
	.stop = real_stop,
};

void phantom_real_clock_init(struct phantom_real_clock *real, int cpu)
{
	memset(real, 0, sizeof(*real));
	real->clock.ops = &real_clock_ops;
	real->cpu = cpu;
	real->fifo = -EAGAIN;
	init_waitqueue_head(&real->wait);
}

void phantom_real_clock_destroy(struct phantom_real_clock *real)
{
	phantom_platform_wait_destroy(&real->wait);
}
