// SPDX-License-Identifier: GPL-2.0-only
/*
 * phantom_clock.c - the kernel's clock: a SCHED_FIFO thread on one CPU that sleeps to absolute
 * deadlines.
 *
 * For a thread of a real-time policy schedule_hrtimeout_range() uses a hard timer on PREEMPT_RT,
 * too: the wake-up comes from the interrupt itself and waits for no softirq.
 */
#include <phantom_platform.h>
#include "phantom_kernel.h"
#include "phantom_servo.h"

/* Above threaded interrupt handlers (50), below what keeps the machine alive (99). */
#define PHANTOM_CLOCK_PRIORITY 80

static struct phantom_kernel_clock *phantom_clock_of(struct phantom_clock *clock)
{
	return container_of(clock, struct phantom_kernel_clock, clock);
}

static u64 phantom_clock_now(struct phantom_clock *clock)
{
	return ktime_get_ns();
}

static bool phantom_clock_sleep_until(struct phantom_clock *clock, u64 deadline_ns)
{
	ktime_t deadline = ns_to_ktime(deadline_ns);

	set_current_state(TASK_INTERRUPTIBLE);
	if (!kthread_should_stop())
		schedule_hrtimeout_range(&deadline, 0, HRTIMER_MODE_ABS);
	__set_current_state(TASK_RUNNING);
	return !kthread_should_stop();
}

static int phantom_clock_thread(void *argument)
{
	struct phantom_kernel_clock *kernel = argument;

	phantom_servo_run(kernel->servo);
	complete(&kernel->over);
	/* kthread_stop() wants a thread to stop */
	set_current_state(TASK_INTERRUPTIBLE);
	while (!kthread_should_stop()) {
		schedule();
		set_current_state(TASK_INTERRUPTIBLE);
	}
	__set_current_state(TASK_RUNNING);
	return 0;
}

static int phantom_clock_pin(const struct phantom_kernel_clock *kernel, struct task_struct *thread)
{
	unsigned int cpu = kernel->cpu;

	if (kernel->cpu < 0)
		cpu = cpumask_last(cpu_online_mask);
	if (cpu >= nr_cpu_ids || !cpu_online(cpu))
		return -EINVAL;
	kthread_bind(thread, cpu);
	return 0;
}

static int phantom_clock_start(struct phantom_clock *clock, struct phantom_servo *servo)
{
	struct sched_attr attributes = {
		.size = sizeof(attributes),
		.sched_policy = SCHED_FIFO,
		.sched_priority = PHANTOM_CLOCK_PRIORITY,
	};
	struct phantom_kernel_clock *kernel = phantom_clock_of(clock);
	struct task_struct *thread;
	int error;

	kernel->servo = servo;
	reinit_completion(&kernel->over);
	thread = kthread_create(phantom_clock_thread, kernel, "phantom-servo");
	if (IS_ERR(thread))
		return PTR_ERR(thread);
	cpus_read_lock();
	error = phantom_clock_pin(kernel, thread);
	cpus_read_unlock();
	if (!error)
		error = sched_setattr_nocheck(thread, &attributes);
	if (error) {
		/* a thread that never ran is stopped without having run */
		kthread_stop(thread);
		return error;
	}
	kernel->thread = thread;
	wake_up_process(thread);
	return 0;
}

static void phantom_clock_stop(struct phantom_clock *clock, struct phantom_servo *servo,
			       u64 timeout_ns)
{
	struct phantom_kernel_clock *kernel = phantom_clock_of(clock);

	if (!wait_for_completion_timeout(&kernel->over, nsecs_to_jiffies(timeout_ns) + 1))
		pr_warn("the force had not ramped to zero in time; the servo is ended all the same\n");
	kthread_stop(kernel->thread);
	kernel->thread = NULL;
}

static const struct phantom_clock_ops phantom_kernel_clock_ops = {
	.now_ns = phantom_clock_now,
	.start = phantom_clock_start,
	.sleep_until = phantom_clock_sleep_until,
	.stop = phantom_clock_stop,
};

void phantom_kernel_clock_init(struct phantom_kernel_clock *kernel, int cpu)
{
	kernel->clock.ops = &phantom_kernel_clock_ops;
	kernel->cpu = cpu;
	init_completion(&kernel->over);
}
