// SPDX-License-Identifier: GPL-2.0-or-later
// Every pointer that a call takes: NULL, the kernel's, not canonical, unmapped, forbidden, crossing pages.
#define _GNU_SOURCE
#include <errno.h>
#include <stdlib.h>
#include <string.h>
#include <sys/ioctl.h>
#include <sys/mman.h>
#include <unistd.h>

#include "device.h"
#include "harness.h"

#define PAGE 4096u

static const struct {
    unsigned long request;
    const char* name;
} calls[] = {
    {PHANTOM_GET_INFO, "GET_INFO"}, {PHANTOM_SET_RATE, "SET_RATE"},     {PHANTOM_SET_MODEL, "SET_MODEL"},
    {PHANTOM_START, "START"},       {PHANTOM_SUBMIT_SET, "SUBMIT_SET"}, {PHANTOM_SIM_MOVE, "SIM_MOVE"},
};
#define CALLS (sizeof(calls) / sizeof(calls[0]))

/* Two pages that may be used, followed by one that is not mapped and one that is forbidden. */
static unsigned char* make_pages(void)
{
    unsigned char* pages = mmap(NULL, 4 * PAGE, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);

    CHECK(pages != MAP_FAILED, "mmap: %s", strerror(errno));
    CHECK(munmap(pages + 2 * PAGE, PAGE) == 0, "munmap");
    CHECK(mprotect(pages + 3 * PAGE, PAGE, PROT_NONE) == 0, "mprotect");
    return pages;
}

/* Addresses at which not one byte can be read or written. */
static size_t bad_addresses(unsigned char* pages, uint64_t bad[16])
{
    size_t n = 0;

    bad[n++] = 0;
    bad[n++] = 1;
    bad[n++] = PAGE;
    bad[n++] = (uintptr_t)pages + 2 * PAGE; /* unmapped */
    bad[n++] = (uintptr_t)pages + 3 * PAGE; /* PROT_NONE */
    bad[n++] = 0x00007fffffffffffull;       /* the last byte of user space */
    bad[n++] = 0x0000800000000000ull;       /* not canonical */
    bad[n++] = 0x8000000000000000ull;
    bad[n++] = 0xffff800000000000ull; /* the kernel's half */
    bad[n++] = 0xffff888000000000ull; /* its direct map */
    bad[n++] = 0xffffffff81000000ull; /* its text */
    bad[n++] = 0xffffffffffffff00ull; /* wraps */
    bad[n++] = 0xffffffffffffffffull;
    return n;
}

VM_TEST(pointer, bad_argument_is_a_fault, 10)
{
    uint64_t bad[16];
    unsigned char* pages = make_pages();
    size_t count = bad_addresses(pages, bad);
    int fd = vm_open_feeder();

    for (size_t i = 0; i < CALLS; i++)
        for (size_t j = 0; j < count; j++) {
            int rc = vm_ioctl(fd, calls[i].request, (const void*)(uintptr_t)bad[j]);

            CHECK(rc == -EFAULT, "%s at %#llx gave %s", calls[i].name, (unsigned long long)bad[j],
                  vm_error_name(rc));
        }
}

VM_TEST(pointer, argument_that_runs_into_a_hole_is_a_fault, 10)
{
    unsigned char* pages = make_pages();
    unsigned char* hole = pages + 2 * PAGE;
    int fd = vm_open_feeder();

    for (size_t i = 0; i < CALLS; i++)
        for (size_t inside = 1; inside < _IOC_SIZE(calls[i].request); inside++) {
            int rc = vm_ioctl(fd, calls[i].request, hole - inside);

            CHECK(rc == -EFAULT, "%s with %zu bytes before the hole gave %s", calls[i].name, inside,
                  vm_error_name(rc));
        }
}

VM_TEST(pointer, info_into_read_only_memory_is_a_fault, 10)
{
    unsigned char* pages = make_pages();
    int fd = vm_open_feeder();

    CHECK(mprotect(pages, PAGE, PROT_READ) == 0, "mprotect");
    vm_expect(fd, PHANTOM_GET_INFO, pages, -EFAULT, "GET_INFO into a read-only page");
    CHECK(pages[0] == 0, "the page was written");
}

