/* SPDX-License-Identifier: GPL-2.0-only */
/*
 * phantom_touch.h - the part of a tick that touches: from the tip to the force that contact and effects ask
 * for. Servo thread but for what says "run state".
 */
#ifndef PHANTOM_TOUCH_H
#define PHANTOM_TOUCH_H

#include "phantom_servo.h"

/* The pass's target, contacts, normal and proxy for its tip; target is zero where nothing is promised. */
void phantom_touch_contact(struct phantom_servo *servo, struct phantom_pass *pass);
/* The active set is a new one: effects that it does not name remember nothing any more. */
void phantom_touch_settle(struct phantom_servo *servo);
/* After contact(): the tip is outside and has used up half of its slack in a frame. */
bool phantom_touch_running_out(const struct phantom_servo *servo, const struct phantom_pass *pass);
/* Of all bodies. Run state. */
void phantom_touch_forget(struct phantom_servo *servo);

#endif /* PHANTOM_TOUCH_H */
