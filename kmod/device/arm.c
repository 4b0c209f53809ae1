// SPDX-License-Identifier: GPL-2.0-only
/*
 * arm.c - the device behind an arm's link: newest report in, newest currents out, limits, silence.
 */
#include <phantom_platform.h>
#include "device/arm.h"

/* Positions in a command. */
#define PHANTOM_ARM_COMMAND 6
#define PHANTOM_ARM_ATTRIBUTE 8
#define PHANTOM_ARM_COMMAND_PRESET 1

#define PHANTOM_ARM_HEAT_SHIFT 10 /* of heat: 1/1024 mA^2 */

static struct phantom_arm *phantom_arm_of(struct phantom_device *device)
{
	return container_of(device, struct phantom_arm, device);
}

/* ---- reports ------------------------------------------------------------- */

static s16 phantom_arm_get16(const u8 *bytes)
{
	return (s16)(bytes[0] | bytes[1] << 8);
}

static void phantom_arm_put16(u8 *bytes, s16 value)
{
	bytes[0] = (u16)value & 0xff;
	bytes[1] = (u16)value >> 8;
}

int phantom_arm_receive(struct phantom_arm *arm, const u8 *report, size_t size)
{
	struct phantom_arm_input input = {.time_ns = arm->link->now_ns(arm)};
	int joint;

	if (size < PHANTOM_ARM_REPORT_BYTES)
		return -EINVAL;
	for (joint = 0; joint < 3; joint++)
		input.encoder[joint] = phantom_arm_get16(report + 2 * joint);
	phantom_mailbox_post(&arm->input, &input);
	return 0;
}

void phantom_arm_command_off(u8 command[PHANTOM_ARM_COMMAND_BYTES])
{
	memset(command, 0, PHANTOM_ARM_COMMAND_BYTES);
}

bool phantom_arm_has_command(const struct phantom_arm *arm)
{
	return phantom_mailbox_fresh(&arm->output) || READ_ONCE(arm->preset_wanted);
}

void phantom_arm_command(struct phantom_arm *arm, u8 command[PHANTOM_ARM_COMMAND_BYTES])
{
	struct phantom_arm_output output;
	int joint;

	phantom_arm_command_off(command);
	phantom_mailbox_read(&arm->output, &output);
	for (joint = 0; joint < 3; joint++)
		phantom_arm_put16(command + 2 * joint, output.current_ma[joint]);
	arm->presetting = xchg(&arm->preset_wanted, 0);
	if (!arm->presetting)
		return;
	phantom_arm_put16(command + PHANTOM_ARM_COMMAND, PHANTOM_ARM_COMMAND_PRESET);
	for (joint = 0; joint < 3; joint++)
		phantom_arm_put16(command + PHANTOM_ARM_ATTRIBUTE + 2 * joint,
				  arm->model->rest[joint]);
}

void phantom_arm_sent(struct phantom_arm *arm, int error)
{
	WRITE_ONCE(arm->error, error);
	if (arm->presetting)
		WRITE_ONCE(arm->preset_error, error);
	WRITE_ONCE(arm->heard_ns, arm->link->now_ns(arm));
}

void phantom_arm_unplug(struct phantom_arm *arm)
{
	WRITE_ONCE(arm->gone, 1);
}

/* ---- currents ------------------------------------------------------------ */

static void phantom_arm_warm(struct phantom_arm *arm)
{
	u32 winding_us = arm->model->motors.winding_us;
	u64 elapsed_us = (arm->link->now_ns(arm) - arm->sent_ns) / NSEC_PER_USEC;
	s64 step_us = min_t(u64, elapsed_us, winding_us);
	int joint;

	arm->sent_ns += elapsed_us * NSEC_PER_USEC;
	for (joint = 0; joint < 3; joint++) {
		s64 square = (s64)arm->sent_ma[joint] * arm->sent_ma[joint];

		/* |difference| < 2^40, step_us < 2^20 s: far below 2^63 */
		arm->heat[joint] += ((square << PHANTOM_ARM_HEAT_SHIFT) - arm->heat[joint]) *
				    step_us / winding_us;
	}
}

static u32 phantom_arm_limit(const struct phantom_arm_motors *motors, s64 heat)
{
	s64 most = (s64)motors->continuous_ma * motors->continuous_ma;
	s64 margin = clamp_t(s64, most - (heat >> PHANTOM_ARM_HEAT_SHIFT), 0, most / 5);

	return motors->continuous_ma +
	       (motors->peak_ma - motors->continuous_ma) * margin / (most / 5);
}

/* The largest fraction of the currents, in 2^-30, that no motor suffers from. */
static s64 phantom_arm_fraction(const struct phantom_arm *arm, const s32 current_ma[3])
{
	s64 fraction = 1LL << 30;
	int joint;

	for (joint = 0; joint < 3; joint++) {
		s64 wanted = current_ma[joint];
		u32 limit = phantom_arm_limit(&arm->model->motors, arm->heat[joint]);

		if (wanted < 0)
			wanted = -wanted;
		if (wanted > limit)
			fraction = min_t(s64, fraction, ((s64)limit << 30) / wanted);
	}
	return fraction;
}

