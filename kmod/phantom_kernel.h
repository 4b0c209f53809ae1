/* SPDX-License-Identifier: GPL-2.0-only */
/*
 * phantom_kernel.h - what only the kernel build has: its clock and its device node.
 */
#ifndef PHANTOM_KERNEL_H
#define PHANTOM_KERNEL_H

#include <phantom_platform.h>
#include "phantom_chardev.h"
#include "phantom_clock.h"

struct phantom_kernel_clock {
	struct phantom_clock clock;
	int cpu; /* fixed; -1 = the last one online when the servo starts */
	struct phantom_servo *servo; /* control mutex */
	struct task_struct *thread; /* control mutex */
	struct completion over; /* the run has ended by itself */
};

void phantom_kernel_clock_init(struct phantom_kernel_clock *kernel, int cpu);

/* /dev/phantom_rt0. The character device must outlive the node. */
struct phantom_node {
	struct miscdevice misc;
	struct phantom_chardev *chardev;
};

int phantom_node_register(struct phantom_node *node, struct phantom_chardev *chardev);
void phantom_node_unregister(struct phantom_node *node);

#endif /* PHANTOM_KERNEL_H */
