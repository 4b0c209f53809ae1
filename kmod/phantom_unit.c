// SPDX-License-Identifier: GPL-2.0-only
/*
 * phantom_unit.c - units: created with a device, removed with it, freed with the last reference.
 *
 *     create   device + clock + servo + character device -> node, class entry
 *     remove   no new open; calls in flight end; a running servo sees the device gone and ends
 *     release  the last file is closed: everything is freed, the number may be used again
 *
 * A number is not given out again before its unit is freed: an arm that is plugged in again while a
 * program still holds the old node gets the next one.
 */
#include <phantom_platform.h>
#include "device/phantom_device.h"
#include "phantom_debugfs.h"
#include "phantom_kernel.h"

static struct phantom_unit_settings phantom_unit_settings;
static dev_t phantom_unit_first;
static DEFINE_IDA(phantom_unit_numbers);
static atomic_t phantom_unit_count = ATOMIC_INIT(0);
static DECLARE_WAIT_QUEUE_HEAD(phantom_unit_freed);

/* Group and more come from udev (60-phantom-rt.rules); this is what a machine without udev gets. */
static char *phantom_unit_devnode(phantom_devnode_device *dev, umode_t *mode)
{
	if (mode)
		*mode = 0660;
	return NULL;
}

static struct class phantom_unit_class = {
	.name = "phantom_rt",
	.devnode = phantom_unit_devnode,
	.dev_groups = phantom_sysfs_groups,
};

static struct phantom_unit *phantom_unit_of(struct device *dev)
{
	return container_of(dev, struct phantom_unit, dev);
}

int phantom_unit_setup(const struct phantom_unit_settings *settings)
{
	int error;

	phantom_unit_settings = *settings;
	error = alloc_chrdev_region(&phantom_unit_first, 0, PHANTOM_UNITS_MAX, "phantom_rt");
	if (error)
		return error;
	error = class_register(&phantom_unit_class);
	if (error)
		unregister_chrdev_region(phantom_unit_first, PHANTOM_UNITS_MAX);
	else
		phantom_debugfs_init();
	return error;
}

void phantom_unit_cleanup(void)
{
	/* a reference may outlast its file by the time that a workqueue takes */
	wait_event(phantom_unit_freed, !atomic_read(&phantom_unit_count));
	phantom_debugfs_exit();
	class_unregister(&phantom_unit_class);
	unregister_chrdev_region(phantom_unit_first, PHANTOM_UNITS_MAX);
	ida_destroy(&phantom_unit_numbers);
}

/* Clock, servo and character device of a unit that nobody sees yet. */
static int phantom_unit_init(struct phantom_unit *unit)
{
	const struct phantom_float_ops *const ops[PHANTOM_ARITHS] = {
		[PHANTOM_ARITH_FLOAT] =
			phantom_platform_has_avx2() ? &phantom_float_avx2 : &phantom_float_sse2,
		[PHANTOM_ARITH_FIXED] = &phantom_float_fixed,
	};
	int error;

	phantom_kernel_clock_init(&unit->clock, phantom_unit_settings.cpu);
	error = phantom_servo_init(&unit->servo, &unit->clock.clock, unit->device, ops,
				   PHANTOM_PATCHES_MAX);
	if (error)
		return error;
	unit->servo.unit = unit->number;
	mutex_lock(&unit->servo.control);
	error = phantom_servo_set_rate(&unit->servo, phantom_unit_settings.rate_hz);
	mutex_unlock(&unit->servo.control);
	if (!error)
		error = phantom_power_register(&unit->power, &unit->servo);
	if (error)
		phantom_servo_destroy(&unit->servo);
	else
		phantom_chardev_init(&unit->chardev, &unit->servo);
	return error;
}

static void phantom_unit_fini(struct phantom_unit *unit)
{
	phantom_power_unregister(&unit->power);
	phantom_servo_destroy(&unit->servo);
	ida_free(&phantom_unit_numbers, unit->number);
}

/* No file, no servo, no node any more. */
static void phantom_unit_release(struct device *dev)
{
	struct phantom_unit *unit = phantom_unit_of(dev);

	phantom_unit_fini(unit);
	if (unit->device)
		unit->device->ops->destroy(unit->device);
	kfree(unit);
	if (atomic_dec_and_test(&phantom_unit_count))
		wake_up(&phantom_unit_freed);
}

/* What a person wants to know, in the log. */
static void phantom_unit_introduce(const struct phantom_unit *unit)
{
	const struct phantom_device *device = unit->device;
	int cpu = unit->clock.cpu < 0 ? (int)cpumask_last(cpu_online_mask) : unit->clock.cpu;

	if (device)
		dev_info(&unit->dev, "%s (%s), at most %u mN\n", device->model, device->ops->name,
			 device->max_force_un / 1000);
	else
		dev_info(&unit->dev, "no device: sets are checked and nothing runs\n");
	dev_info(&unit->dev, "servo at %u Hz on CPU %d%s, float sections in %s\n",
		 unit->servo.rate_hz, cpu,
		 housekeeping_test_cpu(cpu, HK_TYPE_DOMAIN) ? " (not isolated)" : " (isolated)",
		 unit->servo.ops[PHANTOM_ARITH_FLOAT]->name);
	if (!IS_ENABLED(CONFIG_PREEMPT_RT))
		dev_warn(&unit->dev, "this kernel is not PREEMPT_RT: ticks will come late\n");
}

struct phantom_unit *phantom_unit_create(struct phantom_device *device, struct device *parent)
{
	struct phantom_unit *unit = kzalloc(sizeof(*unit), GFP_KERNEL);
	int error;

	if (!unit)
		return ERR_PTR(-ENOMEM);
	unit->device = device;
	unit->number = ida_alloc_max(&phantom_unit_numbers, PHANTOM_UNITS_MAX - 1, GFP_KERNEL);
	error = unit->number;
	if (error < 0)
		goto no_number;
	error = phantom_unit_init(unit);
	if (error)
		goto no_servo;
	error = dev_set_name(&unit->dev, "phantom_rt%d", unit->number);
	if (error)
		goto no_name;
	device_initialize(&unit->dev);
	unit->dev.parent = parent;
	unit->dev.devt = phantom_unit_first + unit->number; /* minor numbers are the low bits */
	unit->dev.class = &phantom_unit_class;
	unit->dev.release = phantom_unit_release;
	atomic_inc(&phantom_unit_count);
	return unit;

no_servo:
	ida_free(&phantom_unit_numbers, unit->number);
	kfree(unit);
	return ERR_PTR(error);

no_name:
	phantom_unit_fini(unit);
no_number:
	kfree(unit);
	return ERR_PTR(error);
}

int phantom_unit_add(struct phantom_unit *unit)
{
	int error;

	cdev_init(&unit->cdev, &phantom_node_operations);
	unit->cdev.owner = THIS_MODULE;
	error = cdev_device_add(&unit->cdev, &unit->dev);
	if (error)
		return error;
	unit->debugfs = phantom_debugfs_add(dev_name(&unit->dev), &unit->servo);
	phantom_unit_introduce(unit);
	return 0;
}

void phantom_unit_remove(struct phantom_unit *unit)
{
	/* first, so that an open() that is on its way already finds the device gone */
	phantom_chardev_unplug(&unit->chardev);
	phantom_debugfs_remove(unit->debugfs);
	cdev_device_del(&unit->cdev, &unit->dev);
	dev_info(&unit->dev, "removed\n");
}

void phantom_unit_put(struct phantom_unit *unit)
{
	put_device(&unit->dev);
}
