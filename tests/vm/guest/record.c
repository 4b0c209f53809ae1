// SPDX-License-Identifier: GPL-2.0-or-later
// read: tick records.
#define _GNU_SOURCE
#include <errno.h>
#include <fcntl.h>
#include <pthread.h>
#include <signal.h>
#include <string.h>
#include <sys/mman.h>
#include <unistd.h>

#include "device.h"
#include "harness.h"

/* noinline: the compiler must not know that some of the buffers are bad. */
__attribute__((noinline)) static int read_some(int fd, void* buffer, size_t size)
{
    ssize_t rc = read(fd, buffer, size);

    return rc < 0 ? -errno : (int)rc;
}

VM_TEST(record, sizes, 10)
{
    static struct phantom_tick records[8];
    int fd = vm_open_feeder();
    const struct phantom_status* page = vm_map(fd);
    int rc;

    vm_start(fd);
    vm_wait_ticks(page, 20);
    for (size_t size = 0; size < sizeof(struct phantom_tick); size++) {
        rc = read_some(fd, records, size);
        CHECK(rc == -EINVAL, "a buffer of %zu bytes gave %s", size, vm_error_name(rc));
    }
    CHECK(read_some(fd, records, sizeof(records[0])) == sizeof(records[0]), "one record");
    memset(records, 0xcc, sizeof(records));
    CHECK(read_some(fd, records, 3 * sizeof(records[0]) - 1) == 2 * sizeof(records[0]),
          "room for not quite three");
    for (size_t i = 0; i < sizeof(records[0]); i++)
        CHECK(((unsigned char*)&records[2])[i] == 0xcc, "byte %zu behind the last record was written", i);
}

VM_TEST(record, bad_buffer_is_a_fault_and_loses_nothing, 10)
{
    int fd = vm_open_feeder();
    const struct phantom_status* page = vm_map(fd);
    struct phantom_tick first, second;
    char* hole = mmap(NULL, 8192, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);

    CHECK(hole != MAP_FAILED && munmap(hole + 4096, 4096) == 0, "mmap");
    vm_start(fd);
    vm_wait_ticks(page, 20);
    CHECK(read_some(fd, &first, sizeof(first)) == sizeof(first), "read");
    CHECK(read_some(fd, NULL, sizeof(first)) == -EFAULT, "NULL");
    CHECK(read_some(fd, (void*)0xffff888000000000ul, sizeof(first)) == -EFAULT, "the kernel's memory");
    CHECK(read_some(fd, hole + 4096 - 8, sizeof(first)) == -EFAULT, "across a hole");
    CHECK(read_some(fd, &second, sizeof(second)) == sizeof(second), "read");
    CHECK(second.tick == first.tick + 1, "tick %llu after %llu", (unsigned long long)second.tick,
          (unsigned long long)first.tick);
}

VM_TEST(record, nothing_to_read, 10)
{
    struct phantom_tick record;
    int fd = vm_open_feeder();
    int observer = vm_open(O_RDONLY | O_NONBLOCK);
    int rc;

    CHECK(read_some(fd, &record, sizeof(record)) == 0, "in IDLE, blocking");
    CHECK(read_some(observer, &record, sizeof(record)) == 0, "in IDLE, O_NONBLOCK");
    vm_start(fd);
    while ((rc = read_some(observer, &record, sizeof(record))) > 0)
        ;
    CHECK(rc == -EAGAIN, "no record, O_NONBLOCK: %s", vm_error_name(rc));
    rc = read_some(fd, &record, sizeof(record));
    CHECK(rc > 0, "a blocking reader got %s", vm_error_name(rc));
}

