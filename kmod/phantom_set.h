/* SPDX-License-Identifier: GPL-2.0-only */
/*
 * phantom_set.h - triangle sets: from the caller's memory to the servo, without either waiting.
 *
 * A pool of slots. Each slot has one holder at a time, and only the holder touches it:
 *
 *     FREE --fill--> FILLING --hand over--> WAITING --take--> IN USE --release--> FREE
 *            (submitter)        (exchange)           (servo)            (servo)
 *                                   |
 *                                   +-- replaced before it was taken --> FREE  (submitter)
 *
 * WAITING is the one pointer `waiting`, exchanged atomically by both sides; a slot becomes FREE
 * by a release store and is picked by an acquire load. In use, waiting and being filled makes
 * three; the fourth lets a submitter work while the servo still holds an outgoing set. Submitters
 * are serialised by a mutex of their own.
 *
 * A set has FRAMES: the scene's with all that rests, and one for each object that moves. Each has
 * patches, coverage and float data of its own; outside this unit a frame is all that contact needs.
 */
#ifndef PHANTOM_SET_H
#define PHANTOM_SET_H

#include <phantom_platform.h>
#include "phantom_abi.h"
#include "float/phantom_float.h"
#include "phantom_motion.h"

#define PHANTOM_SLOTS 4

/* Of a set: the scene's is 0, then one for each object that moves. */
#define PHANTOM_FRAMES (1 + PHANTOM_MOVING_MAX)

#define PHANTOM_SLOT_FREE 0U
#define PHANTOM_SLOT_HELD 1U

/* Coverage farther than this counts as this far: keeps the squares in u64 (3 * 2e9^2 < 2^64). */
#define PHANTOM_COVERAGE_MAX_NM 2000000000U

/*
 * Positions farther from a set's origin along an axis do not fit: the distance to a vertex, which the
 * float sections form in s32, does not either.
 */
#define PHANTOM_RELATIVE_MAX_NM (S32_MAX - PHANTOM_COORDINATE_MAX_NM)

struct phantom_frame {
	s64 origin_nm[3]; /* in the frame */
	s32 centre_nm[3]; /* of the coverage, from the origin; as is radius_nm: */
	u32 radius_nm;
	u32 patch_count;
	u32 effects;
	struct phantom_float_set *floats; /* NULL: never had patches or effects */
	u32 capacity; /* patches that floats has room for, as the slot's ops lays them out */
	u32 effect_room; /* and bytes of tables */
	u32 object; /* number of what moves; not of frame 0 */
	struct phantom_motion motion;
};

struct phantom_slot {
	u32 holder; /* PHANTOM_SLOT_FREE or _HELD, release/acquire */
	/* What follows is the holder's. */
	u64 id;
	u32 reach_nm; /* largest contact radius among its materials */
	u32 patch_count; /* of all frames */
	u32 frame_count;
	struct phantom_frame frame[PHANTOM_FRAMES];
	u32 body[PHANTOM_FRAMES]; /* the servo's: phantom_body.h */
	u64 effect_print; /* of effects and tables, damping aside: the same, or another feel */
	u32 level;
	u32 level_error_nm;
	u32 refused; /* patches that could not be computed */
	u32 object_count;
	u32 object[PHANTOM_OBJECTS_MAX];
	u32 revision[PHANTOM_OBJECTS_MAX];
	u32 object_frame[PHANTOM_OBJECTS_MAX];
	const struct phantom_float_ops *ops; /* which prepared the floats, and alone can use them */
	u64 *tables; /* of effects, as they were submitted; the float sets refer to them */
	u32 table_room; /* bytes */
};

/* Where a frame's patches are in the copy. */
struct phantom_part {
	u32 first;
	u32 patch_count;
	u32 face_count;
	u32 rim_count;
};

