// SPDX-License-Identifier: GPL-2.0-or-later
// The played link, and the servo behind it.
#include <phantom_platform.h>

#include "arm_machine.h"
#include "clocks.h"
#include "device/arm.h"
#include "phantom_chardev.h"

struct arm_machine {
    struct phantom_arm arm;
    struct phantom_virtual_clock clock;
    struct phantom_servo servo;
    struct phantom_chardev chardev;
    struct phantom_file* file;
    s16 encoder[3];
    bool mute, deaf;
    int send_error;
    u8 command[ARM_COMMAND_BYTES];
    u64 later_ns; /* beside the clock, for drive() */
    int fail_once;
};

static struct arm_machine* machine_of(struct phantom_arm* arm)
{
    return container_of(arm, struct arm_machine, arm);
}

/* ---- the link ---- */

static u64 link_now(struct phantom_arm* arm)
{
    struct arm_machine* machine = machine_of(arm);

    return machine->clock.clock.ops->now_ns(&machine->clock.clock) + machine->later_ns;
}

/* Commands are sent when the machine is stepped, or waited for. */
static void link_kick(struct phantom_arm* arm) {}

static int link_flush(struct phantom_arm* arm)
{
    struct arm_machine* machine = machine_of(arm);

    if (machine->deaf)
        return -ETIMEDOUT;
    if (machine->fail_once) {
        phantom_arm_command(arm, machine->command);
        phantom_arm_sent(arm, machine->fail_once);
        machine->fail_once = 0;
    }
    phantom_arm_command(arm, machine->command);
    phantom_arm_sent(arm, machine->send_error);
    return machine->send_error;
}

static void report(struct arm_machine* machine)
{
    u8 bytes[PHANTOM_ARM_REPORT_BYTES] = {0};

    for (int i = 0; i < 3; i++) {
        bytes[2 * i] = (u8)machine->encoder[i];
        bytes[2 * i + 1] = (u8)((u16)machine->encoder[i] >> 8);
    }
    phantom_arm_receive(&machine->arm, bytes, sizeof(bytes));
}

static int link_listen(struct phantom_arm* arm)
{
    struct arm_machine* machine = machine_of(arm);

    if (machine->mute)
        return -ETIMEDOUT;
    report(machine);
    return 0;
}

static void link_destroy(struct phantom_arm* arm) {}

static const struct phantom_arm_link_ops link_ops = {
    .now_ns = link_now,
    .kick = link_kick,
    .flush = link_flush,
    .listen = link_listen,
    .destroy = link_destroy,
};

/* ---- the machine ---- */

static const struct phantom_float_ops* const sections[PHANTOM_ARITHS] = {[PHANTOM_ARITH_FLOAT] =
                                                                             &phantom_float_sse2};

struct arm_machine* arm_machine_create(uint32_t max_force_un)
{
    struct arm_machine* machine = kzalloc(sizeof(*machine), GFP_KERNEL);

    if (!machine)
        return NULL;
    phantom_virtual_clock_init(&machine->clock);
    phantom_arm_init(&machine->arm, &phantom_arm_woodenhaptics, &link_ops, max_force_un);
    if (phantom_servo_init(&machine->servo, &machine->clock.clock, &machine->arm.device, sections,
                           PHANTOM_PATCHES_MAX)) {
        kfree(machine);
        return NULL;
    }
    phantom_chardev_init(&machine->chardev, &machine->servo);
    machine->file = phantom_chardev_open(&machine->chardev, true);
    return machine;
}

void arm_machine_destroy(struct arm_machine* machine)
{
    phantom_chardev_release(machine->file);
    phantom_platform_wait_destroy(&machine->servo.wait);
    phantom_servo_destroy(&machine->servo);
    phantom_virtual_clock_destroy(&machine->clock);
    kfree(machine);
}

void arm_machine_move(struct arm_machine* machine, const int16_t encoder[3])
{
    memcpy(machine->encoder, encoder, sizeof(machine->encoder));
}

void arm_machine_mute(struct arm_machine* machine, int mute)
{
    machine->mute = mute;
}

void arm_machine_deafen(struct arm_machine* machine, int deaf, int error)
{
    machine->deaf = deaf;
    machine->send_error = error;
}

void arm_machine_fail_once(struct arm_machine* machine, int error)
{
    machine->fail_once = error;
}

