// SPDX-License-Identifier: GPL-2.0-or-later
// device=hid with a played arm: plugged in, touched, unplugged at every moment. Each test loads and unloads
// the module.
#define _GNU_SOURCE
#include <dirent.h>
#include <errno.h>
#include <fcntl.h>
#include <math.h>
#include <poll.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

#include "device.h"
#include "harness.h"
#include "module.h"
#include "played_arm.h"

#define SYSFS "/sys/class/phantom_rt/phantom_rt0/"
#define PATIENCE_NS (3 * VM_NS_PER_S)

/* Where the tests touch the plate: 1 mm above a triangle near its middle, as nearly as encoders allow. */
static const long double touch_nm[3] = {2000000, 3000000, 1000000};

static void load(const char* more)
{
    char parameters[100];
    int rc;

    if (access("/dev/uhid", F_OK) < 0)
        vm_skip("no /dev/uhid");
    vm_module_unload(); /* of a test that failed */
    snprintf(parameters, sizeof(parameters), "device=hid %s", more);
    rc = vm_module_load(parameters);
    CHECK(rc == 0, "insmod device=hid: %s", vm_error_name(rc));
}

static void unload(void)
{
    int rc = vm_module_unload();

    CHECK(rc == 0, "rmmod: %s", vm_error_name(rc));
}

static void wait_node(const char* node, bool there)
{
    uint64_t end = vm_now_ns() + PATIENCE_NS;

    while ((access(node, F_OK) == 0) != there) {
        CHECK(vm_now_ns() < end, "%s is %sthere", node, there ? "not " : "");
        vm_sleep_ns(VM_NS_PER_MS);
    }
}

static void plug(struct vm_arm* arm)
{
    memset(arm, 0, sizeof(*arm));
    vm_arm_plug(arm);
    wait_node(PHANTOM_DEVICE_NODE, true);
}

static void expect_attribute(const char* name, const char* expected)
{
    char path[100], text[100];

    snprintf(path, sizeof(path), SYSFS "%s", name);
    vm_read_file(path, text, sizeof(text));
    text[strcspn(text, "\n")] = 0;
    CHECK(strcmp(text, expected) == 0, "%s is \"%s\", not \"%s\"", name, text, expected);
}

static void expect_no_current(const struct vm_arm* arm, const char* when)
{
    int16_t current[3];

    vm_arm_currents(arm, current);
    CHECK(!current[0] && !current[1] && !current[2], "%d %d %d mA %s", current[0], current[1], current[2],
          when);
}

/* Moves the tip there at a hand's speed (0.25 m/s or so), so that nothing takes it for a glitch. */
static void go(struct vm_arm* arm, int16_t from[3], const int16_t to[3])
{
    for (bool there = false; !there;) {
        there = true;
        for (int i = 0; i < 3; i++) {
            int left = to[i] - from[i];

            from[i] = (int16_t)(from[i] + (abs(left) > 4 ? (left > 0 ? 4 : -4) : left));
            there = there && from[i] == to[i];
        }
        vm_arm_move(arm, from);
        vm_sleep_ns(VM_NS_PER_MS);
    }
    vm_sleep_ns(5 * VM_NS_PER_MS);
}

/* Closes the feeder and lets go of the page: a mapping keeps its file. */
static void leave(int fd, const struct phantom_status* page)
{
    CHECK(munmap((void*)(uintptr_t)page, vm_status_size(fd)) == 0 && close(fd) == 0, "close");
}

/* Feeder in contact with the plate at touch_nm, full force reached; the counts it rests at. */
static int touch(struct vm_arm* arm, const struct phantom_status** page, int16_t at[3])
{
    int fd = vm_open_feeder();
    struct phantom_status status;
    uint64_t end = vm_now_ns() + PATIENCE_NS;

    *page = vm_map(fd);
    vm_plate_submit(fd, 1);
    CHECK(vm_arm_reach(touch_nm, at), "out of reach");
    vm_arm_move(arm, at);
    vm_start(fd);
    do {
        CHECK(vm_now_ns() < end, "no full force");
        vm_sleep_ns(VM_NS_PER_MS);
        vm_status(*page, &status);
        CHECK(status.faults == 0, "faults %#x in plain contact", status.faults);
    } while (!status.contacts || (status.flags & (PHANTOM_TICK_RAMPING | PHANTOM_TICK_FADING)));
    return fd;
}

