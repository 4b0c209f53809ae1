/* SPDX-License-Identifier: GPL-2.0-only */
/*
 * magnet.h - effect: surface magnetism, PHANTOM_EFFECT_MAGNET.
 *
 *   p < g:   N = -4 f (p/g) (1 - p/g)      g range, f force: it pulls, f at most, half way
 *   p >= g:  N = k (p - g)                 the surface, g farther in than without the magnet
 *
 * p is the depth that contact gives: the contact radius R reaches g farther than the surface is felt.
 * N is a function of p alone, 0 at its both borders: a potential, continuous, no energy is made; to
 * leave the surface the hand pays 2 f g / 3, and got as much on its way in. Where the magnet
 * lets go the force falls at 4 f / g per mm: that counts as stiffness in a sampled loop.
 * Limits: g < R; parameters of neighbouring materials are mixed by their parts of the contact.
 */
#ifndef PHANTOM_FLOAT_MAGNET_H
#define PHANTOM_FLOAT_MAGNET_H

#include "surface.h"

static inline void magnet_apply(const struct float_magnet *table, struct surface *surface)
{
	struct float_magnet magnet;
	real part, stiffness;

	surface_mean(surface, table, sizeof(magnet) / sizeof(real), (real *)&magnet);
	if (!(magnet.range > 0))
		return;
	if (surface->depth < magnet.range) {
		part = divide(surface->depth, magnet.range);
		surface->load = -4 * mul(magnet.force, mul(part, REAL(1) - part));
		surface->depth = 0;
		return;
	}
	stiffness = divide(surface->load, surface->depth);
	surface->depth -= magnet.range;
	surface->load = mul(stiffness, surface->depth);
}

#endif /* PHANTOM_FLOAT_MAGNET_H */
