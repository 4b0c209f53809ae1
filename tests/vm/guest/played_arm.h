// SPDX-License-Identifier: GPL-2.0-or-later
/*
 * played_arm.h - a WoodenHaptics arm played through /dev/uhid: it reports encoder counts a thousand times
 * a second and takes commands, as the firmware does. What is tested against is computed here once
 * more, in long double with libm, from the arm's published equations.
 */
#ifndef VM_PLAYED_ARM_H
#define VM_PLAYED_ARM_H

#include <pthread.h>
#include <stdbool.h>
#include <stdint.h>

/* Positions in a command. */
enum { ARM_CURRENT = 0, ARM_COMMAND = 3, ARM_ATTRIBUTE = 4, ARM_WORDS = 7 };

struct vm_arm {
    int fd;
    uint32_t usage; /* of its application; 0: the arm's own */
    pthread_t reporter, listener;
    /* Atomic words. */
    uint32_t awake, leaving, mute;
    uint32_t reports, commands, presets, nonzero;
    uint64_t pose;    /* encoder counts since it was built, three times 16 bits */
    uint64_t preset;  /* what they were, less what they were told to be */
    uint64_t current; /* of the last command, three times 16 bits */
};

/* Plugs it in; it stands still, motors counted from where it is. */
void vm_arm_plug(struct vm_arm* arm);
/* Pulls the cable. */
void vm_arm_unplug(struct vm_arm* arm);
/* Moves it there: encoder counts as the firmware would report them after the last preset. */
void vm_arm_move(struct vm_arm* arm, const int16_t encoder[3]);
/* No reports while muted. */
void vm_arm_mute(struct vm_arm* arm, bool mute);
/* Currents of the last command, in mA. */
void vm_arm_currents(const struct vm_arm* arm, int16_t current_ma[3]);
uint32_t vm_arm_commands(const struct vm_arm* arm);
/* Waits until that many more commands have come; fails after five seconds. */
void vm_arm_wait_commands(const struct vm_arm* arm, uint32_t more);

/* ---- what is true of such an arm ---- */

/* Tip in nm at these counts, unrounded. */
void vm_arm_tip(const int16_t encoder[3], long double tip_nm[3]);
/* The nearest counts to a tip, elbow up; false when it is out of reach. */
bool vm_arm_reach(const long double tip_nm[3], int16_t encoder[3]);
/* Motor currents in mA that hold against that force, from the tip's derivative by central differences. */
void vm_arm_expect(const int16_t encoder[3], const int32_t force_un[3], long double current_ma[3]);

#endif /* VM_PLAYED_ARM_H */
