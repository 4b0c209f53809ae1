// SPDX-License-Identifier: GPL-2.0-only
/*
 * phantom_set.c - slots, frames, handover and coverage. Integers only.
 */
#include <phantom_platform.h>
#include "phantom_set.h"

void phantom_set_init(struct phantom_sets *sets, u32 patches_max)
{
	memset(sets, 0, sizeof(*sets));
	mutex_init(&sets->submitting);
	sets->patches_max = patches_max;
}

void phantom_set_destroy(struct phantom_sets *sets)
{
	int i, f;

	for (i = 0; i < PHANTOM_SLOTS; i++) {
		for (f = 0; f < PHANTOM_FRAMES; f++)
			vfree(sets->slot[i].frame[f].floats);
		vfree(sets->slot[i].tables);
	}
	vfree(sets->copy.patches);
	vfree(sets->copy.room);
	vfree(sets->copy.tables);
	mutex_destroy(&sets->submitting);
	memset(sets, 0, sizeof(*sets));
}

/* Room for all that the kernel allows at once, so that only the first sets can fail for memory. */
static u32 phantom_set_capacity(u32 patch_count)
{
	return max_t(u32, patch_count, PHANTOM_PATCHES_MAX);
}

static int phantom_set_copy_tables(struct phantom_set_copy *copy)
{
	const struct phantom_set *header = &copy->header;

	if (copy->table_room < header->effect_bytes) {
		vfree(copy->tables);
		WRITE_ONCE(copy->table_room, 0);
		copy->tables = vzalloc(header->effect_bytes);
		if (!copy->tables)
			return -ENOMEM;
		WRITE_ONCE(copy->table_room, header->effect_bytes);
	}
	if (header->effect_bytes &&
	    copy_from_user(copy->tables, u64_to_user_ptr(phantom_set_tables(header)),
			   header->effect_bytes))
		return -EFAULT;
	return 0;
}

static int phantom_set_copy_arrays(struct phantom_sets *sets)
{
	struct phantom_set_copy *copy = &sets->copy;
	const struct phantom_set *header = &copy->header;
	size_t patches = (size_t)header->patch_count * sizeof(*copy->patches);

	if (copy->capacity < header->patch_count) {
		u32 capacity = phantom_set_capacity(header->patch_count);

		vfree(copy->patches);
		WRITE_ONCE(copy->capacity, 0);
		copy->patches = vzalloc((size_t)capacity * sizeof(*copy->patches));
		if (!copy->patches)
			return -ENOMEM;
		WRITE_ONCE(copy->capacity, capacity);
	}
	if (copy_from_user(copy->materials, u64_to_user_ptr(header->materials),
			   header->material_count * sizeof(copy->materials[0])) ||
	    copy_from_user(copy->objects, u64_to_user_ptr(header->objects),
			   header->object_count * sizeof(copy->objects[0])) ||
	    copy_from_user(copy->patches, u64_to_user_ptr(header->patches), patches))
		return -EFAULT;
	return phantom_set_copy_tables(copy);
}

static struct phantom_slot *phantom_set_pick(struct phantom_sets *sets)
{
	int i;

	for (i = 0; i < PHANTOM_SLOTS; i++)
		/* pairs with phantom_set_release(): the last reader has done with it */
		if (smp_load_acquire(&sets->slot[i].holder) == PHANTOM_SLOT_FREE)
			return &sets->slot[i];
	return NULL;
}

void phantom_set_effects(const struct phantom_set_copy *copy, u32 frame,
			 struct phantom_effects *effects)
{
	*effects = copy->effects;
	if (!frame)
		return;
	effects->mask &= ~PHANTOM_EFFECTS_SPACE;
	effects->constant = NULL;
	effects->viscosity = NULL;
	effects->guide = NULL;
	effects->field = NULL;
	effects->viscosity_count = 0;
	effects->guide_count = 0;
}

static int phantom_set_reserve_frame(struct phantom_frame *frame, u32 patch_count, u32 effect_bytes,
				     const struct phantom_float_ops *ops)
{
	u32 capacity = phantom_set_capacity(patch_count);

	if (frame->floats && frame->capacity >= patch_count && frame->effect_room >= effect_bytes)
		return 0;
	vfree(frame->floats);
	WRITE_ONCE(frame->capacity, 0);
	WRITE_ONCE(frame->effect_room, 0);
	frame->floats = vzalloc(ops->set_bytes(capacity) + effect_bytes);
	if (!frame->floats)
		return -ENOMEM;
	WRITE_ONCE(frame->capacity, capacity);
	WRITE_ONCE(frame->effect_room, effect_bytes);
	return 0;
}

