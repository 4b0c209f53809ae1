// SPDX-License-Identifier: GPL-2.0-or-later
/*
 * arm_machine.h - a WoodenHaptics arm on a link that a test plays, behind a whole servo on a virtual clock.
 * C, because the module's own headers are.
 */
#ifndef PHANTOM_TEST_ARM_MACHINE_H
#define PHANTOM_TEST_ARM_MACHINE_H

#include <stddef.h>
#include <stdint.h>
#include <sys/types.h>

#include "phantom_abi.h"

#ifdef __cplusplus
extern "C" {
#endif

#define ARM_COMMAND_BYTES 14

struct arm_machine; /* opened once, by its feeder */

/* NULL without memory. */
struct arm_machine* arm_machine_create(uint32_t max_force_un);
void arm_machine_destroy(struct arm_machine* machine);

/* ---- the firmware ---- */
/* Reports these counts before every tick from now on. */
void arm_machine_move(struct arm_machine* machine, const int16_t encoder[3]);
void arm_machine_mute(struct arm_machine* machine, int mute);
/* Takes no commands, or answers each with this error. */
void arm_machine_deafen(struct arm_machine* machine, int deaf, int error);
/* The next flush sends twice, and the first of them fails so. */
void arm_machine_fail_once(struct arm_machine* machine, int error);
/* One report of these bytes now: 0 or -errno. */
int arm_machine_receive(struct arm_machine* machine, const uint8_t* report, size_t size);
/* The newest command; also one that nobody has taken yet. */
void arm_machine_command(struct arm_machine* machine, uint8_t command[ARM_COMMAND_BYTES]);
void arm_machine_currents(struct arm_machine* machine, int16_t current_ma[3]);
void arm_machine_unplug(struct arm_machine* machine);

/* ---- the module ---- */
int arm_machine_ioctl(struct arm_machine* machine, unsigned long request, void* argument);
ssize_t arm_machine_read(struct arm_machine* machine, void* buffer, size_t size);
int arm_machine_poll(struct arm_machine* machine);
/* 0 or -errno, of a second file. */
int arm_machine_open_again(struct arm_machine* machine);
int arm_machine_check_mmap(struct arm_machine* machine);
int arm_machine_calibrate(struct arm_machine* machine);
/* Ticks run. */
int arm_machine_step(struct arm_machine* machine, uint32_t ticks);
const struct phantom_status* arm_machine_status(const struct arm_machine* machine);

/* ---- the parts alone ---- */
/* As the servo writes a force whose currents are these (0 or -errno), after so much time. */
int arm_machine_drive(struct arm_machine* machine, const int32_t current_ma[3], uint64_t later_ns);
void arm_machine_drive_zero(struct arm_machine* machine);
/* The linkage's two functions, with the arm's geometry. */
void arm_pose(const int32_t encoder[3], int32_t tip_nm[3]);
void arm_drive(const int32_t encoder[3], const int32_t force_un[3], int32_t current_ma[3]);
/* Sine and cosine of numerator / denominator turns, as the linkage computes them. */
void arm_sine_cosine(int64_t numerator, int64_t denominator, double* sine, double* cosine);

#ifdef __cplusplus
}
#endif

#endif /* PHANTOM_TEST_ARM_MACHINE_H */
