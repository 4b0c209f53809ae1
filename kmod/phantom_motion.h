/* SPDX-License-Identifier: GPL-2.0-only */
/*
 * phantom_motion.h - where the frame of a moving object is. Integers only, any context.
 *
 *   p = T + M x                 x in the frame, p in the scene, nm
 *   T(t) = T0 + v dt            dt = t - t0, held within +-PHANTOM_MOTION_MAX_NS
 *   q(t) = (cos a, n sin a) q0  a = |w| dt / 2, n = w / |w|
 *
 * Length and direction of w are taken apart once a set. A tick has the half angle as a product that
 * wraps with the turns, sine and cosine from polynomials, and no division but those by constants.
 * Quaternion and matrix are Q1.30: a point a metre from the frame's origin is found to 10 nm and 1 nm for
 * each radian turned since t0, however long the motion goes on.
 *
 * AN OFFSET is what the frame was beside the pose that a new set gives, at the tick that took the set. It
 * goes to nothing in a straight line, so that no pose ever steps:
 *
 *   T += s shift,  q = (sqrt(1 - |s e|^2), s e) q,  s = 1 - (t - begin) / length,  then 0
 */
#ifndef PHANTOM_MOTION_H
#define PHANTOM_MOTION_H

#include <phantom_platform.h>
#include "phantom_abi.h"

/* Positions farther from a frame's origin along an axis have no place in it: the products stay in s64. */
#define PHANTOM_FRAME_MAX_NM 4000000000LL

/* What a set says, ready for ticks. */
struct phantom_motion {
	u64 time_ns; /* t0 */
	s64 translation_nm[3]; /* T0 */
	s32 rotation_q30[4]; /* q0: w x y z */
	s32 velocity_nm_s[3]; /* v */
	s32 turn_urad_s[3]; /* w */
	s32 axis_q30[3]; /* n; zero where w is */
	u64 half_rate; /* |w| / 2, in 2^-64 of a turn per ns */
};

struct phantom_offset {
	s64 shift_nm[3];
	s32 turn_q30[3]; /* e: half the angle's sine times the axis */
	u64 begin_ns;
	u64 length_ns; /* 0: there is none */
};

/* At one time. */
struct phantom_pose {
	s64 translation_nm[3]; /* T */
	s32 rotation_q30[4];
	s32 matrix_q30[3][3]; /* M */
	bool stopped; /* dt is held: the frame stands still */
};

/* `object` is valid and moves. */
void phantom_motion_init(struct phantom_motion *motion, const struct phantom_object *object,
			 u64 time_ns);
/* The pose at now_ns; a NULL offset is none. */
void phantom_motion_at(const struct phantom_motion *motion, const struct phantom_offset *offset,
		       u64 now_ns, struct phantom_pose *pose);
/*
 * The offset, to begin at now_ns, that makes the pose `before` of `after`. False: the two differ by a
 * jump (phantom_abi.h) for a tip there, and the offset is none.
 */
bool phantom_motion_offset(const struct phantom_pose *before, const struct phantom_pose *after,
			   const s64 tip_nm[3], u64 now_ns, u64 length_ns,
			   struct phantom_offset *offset);

/* x of p. False: p is too far away, and x is nothing. */
bool phantom_pose_enter(const struct phantom_pose *pose, const s64 place_nm[3], s64 inner_nm[3]);
/* p of x; x as enter() gives it, or within PHANTOM_OBJECT_REACH_NM and a set's coordinates. */
void phantom_pose_leave(const struct phantom_pose *pose, const s64 inner_nm[3], s64 place_nm[3]);
/* A vector's components in the frame, of those in the scene, and back; none beyond +-2^32. In place too. */
void phantom_pose_turn_in(const struct phantom_pose *pose, const s64 outer[3], s64 inner[3]);
void phantom_pose_turn_out(const struct phantom_pose *pose, const s64 inner[3], s64 outer[3]);
/* How fast the frame moves at a place in the scene that it has been entered at. */
void phantom_motion_velocity(const struct phantom_motion *motion, const struct phantom_pose *pose,
			     const s64 place_nm[3], s64 velocity_nm_s[3]);

#endif /* PHANTOM_MOTION_H */
