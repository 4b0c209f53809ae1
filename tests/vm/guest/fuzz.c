// SPDX-License-Identifier: GPL-2.0-or-later
// 200,000 random calls, from nearly right to nonsense. The seed is in the report; vm.seed= repeats a run.
#define _GNU_SOURCE
#include <errno.h>
#include <fcntl.h>
#include <string.h>
#include <sys/ioctl.h>
#include <sys/mman.h>
#include <unistd.h>

#include "device.h"
#include "harness.h"

#define CALLS 200000

static const unsigned long requests[] = {
    PHANTOM_GET_INFO, PHANTOM_SET_RATE,   PHANTOM_SET_MODEL,   PHANTOM_START,      PHANTOM_STOP,
    PHANTOM_SIM_MOVE, PHANTOM_SUBMIT_SET, PHANTOM_CLEAR_FAULT, PHANTOM_SUBMIT_SET, PHANTOM_SIM_MOVE,
};

struct fuzz {
    uint64_t random;
    uint64_t next_id;
    struct vm_plate plate;
    unsigned char argument[512];
};

static uint32_t below(struct fuzz* fuzz, uint32_t bound)
{
    return vm_random_below(&fuzz->random, bound);
}

/* Values at which arithmetic goes wrong, and any others. */
static uint32_t odd_value(struct fuzz* fuzz)
{
    static const uint32_t odd[] = {0, 1, 2, 511, 512, 513, 0x7fffffff, 0x80000000, 0xffffffff, 1u << 30};

    return below(fuzz, 2) ? odd[below(fuzz, sizeof(odd) / sizeof(odd[0]))]
                          : (uint32_t)vm_random(&fuzz->random);
}

static void spoil(struct fuzz* fuzz, void* memory, size_t size)
{
    uint32_t value = odd_value(fuzz);

    memcpy((char*)memory + 4 * below(fuzz, (uint32_t)(size / 4)), &value, sizeof(value));
}

/* A good argument for the request, in fuzz->argument. */
static void make_good(struct fuzz* fuzz, unsigned long request)
{
    memset(fuzz->argument, 0, sizeof(fuzz->argument));
    switch (request) {
    case PHANTOM_SET_RATE: {
        const struct phantom_rate rate = {.rate_hz = vm_rate(1000 + below(fuzz, 9001))};
        memcpy(fuzz->argument, &rate, sizeof(rate));
        break;
    }
    case PHANTOM_SET_MODEL: {
        const struct phantom_model model = {.model = below(fuzz, 3),
                                            .newton_steps = below(fuzz, 4),
                                            .combine = below(fuzz, 2),
                                            .proxy = below(fuzz, 2)};
        memcpy(fuzz->argument, &model, sizeof(model));
        break;
    }
    case PHANTOM_START: {
        const struct phantom_start start = {
            .flags = below(fuzz, 2), .ramp_ms = 1, .stale_ms = 1 + below(fuzz, 100)};
        memcpy(fuzz->argument, &start, sizeof(start));
        break;
    }
    case PHANTOM_SIM_MOVE: {
        const struct phantom_sim_move move = {.tip_nm = {(int64_t)below(fuzz, 60000000) - 30000000,
                                                         (int64_t)below(fuzz, 60000000) - 30000000,
                                                         (int64_t)below(fuzz, 8000000) - 4000000}};
        memcpy(fuzz->argument, &move, sizeof(move));
        break;
    }
    case PHANTOM_SUBMIT_SET:
        vm_plate_make(&fuzz->plate, fuzz->next_id++);
        if (below(fuzz, 3) == 0)
            spoil(fuzz, fuzz->plate.patches, sizeof(fuzz->plate.patches));
        memcpy(fuzz->argument, &fuzz->plate.set, sizeof(fuzz->plate.set));
        break;
    }
}

