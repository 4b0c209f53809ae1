/* SPDX-License-Identifier: GPL-2.0-only */
/*
 * friction.h - effect: static and dynamic Coulomb friction, PHANTOM_EFFECT_FRICTION.
 *
 * A spring k_t from the tip P to a stick point A on the surface, that holds up to mu N:
 *
 *   z = (P - A) less its part along u,  L = k_t |z|
 *   L <= mu N:  sticks. A stays. mu grows back with what is let go of the load:
 *                 mu = max(mu, mu_s - (mu_s - mu_d) L / (mu_d N)) where L < mu_d N
 *   L >  mu N:  slides: e = L - mu N; mu goes towards
 *                 mu* = mu_d + (mu_s - mu_d) / (1 + (v/v_s)^2), or mu_d without v_s
 *               by e/N downwards or e/3N upwards, and A follows to where k_t |z| = mu N
 *   F = -k_t z
 *
 * Stick and slip by displacement, not by time: Hayward & Armstrong 2000, "A new computational model
 * of friction applied to haptic rendering". Nothing is integrated, so at rest nothing drifts, however
 * long and however much an encoder flickers. The Stribeck curve is Hess & Soom's (1990).
 *
 * CONTINUOUS. mu changes by 1/2 k_t/N per mm of slip and not faster: a slope of the load of k_t at
 * most. So static friction breaks away without a step, and where the surface's coefficients change
 * (another material) the force goes over to the new ones along the slip.
 *
 * PASSIVE. k_t z^2 / 2 is what the spring holds; A moves only towards P, which takes from it, and a
 * change of mu moves nothing but A. What N does is contact's own. On a surface curved by c the turn of
 * u leaves a part c z |z|^2 k_t of it. Sampled, k_t counts as stiffness: k_t T / 2 < the arm's own damping.
 *
 * A is no part of contact: the proxy goes on as without friction, and cannot be held by it.
 */
#ifndef PHANTOM_FLOAT_FRICTION_H
#define PHANTOM_FLOAT_FRICTION_H

#include "surface.h"

/* mu in phantom_stick.coefficient_q24. */
#define FRICTION_ONE (1 << 24)

/* z */
static inline struct real3 friction_deflection(const struct phantom_stick *stick,
					       const s32 tip_nm[3], struct real3 u)
{
	struct real3 way = nm_way(stick->anchor_nm, tip_nm);

	return real3_sub(way, real3_scale(u, real3_dot(way, u)));
}

/* mu* */
static inline real friction_target(const struct phantom_float_job *job,
				   const struct float_friction *law, struct real3 u)
{
	struct real3 v = {real_from_nm(job->velocity_nm_s[0]), real_from_nm(job->velocity_nm_s[1]),
			  real_from_nm(job->velocity_nm_s[2])};
	real speed2;

	if (!(law->speed2 > 0))
		return law->dynamic;
	v = real3_sub(v, real3_scale(u, real3_dot(v, u)));
	speed2 = real3_dot(v, v);
	return law->dynamic +
	       mul(law->statical - law->dynamic, divide(law->speed2, law->speed2 + speed2));
}

/* mu of a stick point that holds the load L. */
static inline real friction_hold(const struct float_friction *law, real mu, real load, real normal)
{
	real sliding = mul(law->dynamic, normal);
	real most = real_max(law->statical, divide(load, normal));
	real least = 0;

	if (load < sliding)
		least = law->statical - mul(law->statical - law->dynamic, divide(load, sliding));
	else if (!(load > 0))
		least = law->statical;
	return real_max(least, real_min(mu, most));
}

static inline real friction_slip(real mu, real target, real step)
{
	if (mu > target)
		return real_max(target, mu - step);
	return real_min(target, mu + mul(step, REAL(1.0 / 3)));
}

/* The force along the surface; the stick point goes to job->stick_next. */
static inline struct real3 friction_force(struct phantom_float_job *job,
					  const struct float_friction *table,
					  const struct surface *surface)
{
	const struct phantom_stick *stick = &job->stick;
	struct phantom_stick *next = &job->stick_next;
	struct float_friction law;
	struct real3 u = surface->direction, z = {0, 0, 0};
	real mu, load, excess;

	surface_mean(surface, table, sizeof(law) / sizeof(real), (real *)&law);
	*next = *stick;
	next->held = 1;
	mu = law.statical;
	if (stick->held) {
		mu = real_ratio_of_nm(stick->coefficient_q24, FRICTION_ONE);
		z = friction_deflection(stick, job->tip_nm, u);
	} else {
		nm_offset(job->tip_nm, z, next->anchor_nm);
	}
	load = mul(law.stiffness, real3_length(z));
	excess = load - mul(mu, surface->load);
	if (excess > 0) {
		mu = friction_slip(mu, friction_target(job, &law, u),
				   divide(excess, surface->load));
		z = real3_scale(z, real_min(REAL(1), divide(mul(mu, surface->load), load)));
		nm_offset(job->tip_nm, real3_scale(z, REAL(-1)), next->anchor_nm);
		/* as the next tick will find it */
		z = friction_deflection(next, job->tip_nm, u);
	} else {
		mu = friction_hold(&law, mu, load, surface->load);
	}
	next->coefficient_q24 = (u32)real_to_integer(mu, FRICTION_ONE, &job->saturated);
	return real3_scale(z, -law.stiffness);
}

#endif /* PHANTOM_FLOAT_FRICTION_H */
