// SPDX-License-Identifier: GPL-2.0-only
/*
 * phantom_motion.c - poses of moving frames, in fixed point.
 *
 * Matrices and quaternions are of unit length but for rounding, so by Cauchy and Schwarz a sum of products
 * with their rows is no longer than the other vector, in Q30: below 2^63 for 2^33.
 */
#include <phantom_platform.h>
#include "phantom_motion.h"

#define MOTION_Q 30
#define MOTION_ONE (1LL << MOTION_Q)

#define URAD_PER_RAD 1000000

/* 2^64 half turns per ns for 1 urad/s of the whole: 2^64 1e-15 / (4 pi), times 2^22. */
#define MOTION_RATE_Q 22
#define MOTION_RATE 6157008641ULL

/* A turn of 0.2 rad, as half the angle's sine. */
#define MOTION_JUMP_TURN 107195314LL

static s64 motion_round(s64 value_q, u32 q)
{
	return (value_q + (1LL << (q - 1))) >> q;
}

/* ---- sine and cosine ----------------------------------------------------- */

/* Inside, numbers are Q31: the argument is within +-pi/4. */
#define SERIES_Q 31
#define SERIES_ONE (1LL << SERIES_Q)
#define SERIES_PART(n) ((SERIES_ONE + (n) / 2) / (n))
#define QUARTER_PI_Q30 843314857LL

/*
 * 1 - y a (1 - y b (1 - ...)), y the argument's square: the terms of the series up to x^11 and x^10.
 * What is left out is below 2e-10.
 */
static s64 motion_series(s64 square, const s64 part[5])
{
	s64 sum = SERIES_ONE;
	int i;

	for (i = 4; i >= 0; i--)
		sum = SERIES_ONE -
		      motion_round(square * motion_round(sum * part[i], SERIES_Q), SERIES_Q);
	return sum;
}

/* Of an angle in 2^-64 of a turn; to 2^-30. */
static void motion_sine(u64 angle, s64 *sine_q30, s64 *cosine_q30)
{
	static const s64 sines[5] = {SERIES_PART(6), SERIES_PART(20), SERIES_PART(42),
				     SERIES_PART(72), SERIES_PART(110)};
	static const s64 cosines[5] = {SERIES_PART(2), SERIES_PART(12), SERIES_PART(30),
				       SERIES_PART(56), SERIES_PART(90)};
	u64 quarter = (angle + (1ULL << 61)) >> 62; /* the nearest, 0 ... 3 */
	s64 rest = (s64)(angle - (quarter << 62)) >> 30; /* of 2^-34 of a turn, +-2^31 */
	s64 x = motion_round(rest * QUARTER_PI_Q30, 30); /* 2 pi 2^31 / 2^34 is pi / 4 */
	s64 square = motion_round(x * x, SERIES_Q);
	s64 s = motion_round(motion_round(x * motion_series(square, sines), SERIES_Q), 1);
	s64 c = motion_round(motion_series(square, cosines), 1);

	*sine_q30 = quarter & 1 ? c : s;
	*cosine_q30 = quarter & 1 ? s : c;
	if (quarter & 2)
		*sine_q30 = -*sine_q30;
	if (quarter == 1 || quarter == 2)
		*cosine_q30 = -*cosine_q30;
}

/* ---- rotations ----------------------------------------------------------- */

/* a b; out may be b. */
static void motion_multiply(const s32 a[4], const s32 b[4], s32 out[4])
{
	s64 w = (s64)a[0] * b[0] - (s64)a[1] * b[1] - (s64)a[2] * b[2] - (s64)a[3] * b[3];
	s64 x = (s64)a[0] * b[1] + (s64)a[1] * b[0] + (s64)a[2] * b[3] - (s64)a[3] * b[2];
	s64 y = (s64)a[0] * b[2] - (s64)a[1] * b[3] + (s64)a[2] * b[0] + (s64)a[3] * b[1];
	s64 z = (s64)a[0] * b[3] + (s64)a[1] * b[2] - (s64)a[2] * b[1] + (s64)a[3] * b[0];

	out[0] = motion_round(w, MOTION_Q);
	out[1] = motion_round(x, MOTION_Q);
	out[2] = motion_round(y, MOTION_Q);
	out[3] = motion_round(z, MOTION_Q);
}

