// SPDX-License-Identifier: GPL-2.0-or-later
/*
 * The real feeder, fdhctl, on the real module: a sphere with radial normals is stroked, and every force
 * of the trace must be the sphere's; the bunny at 3 kHz. What fdhctl records of it is computed again, here
 * and by the host, to the same bits. Without /bin/fdhctl in the initramfs these are skipped.
 */
#define _GNU_SOURCE
#include <fcntl.h>
#include <math.h>
#include <signal.h>
#include <spawn.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/wait.h>
#include <unistd.h>

#include "device.h"
#include "harness.h"
#include "module.h"
#include "recording.h"

#define PROGRAM "/bin/fdhctl"
#define SCENE "/scenes/sphere.toml"
#define BUNNY "/scenes/bunny.toml"
#define BUNNY_MESH "/usr/share/glmark2/models/bunny.obj"
#define SPHERE_MM 50.0
#define RADIUS_MM 1.0                 /* the scene's contact radius, by default */
#define STIFFNESS_N_MM 1.0            /* and its stiffness */
#define CHORD_MM (0.0012 * SPHERE_MM) /* the sphere's triangles lie so far below it */

static void need_program(void)
{
    if (access(PROGRAM, X_OK) < 0)
        vm_skip("no " PROGRAM ": `make all` was not run before");
    /* Its control socket and its settings live there. */
    setenv("HOME", "/tmp", 1);
    setenv("XDG_RUNTIME_DIR", "/tmp", 1);
}

/* Starts it with its output going to `log`. */
static pid_t start(const char* log, char* const* words)
{
    posix_spawn_file_actions_t actions;
    pid_t child;
    int rc;

    posix_spawn_file_actions_init(&actions);
    posix_spawn_file_actions_addopen(&actions, 1, log, O_WRONLY | O_CREAT | O_TRUNC, 0600);
    posix_spawn_file_actions_adddup2(&actions, 1, 2);
    rc = posix_spawn(&child, PROGRAM, &actions, NULL, words, environ);
    posix_spawn_file_actions_destroy(&actions);
    CHECK(rc == 0, "cannot start " PROGRAM ": %s", strerror(rc));
    return child;
}

static int wait_for(pid_t child)
{
    int status;

    CHECK(waitpid(child, &status, 0) == child, "waitpid");
    return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
}

/* Runs it to its end; what it printed is in `text`. */
static void run(char* text, size_t size, char* const* words)
{
    int status = wait_for(start("/tmp/fdhctl.log", words));

    vm_read_file("/tmp/fdhctl.log", text, size);
    CHECK(status == 0, "fdhctl %s ended with %d: %.600s", words[1], status, text);
}

#define RUN(text, ...) run(text, sizeof(text), (char* const[]){PROGRAM, __VA_ARGS__, NULL})

/* The recording's ticks once more by the user-mode build, as a trace; and the recording for the host to do
 * the same. */
static void compute_again(const char* recording, const char* trace)
{
    char text[4096];

    run(text, sizeof(text),
        (char* const[]){PROGRAM, "replay", (char*)recording, "-o", (char*)trace, "--json", NULL});
    CHECK(strstr(text, "\"same\":true") && strstr(text, "\"not_compared\":0,") &&
              strstr(text, "\"complete\":true"),
          "replay: %.1500s", text);
    recording_hand_out(recording);
}

struct row {
    double time, tip[3], force[3];
    int contacts, inside;
};

static bool parse_row(const char* line, struct row* row)
{
    return sscanf(line, "%lf,%lf,%lf,%lf,%lf,%lf,%lf,%d,%d", &row->time, &row->tip[0], &row->tip[1],
                  &row->tip[2], &row->force[0], &row->force[1], &row->force[2], &row->contacts,
                  &row->inside) == 9;
}

static double dot(const double a[3], const double b[3])
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

/* The row's force must be the sphere's: radial, k (R - h), h down to a chord's depth uncertain. */
static void check_row(const struct row* row, unsigned int number)
{
    double distance = sqrt(dot(row->tip, row->tip));
    double size = sqrt(dot(row->force, row->force));
    double expected = STIFFNESS_N_MM * (RADIUS_MM - (distance - SPHERE_MM));
    double slack = STIFFNESS_N_MM * CHORD_MM;

    if (expected < 0)
        expected = 0;
    CHECK(size <= expected + 1e-4 && size >= expected - slack - 1e-4,
          "row %u: |F| = %.6f N at %.6f mm from the middle, not %.6f", number, size, distance, expected);
    /* Below the surface the normal at the proxy's own triangle may differ by the mesh's angle. */
    if (size > 0.01 && !row->inside)
        CHECK(dot(row->force, row->tip) / size / distance > 1 - 1e-6, "row %u: the force is not radial",
              number);
}

