/* SPDX-License-Identifier: GPL-2.0-only */
/*
 * convert.h - from the tables of phantom_abi.h to those of table.h. Samples and nodes stay where they are.
 */
#ifndef PHANTOM_FLOAT_EFFECT_CONVERT_H
#define PHANTOM_FLOAT_EFFECT_CONVERT_H

#include "table.h"

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

static inline void prepare_height_map(const struct phantom_height_map *in, const s64 origin_nm[3],
				      struct float_height_map *out)
{
	const u32 size[2] = {in->columns, in->rows};
	u32 i;

	out->height_nm = (const s32 *)(in + 1);
	for (i = 0; i < 3; i++)
		out->origin_nm[i] = origin_nm[i];
	for (i = 0; i < 2; i++) {
		/* a tile of 2^38 nm is a hundred-millionth of itself too long at most */
		out->step[i] = ~0ULL / ((u64)size[i] * in->spacing_nm);
		out->bits[i] = (u32)__builtin_ctz(size[i]);
	}
	out->per_mm = real_from_wide(wide_div(WIDE(1e6), wide_from_integer(in->spacing_nm)));
	out->amplitude = effect_real(in->amplitude_nm, WIDE(1e-6));
}

static inline void prepare_impact(const struct phantom_impact *in, struct float_impact *out)
{
	/* mN s/m = 1e-6 N per mm/s */
	out->gain = effect_real(in->gain_mns_m, WIDE(1e-6));
	out->force = effect_real(in->force_un, WIDE(1e-6));
	out->frequency = effect_real(in->frequency_hz, WIDE(1));
	out->decay = effect_real(in->decay_us, WIDE(1e-6));
}

static inline void prepare_relief(const struct phantom_float_prepare *prepare,
				  const struct float_effects *out)
{
	const struct phantom_effects *in = prepare->effects;
	const struct phantom_texture *texture = in->texture;
	struct float_texture *textures = effect_block(out, EFFECT_TEXTURE);
	struct float_height_map *maps = effect_block(out, EFFECT_HEIGHT_MAP);
	u32 i;

	for (i = 0; i < prepare->material_count; i++) {
		if (in->texture) {
			textures[i] = (struct float_texture){.amplitude = 0};
			if (prepare->materials[i].effects & PHANTOM_EFFECT_TEXTURE)
				prepare_texture(texture++, prepare->origin_nm, &textures[i]);
		}
		if (in->mask & PHANTOM_EFFECT_HEIGHT_MAP) {
			maps[i] = (struct float_height_map){.height_nm = 0};
			if (in->height_map[i])
				prepare_height_map(in->height_map[i], prepare->origin_nm, &maps[i]);
		}
	}
}

static inline void prepare_surfaces(const struct phantom_float_prepare *prepare,
				    const struct float_effects *out)
{
	const struct phantom_effects *in = prepare->effects;
	const struct phantom_magnet *magnet = in->magnet;
	const struct phantom_friction *friction = in->friction;
	const struct phantom_impact *impact = in->impact;
	struct float_magnet *magnets = effect_block(out, EFFECT_MAGNET);
	struct float_friction *frictions = effect_block(out, EFFECT_FRICTION);
	struct float_impact *impacts = effect_block(out, EFFECT_IMPACT);
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
		if (in->impact) {
			impacts[i] = (struct float_impact){.gain = 0};
			if (names & PHANTOM_EFFECT_IMPACT)
				prepare_impact(impact++, &impacts[i]);
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

static inline void prepare_field(const struct phantom_field *in, const s64 origin_nm[3],
				 struct float_field *out)
{
	u32 axis;

	out->force_un = (const s32(*)[3])(in + 1);
	effect_place(in->corner_nm, origin_nm, out->corner_nm);
	for (axis = 0; axis < 3; axis++) {
		out->spacing_nm[axis] = in->spacing_nm[axis];
		out->nodes[axis] = in->nodes[axis];
	}
	out->inverse_border = real_from_wide(wide_div(WIDE(1e6), wide_from_integer(in->border_nm)));
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
	if (in->field)
		prepare_field(in->field, prepare->origin_nm, effect_block(out, EFFECT_FIELD));
}

/* After the header of the set. Bounded: 16 materials, twice 8 regions. */
LANES_NOINLINE void effects_prepare(const struct phantom_float_prepare *prepare)
{
	struct float_effects *out = set_effects(prepare->set);

	effects_lay_out(prepare->effects, prepare->material_count, out->offset);
	out->viscosity_count = prepare->effects->viscosity_count;
	out->guide_count = prepare->effects->guide_count;
	prepare_surfaces(prepare, out);
	prepare_relief(prepare, out);
	prepare_space(prepare, out);
}

#endif /* PHANTOM_FLOAT_EFFECT_CONVERT_H */
