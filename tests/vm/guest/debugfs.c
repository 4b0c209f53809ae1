// SPDX-License-Identifier: GPL-2.0-or-later
// /sys/kernel/debug/phantom_rt: what a person reads there is what the status page says.
#define _GNU_SOURCE
#include <errno.h>
#include <fcntl.h>
#include <pthread.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "device.h"
#include "harness.h"
#include "module.h"

#define FOLDER "/sys/kernel/debug/phantom_rt/phantom_rt0/"

static const char* read_text(const char* path)
{
    static __thread char text[1 << 16];

    vm_read_file(path, text, sizeof(text));
    CHECK(text[0], "%s is empty", path);
    return text;
}

/* The line that begins with `name`, without it. */
static const char* line_of(const char* text, const char* name)
{
    const char* at = strstr(text, name);

    CHECK(at && (at == text || at[-1] == '\n'), "no line '%s' in:\n%.2000s", name, text);
    return at + strlen(name) + strspn(at + strlen(name), " ");
}

VM_TEST(debugfs, status_in_idle_running_and_fault, 20)
{
    int fd = vm_open_feeder();
    const struct phantom_status* page = vm_map(fd);
    struct phantom_status status;
    const char* text = read_text(FOLDER "status");

    CHECK(strncmp(line_of(text, "state"), "IDLE\n", 5) == 0, "%s", text);
    vm_set_rate(fd, 3000);
    vm_touch(fd, page);
    text = read_text(FOLDER "status");
    vm_status(page, &status);
    CHECK(strncmp(line_of(text, "state"), "RUNNING\n", 8) == 0, "%s", text);
    CHECK(strncmp(line_of(text, "faults"), "none\n", 5) == 0, "%s", text);
    CHECK(strtoul(line_of(text, "rate"), NULL, 10) == 3000, "%s", text);
    CHECK(strncmp(line_of(text, "model"), "projected, 2 steps, combine bounded, proxy paper, float, ", 57) ==
              0,
          "%s", text);
    CHECK(strtoull(line_of(text, "ticks"), NULL, 10) <= status.tick, "%s", text);
    CHECK(strtoull(line_of(text, "ticks"), NULL, 10) + 100 > status.tick, "%s", text);
    CHECK(strstr(line_of(text, "ticks"), ", 0 missed, idle 9"), "%s", text);
    CHECK(strtoll(line_of(text, "tip"), NULL, 10) == 2000000, "%s", text);
    CHECK(strstr(line_of(text, "force"), " uN, 1 contacts"), "%s", text);
    vm_move(fd, 90000000, 0, 0);
    vm_wait_state(page, PHANTOM_STATE_FAULT);
    text = read_text(FOLDER "status");
    CHECK(strncmp(line_of(text, "state"), "FAULT\n", 6) == 0, "%s", text);
    CHECK(strncmp(line_of(text, "faults"), "overspeed", 9) == 0, "%s", text);
}

VM_TEST(debugfs, histograms_count_every_tick, 20)
{
    static const char* const names[] = {"latency:", "duration:", "section:"};
    int fd = vm_open_feeder();
    const struct phantom_status* page = vm_map(fd);
    struct phantom_status status;
    const char* text;

    vm_touch(fd, page);
    vm_expect(fd, PHANTOM_STOP, NULL, 0, "STOP");
    vm_status(page, &status);
    text = read_text(FOLDER "histograms");
    for (int i = 0; i < 3; i++) {
        unsigned long long total, from, count, sum = 0, last = 0, median;
        const char* line = line_of(text, names[i]);

        CHECK(sscanf(line, "%llu, median < %llu ns", &total, &median) == 2, "%.100s", line);
        line = strchr(line, '\n') + 1;
        for (; sscanf(line, " %llu ns %llu", &from, &count) == 2; line = strchr(line, '\n') + 1) {
            CHECK(count && (from > last || !sum), "%.100s", line);
            /* the median lies in the bucket in which half of all is reached */
            if (sum < (total + 1) / 2)
                CHECK(median > from, "%s median %llu, bucket %llu", names[i], median, from);
            else
                CHECK(median <= from, "%s median %llu, bucket %llu", names[i], median, from);
            last = from;
            sum += count;
        }
        CHECK(sum == total, "%s buckets sum to %llu of %llu", names[i], sum, total);
        CHECK(i == 2 ? total == status.sections : total == status.tick - status.missed,
              "%s %llu of %llu ticks", names[i], total, (unsigned long long)status.tick);
    }
}

VM_TEST(debugfs, set_and_memory, 20)
{
    int fd = vm_open_feeder();
    const char* text = read_text(FOLDER "set");

    CHECK(strncmp(line_of(text, "set "), "none\n", 5) == 0, "%s", text);
    vm_touch(fd, vm_map(fd));
    text = read_text(FOLDER "set");
    CHECK(strncmp(line_of(text, "set "), "1, 32 patches\n", 14) == 0, "%s", text);
    CHECK(strtoull(line_of(text, "sets"), NULL, 10) > 100000, "%s", text);
    vm_figure("memory of a unit: sets %llu bytes, ring %llu, page %llu, servo %llu",
              strtoull(line_of(text, "sets"), NULL, 10), strtoull(line_of(text, "ring"), NULL, 10),
              strtoull(line_of(text, "page"), NULL, 10), strtoull(line_of(text, "servo"), NULL, 10));
}

static void* read_all(void* argument)
{
    uint64_t end = *(uint64_t*)argument;

    while (vm_now_ns() < end) {
        line_of(read_text(FOLDER "status"), "state");
        line_of(read_text(FOLDER "histograms"), "latency:");
        line_of(read_text(FOLDER "set"), "set ");
    }
    return NULL;
}

VM_TEST(debugfs, readers_cost_no_tick, 20)
{
    int fd = vm_open_feeder();
    const struct phantom_status* page = vm_map(fd);
    struct phantom_status status;
    pthread_t threads[3];
    uint64_t end;

    vm_set_rate(fd, 10000);
    vm_touch(fd, page);
    end = vm_now_ns() + VM_NS_PER_S / 2;
    for (int i = 0; i < 3; i++)
        CHECK(pthread_create(&threads[i], NULL, read_all, &end) == 0, "pthread_create");
    for (int i = 0; i < 3; i++)
        pthread_join(threads[i], NULL);
    vm_status(page, &status);
    CHECK(status.missed == 0 && status.faults == 0, "%llu ticks missed, faults %#x",
          (unsigned long long)status.missed, status.faults);
}

VM_TEST(debugfs, open_file_keeps_the_module, 10)
{
    int fd = open(FOLDER "status", O_RDONLY | O_CLOEXEC);
    int rc;

    CHECK(fd >= 0, "open: %s", strerror(errno));
    rc = vm_module_unload();
    CHECK(rc == -EWOULDBLOCK || rc == -EBUSY, "rmmod gave %s", vm_error_name(rc));
    close(fd);
}
