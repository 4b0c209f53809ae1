/* SPDX-License-Identifier: GPL-2.0-only */
/*
 * phantom_carry.h - the proxy on a geometry that has just changed. Servo thread only.
 *
 * The surface that the tip touches, or that the proxy lies on, is another one
 * now, a little beside the old. phantom_touch_depart() ends with the old: the tick as it would have
 * been is what the crossfade begins with. Then the new one's tick is told that the tip comes from
 * outside, along the normal of the old contact: if the new surface stands between, the proxy is
 * where that path crosses it. First from as far as the two may differ; if nothing at all is felt
 * then, from a contact radius farther: it may have risen over the tip. (Not at once: in a narrow
 * slot that start lies behind another wall.) At last round about.
 */
#ifndef PHANTOM_CARRY_H
#define PHANTOM_CARRY_H

#include "phantom_servo.h"

/*
 * This tick's contact in the slot's frame, in the place of phantom_servo_float_tick(); its touch.carry_nm is
 * not 0.
 */
void phantom_carry(struct phantom_servo *servo, const struct phantom_slot *slot, u32 frame);

#endif /* PHANTOM_CARRY_H */