/* Good arguments at every alignment, across a page's end. */
VM_TEST(pointer, any_alignment_will_do, 10)
{
    const struct phantom_rate rate = {.rate_hz = 2000};
    const struct phantom_model model = {.model = PHANTOM_MODEL_PROJECTED};
    const struct phantom_sim_move move = {.tip_nm = {1, 2, 3}};
    unsigned char* pages = make_pages();
    int fd = vm_open_feeder();

    for (unsigned int offset = 1; offset < 200; offset++) {
        unsigned char* at = pages + PAGE - offset;
        struct vm_plate plate;

        vm_expect(fd, PHANTOM_GET_INFO, at, 0, "GET_INFO across pages");
        memcpy(at, &rate, sizeof(rate));
        vm_expect(fd, PHANTOM_SET_RATE, at, 0, "SET_RATE across pages");
        memcpy(at, &model, sizeof(model));
        vm_expect(fd, PHANTOM_SET_MODEL, at, 0, "SET_MODEL across pages");
        memcpy(at, &move, sizeof(move));
        vm_expect(fd, PHANTOM_SIM_MOVE, at, 0, "SIM_MOVE across pages");
        vm_plate_make(&plate, offset);
        memcpy(at, &plate.set, sizeof(plate.set));
        vm_expect(fd, PHANTOM_SUBMIT_SET, at, 0, "SUBMIT_SET across pages");
    }
}

VM_TEST(pointer, calls_without_an_argument_do_not_look_at_it, 10)
{
    int fd = vm_open_feeder();

    for (int i = 0; i < 3; i++) {
        static const uint64_t odd[] = {1, 0xffff888000000000ull, 0xffffffffffffffffull};

        vm_expect(fd, PHANTOM_STOP, (const void*)(uintptr_t)odd[i], 0, "STOP with a strange argument");
        vm_expect(fd, PHANTOM_CLEAR_FAULT, (const void*)(uintptr_t)odd[i], 0,
                  "CLEAR_FAULT with a strange argument");
    }
}

/* The set's three arrays. */
static __u64* array_of(struct phantom_set* set, int which)
{
    return which == 0 ? &set->patches : which == 1 ? &set->materials : &set->objects;
}

static size_t size_of(int which)
{
    return which == 0   ? VM_PLATE_PATCHES * sizeof(struct phantom_patch)
           : which == 1 ? sizeof(struct phantom_material)
                        : sizeof(struct phantom_object);
}

VM_TEST(pointer, bad_array_of_a_set_is_a_fault, 10)
{
    uint64_t bad[16];
    unsigned char* pages = make_pages();
    size_t count = bad_addresses(pages, bad);
    int fd = vm_open_feeder();
    struct vm_plate plate;

    for (int which = 0; which < 3; which++)
        for (size_t j = 0; j < count; j++) {
            int rc;

            vm_plate_make(&plate, 1);
            *array_of(&plate.set, which) = bad[j];
            rc = vm_ioctl(fd, PHANTOM_SUBMIT_SET, &plate.set);
            CHECK(rc == -EFAULT, "array %d at %#llx gave %s", which, (unsigned long long)bad[j],
                  vm_error_name(rc));
        }
    vm_plate_submit(fd, 1);
}

VM_TEST(pointer, array_of_a_set_that_runs_into_a_hole_is_a_fault, 20)
{
    unsigned char* pages = make_pages();
    unsigned char* hole = pages + 2 * PAGE;
    int fd = vm_open_feeder();
    struct vm_plate plate;

    for (int which = 0; which < 3; which++)
        for (size_t inside = 0; inside < size_of(which); inside += which ? 1 : 7) {
            int rc;

            vm_plate_make(&plate, 1);
            memcpy(hole - inside, (const void*)(uintptr_t)*array_of(&plate.set, which), inside);
            *array_of(&plate.set, which) = (uintptr_t)hole - inside;
            rc = vm_ioctl(fd, PHANTOM_SUBMIT_SET, &plate.set);
            CHECK(rc == -EFAULT, "array %d with %zu bytes before the hole gave %s", which, inside,
                  vm_error_name(rc));
        }
    for (int which = 0; which < 3; which++) {
        vm_plate_make(&plate, 1u + (unsigned int)which);
        memcpy(hole - size_of(which), (const void*)(uintptr_t)*array_of(&plate.set, which), size_of(which));
        *array_of(&plate.set, which) = (uintptr_t)hole - size_of(which);
        vm_expect(fd, PHANTOM_SUBMIT_SET, &plate.set, 0, "SUBMIT_SET with an array right before a hole");
    }
}
