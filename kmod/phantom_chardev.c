// SPDX-License-Identifier: GPL-2.0-only
/*
 * phantom_chardev.c - open, ioctl, mmap, poll, read, release: checks and calls.
 */
#include <phantom_platform.h>
#include "phantom_chardev.h"
#include "phantom_context.h"

void phantom_chardev_init(struct phantom_chardev *chardev, struct phantom_servo *servo)
{
	chardev->servo = servo;
	chardev->feeder = NULL;
	chardev->gone = 0;
}

static bool phantom_chardev_gone(const struct phantom_chardev *chardev)
{
	return READ_ONCE(chardev->gone);
}

void phantom_chardev_unplug(struct phantom_chardev *chardev)
{
	WRITE_ONCE(chardev->gone, 1);
	phantom_servo_unplug(chardev->servo);
}

int phantom_chardev_calibrate(struct phantom_chardev *chardev)
{
	struct phantom_servo *servo = chardev->servo;
	int error;

	if (!servo->device || !servo->device->ops->calibrate)
		return -EOPNOTSUPP;
	if (phantom_chardev_gone(chardev))
		return -ENODEV;
	mutex_lock(&servo->control);
	if (READ_ONCE(servo->state) != PHANTOM_STATE_IDLE)
		error = -EBUSY;
	else
		error = servo->device->ops->calibrate(servo->device);
	mutex_unlock(&servo->control);
	return error;
}

struct phantom_file *phantom_chardev_open(struct phantom_chardev *chardev, bool feeding)
{
	struct phantom_servo *servo = chardev->servo;
	struct phantom_file *file;

	phantom_context_file(servo);
	if (phantom_chardev_gone(chardev))
		return ERR_PTR(-ENODEV);
	file = kzalloc(sizeof(*file), GFP_KERNEL);
	if (!file)
		return ERR_PTR(-ENOMEM);
	mutex_init(&file->reading);
	file->chardev = chardev;
	file->feeding = feeding;
	file->cursor = phantom_stats_head(&servo->stats);
	file->events_told = READ_ONCE(servo->events);
	file->runs_told = READ_ONCE(servo->runs);
	if (!feeding)
		return file;

	mutex_lock(&servo->control);
	if (chardev->feeder) {
		mutex_unlock(&servo->control);
		mutex_destroy(&file->reading);
		kfree(file);
		return ERR_PTR(-EBUSY);
	}
	chardev->feeder = file;
	mutex_unlock(&servo->control);
	return file;
}

void phantom_chardev_release(struct phantom_file *file)
{
	struct phantom_servo *servo = file->chardev->servo;

	phantom_context_file(servo);
	if (file->feeding) {
		mutex_lock(&servo->control);
		phantom_servo_stop(servo, PHANTOM_WISH_ABANDON);
		phantom_servo_forget(servo);
		file->chardev->feeder = NULL;
		mutex_unlock(&servo->control);
	}
	mutex_destroy(&file->reading);
	kfree(file);
}

/* ---- ioctl --------------------------------------------------------------- */

static long phantom_chardev_get_info(struct phantom_file *file, void __user *argument)
{
	const struct phantom_servo *servo = file->chardev->servo;
	const struct phantom_device *device = servo->device;
	struct phantom_info info = {
		.abi_version = PHANTOM_ABI_VERSION,
		.device = device ? device->ops->kind : PHANTOM_DEVICE_NONE,
		.features = servo->features,
		.patches_max = servo->sets.patches_max,
		.materials_max = PHANTOM_MATERIALS_MAX,
		.objects_max = PHANTOM_OBJECTS_MAX,
		.rate_min_hz = PHANTOM_RATE_MIN_HZ,
		.rate_max_hz = PHANTOM_RATE_MAX_HZ,
		.status_size = phantom_stats_page_size(),
		.tick_size = sizeof(struct phantom_tick),
		.effects = PHANTOM_EFFECTS_KNOWN,
	};

	if (device) {
		memcpy(info.workspace_min_nm, device->workspace_min_nm,
		       sizeof(info.workspace_min_nm));
		memcpy(info.workspace_max_nm, device->workspace_max_nm,
		       sizeof(info.workspace_max_nm));
		info.max_force_un = device->max_force_un;
		info.continuous_force_un = device->continuous_force_un;
		info.resolution_nm = device->resolution_nm;
		info.device_rate_hz = device->rate_hz;
	}
	return copy_to_user(argument, &info, sizeof(info)) ? -EFAULT : 0;
}

