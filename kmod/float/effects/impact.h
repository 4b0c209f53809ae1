/* SPDX-License-Identifier: GPL-2.0-only */
/*
 * impact.h - effect: the ring of a surface that is hit, PHANTOM_EFFECT_IMPACT.
 *
 *   where contact begins, at an approach speed v = -V . u > 0:   A = min(a v, f_max), n = u, t = 0
 *   F += n g c A exp(-t / tau) sin(2 pi f t)
 *   c = min(1, 2 E / E_0),  E_0 = A v / (2 pi f)      E: what the ring may still give
 *   g = 1 in contact; without it falls to 0 within IMPACT_QUIET, and does not rise again
 *
 * Event-based haptics: what tells a hard surface from a soft one is the transient at the tap, which no
 * spring of a sampled loop is stiff enough to give (Okamura, Dennerlein & Howe 1998, "Vibration feedback
 * models for virtual environments"; Kuchenbecker, Fiene & Niemeyer 2006). The first half wave pushes out.
 *
 * ENERGY. What F does to the tip is added up, from tick to tick, and E falls by it (time-domain passivity,
 * Hannaford & Ryu 2002); c ends the ring as E ends. So a hit gives E_0 at most, and what one tick does
 * beyond: with a limit of a / (2 pi f) = mu it is mu v^2, 2 mu / m of what an arm of mass m brought along.
 * A tip that moves with what the ring does to an arm of m >= 2 mu takes less and never comes to feel c.
 *
 * AGAIN only after IMPACT_QUIET without contact, when g has ended the ring before: chatter rings once, and
 * no ring begins or ends in a step. F is 0 at t = 0.
 *
 * BAND LIMIT. Full up to 1/8 of the servo's rate, gone at 1/4. The law is that of the material, or mean of
 * materials, that was hit, until the ring is over.
 */
#ifndef PHANTOM_FLOAT_IMPACT_H
#define PHANTOM_FLOAT_IMPACT_H

#include "sine.h"
#include "surface.h"

#define IMPACT_QUIET 10000000U /* ns */

/* Beyond so many tau a ring is over: 6e-6 of it is left. */
#define IMPACT_END 12

/* 2^64 / 1e9: a wave per second in 2^-64 of a wave per ns. */
#define WAVE_PER_SECOND 18446744073ULL

_Static_assert(sizeof(struct phantom_ring) == 8 + 12 * 4, "jobs are compared as bytes: no hole");

#define NJ_PER_MJ 1000000 /* N mm are mJ */
#define IMPACT_ENERGY_MOST REAL(2000) /* mJ; more gives no hit */

/* exp(-x) for 0 <= x <= IMPACT_END, within 1e-4 of itself: 1 / exp(x / 16), Taylor, four times squared. */
static inline real impact_decay(real x)
{
	real y = mul(x, REAL(1.0 / 16)), sum = REAL(1.0 / 120);
	u32 i;

	sum = mul(sum, y) + REAL(1.0 / 24);
	sum = mul(sum, y) + REAL(1.0 / 6);
	sum = mul(sum, y) + REAL(0.5);
	sum = mul(sum, y) + REAL(1);
	sum = divide(REAL(1), mul(sum, y) + REAL(1));
	for (i = 0; i < 4; i++)
		sum = mul(sum, sum);
	return sum;
}

/* A hit, unless the tip does not come nearer. */
static inline void impact_begin(struct phantom_float_job *job, const struct float_impact *table,
				const struct surface *surface)
{
	struct phantom_ring *ring = &job->ring_next;
	struct real3 u = surface->direction;
	struct real3 v = {real_from_nm(job->velocity_nm_s[0]), real_from_nm(job->velocity_nm_s[1]),
			  real_from_nm(job->velocity_nm_s[2])};
	real speed = -real3_dot(v, u), amplitude, energy;
	struct float_impact law;
	real rings = 0;
	u32 m;

	surface_mean(surface, table, sizeof(law) / sizeof(real), (real *)&law);
	for (m = 0; m < surface->materials; m++)
		if (table[m].frequency > 0)
			rings += surface->weight[m];
	amplitude = real_min(mul(law.gain, speed), law.force);
	if (!(speed > 0) || !(amplitude > 0))
		return;
	/* of those that ring at all */
	law.frequency = divide(law.frequency, rings);
	law.decay = divide(law.decay, rings);
	ring->frequency_hz = (u32)real_to_integer(law.frequency, 1, &job->saturated);
	ring->decay_us = (u32)real_to_integer(law.decay, 1000000, &job->saturated);
	if (!ring->frequency_hz || !ring->decay_us)
		return;
	energy = divide(mul(amplitude, speed), mul(REAL(6.283185307179586), law.frequency));
	energy = real_min(energy, IMPACT_ENERGY_MOST);
	ring->amplitude_un = real_to_integer(amplitude, 1000000, &job->saturated);
	ring->energy_nj = real_to_integer(energy, NJ_PER_MJ, &job->saturated);
	ring->left_nj = ring->energy_nj;
	ring->normal_q30[0] = real_to_integer(u.x, PHANTOM_Q30_ONE, &job->saturated);
	ring->normal_q30[1] = real_to_integer(u.y, PHANTOM_Q30_ONE, &job->saturated);
	ring->normal_q30[2] = real_to_integer(u.z, PHANTOM_Q30_ONE, &job->saturated);
	ring->age_ns = 0;
	ring->gate_ns = IMPACT_QUIET;
}

