/* SPDX-License-Identifier: GPL-2.0-only */
/*
 * arm.h - an arm that reports encoder counts and takes motor currents over a link (USB HID).
 *
 * The link's side posts what comes in and sends what is to go out, whenever its bus is ready; the
 * servo's side takes the newest report and leaves the newest currents. Neither waits for the other:
 *
 *     report  -> phantom_arm_receive() -> mailbox -> read(), linkage->pose()       servo
 *     command <- phantom_arm_command() <- mailbox <- write(), linkage->drive()     servo
 *
 * REPORTS of WoodenHaptics' HID firmware, 14 bytes, seven little-endian int16:
 *
 *     in    encoder a, b, c, d, e, f in counts, info
 *     out   current a, b, c in mA, command, attribute 0, 1, 2
 *
 * Command 0 is none; command 1 presets the encoders a, b, c to the attributes. Firmware that hears
 * nothing for half a second switches the motors off by itself.
 *
 * SAFETY. A report older than PHANTOM_ARM_SILENCE_NS, a command that could not be sent, and commands
 * that have not got through for PHANTOM_ARM_DEAF_NS are faults of the device while the servo runs.
 * Zero force is zero current. Currents are scaled down together, so that the direction of the force
 * stays, to what amplifier and windings bear (phantom_arm_motors).
 */
#ifndef PHANTOM_ARM_H
#define PHANTOM_ARM_H

#include <phantom_platform.h>
#include "device/mailbox.h"
#include "device/phantom_device.h"

#define PHANTOM_ARM_REPORT_BYTES 14
#define PHANTOM_ARM_COMMAND_BYTES 14

/* Ten reports at 1 kHz: what a loaded bus may swallow, less than a hand notices. */
#define PHANTOM_ARM_SILENCE_NS 10000000ULL

/* A fifth of the time after which the firmware switches the motors off. */
#define PHANTOM_ARM_DEAF_NS 100000000ULL

/*
 * Motors and amplifiers. A winding warms with the square of its current and cools with its time
 * constant; its mean square i^2 is tracked by  d(i^2)/dt = (current^2 - i^2) / winding_us.  The most
 * that may be sent falls from peak to continuous as i^2 goes from 80 % to all of continuous^2, so
 * the limit never steps.
 */
struct phantom_arm_motors {
	u32 peak_ma;
	u32 continuous_ma;
	u32 winding_us; /* thermal time constant */
};

/* A make of arm. Constant. */
struct phantom_arm_model {
	const char *name; /* one word */
	const char *title; /* for the log */
	const struct phantom_linkage_ops *linkage;
	struct phantom_linkage_geometry geometry;
	struct phantom_arm_motors motors;
	s16 rest[3]; /* encoder counts in the rest pose */
	s32 workspace_nm; /* cube of +- that */
	u32 max_force_un;
	u32 continuous_force_un;
	u32 resolution_nm;
	u32 rate_hz;
};

extern const struct phantom_arm_model phantom_arm_woodenhaptics;

struct phantom_arm;

/* What an arm needs of its link. */
struct phantom_arm_link_ops {
	/* CLOCK_MONOTONIC, or a clock like it. Any context. */
	u64 (*now_ns)(struct phantom_arm *arm);
	/* There is a new command. Servo thread or control: may not wait. */
	void (*kick)(struct phantom_arm *arm);
	/* Waits until the newest command is on its way, 0 or -errno. Control. */
	int (*flush)(struct phantom_arm *arm);
	/* Waits for reports that were made after the call. 0, -ETIMEDOUT. Control. */
	int (*listen)(struct phantom_arm *arm);
	/* Frees the arm and its link. Control. */
	void (*destroy)(struct phantom_arm *arm);
};

struct phantom_arm_input {
	u64 time_ns;
	s32 encoder[3];
};

struct phantom_arm_output {
	s16 current_ma[3];
};

struct phantom_arm {
	struct phantom_device device;
	const struct phantom_arm_model *model; /* fixed */
	const struct phantom_arm_link_ops *link; /* fixed */
	struct phantom_linkage linkage; /* the servo's */
	struct phantom_mailbox input; /* link -> servo */
	struct phantom_mailbox output; /* servo, else control -> link */
	u32 gone; /* one word: unplugged, for good */
	int error; /* one word, link: of the last command sent */
	u64 heard_ns; /* one word, link: when that was */
	u32 preset_wanted; /* exchanged: the next command presets the encoders */
	bool presetting; /* link: the command under way does */
	int preset_error; /* one word, link: what became of it */
	/* the writer's: servo, else control */
	u64 sent_ns;
	s16 sent_ma[3];
	s64 heat[3]; /* mean square of each current, mA^2 in 1/1024 */
};

/* max_force_un: the most that the arm may be asked for, if less than the model's. */
void phantom_arm_init(struct phantom_arm *arm, const struct phantom_arm_model *model,
		      const struct phantom_arm_link_ops *link, u32 max_force_un);

/* ---- the link's side ----------------------------------------------------- */
/* A report has come. 0, or -EINVAL when it is too short. One caller at a time, may not sleep. */
int phantom_arm_receive(struct phantom_arm *arm, const u8 *report, size_t size);
/* The newest command. One caller at a time. */
void phantom_arm_command(struct phantom_arm *arm, u8 command[PHANTOM_ARM_COMMAND_BYTES]);
/* True when phantom_arm_command() would give something new. */
bool phantom_arm_has_command(const struct phantom_arm *arm);
/* That command has been sent, or not: 0 or -errno. */
void phantom_arm_sent(struct phantom_arm *arm, int error);
/* The command that switches the motors off. */
void phantom_arm_command_off(u8 command[PHANTOM_ARM_COMMAND_BYTES]);
/* Unplugged: from here on reads and writes give -ENODEV. Any context. */
void phantom_arm_unplug(struct phantom_arm *arm);

#endif /* PHANTOM_ARM_H */
