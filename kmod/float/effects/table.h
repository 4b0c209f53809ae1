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
#define EFFECT_WEIGHTS 3 /* scratch: how much of the contact each material has */
#define EFFECT_CONSTANT 4
#define EFFECT_VISCOSITY 5
#define EFFECT_GUIDE 6
#define EFFECT_BLOCKS 7

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
		[EFFECT_WEIGHTS] = in->mask & EFFECTS_TOUCH ? materials * sizeof(real) : 0,
		[EFFECT_CONSTANT] = in->constant ? sizeof(struct float_constant) : 0,
		[EFFECT_VISCOSITY] = in->viscosity_count * sizeof(struct float_viscosity),
		[EFFECT_GUIDE] = in->guide_count * sizeof(struct float_guide),
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

/* ---- conversion ------------------------------------------------------------ */

static inline real effect_real(s64 value, wide unit)
{
	return real_from_wide(wide_mul(wide_from_integer(value), unit));
}

static inline struct real3 effect_real3(const s32 value[3], wide unit)
{
	return (struct real3){effect_real(value[0], unit), effect_real(value[1], unit),
			      effect_real(value[2], unit)};
}

static inline void prepare_magnet(const struct phantom_magnet *in, struct float_magnet *out)
{
	out->range = effect_real(in->range_nm, WIDE(1e-6));
	out->force = effect_real(in->force_un, WIDE(1e-6));
}

static inline void prepare_friction(const struct phantom_friction *in, struct float_friction *out)
{
	real speed = effect_real(in->stribeck_um_s, WIDE(1e-3));

	out->statical = effect_real(in->static_ppm, WIDE(1e-6));
	out->dynamic = effect_real(in->dynamic_ppm, WIDE(1e-6));
	out->stiffness = effect_real(in->stiffness_mn_mm, WIDE(1e-3));
	out->speed2 = mul(speed, speed);
}

/* 2^64 / 1e12: one wave per km in 2^-64 of a wave per nm. */
#define WAVE_PER_KM 18446744ULL

static inline void prepare_grating(u32 amplitude_nm, const s32 wave_per_km[3],
				   const s64 origin_nm[3], struct float_grating *out)
{
	u32 axis;

	out->phase = 0;
	for (axis = 0; axis < 3; axis++) {
		out->wave[axis] = (u64)(s64)wave_per_km[axis] * WAVE_PER_KM;
		out->phase += (u64)origin_nm[axis] * out->wave[axis];
	}
	out->amplitude = effect_real(amplitude_nm, WIDE(1e-6));
	out->per_mm = effect_real3(wave_per_km, WIDE(1e-6));
	out->slope = effect_real3(wave_per_km, wide_mul(WIDE(6.283185307179586e-12),
							wide_from_integer(amplitude_nm)));
}

static inline void prepare_texture(const struct phantom_texture *in, const s64 origin_nm[3],
				   struct float_texture *out)
{
	u32 i;

	for (i = 0; i < 2; i++)
		prepare_grating(in->amplitude_nm[i], in->wave_per_km[i], origin_nm,
				&out->grating[i]);
	out->amplitude = out->grating[0].amplitude + out->grating[1].amplitude;
}

static inline void prepare_surfaces(const struct phantom_float_prepare *prepare,
				    const struct float_effects *out)
{
	const struct phantom_effects *in = prepare->effects;
	const struct phantom_magnet *magnet = in->magnet;
	const struct phantom_friction *friction = in->friction;
	const struct phantom_texture *texture = in->texture;
	struct float_magnet *magnets = effect_block(out, EFFECT_MAGNET);
	struct float_friction *frictions = effect_block(out, EFFECT_FRICTION);
	struct float_texture *textures = effect_block(out, EFFECT_TEXTURE);
	u32 i;

	for (i = 0; i < prepare->material_count; i++) {
		u32 names = prepare->materials[i].effects;

		if (in->magnet) {
			magnets[i] = (struct float_magnet){.range = 0};
			if (names & PHANTOM_EFFECT_MAGNET)
				prepare_magnet(magnet++, &magnets[i]);
		}
		if (in->friction) {
			frictions[i] = (struct float_friction){.statical = 0};
			if (names & PHANTOM_EFFECT_FRICTION)
				prepare_friction(friction++, &frictions[i]);
		}
		if (in->texture) {
			textures[i] = (struct float_texture){.amplitude = 0};
			if (names & PHANTOM_EFFECT_TEXTURE)
				prepare_texture(texture++, prepare->origin_nm, &textures[i]);
		}
	}
}

static inline void effect_place(const s64 place_nm[3], const s64 origin_nm[3], s64 out_nm[3])
{
	u32 axis;

	for (axis = 0; axis < 3; axis++)
		out_nm[axis] = place_nm[axis] - origin_nm[axis];
}

static inline void prepare_region(const struct phantom_viscosity *in, const s64 origin_nm[3],
				  struct float_viscosity *out)
{
	effect_place(in->centre_nm, origin_nm, out->centre_nm);
	out->radius = effect_real(in->radius_nm, WIDE(1e-6));
	out->border = effect_real(in->border_nm, WIDE(1e-6));
	/* mN s/m = 1e-6 N per mm/s, mN s^2/m^2 = 1e-9 N per (mm/s)^2 */
	out->viscosity = effect_real(in->viscosity_mns_m, WIDE(1e-6));
	out->drag = effect_real(in->drag_mns2_m2, WIDE(1e-9));
}

static inline void prepare_guide(const struct phantom_guide *in, const s64 origin_nm[3],
				 struct float_guide *out)
{
	effect_place(in->point_nm, origin_nm, out->point_nm);
	out->direction = effect_real3(in->direction_q30, WIDE(1.0 / PHANTOM_Q30_ONE));
	out->kind = in->kind;
	out->stiffness = effect_real(in->stiffness_mn_mm, WIDE(1e-3));
	out->most = effect_real(in->force_un, WIDE(1e-6));
	out->reach = effect_real(in->reach_nm, WIDE(1e-6));
}

static inline void prepare_space(const struct phantom_float_prepare *prepare,
				 const struct float_effects *out)
{
	const struct phantom_effects *in = prepare->effects;
	struct float_constant *constant = effect_block(out, EFFECT_CONSTANT);
	struct float_viscosity *regions = effect_block(out, EFFECT_VISCOSITY);
	struct float_guide *guides = effect_block(out, EFFECT_GUIDE);
	u32 i;

	if (in->constant)
		constant->force = effect_real3(in->constant->force_un, WIDE(1e-6));
	for (i = 0; i < in->viscosity_count; i++)
		prepare_region(&in->viscosity[i], prepare->origin_nm, &regions[i]);
	for (i = 0; i < in->guide_count; i++)
		prepare_guide(&in->guide[i], prepare->origin_nm, &guides[i]);
}

/* After the header of the set. Bounded: 16 materials, twice 8 regions. */
LANES_NOINLINE void effects_prepare(const struct phantom_float_prepare *prepare)
{
	struct float_effects *out = set_effects(prepare->set);

	effects_lay_out(prepare->effects, prepare->material_count, out->offset);
	out->viscosity_count = prepare->effects->viscosity_count;
	out->guide_count = prepare->effects->guide_count;
	prepare_surfaces(prepare, out);
	prepare_space(prepare, out);
}

#endif /* PHANTOM_FLOAT_EFFECT_TABLE_H */
