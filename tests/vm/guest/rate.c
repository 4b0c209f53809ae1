// SPDX-License-Identifier: GPL-2.0-or-later
// SET_RATE, and the ticks that a rate promises.
#include <errno.h>
#include <fcntl.h>
#include <pthread.h>
#include <stdlib.h>

#include "device.h"
#include "harness.h"

VM_TEST(rate, outside_the_limits_is_refused, 10)
{
    static const uint32_t wrong[] = {0, 1, 999, 10001, 20000, 0x7fffffff, 0x80000000, 0xffffffff};
    static const uint32_t right[] = {1000, 1001, 2999, 3000, 9999, 10000};
    int fd = vm_open_feeder();
    const struct phantom_status* page = vm_map(fd);

    for (size_t i = 0; i < sizeof(wrong) / sizeof(wrong[0]); i++) {
        const struct phantom_rate rate = {.rate_hz = wrong[i]};

        CHECK(vm_ioctl(fd, PHANTOM_SET_RATE, &rate) == -EINVAL, "%u Hz was not refused", wrong[i]);
    }
    for (size_t i = 0; i < sizeof(right) / sizeof(right[0]); i++) {
        struct phantom_status status;

        vm_set_rate(fd, right[i]);
        vm_status(page, &status);
        CHECK(status.rate_hz == right[i], "the page says %u Hz after SET_RATE %u", status.rate_hz, right[i]);
    }
}

VM_TEST(rate, reserved_bits_are_refused, 10)
{
    int fd = vm_open_feeder();

    for (int bit = 0; bit < 32; bit++) {
        const struct phantom_rate rate = {.rate_hz = 1000, .reserved = 1u << bit};

        vm_expect(fd, PHANTOM_SET_RATE, &rate, -EINVAL, "SET_RATE with a reserved bit");
    }
}

/* The feeder's loop beside the ticks, as in life: a plate every 5 ms. */
static void feed_for(int fd, uint64_t duration_ns)
{
    uint64_t end = vm_now_ns() + duration_ns;

    for (uint64_t id = 2; vm_now_ns() < end; id++) {
        struct vm_plate plate;
        int rc;

        vm_plate_make(&plate, id);
        rc = vm_ioctl(fd, PHANTOM_SUBMIT_SET, &plate.set);
        CHECK(rc == 0 || rc == -EAGAIN, "SUBMIT_SET gave %s", vm_error_name(rc));
        vm_sleep_ns(5 * VM_NS_PER_MS);
    }
}

static uint64_t histogram_sum(const struct phantom_histogram* histogram)
{
    uint64_t sum = 0;

    for (int i = 0; i < PHANTOM_HISTOGRAM_BUCKETS; i++)
        sum += histogram->count[i];
    return sum;
}

static void every_tick_comes(uint32_t rate_hz)
{
    const uint64_t seconds = 10;
    int fd = vm_open_feeder();
    const struct phantom_status* page = vm_map(fd);
    struct phantom_status before, after;
    uint64_t due, came;

    vm_set_rate(fd, rate_hz);
    vm_touch(fd, page);
    vm_status(page, &before);
    feed_for(fd, seconds * VM_NS_PER_S);
    vm_status(page, &after);
    came = after.tick - before.tick;
    due = (after.time_ns - before.time_ns) * rate_hz / VM_NS_PER_S;
    CHECK(after.faults == 0, "faults %#x", after.faults);
    CHECK(after.missed == 0, "%llu of %llu ticks missed", (unsigned long long)after.missed,
          (unsigned long long)came);
    CHECK(came >= seconds * rate_hz - 2, "%llu ticks in 10 s at %u Hz", (unsigned long long)came, rate_hz);
    CHECK(came + 2 >= due && came <= due + 2, "%llu ticks, by the clock %llu", (unsigned long long)came,
          (unsigned long long)due);
    CHECK(llabs(after.force_un[2] - vm_plate_force(VM_CONTACT_HEIGHT_NM)) < 50, "force %d uN",
          after.force_un[2]);
    CHECK(after.sets > seconds * 100, "only %llu sets taken", (unsigned long long)after.sets);
    CHECK(histogram_sum(&page->duration) >= came, "histogram of durations counts %llu of %llu",
          (unsigned long long)histogram_sum(&page->duration), (unsigned long long)came);
    /* Under -icount a nanosecond is one instruction: path lengths, not time. */
    vm_figure("%u Hz: %llu ticks, 0 missed, tick %llu instructions (longest %u), wake-up at most %u, "
              "section at most %u",
              rate_hz, (unsigned long long)came, (unsigned long long)(after.busy_ns / after.tick),
              page->duration.max_ns, page->latency.max_ns, after.section_max_ns);
}

