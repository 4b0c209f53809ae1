// SPDX-License-Identifier: GPL-2.0-or-later
/*
 * rules.c - calls into the module from contexts that they are not for, below the C API that never does.
 */
#include <phantom_platform.h>

#include "clocks.h"
#include "phantom_chardev.h"
#include "phantom_context.h"
#include "phantom_servo.h"
#include "phantom_touch.h"
#include "rules.h"

static struct phantom_virtual_clock virtual_clock;
static struct phantom_servo servo;
static const struct phantom_float_ops* const sections[PHANTOM_ARITHS] = {[PHANTOM_ARITH_FLOAT] =
                                                                             &phantom_float_sse2};

static void make_servo(void)
{
    struct phantom_device* device = phantom_device_sim_create(1000000);

    phantom_virtual_clock_init(&virtual_clock);
    if (IS_ERR(device) ||
        phantom_servo_init(&servo, &virtual_clock.clock, device, sections, PHANTOM_PATCHES_MAX))
        phantom_platform_broken("a servo can be made", __func__);
}

static void destroy_servo(void)
{
    struct phantom_device* device = servo.device;

    phantom_platform_wait_destroy(&servo.wait);
    phantom_servo_destroy(&servo);
    phantom_virtual_clock_destroy(&virtual_clock);
    device->ops->destroy(device);
}

int rules_kept(void)
{
    const struct phantom_start start = {.stale_ms = 1000};
    int error;

    make_servo();
    mutex_lock(&servo.control);
    error = phantom_servo_set_rate(&servo, 2000);
    error = error ? error : phantom_servo_start(&servo, &start);
    mutex_unlock(&servo.control);
    phantom_virtual_clock_step(&virtual_clock, 3);
    mutex_lock(&servo.control);
    phantom_servo_stop(&servo, PHANTOM_WISH_STOP);
    mutex_unlock(&servo.control);
    destroy_servo();
    return error;
}

void rules_break_control(void)
{
    make_servo();
    phantom_servo_set_rate(&servo, 2000);
}

static void* hold_control(void* unused)
{
    (void)unused;
    mutex_lock(&servo.control);
    return NULL;
}

void rules_break_control_held_by_another(void)
{
    pthread_t other;

    make_servo();
    pthread_create(&other, NULL, hold_control, NULL);
    pthread_join(other, NULL);
    phantom_servo_stop(&servo, PHANTOM_WISH_STOP);
}

void rules_break_submitter(void)
{
    make_servo();
    mutex_lock(&servo.control);
    phantom_set_forget(&servo.sets);
}

void rules_break_file(void)
{
    struct phantom_chardev chardev;

    make_servo();
    phantom_chardev_init(&chardev, &servo);
    mutex_lock(&servo.control);
    phantom_chardev_open(&chardev, false);
}

void rules_break_servo(void)
{
    make_servo();
    phantom_servo_step(&servo);
}

void rules_break_servo_with_control(void)
{
    make_servo();
    mutex_lock(&servo.control);
    phantom_servo_run(&servo);
}

/* Not even with the mutex while another thread is the servo. */
static void* become_servo(void* unused)
{
    (void)unused;
    phantom_servo_enter(&servo);
    return NULL;
}

void rules_break_run(void)
{
    pthread_t other;

    make_servo();
    pthread_create(&other, NULL, become_servo, NULL);
    pthread_join(other, NULL);
    mutex_lock(&servo.control);
    phantom_touch_forget(&servo);
}

void rules_break_section(void)
{
    phantom_context_section();
}

void rules_break_sleep_in_section(void)
{
    struct phantom_file file = {.chardev = NULL};
    struct phantom_chardev chardev;

    make_servo();
    phantom_chardev_init(&chardev, &servo);
    file.chardev = &chardev;
    kernel_fpu_begin();
    phantom_chardev_ioctl(&file, PHANTOM_GET_INFO, NULL);
}

void rules_break_nested_section(void)
{
    kernel_fpu_begin();
    kernel_fpu_begin();
}

void rules_break_section_opened_in_section(void)
{
    make_servo();
    phantom_servo_enter(&servo);
    kernel_fpu_begin();
    phantom_servo_step(&servo);
}