int arm_machine_receive(struct arm_machine* machine, const uint8_t* bytes, size_t size)
{
    return phantom_arm_receive(&machine->arm, bytes, size);
}

void arm_machine_command(struct arm_machine* machine, uint8_t command[ARM_COMMAND_BYTES])
{
    if (phantom_arm_has_command(&machine->arm))
        phantom_arm_command(&machine->arm, machine->command);
    memcpy(command, machine->command, sizeof(machine->command));
}

void arm_machine_currents(struct arm_machine* machine, int16_t current_ma[3])
{
    u8 command[ARM_COMMAND_BYTES];

    arm_machine_command(machine, command);
    for (int i = 0; i < 3; i++)
        current_ma[i] = (s16)(command[2 * i] | command[2 * i + 1] << 8);
}

void arm_machine_unplug(struct arm_machine* machine)
{
    phantom_arm_unplug(&machine->arm);
    phantom_chardev_unplug(&machine->chardev);
}

int arm_machine_ioctl(struct arm_machine* machine, unsigned long request, void* argument)
{
    return (int)phantom_chardev_ioctl(machine->file, (unsigned int)request, argument);
}

ssize_t arm_machine_read(struct arm_machine* machine, void* buffer, size_t size)
{
    return phantom_chardev_read(machine->file, buffer, size, true);
}

int arm_machine_poll(struct arm_machine* machine)
{
    return (int)phantom_chardev_poll(machine->file);
}

int arm_machine_open_again(struct arm_machine* machine)
{
    struct phantom_file* file = phantom_chardev_open(&machine->chardev, false);

    if (IS_ERR(file))
        return (int)PTR_ERR(file);
    phantom_chardev_release(file);
    return 0;
}

int arm_machine_check_mmap(struct arm_machine* machine)
{
    return phantom_chardev_check_mmap(machine->file, false, 0, phantom_stats_page_size());
}

int arm_machine_calibrate(struct arm_machine* machine)
{
    return phantom_chardev_calibrate(&machine->chardev);
}

int arm_machine_step(struct arm_machine* machine, uint32_t ticks)
{
    int done = 0;

    for (uint32_t i = 0; i < ticks; i++) {
        int ran;

        if (!machine->mute)
            report(machine);
        ran = phantom_virtual_clock_step(&machine->clock, 1);
        if (ran <= 0)
            break;
        done += ran;
        if (!machine->deaf && phantom_arm_has_command(&machine->arm)) {
            phantom_arm_command(&machine->arm, machine->command);
            phantom_arm_sent(&machine->arm, machine->send_error);
        }
    }
    return done;
}

const struct phantom_status* arm_machine_status(const struct arm_machine* machine)
{
    return machine->servo.stats.page;
}

int arm_machine_drive(struct arm_machine* machine, const int32_t current_ma[3], uint64_t later_ns)
{
    static const s32 some[3] = {0, 0, 1};

    machine->later_ns += later_ns;
    phantom_arm_sent(&machine->arm, 0);
    memcpy(machine->arm.linkage.current_ma, current_ma, sizeof(machine->arm.linkage.current_ma));
    return machine->arm.device.ops->write(&machine->arm.device, some);
}

void arm_machine_drive_zero(struct arm_machine* machine)
{
    static const s32 zero[3];

    machine->arm.device.ops->write(&machine->arm.device, zero);
}

/* ---- the linkage ---- */

void arm_pose(const int32_t encoder[3], int32_t tip_nm[3])
{
    struct phantom_linkage linkage = {.geometry = &phantom_arm_woodenhaptics.geometry};

    memcpy(linkage.encoder, encoder, sizeof(linkage.encoder));
    phantom_linkage_three_joint.pose(&linkage);
    memcpy(tip_nm, linkage.tip_nm, sizeof(linkage.tip_nm));
}

void arm_drive(const int32_t encoder[3], const int32_t force_un[3], int32_t current_ma[3])
{
    struct phantom_linkage linkage = {.geometry = &phantom_arm_woodenhaptics.geometry};

    memcpy(linkage.encoder, encoder, sizeof(linkage.encoder));
    memcpy(linkage.force_un, force_un, sizeof(linkage.force_un));
    phantom_linkage_three_joint.drive(&linkage);
    memcpy(current_ma, linkage.current_ma, sizeof(linkage.current_ma));
}
