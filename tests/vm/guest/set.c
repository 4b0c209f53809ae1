// SPDX-License-Identifier: GPL-2.0-or-later
// SUBMIT_SET: every field wrong, one at a time, and what a refused set must not touch.
#include <errno.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "device.h"
#include "harness.h"

/* One wrong thing in an otherwise good plate. `at` is an index, bit or axis, 0 ... steps - 1. */
struct fault {
    const char* what;
    int steps;
    void (*plant)(struct vm_plate* plate, int at);
};

static struct phantom_patch* last_patch(struct vm_plate* plate)
{
    return &plate->patches[VM_PLATE_PATCHES - 1];
}

/* ---- header ---- */

static void id_zero(struct vm_plate* plate, int at)
{
    (void)at;
    plate->set.id = 0;
}

static void origin_out_of_range(struct vm_plate* plate, int at)
{
    plate->set.origin_nm[at / 2] = at % 2 ? INT64_MIN : INT64_MAX;
}

static void centre_out_of_range(struct vm_plate* plate, int at)
{
    plate->set.centre_nm[at / 2] = at % 2 ? -PHANTOM_COORDINATE_MAX_NM - 1 : PHANTOM_COORDINATE_MAX_NM + 1;
}

static const uint32_t excess[] = {1, 0x7fffffff, 0x80000000, 0xffffffff};

static void too_many_patches(struct vm_plate* plate, int at)
{
    plate->set.patch_count = at == 0 ? PHANTOM_PATCHES_MAX + 1 : excess[at];
}

static void too_many_materials(struct vm_plate* plate, int at)
{
    plate->set.material_count = at == 0 ? PHANTOM_MATERIALS_MAX + 1 : excess[at];
}

static void too_many_objects(struct vm_plate* plate, int at)
{
    plate->set.object_count = at == 0 ? PHANTOM_OBJECTS_MAX + 1 : excess[at];
}

static void no_material(struct vm_plate* plate, int at)
{
    (void)at;
    plate->set.material_count = 0;
}

static void no_object(struct vm_plate* plate, int at)
{
    (void)at;
    plate->set.object_count = 0;
}

static void header_flag(struct vm_plate* plate, int at)
{
    plate->set.flags = 1u << at;
}
/* Tables that no effect calls for. */
static void header_effect_bytes(struct vm_plate* plate, int at)
{
    plate->set.effect_bytes = 1u << at;
}
/* Unknown effects, known ones that no material names, and those of space without their tables. */
static void header_effect(struct vm_plate* plate, int at)
{
    plate->set.effects = 1u << at;
}

/* ---- patches: the last one, so that a check of the first only does not do ---- */

static void vertex_out_of_range(struct vm_plate* plate, int at)
{
    last_patch(plate)->vertex_nm[at / 3][at % 3] =
        at % 2 ? -PHANTOM_COORDINATE_MAX_NM - 1 : PHANTOM_COORDINATE_MAX_NM + 1;
}

static void vertex_at_the_border_of_the_type(struct vm_plate* plate, int at)
{
    last_patch(plate)->vertex_nm[at / 3][at % 3] = at % 2 ? INT32_MIN : INT32_MAX;
}

static void normal_zero(struct vm_plate* plate, int at)
{
    last_patch(plate)->normal_q30[at][2] = 0;
}

static void normal_too_short(struct vm_plate* plate, int at)
{
    last_patch(plate)->normal_q30[at][2] = PHANTOM_Q30_ONE - (3 << 20) / 2;
}

static void normal_too_long(struct vm_plate* plate, int at)
{
    last_patch(plate)->normal_q30[at][2] = PHANTOM_Q30_ONE + (3 << 20) / 2;
}

static void normal_at_the_border_of_the_type(struct vm_plate* plate, int at)
{
    for (int axis = 0; axis < 3; axis++)
        last_patch(plate)->normal_q30[at][axis] = INT32_MIN;
}

static void neighbour_out_of_range(struct vm_plate* plate, int at)
{
    static const uint32_t wrong[] = {VM_PLATE_PATCHES, 0x7fffffff, 0xfffffffe};

    last_patch(plate)->neighbour[at / 3] = wrong[at % 3];
}

