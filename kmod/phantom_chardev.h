/* SPDX-License-Identifier: GPL-2.0-only */
/*
 * phantom_chardev.h - the calls on /dev/phantom_rt0: checks, and nothing of what they ask for.
 *
 * phantom_node.c hangs these functions into a struct file_operations, the user-mode build into a
 * C API. Context "file" of phantom_servo.h: process context, no mutex held; the table of commands
 * says which are called as "control". Errors as phantom_abi.h says.
 */
#ifndef PHANTOM_CHARDEV_H
#define PHANTOM_CHARDEV_H

#include <phantom_platform.h>
#include "phantom_servo.h"

struct phantom_chardev {
	struct phantom_servo *servo; /* fixed */
	struct phantom_file *feeder; /* under servo->control */
	u32 gone; /* the device was unplugged, for good; one word */
};

struct phantom_file {
	struct phantom_chardev *chardev; /* fixed */
	bool feeding; /* opened for writing; fixed */
	struct mutex reading; /* one reader at a time on one file */
	u64 cursor; /* next record to read; written under reading, one word for poll */
	u32 events_told; /* servo->events when this file last answered; one word */
	u32 runs_told; /* servo->runs when read() last told the end; one word */
};

void phantom_chardev_init(struct phantom_chardev *chardev, struct phantom_servo *servo);

/*
 * The device is gone for good. From here on every call answers -ENODEV (read after the records that
 * are left), waiting ones return, poll tells EPOLLHUP | EPOLLERR, a running servo latches
 * PHANTOM_FAULT_UNPLUGGED and ends. Mappings and close go on as before. Any context that may sleep;
 * waits for nobody.
 */
void phantom_chardev_unplug(struct phantom_chardev *chardev);
/*
 * The arm rests in its rest pose: tells its encoders. 0, -EBUSY while the servo runs, -ENODEV,
 * -EOPNOTSUPP for a device without joints. Sleeps.
 */
int phantom_chardev_calibrate(struct phantom_chardev *chardev);

struct phantom_file *phantom_chardev_open(struct phantom_chardev *chardev, bool feeding);
/* The feeder's: ramps to zero, then forgets sets and contact. Sleeps. */
void phantom_chardev_release(struct phantom_file *file);
long phantom_chardev_ioctl(struct phantom_file *file, unsigned int command, void __user *argument);
ssize_t phantom_chardev_read(struct phantom_file *file, char __user *buffer, size_t size,
			     bool nonblocking);
/*
 * EPOLLIN | EPOLLRDNORM, EPOLLPRI, EPOLLHUP | EPOLLERR; the caller waits on chardev->servo->wait.
 * Any context.
 */
__poll_t phantom_chardev_poll(struct phantom_file *file);
/* 0, -ENODEV, -EPERM or -EINVAL for a mapping of so many bytes at that offset. */
int phantom_chardev_check_mmap(const struct phantom_file *file, bool write_or_execute, u64 offset,
			       u64 size);

#endif /* PHANTOM_CHARDEV_H */
