// SPDX-License-Identifier: GPL-2.0-or-later
/*
 * trace_file.h - what the guest hands out and replay/ computes again: runs of the real module, each as
 *
 *     struct trace_run
 *     set_count times:    struct phantom_set, its patches, materials, objects (pointers mean nothing)
 *     record_count times: struct phantom_tick, every tick from the first on
 *
 * one run behind the other, everything as it lies in memory (both sides are x86-64).
 */
#ifndef VM_TRACE_FILE_H
#define VM_TRACE_FILE_H

#include "phantom_abi.h"

#define TRACE_MAGIC 0x52544850u /* "PHTR" */

/* Where the guest writes: QEMU's second isa-debugcon. */
#define TRACE_PORT 0xea

struct trace_run {
    __u32 magic;
    __u32 rate_hz;
    struct phantom_model model;
    __u32 isa; /* that the module used */
    __u32 set_count;
    __u32 record_count;
    __u32 reserved;
};

#endif /* VM_TRACE_FILE_H */
