/* SPDX-License-Identifier: GPL-2.0-only */
/*
 * height_map.h - effect: a tile of heights on the surface, PHANTOM_EFFECT_HEIGHT_MAP.
 *
 *   h(x) += sum w_a H(x without its part along axis a)       the law of h: relief.h
 *   w_a  = u_a^4 / sum u^4                                   u normal of the contact
 *
 * H is the quadratic B-spline of the samples: at d in -1/2 ... 1/2 from a sample, in samples,
 *
 *   s_-1 (1/2 - d)^2 / 2  +  s_0 (3/4 - d^2)  +  s_1 (1/2 + d)^2 / 2
 *
 * along rows and columns. So grad h is continuous everywhere, h stays between the samples and no slope is
 * above that from one sample to the next: the samples' own limits hold for the surface. It smooths: a
 * wave of n samples keeps cos^2(pi / n) of its amplitude about, of two samples half. (Unser 1999,
 * "Splines: a perfect fit for signal and image processing".)
 *
 * w turns with u; on a surface of curvature c that leaves a part c A of the energy, as relief.h says of
 * curved surfaces. Where u does not turn there is none.
 *
 * BAND LIMIT. The shortest wave has two samples. The whole map is full up to 1/8 of the servo's rate of
 * such waves and gone at 1/4: at 1 kHz and 0.5 mm from 125 to 250 mm/s.
 *
 * STIFFNESS. Up to k p 4 A / spacing^2 on top of k; in a sampled loop that sum counts.
 */
#ifndef PHANTOM_FLOAT_HEIGHT_MAP_H
#define PHANTOM_FLOAT_HEIGHT_MAP_H

#include "relief.h"
#include "sine.h"

/* Where a place is along one way of the tile. */
struct map_place {
	u32 sample[3]; /* the one before, the nearest, the one after */
	real weight[3];
	real rise[3]; /* of the weights, per sample */
};

static inline void map_place(u64 phase, u32 bits, struct map_place *out)
{
	u32 most = (1U << bits) - 1, nearest, i;
	real at; /* d + 1/2 */

	phase += 1ULL << (63 - bits);
	nearest = (u32)(phase >> (64 - bits));
	at = real_ratio_of_nm((s64)(phase << bits >> 40), 1LL << 24);
	for (i = 0; i < 3; i++)
		out->sample[i] = (nearest + most + i) & most;
	out->rise[0] = at - REAL(1);
	out->rise[1] = REAL(1) - 2 * at;
	out->rise[2] = at;
	out->weight[0] = mul(REAL(0.5), mul(out->rise[0], out->rise[0]));
	out->weight[2] = mul(REAL(0.5), mul(at, at));
	out->weight[1] = REAL(1) - out->weight[0] - out->weight[2];
}

/* H and its slopes along columns and rows, where the surface faces that axis. */
static inline void map_height(const struct float_height_map *map, u32 axis, const s32 foot_nm[3],
			      real *height, real slope[2])
{
	const u32 way[2] = {axis == 0 ? 1 : 0, axis == 2 ? 1 : 2};
	struct map_place place[2];
	u32 i, row, column;

	for (i = 0; i < 2; i++) {
		u64 at = (u64)(map->origin_nm[way[i]] + foot_nm[way[i]]);

		map_place(at * map->step[i], map->bits[i], &place[i]);
	}
	*height = slope[0] = slope[1] = 0;
	for (row = 0; row < 3; row++) {
		const s32 *line = map->height_nm + (place[1].sample[row] << map->bits[0]);
		real along = 0, rising = 0;

		for (column = 0; column < 3; column++) {
			real sample = real_from_nm(line[place[0].sample[column]]);

			along += mul(place[0].weight[column], sample);
			rising += mul(place[0].rise[column], sample);
		}
		*height += mul(place[1].weight[row], along);
		slope[0] += mul(place[1].weight[row], rising);
		slope[1] += mul(place[1].rise[row], along);
	}
	slope[0] = mul(slope[0], map->per_mm);
	slope[1] = mul(slope[1], map->per_mm);
}

/* Part of the map that the servo's rate can carry. */
static inline real map_band(const struct phantom_float_job *job, const struct float_height_map *map,
			    struct real3 u)
{
	struct real3 v = {real_from_nm(job->velocity_nm_s[0]), real_from_nm(job->velocity_nm_s[1]),
			  real_from_nm(job->velocity_nm_s[2])};
	real way;

	v = real3_sub(v, real3_scale(u, real3_dot(v, u)));
	/* ns as nm are 1e-6 s: 1000 of what is meant; two samples are a wave */
	way = mul(mul(real3_length(v), real_from_nm(job->period_ns)), REAL(0.5e-3));
	return phase_band(mul(way, map->per_mm));
}

/* Adds that of the part of the contact which the material has. */
static inline void height_map_add(const struct phantom_float_job *job,
				  const struct float_height_map *map, struct real3 u,
				  const s32 foot_nm[3], real weight, struct relief *relief)
{
	struct real3 square = {mul(u.x, u.x), mul(u.y, u.y), mul(u.z, u.z)};
	const real part[3] = {mul(square.x, square.x), mul(square.y, square.y),
			      mul(square.z, square.z)};
	real scale = divide(mul(weight, map_band(job, map, u)), part[0] + part[1] + part[2]);
	real height, slope[2], share;

	relief->amplitude += mul(weight, map->amplitude);
	if (!(scale > 0))
		return;
	share = mul(scale, part[0]);
	if (share > 0) {
		map_height(map, 0, foot_nm, &height, slope);
		relief->height += mul(share, height);
		relief->slope.y += mul(share, slope[0]);
		relief->slope.z += mul(share, slope[1]);
	}
	share = mul(scale, part[1]);
	if (share > 0) {
		map_height(map, 1, foot_nm, &height, slope);
		relief->height += mul(share, height);
		relief->slope.x += mul(share, slope[0]);
		relief->slope.z += mul(share, slope[1]);
	}
	share = mul(scale, part[2]);
	if (share > 0) {
		map_height(map, 2, foot_nm, &height, slope);
		relief->height += mul(share, height);
		relief->slope.x += mul(share, slope[0]);
		relief->slope.y += mul(share, slope[1]);
	}
}

#endif /* PHANTOM_FLOAT_HEIGHT_MAP_H */
