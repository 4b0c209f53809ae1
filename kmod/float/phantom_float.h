/* SPDX-License-Identifier: GPL-2.0-only */
/*
 * phantom_float.h - the border between the float sections and the rest of the module.
 *
 * Float sections (kmod/float/) turn one tip position and one set of patches into one force. They
 * include nothing of Linux but types, allocate nothing, print nothing, sleep never and have no
 * loop without a constant bound. Everything that crosses this header is an integer or a pointer:
 * a float in a signature does not compile outside the units that have FPU flags.
 *
 * Calling context: between kernel_fpu_begin() and kernel_fpu_end(), opened by phantom_servo.c
 * only. One table of functions per instruction set; the servo picks one at load by what the CPU
 * has. The same inputs give the same bits from each of sse2, avx2 and avx512, in the kernel and in user
 * mode (-ffp-contract=off, fixed summation order).
 *
 * Source of the mathematics: Kabelac 2001, Algorithm 1 (`paper`); the shell projection
 * (`projected`) is derived above its code in projected.h.
 */
#ifndef PHANTOM_FLOAT_H
#define PHANTOM_FLOAT_H

#include <phantom_platform_types.h> /* u32, s32, u64, s64, bool, size_t; nothing else */
#include "phantom_abi.h"

/* Opaque to the integer side: SoA blocks of patches in float, precomputed by prepare(). */
struct phantom_float_set;

#define PHANTOM_FLOAT_SET_ALIGN 64

/* Patches converted by one call of prepare(): bounds the float section. */
#define PHANTOM_FLOAT_PREPARE_MAX 16

/* Patches evaluated by one call of a bounded tick in the kernel. */
#define PHANTOM_FLOAT_TICK_MAX PHANTOM_PATCHES_MAX

/*
 * A validated set's effect tables, as they lie in memory; a table is NULL unless the mask names its
 * effect. Surface effects: an entry for each material that names them; height maps by material, NULL where
 * it does not name one. Height maps and field are read by the tick too, as long as the set is in use.
 */
struct phantom_effects {
	u32 mask; /* set.effects */
	const struct phantom_magnet *magnet;
	const struct phantom_friction *friction;
	const struct phantom_texture *texture;
	const struct phantom_height_map *height_map[PHANTOM_MATERIALS_MAX];
	const struct phantom_impact *impact;
	const struct phantom_constant *constant;
	const struct phantom_viscosity *viscosity;
	const struct phantom_guide *guide;
	const struct phantom_field *field;
	u32 viscosity_count;
	u32 guide_count;
};

/* Conversion of a validated set, in pieces; first = 0 initialises the header and materials. */
struct phantom_float_prepare {
	struct phantom_float_set *set;
	const struct phantom_patch *patches; /* the whole array */
	const struct phantom_material *materials;
	const struct phantom_effects *effects; /* NULL: the set has no tables */
	s64 origin_nm[3]; /* of the set; read only for the tables */
	u32 patch_count;
	u32 face_count; /* the first of them; fans (PHANTOM_PATCH_EDGE, _CORNER) follow */
	u32 rim_count; /* the last of them (PHANTOM_PATCH_RIM) */
	u32 material_count;
	u32 first; /* this piece: patches first ... first + count - 1; first is a multiple of 16 */
	u32 count; /* <= PHANTOM_FLOAT_PREPARE_MAX */
	u32 refused; /* out, added to: patches that cannot be computed (zero area, ...) */
};

/* What friction remembers from tick to tick: effects/friction.h. */
struct phantom_stick {
	u32 held; /* 0: no contact, what follows means nothing */
	u32 coefficient_q24; /* that holds the stick point now */
	s32 anchor_nm[3]; /* the stick point */
};

/* What an impact leaves behind: effects/impact.h. All zero: nothing rings, the next contact may. */
struct phantom_ring {
	u64 age_ns;
	u32 wait_ns; /* without contact, until the next may ring */
	u32 gate_ns; /* g; 0: nothing rings, and what follows means nothing */
	s32 normal_q30[3];
	u32 frequency_hz;
	u32 decay_us;
	s32 amplitude_un;
	s32 energy_nj; /* E_0 */
	s32 left_nj; /* E */
	s32 force_un; /* of the tick before, along the normal */
	u32 reserved; /* 0; jobs are compared as bytes, and a hole has any */
};

/*
 * One tick. Positions are nm relative to the origin of `set`; the servo rebases the state when
 * the set changes. All of it is plain integers, so that kernel and user mode can compare it.
 */
struct phantom_float_job {
	/* in */
	const struct phantom_float_set *set;
	struct phantom_model model;
	s32 tip_nm[3]; /* P1 */
	s32 previous_nm[3]; /* P0 */
	s32 velocity_nm_s[3]; /* of the tip, filtered; for effects */
	u32 effects; /* mask to run */
	s32 centre_nm[3]; /* the set's coverage: what lies nearer than radius_nm is in the set */
	u32 radius_nm;
	u32 path_valid; /* 0: P0 means nothing (first tick), no crossing is looked for */
	u32 more; /* 0 when a tick begins; then the section's own */
	/* state, in and out */
	u32 inside;
	s32 proxy_nm[3]; /* V while inside */
	u32 proxy_face; /* phantom_patch.face that V lies on, or PHANTOM_PATCH_NONE */
	/* effects only: in, and what it is after this tick; a tick may be tried more than once */
	u32 period_ns;
	struct phantom_stick stick, stick_next;
	struct phantom_ring ring, ring_next;
	/* out */
	s32 force_un[3];
	s32 normal_q30[3]; /* of the contact; 0 0 0 without one */
	u32 contacts; /* paper: contacts after overlap removal; projected: roots; inside: 1 */
	u32 folded; /* projected: roots of folded shells (they are in contacts too) */
	u32 saturated; /* conversions that saturated in this tick */
	u32 invalid; /* 1: a result was no number; force is 0 0 0 then */
};

struct phantom_float_ops {
	const char *name; /* "sse2", "avx2", "avx512", "double", "fixed" */
	u32 isa; /* PHANTOM_ISA_... */
	bool integer; /* touches no float register: called outside sections too */
	/* Bytes of a set of that many patches (round up to PHANTOM_FLOAT_SET_ALIGN inside). */
	size_t (*set_bytes)(u32 patch_count);
	/* Bytes that the tables take behind those. */
	size_t (*effect_bytes)(const struct phantom_effects *effects, u32 material_count);
	void (*prepare)(struct phantom_float_prepare *prepare);
	/*
	 * True: not yet done, call again with the job as it is; another section may begin in
	 * between. Each call is bounded whatever the set holds, see shell.h.
	 */
	bool (*tick)(struct phantom_float_job *job);
};

extern const struct phantom_float_ops phantom_float_sse2;
extern const struct phantom_float_ops phantom_float_avx2;
/* User mode only: no virtual machine that the module is tested in has AVX-512. */
extern const struct phantom_float_ops phantom_float_avx512;
/* No float at all: no section is needed round its calls. */
extern const struct phantom_float_ops phantom_float_fixed;
/* User mode only: the same source in float64. */
extern const struct phantom_float_ops phantom_float_double;

#endif /* PHANTOM_FLOAT_H */