VM_TEST(record, one_for_every_tick_in_order, 20)
{
    static struct phantom_tick records[64];
    int fd = vm_open_feeder();
    const struct phantom_status* page = vm_map(fd);
    uint64_t expected = 1;
    uint64_t last_ns = 0;

    vm_set_rate(fd, 10000);
    vm_touch(fd, page);
    while (expected < 8000) {
        int got = read_some(fd, records, sizeof(records));

        CHECK(got > 0, "read gave %s", vm_error_name(got));
        for (size_t i = 0; i < (size_t)got / sizeof(records[0]); i++, expected++) {
            CHECK(records[i].tick == expected, "tick %llu, expected %llu",
                  (unsigned long long)records[i].tick, (unsigned long long)expected);
            CHECK(records[i].time_ns > last_ns, "time stands still at tick %llu",
                  (unsigned long long)expected);
            CHECK(records[i].faults == 0 && records[i].tip_nm[2] == VM_CONTACT_HEIGHT_NM,
                  "tick %llu: faults %#x, tip %lld nm", (unsigned long long)expected, records[i].faults,
                  (long long)records[i].tip_nm[2]);
            last_ns = records[i].time_ns;
        }
    }
}

VM_TEST(record, slow_reader_loses_the_oldest_and_sees_the_gap, 20)
{
    static struct phantom_tick records[16384];
    int fd = vm_open_feeder();
    const struct phantom_status* page = vm_map(fd);
    struct phantom_status status;
    uint32_t lost;
    int got;

    vm_status(page, &status);
    lost = status.lost;
    vm_set_rate(fd, 10000);
    vm_start(fd);
    vm_wait_ticks(page, 20000); /* two seconds: more than any ring of this module holds */
    got = read_some(fd, records, sizeof(records)) / (int)sizeof(records[0]);
    vm_status(page, &status);
    CHECK(got > 100 && got < 16384, "%d records at once", got);
    CHECK(records[0].tick > 1, "the ring holds all of two seconds: make the test longer");
    for (int i = 1; i < got; i++)
        CHECK(records[i].tick == records[i - 1].tick + 1, "a gap inside: %llu after %llu",
              (unsigned long long)records[i].tick, (unsigned long long)records[i - 1].tick);
    CHECK(records[got - 1].tick + 100 > status.tick, "the newest is %llu ticks old",
          (unsigned long long)(status.tick - records[got - 1].tick));
    vm_wait_ticks(page, status.tick + 10); /* the page says it with the next tick */
    vm_status(page, &status);
    CHECK(status.lost - lost == records[0].tick - 1, "%u records counted as lost, %llu are",
          status.lost - lost, (unsigned long long)records[0].tick - 1);
    vm_figure("the ring keeps %d records", got);
}

VM_TEST(record, every_reader_gets_all, 10)
{
    static struct phantom_tick one[1000], two[1000];
    int fd = vm_open_feeder();
    int first = vm_open(O_RDONLY | O_NONBLOCK), second = vm_open(O_RDONLY | O_NONBLOCK);
    const struct phantom_status* page = vm_map(fd);
    int got;

    vm_start(fd);
    vm_wait_ticks(page, 100);
    got = read_some(first, one, sizeof(one));
    CHECK(got >= 100 * (int)sizeof(one[0]), "%d bytes", got);
    CHECK(read_some(second, two, (size_t)got) == got, "the second gets less");
    CHECK(memcmp(one, two, (size_t)got) == 0, "they differ");
}

static void on_alarm(int signal)
{
    (void)signal;
}

VM_TEST(record, signal_interrupts_a_waiting_reader, 10)
{
    struct phantom_tick record;
    struct sigaction action = {.sa_handler = on_alarm};
    int fd = vm_open_feeder();
    int rc = 1;

    CHECK(sigaction(SIGALRM, &action, NULL) == 0, "sigaction");
    vm_set_rate(fd, 1000);
    vm_start(fd);
    for (int i = 0; i < 2000 && rc > 0; i++) {
        while (read_some(fd, &record, sizeof(record)) == -EAGAIN)
            ;
        ualarm(300, 0);
        rc = read_some(fd, &record, sizeof(record));
    }
    CHECK(rc == -EINTR, "2000 signals into read, the last gave %s", vm_error_name(rc));
}