/* The scene's frame always, another one if it has patches. */
static int phantom_set_reserve(struct phantom_slot *slot, const struct phantom_set_copy *copy,
			       const struct phantom_float_ops *ops)
{
	u32 f;

	/* what other ops laid out is of no use, also in frames that this set has no need of */
	for (f = 0; slot->ops != ops && f < PHANTOM_FRAMES; f++) {
		vfree(slot->frame[f].floats);
		slot->frame[f].floats = NULL;
		WRITE_ONCE(slot->frame[f].capacity, 0);
	}
	WRITE_ONCE(slot->ops, ops);
	for (f = 0; f < copy->frame_count; f++) {
		u32 effect_bytes = 0;
		struct phantom_effects effects;
		int error;

		if (f && !copy->part[f].patch_count)
			continue;
		phantom_set_effects(copy, f, &effects);
		if (copy->header.effect_bytes)
			effect_bytes = ops->effect_bytes(&effects, copy->header.material_count);
		error = phantom_set_reserve_frame(&slot->frame[f], copy->part[f].patch_count,
						  effect_bytes, ops);
		if (error)
			return error;
	}
	return 0;
}

/* FNV-1a, by words. */
static u64 phantom_print_add(u64 print, u64 word)
{
	return (print ^ word) * 1099511628211ULL;
}

static u64 phantom_set_print(const struct phantom_set_copy *copy)
{
	const struct phantom_set *header = &copy->header;
	u64 print = 14695981039346656037ULL;
	u32 i;

	if (!(header->effects & ~PHANTOM_EFFECT_DAMPING))
		return 0;
	print = phantom_print_add(print, header->effects & ~PHANTOM_EFFECT_DAMPING);
	for (i = 0; i < header->material_count; i++)
		print = phantom_print_add(print,
					  copy->materials[i].effects & ~PHANTOM_EFFECT_DAMPING);
	for (i = 0; i < header->effect_bytes / sizeof(copy->tables[0]); i++)
		print = phantom_print_add(print, copy->tables[i]);
	return print;
}

static void phantom_set_describe_scene(struct phantom_frame *frame,
				       const struct phantom_set_copy *copy)
{
	const struct phantom_set *header = &copy->header;

	memcpy(frame->origin_nm, header->origin_nm, sizeof(frame->origin_nm));
	memcpy(frame->centre_nm, header->centre_nm, sizeof(frame->centre_nm));
	frame->radius_nm = min_t(u32, header->radius_nm, PHANTOM_COVERAGE_MAX_NM);
	frame->patch_count = copy->part[0].patch_count;
	frame->effects = header->effects & ~PHANTOM_EFFECT_TIP; /* nothing for the tick to do */
}

/* The coverage goes along: the ball is where it was in the frame when the set was made. */
static void phantom_set_describe_mover(struct phantom_frame *frame,
				       const struct phantom_set_copy *copy, u32 object)
{
	const struct phantom_set *header = &copy->header;
	s64 centre_nm[3];
	struct phantom_pose pose;
	int axis;

	phantom_motion_init(&frame->motion, &copy->objects[object], header->time_ns);
	phantom_motion_at(&frame->motion, NULL, header->time_ns, &pose);
	memcpy(frame->origin_nm, copy->objects[object].origin_nm, sizeof(frame->origin_nm));
	for (axis = 0; axis < 3; axis++)
		centre_nm[axis] = header->origin_nm[axis] + header->centre_nm[axis];
	frame->radius_nm = min_t(u32, header->radius_nm, PHANTOM_COVERAGE_MAX_NM);
	if (!phantom_pose_enter(&pose, centre_nm, centre_nm) ||
	    !phantom_frame_relative(frame, centre_nm, frame->centre_nm))
		frame->radius_nm = 0; /* so far away that nothing there is covered */
	frame->patch_count = copy->part[copy->frame[object]].patch_count;
	frame->effects = header->effects & PHANTOM_EFFECTS_SURFACE;
	frame->object = copy->objects[object].object;
}

/* The slot gets the tables, which the float set refers to; the copy gets the slot's memory for others. */
static void phantom_set_keep_tables(struct phantom_slot *slot, struct phantom_set_copy *copy)
{
	u64 *tables = slot->tables;
	u32 room = slot->table_room;

	slot->tables = copy->tables;
	copy->tables = tables;
	WRITE_ONCE(slot->table_room, copy->table_room);
	WRITE_ONCE(copy->table_room, room);
}

static void phantom_set_describe(struct phantom_slot *slot, const struct phantom_set_copy *copy)
{
	const struct phantom_set *header = &copy->header;
	u32 i;

	slot->id = header->id;
	slot->patch_count = header->patch_count;
	slot->frame_count = copy->frame_count;
	phantom_set_describe_scene(&slot->frame[0], copy);
	slot->effect_print = phantom_set_print(copy);
	slot->level = header->level;
	slot->level_error_nm = header->level_error_nm;
	slot->refused = 0;
	slot->reach_nm = 0;
	for (i = 0; i < header->material_count; i++)
		slot->reach_nm = max_t(u32, slot->reach_nm, copy->materials[i].radius_nm);
	slot->object_count = header->object_count;
	for (i = 0; i < header->object_count; i++) {
		slot->object[i] = copy->objects[i].object;
		slot->revision[i] = copy->objects[i].revision;
		slot->object_frame[i] = copy->frame[i];
		if (copy->frame[i])
			phantom_set_describe_mover(&slot->frame[copy->frame[i]], copy, i);
	}
}

