// SPDX-License-Identifier: GPL-2.0-or-later
/*
 * 100 times load, touch, unload, and with an arm that is plugged in: what the kernel has allocated must be
 * what it was. Counted per slab cache after every cache was shrunk (which flushes what CPUs keep back), so
 * one object of any size lost in every other cycle shows. With several CPUs a cache may be off by a slab of
 * each: a CPU that has just taken one counts for all of its objects.
 */
#define _GNU_SOURCE
#include <dirent.h>
#include <fcntl.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
#include <unistd.h>

#include "device.h"
#include "harness.h"
#include "module.h"
#include "played_arm.h"

#define CYCLES 100
#define WARM_UP 10
#define HID_CYCLES 40
#define CACHES 1024

struct cache {
    char name[64];
    long active, per_slab;
};

struct memory {
    struct cache caches[CACHES];
    int count;
    long vmalloc_areas;
    long vmalloc_pages;
    long percpu_kb;
};

static void shrink_caches(void)
{
    DIR* folder = opendir("/sys/kernel/slab");
    struct dirent* entry;

    CHECK(folder, "no /sys/kernel/slab");
    while ((entry = readdir(folder))) {
        char path[400];
        int fd;

        snprintf(path, sizeof(path), "/sys/kernel/slab/%s/shrink", entry->d_name);
        fd = open(path, O_WRONLY);
        if (fd < 0)
            continue;
        CHECK(write(fd, "1", 1) == 1, "shrink %s", entry->d_name);
        close(fd);
    }
    closedir(folder);
}

static void count_caches(struct memory* memory)
{
    char line[512];
    FILE* file = fopen("/proc/slabinfo", "r");

    CHECK(file, "no /proc/slabinfo");
    while (fgets(line, sizeof(line), file)) {
        struct cache* cache = &memory->caches[memory->count];

        if (sscanf(line, "%63s %ld %*d %*d %ld", cache->name, &cache->active, &cache->per_slab) == 3 &&
            memory->count < CACHES - 1)
            memory->count++;
    }
    fclose(file);
    CHECK(memory->count > 50, "%d caches in /proc/slabinfo", memory->count);
}

static void count_vmalloc(struct memory* memory)
{
    char line[512];
    FILE* file = fopen("/proc/vmallocinfo", "r");

    CHECK(file, "no /proc/vmallocinfo");
    while (fgets(line, sizeof(line), file)) {
        const char* pages = strstr(line, "pages=");

        if (!pages)
            continue;
        memory->vmalloc_areas++;
        memory->vmalloc_pages += strtol(pages + strlen("pages="), NULL, 10);
    }
    fclose(file);
}

static void count_percpu(struct memory* memory)
{
    char text[8192];
    const char* at;

    vm_read_file("/proc/meminfo", text, sizeof(text));
    at = strstr(text, "Percpu:");
    CHECK(at, "no Percpu in /proc/meminfo");
    memory->percpu_kb = strtol(at + strlen("Percpu:"), NULL, 10);
}

static void count_memory(struct memory* memory)
{
    memset(memory, 0, sizeof(*memory));
    sync();
    vm_sleep_ns(500 * VM_NS_PER_MS); /* what RCU and the work queues still hold */
    shrink_caches();
    vm_sleep_ns(100 * VM_NS_PER_MS);
    shrink_caches();
    count_caches(memory);
    count_vmalloc(memory);
    count_percpu(memory);
}

static void cycle(int number)
{
    const struct phantom_start start = {.ramp_ms = 1, .stale_ms = 60000};
    const struct phantom_status* page;
    int fd, rc;

    rc = vm_module_load(number % 2 ? "rate_hz=10000" : "");
    CHECK(rc == 0, "insmod in cycle %d: %s", number, vm_error_name(rc));
    fd = vm_open(O_RDWR);
    page = vm_map(fd);
    vm_move(fd, 2000000, 3000000, VM_CONTACT_HEIGHT_NM);
    vm_plate_submit(fd, 1);
    vm_expect(fd, PHANTOM_START, &start, 0, "START");
    vm_wait_ticks(page, 10);
    vm_plate_submit(fd, 2);
    CHECK(munmap((void*)(uintptr_t)page, vm_status_size(fd)) == 0, "munmap");
    CHECK(close(fd) == 0, "close");
    rc = vm_module_unload();
    CHECK(rc == 0, "rmmod in cycle %d: %s", number, vm_error_name(rc));
}