static bool may_come(int rc)
{
    switch (rc) {
    case 0:
    case -EINVAL:
    case -EFAULT:
    case -EBUSY:
    case -EIO:
    case -EAGAIN:
    case -ENOTTY:
    case -EOPNOTSUPP:
        return true;
    }
    return false;
}

static int random_call(struct fuzz* fuzz, int fd)
{
    unsigned long request = requests[below(fuzz, sizeof(requests) / sizeof(requests[0]))];
    const void* argument = fuzz->argument;

    make_good(fuzz, request);
    switch (below(fuzz, 8)) {
    case 0:
    case 1:
        spoil(fuzz, fuzz->argument, 136);
        break;
    case 2:
        argument = (const void*)(uintptr_t)vm_random(&fuzz->random);
        break;
    case 3: /* any direction, size and number of our magic */
        request = _IOC(below(fuzz, 4), PHANTOM_IOC_MAGIC, below(fuzz, 12), below(fuzz, 1 << 14));
        break;
    case 4:
        for (size_t i = 0; i < 136; i++)
            fuzz->argument[i] = (unsigned char)vm_random(&fuzz->random);
        break;
    default: /* as it should be */
        break;
    }
    return vm_ioctl(fd, request, argument);
}

VM_TEST(fuzz, two_hundred_thousand_random_calls, 200)
{
    static struct phantom_tick records[64];
    static struct fuzz fuzz;
    int fd = vm_open_feeder();
    int observer = vm_open(O_RDONLY | O_NONBLOCK);
    const struct phantom_status* page = vm_map(observer);
    uint32_t good = 0, runs = 0, last_state = PHANTOM_STATE_IDLE;
    struct phantom_status status;

    fuzz.random = vm_seed();
    fuzz.next_id = 1;
    for (int i = 0; i < CALLS; i++) {
        int rc = random_call(&fuzz, fd);

        CHECK(may_come(rc), "call %d gave %s", i, vm_error_name(rc));
        good += rc == 0;
        if (below(&fuzz, 500) == 0)
            vm_sleep_ns(below(&fuzz, 2000000)); /* let it tick */
        if (below(&fuzz, 50) == 0) {
            rc = vm_ioctl(fd, PHANTOM_CLEAR_FAULT, NULL);
            CHECK(rc == 0 || rc == -EAGAIN, "CLEAR_FAULT gave %s", vm_error_name(rc));
        }
        if (below(&fuzz, 300) == 0) {
            close(fd); /* an enormous id has been taken: the next feeder counts anew */
            fd = vm_open_feeder();
            fuzz.next_id = 1;
        }
        if (i % 100)
            continue;
        vm_status(page, &status);
        runs += status.state != PHANTOM_STATE_IDLE && last_state == PHANTOM_STATE_IDLE;
        last_state = status.state;
        CHECK(status.state <= PHANTOM_STATE_FAULT && status.rate_hz >= PHANTOM_RATE_MIN_HZ &&
                  status.rate_hz <= PHANTOM_RATE_MAX_HZ && status.model.model <= PHANTOM_MODEL_PROJECTED,
              "call %d: state %u, %u Hz, model %u", i, status.state, status.rate_hz, status.model.model);
        CHECK(read(observer, records, sizeof(records)) >= 0 || errno == EAGAIN, "read");
        if (status.state == PHANTOM_STATE_IDLE)
            CHECK(vm_force_size(status.force_un) == 0, "call %d: %d uN in IDLE", i, status.force_un[2]);
    }
    CHECK(good > CALLS / 10 && runs > 20, "no real test: %u calls succeeded, %u runs seen", good, runs);
    vm_figure("%u calls succeeded, %u runs seen", good, runs);
    close(fd);
    vm_status(page, &status);
    CHECK(status.state == PHANTOM_STATE_IDLE, "state %u after the last close", status.state);
    /* It still works. */
    fd = vm_open_feeder();
    vm_plate_submit(fd, 1);
    vm_start(fd);
    vm_wait_ticks(page, 100);
}
