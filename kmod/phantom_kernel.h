/* SPDX-License-Identifier: GPL-2.0-only */
/*
 * phantom_kernel.h - what only the kernel build has: its clock, its units and their nodes.
 *
 * A UNIT is one device with everything that makes it touchable: clock, servo, character device,
 * /dev/phantom_rtN and /sys/class/phantom_rt/phantom_rtN. It lives by reference count: the driver
 * that found the device holds one reference until the device goes, every open file another. So a
 * file outlives the arm that was unplugged under it; its calls answer -ENODEV (phantom_chardev.h).
 */
#ifndef PHANTOM_KERNEL_H
#define PHANTOM_KERNEL_H

#include <phantom_platform.h>
#include "phantom_chardev.h"
#include "phantom_clock.h"
#include "phantom_power.h"

struct phantom_kernel_clock {
	struct phantom_clock clock;
	int cpu; /* fixed; -1 = the last one online when the servo starts */
	struct phantom_servo *servo; /* control mutex */
	struct task_struct *thread; /* control mutex */
	struct completion over; /* the run has ended by itself */
};

void phantom_kernel_clock_init(struct phantom_kernel_clock *kernel, int cpu);

/* Units at a time, those kept by a file included. */
#define PHANTOM_UNITS_MAX 16

struct phantom_unit {
	struct device dev; /* the reference count */
	struct cdev cdev;
	int number; /* N; fixed */
	struct phantom_device *device; /* owned; NULL: there is none */
	struct phantom_kernel_clock clock;
	struct phantom_servo servo;
	struct phantom_chardev chardev;
	struct phantom_power power;
	struct dentry *debugfs; /* its folder, from add to remove */
};

/* What the module's parameters say about every unit. Constant while it is loaded. */
struct phantom_unit_settings {
	u32 rate_hz;
	int cpu; /* as phantom_kernel_clock.cpu */
};

/* phantom_unit.c, process context. The class, and numbers for nodes; 0 or -errno. */
int phantom_unit_setup(const struct phantom_unit_settings *settings);
/* Every unit has been removed; waits for the last reference. */
void phantom_unit_cleanup(void);

/*
 * A unit round `device`, which it owns from here on; NULL makes a unit without a device. `parent` may be
 * NULL. The caller has one reference. ERR_PTR(-ENOMEM), -ENOSPC: no number is free.
 */
struct phantom_unit *phantom_unit_create(struct phantom_device *device, struct device *parent);
/* Node and class entry. 0 or -errno. */
int phantom_unit_add(struct phantom_unit *unit);
/*
 * The device is gone or about to go. Takes the node away, ends every call that waits, lets a running
 * servo end by itself.
 */
void phantom_unit_remove(struct phantom_unit *unit);
/* Gives up a reference. With the last one unit and device are freed. */
void phantom_unit_put(struct phantom_unit *unit);

/* phantom_node.c: the calls on /dev/phantom_rtN. */
extern const struct file_operations phantom_node_operations;
/* phantom_sysfs.c. In the order of the bits of PHANTOM_FAULT_... */
#define PHANTOM_FAULTS 6
extern const char *const phantom_fault_names[PHANTOM_FAULTS];

/* The files in /sys/class/phantom_rt/phantom_rtN. */
extern const struct attribute_group *phantom_sysfs_groups[];

/*
 * device/hid.c. Arms that come and go: each makes a unit when it is plugged in and removes it when it
 * goes. No arm is asked for more than max_force_un. 0 or -errno, -EOPNOTSUPP without HID in the kernel.
 */
#if IS_ENABLED(CONFIG_HID)
int phantom_hid_setup(u32 max_force_un);
void phantom_hid_cleanup(void);
#else
static inline int phantom_hid_setup(u32 max_force_un)
{
	return -EOPNOTSUPP;
}

static inline void phantom_hid_cleanup(void)
{
}
#endif

#endif /* PHANTOM_KERNEL_H */