static long phantom_chardev_set_rate(struct phantom_file *file, void __user *argument)
{
	struct phantom_rate rate;

	if (copy_from_user(&rate, argument, sizeof(rate)))
		return -EFAULT;
	if (rate.reserved)
		return -EINVAL;
	return phantom_servo_set_rate(file->chardev->servo, rate.rate_hz);
}

static long phantom_chardev_set_model(struct phantom_file *file, void __user *argument)
{
	struct phantom_model model;

	if (copy_from_user(&model, argument, sizeof(model)))
		return -EFAULT;
	return phantom_servo_set_model(file->chardev->servo, &model);
}

static long phantom_chardev_start(struct phantom_file *file, void __user *argument)
{
	struct phantom_start start;

	if (copy_from_user(&start, argument, sizeof(start)))
		return -EFAULT;
	return phantom_servo_start(file->chardev->servo, &start);
}

static long phantom_chardev_stop(struct phantom_file *file, void __user *argument)
{
	phantom_servo_stop(file->chardev->servo, PHANTOM_WISH_STOP);
	return 0;
}

static long phantom_chardev_submit_set(struct phantom_file *file, void __user *argument)
{
	struct phantom_servo *servo = file->chardev->servo;

	WRITE_ONCE(file->events_told, READ_ONCE(servo->events));
	return phantom_servo_submit(servo, argument);
}

/* Not as control: the tip moves on while STOP waits for the ramp. */
static long phantom_chardev_sim_move(struct phantom_file *file, void __user *argument)
{
	struct phantom_device *device = file->chardev->servo->device;
	struct phantom_sim_move move;
	int axis;

	if (!device || !device->ops->move)
		return -EOPNOTSUPP;
	if (copy_from_user(&move, argument, sizeof(move)))
		return -EFAULT;
	if (move.reserved)
		return -EINVAL;
	for (axis = 0; axis < 3; axis++)
		if (move.tip_nm[axis] > PHANTOM_POSITION_MAX_NM ||
		    move.tip_nm[axis] < -PHANTOM_POSITION_MAX_NM)
			return -EINVAL;
	device->ops->move(device, move.tip_nm);
	return 0;
}

static long phantom_chardev_clear_fault(struct phantom_file *file, void __user *argument)
{
	struct phantom_servo *servo = file->chardev->servo;

	WRITE_ONCE(file->events_told, READ_ONCE(servo->events));
	return phantom_servo_clear_fault(servo);
}

static const struct phantom_chardev_command {
	unsigned int number;
	bool anyone; /* observers too */
	bool control; /* called as "control" */
	long (*call)(struct phantom_file *file, void __user *argument);
} phantom_chardev_commands[] = {
	{PHANTOM_GET_INFO, true, false, phantom_chardev_get_info},
	{PHANTOM_SET_RATE, false, true, phantom_chardev_set_rate},
	{PHANTOM_SET_MODEL, false, true, phantom_chardev_set_model},
	{PHANTOM_START, false, true, phantom_chardev_start},
	{PHANTOM_STOP, false, true, phantom_chardev_stop},
	{PHANTOM_SUBMIT_SET, false, false, phantom_chardev_submit_set},
	{PHANTOM_SIM_MOVE, false, false, phantom_chardev_sim_move},
	{PHANTOM_CLEAR_FAULT, false, true, phantom_chardev_clear_fault},
};

