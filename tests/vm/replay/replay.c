// SPDX-License-Identifier: GPL-2.0-or-later
/*
 * replay TRACE: computes every tick of a guest's trace (../trace_file.h) again, with the user-mode build
 * on its virtual clock and every instruction set that this CPU has, and compares bit for bit.
 *
 * Compared are force, proxy, contacts, set and flags. Left out are forces while a fade runs: a fade is a
 * function of time, which is not part of the trace; what it fades to is compared all the same, as contacts.
 *
 * One line per run, `ok replay...` or `not ok replay...: why`; exit status 0 when all are ok.
 */
#include <errno.h>
#include <fcntl.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "../trace_file.h"
#include "phantom_usermode.h"

#define COMPARED_FLAGS                                                                                       \
    (PHANTOM_TICK_INSIDE | PHANTOM_TICK_UNCOVERED | PHANTOM_TICK_STALE | PHANTOM_TICK_CLAMPED |              \
     PHANTOM_TICK_SATURATED)

struct run {
    const struct trace_run* header;
    struct phantom_set** sets; /* copies whose pointers lead into the trace */
    const struct phantom_tick* records;
};

struct machine {
    struct phantom_um* um;
    struct phantom_um_file* file;
};

static const char* isa_name(unsigned int isa)
{
    return isa == PHANTOM_ISA_SSE2 ? "sse2" : isa == PHANTOM_ISA_AVX2 ? "avx2" : "?";
}

static void die(const char* what)
{
    printf("not ok replay: %s\n", what);
    exit(1);
}

/* ---- the trace ---- */

struct reader {
    const char* at;
    const char* end;
};

static const void* take(struct reader* reader, size_t size)
{
    const char* at = reader->at;

    if (size > (size_t)(reader->end - at))
        die("the trace is cut short");
    reader->at += size;
    return at;
}

static void read_run(struct reader* reader, struct run* run)
{
    run->header = take(reader, sizeof(*run->header));
    if (run->header->magic != TRACE_MAGIC)
        die("no trace: wrong magic");
    run->sets = calloc(run->header->set_count + 1, sizeof(struct phantom_set*));
    for (unsigned int i = 0; i < run->header->set_count; i++) {
        struct phantom_set* set = malloc(sizeof(*set));

        memcpy(set, take(reader, sizeof(*set)), sizeof(*set));
        set->patches = (uintptr_t)take(reader, set->patch_count * sizeof(struct phantom_patch));
        set->materials = (uintptr_t)take(reader, set->material_count * sizeof(struct phantom_material));
        set->objects = (uintptr_t)take(reader, set->object_count * sizeof(struct phantom_object));
        run->sets[i] = set;
    }
    run->records = take(reader, run->header->record_count * sizeof(struct phantom_tick));
}

static void forget_run(struct run* run)
{
    for (unsigned int i = 0; i < run->header->set_count; i++)
        free(run->sets[i]);
    free(run->sets);
}

static char* read_file(const char* path, size_t* size)
{
    FILE* file = fopen(path, "rb");
    char* data;
    long length;

    if (!file || fseek(file, 0, SEEK_END) || (length = ftell(file)) < 0 || fseek(file, 0, SEEK_SET))
        die("cannot read the trace");
    /* malloc aligns for every structure in it: all their sizes are multiples of 8 */
    data = malloc((size_t)length + 1);
    if (fread(data, 1, (size_t)length, file) != (size_t)length)
        die("cannot read the trace");
    fclose(file);
    *size = (size_t)length;
    return data;
}

/* ---- the machine ---- */

static void must(int rc, const char* what)
{
    if (rc < 0) {
        printf("not ok replay: %s: %s\n", what, strerror(-rc));
        exit(1);
    }
}

/* False: this CPU has not that instruction set. */
static int open_machine(struct machine* machine, const struct trace_run* header, unsigned int isa)
{
    const struct phantom_um_config config = {
        .clock = PHANTOM_UM_CLOCK_VIRTUAL, .rate_hz = header->rate_hz, .cpu = -1, .isa = isa};
    struct phantom_rate rate = {.rate_hz = header->rate_hz};
    struct phantom_model model = header->model;
    int error = 0;

    machine->um = phantom_um_create(&config, &error);
    if (!machine->um)
        return 0;
    machine->file = phantom_um_open(machine->um, O_RDWR | O_NONBLOCK, &error);
    if (!machine->file)
        must(error, "open");
    must(phantom_um_ioctl(machine->file, PHANTOM_SET_RATE, &rate), "SET_RATE");
    must(phantom_um_ioctl(machine->file, PHANTOM_SET_MODEL, &model), "SET_MODEL");
    return 1;
}

