// SPDX-License-Identifier: GPL-2.0-or-later
// The device as the tests use it.
#define _GNU_SOURCE
#include <errno.h>
#include <fcntl.h>
#include <stdlib.h>
#include <string.h>
#include <sys/ioctl.h>
#include <sys/mman.h>
#include <time.h>
#include <unistd.h>

#include "device.h"
#include "harness.h"

#define PATIENCE_NS (5 * VM_NS_PER_S)

uint64_t vm_now_ns(void)
{
    struct timespec now;

    clock_gettime(CLOCK_MONOTONIC, &now);
    return (uint64_t)now.tv_sec * VM_NS_PER_S + (uint64_t)now.tv_nsec;
}

void vm_sleep_ns(uint64_t ns)
{
    struct timespec left = {(time_t)(ns / VM_NS_PER_S), (long)(ns % VM_NS_PER_S)};

    while (clock_nanosleep(CLOCK_MONOTONIC, 0, &left, &left) == EINTR)
        ;
}

int vm_try_open(int flags)
{
    int fd = open(PHANTOM_DEVICE_NODE, flags | O_CLOEXEC);

    return fd < 0 ? -errno : fd;
}

int vm_open(int flags)
{
    int fd = vm_try_open(flags);

    CHECK(fd >= 0, "open %s with flags %#x: %s", PHANTOM_DEVICE_NODE, flags, strerror(-fd));
    return fd;
}

int vm_open_feeder(void)
{
    const struct phantom_model model = {
        .model = PHANTOM_MODEL_PROJECTED,
        .newton_steps = 2,
        .combine = PHANTOM_COMBINE_BOUNDED,
        .proxy = PHANTOM_PROXY_PAPER,
        .arith = PHANTOM_ARITH_FLOAT,
    };
    int fd = vm_open(O_RDWR);

    vm_expect(fd, PHANTOM_CLEAR_FAULT, NULL, 0, "CLEAR_FAULT after open");
    vm_set_rate(fd, 1000);
    vm_expect(fd, PHANTOM_SET_MODEL, &model, 0, "SET_MODEL projected");
    return fd;
}

int vm_ioctl(int fd, unsigned long request, const void* argument)
{
    int rc = ioctl(fd, request, argument);

    return rc < 0 ? -errno : rc;
}

const char* vm_error_name(int error)
{
    return error == 0 ? "0" : strerrorname_np(error < 0 ? -error : error);
}

void vm_expect(int fd, unsigned long request, const void* argument, int expected, const char* what)
{
    int rc = vm_ioctl(fd, request, argument);

    CHECK(rc == expected, "%s gave %s, not %s", what, vm_error_name(rc), vm_error_name(expected));
}

uint32_t vm_rate(uint32_t rate_hz)
{
    uint64_t most_hz = vm_word("vm.most_hz=", rate_hz);

    return rate_hz < most_hz ? rate_hz : (uint32_t)most_hz;
}

void vm_set_rate(int fd, uint32_t rate_hz)
{
    const struct phantom_rate rate = {.rate_hz = vm_rate(rate_hz)};

    vm_expect(fd, PHANTOM_SET_RATE, &rate, 0, "SET_RATE");
}

void vm_start(int fd)
{
    const struct phantom_start start = {.stale_ms = 60000};

    vm_expect(fd, PHANTOM_START, &start, 0, "START");
}

void vm_move(int fd, int64_t x_nm, int64_t y_nm, int64_t z_nm)
{
    const struct phantom_sim_move move = {.tip_nm = {x_nm, y_nm, z_nm}};

    vm_expect(fd, PHANTOM_SIM_MOVE, &move, 0, "SIM_MOVE");
}

size_t vm_status_size(int fd)
{
    struct phantom_info info = {0};

    vm_expect(fd, PHANTOM_GET_INFO, &info, 0, "GET_INFO");
    return info.status_size;
}

const struct phantom_status* vm_map(int fd)
{
    void* page = mmap(NULL, vm_status_size(fd), PROT_READ, MAP_SHARED, fd, 0);

    CHECK(page != MAP_FAILED, "mmap of the status page: %s", strerror(errno));
    return page;
}

void vm_status(const struct phantom_status* page, struct phantom_status* copy)
{
    for (int attempt = 0; attempt < 100000; attempt++) {
        uint32_t before = __atomic_load_n(&page->sequence, __ATOMIC_ACQUIRE);

        if (before & 1) {
            vm_sleep_ns(1000);
            continue;
        }
        *copy = *(const volatile struct phantom_status*)page;
        __atomic_thread_fence(__ATOMIC_ACQUIRE);
        if (__atomic_load_n(&page->sequence, __ATOMIC_RELAXED) == before)
            return;
    }
    CHECK(false, "the status page's sequence never came to rest");
}

uint32_t vm_state(const struct phantom_status* page)
{
    struct phantom_status status;

    vm_status(page, &status);
    return status.state;
}

void vm_wait_ticks(const struct phantom_status* page, uint64_t ticks)
{
    uint64_t end = vm_now_ns() + PATIENCE_NS;
    struct phantom_status status;

    for (;;) {
        vm_status(page, &status);
        if (status.tick >= ticks)
            return;
        CHECK(vm_now_ns() < end, "tick %llu, waited for %llu", (unsigned long long)status.tick,
              (unsigned long long)ticks);
        vm_sleep_ns(100000);
    }
}