struct phantom_slot *phantom_set_fill(struct phantom_sets *sets, const void __user *user,
				      const struct phantom_float_ops *ops)
{
	struct phantom_set_copy *copy = &sets->copy;
	struct phantom_slot *slot;
	int error;

	lockdep_assert_held(&sets->submitting);
	if (copy_from_user(&copy->header, user, sizeof(copy->header)))
		return ERR_PTR(-EFAULT);
	error = phantom_set_check_header(&copy->header, sets->last_id, sets->patches_max);
	if (error)
		return ERR_PTR(error);
	error = phantom_set_copy_arrays(sets);
	if (error)
		return ERR_PTR(error);
	error = phantom_set_check_arrays(copy);
	if (!error)
		error = phantom_set_split(copy);
	if (error)
		return ERR_PTR(error);
	slot = phantom_set_pick(sets);
	if (!slot)
		return ERR_PTR(-EAGAIN);
	error = phantom_set_reserve(slot, copy, ops);
	if (error)
		return ERR_PTR(error);
	phantom_set_describe(slot, copy);
	if (copy->header.effect_bytes)
		phantom_set_keep_tables(slot, copy);
	return slot;
}

void phantom_set_hand_over(struct phantom_sets *sets, struct phantom_slot *slot)
{
	struct phantom_slot *replaced;

	lockdep_assert_held(&sets->submitting);
	sets->last_id = slot->id;
	WRITE_ONCE(slot->holder, PHANTOM_SLOT_HELD);
	replaced = xchg(&sets->waiting, slot);
	if (replaced)
		phantom_set_release(replaced);
}

void phantom_set_forget(struct phantom_sets *sets)
{
	struct phantom_slot *waiting = xchg(&sets->waiting, NULL);

	lockdep_assert_held(&sets->submitting);
	if (waiting)
		phantom_set_release(waiting);
	sets->last_id = 0;
}

size_t phantom_set_bytes(const struct phantom_sets *sets)
{
	size_t bytes = (size_t)READ_ONCE(sets->copy.capacity) * sizeof(struct phantom_patch) +
		       READ_ONCE(sets->copy.room_capacity) * PHANTOM_SPLIT_BYTES +
		       READ_ONCE(sets->copy.table_room);
	int i, f;

	for (i = 0; i < PHANTOM_SLOTS; i++) {
		const struct phantom_float_ops *ops = READ_ONCE(sets->slot[i].ops);

		bytes += READ_ONCE(sets->slot[i].table_room);
		for (f = 0; ops && f < PHANTOM_FRAMES; f++) {
			const struct phantom_frame *frame = &sets->slot[i].frame[f];
			u32 capacity = READ_ONCE(frame->capacity);

			if (capacity)
				bytes += ops->set_bytes(capacity) + READ_ONCE(frame->effect_room);
		}
	}
	return bytes;
}

struct phantom_slot *phantom_set_take(struct phantom_sets *sets)
{
	if (!READ_ONCE(sets->waiting))
		return NULL;
	return xchg(&sets->waiting, NULL);
}

void phantom_set_release(struct phantom_slot *slot)
{
	smp_store_release(&slot->holder, PHANTOM_SLOT_FREE); /* pairs with phantom_set_pick() */
}

u32 phantom_set_reshaped(const struct phantom_slot *before, const struct phantom_slot *after)
{
	u32 i, j, frames = 0;

	if (before->level != after->level)
		return (1U << after->frame_count) - 1;
	for (i = 0; i < before->object_count; i++)
		for (j = 0; j < after->object_count; j++)
			if (before->object[i] == after->object[j] &&
			    before->revision[i] != after->revision[j])
				frames |= 1U << after->object_frame[j];
	return frames;
}

bool phantom_frame_relative(const struct phantom_frame *frame, const s64 position_nm[3],
			    s32 relative_nm[3])
{
	bool fits = true;
	int axis;

	for (axis = 0; axis < 3; axis++) {
		/* Both are within PHANTOM_POSITION_MAX_NM: the difference cannot overflow. */
		s64 difference = position_nm[axis] - frame->origin_nm[axis];

		relative_nm[axis] =
			clamp_t(s64, difference, -PHANTOM_RELATIVE_MAX_NM, PHANTOM_RELATIVE_MAX_NM);
		fits &= relative_nm[axis] == difference;
	}
	return fits;
}

bool phantom_frame_covers(const struct phantom_frame *frame, const s32 point_nm[3], u32 ball_nm)
{
	u64 radius, sum = 0;
	int axis;

	if (frame->radius_nm < ball_nm)
		return false;
	radius = frame->radius_nm - ball_nm;
	for (axis = 0; axis < 3; axis++) {
		s64 difference = (s64)point_nm[axis] - frame->centre_nm[axis];
		u64 distance = difference < 0 ? -difference : difference;

		if (distance > radius)
			return false;
		sum += distance * distance;
	}
	return sum <= radius * radius;
}
