// SPDX-License-Identifier: GPL-2.0-or-later
// GET_INFO: what the module says about itself is complete and true.
#include <cpuid.h>
#include <errno.h>
#include <fcntl.h>
#include <string.h>

#include "device.h"
#include "harness.h"

static bool cpu_has_avx2(void)
{
    unsigned int a, b, c, d;

    return __get_cpuid_count(7, 0, &a, &b, &c, &d) && (b & bit_AVX2);
}

VM_TEST(info, is_complete_and_within_the_limits, 10)
{
    struct phantom_info info;
    int fd = vm_open(O_RDONLY);

    memset(&info, 0xcc, sizeof(info)); /* a field that the module forgets shows */
    vm_expect(fd, PHANTOM_GET_INFO, &info, 0, "GET_INFO");
    CHECK(info.abi_version == PHANTOM_ABI_VERSION, "abi_version %u", info.abi_version);
    CHECK(info.device == PHANTOM_DEVICE_SIM, "device %u", info.device);
    CHECK(info.features & PHANTOM_FEATURE_SIM_MOVE, "features %#llx without SIM_MOVE",
          (unsigned long long)info.features);
    CHECK(!(info.features & PHANTOM_FEATURE_ARITH_DOUBLE), "float64 in the kernel?");
    CHECK(info.patches_max == PHANTOM_PATCHES_MAX, "patches_max %u", info.patches_max);
    CHECK(info.materials_max == PHANTOM_MATERIALS_MAX, "materials_max %u", info.materials_max);
    CHECK(info.objects_max == PHANTOM_OBJECTS_MAX, "objects_max %u", info.objects_max);
    CHECK(info.rate_min_hz == PHANTOM_RATE_MIN_HZ, "rate_min_hz %u", info.rate_min_hz);
    CHECK(info.rate_max_hz == PHANTOM_RATE_MAX_HZ, "rate_max_hz %u", info.rate_max_hz);
    CHECK(info.status_size >= sizeof(struct phantom_status) && info.status_size % 4096 == 0, "status_size %u",
          info.status_size);
    CHECK(info.tick_size == sizeof(struct phantom_tick), "tick_size %u", info.tick_size);
    CHECK((info.effects & ~PHANTOM_EFFECTS_KNOWN) == 0, "effects %#x", info.effects);
    CHECK(info.max_force_un == 10000000, "max_force_un %u, insmod said 10 N", info.max_force_un);
    for (int axis = 0; axis < 3; axis++)
        CHECK(info.workspace_min_nm[axis] < info.workspace_max_nm[axis], "workspace axis %d: %d ... %d", axis,
              info.workspace_min_nm[axis], info.workspace_max_nm[axis]);
    for (int i = 0; i < 6; i++)
        CHECK(info.reserved[i] == 0, "reserved[%d] = %#x", i, info.reserved[i]);
}

VM_TEST(info, is_the_same_for_feeder_and_observer, 10)
{
    struct phantom_info feeder, observer;
    int fd = vm_open_feeder();

    vm_expect(fd, PHANTOM_GET_INFO, &feeder, 0, "GET_INFO of the feeder");
    vm_expect(vm_open(O_RDONLY), PHANTOM_GET_INFO, &observer, 0, "GET_INFO of an observer");
    CHECK(memcmp(&feeder, &observer, sizeof(feeder)) == 0, "they differ");
}

VM_TEST(info, status_names_the_best_instruction_set_of_the_cpu, 10)
{
    int fd = vm_open_feeder();
    const struct phantom_status* page = vm_map(fd);
    struct phantom_status status;
    uint32_t expected = cpu_has_avx2() ? PHANTOM_ISA_AVX2 : PHANTOM_ISA_SSE2;

    vm_plate_submit(fd, 1);
    vm_start(fd);
    vm_wait_ticks(page, 3);
    vm_status(page, &status);
    CHECK(status.abi_version == PHANTOM_ABI_VERSION, "abi_version %u", status.abi_version);
    CHECK(status.isa == expected, "isa %u, the CPU calls for %u", status.isa, expected);
    vm_figure("isa %u", status.isa);
}