void vm_wait_state(const struct phantom_status* page, uint32_t state)
{
    uint64_t end = vm_now_ns() + PATIENCE_NS;

    while (vm_state(page) != state) {
        CHECK(vm_now_ns() < end, "state is %u, waited for %u", vm_state(page), state);
        vm_sleep_ns(100000);
    }
}

int64_t vm_force_size(const int32_t force_un[3])
{
    int64_t largest = 0;

    for (int axis = 0; axis < 3; axis++)
        if (llabs(force_un[axis]) > largest)
            largest = llabs(force_un[axis]);
    return largest;
}

/* Index of a triangle of the plate: `upper` is the one at the cell's far corner. */
static uint32_t plate_index(int column, int row, int upper)
{
    if (column < 0 || row < 0 || column >= VM_PLATE_CELLS || row >= VM_PLATE_CELLS)
        return PHANTOM_PATCH_NONE;
    return (uint32_t)(2 * (row * VM_PLATE_CELLS + column) + upper);
}

static void plate_corner(struct phantom_patch* patch, int corner, int column, int row)
{
    const int32_t step = 2 * VM_PLATE_HALF_NM / VM_PLATE_CELLS;

    patch->vertex_nm[corner][0] = column * step - VM_PLATE_HALF_NM;
    patch->vertex_nm[corner][1] = row * step - VM_PLATE_HALF_NM;
    patch->normal_q30[corner][2] = PHANTOM_Q30_ONE;
    patch->vertex[corner] = (uint32_t)(row * (VM_PLATE_CELLS + 1) + column);
}

void vm_plate_make(struct vm_plate* plate, uint64_t id)
{
    memset(plate, 0, sizeof(*plate));
    for (int row = 0; row < VM_PLATE_CELLS; row++)
        for (int column = 0; column < VM_PLATE_CELLS; column++) {
            struct phantom_patch* lower = &plate->patches[plate_index(column, row, 0)];
            struct phantom_patch* upper = &plate->patches[plate_index(column, row, 1)];

            /* lower: edges south, diagonal, west; upper: diagonal, east, north. */
            plate_corner(lower, 0, column, row);
            plate_corner(lower, 1, column + 1, row);
            plate_corner(lower, 2, column, row + 1);
            lower->neighbour[0] = plate_index(column, row - 1, 1);
            lower->neighbour[1] = plate_index(column, row, 1);
            lower->neighbour[2] = plate_index(column - 1, row, 1);
            plate_corner(upper, 0, column, row + 1);
            plate_corner(upper, 1, column + 1, row);
            plate_corner(upper, 2, column + 1, row + 1);
            upper->neighbour[0] = plate_index(column, row, 0);
            upper->neighbour[1] = plate_index(column + 1, row, 0);
            upper->neighbour[2] = plate_index(column, row + 1, 0);
        }
    for (uint32_t i = 0; i < VM_PLATE_PATCHES; i++)
        plate->patches[i].face = i;
    plate->material.stiffness_mn_mm = VM_PLATE_STIFFNESS;
    plate->material.radius_nm = VM_PLATE_RADIUS_NM;
    plate->object.rotation_q30[0] = PHANTOM_Q30_ONE;
    plate->set.id = id;
    plate->set.radius_nm = 500000000; /* 0.5 m: all of the workspace */
    plate->set.patch_count = VM_PLATE_PATCHES;
    plate->set.material_count = 1;
    plate->set.object_count = 1;
    plate->set.patches = (uintptr_t)plate->patches;
    plate->set.materials = (uintptr_t)&plate->material;
    plate->set.objects = (uintptr_t)&plate->object;
}

void vm_plate_submit(int fd, uint64_t id)
{
    struct vm_plate plate;

    vm_plate_make(&plate, id);
    vm_expect(fd, PHANTOM_SUBMIT_SET, &plate.set, 0, "SUBMIT_SET of the plate");
}

int64_t vm_plate_force(int64_t height_nm)
{
    if (height_nm >= VM_PLATE_RADIUS_NM)
        return 0;
    return (VM_PLATE_RADIUS_NM - height_nm) * VM_PLATE_STIFFNESS / 1000;
}

void vm_touch(int fd, const struct phantom_status* page)
{
    uint64_t end = vm_now_ns() + PATIENCE_NS;
    struct phantom_status status;

    vm_move(fd, 2000000, 3000000, VM_CONTACT_HEIGHT_NM);
    vm_plate_submit(fd, 1);
    vm_start(fd);
    do {
        CHECK(vm_now_ns() < end, "no full force after five seconds in contact");
        vm_sleep_ns(VM_NS_PER_MS);
        vm_status(page, &status);
        CHECK(status.faults == 0, "faults %#x in plain contact", status.faults);
    } while (status.force_un[2] < vm_plate_force(VM_CONTACT_HEIGHT_NM) - 50 ||
             (status.flags & (PHANTOM_TICK_RAMPING | PHANTOM_TICK_FADING | PHANTOM_TICK_SLEWED)));
}
