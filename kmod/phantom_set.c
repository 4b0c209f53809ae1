// SPDX-License-Identifier: GPL-2.0-only
/*
 * phantom_set.c - slots, handover and coverage. Integers only.
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
	int i;

	for (i = 0; i < PHANTOM_SLOTS; i++) {
		vfree(sets->slot[i].floats);
		vfree(sets->slot[i].tables);
	}
	vfree(sets->copy.patches);
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

static int phantom_set_reserve(struct phantom_slot *slot, const struct phantom_set_copy *copy,
			       const struct phantom_float_ops *ops)
{
	u32 patch_count = copy->header.patch_count;
	u32 capacity = phantom_set_capacity(patch_count), effect_bytes = 0;

	if (copy->header.effect_bytes)
		effect_bytes = ops->effect_bytes(&copy->effects, copy->header.material_count);
	if (slot->floats && slot->ops == ops && slot->capacity >= patch_count &&
	    slot->effect_room >= effect_bytes)
		return 0;
	vfree(slot->floats);
	WRITE_ONCE(slot->capacity, 0);
	WRITE_ONCE(slot->effect_room, 0);
	WRITE_ONCE(slot->ops, ops);
	slot->floats = vzalloc(ops->set_bytes(capacity) + effect_bytes);
	if (!slot->floats)
		return -ENOMEM;
	WRITE_ONCE(slot->capacity, capacity);
	WRITE_ONCE(slot->effect_room, effect_bytes);
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
	memcpy(slot->origin_nm, header->origin_nm, sizeof(slot->origin_nm));
	memcpy(slot->centre_nm, header->centre_nm, sizeof(slot->centre_nm));
	slot->radius_nm = min_t(u32, header->radius_nm, PHANTOM_COVERAGE_MAX_NM);
	slot->patch_count = header->patch_count;
	slot->effects = header->effects & ~PHANTOM_EFFECT_TIP; /* nothing for the tick to do */
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
		       READ_ONCE(sets->copy.table_room);
	int i;

	for (i = 0; i < PHANTOM_SLOTS; i++) {
		const struct phantom_float_ops *ops = READ_ONCE(sets->slot[i].ops);
		u32 capacity = READ_ONCE(sets->slot[i].capacity);

		bytes += READ_ONCE(sets->slot[i].table_room);
		if (ops && capacity)
			bytes += ops->set_bytes(capacity) + READ_ONCE(sets->slot[i].effect_room);
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

bool phantom_set_reshaped(const struct phantom_slot *before, const struct phantom_slot *after)
{
	u32 i, j;

	if (before->level != after->level)
		return true;
	for (i = 0; i < before->object_count; i++)
		for (j = 0; j < after->object_count; j++)
			if (before->object[i] == after->object[j] &&
			    before->revision[i] != after->revision[j])
				return true;
	return false;
}

bool phantom_set_relative(const struct phantom_slot *slot, const s64 position_nm[3],
			  s32 relative_nm[3])
{
	bool fits = true;
	int axis;

	for (axis = 0; axis < 3; axis++) {
		/* Both are within PHANTOM_POSITION_MAX_NM: the difference cannot overflow. */
		s64 difference = position_nm[axis] - slot->origin_nm[axis];

		relative_nm[axis] =
			clamp_t(s64, difference, -PHANTOM_RELATIVE_MAX_NM, PHANTOM_RELATIVE_MAX_NM);
		fits &= relative_nm[axis] == difference;
	}
	return fits;
}

bool phantom_set_covers(const struct phantom_slot *slot, const s32 point_nm[3], u32 ball_nm)
{
	u64 radius, sum = 0;
	int axis;

	if (slot->radius_nm < ball_nm)
		return false;
	radius = slot->radius_nm - ball_nm;
	for (axis = 0; axis < 3; axis++) {
		s64 difference = (s64)point_nm[axis] - slot->centre_nm[axis];
		u64 distance = difference < 0 ? -difference : difference;

		if (distance > radius)
			return false;
		sum += distance * distance;
	}
	return sum <= radius * radius;
}