static void phantom_arm_send(struct phantom_arm *arm, const s32 current_ma[3])
{
	struct phantom_arm_output output;
	s64 fraction;
	int joint;

	phantom_arm_warm(arm);
	fraction = phantom_arm_fraction(arm, current_ma);
	for (joint = 0; joint < 3; joint++)
		output.current_ma[joint] = (s16)(current_ma[joint] * fraction / (1LL << 30));
	memcpy(arm->sent_ma, output.current_ma, sizeof(arm->sent_ma));
	phantom_mailbox_post(&arm->output, &output);
	arm->link->kick(arm);
}

/* ---- the device ---------------------------------------------------------- */

static const s32 phantom_arm_no_current[3];

static int phantom_arm_start(struct phantom_device *device)
{
	struct phantom_arm *arm = phantom_arm_of(device);
	int error;

	if (READ_ONCE(arm->gone))
		return -ENODEV;
	phantom_arm_send(arm, phantom_arm_no_current);
	error = arm->link->flush(arm);
	return error ? error : arm->link->listen(arm);
}

static void phantom_arm_stop(struct phantom_device *device)
{
	struct phantom_arm *arm = phantom_arm_of(device);

	if (READ_ONCE(arm->gone))
		return;
	phantom_arm_send(arm, phantom_arm_no_current);
	arm->link->flush(arm);
}

static int phantom_arm_read(struct phantom_device *device, s64 tip_nm[3])
{
	struct phantom_arm *arm = phantom_arm_of(device);
	struct phantom_arm_input input;

	if (READ_ONCE(arm->gone))
		return -ENODEV;
	phantom_mailbox_read(&arm->input, &input);
	/* a report may be made after the time that it is compared with */
	if (arm->link->now_ns(arm) > input.time_ns + PHANTOM_ARM_SILENCE_NS)
		return -EIO;
	memcpy(arm->linkage.encoder, input.encoder, sizeof(arm->linkage.encoder));
	return 0;
}

static int phantom_arm_write(struct phantom_device *device, const s32 force_un[3])
{
	struct phantom_arm *arm = phantom_arm_of(device);
	bool force = force_un[0] || force_un[1] || force_un[2];

	if (READ_ONCE(arm->gone))
		return -ENODEV;
	phantom_arm_send(arm, force ? arm->linkage.current_ma : phantom_arm_no_current);
	if (arm->link->now_ns(arm) > READ_ONCE(arm->heard_ns) + PHANTOM_ARM_DEAF_NS)
		return -EIO;
	return READ_ONCE(arm->error);
}

static int phantom_arm_calibrate(struct phantom_device *device)
{
	struct phantom_arm *arm = phantom_arm_of(device);
	int error;

	if (READ_ONCE(arm->gone))
		return -ENODEV;
	xchg(&arm->preset_wanted, 1);
	phantom_arm_send(arm, phantom_arm_no_current);
	error = arm->link->flush(arm);
	/* a later command may have got through where this one did not */
	return error ? error : READ_ONCE(arm->preset_error);
}

static void phantom_arm_destroy(struct phantom_device *device)
{
	struct phantom_arm *arm = phantom_arm_of(device);

	arm->link->destroy(arm);
}

static const struct phantom_device_ops phantom_arm_ops = {
	.name = "hid",
	.kind = PHANTOM_DEVICE_HID,
	.start = phantom_arm_start,
	.stop = phantom_arm_stop,
	.read = phantom_arm_read,
	.write = phantom_arm_write,
	.calibrate = phantom_arm_calibrate,
	.destroy = phantom_arm_destroy,
};

void phantom_arm_init(struct phantom_arm *arm, const struct phantom_arm_model *model,
		      const struct phantom_arm_link_ops *link, u32 max_force_un)
{
	struct phantom_device *device = &arm->device;
	int axis;

	memset(arm, 0, sizeof(*arm));
	arm->model = model;
	arm->link = link;
	arm->linkage.ops = model->linkage;
	arm->linkage.geometry = &model->geometry;
	phantom_mailbox_init(&arm->input, sizeof(struct phantom_arm_input));
	phantom_mailbox_init(&arm->output, sizeof(struct phantom_arm_output));
	arm->sent_ns = link->now_ns(arm);
	device->ops = &phantom_arm_ops;
	device->model = model->name;
	device->linkage = &arm->linkage;
	for (axis = 0; axis < 3; axis++) {
		device->workspace_min_nm[axis] = -model->workspace_nm;
		device->workspace_max_nm[axis] = model->workspace_nm;
	}
	device->max_force_un = min(max_force_un, model->max_force_un);
	device->continuous_force_un = min(max_force_un, model->continuous_force_un);
	device->resolution_nm = model->resolution_nm;
	device->rate_hz = model->rate_hz;
}
