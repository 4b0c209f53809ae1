// SPDX-License-Identifier: GPL-2.0-or-later
// Parameters at load, and the two calls behind insmod and rmmod.
#define _GNU_SOURCE
#include <errno.h>
#include <fcntl.h>
#include <stdio.h>
#include <string.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <unistd.h>

#include "device.h"
#include "harness.h"
#include "module.h"

int vm_module_load(const char* parameters)
{
    int fd = open(VM_MODULE_FILE, O_RDONLY | O_CLOEXEC);
    int rc;

    CHECK(fd >= 0, "open %s: %s", VM_MODULE_FILE, strerror(errno));
    rc = syscall(SYS_finit_module, fd, parameters, 0) < 0 ? -errno : 0;
    close(fd);
    return rc;
}

int vm_module_unload(void)
{
    return syscall(SYS_delete_module, VM_MODULE_NAME, O_NONBLOCK) < 0 ? -errno : 0;
}

bool vm_module_is_loaded(void)
{
    struct stat entry;

    return stat("/sys/module/" VM_MODULE_NAME, &entry) == 0;
}

void vm_read_file(const char* path, char* text, size_t size)
{
    int fd = open(path, O_RDONLY | O_CLOEXEC);
    size_t used = 0;

    while (fd >= 0 && used < size - 1) {
        ssize_t got = read(fd, text + used, size - 1 - used);

        if (got <= 0)
            break;
        used += (size_t)got;
    }
    text[used] = 0;
    if (fd >= 0)
        close(fd);
}

VM_TEST(module, wrong_parameters_are_refused_and_leave_nothing, 20)
{
    static const char* const wrong[] = {
        "rate_hz=0",
        "rate_hz=999",
        "rate_hz=10001",
        "rate_hz=-1",
        "rate_hz=fast",
        "device=phantom",
        "device=",
        "max_force_mn=0",
        "max_force_mn=100001",
        "max_force_mn=4294967295",
        "cpu=-2",
        "cpu=4096",
        "cpu=2147483647",
        "device=none rate_hz=1",
    };

    for (size_t i = 0; i < sizeof(wrong) / sizeof(wrong[0]); i++) {
        int rc = vm_module_load(wrong[i]);

        CHECK(rc == -EINVAL || rc == -ERANGE, "insmod %s gave %s", wrong[i], vm_error_name(rc));
        CHECK(!vm_module_is_loaded(), "insmod %s failed and is loaded", wrong[i]);
        CHECK(access(PHANTOM_DEVICE_NODE, F_OK) < 0, "insmod %s failed and left its node", wrong[i]);
    }
}

VM_TEST(module, without_a_device_there_is_no_run, 10)
{
    const struct phantom_start start = {0};
    const struct phantom_sim_move move = {0};
    struct phantom_info info = {0};
    int fd;

    CHECK(vm_module_load("device=none") == 0, "insmod device=none");
    fd = vm_open(O_RDWR);
    vm_expect(fd, PHANTOM_GET_INFO, &info, 0, "GET_INFO");
    CHECK(info.device == PHANTOM_DEVICE_NONE, "device %u", info.device);
    CHECK(!(info.features & PHANTOM_FEATURE_SIM_MOVE), "SIM_MOVE is offered");
    vm_expect(fd, PHANTOM_SIM_MOVE, &move, -EOPNOTSUPP, "SIM_MOVE without a simulated device");
    vm_expect(fd, PHANTOM_START, &start, -ENODEV, "START without a device");
    vm_plate_submit(fd, 1);
    vm_expect(fd, PHANTOM_STOP, NULL, 0, "STOP");
    CHECK(close(fd) == 0, "close");
    CHECK(vm_module_unload() == 0, "rmmod");
}

VM_TEST(module, parameters_take_effect_and_can_be_read, 10)
{
    struct phantom_info info = {0};
    struct phantom_status status;
    char text[64];
    struct stat node;
    int fd;

    CHECK(vm_module_load("rate_hz=5000 cpu=0 device=sim max_force_mn=3300") == 0, "insmod");
    fd = vm_open(O_RDONLY);
    vm_expect(fd, PHANTOM_GET_INFO, &info, 0, "GET_INFO");
    CHECK(info.max_force_un == 3300000, "max_force_un %u", info.max_force_un);
    vm_status(vm_map(fd), &status);
    CHECK(status.rate_hz == 5000, "rate_hz %u", status.rate_hz);
    CHECK(status.state == PHANTOM_STATE_IDLE && status.faults == 0, "state %u", status.state);
    vm_read_file("/sys/module/phantom_rt/parameters/rate_hz", text, sizeof(text));
    CHECK(strcmp(text, "5000\n") == 0, "sysfs says rate_hz %s", text);
    CHECK(stat(PHANTOM_DEVICE_NODE, &node) == 0 && S_ISCHR(node.st_mode), "the node is no character device");
    CHECK((node.st_mode & 0007) == 0, "everybody may open the node: mode %o", node.st_mode & 0777);
}

VM_TEST(module, second_load_is_refused_and_the_first_stays, 10)
{
    /* The module of the test before: its file was closed with the test. */
    int rc = vm_module_load("");

    CHECK(rc == -EEXIST, "second insmod gave %s", vm_error_name(rc));
    close(vm_open(O_RDONLY));
    CHECK(vm_module_unload() == 0, "rmmod");
    CHECK(vm_try_open(O_RDONLY) == -ENOENT, "the node is there after rmmod");
}