VM_TEST(hid, plugged_arm_gets_a_node_and_says_what_it_is, 20)
{
    struct vm_arm arm;
    struct phantom_info info = {0};
    const struct phantom_sim_move move = {0};
    const struct phantom_start unlimited = {.flags = PHANTOM_START_LIMITS_OFF};
    char version[20];
    struct stat node;
    int fd;

    load("rate_hz=2000");
    CHECK(access(PHANTOM_DEVICE_NODE, F_OK) < 0, "a node without an arm");
    plug(&arm);
    CHECK(stat(PHANTOM_DEVICE_NODE, &node) == 0 && (node.st_mode & 0777) == 0660, "mode %o",
          node.st_mode & 0777);
    snprintf(version, sizeof(version), "%d", PHANTOM_ABI_VERSION);
    expect_attribute("kind", "hid");
    expect_attribute("model", "woodenhaptics");
    expect_attribute("abi_version", version);
    expect_attribute("rate_hz", "2000");
    expect_attribute("max_force_mn", "5000");
    expect_attribute("continuous_force_mn", "4300");
    expect_attribute("state", "idle");
    expect_attribute("faults", "none");
    fd = vm_open(O_RDWR);
    vm_expect(fd, PHANTOM_GET_INFO, &info, 0, "GET_INFO");
    CHECK(info.device == PHANTOM_DEVICE_HID && info.max_force_un == 5000000 && info.device_rate_hz == 1000 &&
              info.resolution_nm == 64141,
          "device %u, %u uN, %u Hz, %u nm", info.device, info.max_force_un, info.device_rate_hz,
          info.resolution_nm);
    vm_expect(fd, PHANTOM_SIM_MOVE, &move, -EOPNOTSUPP, "SIM_MOVE");
    vm_expect(fd, PHANTOM_START, &unlimited, -EPERM, "START without limits");
    close(fd);
    CHECK(arm.presets == 1, "%u presets", arm.presets);
    vm_arm_unplug(&arm);
    wait_node(PHANTOM_DEVICE_NODE, false);
    unload();
}

VM_TEST(hid, parameter_lowers_what_the_arm_may_be_asked_for, 20)
{
    struct vm_arm arm;
    const struct phantom_start more = {.max_force_un = 2000001};

    load("max_force_mn=2000");
    plug(&arm);
    expect_attribute("max_force_mn", "2000");
    vm_expect(vm_open(O_RDWR), PHANTOM_START, &more, -EINVAL, "START with more");
}

VM_TEST(hid, tip_follows_the_encoders, 30)
{
    struct vm_arm arm;
    const struct phantom_status* page;
    struct phantom_status status;
    uint64_t random = vm_seed();
    int16_t at[3] = {0, 0, 6000};
    int fd;

    load("");
    plug(&arm);
    fd = vm_open_feeder();
    page = vm_map(fd);
    vm_start(fd);
    for (int i = 0; i < 8; i++) {
        long double wanted[3], expected[3];
        int16_t to[3];

        for (int axis = 0; axis < 3; axis++)
            wanted[axis] = (long double)vm_random_below(&random, 100000000) - 50000000;
        CHECK(vm_arm_reach(wanted, to), "out of reach");
        go(&arm, at, to);
        vm_status(page, &status);
        vm_arm_tip(to, expected);
        CHECK(status.faults == 0, "faults %#x", status.faults);
        for (int axis = 0; axis < 3; axis++) {
            CHECK(fabsl(status.tip_nm[axis] - expected[axis]) <= 0.51L, "axis %d: %lld nm, not %.1Lf", axis,
                  (long long)status.tip_nm[axis], expected[axis]);
            CHECK(fabsl(expected[axis] - wanted[axis]) < 100000, "axis %d: %.0Lf nm for %.0Lf", axis,
                  expected[axis], wanted[axis]);
        }
    }
    leave(fd, page);
    vm_arm_unplug(&arm);
    wait_node(PHANTOM_DEVICE_NODE, false);
    unload();
}

