/* SPDX-License-Identifier: GPL-2.0-only */
/*
 * phantom_effects_check.h - between the files that check a set's effect tables.
 *
 * Each check takes its effect's table from the walk, looks at every field and leaves the table's address
 * in copy->effects. False: the table is too short, or wrong. Submitter.
 */
#ifndef PHANTOM_EFFECTS_CHECK_H
#define PHANTOM_EFFECTS_CHECK_H

#include <phantom_platform.h>
#include "phantom_set.h"

/* Where the next table begins. */
struct phantom_table_walk {
	const u8 *at;
	u32 left;
};

/* The table of that many entries, or NULL: none, or the tables end before it does. */
static inline const void *phantom_table_take(struct phantom_table_walk *walk, u32 count,
					     size_t bytes)
{
	const void *table = walk->at;

	/* count is below 2^14, an entry shorter than 2^8: no product wraps */
	if (!count || count * bytes > walk->left)
		return NULL;
	walk->at += count * bytes;
	walk->left -= count * bytes;
	return table;
}

/* phantom_surface_check.c; materials are checked before */
bool phantom_check_magnets(struct phantom_set_copy *copy, struct phantom_table_walk *walk);
bool phantom_check_friction(struct phantom_set_copy *copy, struct phantom_table_walk *walk);
bool phantom_check_textures(struct phantom_set_copy *copy, struct phantom_table_walk *walk);
bool phantom_check_height_maps(struct phantom_set_copy *copy, struct phantom_table_walk *walk);
bool phantom_check_impacts(struct phantom_set_copy *copy, struct phantom_table_walk *walk);

/* phantom_space_check.c; the header is checked before */
bool phantom_check_constant(struct phantom_set_copy *copy, struct phantom_table_walk *walk);
bool phantom_check_viscosity(struct phantom_set_copy *copy, struct phantom_table_walk *walk);
bool phantom_check_guides(struct phantom_set_copy *copy, struct phantom_table_walk *walk);
bool phantom_check_field(struct phantom_set_copy *copy, struct phantom_table_walk *walk);

#endif /* PHANTOM_EFFECTS_CHECK_H */
