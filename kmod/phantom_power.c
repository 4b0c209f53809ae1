// SPDX-License-Identifier: GPL-2.0-only
/*
 * phantom_power.c - suspend, hibernation and the way back, from the kernel's notifier chain.
 */
#include <phantom_platform.h>
#include "phantom_power.h"

static int phantom_power_notify(struct notifier_block *notifier, unsigned long event, void *unused)
{
	struct phantom_power *power = container_of(notifier, struct phantom_power, notifier);
	struct phantom_servo *servo = power->servo;
	int error = 0;

	mutex_lock(&servo->control);
	switch (event) {
	case PM_SUSPEND_PREPARE:
	case PM_HIBERNATION_PREPARE:
	case PM_RESTORE_PREPARE:
		phantom_servo_suspend(servo);
		break;
	case PM_POST_SUSPEND:
	case PM_POST_HIBERNATION:
	case PM_POST_RESTORE:
		error = phantom_servo_resume(servo);
		break;
	}
	mutex_unlock(&servo->control);
	if (error)
		pr_err("the servo could not go on after the machine woke up: error %d; CLEAR_FAULT and START again\n",
		       error);
	return NOTIFY_OK;
}

int phantom_power_register(struct phantom_power *power, struct phantom_servo *servo)
{
	power->servo = servo;
	power->notifier.notifier_call = phantom_power_notify;
	return register_pm_notifier(&power->notifier);
}

void phantom_power_unregister(struct phantom_power *power)
{
	unregister_pm_notifier(&power->notifier);
}