/* To unit length from 2^-10 beside it: Newton's steps for 1 / |q|, each squares the error. */
static void motion_normalize(s32 q[4])
{
	int step, i;

	for (step = 0; step < 3; step++) {
		s64 square = 0;

		for (i = 0; i < 4; i++)
			square += (s64)q[i] * q[i];
		square = motion_round(square, MOTION_Q);
		for (i = 0; i < 4; i++)
			q[i] = motion_round(q[i] * (3 * MOTION_ONE - square), MOTION_Q + 1);
	}
}

static void motion_matrix(const s32 q[4], s32 m[3][3])
{
	s64 xx = (s64)q[1] * q[1], yy = (s64)q[2] * q[2], zz = (s64)q[3] * q[3];
	s64 xy = (s64)q[1] * q[2], xz = (s64)q[1] * q[3], yz = (s64)q[2] * q[3];
	s64 wx = (s64)q[0] * q[1], wy = (s64)q[0] * q[2], wz = (s64)q[0] * q[3];

	/* the two in 1 - 2 (yy + zz) is in the shift */
	m[0][0] = MOTION_ONE - motion_round(yy + zz, MOTION_Q - 1);
	m[1][1] = MOTION_ONE - motion_round(xx + zz, MOTION_Q - 1);
	m[2][2] = MOTION_ONE - motion_round(xx + yy, MOTION_Q - 1);
	m[0][1] = motion_round(xy - wz, MOTION_Q - 1);
	m[1][0] = motion_round(xy + wz, MOTION_Q - 1);
	m[0][2] = motion_round(xz + wy, MOTION_Q - 1);
	m[2][0] = motion_round(xz - wy, MOTION_Q - 1);
	m[1][2] = motion_round(yz - wx, MOTION_Q - 1);
	m[2][1] = motion_round(yz + wx, MOTION_Q - 1);
}

/* ---- motions ------------------------------------------------------------- */

/* Direction and length of w: the square is brought up first, so that its root keeps 30 bits. */
static void motion_take_apart(struct phantom_motion *motion)
{
	u64 square = 0, root;
	u32 shift;
	int axis;

	for (axis = 0; axis < 3; axis++) {
		s64 about = motion->turn_urad_s[axis];

		square += (u64)(about *
				about); /* <= PHANTOM_OBJECT_TURN_MAX_URAD_S squared: 2^53.2 */
	}
	if (!square) {
		memset(motion->axis_q30, 0, sizeof(motion->axis_q30));
		motion->half_rate = 0;
		return;
	}
	for (shift = 0; square << 2 * shift < 1ULL << 60; shift++)
		;
	root = int_sqrt64(square << 2 * shift); /* |w| 2^shift, 2^30 ... 2^31 */
	for (axis = 0; axis < 3; axis++)
		motion->axis_q30[axis] =
			motion->turn_urad_s[axis] * (1LL << (MOTION_Q + shift)) / (s64)root;
	motion->half_rate = root * MOTION_RATE >> (MOTION_RATE_Q + shift);
}

void phantom_motion_init(struct phantom_motion *motion, const struct phantom_object *object,
			 u64 time_ns)
{
	motion->time_ns = time_ns;
	memcpy(motion->translation_nm, object->translation_nm, sizeof(motion->translation_nm));
	memcpy(motion->rotation_q30, object->rotation_q30, sizeof(motion->rotation_q30));
	memcpy(motion->velocity_nm_s, object->velocity_nm_s, sizeof(motion->velocity_nm_s));
	memcpy(motion->turn_urad_s, object->angular_velocity_urad_s, sizeof(motion->turn_urad_s));
	motion_normalize(motion->rotation_q30);
	motion_take_apart(motion);
}

