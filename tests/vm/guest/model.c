// SPDX-License-Identifier: GPL-2.0-or-later
// SET_MODEL: every value of every field.
#include <errno.h>
#include <stddef.h>
#include <string.h>

#include "device.h"
#include "harness.h"

static uint64_t features_of(int fd)
{
    struct phantom_info info;

    vm_expect(fd, PHANTOM_GET_INFO, &info, 0, "GET_INFO");
    return info.features;
}

static int offered(uint64_t features, uint64_t feature)
{
    return features & feature ? 0 : -EOPNOTSUPP;
}

/* The field takes value 0 ... 40 and a few huge ones; expected[] says 0 or -errno for the first ones. */
static void try_field(int fd, size_t offset, const int* expected, unsigned int count, const char* what)
{
    static const uint32_t huge[] = {0x7fffffff, 0x80000000, 0xffffffff};

    for (unsigned int i = 0; i < 40 + 3; i++) {
        struct phantom_model model = {.model = PHANTOM_MODEL_PROJECTED, .proxy = PHANTOM_PROXY_PAPER};
        uint32_t value = i < 40 ? i : huge[i - 40];
        int wanted = value < count ? expected[value] : -EINVAL;
        int rc;

        memcpy((char*)&model + offset, &value, sizeof(value));
        rc = vm_ioctl(fd, PHANTOM_SET_MODEL, &model);
        CHECK(rc == wanted, "%s = %u gave %s, not %s", what, value, vm_error_name(rc), vm_error_name(wanted));
    }
}

VM_TEST(model, every_value_of_every_field, 10)
{
    int fd = vm_open_feeder();
    uint64_t features = features_of(fd);
    const int models[] = {0, offered(features, PHANTOM_FEATURE_MODEL_PAPER),
                          offered(features, PHANTOM_FEATURE_MODEL_PROJECTED)};
    const int steps[] = {0, 0, 0, 0};
    const int combines[] = {0, 0};
    const int proxies[] = {0, offered(features, PHANTOM_FEATURE_PROXY_PAPER),
                           offered(features, PHANTOM_FEATURE_PROXY_CONSTRAINED)};
    const int ariths[] = {offered(features, PHANTOM_FEATURE_ARITH_FLOAT),
                          offered(features, PHANTOM_FEATURE_ARITH_FIXED),
                          offered(features, PHANTOM_FEATURE_ARITH_DOUBLE)};

    try_field(fd, offsetof(struct phantom_model, model), models, 3, "model");
    try_field(fd, offsetof(struct phantom_model, newton_steps), steps, 4, "newton_steps");
    try_field(fd, offsetof(struct phantom_model, combine), combines, 2, "combine");
    try_field(fd, offsetof(struct phantom_model, proxy), proxies, 3, "proxy");
    try_field(fd, offsetof(struct phantom_model, arith), ariths, 3, "arith");
}

VM_TEST(model, reserved_bits_are_refused, 10)
{
    int fd = vm_open_feeder();

    for (int word = 0; word < 3; word++)
        for (int bit = 0; bit < 32; bit++) {
            struct phantom_model model = {.model = PHANTOM_MODEL_PROJECTED};

            model.reserved[word] = 1u << bit;
            vm_expect(fd, PHANTOM_SET_MODEL, &model, -EINVAL, "SET_MODEL with a reserved bit");
        }
}

VM_TEST(model, a_refused_model_changes_nothing, 10)
{
    int fd = vm_open_feeder();
    const struct phantom_status* page = vm_map(fd);
    const struct phantom_model wrong = {.model = PHANTOM_MODEL_PAPER, .combine = 7};
    struct phantom_status before, after;

    vm_touch(fd, page);
    vm_status(page, &before);
    vm_expect(fd, PHANTOM_SET_MODEL, &wrong, -EINVAL, "SET_MODEL combine 7");
    vm_wait_ticks(page, before.tick + 50);
    vm_status(page, &after);
    CHECK(memcmp(&before.model, &after.model, sizeof(before.model)) == 0, "the page's model changed");
    CHECK(memcmp(before.force_un, after.force_un, sizeof(before.force_un)) == 0, "the force changed");
}

VM_TEST(model, off_gives_zero_force_through_a_fade, 10)
{
    int fd = vm_open_feeder();
    const struct phantom_status* page = vm_map(fd);
    const struct phantom_model off = {.model = PHANTOM_MODEL_OFF};
    struct phantom_status status;

    vm_touch(fd, page);
    vm_status(page, &status);
    vm_expect(fd, PHANTOM_SET_MODEL, &off, 0, "SET_MODEL off");
    vm_wait_ticks(page, status.tick + 5);
    vm_status(page, &status);
    CHECK(status.flags & PHANTOM_TICK_FADING, "no fade: flags %#x", status.flags);
    vm_wait_ticks(page, status.tick + 50);
    vm_status(page, &status);
    CHECK(vm_force_size(status.force_un) == 0, "force %d uN with the model off", status.force_un[2]);
    CHECK(status.model.model == PHANTOM_MODEL_OFF, "the page says model %u", status.model.model);
}