static void object_out_of_range(struct vm_plate* plate, int at)
{
    last_patch(plate)->object = excess[at];
}
static void material_out_of_range(struct vm_plate* plate, int at)
{
    last_patch(plate)->material = excess[at];
}
static void kind_unknown(struct vm_plate* plate, int at)
{
    last_patch(plate)->kind = 1u << at;
}

static void patch_reserved(struct vm_plate* plate, int at)
{
    last_patch(plate)->reserved = 1u << at;
}

/* ---- material ---- */

static void radius_zero(struct vm_plate* plate, int at)
{
    (void)at;
    plate->material.radius_nm = 0;
}

static void damping_without_its_effect(struct vm_plate* plate, int at)
{
    (void)at;
    plate->material.damping_mns_m = 1;
}

static void material_effect(struct vm_plate* plate, int at)
{
    plate->material.effects = 1u << at; /* some bits are known, but then the header lacks them */
}

/* Unknown, of space, or without its table. */
static void material_effect_unfit_in_both(struct vm_plate* plate, int at)
{
    plate->material.effects = 2u << at;
    plate->set.effects = 2u << at;
}

static void material_reserved(struct vm_plate* plate, int at)
{
    plate->material.reserved[at / 32] = 1u << at % 32;
}

/* ---- object ---- */

static void object_moved(struct vm_plate* plate, int at)
{
    plate->object.translation_nm[at] = 1;
}
static void object_turned(struct vm_plate* plate, int at)
{
    plate->object.rotation_q30[1 + at] = 1;
}

static void object_without_rotation(struct vm_plate* plate, int at)
{
    plate->object.rotation_q30[0] = at ? PHANTOM_Q30_ONE - 1 : 0;
}

static void object_moving(struct vm_plate* plate, int at)
{
    plate->object.velocity_nm_s[at] = -1;
}
static void object_turning(struct vm_plate* plate, int at)
{
    plate->object.angular_velocity_urad_s[at] = 1;
}

static void object_with_an_origin(struct vm_plate* plate, int at)
{
    plate->object.origin_nm[at] = 1;
}

static void object_flag(struct vm_plate* plate, int at)
{
    plate->object.flags = 2u << at;
}

static void object_reserved(struct vm_plate* plate, int at)
{
    plate->object.reserved = 1u << at;
}

/* ---- an object that moves ---- */

static void mover_without_rotation(struct vm_plate* plate, int at)
{
    plate->object.flags = PHANTOM_OBJECT_MOVES;
    plate->object.rotation_q30[0] = at ? -PHANTOM_Q30_ONE - (2 << 20) : 0;
}

static void mover_with_a_long_rotation(struct vm_plate* plate, int at)
{
    plate->object.flags = PHANTOM_OBJECT_MOVES;
    plate->object.rotation_q30[1 + at] = PHANTOM_Q30_ONE;
}

static void mover_out_of_range(struct vm_plate* plate, int at)
{
    plate->object.flags = PHANTOM_OBJECT_MOVES;
    plate->object.translation_nm[at / 2] = (at % 2 ? 1 : -1) * (PHANTOM_POSITION_MAX_NM + 1);
}

static void mover_beyond_reach(struct vm_plate* plate, int at)
{
    plate->object.flags = PHANTOM_OBJECT_MOVES;
    plate->object.origin_nm[at / 2] = (at % 2 ? 1 : -1) * (PHANTOM_OBJECT_REACH_NM + 1LL);
}

static void mover_too_fast(struct vm_plate* plate, int at)
{
    plate->object.flags = PHANTOM_OBJECT_MOVES;
    plate->object.angular_velocity_urad_s[at] = -PHANTOM_OBJECT_TURN_MAX_URAD_S - 1;
}

