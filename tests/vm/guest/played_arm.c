// SPDX-License-Identifier: GPL-2.0-or-later
// The played arm: uhid's side, the firmware's side, and the arm's geometry.
#define _GNU_SOURCE
#include <errno.h>
#include <fcntl.h>
#include <linux/input.h>
#include <linux/uhid.h>
#include <math.h>
#include <poll.h>
#include <sched.h>
#include <stddef.h>
#include <string.h>
#include <time.h>
#include <unistd.h>

#include "device.h"
#include "harness.h"
#include "played_arm.h"

#define ARM_VENDOR 0x16c0
#define ARM_PRODUCT 0x0486
#define ARM_USAGE 0xffab0200u
#define ARM_REPORT 64
#define ARM_PERIOD_NS 1000000
/* Above the servo: real firmware has a processor of its own. */
#define FIRMWARE_PRIORITY 90

/* A Teensy with raw HID: 64 bytes each way, no report numbers. Usage page and usage are put in. */
static const uint8_t descriptor[] = {
    0x06, 0,    0,          /* usage page */
    0x0a, 0,    0,          /* usage */
    0xa1, 0x01,             /* collection (application) */
    0x75, 0x08,             /*   report size 8 */
    0x15, 0x00,             /*   logical minimum 0 */
    0x26, 0xff, 0x00,       /*   logical maximum 255 */
    0x95, 0x40, 0x09, 0x01, /*   report count 64, usage 1 */
    0x81, 0x02,             /*   input */
    0x95, 0x40, 0x09, 0x02, /*   report count 64, usage 2 */
    0x91, 0x02,             /*   output */
    0xc0,                   /* end */
};

static uint64_t pack(const int16_t word[3])
{
    return (uint64_t)(uint16_t)word[0] | (uint64_t)(uint16_t)word[1] << 16 |
           (uint64_t)(uint16_t)word[2] << 32;
}

static void unpack(uint64_t packed, int16_t word[3])
{
    for (int i = 0; i < 3; i++)
        word[i] = (int16_t)(packed >> (16 * i));
}

/* Word by word, without carries. */
static uint64_t subtract(uint64_t a, uint64_t b)
{
    int16_t from[3], less[3];

    unpack(a, from);
    unpack(b, less);
    for (int i = 0; i < 3; i++)
        from[i] = (int16_t)(from[i] - less[i]);
    return pack(from);
}

static uint64_t load(const uint64_t* word)
{
    return __atomic_load_n(word, __ATOMIC_ACQUIRE);
}

static void store(uint64_t* word, uint64_t value)
{
    __atomic_store_n(word, value, __ATOMIC_RELEASE);
}

static bool is_set(const uint32_t* flag)
{
    return __atomic_load_n(flag, __ATOMIC_ACQUIRE) != 0;
}

static void count(uint32_t* counter)
{
    __atomic_add_fetch(counter, 1, __ATOMIC_ACQ_REL);
}

/* ---- the firmware ---- */

static void report(struct vm_arm* arm)
{
    struct uhid_event event = {.type = UHID_INPUT2};
    int16_t encoder[3];

    unpack(subtract(load(&arm->pose), load(&arm->preset)), encoder);
    event.u.input2.size = ARM_REPORT;
    for (int i = 0; i < 3; i++) {
        event.u.input2.data[2 * i] = (uint8_t)encoder[i];
        event.u.input2.data[2 * i + 1] = (uint8_t)((uint16_t)encoder[i] >> 8);
    }
    if (write(arm->fd, &event, offsetof(struct uhid_event, u.input2.data) + ARM_REPORT) > 0)
        count(&arm->reports);
}

static void* report_for_ever(void* argument)
{
    struct vm_arm* arm = argument;
    struct sched_param priority = {.sched_priority = FIRMWARE_PRIORITY};
    struct timespec next;

    sched_setscheduler(0, SCHED_FIFO, &priority);
    count(&arm->awake);
    clock_gettime(CLOCK_MONOTONIC, &next);
    while (!is_set(&arm->leaving)) {
        next.tv_nsec += ARM_PERIOD_NS;
        if (next.tv_nsec >= (long)VM_NS_PER_S) {
            next.tv_nsec -= (long)VM_NS_PER_S;
            next.tv_sec++;
        }
        clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &next, NULL);
        if (!is_set(&arm->mute))
            report(arm);
    }
    return NULL;
}

