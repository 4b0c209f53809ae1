/* SPDX-License-Identifier: GPL-2.0-only */
/*
 * phantom_device.h - a haptic device as the servo sees it: a tip position comes out, a force goes
 * in.
 *
 * Every back end is one file in this folder with one ops table. It knows this header and the
 * platform, nothing else of the module.
 */
#ifndef PHANTOM_DEVICE_H
#define PHANTOM_DEVICE_H

#include <phantom_platform.h>
#include "float/phantom_linkage.h"
#include "phantom_abi.h"

struct phantom_device;

struct phantom_device_ops {
	const char *name;
	u32 kind; /* PHANTOM_DEVICE_... */
	/* Amplifier on, force zero. 0 or -errno. Process context, control mutex held. */
	int (*start)(struct phantom_device *device);
	/* Amplifier off. Process context, after the last tick. */
	void (*stop)(struct phantom_device *device);
	/*
	 * Newest tip position in nm, device frame = world frame. 0, -ENODEV when the device is
	 * gone, or another -errno. Servo thread: may not wait for the device. A device with a
	 * linkage puts its newest encoder counts there instead; the servo makes the tip of them.
	 */
	int (*read)(struct phantom_device *device, s64 tip_nm[3]);
	/*
	 * Force in uN. Same errors and context. Zero must always be accepted. In a linkage stand
	 * the motor currents of this force, unless it is zero: that means no current, and may also
	 * come from control.
	 */
	int (*write)(struct phantom_device *device, const s32 force_un[3]);
	/* Simulated devices only, else NULL: where the tip is from the next read on. Any thread. */
	void (*move)(struct phantom_device *device, const s64 tip_nm[3]);
	/*
	 * Devices with encoders that count from where they were switched on, else NULL: the arm
	 * is in its rest pose now. 0 or -errno. Process context, control mutex held, idle.
	 */
	int (*calibrate)(struct phantom_device *device);
	/* The last call. */
	void (*destroy)(struct phantom_device *device);
};

/* Filled in by the back end when it creates the device; constant but for what linkage points to. */
struct phantom_device {
	const struct phantom_device_ops *ops;
	const char *model; /* what a person calls it, one word */
	struct phantom_linkage *linkage; /* run state; NULL: the device knows its tip itself */
	s32 workspace_min_nm[3];
	s32 workspace_max_nm[3];
	u32 max_force_un;
	u32 continuous_force_un; /* 0 = not known */
	u32 resolution_nm; /* 0 = not known */
	u32 rate_hz; /* 0 = answers every tick */
};

/* The most that a device may declare: keeps the integer arithmetic of phantom_safety.c in range. */
#define PHANTOM_DEVICE_FORCE_MAX_UN 100000000 /* 100 N */

/* ERR_PTR(-ENOMEM), ERR_PTR(-EINVAL) for a force of 0 or above PHANTOM_DEVICE_FORCE_MAX_UN. */
struct phantom_device *phantom_device_sim_create(u32 max_force_un);

#endif /* PHANTOM_DEVICE_H */
