// SPDX-License-Identifier: GPL-2.0-or-later
// poll: records, a wish for a set, a fault, the end. No assertion on how long it takes.
#include <errno.h>
#include <fcntl.h>
#include <poll.h>
#include <pthread.h>
#include <unistd.h>

#include "device.h"
#include "harness.h"

static short poll_for(int fd, short events, int timeout_ms)
{
    struct pollfd entry = {.fd = fd, .events = events};
    int rc = poll(&entry, 1, timeout_ms);

    CHECK(rc >= 0, "poll failed");
    return rc ? entry.revents : 0;
}

static void drain(int fd)
{
    static struct phantom_tick records[1024];

    while (read(fd, records, sizeof(records)) > 0)
        ;
}

VM_TEST(poll, says_nothing_in_idle, 10)
{
    int fd = vm_open_feeder();

    CHECK(poll_for(fd, POLLIN | POLLPRI, 0) == 0, "the feeder");
    CHECK(poll_for(vm_open(O_RDONLY), POLLIN | POLLPRI, 50) == 0, "an observer");
}

VM_TEST(poll, asks_for_a_set_until_there_is_one, 10)
{
    int fd = vm_open_feeder();
    const struct phantom_status* page = vm_map(fd);
    struct phantom_status status;

    vm_start(fd);
    CHECK(poll_for(fd, POLLPRI, 1000) & POLLPRI, "no set, and nobody asks for one");
    vm_status(page, &status);
    CHECK(status.flags & PHANTOM_TICK_UNCOVERED, "flags %#x without a set", status.flags);
    vm_plate_submit(fd, 1);
    vm_wait_ticks(page, status.tick + 5);
    vm_plate_submit(fd, 2); /* what was asked for before the first came is answered */
    CHECK(poll_for(fd, POLLPRI, 100) == 0, "asks although the set covers everything");
    vm_status(page, &status);
    CHECK(!(status.flags & PHANTOM_TICK_UNCOVERED), "flags %#x with a set", status.flags);
}

VM_TEST(poll, asks_when_the_tip_leaves_coverage, 10)
{
    int fd = vm_open_feeder();
    const struct phantom_status* page = vm_map(fd);
    struct phantom_status status;
    struct vm_plate plate;

    vm_plate_make(&plate, 1);
    plate.set.radius_nm = 10000000;
    vm_expect(fd, PHANTOM_SUBMIT_SET, &plate.set, 0, "SUBMIT_SET that covers 10 mm");
    vm_start(fd);
    vm_wait_ticks(page, 20);
    CHECK(poll_for(fd, POLLPRI, 50) == 0, "asks in the middle of the coverage");
    for (int step = 1; step <= 40; step++) {
        vm_move(fd, step * 300000, 0, VM_CONTACT_HEIGHT_NM);
        vm_sleep_ns(2 * VM_NS_PER_MS);
    }
    CHECK(poll_for(fd, POLLPRI, 1000) & POLLPRI, "does not ask 12 mm from the middle of 10 mm");
    vm_status(page, &status);
    CHECK(status.flags & PHANTOM_TICK_UNCOVERED, "flags %#x", status.flags);
    vm_sleep_ns(2 * PHANTOM_FADE_NS);
    vm_status(page, &status);
    CHECK(vm_force_size(status.force_un) == 0, "force %d uN out of coverage", status.force_un[2]);
}

VM_TEST(poll, tells_a_fault_to_feeder_and_observer, 10)
{
    const struct phantom_start start = {.max_speed_um_s = 1000, .stale_ms = 60000};
    int fd = vm_open_feeder();
    int observer = vm_open(O_RDONLY);
    const struct phantom_status* page = vm_map(fd);

    vm_plate_submit(fd, 1);
    vm_move(fd, 0, 0, 10000000);
    vm_expect(fd, PHANTOM_START, &start, 0, "START");
    vm_wait_ticks(page, 10);
    vm_plate_submit(fd, 2);
    CHECK(poll_for(fd, POLLPRI, 50) == 0, "something is told before the fault");
    vm_move(fd, 0, 0, 90000000);
    CHECK(poll_for(fd, POLLPRI, 1000) & POLLPRI, "the feeder is not told");
    CHECK(poll_for(observer, POLLPRI, 1000) & POLLPRI, "the observer is not told");
    CHECK(vm_state(page) == PHANTOM_STATE_FAULT, "state %u", vm_state(page));
}

VM_TEST(poll, records_can_be_waited_for, 10)
{
    int fd = vm_open_feeder();
    int observer = vm_open(O_RDONLY | O_NONBLOCK);

    vm_plate_submit(fd, 1);
    vm_start(fd);
    for (int i = 0; i < 100; i++) {
        CHECK(poll_for(observer, POLLIN, 1000) & POLLIN, "no record within a second");
        drain(observer);
    }
}

static void* stop_later(void* argument)
{
    vm_sleep_ns(20 * VM_NS_PER_MS);
    vm_expect(*(int*)argument, PHANTOM_STOP, NULL, 0, "STOP");
    return NULL;
}

VM_TEST(poll, end_of_a_run_wakes_and_is_told_once, 10)
{
    int fd = vm_open_feeder();
    int observer = vm_open(O_RDONLY);
    pthread_t thread;
    struct phantom_tick record;
    int records = 0;

    vm_plate_submit(fd, 1);
    vm_start(fd);
    CHECK(pthread_create(&thread, NULL, stop_later, &fd) == 0, "pthread_create");
    for (;;) {
        CHECK(poll_for(observer, POLLIN, 3000) & POLLIN, "asleep after %d records", records);
        if (read(observer, &record, sizeof(record)) == 0)
            break;
        records++;
    }
    pthread_join(thread, NULL);
    CHECK(records > 20, "%d records", records);
    CHECK(poll_for(observer, POLLIN, 50) == 0, "the end is told twice");
}
