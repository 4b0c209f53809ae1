// SPDX-License-Identifier: GPL-2.0-or-later
// The force of a flat plate, which is known: F = k (R - h) along the normal, above and below the surface.
#include <stdlib.h>
#include <sys/mman.h>
#include <unistd.h>

#include "device.h"
#include "harness.h"

/* Single precision over 20 mm resolves 1 to 2 nm; k = 1 uN/nm; the sums of a few of them. */
#define FORCE_SLACK_UN 20
#define PLACE_SLACK_NM 20

struct stroke {
    int fd;
    const struct phantom_status* page;
    int64_t at_nm[3];
};

/* Moves the tip there, not faster than 0.5 m/s, and waits until that place has been computed. */
static void stroke_to(struct stroke* stroke, int64_t x_nm, int64_t y_nm, int64_t z_nm)
{
    const int64_t to_nm[3] = {x_nm, y_nm, z_nm};
    struct phantom_status status;
    bool there;

    do {
        there = true;
        for (int axis = 0; axis < 3; axis++) {
            int64_t step = to_nm[axis] - stroke->at_nm[axis];

            if (llabs(step) > 250000) {
                step = step > 0 ? 250000 : -250000;
                there = false;
            }
            stroke->at_nm[axis] += step;
        }
        vm_move(stroke->fd, stroke->at_nm[0], stroke->at_nm[1], stroke->at_nm[2]);
        vm_status(stroke->page, &status);
        vm_wait_ticks(stroke->page, status.tick + 2);
    } while (!there);
}

static void check_force(struct stroke* stroke, const char* where)
{
    int64_t height = stroke->at_nm[2];
    int64_t expected = vm_plate_force(height);
    struct phantom_status status;

    vm_status(stroke->page, &status);
    CHECK(status.faults == 0 && status.state == PHANTOM_STATE_RUNNING, "%s: faults %#x", where,
          status.faults);
    CHECK(llabs(status.force_un[2] - expected) <= FORCE_SLACK_UN &&
              abs(status.force_un[0]) <= FORCE_SLACK_UN && abs(status.force_un[1]) <= FORCE_SLACK_UN,
          "%s, height %lld nm: force %d %d %d uN, not 0 0 %lld", where, (long long)height, status.force_un[0],
          status.force_un[1], status.force_un[2], (long long)expected);
    CHECK(!(status.flags & PHANTOM_TICK_INSIDE) == (height > 0), "%s, height %lld nm: flags %#x", where,
          (long long)height, status.flags);
    if (height < VM_PLATE_RADIUS_NM)
        CHECK(status.contacts >= 1 && status.normal_q30[2] > PHANTOM_Q30_ONE - (1 << 12),
              "%s: %u contacts, normal z %d", where, status.contacts, status.normal_q30[2]);
    if (height < 0)
        CHECK(llabs(status.proxy_nm[0] - stroke->at_nm[0]) <= PLACE_SLACK_NM &&
                  llabs(status.proxy_nm[1] - stroke->at_nm[1]) <= PLACE_SLACK_NM &&
                  llabs(status.proxy_nm[2]) <= PLACE_SLACK_NM,
              "%s, depth %lld nm: proxy %lld %lld %lld", where, (long long)-height,
              (long long)status.proxy_nm[0], (long long)status.proxy_nm[1], (long long)status.proxy_nm[2]);
    else
        CHECK(status.proxy_nm[2] == height, "%s: proxy %lld nm outside", where,
              (long long)status.proxy_nm[2]);
}

static void begin(struct stroke* stroke, uint32_t model, uint32_t steps, uint32_t combine)
{
    const struct phantom_model wanted = {
        .model = model, .newton_steps = steps, .combine = combine, .proxy = PHANTOM_PROXY_PAPER};

    *stroke = (struct stroke){.fd = vm_open_feeder(), .at_nm = {2000000, 3000000, VM_CONTACT_HEIGHT_NM}};
    stroke->page = vm_map(stroke->fd);
    vm_expect(stroke->fd, PHANTOM_SET_MODEL, &wanted, 0, "SET_MODEL");
    vm_touch(stroke->fd, stroke->page);
}