/* Beside the pose so far. */
static void motion_add_offset(const struct phantom_offset *offset, u64 now_ns,
			      struct phantom_pose *pose)
{
	u64 elapsed_ns = now_ns - offset->begin_ns;
	s64 left, second, square = 0;
	s32 turn[4];
	int axis;

	if (elapsed_ns >= offset->length_ns)
		return;
	left = ((offset->length_ns - elapsed_ns) << MOTION_Q) / offset->length_ns;
	for (axis = 0; axis < 3; axis++) {
		pose->translation_nm[axis] += motion_round(offset->shift_nm[axis] * left, MOTION_Q);
		turn[1 + axis] = motion_round(offset->turn_q30[axis] * left, MOTION_Q);
		square += (s64)turn[1 + axis] * turn[1 + axis];
	}
	/* sqrt(1 - s) = 1 - s/2 - s^2/8 - s^3/16 - ...; s is 0.01 at most, what is left out 4e-10 */
	square = motion_round(square, MOTION_Q);
	second = motion_round(square * square, MOTION_Q);
	turn[0] = MOTION_ONE - motion_round(square, 1) - motion_round(second, 3) -
		  motion_round(second * square, MOTION_Q + 4);
	motion_multiply(turn, pose->rotation_q30, pose->rotation_q30);
}

void phantom_motion_at(const struct phantom_motion *motion, const struct phantom_offset *offset,
		       u64 now_ns, struct phantom_pose *pose)
{
	s64 since_ns = (s64)(now_ns - motion->time_ns);
	s64 dt_ns = clamp_t(s64, since_ns, -PHANTOM_MOTION_MAX_NS, PHANTOM_MOTION_MAX_NS);
	s64 sine, cosine;
	s32 turn[4];
	int axis;

	pose->stopped = dt_ns != since_ns;
	motion_sine((u64)dt_ns * motion->half_rate, &sine, &cosine);
	turn[0] = cosine;
	for (axis = 0; axis < 3; axis++) {
		s64 way = motion->velocity_nm_s[axis] * dt_ns; /* below 2^61 */

		pose->translation_nm[axis] = motion->translation_nm[axis] + way / NSEC_PER_SEC;
		turn[1 + axis] = motion_round(motion->axis_q30[axis] * sine, MOTION_Q);
	}
	motion_multiply(turn, motion->rotation_q30, pose->rotation_q30);
	if (offset && offset->length_ns)
		motion_add_offset(offset, now_ns, pose);
	motion_matrix(pose->rotation_q30, pose->matrix_q30);
}

static u64 motion_square(const s64 v[3])
{
	return (u64)(v[0] * v[0]) + (u64)(v[1] * v[1]) + (u64)(v[2] * v[2]);
}

/* How far the same tip is from itself in the two, in the frame. False: farther than a jump. */
static bool motion_near(const struct phantom_pose *before, const struct phantom_pose *after,
			const s64 tip_nm[3])
{
	s64 a[3], b[3], way[3];
	int axis;

	if (!phantom_pose_enter(before, tip_nm, a) || !phantom_pose_enter(after, tip_nm, b))
		return false;
	for (axis = 0; axis < 3; axis++) {
		way[axis] = a[axis] - b[axis];
		if (way[axis] > PHANTOM_MOTION_JUMP_NM || way[axis] < -PHANTOM_MOTION_JUMP_NM)
			return false;
	}
	return motion_square(way) <= (u64)PHANTOM_MOTION_JUMP_NM * PHANTOM_MOTION_JUMP_NM;
}

