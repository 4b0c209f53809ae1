// SPDX-License-Identifier: GPL-2.0-or-later
/*
 * The machine goes to sleep and wakes up while the tip is in contact, and the wall clock is set.
 *
 * The kernel's own test levels (/sys/power/pm_test) stop half-way into suspend and come back: `freezer`
 * freezes processes, `devices` suspends devices as well. The chain of notifiers runs as for a real one. They
 * come back at once: the kernel's delay of five seconds is a loop, and under -icount a loop takes its time.
 */
#define _GNU_SOURCE
#include <errno.h>
#include <fcntl.h>
#include <poll.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>
#include <unistd.h>

#include "device.h"
#include "harness.h"
#include "module.h"

static bool try_write(const char* path, const char* text)
{
    int fd = open(path, O_WRONLY | O_CLOEXEC);
    bool written = fd >= 0 && write(fd, text, strlen(text)) == (ssize_t)strlen(text);

    if (fd >= 0)
        close(fd);
    return written;
}

static int sleeps_so_far(void)
{
    char text[16] = "";
    int fd = open("/sys/power/suspend_stats/success", O_RDONLY | O_CLOEXEC);

    CHECK(fd >= 0 && read(fd, text, sizeof(text) - 1) > 0, "suspend_stats: %s", strerror(errno));
    close(fd);
    return atoi(text);
}

/* Returns when the machine has woken up again. */
static void sleep_machine(const char* level)
{
    int before = sleeps_so_far();

    if (!try_write("/sys/power/pm_test", level))
        vm_skip("this kernel has no /sys/power/pm_test");
    CHECK(try_write("/sys/module/suspend/parameters/pm_test_delay", "0"), "pm_test_delay: %s",
          strerror(errno));
    CHECK(try_write("/sys/power/state", "freeze"), "suspend: %s", strerror(errno));
    CHECK(sleeps_so_far() == before + 1, "the kernel did not suspend");
}

/* Records of the whole test; the force may fall, never jump, and is zero from some tick on. */
static void check_ramp_down(int observer, uint64_t asleep_ns)
{
    static struct phantom_tick records[8192];
    ssize_t got = read(observer, records, sizeof(records));
    int32_t last = 0;
    bool fell = false;

    CHECK(got > 0, "read: %s", strerror(errno));
    for (size_t i = 0; i < (size_t)got / sizeof(records[0]); i++) {
        const struct phantom_tick* tick = &records[i];

        CHECK(i == 0 || tick->tick == records[i - 1].tick + 1, "tick %llu after %llu",
              (unsigned long long)tick->tick, (unsigned long long)records[i - 1].tick);
        if (tick->time_ns < asleep_ns) {
            last = tick->force_un[2];
            continue;
        }
        CHECK(abs(tick->force_un[2] - last) < 200000, "tick %llu: %d uN after %d",
              (unsigned long long)tick->tick, tick->force_un[2], last);
        CHECK(!tick->force_un[2] || tick->time_ns < asleep_ns + PHANTOM_FADE_NS,
              "%d uN %llu us after suspend", tick->force_un[2],
              (unsigned long long)(tick->time_ns - asleep_ns) / 1000);
        fell |= last && !tick->force_un[2];
        last = tick->force_un[2];
    }
    CHECK(fell && !last, "the force did not end at zero but at %d uN", last);
}

