// SPDX-License-Identifier: GPL-2.0-or-later
// The harness: registration, one process a test, limits, the report.
#define _GNU_SOURCE
#include <errno.h>
#include <signal.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/io.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>

#include "harness.h"

/* QEMU's isa-debugcon: every byte written goes into a file of the host. */
#define RESULTS_PORT 0xe9

/* In the initramfs of a kernel on which some tests make no sense: one `GROUP.NAME: WHY` a line. */
#define SKIPPED_TESTS "/skipped"

/* The child's exit status; any other is a failure without a message. */
enum { PASSED = 0, FAILED = 41, SKIPPED = 42 };

/* Shared with the test's processes: what the first failure says. */
struct report {
    int taken;
    char why[1000];
};

static struct vm_test* first;
static struct vm_test** last = &first;
static struct report* report;
static const struct vm_test* running;

void vm_test_register(struct vm_test* test)
{
    *last = test;
    last = &test->next;
}

static void take_report(const char* file, int line, const char* format, va_list arguments)
{
    size_t used = 0;

    if (__atomic_exchange_n(&report->taken, 1, __ATOMIC_ACQ_REL))
        return;
    if (file) {
        const char* slash = strrchr(file, '/');
        used = (size_t)snprintf(report->why, sizeof(report->why), "%s:%d: ", slash ? slash + 1 : file, line);
    }
    vsnprintf(report->why + used, sizeof(report->why) - used, format, arguments);
}

void vm_fail(const char* file, int line, const char* format, ...)
{
    va_list arguments;

    va_start(arguments, format);
    take_report(file, line, format, arguments);
    va_end(arguments);
    _exit(FAILED);
}

void vm_skip(const char* format, ...)
{
    va_list arguments;

    va_start(arguments, format);
    take_report(NULL, 0, format, arguments);
    va_end(arguments);
    _exit(SKIPPED);
}

void vm_report(const char* format, ...)
{
    char line[1400];
    va_list arguments;
    size_t length;

    va_start(arguments, format);
    vsnprintf(line, sizeof(line) - 1, format, arguments);
    va_end(arguments);
    strcat(line, "\n");
    length = strlen(line);
    fputs(line, stdout);
    fflush(stdout);
    if (ioperm(RESULTS_PORT, 1, 1) == 0) {
        for (size_t i = 0; i < length; i++)
            outb((unsigned char)line[i], RESULTS_PORT);
        ioperm(RESULTS_PORT, 1, 0);
    }
}

void vm_figure(const char* format, ...)
{
    char figure[1000];
    va_list arguments;

    va_start(arguments, format);
    vsnprintf(figure, sizeof(figure), format, arguments);
    va_end(arguments);
    vm_report("figure %s.%s: %s", running->group, running->name, figure);
}

uint64_t vm_word(const char* name, uint64_t otherwise)
{
    uint64_t value = otherwise;
    char line[4096] = "";
    FILE* file = fopen("/proc/cmdline", "r");

    if (file) {
        if (fgets(line, sizeof(line), file)) {
            const char* given = strstr(line, name);
            if (given)
                value = strtoull(given + strlen(name), NULL, 0);
        }
        fclose(file);
    }
    return value;
}

uint64_t vm_seed(void)
{
    uint64_t seed = vm_word("vm.seed=", 20010917);

    vm_figure("seed %llu", (unsigned long long)seed);
    return seed;
}

uint64_t vm_random(uint64_t* state)
{
    uint64_t z = (*state += 0x9e3779b97f4a7c15u);

    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
    return z ^ (z >> 31);
}

uint32_t vm_random_below(uint64_t* state, uint32_t bound)
{
    return (uint32_t)(vm_random(state) % bound);
}

/* Waits for the child; false when the limit came first. */
static bool wait_limited(pid_t child, unsigned int limit_s, int* status)
{
    struct timespec now, end;
    sigset_t set;

    sigemptyset(&set);
    sigaddset(&set, SIGCHLD);
    clock_gettime(CLOCK_MONOTONIC, &end);
    end.tv_sec += limit_s;
    for (;;) {
        struct timespec left;

        if (waitpid(child, status, WNOHANG) == child)
            return true;
        clock_gettime(CLOCK_MONOTONIC, &now);
        left.tv_sec = end.tv_sec - now.tv_sec;
        left.tv_nsec = end.tv_nsec - now.tv_nsec;
        if (left.tv_nsec < 0) {
            left.tv_nsec += 1000000000;
            left.tv_sec--;
        }
        if (left.tv_sec < 0)
            return false;
        sigtimedwait(&set, NULL, &left);
    }
}

