// SPDX-License-Identifier: GPL-2.0-or-later
// Request numbers, and who may use which.
#include <errno.h>
#include <fcntl.h>
#include <string.h>
#include <sys/ioctl.h>

#include "device.h"
#include "harness.h"

static const unsigned long known[] = {
    PHANTOM_GET_INFO, PHANTOM_SET_RATE,   PHANTOM_SET_MODEL, PHANTOM_START,
    PHANTOM_STOP,     PHANTOM_SUBMIT_SET, PHANTOM_SIM_MOVE,  PHANTOM_CLEAR_FAULT,
};
#define KNOWN (sizeof(known) / sizeof(known[0]))

static bool is_known(unsigned long request)
{
    for (size_t i = 0; i < KNOWN; i++)
        if (known[i] == request)
            return true;
    return false;
}

VM_TEST(number, unknown_number_of_our_magic_is_refused, 10)
{
    unsigned char argument[4096] = {0};
    int fd = vm_open_feeder();

    for (unsigned int nr = 0; nr < 256; nr++)
        for (unsigned int direction = 0; direction < 4; direction++) {
            unsigned long request = _IOC(direction, PHANTOM_IOC_MAGIC, nr, direction ? 32 : 0);

            if (!is_known(request))
                CHECK(vm_ioctl(fd, request, argument) == -ENOTTY, "request %#lx was not refused", request);
        }
}

VM_TEST(number, wrong_size_or_direction_of_a_known_number_is_refused, 10)
{
    unsigned char argument[1 << 14] = {0};
    int fd = vm_open_feeder();

    for (size_t i = 0; i < KNOWN; i++)
        for (unsigned int size = 0; size < (1 << 14); size += size < 512 ? 1 : 509)
            for (unsigned int direction = 0; direction < 4; direction++) {
                unsigned long request = _IOC(direction, PHANTOM_IOC_MAGIC, _IOC_NR(known[i]), size);
                int rc;

                if (is_known(request))
                    continue;
                rc = vm_ioctl(fd, request, argument);
                CHECK(rc == -ENOTTY, "request %#lx (number %zu, size %u, direction %u) gave %s", request, i,
                      size, direction, vm_error_name(rc));
            }
}

VM_TEST(number, wrong_magic_is_refused, 10)
{
    unsigned char argument[512] = {0};
    int fd = vm_open_feeder();

    for (unsigned int magic = 0; magic < 256; magic++)
        for (size_t i = 0; i < KNOWN; i++) {
            unsigned long request = _IOC(_IOC_DIR(known[i]), magic, _IOC_NR(known[i]), _IOC_SIZE(known[i]));

            /* 'f', 'T' ... are the VFS's own for every file; ours lie beside them. */
            if (magic != PHANTOM_IOC_MAGIC && magic != 'f' && magic != 'T' && magic != 'X' && magic != 0)
                CHECK(vm_ioctl(fd, request, argument) == -ENOTTY, "request %#lx was not refused", request);
        }
}

VM_TEST(number, observer_may_only_ask_for_info, 10)
{
    struct vm_plate plate;
    const struct phantom_rate rate = {.rate_hz = 1000};
    const struct phantom_model model = {0};
    const struct phantom_start start = {0};
    const struct phantom_sim_move move = {0};
    int fd = vm_open(O_RDONLY);

    vm_plate_make(&plate, 1);
    vm_expect(fd, PHANTOM_SET_RATE, &rate, -EBADF, "SET_RATE by an observer");
    vm_expect(fd, PHANTOM_SET_MODEL, &model, -EBADF, "SET_MODEL by an observer");
    vm_expect(fd, PHANTOM_START, &start, -EBADF, "START by an observer");
    vm_expect(fd, PHANTOM_STOP, NULL, -EBADF, "STOP by an observer");
    vm_expect(fd, PHANTOM_SUBMIT_SET, &plate.set, -EBADF, "SUBMIT_SET by an observer");
    vm_expect(fd, PHANTOM_SIM_MOVE, &move, -EBADF, "SIM_MOVE by an observer");
    vm_expect(fd, PHANTOM_CLEAR_FAULT, NULL, -EBADF, "CLEAR_FAULT by an observer");
}