static void obey(struct vm_arm* arm, const uint8_t* data)
{
    int16_t word[ARM_WORDS];

    for (int i = 0; i < ARM_WORDS; i++)
        word[i] = (int16_t)(data[2 * i] | data[2 * i + 1] << 8);
    if (word[ARM_COMMAND] == 1) {
        store(&arm->preset, subtract(load(&arm->pose), pack(word + ARM_ATTRIBUTE)));
        count(&arm->presets);
    }
    store(&arm->current, pack(word + ARM_CURRENT));
    if (pack(word + ARM_CURRENT))
        count(&arm->nonzero);
    count(&arm->commands);
}

/* uhid keeps 32 events and drops the rest: they are taken as they come. */
static void* listen_for_ever(void* argument)
{
    struct vm_arm* arm = argument;
    struct sched_param priority = {.sched_priority = FIRMWARE_PRIORITY + 1};
    struct uhid_event event;

    sched_setscheduler(0, SCHED_FIFO, &priority);
    count(&arm->awake);
    while (!is_set(&arm->leaving)) {
        struct pollfd wait = {.fd = arm->fd, .events = POLLIN};

        if (poll(&wait, 1, 10) <= 0 || read(arm->fd, &event, sizeof(event)) <= 0)
            continue;
        /* before the report stands its number, 0 */
        if (event.type == UHID_OUTPUT && event.u.output.size == 1 + ARM_REPORT)
            obey(arm, event.u.output.data + 1);
    }
    return NULL;
}

void vm_arm_plug(struct vm_arm* arm)
{
    struct uhid_event event = {.type = UHID_CREATE2};
    uint32_t usage = arm->usage ? arm->usage : ARM_USAGE;

    memset(arm, 0, sizeof(*arm));
    arm->fd = open("/dev/uhid", O_RDWR | O_CLOEXEC | O_NONBLOCK);
    CHECK(arm->fd >= 0, "open /dev/uhid: %s", strerror(errno));
    strcpy((char*)event.u.create2.name, "played arm");
    event.u.create2.bus = BUS_USB;
    event.u.create2.vendor = ARM_VENDOR;
    event.u.create2.product = ARM_PRODUCT;
    event.u.create2.rd_size = sizeof(descriptor);
    memcpy(event.u.create2.rd_data, descriptor, sizeof(descriptor));
    event.u.create2.rd_data[1] = (uint8_t)(usage >> 16);
    event.u.create2.rd_data[2] = (uint8_t)(usage >> 24);
    event.u.create2.rd_data[4] = (uint8_t)usage;
    event.u.create2.rd_data[5] = (uint8_t)(usage >> 8);
    CHECK(pthread_create(&arm->listener, NULL, listen_for_ever, arm) == 0, "pthread_create");
    CHECK(pthread_create(&arm->reporter, NULL, report_for_ever, arm) == 0, "pthread_create");
    /* The firmware runs before the cable is in: the first command must not wait for a thread to begin. */
    while (__atomic_load_n(&arm->awake, __ATOMIC_ACQUIRE) < 2)
        vm_sleep_ns(VM_NS_PER_MS / 10);
    CHECK(write(arm->fd, &event, sizeof(event)) == sizeof(event), "UHID_CREATE2: %s", strerror(errno));
}

void vm_arm_unplug(struct vm_arm* arm)
{
    const struct uhid_event event = {.type = UHID_DESTROY};

    /* the cable first: threads find out by themselves */
    CHECK(write(arm->fd, &event, sizeof(event)) == sizeof(event), "UHID_DESTROY: %s", strerror(errno));
    __atomic_store_n(&arm->leaving, 1, __ATOMIC_RELEASE);
    pthread_join(arm->reporter, NULL);
    pthread_join(arm->listener, NULL);
    close(arm->fd);
}

