// SPDX-License-Identifier: GPL-2.0-only
/*
 * phantom_main.c - load and unload: parameters, and the first unit or the driver that makes units.
 */
#include <phantom_platform.h>
#include "device/phantom_device.h"
#include "phantom_kernel.h"

static unsigned int rate_hz = 1000;
module_param(rate_hz, uint, 0444);
MODULE_PARM_DESC(rate_hz, "servo rate at load, 1000 ... 10000 Hz (1000)");

static int cpu = -1;
module_param(cpu, int, 0444);
MODULE_PARM_DESC(cpu, "CPU that the servo thread is pinned to; -1: the last one online (-1)");

static char *device = "sim";
module_param(device, charp, 0444);
MODULE_PARM_DESC(
	device,
	"sim: a simulated device; hid: USB arms (WoodenHaptics, Polhem); none: no device (sim)");

static unsigned int max_force_mn = 10000;
module_param(max_force_mn, uint, 0444);
MODULE_PARM_DESC(max_force_mn, "force that no device is asked to exceed, 1 ... 100000 mN (10000)");

static bool phantom_hid_wanted;
static struct phantom_unit *phantom_unit; /* sim and none: there from load to unload */

static int __init phantom_check_parameters(void)
{
	if (rate_hz < PHANTOM_RATE_MIN_HZ || rate_hz > PHANTOM_RATE_MAX_HZ) {
		pr_err("rate_hz=%u is not within %u ... %u\n", rate_hz, PHANTOM_RATE_MIN_HZ,
		       PHANTOM_RATE_MAX_HZ);
		return -EINVAL;
	}
	if (cpu < -1 || (cpu >= 0 && (cpu >= nr_cpu_ids || !cpu_online(cpu)))) {
		pr_err("cpu=%d is not online: see /sys/devices/system/cpu/online\n", cpu);
		return -EINVAL;
	}
	if (strcmp(device, "sim") && strcmp(device, "hid") && strcmp(device, "none")) {
		pr_err("device=%s is not known: use sim, hid or none\n", device);
		return -EINVAL;
	}
	if (!max_force_mn || max_force_mn > PHANTOM_DEVICE_FORCE_MAX_UN / 1000) {
		pr_err("max_force_mn=%u is not within 1 ... %u\n", max_force_mn,
		       PHANTOM_DEVICE_FORCE_MAX_UN / 1000);
		return -EINVAL;
	}
	return 0;
}

/* The unit of a device that does not come and go; `created` may be NULL. */
static int __init phantom_create_unit(struct phantom_device *created)
{
	struct phantom_unit *unit;
	int error;

	if (IS_ERR(created))
		return PTR_ERR(created);
	unit = phantom_unit_create(created, NULL);
	if (IS_ERR(unit)) {
		if (created)
			created->ops->destroy(created);
		return PTR_ERR(unit);
	}
	error = phantom_unit_add(unit);
	if (error)
		phantom_unit_put(unit);
	else
		phantom_unit = unit;
	return error;
}

static int __init phantom_create_device(void)
{
	if (!strcmp(device, "none"))
		return phantom_create_unit(NULL);
	if (!strcmp(device, "sim"))
		return phantom_create_unit(phantom_device_sim_create(max_force_mn * 1000));
	phantom_hid_wanted = true;
	return phantom_hid_setup(max_force_mn * 1000);
}

static int __init phantom_init(void)
{
	struct phantom_unit_settings settings;
	int error;

	error = phantom_check_parameters();
	if (error)
		return error;
	settings.rate_hz = rate_hz;
	settings.cpu = cpu;
	error = phantom_unit_setup(&settings);
	if (error)
		goto failed;
	error = phantom_create_device();
	if (!error)
		return 0;

	phantom_unit_cleanup();
failed:
	pr_err("not loaded: error %d\n", error);
	return error;
}

/* No file is open: the module's count says so. The last close has stopped the servo. */
static void __exit phantom_exit(void)
{
	if (phantom_hid_wanted)
		phantom_hid_cleanup();
	if (phantom_unit) {
		phantom_unit_remove(phantom_unit);
		phantom_unit_put(phantom_unit);
	}
	phantom_unit_cleanup();
	pr_info("unloaded\n");
}

module_init(phantom_init);
module_exit(phantom_exit);

MODULE_DESCRIPTION("Haptic rendering of triangle meshes in real time");
MODULE_AUTHOR("The phantom_rt authors");
MODULE_LICENSE("GPL");
MODULE_VERSION("0.1.0");
