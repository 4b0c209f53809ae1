/* SPDX-License-Identifier: GPL-2.0-only */
/*
 * surface.h - what a surface effect is told of a contact, and how it changes it.
 *
 *   u   direction of the contact's force
 *   N   its length, N >= 0
 *   p   depth: how far the contact is pressed in, mm; N = k p before any effect
 *   w_m part of material m in the contact, by force; they add up to 1
 *
 * k and R of a contact between materials are their means by w, as is every parameter of an effect: as
 * the contact goes over from one material to another so does what it feels like, without a step.
 */
#ifndef PHANTOM_FLOAT_SURFACE_H
#define PHANTOM_FLOAT_SURFACE_H

#include "../combine.h"
#include "../crossing.h"
#include "table.h"

struct surface {
	struct real3 direction; /* u */
	real load; /* N; with a magnet it may be < 0: it pulls */
	real depth; /* p, mm; 0 where a magnet pulls */
	real raised; /* height of the tip over the foot, mm: R - p before any effect */
	const real *weight; /* w, by material */
	u32 materials;
};

/* Means of `fields` reals of each material. */
static inline void surface_mean(const struct surface *surface, const void *table, u32 fields,
				real mean[])
{
	const real *row = table;
	u32 i, m;

	for (i = 0; i < fields; i++)
		mean[i] = 0;
	for (m = 0; m < surface->materials; m++, row += fields)
		if (surface->weight[m] > 0)
			for (i = 0; i < fields; i++)
				mean[i] += mul(surface->weight[m], row[i]);
}

/* The weights, which the shell has added up, become parts of 1. */
static inline void surface_weigh(const struct phantom_float_set *set,
				 const struct contact_force *contact, bool inside, real weight[])
{
	u32 materials = set->material_count, m;
	real sum = 0;

	if (inside || materials == 1) {
		u32 patch = contact->deepest_patch;

		for (m = 0; m < materials; m++)
			weight[m] = 0;
		m = materials == 1
			    ? 0
			    : set->blocks[patch / PHANTOM_BLOCK].material[patch % PHANTOM_BLOCK];
		weight[m] = REAL(1);
		return;
	}
	for (m = 0; m < materials; m++)
		sum += weight[m];
	for (m = 0; m < materials; m++)
		weight[m] = sum > 0 ? divide(weight[m], sum) : 0;
}

/* False: there is no contact. */
static inline bool surface_begin(const struct phantom_float_job *job,
				 const struct contact_force *contact, struct surface *out)
{
	const struct phantom_float_set *set = job->set;
	real *weight = effect_block(set_effects(set), EFFECT_WEIGHTS);
	real stiffness = 0, radius = 0;
	u32 m;

	out->load = contact->contacts ? real3_length(contact->force) : 0;
	if (!(out->load > 0))
		return false;
	surface_weigh(set, contact, job->inside, weight);
	for (m = 0; m < set->material_count; m++) {
		stiffness += mul(weight[m], set->materials[m].stiffness);
		radius += mul(weight[m], set->materials[m].radius);
	}
	if (!(stiffness > 0))
		return false;
	out->direction = real3_unit(contact->force);
	out->depth = divide(out->load, stiffness);
	out->raised = radius - out->depth;
	out->weight = weight;
	out->materials = set->material_count;
	return true;
}

#endif /* PHANTOM_FLOAT_SURFACE_H */
