// SPDX-License-Identifier: GPL-2.0-or-later
// START, STOP, CLEAR_FAULT: errors, and the states between them.
#include <errno.h>
#include <fcntl.h>
#include <pthread.h>
#include <stdlib.h>
#include <unistd.h>

#include "device.h"
#include "harness.h"

VM_TEST(start, unknown_flags_are_refused, 10)
{
    int fd = vm_open_feeder();
    const struct phantom_status* page = vm_map(fd);

    for (int bit = 0; bit < 32; bit++) {
        const struct phantom_start flag = {.flags = 1u << bit};

        if (!(flag.flags & PHANTOM_START_FLAGS_KNOWN))
            vm_expect(fd, PHANTOM_START, &flag, -EINVAL, "START with an unknown flag");
    }
    CHECK(vm_state(page) == PHANTOM_STATE_IDLE, "a refused START left state %u", vm_state(page));
}

VM_TEST(start, more_force_than_the_device_has_is_refused, 10)
{
    struct phantom_info info;
    int fd = vm_open_feeder();
    struct phantom_start start = {0};

    vm_expect(fd, PHANTOM_GET_INFO, &info, 0, "GET_INFO");
    start.max_force_un = info.max_force_un + 1;
    vm_expect(fd, PHANTOM_START, &start, -EINVAL, "START 1 uN above the device's force");
    start.max_force_un = 0xffffffff;
    vm_expect(fd, PHANTOM_START, &start, -EINVAL, "START with 4.3 kN");
    start.max_force_un = info.max_force_un;
    vm_expect(fd, PHANTOM_START, &start, 0, "START with all of the device's force");
}

VM_TEST(start, ramp_longer_than_the_limit_is_refused, 10)
{
    int fd = vm_open_feeder();
    struct phantom_start start = {.ramp_ms = PHANTOM_RAMP_MAX_MS + 1};

    vm_expect(fd, PHANTOM_START, &start, -EINVAL, "START with a ramp 1 ms too long");
    start.ramp_ms = 0xffffffff;
    vm_expect(fd, PHANTOM_START, &start, -EINVAL, "START with a ramp of 50 days");
    start.ramp_ms = PHANTOM_RAMP_MAX_MS;
    vm_expect(fd, PHANTOM_START, &start, 0, "START with the longest ramp");
}

VM_TEST(start, crossfade_longer_than_the_limit_is_refused, 10)
{
    int fd = vm_open_feeder();
    struct phantom_start start = {.crossfade_ms = PHANTOM_RAMP_MAX_MS + 1};

    vm_expect(fd, PHANTOM_START, &start, -EINVAL, "START with a crossfade 1 ms too long");
    start.crossfade_ms = PHANTOM_RAMP_MAX_MS;
    vm_expect(fd, PHANTOM_START, &start, 0, "START with the longest crossfade");
}

VM_TEST(start, second_start_is_busy_and_stop_is_idempotent, 10)
{
    const struct phantom_start start = {0};
    int fd = vm_open_feeder();
    const struct phantom_status* page = vm_map(fd);

    vm_expect(fd, PHANTOM_STOP, NULL, 0, "STOP in IDLE");
    vm_expect(fd, PHANTOM_START, &start, 0, "START");
    vm_expect(fd, PHANTOM_START, &start, -EBUSY, "second START");
    CHECK(vm_state(page) == PHANTOM_STATE_RUNNING, "state %u", vm_state(page));
    vm_expect(fd, PHANTOM_STOP, NULL, 0, "STOP");
    vm_wait_state(page, PHANTOM_STATE_IDLE);
    vm_expect(fd, PHANTOM_STOP, NULL, 0, "second STOP");
    vm_expect(fd, PHANTOM_START, &start, 0, "START again");
}

VM_TEST(start, every_limit_may_be_given_or_left_out, 20)
{
    int fd = vm_open_feeder();
    const struct phantom_status* page = vm_map(fd);
    const struct phantom_start starts[] = {
        {0},
        {.flags = PHANTOM_START_LIMITS_OFF},
        {.max_force_un = 1},
        {.slew_un_per_ms = 1},
        {.ramp_ms = 1},
        {.max_speed_um_s = 1},
        {.stall_us = 1000},
        {.stale_ms = 1},
        {.crossfade_ms = 1},
    };

    for (size_t i = 0; i < sizeof(starts) / sizeof(starts[0]); i++) {
        CHECK(vm_ioctl(fd, PHANTOM_START, &starts[i]) == 0, "START number %zu", i);
        vm_sleep_ns(5 * VM_NS_PER_MS);
        vm_expect(fd, PHANTOM_STOP, NULL, 0, "STOP");
        vm_wait_state(page, PHANTOM_STATE_IDLE);
    }
}

