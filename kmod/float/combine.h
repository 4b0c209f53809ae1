/* SPDX-License-Identifier: GPL-2.0-only */
/*
 * combine.h - from the forces of the patches to one force.
 *
 * The order of summation is part of the definition, so that every width gives the same bits:
 * column l (0 ... 15) adds patches l, l + 16, l + 32, ... in that order, then the columns are added
 * from 0 to 15. A patch without contact adds +0, so leaving out a whole step changes nothing.
 */
#ifndef PHANTOM_FLOAT_COMBINE_H
#define PHANTOM_FLOAT_COMBINE_H

#include "block.h"

/* combine=paper: below this part of max |s| the sum has no direction and the force is 0. */
#define OPPOSED REAL(1e-9)

/* What a contact model hands on. */
struct contact_force {
	struct real3 force; /* N */
	struct real3 normal; /* unit; 0 without contact */
	real damping; /* of the materials touched, weighted by force, N per mm/s */
	real deepest; /* least height of a contact, mm; the patch: */
	u32 deepest_patch; /* inside: V's */
	u32 contacts;
	u32 folded;
};

struct columns {
	struct lanes3 sum[PHANTOM_STEPS];
	lanes most[PHANTOM_STEPS]; /* max |s| */
};

LANES_INLINE void columns_add(struct columns *columns, u32 step, struct lanes3 normal,
			      lanes magnitude)
{
	columns->sum[step] =
		lanes3_add(columns->sum[step], lanes3_scale_fitting(normal, magnitude));
	columns->most[step] = lanes_max(columns->most[step], magnitude);
}

static inline struct real3 columns_total(const struct columns *columns)
{
	struct real3 total = {0, 0, 0};
	u32 column;

	for (column = 0; column < PHANTOM_BLOCK; column++)
		total = real3_add(total, lanes3_lane(columns->sum[column / PHANTOM_LANES],
						     column % PHANTOM_LANES));
	return total;
}

static inline real columns_most(const struct columns *columns)
{
	real most = 0;
	u32 column;

	for (column = 0; column < PHANTOM_BLOCK; column++)
		most = real_max(most, row_lane(columns->most, column));
	return most;
}

/*
 * combine=paper:    F = S max|s| / |S|, and 0 where the s oppose each other
 * combine=bounded:  F = S min(1, max|s| / |S|)
 */
static inline struct real3 combine_paper(struct real3 sum, real most, u32 rule)
{
	real length = real3_length(sum);

	if (!(length > mul(OPPOSED, most)))
		return (struct real3){0, 0, 0};
	if (rule == PHANTOM_COMBINE_PAPER)
		return real3_scale(sum, divide(most, length));
	return real3_scale(sum, real_min(REAL(1), divide(most, length)));
}

/* The normal of a contact is the direction of its force; 0 without one. */
static inline void contact_direction(struct contact_force *out)
{
	out->normal = real3_unit(out->force);
}

#endif /* PHANTOM_FLOAT_COMBINE_H */
