/* SPDX-License-Identifier: GPL-2.0-only */
/*
 * phantom_usermode.h - the module as a library: the same sources, another seam.
 *
 * A machine is one phantom_rt device with its character device. Calls mirror the system calls
 * on /dev/phantom_rt0 and return what they would: >= 0, or -errno. Structures are those of
 * phantom_abi.h, unchanged.
 *
 * Clock: REAL runs the servo in a thread of its own (SCHED_FIFO where the system allows it) on
 * CLOCK_MONOTONIC. VIRTUAL has no thread and no time but what phantom_um_step() adds: 10,000 ticks
 * take as long as they compute, and the same calls give the same records.
 *
 * Threads: every call but create, destroy and step may come from any thread at any time.
 */
#ifndef PHANTOM_USERMODE_H
#define PHANTOM_USERMODE_H

#include <stddef.h>
#include <stdint.h>
#include <sys/types.h>

#include "phantom_abi.h"

#ifdef __cplusplus
extern "C" {
#endif

#define PHANTOM_UM_CLOCK_REAL 0
#define PHANTOM_UM_CLOCK_VIRTUAL 1

struct phantom_um_config {
	uint32_t clock; /* PHANTOM_UM_CLOCK_... */
	uint32_t rate_hz; /* 0 = 1000 */
	int32_t cpu; /* pin the servo to that CPU; -1 = do not */
	uint32_t max_force_un; /* the simulated device's; 0 = 10 N */
	uint32_t isa; /* PHANTOM_ISA_..., NONE = the best the CPU has; DOUBLE allows arith=double */
	uint32_t patches_max; /* 0 = PHANTOM_PATCHES_MAX; larger for a whole mesh */
};

struct phantom_um; /* a machine */
struct phantom_um_file; /* an open file of it */

/* NULL and *error = -ENOMEM, -EINVAL (unknown clock or isa, or one this CPU has not). */
struct phantom_um *phantom_um_create(const struct phantom_um_config *config, int *error);
/* Every file must be closed. */
void phantom_um_destroy(struct phantom_um *machine);

/* flags: O_RDONLY or O_RDWR, with O_NONBLOCK or not. NULL and *error = -EBUSY, ... */
struct phantom_um_file *phantom_um_open(struct phantom_um *machine, int flags, int *error);
int phantom_um_close(struct phantom_um_file *file);
int phantom_um_ioctl(struct phantom_um_file *file, unsigned long request, void *argument);
/* The status page. Read-only memory, valid until close. NULL and *error on failure. */
const struct phantom_status *phantom_um_mmap(struct phantom_um_file *file, int *error);
ssize_t phantom_um_read(struct phantom_um_file *file, void *buffer, size_t size);
/* Like poll() on one file: the revents, 0 after timeout_ms (-1 = for ever), or -errno. */
int phantom_um_poll(struct phantom_um_file *file, short events, int timeout_ms);

/*
 * VIRTUAL only: run that many ticks now, in this thread. -EINVAL on a REAL machine, -EAGAIN when
 * not started. Returns the ticks run. Each tick sees the time of its own period's begin.
 */
int phantom_um_step(struct phantom_um *machine, uint32_t ticks);

/*
 * VIRTUAL only: another machine's run, tick by tick from its records. set_time() before START
 * says when that run began. replay() runs the tick that left this record: at its time, of the
 * period that began at due_ns, with its tip, and with the STOP, CLEAR_FAULT or error of the device
 * that came to it. Sets, rate and model are given by the calls, before it. A run that has
 * ended is ended here too by PHANTOM_STOP. -EINVAL on a REAL machine, -EAGAIN when not started or
 * the run is over, else 1.
 */
int phantom_um_set_time(struct phantom_um *machine, uint64_t now_ns);
int phantom_um_replay(struct phantom_um *machine, const struct phantom_tick *record,
		      uint64_t due_ns);

/*
 * The float sections (phantom_float.h) that this CPU can run: the best in float32 first, NULL last.
 * For tests and benchmarks, which call them without a machine.
 */
struct phantom_float_ops;
const struct phantom_float_ops *const *phantom_um_sections(void);

/* For reports: what the servo thread got. */
struct phantom_um_thread_info {
	int32_t fifo; /* 1 = SCHED_FIFO, 0 = the system did not allow it, -errno = not started */
	int32_t cpu; /* pinned to, or -1 */
};
void phantom_um_thread(const struct phantom_um *machine, struct phantom_um_thread_info *info);

/* What the kernel's module does before the machine goes to sleep, and when it has woken up. */
void phantom_um_suspend(struct phantom_um *machine);
int phantom_um_resume(struct phantom_um *machine);

/*
 * Tests only. The next tick comes that much later (either clock). The device answers every read
 * with that -errno until told 0; -ENODEV is an unplugged one. The nth allocation from now on in
 * the calling thread fails, once; 0 = none.
 */
void phantom_um_inject_stall(struct phantom_um *machine, uint64_t ns);
void phantom_um_inject_device_error(struct phantom_um *machine, int error);
void phantom_um_inject_allocation_failure(uint32_t nth);

#ifdef __cplusplus
}
#endif

#endif /* PHANTOM_USERMODE_H */
