// SPDX-License-Identifier: GPL-2.0-only
/*
 * linkage.c - kinematics of an arm of three joints in float64, with its own sine and cosine: no
 * libm, no x87. Scalar SSE2 on every machine, so the bits are the same everywhere.
 *
 * PRECISION. Counts become quarter turns and a remainder of at most an eighth of a turn in integers,
 * without rounding. There the Taylor polynomials below are cut off at
 *
 *     |sin x - p(x)| <= (pi/4)^17 / 17! < 5e-17,   |cos x - q(x)| <= (pi/4)^18 / 18! < 3e-18
 *
 * and evaluated in Horner's order, which keeps the rounding below 2^-52: each is within 4e-16 of the
 * true value. A tip half a metre away is then off by less than 1e-6 nm before it is rounded to nm,
 * a current of 10 A by less than 1e-10 mA before it is rounded to mA.
 */
#include "phantom_linkage.h"

#define LINKAGE_PI 3.14159265358979323846

/* Far beyond any arm; keeps the conversions to integers defined. */
#define LINKAGE_LIMIT 2147483647.0

struct linkage_angle {
	double sine;
	double cosine;
};

static double linkage_sine(double x)
{
	double s = x * x;
	double p = -1.0 / 1307674368000; /* -1/15! */

	p = p * s + 1.0 / 6227020800; /* 1/13! */
	p = p * s - 1.0 / 39916800; /* 1/11! */
	p = p * s + 1.0 / 362880; /* 1/9! */
	p = p * s - 1.0 / 5040; /* 1/7! */
	p = p * s + 1.0 / 120; /* 1/5! */
	p = p * s - 1.0 / 6; /* 1/3! */
	return x + x * s * p;
}

static double linkage_cosine(double x)
{
	double s = x * x;
	double p = 1.0 / 20922789888000; /* 1/16! */

	p = p * s - 1.0 / 87178291200; /* 1/14! */
	p = p * s + 1.0 / 479001600; /* 1/12! */
	p = p * s - 1.0 / 3628800; /* 1/10! */
	p = p * s + 1.0 / 40320; /* 1/8! */
	p = p * s - 1.0 / 720; /* 1/6! */
	p = p * s + 1.0 / 24; /* 1/4! */
	return 1.0 - s * 0.5 + s * s * p;
}

/* Of numerator / denominator turns; both below 2^60, denominator > 0. */
static struct linkage_angle linkage_turns(s64 numerator, s64 denominator)
{
	s64 quarters = 4 * numerator;
	s64 half = quarters < 0 ? -(denominator / 2) : denominator / 2;
	s64 quadrant = (quarters + half) / denominator; /* nearest */
	double x = (double)(quarters - quadrant * denominator) / (double)denominator *
		   (LINKAGE_PI / 2);
	double sine = linkage_sine(x);
	double cosine = linkage_cosine(x);
	struct linkage_angle angle;

	switch (quadrant & 3) {
	case 0:
		angle.sine = sine;
		angle.cosine = cosine;
		break;
	case 1:
		angle.sine = cosine;
		angle.cosine = -sine;
		break;
	case 2:
		angle.sine = -sine;
		angle.cosine = -cosine;
		break;
	default:
		angle.sine = -cosine;
		angle.cosine = sine;
		break;
	}
	return angle;
}

/* Nearest, halves away from zero; saturates. */
static s32 linkage_round(double value)
{
	value += value < 0 ? -0.5 : 0.5;
	if (value > LINKAGE_LIMIT)
		return 2147483647;
	if (value < -LINKAGE_LIMIT)
		return -2147483647;
	return (s32)value;
}

static void linkage_angles(const struct phantom_linkage *linkage, struct linkage_angle angle[3])
{
	const struct phantom_linkage_geometry *geometry = linkage->geometry;
	int joint;

	for (joint = 0; joint < 3; joint++)
		angle[joint] = linkage_turns((s64)linkage->encoder[joint] * geometry->capstan_um,
					     (s64)geometry->counts * geometry->body_um[joint]);
}

static void linkage_pose(struct phantom_linkage *linkage)
{
	const struct phantom_linkage_geometry *geometry = linkage->geometry;
	struct linkage_angle angle[3];
	double reach;

	linkage_angles(linkage, angle);
	reach = geometry->upper_nm * angle[1].sine + geometry->fore_nm * angle[2].sine;
	linkage->tip_nm[0] = linkage_round(angle[0].cosine * reach - geometry->origin_nm[0]);
	linkage->tip_nm[1] = linkage_round(angle[0].sine * reach - geometry->origin_nm[1]);
	linkage->tip_nm[2] =
		linkage_round(geometry->base_nm + geometry->upper_nm * angle[1].cosine -
			      geometry->fore_nm * angle[2].cosine - geometry->origin_nm[2]);
}

/*
 * Virtual work: joint torques T = J^T F, J the derivative of the tip by the joint angles. A motor gives
 * T capstan / body, and a current is its torque by the torque constant.
 */
static void linkage_drive(struct phantom_linkage *linkage)
{
	const struct phantom_linkage_geometry *geometry = linkage->geometry;
	struct linkage_angle angle[3];
	double outward, sideways, up, reach;
	double torque[3]; /* nm uN = 1e-15 N m */
	int joint;

	linkage_angles(linkage, angle);
	outward = angle[0].cosine * linkage->force_un[0] + angle[0].sine * linkage->force_un[1];
	sideways = angle[0].cosine * linkage->force_un[1] - angle[0].sine * linkage->force_un[0];
	up = linkage->force_un[2];
	reach = geometry->upper_nm * angle[1].sine + geometry->fore_nm * angle[2].sine;
	torque[0] = reach * sideways;
	torque[1] = geometry->upper_nm * (angle[1].cosine * outward - angle[1].sine * up);
	torque[2] = geometry->fore_nm * (angle[2].cosine * outward + angle[2].sine * up);
	for (joint = 0; joint < 3; joint++) {
		double motor = torque[joint] * geometry->capstan_um / geometry->body_um[joint];

		/* 1e-15 N m by 1e-6 N m / A is 1e-9 A, in mA 1e-6 */
		linkage->current_ma[joint] = linkage_round(motor / geometry->torque_unm_a * 1e-6);
	}
}

const struct phantom_linkage_ops phantom_linkage_three_joint = {
	.pose = linkage_pose,
	.drive = linkage_drive,
};