/* The caller's arrays, copied before anything is believed. The submitter's. */
struct phantom_set_copy {
	struct phantom_set header;
	struct phantom_material materials[PHANTOM_MATERIALS_MAX];
	struct phantom_object objects[PHANTOM_OBJECTS_MAX];
	u64 *tables; /* header.effect_bytes of them; they change places with the slot's */
	u32 table_room; /* bytes */
	struct phantom_patch *patches;
	u32 capacity; /* of patches */
	/* by phantom_set_split(): the patches frame by frame */
	const struct phantom_patch *sorted;
	struct phantom_part part[PHANTOM_FRAMES];
	struct phantom_patch
		*room; /* for sorted, and for where each patch has gone; NULL until asked for */
	u32 room_capacity;
	/* by phantom_set_check_arrays() */
	u32 face_count; /* patches of kind FACE: they come first */
	u32 rim_count; /* patches of kind RIM: they come last */
	u32 frame_count;
	u32 frame[PHANTOM_OBJECTS_MAX]; /* of each object */
	struct phantom_effects effects; /* the tables */
};

struct phantom_sets {
	struct phantom_slot slot[PHANTOM_SLOTS];
	struct phantom_slot *waiting; /* exchanged atomically */
	struct mutex submitting; /* one submitter at a time; guards what follows */
	struct phantom_set_copy copy;
	u64 last_id;
	u32 patches_max;
};

void phantom_set_init(struct phantom_sets *sets, u32 patches_max);
/* No servo, no submitter any more. */
void phantom_set_destroy(struct phantom_sets *sets);

/* ---- submitter: process context, `submitting` held ----------------------- */

/*
 * Copies and validates the set, and picks a slot with room for it in the layout of `ops`. The
 * slot is the caller's until handed over; its float data is not yet written. ERR_PTR as
 * phantom_abi.h says.
 */
struct phantom_slot *phantom_set_fill(struct phantom_sets *sets, const void __user *user,
				      const struct phantom_float_ops *ops);
/* Makes the slot the one that the servo takes next. */
void phantom_set_hand_over(struct phantom_sets *sets, struct phantom_slot *slot);
/* Forgets the waiting set and the last id. */
void phantom_set_forget(struct phantom_sets *sets);

/* Where the tables begin in the caller's memory. */
static inline u64 phantom_set_tables(const struct phantom_set *header)
{
	return header->materials + header->material_count * sizeof(struct phantom_material);
}

/* Memory of slots and copy. Any context; a submission in flight may or may not count. */
size_t phantom_set_bytes(const struct phantom_sets *sets);

/* phantom_set_check.c: 0 or -EINVAL. Looks at every field of the copy; counts its faces. */
int phantom_set_check_header(const struct phantom_set *header, u64 last_id, u32 patches_max);
int phantom_set_check_arrays(struct phantom_set_copy *copy);
/* A vector of unit length? */
bool phantom_check_unit(const s32 vector_q30[3]);
/*
 * phantom_set_split.c: patches frame by frame, with the neighbours' places in their frame. The copy is
 * checked. 0 or -ENOMEM.
 */
int phantom_set_split(struct phantom_set_copy *copy);
/* Bytes of room for each patch of room_capacity. */
#define PHANTOM_SPLIT_BYTES (sizeof(struct phantom_patch) + sizeof(u32))
/* The tables that a frame's float data is made with: those of space are the scene's alone. */
void phantom_set_effects(const struct phantom_set_copy *copy, u32 frame,
			 struct phantom_effects *effects);
/* phantom_effects_check.c: the same for the tables; materials are checked before. Finds the tables. */
int phantom_effects_check(struct phantom_set_copy *copy);

/* ---- servo, wait-free ---------------------------------------------------- */

/* The newest set handed over since the last call, or NULL. */
struct phantom_slot *phantom_set_take(struct phantom_sets *sets);
void phantom_set_release(struct phantom_slot *slot);

/*
 * The frames of `after`, one bit each, that have another geometry than before: another revision of an
 * object, or another level of detail.
 */
u32 phantom_set_reshaped(const struct phantom_slot *before, const struct phantom_slot *after);
/* A position in the frame relative to its origin; false when it does not fit: it is not covered. */
bool phantom_frame_relative(const struct phantom_frame *frame, const s64 position_nm[3],
			    s32 relative_nm[3]);
/* True when the set promises the whole ball of that radius round a point relative to the origin. */
bool phantom_frame_covers(const struct phantom_frame *frame, const s32 point_nm[3], u32 ball_nm);

#endif /* PHANTOM_SET_H */
