// SPDX-License-Identifier: GPL-2.0-or-later
// Everything at once, on one file and on many.
#define _GNU_SOURCE
#include <errno.h>
#include <fcntl.h>
#include <poll.h>
#include <pthread.h>
#include <stdlib.h>
#include <sys/mman.h>
#include <unistd.h>

#include "device.h"
#include "harness.h"

struct stage {
    int fd;
    uint64_t end_ns;
    uint64_t next_id;
    uint32_t calls;
};

static bool goes_on(struct stage* stage)
{
    __atomic_add_fetch(&stage->calls, 1, __ATOMIC_RELAXED);
    return vm_now_ns() < stage->end_ns;
}

static void* submit(void* argument)
{
    struct stage* stage = argument;
    struct vm_plate plate;

    while (goes_on(stage)) {
        int rc;

        vm_plate_make(&plate, __atomic_add_fetch(&stage->next_id, 1, __ATOMIC_RELAXED));
        rc = vm_ioctl(stage->fd, PHANTOM_SUBMIT_SET, &plate.set);
        /* EINVAL: the other submitter was faster with a larger number */
        CHECK(rc == 0 || rc == -EINVAL || rc == -EAGAIN, "SUBMIT_SET gave %s", vm_error_name(rc));
        usleep(50);
    }
    return NULL;
}

static void* start_and_stop(void* argument)
{
    struct stage* stage = argument;
    uint64_t random = stage->end_ns;

    while (goes_on(stage)) {
        const struct phantom_start start = {.ramp_ms = 1, .stale_ms = 100};
        int rc = vm_ioctl(stage->fd, PHANTOM_START, &start);

        CHECK(rc == 0 || rc == -EBUSY || rc == -EIO, "START gave %s", vm_error_name(rc));
        usleep(vm_random_below(&random, 5000));
        vm_expect(stage->fd, PHANTOM_STOP, NULL, 0, "STOP");
        rc = vm_ioctl(stage->fd, PHANTOM_CLEAR_FAULT, NULL);
        CHECK(rc == 0 || rc == -EAGAIN, "CLEAR_FAULT gave %s", vm_error_name(rc));
    }
    return NULL;
}

static void* change_settings(void* argument)
{
    struct stage* stage = argument;
    uint64_t random = stage->end_ns + 1;

    while (goes_on(stage)) {
        const struct phantom_model model = {.model = vm_random_below(&random, 3),
                                            .newton_steps = vm_random_below(&random, 4),
                                            .combine = vm_random_below(&random, 2),
                                            .proxy = vm_random_below(&random, 2)};

        vm_set_rate(stage->fd, 1000 + vm_random_below(&random, 9001));
        vm_expect(stage->fd, PHANTOM_SET_MODEL, &model, 0, "SET_MODEL");
        vm_move(stage->fd, (int64_t)vm_random_below(&random, 1000000), 0,
                (int64_t)vm_random_below(&random, 4000000) - 2000000);
        usleep(300);
    }
    return NULL;
}

static void* observe(void* argument)
{
    struct stage* stage = argument;
    static __thread struct phantom_tick records[256];

    while (goes_on(stage)) {
        int fd = vm_open(O_RDONLY | O_NONBLOCK);
        const struct phantom_status* page = vm_map(fd);
        struct phantom_status status;
        struct pollfd entry = {.fd = fd, .events = POLLIN | POLLPRI};

        poll(&entry, 1, 2);
        CHECK(read(fd, records, sizeof(records)) >= 0 || errno == EAGAIN, "read");
        vm_status(page, &status);
        CHECK(status.state <= PHANTOM_STATE_FAULT, "state %u", status.state);
        munmap((void*)(uintptr_t)page, vm_status_size(fd));
        close(fd);
    }
    return NULL;
}

VM_TEST(race, all_calls_from_eight_threads, 60)
{
    static void* (*const roles[])(void*) = {submit,          submit,  start_and_stop, start_and_stop,
                                            change_settings, observe, observe,        change_settings};
    struct stage stage = {.fd = vm_open_feeder(), .end_ns = vm_now_ns() + 3 * VM_NS_PER_S};
    const struct phantom_status* page = vm_map(stage.fd);
    pthread_t threads[8];

    for (int i = 0; i < 8; i++)
        CHECK(pthread_create(&threads[i], NULL, roles[i], &stage) == 0, "pthread_create");
    for (int i = 0; i < 8; i++)
        pthread_join(threads[i], NULL);
    vm_expect(stage.fd, PHANTOM_STOP, NULL, 0, "STOP");
    CHECK(vm_state(page) == PHANTOM_STATE_IDLE, "state %u", vm_state(page));
    vm_figure("%u rounds", stage.calls);
}

/* The file is closed by one thread while others are inside its calls. */
VM_TEST(race, close_under_running_calls, 60)
{
    for (int round = 0; round < 20; round++) {
        struct stage stage = {.fd = vm_open_feeder(), .end_ns = vm_now_ns() + 10 * VM_NS_PER_MS};
        struct stage twin = stage;
        pthread_t threads[3];
        int copy = dup(stage.fd);

        twin.fd = copy;
        CHECK(pthread_create(&threads[0], NULL, submit, &stage) == 0, "pthread_create");
        CHECK(pthread_create(&threads[1], NULL, start_and_stop, &stage) == 0, "pthread_create");
        CHECK(pthread_create(&threads[2], NULL, change_settings, &twin) == 0, "pthread_create");
        for (int i = 0; i < 3; i++)
            pthread_join(threads[i], NULL);
        close(stage.fd);
        close(copy);
    }
}
