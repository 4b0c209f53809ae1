// SPDX-License-Identifier: GPL-2.0-or-later
/*
 * Bits: strokes over a relief, in and out of the surface, with a new set every few milliseconds, with every
 * limit, ramp and fade on; first it rests, then it moves. Each becomes a recording, which the host computes
 * again with the user-mode build and compares: what happened on which tick depends on the clock; what came
 * out of it must not.
 */
#define _GNU_SOURCE
#include <fcntl.h>
#include <math.h>
#include <stdlib.h>
#include <unistd.h>

#include "device.h"
#include "harness.h"
#include "recording.h"
#include "relief.h"

#define SETS_MAX 128
#define RECORDS_MAX 8000
#define FEED_NS (12 * VM_NS_PER_MS)
#define RUN_NS (480 * VM_NS_PER_MS)
#define RAMP_MS 60

static struct relief_set sets[SETS_MAX];
static struct phantom_tick records[RECORDS_MAX];

/* A feeder, an observer that reads what it causes, and what has been submitted. */
struct hand {
    int fd, observer;
    const struct phantom_status* page;
    uint32_t sets, ticks;
};

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

static void feed(struct hand* hand, const int64_t tip_nm[3])
{
    struct relief_set* set = &sets[hand->sets];

    CHECK(hand->sets < SETS_MAX, "too many sets");
    relief_cut(set, ++hand->sets, tip_nm);
    /* each fourth feels of nothing: all of it comes and goes by fades */
    if (hand->sets % 4)
        relief_feel(set);
    /* from the ninth on the surface moves */
    if (hand->sets > 8)
        relief_move(set, vm_now_ns());
    vm_expect(hand->fd, PHANTOM_SUBMIT_SET, &set->set, 0, "SUBMIT_SET of the relief");
    recording_set(&set->set);
}

/* Moves and feeds from `begin` to `end` of the stroke. */
static void drive(struct hand* hand, uint64_t begin, uint64_t end)
{
    uint64_t zero = vm_now_ns(), fed = 0, now;

    while ((now = begin + vm_now_ns() - zero) < end) {
        int64_t tip_nm[3];

        stroke(now, tip_nm);
        vm_move(hand->fd, tip_nm[0], tip_nm[1], tip_nm[2]);
        if (!fed || now - fed >= FEED_NS) {
            feed(hand, tip_nm);
            fed = now;
        }
        vm_sleep_ns(300000);
    }
}

static void take_records(struct hand* hand)
{
    struct phantom_status status;
    ssize_t got;

    vm_status(hand->page, &status);
    got = read(hand->observer, &records[hand->ticks], sizeof(records) - hand->ticks * sizeof(records[0]));
    CHECK(got > 0, "no records");
    recording_ticks(&records[hand->ticks], (uint32_t)((size_t)got / sizeof(records[0])));
    hand->ticks += (uint32_t)((size_t)got / sizeof(records[0]));
    recording_mark(&status);
}

static void open_hand(struct hand* hand, const struct phantom_model* model, uint32_t rate_hz,
                      const char* scene)
{
    *hand = (struct hand){.fd = vm_open_feeder(), .observer = vm_open(O_RDONLY | O_NONBLOCK)};
    hand->page = vm_map(hand->fd);
    vm_set_rate(hand->fd, rate_hz);
    vm_expect(hand->fd, PHANTOM_SET_MODEL, model, 0, "SET_MODEL");
    recording_begin(hand->fd, scene);
}

static void start(struct hand* hand, const struct phantom_start* start, uint64_t stroke_ns)
{
    struct phantom_status status;
    int64_t tip_nm[3];

    stroke(stroke_ns, tip_nm);
    vm_move(hand->fd, tip_nm[0], tip_nm[1], tip_nm[2]);
    feed(hand, tip_nm);
    vm_expect(hand->fd, PHANTOM_START, start, 0, "START");
    vm_status(hand->page, &status);
    recording_started(start, &status);
}