/* Into the plate, along it, and out again. */
static void press_and_slide(uint32_t model, uint32_t steps, uint32_t combine)
{
    static const int64_t heights_nm[] = {1999000, 1500000, 1000000,  500000,   100000,
                                         -100000, -500000, -1000000, -3000000, 700000};
    struct stroke stroke;

    begin(&stroke, model, steps, combine);
    for (size_t i = 0; i < sizeof(heights_nm) / sizeof(heights_nm[0]); i++) {
        stroke_to(&stroke, 2000000, 3000000, heights_nm[i]);
        check_force(&stroke, "pressing");
    }
    stroke_to(&stroke, 2000000, 3000000, -1000000);
    for (int step = 0; step < 20; step++) {
        /* never on an edge or a corner, on either side of both kinds of edges */
        stroke_to(&stroke, -9100000 + step * 900000, 3300000 - step * 500000, -1000000);
        check_force(&stroke, "sliding below the surface");
    }
    stroke_to(&stroke, stroke.at_nm[0], stroke.at_nm[1], 1000000);
    for (int step = 0; step < 20; step++) {
        stroke_to(&stroke, -9100000 + step * 900000, 3300000 - step * 500000, 1000000);
        check_force(&stroke, "sliding above the surface");
    }
    stroke_to(&stroke, stroke.at_nm[0], stroke.at_nm[1], VM_PLATE_RADIUS_NM + 1000000);
    check_force(&stroke, "out of reach");
}

VM_TEST(contact, plate_is_exact_with_the_projected_model, 60)
{
    press_and_slide(PHANTOM_MODEL_PROJECTED, 2, PHANTOM_COMBINE_BOUNDED);
}

VM_TEST(contact, plate_is_exact_with_the_papers_model, 60)
{
    press_and_slide(PHANTOM_MODEL_PAPER, 0, PHANTOM_COMBINE_PAPER);
}

VM_TEST(contact, every_number_of_newton_steps_agrees_on_a_plate, 60)
{
    for (uint32_t steps = 0; steps <= PHANTOM_NEWTON_STEPS_MAX; steps++) {
        struct stroke stroke;

        begin(&stroke, PHANTOM_MODEL_PROJECTED, steps, PHANTOM_COMBINE_BOUNDED);
        check_force(&stroke, "touching");
        /* A mapping keeps the file, and with it the place of the feeder. */
        munmap((void*)(uintptr_t)stroke.page, vm_status_size(stroke.fd));
        close(stroke.fd);
    }
}

/* On edges and corners of the plate's triangles: one wall, one force. */
VM_TEST(contact, seams_of_the_plate_cannot_be_felt, 60)
{
    const int64_t cell = 2 * VM_PLATE_HALF_NM / VM_PLATE_CELLS;
    struct stroke stroke;

    begin(&stroke, PHANTOM_MODEL_PROJECTED, 2, PHANTOM_COMBINE_BOUNDED);
    for (int column = -1; column <= 1; column++) {
        stroke_to(&stroke, column * cell, 0, 1000000);
        check_force(&stroke, "on a corner");
        stroke_to(&stroke, column * cell, cell / 3, 1000000);
        check_force(&stroke, "on a straight edge");
        stroke_to(&stroke, column * cell + cell / 2, cell / 2, 1000000);
        check_force(&stroke, "on a diagonal");
    }
}

VM_TEST(contact, force_never_exceeds_the_limit, 20)
{
    const struct phantom_start start = {.max_force_un = 700000, .stale_ms = 60000};
    int fd = vm_open_feeder();
    const struct phantom_status* page = vm_map(fd);
    struct phantom_status status;

    vm_plate_submit(fd, 1);
    vm_move(fd, 2000000, 3000000, 500000); /* 1.5 N */
    vm_expect(fd, PHANTOM_START, &start, 0, "START with at most 0.7 N");
    for (int i = 0; i < 400; i++) {
        vm_sleep_ns(VM_NS_PER_MS);
        vm_status(page, &status);
        CHECK(vm_force_size(status.force_un) <= 700000, "%d uN", status.force_un[2]);
    }
    CHECK(status.force_un[2] > 699900, "%d uN after the ramp", status.force_un[2]);
    CHECK((status.flags & PHANTOM_TICK_CLAMPED) && status.clamped > 100, "flags %#x, %llu ticks clamped",
          status.flags, (unsigned long long)status.clamped);
}