VM_TEST(hid, contact_gives_the_currents_of_its_force, 20)
{
    struct vm_arm arm;
    const struct phantom_status* page;
    struct phantom_status status;
    long double tip[3], expected[3];
    int16_t at[3], current[3];
    int fd;

    load("");
    plug(&arm);
    fd = touch(&arm, &page, at);
    vm_arm_tip(at, tip);
    vm_arm_wait_commands(&arm, 3);
    vm_status(page, &status);
    vm_arm_currents(&arm, current);
    CHECK(labs(status.force_un[2] - (long)vm_plate_force(llroundl(tip[2]))) < 50, "%d uN, not %lld",
          status.force_un[2], (long long)vm_plate_force(llroundl(tip[2])));
    vm_arm_expect(at, status.force_un, expected);
    for (int i = 0; i < 3; i++)
        CHECK(fabsl(current[i] - expected[i]) <= 0.51L, "motor %d: %d mA, not %.3Lf", i, current[i],
              expected[i]);
    CHECK(abs(current[1]) > 100 && abs(current[2]) > 100, "%d %d %d mA at 1 N", current[0], current[1],
          current[2]);
    vm_figure("%d %d %d mA at %d uN", current[0], current[1], current[2], status.force_un[2]);
    vm_expect(fd, PHANTOM_STOP, NULL, 0, "STOP");
    expect_no_current(&arm, "after STOP");
    vm_start(fd);
    vm_wait_ticks(page, 400);
    vm_arm_currents(&arm, current);
    CHECK(current[2] != 0, "no force in the second run");
    leave(fd, page);
    expect_no_current(&arm, "after close");
    vm_arm_unplug(&arm);
    wait_node(PHANTOM_DEVICE_NODE, false);
}

static void expect_gone(int fd)
{
    static const struct {
        unsigned long request;
        size_t size;
        const char* name;
    } calls[] = {
        {PHANTOM_GET_INFO, sizeof(struct phantom_info), "GET_INFO"},
        {PHANTOM_SET_RATE, sizeof(struct phantom_rate), "SET_RATE"},
        {PHANTOM_SET_MODEL, sizeof(struct phantom_model), "SET_MODEL"},
        {PHANTOM_START, sizeof(struct phantom_start), "START"},
        {PHANTOM_STOP, 0, "STOP"},
        {PHANTOM_SUBMIT_SET, sizeof(struct phantom_set), "SUBMIT_SET"},
        {PHANTOM_SIM_MOVE, sizeof(struct phantom_sim_move), "SIM_MOVE"},
        {PHANTOM_CLEAR_FAULT, 0, "CLEAR_FAULT"},
    };
    static char argument[4096];
    struct phantom_tick record = {.faults = PHANTOM_FAULT_UNPLUGGED};
    struct pollfd poll_fd = {.fd = fd, .events = POLLIN | POLLPRI};
    ssize_t got;

    for (size_t i = 0; i < sizeof(calls) / sizeof(calls[0]); i++) {
        memset(argument, 0, sizeof(argument));
        vm_expect(fd, calls[i].request, argument, -ENODEV, calls[i].name);
    }
    CHECK(poll(&poll_fd, 1, 0) == 1 && (poll_fd.revents & (POLLHUP | POLLERR)) == (POLLHUP | POLLERR),
          "poll gave %#x", poll_fd.revents);
    while ((got = read(fd, &record, sizeof(record))) == sizeof(record))
        ;
    CHECK(got < 0 && errno == ENODEV, "read gave %zd, %s", got, vm_error_name(errno));
    CHECK(vm_force_size(record.force_un) == 0 && (record.faults & PHANTOM_FAULT_UNPLUGGED),
          "the last record: %d uN, faults %#x", record.force_un[2], record.faults);
}