static void sleeps_and_wakes(const char* level)
{
    int fd = vm_open_feeder();
    int observer = vm_open(O_RDONLY);
    const struct phantom_status* page = vm_map(fd);
    struct pollfd entry = {.fd = observer, .events = POLLPRI};
    struct phantom_status before, after;
    uint64_t asleep_ns;
    char text[100];

    vm_touch(fd, page);
    vm_status(page, &before);
    asleep_ns = vm_now_ns();
    sleep_machine(level);
    vm_wait_ticks(page, before.tick + 40);
    vm_status(page, &after);
    vm_read_file("/sys/class/phantom_rt/phantom_rt0/faults", text, sizeof(text));
    CHECK(strcmp(text, "suspended\n") == 0, "the faults file says %s", text);
    CHECK(after.state == PHANTOM_STATE_FAULT && after.faults == PHANTOM_FAULT_SUSPENDED,
          "state %u, faults %#x", after.state, after.faults);
    CHECK(vm_force_size(after.force_un) == 0, "force %d uN after waking up", after.force_un[2]);
    CHECK(after.missed == 0, "%llu ticks missed", (unsigned long long)after.missed);
    CHECK(after.start_ns == before.start_ns, "the run began anew");
    CHECK(poll(&entry, 1, 0) == 1 && (entry.revents & POLLPRI), "poll does not tell the fault");
    check_ramp_down(observer, asleep_ns);

    vm_plate_submit(fd, 2);
    vm_expect(fd, PHANTOM_CLEAR_FAULT, NULL, 0, "CLEAR_FAULT");
    vm_wait_state(page, PHANTOM_STATE_RUNNING);
    vm_status(page, &after);
    CHECK(after.faults == 0 && after.force_un[2] < 100000, "faults %#x, %d uN at once", after.faults,
          after.force_un[2]);
    vm_sleep_ns(400 * VM_NS_PER_MS);
    vm_status(page, &after);
    CHECK(llabs(after.force_un[2] - vm_plate_force(VM_CONTACT_HEIGHT_NM)) < 50, "%d uN after the ramp",
          after.force_un[2]);
    CHECK(after.missed == 0, "%llu ticks missed", (unsigned long long)after.missed);
}

VM_TEST(sleep, freezer_in_contact_ends_the_force_until_clear_fault, 30)
{
    sleeps_and_wakes("freezer");
}
VM_TEST(sleep, devices_in_contact_ends_the_force_until_clear_fault, 30)
{
    sleeps_and_wakes("devices");
}

VM_TEST(sleep, idle_sleeps_without_a_fault, 30)
{
    int fd = vm_open_feeder();
    const struct phantom_status* page = vm_map(fd);

    sleep_machine("freezer");
    CHECK(vm_state(page) == PHANTOM_STATE_IDLE, "state %u", vm_state(page));
    vm_touch(fd, page);
}

VM_TEST(sleep, no_feeder_no_trouble, 30)
{
    sleep_machine("freezer");
    close(vm_open_feeder());
}

static void set_wall_clock(int64_t seconds)
{
    struct timespec now;

    clock_gettime(CLOCK_REALTIME, &now);
    now.tv_sec += seconds;
    CHECK(clock_settime(CLOCK_REALTIME, &now) == 0, "clock_settime: %s", strerror(errno));
}

VM_TEST(sleep, wall_clock_set_by_an_hour_changes_nothing, 20)
{
    static const int64_t steps_s[] = {3600, -3600, -3600, 3600, 86400, -86400};
    int fd = vm_open_feeder();
    const struct phantom_status* page = vm_map(fd);
    struct phantom_status before, after;

    vm_set_rate(fd, 5000);
    vm_touch(fd, page);
    vm_status(page, &before);
    for (size_t i = 0; i < sizeof(steps_s) / sizeof(steps_s[0]); i++) {
        set_wall_clock(steps_s[i]);
        vm_sleep_ns(100 * VM_NS_PER_MS);
    }
    vm_status(page, &after);
    CHECK(after.missed == 0 && after.faults == 0, "%llu ticks missed, faults %#x",
          (unsigned long long)after.missed, after.faults);
    CHECK(llabs((int64_t)(after.tick - before.tick) - (int64_t)((after.time_ns - before.time_ns) / 200000)) <=
              1,
          "%llu ticks in %llu ns", (unsigned long long)(after.tick - before.tick),
          (unsigned long long)(after.time_ns - before.time_ns));
    CHECK(llabs(after.force_un[2] - vm_plate_force(VM_CONTACT_HEIGHT_NM)) < 50, "force %d uN",
          after.force_un[2]);
}
