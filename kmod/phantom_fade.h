/* SPDX-License-Identifier: GPL-2.0-only */
/*
 * phantom_fade.h - the blend from the force that is to the force that shall be.
 *
 *     F(t) = from + (target(t) - from) (t - begin) / PHANTOM_FADE_NS,   then target(t)
 *
 * A fade begun while another runs starts from where that one is: the output never steps. Servo
 * only.
 */
#ifndef PHANTOM_FADE_H
#define PHANTOM_FADE_H

#include <phantom_platform.h>
#include "phantom_abi.h"

struct phantom_fade {
	s32 now_un[3]; /* what the last blend gave */
	s32 from_un[3];
	u64 begin_ns;
	bool active;
};

/* No fade, force zero. */
void phantom_fade_reset(struct phantom_fade *fade);
/* From the present force to `target`, unless they are the same. True when a fade began. */
bool phantom_fade_begin(struct phantom_fade *fade, const s32 target_un[3], u64 now_ns);
/* The force at now_ns; true while the fade lasts. */
bool phantom_fade_blend(struct phantom_fade *fade, const s32 target_un[3], u64 now_ns,
			s32 force_un[3]);

#endif /* PHANTOM_FADE_H */