VM_TEST(start, force_ramps_up_and_down_and_never_steps, 20)
{
    enum { RECORDS = 4096 };
    static struct phantom_tick records[RECORDS];
    int fd = vm_open_feeder();
    int observer = vm_open(O_RDONLY | O_NONBLOCK);
    const struct phantom_status* page = vm_map(fd);
    int32_t last = 0;
    int32_t most = 0;
    size_t count = 0;

    vm_touch(fd, page);
    vm_expect(fd, PHANTOM_STOP, NULL, 0, "STOP");
    vm_wait_state(page, PHANTOM_STATE_IDLE);
    for (;;) {
        ssize_t got = read(observer, records, sizeof(records));

        if (got <= 0)
            break;
        count += (size_t)got / sizeof(records[0]);
        for (size_t i = 0; i < (size_t)got / sizeof(records[0]); i++) {
            /* 1 N over 250 ticks: 4 mN a tick; in the first 20 ms the fade doubles that at most. */
            CHECK(abs(records[i].force_un[2] - last) <= 9000, "tick %llu steps from %d to %d uN",
                  (unsigned long long)records[i].tick, last, records[i].force_un[2]);
            last = records[i].force_un[2];
            most = last > most ? last : most;
        }
    }
    CHECK(count > 400, "%zu records of two ramps of 250 ms", count);
    CHECK(most > vm_plate_force(VM_CONTACT_HEIGHT_NM) - 50, "at most %d uN", most);
    CHECK(last == 0, "the last record has %d uN", last);
}

VM_TEST(start, clear_fault_without_a_fault_is_nothing, 10)
{
    int fd = vm_open_feeder();
    const struct phantom_status* page = vm_map(fd);

    vm_expect(fd, PHANTOM_CLEAR_FAULT, NULL, 0, "CLEAR_FAULT in IDLE");
    vm_touch(fd, page);
    vm_expect(fd, PHANTOM_CLEAR_FAULT, NULL, 0, "CLEAR_FAULT while running");
    vm_sleep_ns(10 * VM_NS_PER_MS);
    CHECK(vm_state(page) == PHANTOM_STATE_RUNNING, "state %u", vm_state(page));
}

VM_TEST(start, latched_fault_outlives_stop_and_forbids_start, 20)
{
    const struct phantom_start start = {.max_speed_um_s = 1000}; /* 1 mm/s */
    int fd = vm_open_feeder();
    const struct phantom_status* page = vm_map(fd);
    struct phantom_status status;

    vm_move(fd, 0, 0, 0);
    vm_expect(fd, PHANTOM_START, &start, 0, "START");
    vm_wait_ticks(page, 5);
    vm_move(fd, 0, 0, 50000000);
    vm_wait_state(page, PHANTOM_STATE_FAULT);
    vm_status(page, &status);
    CHECK(status.faults == PHANTOM_FAULT_OVERSPEED, "faults %#x", status.faults);
    vm_expect(fd, PHANTOM_STOP, NULL, 0, "STOP in FAULT");
    vm_wait_state(page, PHANTOM_STATE_IDLE);
    vm_expect(fd, PHANTOM_START, &start, -EIO, "START with a latched fault");
    vm_expect(fd, PHANTOM_CLEAR_FAULT, NULL, 0, "CLEAR_FAULT");
    vm_expect(fd, PHANTOM_START, &start, 0, "START after CLEAR_FAULT");
}

struct stop {
    int fd;
    uint64_t over_ns;
};

static void* stop_it(void* argument)
{
    struct stop* stop = argument;

    vm_expect(stop->fd, PHANTOM_STOP, NULL, 0, "STOP");
    __atomic_store_n(&stop->over_ns, vm_now_ns(), __ATOMIC_RELEASE);
    return NULL;
}

/* The ramp down still pushes: it has to know of the triangles that come. */
VM_TEST(start, sets_are_taken_while_stop_ramps_down, 20)
{
    const struct phantom_start start = {.ramp_ms = 400, .stale_ms = 100};
    struct stop stop = {.fd = vm_open_feeder()};
    const struct phantom_status* page = vm_map(stop.fd);
    struct phantom_status status;
    uint64_t asked_ns, longest_ns = 0, id = 1;
    pthread_t thread;

    vm_move(stop.fd, 2000000, 3000000, VM_CONTACT_HEIGHT_NM);
    vm_plate_submit(stop.fd, id);
    vm_expect(stop.fd, PHANTOM_START, &start, 0, "START");
    for (int i = 0; i < 100; i++) {
        vm_plate_submit(stop.fd, ++id);
        vm_sleep_ns(5 * VM_NS_PER_MS);
    }
    asked_ns = vm_now_ns();
    CHECK(pthread_create(&thread, NULL, stop_it, &stop) == 0, "pthread_create");
    while (!__atomic_load_n(&stop.over_ns, __ATOMIC_ACQUIRE)) {
        uint64_t began_ns = vm_now_ns(), length_ns;

        vm_plate_submit(stop.fd, ++id);
        length_ns = vm_now_ns() - began_ns;
        longest_ns = length_ns > longest_ns ? length_ns : longest_ns;
        vm_sleep_ns(5 * VM_NS_PER_MS);
        vm_status(page, &status);
        CHECK(!(status.flags & (PHANTOM_TICK_STALE | PHANTOM_TICK_FADING)), "flags %#x during the ramp",
              status.flags);
    }
    pthread_join(thread, NULL);
    CHECK(stop.over_ns - asked_ns > 350 * VM_NS_PER_MS, "the ramp took %llu ns",
          (unsigned long long)(stop.over_ns - asked_ns));
    CHECK(longest_ns < 20 * VM_NS_PER_MS, "a SUBMIT_SET took %llu ns", (unsigned long long)longest_ns);
    CHECK(status.set_id + 5 > id, "set %llu in use, %llu submitted", (unsigned long long)status.set_id,
          (unsigned long long)id);
}
