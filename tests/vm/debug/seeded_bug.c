// SPDX-License-Identifier: GPL-2.0-or-later
/*
 * A module that commits one bug, for tools/vm-debug: each mistake that a haptic servo could make must be caught by
 * the debug kernel, or a silent run of the suite on it would mean nothing. Never part of phantom_rt.
 *
 *     insmod seeded_bug.ko bug=NAME
 */
#include <linux/delay.h>
#include <linux/hrtimer.h>
#include <linux/module.h>
#include <linux/slab.h>
#include <linux/spinlock.h>
#include <asm/fpu/api.h>

static char *bug = "";
module_param(bug, charp, 0444);
MODULE_PARM_DESC(bug, "which one");

static DEFINE_SPINLOCK(sleeping_lock); /* on PREEMPT_RT */
static DEFINE_RAW_SPINLOCK(spinning_lock);
static struct hrtimer timer;

/* Nothing: the kernel must not complain about this either. */
static void none(void)
{
	kernel_fpu_begin();
	kernel_fpu_end();
	kfree(kmalloc(32, GFP_KERNEL));
}

static void sleep_in_section(void)
{
	kernel_fpu_begin();
	msleep(20);
	kernel_fpu_end();
}

static void nested_section(void)
{
	kernel_fpu_begin();
	kernel_fpu_begin();
	kernel_fpu_end();
	kernel_fpu_end();
}

static void lock_in_section(void)
{
	kernel_fpu_begin();
	spin_lock(&sleeping_lock);
	spin_unlock(&sleeping_lock);
	kernel_fpu_end();
}

static enum hrtimer_restart lock_in_interrupt(struct hrtimer *expired)
{
	spin_lock(&sleeping_lock);
	spin_unlock(&sleeping_lock);
	return HRTIMER_NORESTART;
}

static void lock_in_hard_timer(void)
{
	hrtimer_init(&timer, CLOCK_MONOTONIC, HRTIMER_MODE_REL_HARD);
	timer.function = lock_in_interrupt;
	hrtimer_start(&timer, ms_to_ktime(1), HRTIMER_MODE_REL_HARD);
	msleep(20);
	hrtimer_cancel(&timer);
}

static void allocation_under_raw_lock(void)
{
	unsigned long flags;
	void *memory;

	raw_spin_lock_irqsave(&spinning_lock, flags);
	memory = kmalloc(64, GFP_ATOMIC);
	raw_spin_unlock_irqrestore(&spinning_lock, flags);
	kfree(memory);
}

static void out_of_bounds(void)
{
	char *memory = kmalloc(32, GFP_KERNEL);

	if (!memory)
		return;
	OPTIMIZER_HIDE_VAR(memory); /* or the compiler would find it */
	memory[34] = 1;
	kfree(memory);
}

static void leak(void)
{
	void *memory = kmalloc(77, GFP_KERNEL);

	OPTIMIZER_HIDE_VAR(memory); /* or the allocation would be optimised away */
}

static void shift_too_far(void)
{
	int by = 40;

	OPTIMIZER_HIDE_VAR(by);
	pr_info("%d\n", 1 << by);
}

static const struct {
	const char *name;
	void (*commit)(void);
} bugs[] = {
	{"none", none},
	{"sleep_in_section", sleep_in_section},
	{"nested_section", nested_section},
	{"lock_in_section", lock_in_section},
	{"lock_in_hard_timer", lock_in_hard_timer},
	{"allocation_under_raw_lock", allocation_under_raw_lock},
	{"out_of_bounds", out_of_bounds},
	{"leak", leak},
	{"shift_too_far", shift_too_far},
};

static int __init seeded_bug_init(void)
{
	for (size_t i = 0; i < ARRAY_SIZE(bugs); i++)
		if (strcmp(bug, bugs[i].name) == 0) {
			bugs[i].commit();
			return 0;
		}
	return -EINVAL;
}
module_init(seeded_bug_init);

static void __exit seeded_bug_exit(void)
{
}
module_exit(seeded_bug_exit);

MODULE_DESCRIPTION("One bug, to be caught");
MODULE_LICENSE("GPL");