VM_TEST(hid, unplugged_in_contact_is_a_fault_and_nothing_worse, 30)
{
    struct vm_arm arm, again;
    const struct phantom_status* page;
    struct phantom_status status;
    int16_t at[3];
    int fd, rc;

    load("");
    plug(&arm);
    fd = touch(&arm, &page, at);
    vm_arm_unplug(&arm);
    wait_node(PHANTOM_DEVICE_NODE, false);
    vm_wait_state(page, PHANTOM_STATE_FAULT);
    vm_sleep_ns(5 * VM_NS_PER_MS);
    vm_status(page, &status);
    CHECK(status.faults & PHANTOM_FAULT_UNPLUGGED, "faults %#x", status.faults);
    CHECK(vm_force_size(status.force_un) == 0, "%d uN", status.force_un[2]);
    expect_gone(fd);
    rc = vm_module_unload();
    CHECK(rc == -EWOULDBLOCK, "rmmod under an open file gave %s", vm_error_name(rc));
    /* plugged in again it is another device, as long as the old one is held */
    memset(&again, 0, sizeof(again));
    vm_arm_plug(&again);
    wait_node("/dev/phantom_rt1", true);
    CHECK(access(PHANTOM_DEVICE_NODE, F_OK) < 0, "two devices with one name");
    expect_gone(fd);
    close(fd);
    CHECK(page->state == PHANTOM_STATE_FAULT && page->faults == PHANTOM_FAULT_UNPLUGGED,
          "the page shows %u, %#x", page->state, page->faults);
    vm_arm_unplug(&again);
    wait_node("/dev/phantom_rt1", false);
}

VM_TEST(hid, driver_taken_away_in_contact_switches_the_motors_off, 20)
{
    static const char folder[] = "/sys/bus/hid/drivers/phantom_rt/";
    struct vm_arm arm;
    const struct phantom_status* page;
    struct dirent* entry;
    int16_t at[3], current[3];
    int unbind;
    DIR* drivers;

    load("");
    plug(&arm);
    touch(&arm, &page, at);
    vm_arm_wait_commands(&arm, 3);
    vm_arm_currents(&arm, current);
    CHECK(current[2] != 0, "no force");
    drivers = opendir(folder);
    CHECK(drivers, "no %s", folder);
    while ((entry = readdir(drivers)) && !strstr(entry->d_name, "16C0"))
        ;
    CHECK(entry, "the arm is not bound");
    unbind = openat(dirfd(drivers), "unbind", O_WRONLY);
    CHECK(write(unbind, entry->d_name, strlen(entry->d_name)) > 0, "unbind: %s", strerror(errno));
    /* the cable is still in: its last command must have been the one */
    vm_sleep_ns(2 * VM_NS_PER_MS);
    expect_no_current(&arm, "after unbind");
    CHECK(page->faults == PHANTOM_FAULT_UNPLUGGED, "faults %#x", page->faults);
    CHECK(access(PHANTOM_DEVICE_NODE, F_OK) < 0, "the node is there");
}

VM_TEST(hid, first_number_is_free_again_after_the_last_close, 20)
{
    struct vm_arm arm;

    /* the module of the tests before stays: it could not go while its page was mapped */
    if (!vm_module_is_loaded())
        load("");
    plug(&arm);
    vm_arm_unplug(&arm);
    wait_node(PHANTOM_DEVICE_NODE, false);
    unload();
}

VM_TEST(hid, silent_arm_is_a_fault_and_may_come_back, 30)
{
    struct vm_arm arm;
    const struct phantom_status* page;
    struct phantom_status status;
    int16_t at[3], current[3];
    uint64_t begin;
    int fd;

    load("");
    plug(&arm);
    fd = touch(&arm, &page, at);
    vm_arm_mute(&arm, true);
    begin = vm_now_ns();
    vm_wait_state(page, PHANTOM_STATE_FAULT);
    vm_sleep_ns(2 * VM_NS_PER_MS);
    vm_status(page, &status);
    CHECK(vm_now_ns() - begin < 15 * VM_NS_PER_MS, "noticed after %llu us",
          (unsigned long long)(vm_now_ns() - begin) / 1000);
    CHECK(status.faults == PHANTOM_FAULT_DEVICE && vm_force_size(status.force_un) == 0, "faults %#x, %d uN",
          status.faults, status.force_un[2]);
    expect_no_current(&arm, "while silent");
    expect_attribute("faults", "device");
    vm_expect(fd, PHANTOM_CLEAR_FAULT, NULL, -EAGAIN, "CLEAR_FAULT while silent");
    vm_arm_mute(&arm, false);
    vm_sleep_ns(5 * VM_NS_PER_MS);
    vm_expect(fd, PHANTOM_CLEAR_FAULT, NULL, 0, "CLEAR_FAULT");
    vm_wait_state(page, PHANTOM_STATE_RUNNING);
    vm_sleep_ns(300 * VM_NS_PER_MS);
    vm_arm_currents(&arm, current);
    CHECK(current[2] != 0, "no force after CLEAR_FAULT");
    vm_expect(fd, PHANTOM_STOP, NULL, 0, "STOP");
    /* nor does a silent one start */
    vm_arm_mute(&arm, true);
    vm_sleep_ns(5 * VM_NS_PER_MS);
    vm_expect(fd, PHANTOM_START, &(struct phantom_start){0}, -ETIMEDOUT, "START of a silent arm");
    CHECK(vm_state(page) == PHANTOM_STATE_IDLE, "state %u", vm_state(page));
}

