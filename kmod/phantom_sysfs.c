// SPDX-License-Identifier: GPL-2.0-only
/*
 * phantom_sysfs.c - what a unit tells in /sys/class/phantom_rt/phantom_rtN, for people, scripts and
 * udev. One value a file; read-only but for `calibrate`.
 *
 *   kind            what the device is: sim, hid, pci, none
 *   model           its name: simulated, woodenhaptics; none
 *   abi_version     of the calls on the node: PHANTOM_ABI_VERSION
 *   features        PHANTOM_FEATURE_... as a hexadecimal mask
 *   instruction_set of the float sections: sse2, avx2
 *   rate_hz         of the servo, as set last by anyone
 *   max_force_mn    the most that the device may be asked for
 *   continuous_force_mn  what it bears for long; 0: not known
 *   state           idle, running, fault
 *   faults          the latched ones, separated by blanks: device, overspeed, stall, numeric,
 *                   unplugged, suspended; or none
 *   calibrate       write 1 while the arm rests in its rest pose: its encoders are told so.
 *                   Only where the device has joints. EBUSY while the servo runs, EINVAL for
 *                   anything but 1, ENODEV when the device is gone
 */
#include <phantom_platform.h>
#include "device/phantom_device.h"
#include "phantom_kernel.h"

const char *const phantom_fault_names[PHANTOM_FAULTS] = {"device",  "overspeed", "stall",
							 "numeric", "unplugged", "suspended"};

static const struct phantom_unit *phantom_sysfs_unit(const struct device *dev)
{
	return container_of(dev, const struct phantom_unit, dev);
}

static ssize_t kind_show(struct device *dev, struct device_attribute *attribute, char *text)
{
	const struct phantom_device *device = phantom_sysfs_unit(dev)->device;

	return sysfs_emit(text, "%s\n", device ? device->ops->name : "none");
}
static DEVICE_ATTR_RO(kind);

static ssize_t model_show(struct device *dev, struct device_attribute *attribute, char *text)
{
	const struct phantom_device *device = phantom_sysfs_unit(dev)->device;

	return sysfs_emit(text, "%s\n", device ? device->model : "none");
}
static DEVICE_ATTR_RO(model);

static ssize_t abi_version_show(struct device *dev, struct device_attribute *attribute, char *text)
{
	return sysfs_emit(text, "%u\n", PHANTOM_ABI_VERSION);
}
static DEVICE_ATTR_RO(abi_version);

static ssize_t features_show(struct device *dev, struct device_attribute *attribute, char *text)
{
	return sysfs_emit(text, "0x%llx\n", phantom_sysfs_unit(dev)->servo.features);
}
static DEVICE_ATTR_RO(features);

static ssize_t instruction_set_show(struct device *dev, struct device_attribute *attribute,
				    char *text)
{
	return sysfs_emit(text, "%s\n",
			  phantom_sysfs_unit(dev)->servo.ops[PHANTOM_ARITH_FLOAT]->name);
}
static DEVICE_ATTR_RO(instruction_set);

static ssize_t rate_hz_show(struct device *dev, struct device_attribute *attribute, char *text)
{
	return sysfs_emit(text, "%u\n", READ_ONCE(phantom_sysfs_unit(dev)->servo.rate_hz));
}
static DEVICE_ATTR_RO(rate_hz);

static ssize_t max_force_mn_show(struct device *dev, struct device_attribute *attribute, char *text)
{
	const struct phantom_device *device = phantom_sysfs_unit(dev)->device;

	return sysfs_emit(text, "%u\n", device ? device->max_force_un / 1000 : 0);
}
static DEVICE_ATTR_RO(max_force_mn);

static ssize_t continuous_force_mn_show(struct device *dev, struct device_attribute *attribute,
					char *text)
{
	const struct phantom_device *device = phantom_sysfs_unit(dev)->device;

	return sysfs_emit(text, "%u\n", device ? device->continuous_force_un / 1000 : 0);
}
static DEVICE_ATTR_RO(continuous_force_mn);

static ssize_t state_show(struct device *dev, struct device_attribute *attribute, char *text)
{
	switch (READ_ONCE(phantom_sysfs_unit(dev)->servo.state)) {
	case PHANTOM_STATE_IDLE:
		return sysfs_emit(text, "idle\n");
	case PHANTOM_STATE_RUNNING:
		return sysfs_emit(text, "running\n");
	default:
		return sysfs_emit(text, "fault\n");
	}
}
static DEVICE_ATTR_RO(state);

static ssize_t faults_show(struct device *dev, struct device_attribute *attribute, char *text)
{
	u32 faults = READ_ONCE(phantom_sysfs_unit(dev)->servo.faults);
	ssize_t length = 0;
	size_t bit;

	for (bit = 0; bit < ARRAY_SIZE(phantom_fault_names); bit++)
		if (faults & BIT(bit))
			length += sysfs_emit_at(text, length, "%s%s", length ? " " : "",
						phantom_fault_names[bit]);
	return length + sysfs_emit_at(text, length, "%s\n", length ? "" : "none");
}
static DEVICE_ATTR_RO(faults);

static ssize_t calibrate_store(struct device *dev, struct device_attribute *attribute,
			       const char *text, size_t size)
{
	struct phantom_unit *unit = container_of(dev, struct phantom_unit, dev);
	bool wanted;
	int error;

	if (kstrtobool(text, &wanted) || !wanted)
		return -EINVAL;
	error = phantom_chardev_calibrate(&unit->chardev);
	return error ? error : (ssize_t)size;
}
static DEVICE_ATTR_WO(calibrate);

static struct attribute *phantom_sysfs_attributes[] = {
	&dev_attr_kind.attr,
	&dev_attr_model.attr,
	&dev_attr_abi_version.attr,
	&dev_attr_features.attr,
	&dev_attr_instruction_set.attr,
	&dev_attr_rate_hz.attr,
	&dev_attr_max_force_mn.attr,
	&dev_attr_continuous_force_mn.attr,
	&dev_attr_state.attr,
	&dev_attr_faults.attr,
	&dev_attr_calibrate.attr,
	NULL,
};

static umode_t phantom_sysfs_is_visible(struct kobject *kobject, struct attribute *attribute, int i)
{
	const struct phantom_device *device = phantom_sysfs_unit(kobj_to_dev(kobject))->device;

	if (attribute == &dev_attr_calibrate.attr && !(device && device->ops->calibrate))
		return 0;
	return attribute->mode;
}

static const struct attribute_group phantom_sysfs_group = {
	.attrs = phantom_sysfs_attributes,
	.is_visible = phantom_sysfs_is_visible,
};

const struct attribute_group *phantom_sysfs_groups[] = {&phantom_sysfs_group, NULL};
