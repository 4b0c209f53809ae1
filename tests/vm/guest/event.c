// SPDX-License-Identifier: GPL-2.0-or-later
// The events phantom_rt:* of the kernel's tracer: one line for every thing that happened, with its figures.
#define _GNU_SOURCE
#include <errno.h>
#include <fcntl.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
#include <unistd.h>

#include "device.h"
#include "harness.h"
#include "module.h"

/* debugfs mounts it by itself. */
#define TRACING "/sys/kernel/debug/tracing/"

static void set_file(const char* path, const char* text)
{
    int fd = open(path, O_WRONLY | O_TRUNC | O_CLOEXEC);

    CHECK(fd >= 0, "%s: %s", path, strerror(errno));
    CHECK(write(fd, text, strlen(text)) == (ssize_t)strlen(text), "%s: %s", path, strerror(errno));
    close(fd);
}

static char* read_trace(void)
{
    static char text[4 << 20];
    size_t size = 0;
    ssize_t got;
    int fd = open(TRACING "trace", O_RDONLY | O_CLOEXEC);

    CHECK(fd >= 0, "trace: %s", strerror(errno));
    while ((got = read(fd, text + size, sizeof(text) - 1 - size)) > 0)
        size += (size_t)got;
    close(fd);
    text[size] = 0;
    return text;
}

/* The number behind `key` in the line, e.g. " tick=". */
static long long number_of(const char* line, const char* key)
{
    const char* at = strstr(line, key);

    CHECK(at && at < strchr(line, '\n'), "no '%s' in: %.300s", key, line);
    return strtoll(at + strlen(key), NULL, 10);
}

static size_t count_of(const char* text, const char* what)
{
    size_t count = 0;

    for (; (text = strstr(text, what)); text += strlen(what))
        count++;
    return count;
}

/* A run of some 400 ticks with two sets, a fault, and its end, under the tracer. */
static size_t traced_run(struct phantom_tick* records, size_t most)
{
    int fd = vm_open_feeder();
    int observer = vm_open(O_RDONLY | O_NONBLOCK);
    const struct phantom_status* page = vm_map(fd);
    ssize_t got;

    set_file(TRACING "trace", "");
    set_file(TRACING "events/phantom_rt/enable", "1");
    vm_touch(fd, page);
    vm_plate_submit(fd, 77);
    vm_sleep_ns(10 * VM_NS_PER_MS);
    vm_move(fd, 90000000, 0, 0); /* 90 mm in a tick: faster than any hand */
    vm_wait_state(page, PHANTOM_STATE_FAULT);
    vm_expect(fd, PHANTOM_STOP, NULL, 0, "STOP");
    set_file(TRACING "events/phantom_rt/enable", "0");
    got = read(observer, records, most * sizeof(records[0]));
    CHECK(got > 200 * (ssize_t)sizeof(records[0]), "%zd bytes of records", got);
    return (size_t)got / sizeof(records[0]);
}

VM_TEST(event, every_tick_set_fault_and_state_has_a_line, 30)
{
    static struct phantom_tick records[4096];
    size_t count = traced_run(records, 4096), ticks = 0;
    const char *text = read_trace(), *line = text;

    while ((line = strstr(line, " phantom_tick: "))) {
        const struct phantom_tick* record = &records[ticks++];

        CHECK(ticks <= count, "more lines than the %zu ticks", count);
        CHECK(number_of(line, " unit=") == 0, "unit: %.300s", line);
        CHECK(number_of(line, " tick=") == (long long)record->tick, "tick %llu: %.300s",
              (unsigned long long)record->tick, line);
        CHECK(number_of(line, " latency_ns=") == record->latency_ns, "latency %u: %.300s", record->latency_ns,
              line);
        CHECK(number_of(line, " duration_ns=") == record->duration_ns, "duration %u: %.300s",
              record->duration_ns, line);
        CHECK(number_of(line, " tip_nm=(") == record->tip_nm[0], "tip %lld: %.300s",
              (long long)record->tip_nm[0], line);
        CHECK(number_of(line, " force_un=(0 0 ") == record->force_un[2], "force %d: %.300s",
              record->force_un[2], line);
        CHECK(number_of(line, " set=") == (long long)record->set_id, "set %llu: %.300s",
              (unsigned long long)record->set_id, line);
        line++;
    }
    CHECK(ticks == count, "%zu lines of %zu ticks", ticks, count);
    CHECK(count_of(text, " phantom_set: ") == 2, "%zu sets", count_of(text, " phantom_set: "));
    CHECK(strstr(text, "phantom_set: unit=0 set=77 patches=32 refused=0 radius_nm=500000000"), "set 77");
    CHECK(count_of(text, " phantom_fault: ") == 1 && strstr(text, "phantom_fault: unit=0 faults=overspeed"),
          "%zu faults", count_of(text, " phantom_fault: "));
    CHECK(count_of(text, " phantom_state: ") == 3, "%zu states", count_of(text, " phantom_state: "));
    line = strstr(text, "from=IDLE to=RUNNING");
    line = line ? strstr(line, "from=RUNNING to=FAULT") : NULL;
    CHECK(line && strstr(line, "from=FAULT to=IDLE"), "states in another order");
}

VM_TEST(event, off_leaves_no_line, 20)
{
    int fd = vm_open_feeder();

    set_file(TRACING "trace", "");
    vm_touch(fd, vm_map(fd));
    vm_expect(fd, PHANTOM_STOP, NULL, 0, "STOP");
    CHECK(!strstr(read_trace(), "phantom_"), "a line although the events are off");
}

static double tick_length(bool traced)
{
    int fd = vm_open_feeder();
    const struct phantom_status* page = vm_map(fd);
    struct phantom_status before, after;

    set_file(TRACING "events/phantom_rt/enable", traced ? "1" : "0");
    vm_touch(fd, page);
    vm_status(page, &before);
    vm_wait_ticks(page, before.tick + 1000);
    vm_status(page, &after);
    set_file(TRACING "events/phantom_rt/enable", "0");
    CHECK(after.missed == 0, "%llu ticks missed", (unsigned long long)after.missed);
    munmap((void*)(uintptr_t)page, vm_status_size(fd));
    close(fd);
    return (double)(after.busy_ns - before.busy_ns) / (double)(after.tick - before.tick);
}

/* What is off may not cost: a tick under the tracer is longer, one without is as the figure says. */
VM_TEST(event, cost_of_a_tick, 30)
{
    vm_figure("tick with the events off %.0f instructions, on %.0f", tick_length(false), tick_length(true));
}