static long active_in(const struct memory* memory, const char* name)
{
    for (int i = 0; i < memory->count; i++)
        if (strcmp(memory->caches[i].name, name) == 0)
            return memory->caches[i].active;
    return 0;
}

static void compare(const struct memory* before, const struct memory* after, int cycles)
{
    const long cpus = sysconf(_SC_NPROCESSORS_ONLN);

    for (int i = 0; i < after->count; i++) {
        long grown = after->caches[i].active - active_in(before, after->caches[i].name);

        CHECK(grown < cycles / 2 + (cpus > 1 ? cpus * after->caches[i].per_slab : 0),
              "cache %s holds %ld objects more after %d cycles", after->caches[i].name, grown, cycles);
    }
    /* Each CPU keeps up to two thread stacks for later: a few areas come and go. */
    CHECK(after->vmalloc_areas - before->vmalloc_areas < cycles / 2,
          "vmalloc: %ld areas of %ld pages, were %ld of %ld", after->vmalloc_areas, after->vmalloc_pages,
          before->vmalloc_areas, before->vmalloc_pages);
    CHECK(after->vmalloc_pages - before->vmalloc_pages < cycles, "vmalloc: %ld pages, were %ld",
          after->vmalloc_pages, before->vmalloc_pages);
    CHECK(after->percpu_kb <= before->percpu_kb, "per-CPU memory: %ld kB, was %ld", after->percpu_kb,
          before->percpu_kb);
}

VM_TEST(cycle, a_hundred_loads_leave_nothing_behind, 120)
{
    static struct memory before, after;

    for (int i = 0; i < WARM_UP; i++)
        cycle(i);
    count_memory(&before);
    for (int i = 0; i < CYCLES; i++)
        cycle(i);
    count_memory(&after);
    compare(&before, &after, CYCLES);
}

/* The arm stays plugged in while the module comes and goes, or is unplugged while it runs. */
static void hid_cycle(struct vm_arm* arm, int number)
{
    const struct phantom_start start = {.ramp_ms = 1, .stale_ms = 60000};
    int fd, rc;

    rc = vm_module_load("device=hid");
    CHECK(rc == 0, "insmod in cycle %d: %s", number, vm_error_name(rc));
    for (int ms = 0; access(PHANTOM_DEVICE_NODE, F_OK) < 0; ms++) {
        CHECK(ms < 1000, "no node in cycle %d", number);
        vm_sleep_ns(VM_NS_PER_MS);
    }
    fd = vm_open(O_RDWR);
    vm_plate_submit(fd, 1);
    vm_expect(fd, PHANTOM_START, &start, 0, "START");
    vm_sleep_ns(5 * VM_NS_PER_MS);
    if (number % 2) {
        vm_arm_unplug(arm);
        memset(arm, 0, sizeof(*arm));
        vm_arm_plug(arm);
    }
    CHECK(close(fd) == 0, "close");
    rc = vm_module_unload();
    CHECK(rc == 0, "rmmod in cycle %d: %s", number, vm_error_name(rc));
}

VM_TEST(cycle, loads_with_an_arm_that_comes_and_goes_leave_nothing_behind, 120)
{
    static struct memory before, after;
    struct vm_arm arm = {0};

    if (access("/dev/uhid", F_OK) < 0)
        vm_skip("no /dev/uhid");
    vm_arm_plug(&arm);
    for (int i = 0; i < WARM_UP; i++)
        hid_cycle(&arm, i);
    count_memory(&before);
    for (int i = 0; i < HID_CYCLES; i++)
        hid_cycle(&arm, i);
    count_memory(&after);
    compare(&before, &after, HID_CYCLES);
    vm_arm_unplug(&arm);
}