long phantom_chardev_ioctl(struct phantom_file *file, unsigned int command, void __user *argument)
{
	struct phantom_servo *servo = file->chardev->servo;
	const struct phantom_chardev_command *entry;
	long result;
	size_t i;

	phantom_context_file(servo);
	if (phantom_chardev_gone(file->chardev))
		return -ENODEV;
	for (i = 0; i < ARRAY_SIZE(phantom_chardev_commands); i++) {
		entry = &phantom_chardev_commands[i];
		if (entry->number != command)
			continue;
		if (!entry->anyone && !file->feeding)
			return -EBADF;
		if (!entry->control)
			return entry->call(file, argument);
		mutex_lock(&servo->control);
		result = entry->call(file, argument);
		mutex_unlock(&servo->control);
		return result;
	}
	return -ENOTTY;
}

/* ---- read, poll, mmap ---------------------------------------------------- */

static bool phantom_chardev_has_records(const struct phantom_file *file)
{
	return phantom_stats_head(&file->chardev->servo->stats) > READ_ONCE(file->cursor);
}

/* No record will come: there is no run, or it has ended by itself because the device is gone. */
static bool phantom_chardev_over(const struct phantom_file *file)
{
	const struct phantom_servo *servo = file->chardev->servo;

	/* pairs with the end of a run in phantom_servo.c: its last record is there */
	return READ_ONCE(servo->state) == PHANTOM_STATE_IDLE || smp_load_acquire(&servo->ended);
}

/* As many whole records as there are and fit. Bytes, or -EFAULT when not one could be copied. */
static ssize_t phantom_chardev_copy_records(struct phantom_file *file, char __user *buffer,
					    size_t size)
{
	struct phantom_stats *stats = &file->chardev->servo->stats;
	struct phantom_tick record;
	u64 cursor = file->cursor;
	size_t done = 0;

	while (size - done >= sizeof(record) && phantom_stats_read(stats, &cursor, &record)) {
		if (copy_to_user(buffer + done, &record, sizeof(record)))
			return done ? (ssize_t)done : -EFAULT;
		WRITE_ONCE(file->cursor, cursor);
		done += sizeof(record);
	}
	return done;
}

ssize_t phantom_chardev_read(struct phantom_file *file, char __user *buffer, size_t size,
			     bool nonblocking)
{
	struct phantom_servo *servo = file->chardev->servo;
	ssize_t done;

	phantom_context_file(servo);
	if (size < sizeof(struct phantom_tick))
		return -EINVAL;
	size = min_t(size_t, size, PHANTOM_RING_RECORDS * sizeof(struct phantom_tick));
	WRITE_ONCE(file->events_told, READ_ONCE(servo->events));
	for (;;) {
		/* the state first: records that come before its end are not lost */
		u32 runs = READ_ONCE(servo->runs);
		bool over = phantom_chardev_over(file);

		smp_rmb(); /* the end before the records, and those after it */
		mutex_lock(&file->reading);
		done = phantom_chardev_copy_records(file, buffer, size);
		mutex_unlock(&file->reading);
		if (done)
			return done;
		if (over && phantom_chardev_gone(file->chardev))
			return -ENODEV;
		if (over) {
			WRITE_ONCE(file->runs_told, runs);
			return 0;
		}
		if (nonblocking)
			return -EAGAIN;
		if (wait_event_interruptible(servo->wait, phantom_chardev_has_records(file) ||
								  phantom_chardev_over(file)))
			return -ERESTARTSYS;
	}
}

__poll_t phantom_chardev_poll(struct phantom_file *file)
{
	const struct phantom_servo *servo = file->chardev->servo;
	__poll_t mask = 0;

	if (phantom_chardev_has_records(file) ||
	    READ_ONCE(servo->runs) != READ_ONCE(file->runs_told))
		mask |= EPOLLIN | EPOLLRDNORM;
	if (READ_ONCE(servo->events) != READ_ONCE(file->events_told))
		mask |= EPOLLPRI;
	if (phantom_chardev_gone(file->chardev))
		mask |= EPOLLHUP | EPOLLERR;
	return mask;
}

int phantom_chardev_check_mmap(const struct phantom_file *file, bool write_or_execute, u64 offset,
			       u64 size)
{
	if (phantom_chardev_gone(file->chardev))
		return -ENODEV;
	if (write_or_execute)
		return -EPERM;
	return offset || size > phantom_stats_page_size() ? -EINVAL : 0;
}
