// SPDX-License-Identifier: GPL-2.0-or-later
/*
 * recording.h - recordings (userland/device/recording_format.h) handed out to the host, which computes them
 * again: `fdhctl replay`. One behind the other, through QEMU's second isa-debugcon.
 */
#ifndef VM_RECORDING_H
#define VM_RECORDING_H

#include <stdint.h>

#include "../../../userland/device/recording_format.h"

/* ---- one made here: begin, then starts, sets, ticks and marks in any order that the format allows, end ----
 */

/* Of that file, which feeds the module. scene: for people. */
void recording_begin(int fd, const char* scene);
/* After a START: the status page says when. */
void recording_started(const struct phantom_start* start, const struct phantom_status* status);
void recording_set(const struct phantom_set* set);
void recording_ticks(const struct phantom_tick* ticks, uint32_t count);
void recording_mark(const struct phantom_status* status);
void recording_end(void);

/* ---- one that fdhctl wrote ---- */
void recording_hand_out(const char* file);

#endif /* VM_RECORDING_H */