struct counts {
    uint32_t contacts, inside, fading, ramping, slewed, faults, cleared;
};

static struct counts count_records(const struct hand* hand)
{
    struct counts counts = {0};

    for (uint32_t i = 0; i < hand->ticks; i++) {
        const struct phantom_tick* tick = &records[i];

        counts.contacts += tick->contacts > 0;
        counts.inside += (tick->flags & PHANTOM_TICK_INSIDE) != 0;
        counts.fading += (tick->flags & PHANTOM_TICK_FADING) != 0;
        counts.ramping += (tick->flags & PHANTOM_TICK_RAMPING) != 0;
        counts.slewed += (tick->flags & PHANTOM_TICK_SLEWED) != 0;
        counts.faults += tick->faults != 0;
        counts.cleared += (tick->flags & PHANTOM_TICK_CLEARED) != 0;
    }
    return counts;
}

/* One run, from START's ramp to STOP's. */
static void record_with(uint32_t arith, uint32_t model, uint32_t steps, uint32_t proxy, uint32_t rate_hz,
                        uint32_t flags)
{
    const struct phantom_model words = {.model = model,
                                        .newton_steps = steps,
                                        .combine = PHANTOM_COMBINE_BOUNDED,
                                        .proxy = proxy,
                                        .arith = arith};
    const struct phantom_start limits = {.flags = flags, .ramp_ms = RAMP_MS, .stale_ms = 1000};
    struct counts counts;
    struct hand hand;

    open_hand(&hand, &words, rate_hz, "relief, one run");
    start(&hand, &limits, 0);
    drive(&hand, 0, RUN_NS);
    vm_expect(hand.fd, PHANTOM_STOP, NULL, 0, "STOP");
    take_records(&hand);
    recording_end();

    counts = count_records(&hand);
    CHECK(hand.sets > 30, "%u sets", hand.sets);
    CHECK(hand.ticks > rate_hz / 3, "%u records", hand.ticks);
    for (uint32_t i = 0; i < hand.ticks; i++)
        CHECK(records[i].tick == i + 1 && !records[i].faults && !(records[i].flags & PHANTOM_TICK_UNCOVERED),
              "record %u is of tick %llu, flags %#x", i, (unsigned long long)records[i].tick,
              records[i].flags);
    CHECK(counts.contacts > hand.ticks / 4, "%u of %u ticks in contact", counts.contacts, hand.ticks);
    CHECK(proxy == PHANTOM_PROXY_OFF || counts.inside > hand.ticks / 10, "%u of %u ticks below the surface",
          counts.inside, hand.ticks);
    CHECK(flags || counts.ramping > RAMP_MS * rate_hz / 1000, "%u ticks on a ramp", counts.ramping);
    vm_figure("model %u steps %u proxy %u at %u Hz: %u ticks, %u in contact, %u below the surface, %u "
              "fading, %u on "
              "a ramp, %u sets",
              model, steps, proxy, rate_hz, hand.ticks, counts.contacts, counts.inside, counts.fading,
              counts.ramping, hand.sets);
}

static void record(uint32_t model, uint32_t steps, uint32_t proxy, uint32_t rate_hz, uint32_t flags)
{
    record_with(PHANTOM_ARITH_FLOAT, model, steps, proxy, rate_hz, flags);
}

VM_TEST(trace, of_the_projected_model, 60)
{
    record(PHANTOM_MODEL_PROJECTED, 2, PHANTOM_PROXY_PAPER, 3000, 0);
}
VM_TEST(trace, of_the_projected_model_without_newton_steps, 60)
{
    record(PHANTOM_MODEL_PROJECTED, 0, PHANTOM_PROXY_OFF, 1000, PHANTOM_START_LIMITS_OFF);
}
VM_TEST(trace, of_the_papers_model, 60)
{
    record(PHANTOM_MODEL_PAPER, 0, PHANTOM_PROXY_PAPER, 1000, 0);
}

