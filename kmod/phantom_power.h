/* SPDX-License-Identifier: GPL-2.0-only */
/*
 * phantom_power.h - tells a servo when the machine goes to sleep and when it has woken up.
 *
 * A notifier and not a driver's suspend callback: it comes while threads and devices still work, so
 * that the force can ramp down, and for every kind of device.
 */
#ifndef PHANTOM_POWER_H
#define PHANTOM_POWER_H

#include <phantom_platform.h>
#include "phantom_servo.h"

struct phantom_power {
	struct notifier_block notifier;
	struct phantom_servo *servo; /* fixed */
};

/* 0 or -errno. The servo must outlive the registration. Process context, no mutex held. */
int phantom_power_register(struct phantom_power *power, struct phantom_servo *servo);
void phantom_power_unregister(struct phantom_power *power);

#endif /* PHANTOM_POWER_H */