VM_TEST(rate, every_tick_comes_for_10_s_at_1_khz, 30)
{
    every_tick_comes(1000);
}
VM_TEST(rate, every_tick_comes_for_10_s_at_3_khz, 30)
{
    every_tick_comes(3000);
}
VM_TEST(rate, every_tick_comes_for_10_s_at_5_khz, 30)
{
    every_tick_comes(5000);
}
VM_TEST(rate, every_tick_comes_for_10_s_at_10_khz, 30)
{
    every_tick_comes(10000);
}

/* Making the thread is START's business, not the ticks'. */
VM_TEST(rate, start_misses_no_tick, 60)
{
    const struct phantom_start start = {.ramp_ms = 1, .stale_ms = 60000};
    int fd = vm_open_feeder();
    const struct phantom_status* page = vm_map(fd);
    struct phantom_status status;
    uint64_t missed = 0;
    int starts = 0;

    vm_set_rate(fd, 10000);
    for (int i = 0; i < 200; i++) {
        vm_expect(fd, PHANTOM_START, &start, 0, "START");
        vm_wait_ticks(page, 10);
        vm_status(page, &status);
        missed += status.missed;
        starts += status.missed != 0;
        vm_expect(fd, PHANTOM_STOP, NULL, 0, "STOP");
    }
    CHECK(missed == 0, "%d of 200 starts missed %llu ticks", starts, (unsigned long long)missed);
}

static void* change_rates(void* argument)
{
    int fd = *(int*)argument;
    uint64_t random = (uint64_t)(uintptr_t)&random;
    uint64_t end = vm_now_ns() + 2 * VM_NS_PER_S;

    while (vm_now_ns() < end) {
        vm_set_rate(fd, 1000 + vm_random_below(&random, 9001));
        vm_sleep_ns(vm_random_below(&random, 3000000));
    }
    return NULL;
}

VM_TEST(rate, changes_from_four_threads_miss_no_tick, 20)
{
    int fd = vm_open_feeder();
    const struct phantom_status* page = vm_map(fd);
    struct phantom_status before, after;
    pthread_t threads[4];

    vm_touch(fd, page);
    vm_status(page, &before);
    for (int i = 0; i < 4; i++)
        CHECK(pthread_create(&threads[i], NULL, change_rates, &fd) == 0, "pthread_create");
    for (int i = 0; i < 4; i++)
        pthread_join(threads[i], NULL);
    vm_set_rate(fd, 4321);
    vm_status(page, &before);
    vm_wait_ticks(page, before.tick + 4321);
    vm_status(page, &after);
    CHECK(after.missed == 0, "%llu ticks missed", (unsigned long long)after.missed);
    CHECK(after.faults == 0, "faults %#x", after.faults);
    CHECK(after.rate_hz == 4321, "the page says %u Hz", after.rate_hz);
    CHECK(llabs((int64_t)(after.time_ns - before.time_ns) - (int64_t)VM_NS_PER_S) < 2 * (int64_t)VM_NS_PER_MS,
          "4321 ticks at 4321 Hz took %lld ns", (long long)(after.time_ns - before.time_ns));
}