VM_TEST(hid, encoder_that_jumps_is_an_overspeed, 20)
{
    struct vm_arm arm;
    const struct phantom_status* page;
    int16_t at[3];

    load("");
    plug(&arm);
    touch(&arm, &page, at);
    at[1] = (int16_t)(at[1] + 4000); /* 60 degrees in a millisecond */
    vm_arm_move(&arm, at);
    vm_wait_state(page, PHANTOM_STATE_FAULT);
    vm_sleep_ns(5 * VM_NS_PER_MS);
    CHECK(page->faults == PHANTOM_FAULT_OVERSPEED, "faults %#x", page->faults);
    expect_no_current(&arm, "after a jump");
}

VM_TEST(hid, calibration_is_for_an_arm_at_rest, 20)
{
    static const int16_t turned[3] = {1234, -567, 2000};
    struct vm_arm arm;
    const struct phantom_status* page;
    struct phantom_status status;
    int calibrate, fd;

    load("");
    plug(&arm);
    vm_arm_move(&arm, turned);
    calibrate = open(SYSFS "calibrate", O_WRONLY);
    CHECK(calibrate >= 0, "open calibrate: %s", strerror(errno));
    CHECK(write(calibrate, "0", 1) < 0 && errno == EINVAL, "calibrate 0");
    CHECK(write(calibrate, "1", 1) == 1, "calibrate: %s", strerror(errno));
    fd = vm_open_feeder();
    page = vm_map(fd);
    vm_start(fd);
    vm_wait_ticks(page, 5);
    vm_status(page, &status);
    CHECK(status.tip_nm[0] == 25000000 && status.tip_nm[1] == 0 && status.tip_nm[2] == 205000000,
          "tip %lld %lld %lld", (long long)status.tip_nm[0], (long long)status.tip_nm[1],
          (long long)status.tip_nm[2]);
    CHECK(write(calibrate, "1", 1) < 0 && errno == EBUSY, "calibrate of a running arm");
    CHECK(arm.presets == 2, "%u presets", arm.presets);
}

VM_TEST(hid, runs_at_one_khz_for_two_seconds, 30)
{
    struct vm_arm arm;
    const struct phantom_status* page;
    struct phantom_status before, after;
    uint32_t commands, reports;
    int16_t at[3];

    load("");
    plug(&arm);
    touch(&arm, &page, at);
    vm_status(page, &before);
    commands = vm_arm_commands(&arm);
    reports = __atomic_load_n(&arm.reports, __ATOMIC_RELAXED);
    vm_sleep_ns(2 * VM_NS_PER_S);
    commands = vm_arm_commands(&arm) - commands;
    reports = __atomic_load_n(&arm.reports, __ATOMIC_RELAXED) - reports;
    vm_status(page, &after);
    CHECK(after.missed == 0 && after.faults == 0, "%llu missed, faults %#x", (unsigned long long)after.missed,
          after.faults);
    CHECK(reports >= 1999 && commands >= 1990, "%u reports, %u commands", reports, commands);
    vm_figure("%u reports, %u commands, %llu ticks, section at most %u instructions", reports, commands,
              (unsigned long long)(after.tick - before.tick), after.section_max_ns);
}

