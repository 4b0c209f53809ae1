// SPDX-License-Identifier: GPL-2.0-only
/*
 * phantom_main.c - load and unload: parameters, one device, one servo, one node.
 */
#include <phantom_platform.h>
#include "device/phantom_device.h"
#include "phantom_kernel.h"
#include "phantom_power.h"

static unsigned int rate_hz = 1000;
module_param(rate_hz, uint, 0444);
MODULE_PARM_DESC(rate_hz, "servo rate at load, 1000 ... 10000 Hz (1000)");

static int cpu = -1;
module_param(cpu, int, 0444);
MODULE_PARM_DESC(cpu, "CPU that the servo thread is pinned to; -1: the last one online (-1)");

static char *device = "sim";
module_param(device, charp, 0444);
MODULE_PARM_DESC(device, "sim: a simulated device; none: no device (sim)");

static unsigned int max_force_mn = 10000;
module_param(max_force_mn, uint, 0444);
MODULE_PARM_DESC(max_force_mn, "force that the simulated device can take, 1 ... 100000 mN (10000)");

static struct phantom_device *phantom_device;
static struct phantom_kernel_clock phantom_clock;
static struct phantom_servo *phantom_servo;
static struct phantom_chardev phantom_chardev;
static struct phantom_node phantom_node;
static struct phantom_power phantom_power;

static int __init phantom_create_device(void)
{
	struct phantom_device *created;

	if (!strcmp(device, "none"))
		return 0;
	if (strcmp(device, "sim")) {
		pr_err("device=%s is not known: use sim or none\n", device);
		return -EINVAL;
	}
	if (!max_force_mn || max_force_mn > PHANTOM_DEVICE_FORCE_MAX_UN / 1000) {
		pr_err("max_force_mn=%u is not within 1 ... %u\n", max_force_mn,
		       PHANTOM_DEVICE_FORCE_MAX_UN / 1000);
		return -EINVAL;
	}
	created = phantom_device_sim_create(max_force_mn * 1000);
	if (IS_ERR(created))
		return PTR_ERR(created);
	phantom_device = created;
	return 0;
}

static void phantom_destroy_device(void)
{
	if (phantom_device)
		phantom_device->ops->destroy(phantom_device);
}

static int __init phantom_check_parameters(void)
{
	if (rate_hz < PHANTOM_RATE_MIN_HZ || rate_hz > PHANTOM_RATE_MAX_HZ) {
		pr_err("rate_hz=%u is not within %u ... %u\n", rate_hz, PHANTOM_RATE_MIN_HZ,
		       PHANTOM_RATE_MAX_HZ);
		return -EINVAL;
	}
	if (cpu < -1 || (cpu >= 0 && (cpu >= nr_cpu_ids || !cpu_online(cpu)))) {
		pr_err("cpu=%d is not online\n", cpu);
		return -EINVAL;
	}
	return 0;
}

static int __init phantom_init(void)
{
	const struct phantom_float_ops *ops =
		phantom_platform_has_avx2() ? &phantom_float_avx2 : &phantom_float_sse2;
	int error;

	error = phantom_check_parameters();
	if (error)
		return error;
	error = phantom_create_device();
	if (error)
		return error;
	phantom_kernel_clock_init(&phantom_clock, cpu);
	phantom_servo = kzalloc(sizeof(*phantom_servo), GFP_KERNEL);
	error = -ENOMEM;
	if (!phantom_servo)
		goto no_memory;
	error = phantom_servo_init(phantom_servo, &phantom_clock.clock, phantom_device, ops, NULL,
				   PHANTOM_PATCHES_MAX);
	if (error)
		goto no_servo;
	mutex_lock(&phantom_servo->control);
	error = phantom_servo_set_rate(phantom_servo, rate_hz);
	mutex_unlock(&phantom_servo->control);
	if (error)
		goto no_power;
	phantom_chardev_init(&phantom_chardev, phantom_servo);
	error = phantom_power_register(&phantom_power, phantom_servo);
	if (error)
		goto no_power;
	error = phantom_node_register(&phantom_node, &phantom_chardev);
	if (error)
		goto no_node;
	pr_info("/dev/phantom_rt0 is there: device %s, %u Hz, float sections in %s\n",
		phantom_device ? phantom_device->ops->name : "none", rate_hz, ops->name);
	return 0;

no_node:
	phantom_power_unregister(&phantom_power);
no_power:
	phantom_servo_destroy(phantom_servo);
no_servo:
	kfree(phantom_servo);
no_memory:
	phantom_destroy_device();
	pr_err("not loaded: error %d\n", error);
	return error;
}

/* No file is open: the module's count says so. The last close has stopped the servo. */
static void __exit phantom_exit(void)
{
	phantom_node_unregister(&phantom_node);
	phantom_power_unregister(&phantom_power);
	phantom_servo_destroy(phantom_servo);
	kfree(phantom_servo);
	phantom_destroy_device();
	pr_info("unloaded\n");
}

module_init(phantom_init);
module_exit(phantom_exit);

MODULE_DESCRIPTION("Haptic rendering of triangle meshes in real time");
MODULE_AUTHOR("The phantom_rt authors");
MODULE_LICENSE("GPL");
MODULE_VERSION("0.1.0");
