// SPDX-License-Identifier: GPL-2.0-or-later
// SIM_MOVE: the simulated tip.
#include <errno.h>
#include <stdint.h>

#include "device.h"
#include "harness.h"

VM_TEST(move, reserved_bits_are_refused, 10)
{
    int fd = vm_open_feeder();

    for (int bit = 0; bit < 64; bit++) {
        const struct phantom_sim_move move = {.reserved = 1ull << bit};

        vm_expect(fd, PHANTOM_SIM_MOVE, &move, -EINVAL, "SIM_MOVE with a reserved bit");
    }
}

VM_TEST(move, positions_are_refused_beyond_the_limit_and_do_no_harm_within, 10)
{
    static const int64_t far[] = {INT64_MAX,
                                  INT64_MIN,
                                  PHANTOM_POSITION_MAX_NM + 1,
                                  -PHANTOM_POSITION_MAX_NM - 1,
                                  PHANTOM_POSITION_MAX_NM,
                                  -PHANTOM_POSITION_MAX_NM,
                                  INT32_MAX,
                                  INT32_MIN};
    const struct phantom_start start = {.flags = PHANTOM_START_LIMITS_OFF, .stale_ms = 60000};
    int fd = vm_open_feeder();
    const struct phantom_status* page = vm_map(fd);
    struct phantom_status status;

    vm_plate_submit(fd, 1);
    vm_expect(fd, PHANTOM_START, &start, 0, "START");
    for (size_t i = 0; i < sizeof(far) / sizeof(far[0]); i++)
        for (int axis = 0; axis < 3; axis++) {
            struct phantom_sim_move move = {0};
            int expected =
                far[i] > PHANTOM_POSITION_MAX_NM || far[i] < -PHANTOM_POSITION_MAX_NM ? -EINVAL : 0;

            move.tip_nm[axis] = far[i];
            vm_expect(fd, PHANTOM_SIM_MOVE, &move, expected, "SIM_MOVE far away");
            vm_status(page, &status);
            vm_wait_ticks(page, status.tick + 3);
            vm_status(page, &status);
            CHECK(status.state == PHANTOM_STATE_RUNNING && status.faults == 0, "state %u, faults %#x",
                  status.state, status.faults);
        }
}

VM_TEST(move, next_tick_is_there, 10)
{
    int fd = vm_open_feeder();
    const struct phantom_status* page = vm_map(fd);
    struct phantom_status status;

    vm_move(fd, 1, -2, 3);
    vm_start(fd);
    vm_wait_ticks(page, 2);
    for (int i = 0; i < 100; i++) {
        vm_move(fd, i * 1000, -i * 2000, i * 3000);
        vm_status(page, &status);
        vm_wait_ticks(page, status.tick + 2);
        vm_status(page, &status);
        CHECK(status.tip_nm[0] == i * 1000 && status.tip_nm[1] == -i * 2000 && status.tip_nm[2] == i * 3000,
              "tip %lld %lld %lld nm after move %d", (long long)status.tip_nm[0], (long long)status.tip_nm[1],
              (long long)status.tip_nm[2], i);
    }
}