static const struct fault faults[] = {
    {"id 0", 1, id_zero},
    {"origin", 6, origin_out_of_range},
    {"centre", 6, centre_out_of_range},
    {"patch_count", 4, too_many_patches},
    {"material_count", 4, too_many_materials},
    {"object_count", 4, too_many_objects},
    {"a material index without materials", 1, no_material},
    {"an object index without objects", 1, no_object},
    {"flags bit", 32, header_flag},
    {"header effect_bytes bit", 32, header_effect_bytes},
    {"header effect bit", 32, header_effect},
    {"vertex beyond 1 m", 9, vertex_out_of_range},
    {"vertex at the type's border", 9, vertex_at_the_border_of_the_type},
    {"normal 0", 3, normal_zero},
    {"normal too short", 3, normal_too_short},
    {"normal too long", 3, normal_too_long},
    {"normal at the type's border", 3, normal_at_the_border_of_the_type},
    {"neighbour", 9, neighbour_out_of_range},
    {"object index", 4, object_out_of_range},
    {"material index", 4, material_out_of_range},
    {"kind bit", 32, kind_unknown},
    {"patch reserved bit", 32, patch_reserved},
    {"radius 0", 1, radius_zero},
    {"damping without its effect", 1, damping_without_its_effect},
    {"material effect bit", 32, material_effect},
    {"unfit effect bit in both", 31, material_effect_unfit_in_both},
    {"material reserved bit", 128, material_reserved},
    {"object translation", 3, object_moved},
    {"object rotation", 3, object_turned},
    {"object rotation w", 2, object_without_rotation},
    {"object velocity", 3, object_moving},
    {"object angular velocity", 3, object_turning},
    {"object origin", 3, object_with_an_origin},
    {"object flags bit", 31, object_flag},
    {"object reserved bit", 32, object_reserved},
    {"moving object's rotation w", 2, mover_without_rotation},
    {"moving object's rotation too long", 3, mover_with_a_long_rotation},
    {"moving object's translation", 6, mover_out_of_range},
    {"moving object's origin", 6, mover_beyond_reach},
    {"moving object's angular velocity", 3, mover_too_fast},
};
#define FAULTS (sizeof(faults) / sizeof(faults[0]))

VM_TEST(set, every_wrong_field_is_refused, 20)
{
    int fd = vm_open_feeder();
    struct vm_plate plate;
    int tried = 0;

    for (size_t i = 0; i < FAULTS; i++)
        for (int at = 0; at < faults[i].steps; at++) {
            int rc;

            vm_plate_make(&plate, 1);
            faults[i].plant(&plate, at);
            rc = vm_ioctl(fd, PHANTOM_SUBMIT_SET, &plate.set);
            CHECK(rc == -EINVAL, "%s (%d) gave %s", faults[i].what, at, vm_error_name(rc));
            tried++;
        }
    /* Not one of the refused sets has used the number up. */
    vm_plate_submit(fd, 1);
    vm_figure("%d wrong sets refused", tried);
}

VM_TEST(set, a_refused_set_leaves_contact_alone, 20)
{
    int fd = vm_open_feeder();
    const struct phantom_status* page = vm_map(fd);
    struct phantom_status before, after;
    struct vm_plate plate;

    vm_touch(fd, page);
    vm_status(page, &before);
    for (size_t i = 0; i < FAULTS; i++) {
        vm_plate_make(&plate, 100 + i);
        faults[i].plant(&plate, 0);
        vm_expect(fd, PHANTOM_SUBMIT_SET, &plate.set, -EINVAL, faults[i].what);
    }
    vm_status(page, &after);
    vm_wait_ticks(page, after.tick + 10);
    vm_status(page, &after);
    CHECK(after.set_id == before.set_id, "set %llu in use", (unsigned long long)after.set_id);
    CHECK(memcmp(before.force_un, after.force_un, sizeof(before.force_un)) == 0, "force %d uN, was %d",
          after.force_un[2], before.force_un[2]);
    vm_plate_submit(fd, 2);
}

