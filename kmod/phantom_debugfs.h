/* SPDX-License-Identifier: GPL-2.0-only */
/*
 * phantom_debugfs.h - /sys/kernel/debug/phantom_rt/phantom_rtN/: a servo for a person to read.
 *
 *   status       the status page in words
 *   histograms   latency, duration and float sections: percentiles, then every bucket that counts
 *   set          the set in use, and the memory of the unit
 *
 * Reading disturbs nobody: no file takes a lock that the servo or control takes. An open file keeps
 * the module; a file of a unit that has gone reads as EIO. No text here is an interface: programs
 * use phantom_abi.h. All of it is left out, silently, where the kernel has no debugfs.
 */
#ifndef PHANTOM_DEBUGFS_H
#define PHANTOM_DEBUGFS_H

#include <phantom_platform.h>
#include "phantom_servo.h"

/* Process context, all four. The module's folder, at load and unload. */
void phantom_debugfs_init(void);
void phantom_debugfs_exit(void);

/* A unit's folder. remove() returns when no reader is inside; NULL is nothing to do. */
struct dentry *phantom_debugfs_add(const char *name, struct phantom_servo *servo);
void phantom_debugfs_remove(struct dentry *folder);

#endif /* PHANTOM_DEBUGFS_H */
