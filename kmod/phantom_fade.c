// SPDX-License-Identifier: GPL-2.0-only
/*
 * phantom_fade.c - the blend from the force that is to the force that shall be. Integers only.
 */
#include <phantom_platform.h>
#include "phantom_fade.h"

/* A square below this can be multiplied by PHANTOM_FADE_ONE. */
#define PHANTOM_FADE_SQUARE_MAX (1LL << (62 - PHANTOM_FADE_SHIFT))

void phantom_fade_reset(struct phantom_fade *fade)
{
	memset(fade, 0, sizeof(*fade));
}

/* a of phantom_fade.h. */
static s64 phantom_fade_part(const s32 from_un[3], const s32 target_un[3])
{
	s64 along = 0, square = 0;
	int axis;

	/* halves: three products below 2^60 */
	for (axis = 0; axis < 3; axis++) {
		along += (s64)(from_un[axis] / 2) * (target_un[axis] / 2);
		square += (s64)(target_un[axis] / 2) * (target_un[axis] / 2);
	}
	if (along <= 0)
		return 0;
	if (along >= square)
		return PHANTOM_FADE_ONE;
	while (square >= PHANTOM_FADE_SQUARE_MAX) {
		square /= 2;
		along /= 2;
	}
	return along * PHANTOM_FADE_ONE / square;
}

static bool phantom_fade_zero(const s32 force_un[3])
{
	return !force_un[0] && !force_un[1] && !force_un[2];
}

bool phantom_fade_begin(struct phantom_fade *fade, const s32 target_un[3], u64 now_ns,
			u64 length_ns)
{
	int axis;

	if (fade->active && fade->to_zero && phantom_fade_zero(target_un) &&
	    fade->begin_ns + fade->length_ns <= now_ns + length_ns)
		return false;
	fade->active = memcmp(fade->now_un, target_un, sizeof(fade->now_un)) != 0;
	if (!fade->active)
		return false;
	fade->part = phantom_fade_part(fade->now_un, target_un);
	for (axis = 0; axis < 3; axis++)
		fade->rest_un[axis] =
			fade->now_un[axis] - target_un[axis] * fade->part / PHANTOM_FADE_ONE;
	fade->begin_ns = now_ns;
	fade->length_ns = length_ns;
	return true;
}

bool phantom_fade_blend(struct phantom_fade *fade, const s32 target_un[3], u64 now_ns,
			s32 force_un[3])
{
	u64 elapsed = now_ns - fade->begin_ns;
	s64 left = 0, gain;
	int axis;

	if (fade->active && elapsed >= fade->length_ns)
		fade->active = false;
	if (fade->active)
		left = ((fade->length_ns - elapsed) << PHANTOM_FADE_SHIFT) / fade->length_ns;
	gain = PHANTOM_FADE_ONE - (PHANTOM_FADE_ONE - fade->part) * left / PHANTOM_FADE_ONE;
	for (axis = 0; axis < 3; axis++) {
		s64 force = target_un[axis] * gain + fade->rest_un[axis] * left;

		fade->now_un[axis] = clamp_t(s64, force / PHANTOM_FADE_ONE, -S32_MAX, S32_MAX);
	}
	fade->to_zero = phantom_fade_zero(target_un);
	memcpy(force_un, fade->now_un, sizeof(fade->now_un));
	return fade->active;
}
