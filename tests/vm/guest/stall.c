// SPDX-License-Identifier: GPL-2.0-or-later
/*
 * The servo is kept from its CPU, by the real scheduler: a SCHED_FIFO 99 thread that runs there without a
 * break for longer than start.stall_us.
 */
#define _GNU_SOURCE
#include <errno.h>
#include <fcntl.h>
#include <poll.h>
#include <pthread.h>
#include <sched.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "device.h"
#include "harness.h"

/* On the servo's CPU: the last one online. Returns when it is over. */
static void hog_for(uint64_t duration_ns)
{
    const struct sched_param highest = {.sched_priority = 99};
    const struct sched_param none = {0};
    uint64_t end;
    cpu_set_t set;

    CPU_ZERO(&set);
    CPU_SET((int)sysconf(_SC_NPROCESSORS_ONLN) - 1, &set);
    CHECK(sched_setaffinity(0, sizeof(set), &set) == 0, "sched_setaffinity: %s", strerror(errno));
    CHECK(sched_setscheduler(0, SCHED_FIFO, &highest) == 0, "sched_setscheduler: %s", strerror(errno));
    end = vm_now_ns() + duration_ns;
    while (vm_now_ns() < end)
        ;
    CHECK(sched_setscheduler(0, SCHED_OTHER, &none) == 0, "sched_setscheduler: %s", strerror(errno));
}

VM_TEST(stall, longer_than_the_limit_is_a_fault_and_zero_force, 20)
{
    static struct phantom_tick records[8192];
    int fd = vm_open_feeder();
    int observer = vm_open(O_RDONLY);
    const struct phantom_status* page = vm_map(fd);
    struct pollfd entry = {.fd = observer, .events = POLLPRI};
    const struct phantom_start start = {.stale_ms = 60000};
    struct phantom_status status;
    uint64_t begin, late = 0, faulty = 0;
    ssize_t got;

    vm_touch(fd, page);
    begin = vm_now_ns();
    hog_for(30 * VM_NS_PER_MS); /* the default limit is 20 ms */
    vm_wait_state(page, PHANTOM_STATE_FAULT);
    vm_status(page, &status);
    CHECK(status.faults == PHANTOM_FAULT_STALL, "faults %#x", status.faults);
    CHECK(status.missed >= 28 && status.missed <= 31, "%llu ticks missed in 30 ms at 1 kHz",
          (unsigned long long)status.missed);
    CHECK(vm_force_size(status.force_un) == 0, "force %d uN with a fault", status.force_un[2]);
    CHECK(poll(&entry, 1, 1000) == 1 && (entry.revents & POLLPRI), "poll does not tell the fault");
    vm_wait_ticks(page, status.tick + 50);
    got = read(observer, records, sizeof(records));
    CHECK(got > 0, "read");
    for (size_t i = 0; i < (size_t)got / sizeof(records[0]); i++) {
        if (records[i].time_ns < begin)
            continue;
        if (records[i].latency_ns > 20000000)
            late++;
        if (!late)
            continue;
        faulty++;
        CHECK(vm_force_size(records[i].force_un) == 0, "tick %llu: %d uN after the stall",
              (unsigned long long)records[i].tick, records[i].force_un[2]);
        CHECK(records[i].faults == PHANTOM_FAULT_STALL, "tick %llu: faults %#x",
              (unsigned long long)records[i].tick, records[i].faults);
    }
    CHECK(late == 1, "%llu late ticks of one stall: run in a burst?", (unsigned long long)late);
    CHECK(faulty > 40, "%llu ticks with the fault", (unsigned long long)faulty);
    vm_expect(fd, PHANTOM_START, &start, -EBUSY, "START in FAULT");
}

VM_TEST(stall, clear_fault_brings_the_force_back_through_the_ramp, 20)
{
    int fd = vm_open_feeder();
    const struct phantom_status* page = vm_map(fd);
    struct phantom_status status;

    vm_touch(fd, page);
    hog_for(30 * VM_NS_PER_MS);
    vm_wait_state(page, PHANTOM_STATE_FAULT);
    vm_expect(fd, PHANTOM_CLEAR_FAULT, NULL, 0, "CLEAR_FAULT");
    vm_wait_state(page, PHANTOM_STATE_RUNNING);
    vm_status(page, &status);
    CHECK(status.faults == 0, "faults %#x", status.faults);
    CHECK(status.force_un[2] < 200000, "%d uN at once after CLEAR_FAULT", status.force_un[2]);
    vm_sleep_ns(400 * VM_NS_PER_MS);
    vm_status(page, &status);
    CHECK(llabs(status.force_un[2] - vm_plate_force(VM_CONTACT_HEIGHT_NM)) < 50, "%d uN after the ramp",
          status.force_un[2]);
}

VM_TEST(stall, shorter_than_the_limit_is_none, 20)
{
    int fd = vm_open_feeder();
    const struct phantom_status* page = vm_map(fd);
    struct phantom_status status;

    vm_touch(fd, page);
    hog_for(10 * VM_NS_PER_MS);
    vm_sleep_ns(20 * VM_NS_PER_MS);
    vm_status(page, &status);
    CHECK(status.state == PHANTOM_STATE_RUNNING && status.faults == 0, "state %u, faults %#x", status.state,
          status.faults);
    CHECK(status.missed >= 8 && status.missed <= 11, "%llu ticks missed in 10 ms at 1 kHz",
          (unsigned long long)status.missed);
}

VM_TEST(stall, limits_off_turns_it_off, 20)
{
    const struct phantom_start start = {.flags = PHANTOM_START_LIMITS_OFF, .stale_ms = 60000};
    int fd = vm_open_feeder();
    const struct phantom_status* page = vm_map(fd);
    struct phantom_status status;

    vm_plate_submit(fd, 1);
    vm_expect(fd, PHANTOM_START, &start, 0, "START without limits");
    vm_wait_ticks(page, 10);
    hog_for(50 * VM_NS_PER_MS);
    vm_sleep_ns(5 * VM_NS_PER_MS);
    vm_status(page, &status);
    CHECK(status.state == PHANTOM_STATE_RUNNING, "state %u, faults %#x", status.state, status.faults);
    CHECK(status.missed > 40, "%llu ticks missed", (unsigned long long)status.missed);
}
