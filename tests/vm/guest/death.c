// SPDX-License-Identifier: GPL-2.0-or-later
/*
 * The feeder dies in contact. Whoever holds the arm must not be pushed by a program that is no more:
 * zero force within PHANTOM_FADE_NS (20 ms), seen by an observer in the tick records.
 */
#define _GNU_SOURCE
#include <errno.h>
#include <fcntl.h>
#include <signal.h>
#include <stdlib.h>
#include <string.h>
#include <sys/wait.h>
#include <unistd.h>

#include "device.h"
#include "harness.h"

/* A feeder in contact; returns when it gives full force. */
static pid_t make_feeder(uint32_t rate_hz, const struct phantom_status* page)
{
    uint64_t end = vm_now_ns() + 5 * VM_NS_PER_S;
    struct phantom_status status;
    pid_t feeder = fork();

    if (feeder == 0) {
        int fd = vm_open_feeder();

        vm_set_rate(fd, rate_hz);
        vm_touch(fd, vm_map(fd));
        for (uint64_t id = 2;; id++) {
            vm_plate_submit(fd, id);
            vm_sleep_ns(2 * VM_NS_PER_MS);
        }
    }
    CHECK(feeder > 0, "fork");
    do {
        CHECK(vm_now_ns() < end, "the feeder never came to full force");
        vm_sleep_ns(VM_NS_PER_MS);
        vm_status(page, &status);
    } while (status.force_un[2] < vm_plate_force(VM_CONTACT_HEIGHT_NM) - 50 || status.sets < 3);
    return feeder;
}

/* Reads what is left and looks at what the force did after `died_ns`. */
static void check_records(int observer, uint64_t died_ns, const char* how)
{
    static struct phantom_tick records[16384];
    uint64_t silent_ns = 0;
    int32_t before = 0, after = 0;
    bool pushed = false;

    for (;;) {
        ssize_t got = read(observer, records, sizeof(records));

        CHECK(got >= 0, "read: %s", strerror(errno));
        if (got == 0)
            break;
        for (size_t i = 0; i < (size_t)got / sizeof(records[0]); i++) {
            int64_t force = vm_force_size(records[i].force_un);

            if (records[i].time_ns <= died_ns) {
                before = records[i].force_un[2];
                continue;
            }
            if (force) {
                CHECK(!silent_ns, "%s: force again, %lld uN, after zero", how, (long long)force);
                pushed = true;
                after = records[i].force_un[2];
            } else if (!silent_ns) {
                silent_ns = records[i].time_ns;
            }
            CHECK(force == 0 || records[i].time_ns <= died_ns + PHANTOM_FADE_NS, "%s: %lld uN %llu us later",
                  how, (long long)force, (unsigned long long)(records[i].time_ns - died_ns) / 1000);
        }
    }
    CHECK(before > vm_plate_force(VM_CONTACT_HEIGHT_NM) - 50, "%s: only %d uN before", how, before);
    vm_figure("%s: zero force %llu us later%s (last %d uN)", how,
              (unsigned long long)(silent_ns ? (silent_ns - died_ns) / 1000 : 0), pushed ? "" : ", at once",
              after);
}

static void dies(uint32_t rate_hz, int signal)
{
    int observer = vm_open(O_RDONLY);
    const struct phantom_status* page = vm_map(observer);
    pid_t feeder = make_feeder(rate_hz, page);
    struct phantom_status status;
    uint64_t died_ns;

    vm_sleep_ns(20 * VM_NS_PER_MS);
    died_ns = vm_now_ns();
    CHECK(kill(feeder, signal) == 0, "kill");
    vm_wait_state(page, PHANTOM_STATE_IDLE);
    vm_status(page, &status);
    CHECK(vm_force_size(status.force_un) == 0, "force %d uN in IDLE", status.force_un[2]);
    CHECK(status.faults == 0, "faults %#x", status.faults);
    CHECK(waitpid(feeder, NULL, 0) == feeder, "waitpid");
    check_records(observer, died_ns, strsignal(signal));
    close(vm_open_feeder()); /* the next one can begin */
}

VM_TEST(death, sigkill_in_contact_at_1_khz_ends_the_force_within_20_ms, 20)
{
    dies(1000, SIGKILL);
}
VM_TEST(death, sigkill_in_contact_at_10_khz_ends_the_force_within_20_ms, 20)
{
    dies(10000, SIGKILL);
}
VM_TEST(death, sigsegv_in_contact_ends_the_force_within_20_ms, 20)
{
    dies(3000, SIGSEGV);
}

VM_TEST(death, sigstop_is_not_death_but_the_set_goes_stale, 20)
{
    const struct phantom_start start = {.stale_ms = 50};
    int observer = vm_open(O_RDONLY);
    const struct phantom_status* page = vm_map(observer);
    struct phantom_status status;
    pid_t feeder = fork();

    if (feeder == 0) {
        int fd = vm_open_feeder();

        vm_move(fd, 2000000, 3000000, VM_CONTACT_HEIGHT_NM);
        vm_plate_submit(fd, 1);
        vm_expect(fd, PHANTOM_START, &start, 0, "START");
        for (uint64_t id = 2;; id++) {
            vm_plate_submit(fd, id);
            vm_sleep_ns(5 * VM_NS_PER_MS);
        }
    }
    vm_sleep_ns(400 * VM_NS_PER_MS);
    vm_status(page, &status);
    CHECK(status.force_un[2] > 900000, "force %d uN", status.force_un[2]);
    CHECK(kill(feeder, SIGSTOP) == 0, "kill");
    vm_sleep_ns(50 * VM_NS_PER_MS + 2 * PHANTOM_FADE_NS);
    vm_status(page, &status);
    CHECK(status.state == PHANTOM_STATE_RUNNING && (status.flags & PHANTOM_TICK_STALE), "state %u, flags %#x",
          status.state, status.flags);
    CHECK(vm_force_size(status.force_un) == 0, "force %d uN from a stopped feeder", status.force_un[2]);
    CHECK(kill(feeder, SIGCONT) == 0, "kill");
    vm_sleep_ns(60 * VM_NS_PER_MS);
    vm_status(page, &status);
    CHECK(status.force_un[2] > 900000, "force %d uN after SIGCONT", status.force_un[2]);
    CHECK(kill(feeder, SIGKILL) == 0 && waitpid(feeder, NULL, 0) == feeder, "kill");
}
