/* SPDX-License-Identifier: GPL-2.0-only */
/*
 * table.h - the parameters of a set's effects as the tick reads them, behind the set's scratch.
 *
 * Each effect that is named has a block here, each that is not has none; damping has its parameter in
 * the material. Where each block begins stands in the first one, struct float_effects.
 */
#ifndef PHANTOM_FLOAT_EFFECT_TABLE_H
#define PHANTOM_FLOAT_EFFECT_TABLE_H

#include "../block.h"
#include "../wide3.h"

#define EFFECT_MAGNET 0
#define EFFECT_FRICTION 1
#define EFFECT_TEXTURE 2
#define EFFECT_HEIGHT_MAP 3
#define EFFECT_IMPACT 4
#define EFFECT_WEIGHTS 5 /* scratch: how much of the contact each material has */
#define EFFECT_CONSTANT 6
#define EFFECT_VISCOSITY 7
#define EFFECT_GUIDE 8
#define EFFECT_FIELD 9
#define EFFECT_BLOCKS 10

/* Surface effects that have tables. */
#define EFFECTS_TOUCH (PHANTOM_EFFECTS_SURFACE & ~PHANTOM_EFFECT_DAMPING)

struct float_effects {
	u32 offset[EFFECT_BLOCKS + 1]; /* of each block, from here, bytes; the last: of their end */
	u32 viscosity_count;
	u32 guide_count;
};

/* Of one material; all 0: it does not name the effect. */
struct float_magnet {
	real range; /* mm */
	real force; /* N */
};

struct float_friction {
	real statical, dynamic; /* coefficients */
	real stiffness; /* N/mm */
	real speed2; /* of Stribeck, (mm/s)^2 */
};

struct float_grating {
	u64 wave[3]; /* 2^-64 of a wave per nm: phases wrap as the integers do */
	u64 phase; /* at the set's origin */
	real amplitude; /* mm */
	struct real3 per_mm; /* waves per mm */
	struct real3 slope; /* 2 pi amplitude per_mm */
};

struct float_texture {
	real amplitude; /* both gratings' sum, mm */
	struct float_grating grating[2];
};

struct float_height_map {
	const s32 *height_nm; /* [rows][columns], as submitted; NULL: the material names none */
	s64 origin_nm[3]; /* of the set */
	u64 step[2]; /* 2^-64 of the tile per nm, along columns and rows */
	u32 bits[2]; /* columns and rows, as powers of two */
	real per_mm; /* samples per mm */
	real amplitude; /* mm */
};

struct float_impact {
	real gain; /* N per mm/s */
	real force; /* N */
	real frequency; /* Hz */
	real decay; /* s */
};

struct float_constant {
	struct real3 force; /* N */
};

/* Places are relative to the set's origin. */
struct float_viscosity {
	s64 centre_nm[3];
	real radius, border; /* mm; 0 = everywhere */
	real viscosity; /* N per mm/s */
	real drag; /* N per (mm/s)^2 */
};

struct float_guide {
	s64 point_nm[3];
	struct real3 direction;
	u32 kind;
	real stiffness; /* N/mm */
	real most; /* N */
	real reach; /* mm; 0 = everywhere */
};

struct float_field {
	const s32 (*force_un)[3]; /* [z][y][x], as submitted */
	s64 corner_nm[3];
	u32 spacing_nm[3];
	u32 nodes[3];
	real inverse_border; /* 1 / mm */
};

LANES_INLINE struct float_effects *set_effects(const struct phantom_float_set *set)
{
	u64 scratch = (u64)(set->block_count + set->fan_block_count) * sizeof(union scratch);

	return (struct float_effects *)((u8 *)set + set->scratch_offset + scratch +
					SHELL_SCRATCH_BYTES);
}

LANES_INLINE void *effect_block(const struct float_effects *effects, u32 block)
{
	return (u8 *)effects + effects->offset[block];
}

/* ---- layout ---------------------------------------------------------------- */

/* Blocks follow each other in their order; sizes are multiples of 8. */
static inline void effects_lay_out(const struct phantom_effects *in, u32 materials, u32 offset[])
{
	const size_t bytes[EFFECT_BLOCKS] = {
		[EFFECT_MAGNET] = in->magnet ? materials * sizeof(struct float_magnet) : 0,
		[EFFECT_FRICTION] = in->friction ? materials * sizeof(struct float_friction) : 0,
		[EFFECT_TEXTURE] = in->texture ? materials * sizeof(struct float_texture) : 0,
		[EFFECT_HEIGHT_MAP] = in->mask & PHANTOM_EFFECT_HEIGHT_MAP
					      ? materials * sizeof(struct float_height_map)
					      : 0,
		[EFFECT_IMPACT] = in->impact ? materials * sizeof(struct float_impact) : 0,
		[EFFECT_WEIGHTS] = in->mask & EFFECTS_TOUCH ? materials * sizeof(real) : 0,
		[EFFECT_CONSTANT] = in->constant ? sizeof(struct float_constant) : 0,
		[EFFECT_VISCOSITY] = in->viscosity_count * sizeof(struct float_viscosity),
		[EFFECT_GUIDE] = in->guide_count * sizeof(struct float_guide),
		[EFFECT_FIELD] = in->field ? sizeof(struct float_field) : 0,
	};
	u32 at = sizeof(struct float_effects), block;

	for (block = 0; block < EFFECT_BLOCKS; block++) {
		at = (at + 7) & ~7U;
		offset[block] = at;
		at += (u32)bytes[block];
	}
	offset[EFFECT_BLOCKS] = (at + 7) & ~7U;
}

static size_t section_effect_bytes(const struct phantom_effects *effects, u32 material_count)
{
	u32 offset[EFFECT_BLOCKS + 1];

	effects_lay_out(effects, material_count, offset);
	return offset[EFFECT_BLOCKS];
}

#endif /* PHANTOM_FLOAT_EFFECT_TABLE_H */