VM_TEST(program, stroke_over_a_sphere_gives_the_spheres_force, 120)
{
    char text[4096], line[400];
    unsigned int rows = 0, contacts = 0, inside = 0;
    struct row row;
    FILE* trace;

    need_program();
    RUN(text, "stroke", SCENE, "--seconds", "3", "-o", "/tmp/path.csv");
    RUN(text, "load", SCENE, "--path", "/tmp/path.csv", "--record", "/tmp/touch.rec", "--json");
    CHECK(strstr(text, "\"missed\":0,"), "ticks were missed: %.600s", text);
    CHECK(strstr(text, "\"device\":\"/dev/phantom_rt0\""), "not the module was fed: %.600s", text);
    compute_again("/tmp/touch.rec", "/tmp/trace.csv");
    trace = fopen("/tmp/trace.csv", "r");
    CHECK(trace && fgets(line, sizeof(line), trace), "no trace");
    while (fgets(line, sizeof(line), trace)) {
        rows++;
        CHECK(parse_row(line, &row), "row %u: %s", rows, line);
        if (row.time < 0.3 || row.time > 3) /* START and STOP ramp */
            continue;
        contacts += row.contacts > 0;
        inside += row.inside;
        check_row(&row, rows);
    }
    fclose(trace);
    CHECK(rows > 2900 && contacts > 1000 && inside > 100, "%u rows, %u in contact, %u inside", rows, contacts,
          inside);
    vm_figure("%u rows, %u in contact, %u below the surface", rows, contacts, inside);
}

/* The number behind "name": in one line of JSON; fails without it. */
static double number_of(const char* json, const char* name)
{
    const char* at = strstr(json, name);

    CHECK(at, "no %s in %.600s", name, json);
    return strtod(at + strlen(name), NULL);
}

VM_TEST(program, bunny_is_touched_at_3_khz_without_a_missed_tick, 300)
{
    char text[4096];

    need_program();
    if (access(BUNNY_MESH, R_OK) < 0)
        vm_skip("no " BUNNY_MESH ": package glmark2-data");
    RUN(text, "stroke", BUNNY, "--seconds", "2", "-o", "/tmp/path.csv");
    RUN(text, "load", BUNNY, "--path", "/tmp/path.csv", "--record", "/tmp/touch.rec", "--json");
    CHECK(strstr(text, "\"device\":\"/dev/phantom_rt0\""), "not the module was fed: %.600s", text);
    CHECK(strstr(text, "\"faults\":\"none\""), "faults: %.600s", text);
    CHECK(number_of(text, "\"missed\":") == 0, "ticks were missed: %.600s", text);
    CHECK(number_of(text, "\"rate_hz\":") == 3000, "another rate: %.600s", text);
    CHECK(number_of(text, "\"contact_ticks\":") > 1000, "hardly touched: %.600s", text);
    CHECK(number_of(text, "\"force_max_n\":") > 0.2, "no force to speak of: %.600s", text);
    compute_again("/tmp/touch.rec", "/tmp/trace.csv");
    vm_figure("%.0f ticks, %.0f in contact, at most %.3f N", number_of(text, "\"ticks\":"),
              number_of(text, "\"contact_ticks\":"), number_of(text, "\"force_max_n\":"));
}

VM_TEST(program, status_rate_and_stop_reach_the_running_feeder, 120)
{
    const struct phantom_status* page;
    struct phantom_status status;
    char text[4096];
    pid_t feeder;

    need_program();
    page = vm_map(vm_open(O_RDONLY));
    feeder = start("/tmp/load.log", (char* const[]){PROGRAM, "load", SCENE, NULL});
    vm_wait_state(page, PHANTOM_STATE_RUNNING);
    vm_wait_ticks(page, 100);
    RUN(text, "rate", "3000");
    vm_sleep_ns(50 * VM_NS_PER_MS);
    vm_status(page, &status);
    CHECK(status.rate_hz == 3000, "%u Hz after `fdhctl rate 3000`", status.rate_hz);
    RUN(text, "status", "--json");
    CHECK(strstr(text, "\"rate_hz\":3000"), "status: %.600s", text);
    RUN(text, "stop");
    CHECK(wait_for(feeder) == 0, "the feeder did not end well after `fdhctl stop`");
    CHECK(vm_state(page) == PHANTOM_STATE_IDLE, "state %u", vm_state(page));
    vm_status(page, &status);
    CHECK(status.missed == 0, "%llu ticks missed", (unsigned long long)status.missed);
}

VM_TEST(program, killed_in_contact_it_leaves_the_device_to_the_next, 120)
{
    const struct phantom_status* page;
    char text[4096];
    pid_t feeder;

    need_program();
    page = vm_map(vm_open(O_RDONLY));
    feeder = start("/tmp/load.log", (char* const[]){PROGRAM, "load", SCENE, NULL});
    vm_wait_state(page, PHANTOM_STATE_RUNNING);
    CHECK(kill(feeder, SIGKILL) == 0, "kill");
    wait_for(feeder);
    vm_wait_state(page, PHANTOM_STATE_IDLE);
    RUN(text, "load", SCENE, "--seconds", "1", "--json");
    CHECK(strstr(text, "\"device\":\"/dev/phantom_rt0\""), "not the module was fed: %.600s", text);
}