void vm_arm_move(struct vm_arm* arm, const int16_t encoder[3])
{
    int16_t none[3] = {0, 0, 0};

    /* pose = encoder + preset */
    store(&arm->pose, subtract(pack(encoder), subtract(pack(none), load(&arm->preset))));
}

void vm_arm_mute(struct vm_arm* arm, bool mute)
{
    __atomic_store_n(&arm->mute, mute, __ATOMIC_RELEASE);
}

void vm_arm_currents(const struct vm_arm* arm, int16_t current_ma[3])
{
    unpack(load(&arm->current), current_ma);
}

uint32_t vm_arm_commands(const struct vm_arm* arm)
{
    return __atomic_load_n(&arm->commands, __ATOMIC_ACQUIRE);
}

void vm_arm_wait_commands(const struct vm_arm* arm, uint32_t more)
{
    uint32_t begin = vm_arm_commands(arm);
    uint64_t end = vm_now_ns() + 5 * VM_NS_PER_S;

    while (vm_arm_commands(arm) - begin < more) {
        CHECK(vm_now_ns() < end, "%u commands came, waited for %u", vm_arm_commands(arm) - begin, more);
        vm_sleep_ns(VM_NS_PER_MS);
    }
}

/* ---- the arm ---- */

#define LN 80.0L
#define LB 205.0L
#define LC 245.0L
#define CAPSTAN 10.0L
#define COUNTS 2000.0L
#define NM_PER_MM 1e6L
#define NM_A 0.0259L /* N m / A */

static const long double body[3] = {160, 120, 120};
static const long double origin[3] = {220, 0, 80};

static long double angle(long double encoder, int joint)
{
    return encoder / COUNTS * CAPSTAN / body[joint] * 2 * M_PIl;
}

static void tip_mm(const long double a[3], long double tip[3])
{
    long double reach = LB * sinl(a[1]) + LC * sinl(a[2]);

    tip[0] = cosl(a[0]) * reach - origin[0];
    tip[1] = sinl(a[0]) * reach - origin[1];
    tip[2] = LN + LB * cosl(a[1]) - LC * cosl(a[2]) - origin[2];
}

void vm_arm_tip(const int16_t encoder[3], long double tip_nm[3])
{
    long double a[3], tip[3];

    for (int i = 0; i < 3; i++)
        a[i] = angle(encoder[i], i);
    tip_mm(a, tip);
    for (int i = 0; i < 3; i++)
        tip_nm[i] = tip[i] * NM_PER_MM;
}

bool vm_arm_reach(const long double tip_nm[3], int16_t encoder[3])
{
    long double p[3], reach, height, distance, a[3];

    for (int i = 0; i < 3; i++)
        p[i] = tip_nm[i] / NM_PER_MM + origin[i];
    reach = hypotl(p[0], p[1]);
    height = p[2] - LN;
    distance = hypotl(reach, height);
    if (distance > LB + LC || distance < LC - LB)
        return false;
    /* from the shoulder: upper arm at angle B from the vertical, the tip at angle `to` */
    a[1] = atan2l(reach, height) - acosl((LB * LB + distance * distance - LC * LC) / (2 * LB * distance));
    a[0] = atan2l(p[1], p[0]);
    a[2] = atan2l(reach - LB * sinl(a[1]), LB * cosl(a[1]) - height);
    for (int i = 0; i < 3; i++)
        encoder[i] = (int16_t)lroundl(a[i] / (2 * M_PIl) * body[i] / CAPSTAN * COUNTS);
    return true;
}

void vm_arm_expect(const int16_t encoder[3], const int32_t force_un[3], long double current_ma[3])
{
    const long double step = 1e-6L; /* rad */

    for (int joint = 0; joint < 3; joint++) {
        long double a[3], after[3], before[3], torque = 0; /* N m */

        for (int i = 0; i < 3; i++)
            a[i] = angle(encoder[i], i);
        a[joint] += step;
        tip_mm(a, after);
        a[joint] -= 2 * step;
        tip_mm(a, before);
        for (int i = 0; i < 3; i++)
            torque += (after[i] - before[i]) / (2 * step) * 1e-3L * force_un[i] * 1e-6L;
        current_ma[joint] = torque * CAPSTAN / body[joint] / NM_A * 1000;
    }
}
