/* SPDX-License-Identifier: GPL-2.0-only */
/*
 * sine.h - the sine of a phase: 2^64 is a whole wave, so phases wrap as integers do.
 */
#ifndef PHANTOM_FLOAT_SINE_H
#define PHANTOM_FLOAT_SINE_H

#include "../lanes.h"

/* 1/4 of a wave as a phase. */
#define PHASE_QUARTER (1ULL << 62)

/*
 * sin(2 pi phase 2^-64), within 4e-6: Taylor to the ninth order up to a quarter of a wave, the rest is
 * mirrored.
 */
static inline real phase_sine(u64 phase)
{
	s32 turn = (s32)(phase >> 32);
	real x, x2, sum;

	if (turn > (1 << 30) || turn < -(1 << 30))
		turn = (s32)((1U << 31) - (u32)turn);
	x = mul(real_ratio_of_nm(turn, 1LL << 32), REAL(6.283185307179586));
	x2 = mul(x, x);
	sum = REAL(1.0 / 362880);
	sum = mul(sum, x2) - REAL(1.0 / 5040);
	sum = mul(sum, x2) + REAL(1.0 / 120);
	sum = mul(sum, x2) - REAL(1.0 / 6);
	sum = mul(sum, x2) + REAL(1);
	return mul(sum, x);
}

/*
 * What the servo's rate can carry of so many waves a tick: all up to 1/8, nothing from 1/4 on. Less than
 * four samples a wave are a buzz of another pitch.
 */
static inline real phase_band(real waves)
{
	return real_clamp(REAL(2) - 8 * waves, 0, REAL(1));
}

#endif /* PHANTOM_FLOAT_SINE_H */