VM_TEST(set, an_object_number_twice_is_refused, 10)
{
    int fd = vm_open_feeder();
    struct phantom_object objects[PHANTOM_OBJECTS_MAX];
    struct vm_plate plate;

    vm_plate_make(&plate, 1);
    for (uint32_t i = 0; i < PHANTOM_OBJECTS_MAX; i++) {
        objects[i] = plate.object;
        objects[i].object = 1000 + i;
    }
    plate.set.object_count = PHANTOM_OBJECTS_MAX;
    plate.set.objects = (uintptr_t)objects;
    for (uint32_t i = 0; i < PHANTOM_OBJECTS_MAX - 1; i++) {
        objects[PHANTOM_OBJECTS_MAX - 1].object = objects[i].object;
        vm_expect(fd, PHANTOM_SUBMIT_SET, &plate.set, -EINVAL, "SUBMIT_SET with an object number twice");
    }
    objects[PHANTOM_OBJECTS_MAX - 1].object = 0xffffffff;
    vm_expect(fd, PHANTOM_SUBMIT_SET, &plate.set, 0, "SUBMIT_SET with sixteen object numbers");
}

VM_TEST(set, origin_may_be_as_far_as_positions_go, 10)
{
    int fd = vm_open_feeder();
    struct vm_plate plate;

    for (int axis = 0; axis < 3; axis++)
        for (int sign = -1; sign <= 1; sign += 2) {
            vm_plate_make(&plate, 1u + (unsigned int)(2 * axis + (sign > 0)));
            plate.set.origin_nm[axis] = sign * (PHANTOM_POSITION_MAX_NM + 1);
            vm_expect(fd, PHANTOM_SUBMIT_SET, &plate.set, -EINVAL, "SUBMIT_SET with an origin too far");
            plate.set.origin_nm[axis] = sign * PHANTOM_POSITION_MAX_NM;
            vm_expect(fd, PHANTOM_SUBMIT_SET, &plate.set, 0, "SUBMIT_SET with the farthest origin");
        }
}

VM_TEST(set, id_must_grow, 10)
{
    int fd = vm_open_feeder();
    struct vm_plate plate;

    vm_plate_submit(fd, 10);
    for (uint64_t id = 0; id <= 10; id++) {
        vm_plate_make(&plate, id);
        vm_expect(fd, PHANTOM_SUBMIT_SET, &plate.set, -EINVAL, "SUBMIT_SET of an old id");
    }
    vm_plate_submit(fd, 11);
    vm_plate_submit(fd, UINT64_MAX);
    vm_plate_make(&plate, 12);
    vm_expect(fd, PHANTOM_SUBMIT_SET, &plate.set, -EINVAL, "SUBMIT_SET after the last id there is");
}

VM_TEST(set, next_feeder_begins_its_own_count, 10)
{
    int fd = vm_open_feeder();

    vm_plate_submit(fd, 1000);
    CHECK(close(fd) == 0, "close");
    fd = vm_open_feeder();
    vm_plate_submit(fd, 1);
}

VM_TEST(set, limits_themselves_are_accepted, 20)
{
    static struct phantom_patch patches[PHANTOM_PATCHES_MAX];
    struct phantom_material materials[PHANTOM_MATERIALS_MAX];
    struct phantom_object objects[PHANTOM_OBJECTS_MAX];
    int fd = vm_open_feeder();
    const struct phantom_status* page = vm_map(fd);
    struct phantom_status status;
    struct vm_plate plate;

    vm_plate_make(&plate, 1);
    for (int i = 0; i < PHANTOM_PATCHES_MAX; i++) {
        patches[i] = plate.patches[i % VM_PLATE_PATCHES];
        patches[i].face = (uint32_t)i;
        patches[i].material = (uint32_t)i % PHANTOM_MATERIALS_MAX;
        patches[i].object = (uint32_t)i % PHANTOM_OBJECTS_MAX;
        for (int edge = 0; edge < 3; edge++)
            patches[i].neighbour[edge] = PHANTOM_PATCH_NONE;
    }
    for (uint32_t i = 0; i < PHANTOM_MATERIALS_MAX; i++)
        materials[i] = plate.material;
    for (uint32_t i = 0; i < PHANTOM_OBJECTS_MAX; i++) {
        objects[i] = plate.object;
        objects[i].object = i;
    }
    plate.set.patch_count = PHANTOM_PATCHES_MAX;
    plate.set.material_count = PHANTOM_MATERIALS_MAX;
    plate.set.object_count = PHANTOM_OBJECTS_MAX;
    plate.set.patches = (uintptr_t)patches;
    plate.set.materials = (uintptr_t)materials;
    plate.set.objects = (uintptr_t)objects;
    plate.set.centre_nm[0] = PHANTOM_COORDINATE_MAX_NM;
    plate.set.centre_nm[1] = -PHANTOM_COORDINATE_MAX_NM;
    plate.set.radius_nm = 0xffffffff;
    vm_expect(fd, PHANTOM_SUBMIT_SET, &plate.set, 0, "SUBMIT_SET at all limits");
    vm_set_rate(fd, 10000);
    vm_start(fd);
    vm_wait_ticks(page, 100);
    vm_status(page, &status);
    CHECK(status.set_patches == PHANTOM_PATCHES_MAX, "%u patches in use", status.set_patches);
    CHECK(status.missed == 0, "%llu ticks missed", (unsigned long long)status.missed);
    vm_figure("512 patches at 10 kHz: longest section %u instructions", status.section_max_ns);
}

