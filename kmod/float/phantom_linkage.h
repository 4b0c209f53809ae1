/* SPDX-License-Identifier: GPL-2.0-only */
/*
 * phantom_linkage.h - the border to the kinematics of arms: encoder counts to tip position, force to
 * motor currents.
 *
 * As phantom_float.h: integers and pointers only, called between kernel_fpu_begin() and
 * kernel_fpu_end() by phantom_servo.c, no loop without a constant bound; the same inputs give the
 * same bits in the kernel and in user mode.
 */
#ifndef PHANTOM_LINKAGE_H
#define PHANTOM_LINKAGE_H

#include <phantom_platform_types.h>

/*
 * An arm of three driven joints whose motors all sit on its base (WoodenHaptics): A turns the arm
 * about the vertical axis, B and C swing upper and fore arm, both measured from the vertical. Each
 * motor turns its joint's body by a cable round a capstan.
 *
 *     angle = encoder / counts * capstan / body                    turns
 *     reach = Lb sin B + Lc sin C
 *     x = cos A reach - ox,  y = sin A reach - oy,  z = Ln + Lb cos B - Lc cos C - oz
 */
struct phantom_linkage_geometry {
	s32 base_nm; /* Ln, the shoulder's height */
	s32 upper_nm; /* Lb */
	s32 fore_nm; /* Lc */
	s32 origin_nm[3]; /* (ox, oy, oz), where the tip is at 0 0 0 */
	u32 counts; /* of the encoder, per turn of the motor */
	u32 capstan_um; /* diameter */
	u32 body_um[3]; /* diameters, of A, B and C */
	u32 torque_unm_a; /* torque constant of the motors, uN m / A */
};

struct phantom_linkage_ops;

struct phantom_linkage {
	const struct phantom_linkage_ops *ops;
	const struct phantom_linkage_geometry *geometry;
	s32 encoder[3]; /* in; |counts| < 2^31, of A, B and C */
	s32 tip_nm[3]; /* out of pose() */
	s32 force_un[3]; /* in, on the person's hand */
	s32 current_ma[3]; /* out of drive(), at the same encoder counts; saturates */
};

struct phantom_linkage_ops {
	void (*pose)(struct phantom_linkage *linkage);
	void (*drive)(struct phantom_linkage *linkage);
};

extern const struct phantom_linkage_ops phantom_linkage_three_joint;

#endif /* PHANTOM_LINKAGE_H */
