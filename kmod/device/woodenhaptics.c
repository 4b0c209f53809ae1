// SPDX-License-Identifier: GPL-2.0-only
/*
 * woodenhaptics.c - the numbers of the WoodenHaptics arm (also sold as Polhem's), open hardware:
 * Forsslund, Yip, Sallnaes 2015, and the CHAI3D driver of its makers.
 *
 * REST POSE. Base straight ahead, upper arm upright, fore arm level: angles (0, 0, 1/4 turn), which
 * puts the tip at (25, 0, 205) mm. Encoders know nothing but how far they have turned since they were
 * switched on: whoever plugs the arm in, or loads the module, holds it there for a moment.
 */
#include <phantom_platform.h>
#include "device/arm.h"

const struct phantom_arm_model phantom_arm_woodenhaptics = {
	.name = "woodenhaptics",
	.title = "WoodenHaptics arm",
	.linkage = &phantom_linkage_three_joint,
	.geometry =
		{
			.base_nm = 80000000,
			.upper_nm = 205000000,
			.fore_nm = 245000000,
			.origin_nm = {220000000, 0, 80000000},
			.counts = 2000,
			.capstan_um = 10000,
			.body_um = {160000, 120000, 120000},
			.torque_unm_a = 25900,
		},
	/*
	 * Maxon RE 30 (310007): 3.44 A continuous, winding 16.3 s, 25.9 mN m / A. The newer firmware
	 * refuses more than 6 A.
	 */
	.motors =
		{
			.peak_ma = 6000,
			.continuous_ma = 3440,
			.winding_us = 16300000,
		},
	.rest = {0, 0, 6000}, /* a quarter of 2000 * 120 / 10 */
	.workspace_nm = 100000000,
	.max_force_un = 5000000,
	/* the weakest direction: 3.44 A * 0.0259 N m / A * 12 / 0.245 m = 4.36 N along C */
	.continuous_force_un = 4300000,
	/* the coarsest joint: C, 245 mm * 2 pi / 24000 */
	.resolution_nm = 64141,
	.rate_hz = 1000,
};