VM_TEST(set, empty_set_covers_and_gives_no_force, 10)
{
    int fd = vm_open_feeder();
    const struct phantom_status* page = vm_map(fd);
    const struct phantom_set empty = {.id = 2, .radius_nm = 100000000};
    struct phantom_status status;

    vm_touch(fd, page);
    vm_expect(fd, PHANTOM_SUBMIT_SET, &empty, 0, "SUBMIT_SET without patches, its pointers NULL");
    vm_status(page, &status);
    vm_wait_ticks(page, status.tick + 40);
    vm_status(page, &status);
    CHECK(status.set_id == 2 && status.set_patches == 0, "set %llu of %u patches",
          (unsigned long long)status.set_id, status.set_patches);
    CHECK(!(status.flags & PHANTOM_TICK_UNCOVERED), "uncovered");
    CHECK(vm_force_size(status.force_un) == 0, "force %d uN from nothing", status.force_un[2]);
}

VM_TEST(set, swap_of_equal_sets_leaves_the_force, 20)
{
    int fd = vm_open_feeder();
    const struct phantom_status* page = vm_map(fd);
    struct phantom_status status;

    vm_touch(fd, page);
    for (uint64_t id = 2; id < 202; id++) {
        vm_plate_submit(fd, id);
        vm_sleep_ns(VM_NS_PER_MS);
        vm_status(page, &status);
        CHECK(llabs(status.force_un[2] - vm_plate_force(VM_CONTACT_HEIGHT_NM)) < 50, "set %llu: force %d uN",
              (unsigned long long)id, status.force_un[2]);
        CHECK(!(status.flags & PHANTOM_TICK_FADING), "set %llu: fade", (unsigned long long)id);
    }
}

VM_TEST(set, stale_set_fades_to_zero_and_a_new_one_brings_it_back, 10)
{
    const struct phantom_start start = {.stale_ms = 50};
    int fd = vm_open_feeder();
    const struct phantom_status* page = vm_map(fd);
    struct phantom_status status;
    uint64_t id = 1;

    vm_move(fd, 2000000, 3000000, VM_CONTACT_HEIGHT_NM);
    vm_plate_submit(fd, id++);
    vm_expect(fd, PHANTOM_START, &start, 0, "START");
    for (int i = 0; i < 40; i++) {
        vm_plate_submit(fd, id++);
        vm_sleep_ns(10 * VM_NS_PER_MS);
    }
    vm_status(page, &status);
    CHECK(status.force_un[2] > 900000 && !(status.flags & PHANTOM_TICK_STALE), "force %d uN, flags %#x, fed",
          status.force_un[2], status.flags);
    vm_sleep_ns(50 * VM_NS_PER_MS + 2 * PHANTOM_FADE_NS);
    vm_status(page, &status);
    CHECK(status.flags & PHANTOM_TICK_STALE, "flags %#x, unfed for 90 ms", status.flags);
    CHECK(vm_force_size(status.force_un) == 0, "force %d uN of a stale set", status.force_un[2]);
    vm_plate_submit(fd, id++);
    vm_sleep_ns(2 * PHANTOM_FADE_NS);
    vm_status(page, &status);
    CHECK(status.force_un[2] > 900000, "force %d uN, fed again", status.force_un[2]);
}
