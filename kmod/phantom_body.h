/* SPDX-License-Identifier: GPL-2.0-only */
/*
 * phantom_body.h - what can be touched, for the servo: the scene that rests, and each object that moves.
 *
 * A body keeps what contact with it remembers while sets come and go. Body 0 is the scene's. The others
 * are found by the object's number; one that left the set waits for PHANTOM_MEMORY_NS, as an uncovered
 * tip does. There is room for those of two sets, so that a set that comes and the one that goes
 * have their bodies at once. Servo thread only.
 */
#ifndef PHANTOM_BODY_H
#define PHANTOM_BODY_H

#include <phantom_platform.h>
#include "phantom_motion.h"
#include "phantom_set.h"

#define PHANTOM_BODIES (1 + 2 * PHANTOM_MOVING_MAX)

struct phantom_servo;
struct phantom_pass;

/* What contact remembers from tick to tick, in the body's frame: no swap of sets and no motion moves it. */
struct phantom_touch {
	bool valid; /* previous_nm was evaluated not longer than PHANTOM_MEMORY_NS ago */
	bool inside;
	s64 previous_nm[3]; /* the tip where contact was evaluated last */
	s64 proxy_nm[3]; /* while inside */
	u32 proxy_face;
	s32 normal_q30[3]; /* of the contact there; zero without one */
	u32 carry_nm; /* the geometry has changed since, by about that much; 0 = it has not */
	u32 moved_nm; /* and may have moved by that much */
	bool stuck; /* friction holds a stick point: */
	u32 coefficient_q24; /* struct phantom_stick */
	s64 anchor_nm[3];
	struct phantom_ring ring; /* of an impact */
	u64 evaluated_ns; /* when */
};

struct phantom_body {
	struct phantom_touch touch;
	/* what follows is not the scene's */
	bool known; /* it is of an object: */
	u32 object; /* its number */
	struct phantom_motion motion; /* as the newest set says */
	struct phantom_offset offset; /* what is left of where it was before that */
	struct phantom_pose pose; /* in this tick */
	bool near; /* the tip has a place in the frame: */
	s64 tip_nm[3];
};

/* Outside, nothing remembered. */
void phantom_body_forget(struct phantom_body *body);
/*
 * A set comes, in which something moves or did so before: gives its frames their bodies, and makes the
 * poses go on from where they are. `before` may be NULL.
 */
void phantom_bodies_swap(struct phantom_servo *servo, const struct phantom_slot *before,
			 struct phantom_slot *slot, struct phantom_pass *pass);
/* Brings the bodies of the slot's frames to this tick: pose and tip. */
void phantom_bodies_move(struct phantom_servo *servo, const struct phantom_slot *slot,
			 const struct phantom_pass *pass);
/* How fast the tip moves against the body's surface there, in its frame; saturated. */
void phantom_body_velocity(const struct phantom_body *body, const s64 tip_nm[3],
			   const s64 velocity_nm_s[3], s32 relative_nm_s[3]);

#endif /* PHANTOM_BODY_H */