static void close_machine(struct machine* machine)
{
    phantom_um_close(machine->file);
    phantom_um_destroy(machine->um);
}

/* Makes the machine do what the guest's did on that tick. */
static void compute(struct machine* machine, const struct run* run, unsigned int at,
                    struct phantom_tick* again)
{
    const struct phantom_tick* tick = &run->records[at];
    struct phantom_sim_move move = {.tip_nm = {tick->tip_nm[0], tick->tip_nm[1], tick->tip_nm[2]}};
    struct phantom_start start = {.flags = PHANTOM_START_LIMITS_OFF, .stale_ms = 3600000};

    if (tick->set_id && (at == 0 || run->records[at - 1].set_id != tick->set_id)) {
        if (tick->set_id > run->header->set_count)
            die("a record names a set that the trace has not");
        must(phantom_um_ioctl(machine->file, PHANTOM_SUBMIT_SET, run->sets[tick->set_id - 1]), "SUBMIT_SET");
    }
    must(phantom_um_ioctl(machine->file, PHANTOM_SIM_MOVE, &move), "SIM_MOVE");
    if (at == 0)
        must(phantom_um_ioctl(machine->file, PHANTOM_START, &start), "START");
    must(phantom_um_step(machine->um, 1), "step");
    if (phantom_um_read(machine->file, again, sizeof(*again)) != sizeof(*again))
        die("no record of a tick");
}

static int same(const struct phantom_tick* one, const struct phantom_tick* two)
{
    int fading = (one->flags | two->flags) & PHANTOM_TICK_FADING;

    return one->set_id == two->set_id && one->contacts == two->contacts &&
           (one->flags & COMPARED_FLAGS) == (two->flags & COMPARED_FLAGS) &&
           memcmp(one->proxy_nm, two->proxy_nm, sizeof(one->proxy_nm)) == 0 &&
           (fading || memcmp(one->force_un, two->force_un, sizeof(one->force_un)) == 0);
}

static void print_tick(const char* who, const struct phantom_tick* tick)
{
    printf("  %s: tick %llu set %llu force %d %d %d proxy %lld %lld %lld contacts %u flags %#x\n", who,
           (unsigned long long)tick->tick, (unsigned long long)tick->set_id, tick->force_un[0],
           tick->force_un[1], tick->force_un[2], (long long)tick->proxy_nm[0], (long long)tick->proxy_nm[1],
           (long long)tick->proxy_nm[2], tick->contacts, tick->flags);
}

/* 0: all bits are the same. */
static int replay(const struct run* run, unsigned int isa)
{
    const struct trace_run* header = run->header;
    unsigned int different = 0, fading = 0;
    struct machine machine;
    char name[160];

    snprintf(name, sizeof(name), "replay of model %u, %u steps, proxy %u at %u Hz: kernel %s, user mode %s",
             header->model.model, header->model.newton_steps, header->model.proxy, header->rate_hz,
             isa_name(header->isa), isa_name(isa));
    if (!open_machine(&machine, header, isa)) {
        printf("skipped %s: not on this CPU\n", name);
        return 0;
    }
    for (unsigned int i = 0; i < header->record_count; i++) {
        struct phantom_tick again;

        compute(&machine, run, i, &again);
        fading += (again.flags & PHANTOM_TICK_FADING) != 0;
        if (same(&run->records[i], &again) || different++ >= 3)
            continue;
        print_tick("kernel", &run->records[i]);
        print_tick("user mode", &again);
    }
    close_machine(&machine);
    if (different || fading > header->record_count / 10)
        printf("not ok %s: %u of %u ticks differ, %u in a fade\n", name, different, header->record_count,
               fading);
    else
        printf("ok %s: %u ticks, bit for bit\n", name, header->record_count);
    return different || fading > header->record_count / 10;
}

int main(int argc, char** argv)
{
    struct reader reader;
    size_t size;
    char* data;
    int failed = 0;

    if (argc != 2) {
        fprintf(stderr, "usage: replay TRACE\n");
        return 2;
    }
    data = read_file(argv[1], &size);
    reader = (struct reader){data, data + size};
    if (size == 0)
        die("the trace is empty");
    while (reader.at < reader.end) {
        struct run run;

        read_run(&reader, &run);
        failed |= replay(&run, PHANTOM_ISA_SSE2);
        failed |= replay(&run, PHANTOM_ISA_AVX2);
        forget_run(&run);
    }
    free(data);
    return failed;
}