VM_TEST(hid, arm_that_was_there_before_the_module_is_taken_over_and_given_back, 20)
{
    struct vm_arm arm = {0};

    vm_module_unload();
    if (access("/dev/uhid", F_OK) < 0)
        vm_skip("no /dev/uhid");
    vm_arm_plug(&arm);
    vm_sleep_ns(100 * VM_NS_PER_MS);
    load("");
    wait_node(PHANTOM_DEVICE_NODE, true);
    unload();
    CHECK(access(PHANTOM_DEVICE_NODE, F_OK) < 0, "the node is there after rmmod");
    expect_no_current(&arm, "after rmmod");
    load("");
    wait_node(PHANTOM_DEVICE_NODE, true);
    vm_arm_unplug(&arm);
    wait_node(PHANTOM_DEVICE_NODE, false);
    unload();
}

VM_TEST(hid, other_devices_with_the_same_id_are_left_alone, 20)
{
    struct vm_arm serial_line = {.usage = 0xffc90004};

    load("");
    vm_arm_plug(&serial_line);
    vm_sleep_ns(200 * VM_NS_PER_MS);
    CHECK(access(PHANTOM_DEVICE_NODE, F_OK) < 0, "a serial line became an arm");
    CHECK(vm_arm_commands(&serial_line) == 0, "it was sent %u commands", vm_arm_commands(&serial_line));
    vm_arm_unplug(&serial_line);
    unload();
}

VM_TEST(hid, two_arms_are_two_devices, 20)
{
    struct vm_arm first, second = {0};
    const struct phantom_status* page;
    int16_t at[3], current[3];
    int other;

    load("");
    plug(&first);
    vm_arm_plug(&second);
    wait_node("/dev/phantom_rt1", true);
    other = open("/dev/phantom_rt1", O_RDWR);
    CHECK(other >= 0, "open the second: %s", strerror(errno));
    touch(&first, &page, at);
    vm_start(other);
    vm_sleep_ns(50 * VM_NS_PER_MS);
    vm_arm_currents(&first, current);
    CHECK(current[2] != 0, "no force in the first");
    expect_no_current(&second, "in the second");
    vm_arm_unplug(&second);
    wait_node("/dev/phantom_rt1", false);
    vm_expect(other, PHANTOM_STOP, NULL, -ENODEV, "STOP of the second");
    CHECK(page->faults == 0 && page->state == PHANTOM_STATE_RUNNING, "the first has faults %#x",
          page->faults);
}

static void* start_and_stop(void* argument)
{
    const struct phantom_start start = {.ramp_ms = 1, .stale_ms = 60000};
    const bool* over = argument;

    while (!__atomic_load_n(over, __ATOMIC_ACQUIRE)) {
        int fd = vm_try_open(O_RDWR);
        int rc;

        if (fd < 0) {
            vm_sleep_ns(100000);
            continue;
        }
        rc = vm_ioctl(fd, PHANTOM_START, &start);
        CHECK(rc == 0 || rc == -ENODEV || rc == -ETIMEDOUT, "START gave %s", vm_error_name(rc));
        vm_sleep_ns(500000);
        rc = vm_ioctl(fd, PHANTOM_STOP, NULL);
        CHECK(rc == 0 || rc == -ENODEV, "STOP gave %s", vm_error_name(rc));
        close(fd);
    }
    return NULL;
}

VM_TEST(hid, may_be_unplugged_at_any_moment_of_start_and_stop, 60)
{
    uint64_t random = vm_seed();
    bool over = false;
    struct vm_arm arm;
    pthread_t thread;

    load("");
    CHECK(pthread_create(&thread, NULL, start_and_stop, &over) == 0, "pthread_create");
    for (int i = 0; i < 30; i++) {
        memset(&arm, 0, sizeof(arm));
        vm_arm_plug(&arm);
        vm_sleep_ns(vm_random_below(&random, 12000000));
        vm_arm_unplug(&arm);
    }
    __atomic_store_n(&over, true, __ATOMIC_RELEASE);
    pthread_join(thread, NULL);
    for (int number = 0; number < 3; number++) {
        char node[40];

        snprintf(node, sizeof(node), "/dev/phantom_rt%d", number);
        wait_node(node, false);
    }
    unload();
}
