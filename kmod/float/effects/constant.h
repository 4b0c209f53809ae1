/* SPDX-License-Identifier: GPL-2.0-only */
/*
 * constant.h - effect: a constant force, PHANTOM_EFFECT_CONSTANT: gravity, wind.
 *
 *   F += f          N, in world axes
 *
 * A potential, -f . P: no energy is made on any closed path. Limits: 100 N along an axis; what the
 * device may be asked for is cut by safety, not here.
 */
#ifndef PHANTOM_FLOAT_CONSTANT_H
#define PHANTOM_FLOAT_CONSTANT_H

#include "table.h"

static inline struct real3 constant_force(const struct float_constant *constant)
{
	return constant->force;
}

#endif /* PHANTOM_FLOAT_CONSTANT_H */
