// SPDX-License-Identifier: GPL-2.0-or-later
// Recordings to the host.
#define _GNU_SOURCE
#include <errno.h>
#include <fcntl.h>
#include <stdio.h>
#include <string.h>
#include <sys/io.h>
#include <unistd.h>

#include "device.h"
#include "harness.h"
#include "recording.h"

/* Where QEMU's second isa-debugcon listens. */
#define RECORDING_PORT 0xea

struct part {
    const void* data;
    size_t size;
};

static struct recording_end written;

static void put(const void* data, size_t size)
{
    outsb(RECORDING_PORT, data, size);
}

static void put_chunk(uint32_t kind, const struct part* parts, int count)
{
    struct recording_chunk chunk = {.kind = kind};

    for (int i = 0; i < count; i++)
        chunk.size += (uint32_t)parts[i].size;
    chunk.checksum = recording_checksum(0, &chunk, offsetof(struct recording_chunk, checksum));
    for (int i = 0; i < count; i++)
        chunk.checksum = recording_checksum(chunk.checksum, parts[i].data, parts[i].size);
    put(&chunk, sizeof(chunk));
    for (int i = 0; i < count; i++)
        put(parts[i].data, parts[i].size);
}

static void put_one(uint32_t kind, const void* data, size_t size)
{
    const struct part part = {data, size};

    put_chunk(kind, &part, 1);
}

static void open_port(void)
{
    CHECK(ioperm(RECORDING_PORT, 1, 1) == 0, "ioperm: %s", strerror(errno));
}

void recording_begin(int fd, const char* scene)
{
    const struct recording_header header = {RECORDING_MAGIC, RECORDING_VERSION, 0};
    struct recording_origin origin = {.flags = RECORDING_FED, .device = PHANTOM_DEVICE_NODE};
    struct phantom_status status;

    open_port();
    vm_expect(fd, PHANTOM_GET_INFO, &origin.info, 0, "GET_INFO");
    vm_status(vm_map(fd), &status);
    origin.isa = status.isa;
    snprintf(origin.scene, sizeof(origin.scene), "%s", scene);
    memset(&written, 0, sizeof(written));
    put(&header, sizeof(header));
    put_one(RECORDING_ORIGIN, &origin, sizeof(origin));
}

void recording_started(const struct phantom_start* start, const struct phantom_status* status)
{
    const struct recording_start chunk = {status->start_ns, *start};

    put_one(RECORDING_START, &chunk, sizeof(chunk));
}

void recording_set(const struct phantom_set* set)
{
    const struct part parts[] = {
        {set, sizeof(*set)},
        {(const void*)(uintptr_t)set->patches, set->patch_count * sizeof(struct phantom_patch)},
        /* the effects' tables lie behind the materials */
        {(const void*)(uintptr_t)set->materials,
         set->material_count * sizeof(struct phantom_material) + set->effect_bytes},
        {(const void*)(uintptr_t)set->objects, set->object_count * sizeof(struct phantom_object)},
    };

    put_chunk(RECORDING_SET, parts, 4);
    written.sets++;
}

void recording_ticks(const struct phantom_tick* ticks, uint32_t count)
{
    put_one(RECORDING_TICKS, ticks, count * sizeof(*ticks));
    written.ticks += count;
}

void recording_mark(const struct phantom_status* status)
{
    const struct recording_mark mark = {status->start_ns, status->tick, status->missed};

    put_one(RECORDING_MARK, &mark, sizeof(mark));
}

void recording_end(void)
{
    put_one(RECORDING_END, &written, sizeof(written));
}

void recording_hand_out(const char* file)
{
    static char buffer[1 << 16];
    int fd = open(file, O_RDONLY);
    ssize_t got;

    CHECK(fd >= 0, "%s: %s", file, strerror(errno));
    open_port();
    while ((got = read(fd, buffer, sizeof(buffer))) > 0)
        put(buffer, (size_t)got);
    close(fd);
}
