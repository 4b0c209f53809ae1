/* SPDX-License-Identifier: GPL-2.0-only */
/*
 * phantom_fade.h - the blend from the force that is to the force that shall be. Servo only.
 *
 * The target goes on changing while a fade lasts: the tip moves. What must go away is not the old
 * force but what it had, at the begin, beyond the target T0 of that moment. So the old force is
 * taken apart once, into a part of T0 and a rest, and only the rest and the missing part fade:
 *
 *     from = a T0 + rest,   a = from . T0 / |T0|^2, within 0 ... 1
 *     F(t) = T(t) (1 - (1 - a) s) + rest s,   s = 1 - (t - begin) / length,   then T(t)
 *
 * Two shapes of a surface that differ by little have a near 1 and a small rest: F follows the new
 * surface from the first tick on. A force that comes up from nothing has a = 0 and no rest: F is a
 * part of the target, and never points against it. A target that is zero leaves a plain fade-out.
 * |rest| <= |from|, so |F| <= |T| + |from| s.
 *
 * At the begin F is `from`, and a fade begun while another runs starts from where that one is: the
 * output never steps. A fade-out that would not end later than the new one goes on instead: however
 * many reasons there are one after the other, the force is gone in the time of one.
 */
#ifndef PHANTOM_FADE_H
#define PHANTOM_FADE_H

#include <phantom_platform.h>
#include "phantom_abi.h"

/* A fade's parts of one. Forces are below 2^31 and lengths below 2^34 ns: products stay in s64. */
#define PHANTOM_FADE_SHIFT 28
#define PHANTOM_FADE_ONE (1LL << PHANTOM_FADE_SHIFT)

struct phantom_fade {
	s32 now_un[3]; /* what the last blend gave */
	s64 rest_un[3];
	s64 part; /* a, of PHANTOM_FADE_ONE */
	u64 begin_ns;
	u64 length_ns;
	bool active;
	bool to_zero; /* the last blend's target was zero */
};

/* No fade, force zero. */
void phantom_fade_reset(struct phantom_fade *fade);
/*
 * From the present force to `target` in length_ns (1 ... PHANTOM_RAMP_MAX_MS), unless they are the
 * same. True when a fade began.
 */
bool phantom_fade_begin(struct phantom_fade *fade, const s32 target_un[3], u64 now_ns,
			u64 length_ns);
/* The force at now_ns; true while the fade lasts. */
bool phantom_fade_blend(struct phantom_fade *fade, const s32 target_un[3], u64 now_ns,
			s32 force_un[3]);

#endif /* PHANTOM_FADE_H */
