// SPDX-License-Identifier: GPL-2.0-or-later
/*
 * Bits: strokes over a relief, in and out of the surface, with a new set every few milliseconds. Sets and
 * tick records go to the host, where replay/ computes every tick again with the user-mode build and
 * compares. What happened on which tick depends on the clock; what came out of it must not.
 */
#define _GNU_SOURCE
#include <fcntl.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <sys/io.h>
#include <unistd.h>

#include "../trace_file.h"
#include "device.h"
#include "harness.h"
#include "relief.h"

#define SETS_MAX 64
#define RECORDS_MAX 4096
#define FEED_NS (12 * VM_NS_PER_MS)
#define RUN_NS (480 * VM_NS_PER_MS)

static struct relief_set sets[SETS_MAX];
static struct phantom_tick records[RECORDS_MAX];

static void hand_out(const void* data, size_t size)
{
    outsb(TRACE_PORT, data, size);
}

static void hand_out_run(const struct trace_run* run)
{
    CHECK(ioperm(TRACE_PORT, 1, 1) == 0, "ioperm");
    hand_out(run, sizeof(*run));
    for (uint32_t i = 0; i < run->set_count; i++) {
        hand_out(&sets[i].set, sizeof(sets[i].set));
        hand_out(sets[i].patches, sizeof(sets[i].patches));
        hand_out(&sets[i].material, sizeof(sets[i].material));
        hand_out(&sets[i].object, sizeof(sets[i].object));
    }
    hand_out(records, run->record_count * sizeof(records[0]));
}

/* Where the hand is: a loop of 60 mm/s or so over the bumps, from 1.3 mm above to 1.6 mm below them. */
static void stroke(uint64_t time_ns, int64_t tip_nm[3])
{
    double s = (double)time_ns * 1e-9;
    double x = 15e6 * sin(2 * M_PI * 0.61 * s + 0.3);
    double y = 14e6 * sin(2 * M_PI * 0.83 * s + 1.1);

    tip_nm[0] = llrint(x);
    tip_nm[1] = llrint(y);
    tip_nm[2] = llrint(relief_height_nm(x, y) - 0.15e6 + 1.45e6 * cos(2 * M_PI * 5.3 * s));
}

/* Moves and feeds for RUN_NS; the number of sets. */
static uint32_t drive(int fd)
{
    uint64_t begin = vm_now_ns(), fed = 0, now;
    uint32_t count = 0;

    while ((now = vm_now_ns() - begin) < RUN_NS) {
        int64_t tip_nm[3];

        stroke(now, tip_nm);
        vm_move(fd, tip_nm[0], tip_nm[1], tip_nm[2]);
        if (!count || now - fed >= FEED_NS) {
            CHECK(count < SETS_MAX, "too many sets");
            relief_cut(&sets[count], count + 1, tip_nm);
            vm_expect(fd, PHANTOM_SUBMIT_SET, &sets[count].set, 0, "SUBMIT_SET of the relief");
            count++;
            fed = now;
        }
        if (count == 1 && fed == now) {
            /* without limits: what leaves the tick is what contact gave */
            const struct phantom_start start = {.flags = PHANTOM_START_LIMITS_OFF, .stale_ms = 60000};

            vm_expect(fd, PHANTOM_START, &start, 0, "START");
        }
        vm_sleep_ns(300000);
    }
    return count;
}

static void check_run(const struct trace_run* run)
{
    uint32_t contacts = 0, inside = 0;

    CHECK(run->set_count > 30, "%u sets", run->set_count);
    CHECK(run->record_count > run->rate_hz / 3, "%u records", run->record_count);
    for (uint32_t i = 0; i < run->record_count; i++) {
        CHECK(records[i].tick == records[0].tick + i, "record %u is of tick %llu", i,
              (unsigned long long)records[i].tick);
        CHECK(records[i].faults == 0 && !(records[i].flags & PHANTOM_TICK_UNCOVERED), "tick %u: flags %#x",
              i + 1, records[i].flags);
        contacts += records[i].contacts > 0;
        inside += (records[i].flags & PHANTOM_TICK_INSIDE) != 0;
    }
    CHECK(contacts > run->record_count / 4, "%u of %u ticks in contact", contacts, run->record_count);
    CHECK(run->model.proxy == PHANTOM_PROXY_OFF || inside > run->record_count / 10,
          "%u of %u ticks below the surface", inside, run->record_count);
    vm_figure("model %u steps %u proxy %u at %u Hz: %u ticks, %u in contact, %u below the surface, %u sets",
              run->model.model, run->model.newton_steps, run->model.proxy, run->rate_hz, run->record_count,
              contacts, inside, run->set_count);
}

static void record(uint32_t model, uint32_t steps, uint32_t proxy, uint32_t rate_hz)
{
    struct trace_run run = {.magic = TRACE_MAGIC, .rate_hz = rate_hz};
    int fd = vm_open_feeder();
    int observer = vm_open(O_RDONLY | O_NONBLOCK);
    struct phantom_status status;
    ssize_t got;

    run.model = (struct phantom_model){
        .model = model,
        .newton_steps = steps,
        .combine = PHANTOM_COMBINE_BOUNDED,
        .proxy = proxy,
        .arith = PHANTOM_ARITH_FLOAT,
    };
    vm_set_rate(fd, rate_hz);
    vm_expect(fd, PHANTOM_SET_MODEL, &run.model, 0, "SET_MODEL");
    run.set_count = drive(fd);
    got = read(observer, records, sizeof(records));
    CHECK(got > 0, "no records");
    run.record_count = (uint32_t)((size_t)got / sizeof(records[0]));
    vm_status(vm_map(fd), &status);
    run.isa = status.isa;
    check_run(&run);
    hand_out_run(&run);
}

VM_TEST(trace, of_the_projected_model, 60)
{
    record(PHANTOM_MODEL_PROJECTED, 2, PHANTOM_PROXY_PAPER, 3000);
}
VM_TEST(trace, of_the_projected_model_without_newton_steps, 60)
{
    record(PHANTOM_MODEL_PROJECTED, 0, PHANTOM_PROXY_OFF, 1000);
}
VM_TEST(trace, of_the_papers_model, 60)
{
    record(PHANTOM_MODEL_PAPER, 0, PHANTOM_PROXY_PAPER, 1000);
}

VM_TEST(trace, of_the_constrained_proxy, 60)
{
    struct phantom_info info = {0};

    vm_expect(vm_open(O_RDONLY), PHANTOM_GET_INFO, &info, 0, "GET_INFO");
    if (!(info.features & PHANTOM_FEATURE_PROXY_CONSTRAINED))
        vm_skip("the module does not offer proxy=constrained");
    record(PHANTOM_MODEL_PROJECTED, 3, PHANTOM_PROXY_CONSTRAINED, 1000);
}
