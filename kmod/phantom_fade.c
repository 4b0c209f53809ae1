// SPDX-License-Identifier: GPL-2.0-only
/*
 * phantom_fade.c - the blend from the force that is to the force that shall be. Integers only.
 */
#include <phantom_platform.h>
#include "phantom_fade.h"

void phantom_fade_reset(struct phantom_fade *fade)
{
	memset(fade, 0, sizeof(*fade));
}

bool phantom_fade_begin(struct phantom_fade *fade, const s32 target_un[3], u64 now_ns)
{
	if (!memcmp(fade->now_un, target_un, sizeof(fade->now_un)))
		return false;
	memcpy(fade->from_un, fade->now_un, sizeof(fade->from_un));
	fade->begin_ns = now_ns;
	fade->active = true;
	return true;
}

bool phantom_fade_blend(struct phantom_fade *fade, const s32 target_un[3], u64 now_ns,
			s32 force_un[3])
{
	u64 elapsed = now_ns - fade->begin_ns;
	int axis;

	if (fade->active && elapsed >= PHANTOM_FADE_NS)
		fade->active = false;
	for (axis = 0; axis < 3; axis++) {
		s64 force = target_un[axis];

		/* |difference| < 2^32, elapsed < 2^25: within s64 */
		if (fade->active)
			force = fade->from_un[axis] +
				(force - fade->from_un[axis]) * (s64)elapsed / PHANTOM_FADE_NS;
		fade->now_un[axis] = force;
	}
	memcpy(force_un, fade->now_un, sizeof(fade->now_un));
	return fade->active;
}
