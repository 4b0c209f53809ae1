// SPDX-License-Identifier: GPL-2.0-or-later
// Who may open: one feeder, any number of observers; and what a close leaves behind.
#define _GNU_SOURCE
#include <errno.h>
#include <fcntl.h>
#include <sys/mman.h>
#include <sys/wait.h>
#include <unistd.h>

#include "device.h"
#include "harness.h"

VM_TEST(opener, second_feeder_is_busy_and_observers_are_not, 10)
{
    int fd = vm_open_feeder();
    int rc;

    rc = vm_try_open(O_RDWR);
    CHECK(rc == -EBUSY, "second O_RDWR gave %s", vm_error_name(rc));
    rc = vm_try_open(O_WRONLY);
    CHECK(rc == -EBUSY, "O_WRONLY beside a feeder gave %s", vm_error_name(rc));
    for (int i = 0; i < 100; i++)
        vm_open(O_RDONLY);
    CHECK(close(fd) == 0, "close");
    fd = vm_open(O_WRONLY);
    rc = vm_try_open(O_RDWR);
    CHECK(rc == -EBUSY, "O_RDWR beside O_WRONLY gave %s", vm_error_name(rc));
    CHECK(close(fd) == 0, "close");
    vm_open_feeder();
}

VM_TEST(opener, duplicated_file_is_one_feeder, 10)
{
    int fd = vm_open_feeder();
    int copy = dup(fd);

    CHECK(copy >= 0, "dup");
    CHECK(close(fd) == 0, "close");
    CHECK(vm_try_open(O_RDWR) == -EBUSY, "free while the duplicate is open");
    vm_set_rate(copy, 2000);
    CHECK(close(copy) == 0, "close");
    vm_open_feeder();
}

VM_TEST(opener, close_ends_the_run_with_zero_force, 20)
{
    int observer = vm_open(O_RDONLY);
    const struct phantom_status* page = vm_map(observer);
    struct phantom_status status;
    uint64_t tick;

    for (int i = 0; i < 3; i++) {
        int fd = vm_open_feeder();

        vm_touch(fd, page);
        CHECK(close(fd) == 0, "close");
        vm_status(page, &status);
        CHECK(status.state == PHANTOM_STATE_IDLE, "state %u after close", status.state);
        CHECK(vm_force_size(status.force_un) == 0, "force %d uN after close", status.force_un[2]);
        CHECK(status.set_id == 0, "set %llu outlived its feeder", (unsigned long long)status.set_id);
        tick = status.tick;
        vm_sleep_ns(10 * VM_NS_PER_MS);
        vm_status(page, &status);
        CHECK(status.tick == tick, "it ticks on after close");
    }
}

VM_TEST(opener, close_at_any_moment_of_a_tick, 60)
{
    uint64_t random = vm_seed();
    int observer = vm_open(O_RDONLY);
    const struct phantom_status* page = vm_map(observer);

    for (int i = 0; i < 200; i++) {
        const struct phantom_start start = {.ramp_ms = 1, .stale_ms = 60000};
        int fd = vm_open_feeder();

        vm_set_rate(fd, 10000);
        vm_move(fd, 0, 0, VM_CONTACT_HEIGHT_NM);
        vm_plate_submit(fd, 1);
        vm_expect(fd, PHANTOM_START, &start, 0, "START");
        vm_sleep_ns(vm_random_below(&random, 500000));
        if (i % 3 == 0)
            vm_plate_submit(fd, 2);
        CHECK(close(fd) == 0, "close");
        CHECK(vm_state(page) == PHANTOM_STATE_IDLE, "state %u after close %d", vm_state(page), i);
    }
}

struct race {
    uint32_t holders;
    uint32_t taken;
    uint32_t busy;
};

static void race_for_the_feeder(struct race* race, uint64_t random)
{
    uint64_t end = vm_now_ns() + VM_NS_PER_S;

    while (vm_now_ns() < end) {
        int fd = vm_try_open(O_RDWR);

        if (fd < 0) {
            CHECK(fd == -EBUSY, "open gave %s", vm_error_name(fd));
            __atomic_add_fetch(&race->busy, 1, __ATOMIC_SEQ_CST);
            vm_sleep_ns(vm_random_below(&random, 20000));
            continue;
        }
        CHECK(__atomic_add_fetch(&race->holders, 1, __ATOMIC_SEQ_CST) == 1, "two feeders at once");
        __atomic_add_fetch(&race->taken, 1, __ATOMIC_SEQ_CST);
        vm_plate_submit(fd, 1);
        vm_sleep_ns(vm_random_below(&random, 50000));
        __atomic_sub_fetch(&race->holders, 1, __ATOMIC_SEQ_CST);
        close(fd);
        vm_sleep_ns(vm_random_below(&random, 20000));
    }
}

VM_TEST(opener, racing_feeders_take_turns, 20)
{
    struct race* race = mmap(NULL, sizeof(*race), PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0);
    uint64_t seed = vm_seed();
    int status;

    CHECK(race != MAP_FAILED, "mmap");
    for (unsigned int i = 0; i < 4; i++)
        if (fork() == 0) {
            race_for_the_feeder(race, seed + i);
            _exit(0);
        }
    for (int i = 0; i < 4; i++)
        CHECK(wait(&status) > 0 && status == 0, "a racer ended with status %#x", status);
    CHECK(race->taken > 100 && race->busy > 100, "no race: %u taken, %u busy", race->taken, race->busy);
    vm_figure("%u times taken, %u times busy", race->taken, race->busy);
}