/* Ends what the test forked; orphans come to us because this process is their subreaper. */
static void reap_group(pid_t group)
{
    kill(-group, SIGKILL);
    while (waitpid(-1, NULL, 0) > 0 || errno == EINTR)
        ;
}

static int run_one(const struct vm_test* test)
{
    int status = 0;
    bool in_time;
    pid_t child;

    memset(report, 0, sizeof(*report));
    running = test;
    fflush(stdout);
    child = fork();
    if (child == 0) {
        setpgid(0, 0);
        prctl(PR_SET_PDEATHSIG, SIGKILL);
        test->run();
        fflush(stdout);
        _exit(PASSED);
    }
    if (child < 0) {
        vm_report("not ok %s.%s: fork: %s", test->group, test->name, strerror(errno));
        return FAILED;
    }
    setpgid(child, child);
    in_time = wait_limited(child, test->limit_s, &status);
    reap_group(child);
    report->why[sizeof(report->why) - 1] = 0;
    if (!in_time) {
        vm_report("not ok %s.%s: not done after %u s%s%s", test->group, test->name, test->limit_s,
                  report->why[0] ? ": " : "", report->why);
        return FAILED;
    }
    if (WIFSIGNALED(status)) {
        vm_report("not ok %s.%s: killed by signal %d (%s)", test->group, test->name, WTERMSIG(status),
                  strsignal(WTERMSIG(status)));
        return FAILED;
    }
    if (WEXITSTATUS(status) == SKIPPED) {
        vm_report("skipped %s.%s: %s", test->group, test->name, report->why);
        return SKIPPED;
    }
    /* A forked helper may have failed while the test itself went on. */
    if (WEXITSTATUS(status) != PASSED || report->taken) {
        vm_report("not ok %s.%s: %s", test->group, test->name,
                  report->taken ? report->why : "ended without a message");
        return FAILED;
    }
    vm_report("ok %s.%s", test->group, test->name);
    return PASSED;
}

static bool is_wanted(const struct vm_test* test, char* const* wanted, int count)
{
    char full[128];

    snprintf(full, sizeof(full), "%s.%s", test->group, test->name);
    for (int i = 0; i < count; i++)
        if (strcmp(wanted[i], test->group) == 0 || strcmp(wanted[i], full) == 0)
            return true;
    return false;
}

/* Why this kernel cannot give the test what it needs, by a line `GROUP.NAME: WHY` of the file; NULL when it
 * can. */
static const char* reason_to_skip(const struct vm_test* test)
{
    static char line[1000];
    char full[128];
    size_t length = (size_t)snprintf(full, sizeof(full), "%s.%s: ", test->group, test->name);
    FILE* file = fopen(SKIPPED_TESTS, "r");
    const char* why = NULL;

    while (file && !why && fgets(line, sizeof(line), file)) {
        line[strcspn(line, "\n")] = 0;
        if (strncmp(line, full, length) == 0)
            why = line + length;
    }
    if (file)
        fclose(file);
    return why;
}

int vm_run(char* const* wanted, int count)
{
    int passed = 0, failed = 0, skipped = 0;
    sigset_t set;

    report = mmap(NULL, sizeof(*report), PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0);
    if (report == MAP_FAILED) {
        perror("mmap");
        return 1;
    }
    /* For sigtimedwait() above; tests wait for their own children with waitpid(). */
    sigemptyset(&set);
    sigaddset(&set, SIGCHLD);
    sigprocmask(SIG_BLOCK, &set, NULL);
    prctl(PR_SET_CHILD_SUBREAPER, 1);
    for (const struct vm_test* test = first; test; test = test->next) {
        const char* why;

        if (!is_wanted(test, wanted, count))
            continue;
        why = reason_to_skip(test);
        if (why) {
            vm_report("skipped %s.%s: %s", test->group, test->name, why);
            skipped++;
            continue;
        }
        switch (run_one(test)) {
        case PASSED:
            passed++;
            break;
        case SKIPPED:
            skipped++;
            break;
        default:
            failed++;
        }
    }
    vm_report("suite: %d passed, %d failed, %d skipped", passed, failed, skipped);
    return failed == 0 && passed > 0 ? 0 : 1;
}

void vm_list(void)
{
    for (const struct vm_test* test = first; test; test = test->next)
        printf("%s.%s\n", test->group, test->name);
}