VM_TEST(trace, of_the_constrained_proxy, 60)
{
    struct phantom_info info = {0};

    vm_expect(vm_open(O_RDONLY), PHANTOM_GET_INFO, &info, 0, "GET_INFO");
    if (!(info.features & PHANTOM_FEATURE_PROXY_CONSTRAINED))
        vm_skip("the module does not offer proxy=constrained");
    record(PHANTOM_MODEL_PROJECTED, 3, PHANTOM_PROXY_CONSTRAINED, 1000, 0);
}

/* In integers, of which user mode must make the same. */
VM_TEST(trace, of_fixed_point, 60)
{
    record_with(PHANTOM_ARITH_FIXED, PHANTOM_MODEL_PROJECTED, 2, PHANTOM_PROXY_CONSTRAINED, 1000, 0);
}

/* Two runs, and in the first whatever can be changed while it goes on: rate, model, a fault and its end. */
VM_TEST(trace, of_two_runs_with_changes_of_rate_and_model_and_a_fault, 60)
{
    struct phantom_model model = {.model = PHANTOM_MODEL_PROJECTED,
                                  .newton_steps = 2,
                                  .combine = PHANTOM_COMBINE_BOUNDED,
                                  .proxy = PHANTOM_PROXY_PAPER};
    const struct phantom_start limits = {.ramp_ms = RAMP_MS, .stale_ms = 1000, .slew_un_per_ms = 30000};
    struct counts counts;
    struct hand hand;

    open_hand(&hand, &model, 1000, "relief, two runs with changes");
    start(&hand, &limits, 0);
    drive(&hand, 0, 150 * VM_NS_PER_MS);
    vm_set_rate(hand.fd, 5000);
    drive(&hand, 150 * VM_NS_PER_MS, 300 * VM_NS_PER_MS);
    model.model = PHANTOM_MODEL_PAPER;
    vm_expect(hand.fd, PHANTOM_SET_MODEL, &model, 0, "SET_MODEL");
    drive(&hand, 300 * VM_NS_PER_MS, 400 * VM_NS_PER_MS);
    /* 100 mm in a tick is an overspeed, whichever way */
    vm_move(hand.fd, 0, 0, 100000000);
    vm_wait_state(hand.page, PHANTOM_STATE_FAULT);
    drive(&hand, 400 * VM_NS_PER_MS, 450 * VM_NS_PER_MS);
    vm_expect(hand.fd, PHANTOM_CLEAR_FAULT, NULL, 0, "CLEAR_FAULT");
    drive(&hand, 450 * VM_NS_PER_MS, 550 * VM_NS_PER_MS);
    vm_expect(hand.fd, PHANTOM_STOP, NULL, 0, "STOP");
    take_records(&hand);
    vm_sleep_ns(20 * VM_NS_PER_MS);
    start(&hand, &limits, 550 * VM_NS_PER_MS);
    drive(&hand, 550 * VM_NS_PER_MS, 700 * VM_NS_PER_MS);
    vm_expect(hand.fd, PHANTOM_STOP, NULL, 0, "STOP");
    take_records(&hand);
    recording_end();

    counts = count_records(&hand);
    CHECK(counts.contacts > 400 && counts.inside > 100 && counts.fading > 10 && counts.ramping > 500 &&
              counts.slewed > 10 && counts.faults > 50 && counts.cleared == 1,
          "of %u ticks %u in contact, %u inside, %u fading, %u on a ramp, %u slewed, %u with a fault, %u "
          "cleared",
          hand.ticks, counts.contacts, counts.inside, counts.fading, counts.ramping, counts.slewed,
          counts.faults, counts.cleared);
    vm_figure("%u ticks, %u in contact, %u inside, %u fading, %u on a ramp, %u slewed, %u with a fault",
              hand.ticks, counts.contacts, counts.inside, counts.fading, counts.ramping, counts.slewed,
              counts.faults);
}