bool phantom_motion_offset(const struct phantom_pose *before, const struct phantom_pose *after,
			   const s64 tip_nm[3], u64 now_ns, u64 length_ns,
			   struct phantom_offset *offset)
{
	const s32 *q = after->rotation_q30;
	const s32 back[4] = {q[0], -q[1], -q[2], -q[3]};
	s32 turn[4];
	s64 e[3];
	int axis;

	memset(offset, 0, sizeof(*offset));
	if (!motion_near(before, after, tip_nm))
		return false;
	motion_multiply(before->rotation_q30, back, turn);
	for (axis = 0; axis < 3; axis++) {
		/* q and -q are one rotation */
		e[axis] = turn[0] < 0 ? -(s64)turn[1 + axis] : turn[1 + axis];
		offset->shift_nm[axis] = before->translation_nm[axis] - after->translation_nm[axis];
		offset->turn_q30[axis] = e[axis];
	}
	if (motion_square(e) > (u64)(MOTION_JUMP_TURN * MOTION_JUMP_TURN)) {
		memset(offset, 0, sizeof(*offset));
		return false;
	}
	offset->begin_ns = now_ns;
	offset->length_ns = length_ns;
	return true;
}

/* ---- poses --------------------------------------------------------------- */

void phantom_pose_turn_in(const struct phantom_pose *pose, const s64 outer[3], s64 inner[3])
{
	const s32(*m)[3] = pose->matrix_q30;
	s64 x = outer[0], y = outer[1], z = outer[2];
	int axis;

	for (axis = 0; axis < 3; axis++)
		inner[axis] =
			motion_round(m[0][axis] * x + m[1][axis] * y + m[2][axis] * z, MOTION_Q);
}

void phantom_pose_turn_out(const struct phantom_pose *pose, const s64 inner[3], s64 outer[3])
{
	const s32(*m)[3] = pose->matrix_q30;
	s64 x = inner[0], y = inner[1], z = inner[2];
	int axis;

	for (axis = 0; axis < 3; axis++)
		outer[axis] =
			motion_round(m[axis][0] * x + m[axis][1] * y + m[axis][2] * z, MOTION_Q);
}

bool phantom_pose_enter(const struct phantom_pose *pose, const s64 place_nm[3], s64 inner_nm[3])
{
	s64 way[3];
	int axis;

	for (axis = 0; axis < 3; axis++) {
		/* both are near PHANTOM_POSITION_MAX_NM at most: the difference cannot overflow */
		way[axis] = place_nm[axis] - pose->translation_nm[axis];
		if (way[axis] > PHANTOM_FRAME_MAX_NM || way[axis] < -PHANTOM_FRAME_MAX_NM)
			return false;
	}
	phantom_pose_turn_in(pose, way, inner_nm);
	return true;
}

void phantom_pose_leave(const struct phantom_pose *pose, const s64 inner_nm[3], s64 place_nm[3])
{
	int axis;

	phantom_pose_turn_out(pose, inner_nm, place_nm);
	for (axis = 0; axis < 3; axis++)
		place_nm[axis] += pose->translation_nm[axis];
}

void phantom_motion_velocity(const struct phantom_motion *motion, const struct phantom_pose *pose,
			     const s64 place_nm[3], s64 velocity_nm_s[3])
{
	const s32 *w = motion->turn_urad_s;
	s64 r[3];
	int axis;

	if (pose->stopped) {
		memset(velocity_nm_s, 0, 3 * sizeof(velocity_nm_s[0]));
		return;
	}
	for (axis = 0; axis < 3; axis++)
		r[axis] = place_nm[axis] - pose->translation_nm[axis];
	for (axis = 0; axis < 3; axis++) {
		int next = (axis + 1) % 3, last = (axis + 2) % 3;

		/* below 2^60: 1e8 urad/s, 4e9 nm, twice */
		velocity_nm_s[axis] = motion->velocity_nm_s[axis] +
				      (w[next] * r[last] - w[last] * r[next]) / URAD_PER_RAD;
	}
}