/* E, after what the last force has done on the way to here. */
static inline void impact_pay(const struct phantom_float_job *job, struct real3 normal,
			      struct phantom_ring *ring)
{
	real way = real3_dot(normal, nm_way(job->previous_nm, job->tip_nm));
	real left = real_ratio_of_nm(ring->left_nj, NJ_PER_MJ);
	real energy = real_ratio_of_nm(ring->energy_nj, NJ_PER_MJ);
	u32 saturated = 0;

	left -= mul(real_ratio_of_nm(ring->force_un, 1000000), way);
	ring->left_nj = real_to_integer(real_clamp(left, 0, energy), NJ_PER_MJ, &saturated);
}

/* A period goes by. */
static inline void impact_age(const struct phantom_float_job *job, bool touched,
			      struct phantom_ring *ring)
{
	if (ring->age_ns <= (u64)IMPACT_END * 1000 * PHANTOM_IMPACT_DECAY_MAX_US)
		ring->age_ns += job->period_ns;
	if (touched) {
		ring->wait_ns = IMPACT_QUIET;
		return;
	}
	ring->wait_ns -= ring->wait_ns < job->period_ns ? ring->wait_ns : job->period_ns;
	if (ring->gate_ns > ring->wait_ns)
		ring->gate_ns = ring->wait_ns;
}

/* surface: NULL without contact. */
static inline struct real3 impact_force(struct phantom_float_job *job,
					const struct float_impact *table,
					const struct surface *surface)
{
	const struct phantom_ring *before = &job->ring;
	struct phantom_ring *ring = &job->ring_next;
	struct real3 normal;
	real force, decay;

	*ring = *before;
	impact_age(job, surface != 0, ring);
	/* where the path means nothing the tip has not come from outside */
	if (surface && !before->wait_ns && job->path_valid)
		impact_begin(job, table, surface);
	ring->force_un = 0;
	if (!ring->gate_ns)
		return (struct real3){0, 0, 0};
	normal = (struct real3){real_ratio_of_nm(ring->normal_q30[0], PHANTOM_Q30_ONE),
				real_ratio_of_nm(ring->normal_q30[1], PHANTOM_Q30_ONE),
				real_ratio_of_nm(ring->normal_q30[2], PHANTOM_Q30_ONE)};
	ring->force_un = before->force_un;
	impact_pay(job, normal, ring);
	ring->force_un = 0;
	decay = real_ratio_of_nm((s64)ring->age_ns, 1000 * (s64)ring->decay_us);
	if (decay > REAL(IMPACT_END) || ring->energy_nj <= 0)
		return (struct real3){0, 0, 0};
	force = real_ratio_of_nm(ring->amplitude_un, 1000000);
	force = mul(force, mul(impact_decay(decay),
			       phase_sine(ring->age_ns * ring->frequency_hz * WAVE_PER_SECOND)));
	force = mul(force, real_min(REAL(1), 2 * real_ratio_of_nm(ring->left_nj, ring->energy_nj)));
	force = mul(force, real_ratio_of_nm(ring->gate_ns, IMPACT_QUIET));
	force = mul(force, phase_band(real_ratio_of_nm((s64)ring->frequency_hz * job->period_ns,
						       1000000000)));
	ring->force_un = real_to_integer(force, 1000000, &job->saturated);
	return real3_scale(normal, force);
}

#endif /* PHANTOM_FLOAT_IMPACT_H */
