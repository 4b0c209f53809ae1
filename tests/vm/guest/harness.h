// SPDX-License-Identifier: GPL-2.0-or-later
/*
 * harness.h - a test is a function; each runs in a process of its own.
 *
 *     VM_TEST(set, refuses_id_zero, 10) { ... CHECK(condition, "why, with %d", number); }
 *
 * reports `ok set.refuses_id_zero`, or `not ok set.refuses_id_zero: file:line: why`. A test fails by the
 * first CHECK that does not hold in any of its threads and forked processes, by a signal, or by taking
 * longer than its limit (seconds of guest time). Whatever it leaves open or running is closed and
 * killed with it, so no test sees another's files. Tests run file by file in the order of the sources.
 */
#ifndef VM_HARNESS_H
#define VM_HARNESS_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

struct vm_test {
    const char* group;
    const char* name;
    unsigned int limit_s;
    void (*run)(void);
    struct vm_test* next;
};

void vm_test_register(struct vm_test* test);

#define VM_TEST(group_, name_, limit_s_)                                                                     \
    static void group_##_##name_(void);                                                                      \
    static struct vm_test group_##_##name_##_test = {#group_, #name_, limit_s_, group_##_##name_, NULL};     \
    __attribute__((constructor)) static void group_##_##name_##_register(void)                               \
    {                                                                                                        \
        vm_test_register(&group_##_##name_##_test);                                                          \
    }                                                                                                        \
    static void group_##_##name_(void)

/* Fails the test and ends the calling process. */
__attribute__((noreturn, format(printf, 3, 4))) void vm_fail(const char* file, int line, const char* format,
                                                             ...);
/* The test cannot run here (a CPU or a device is missing): counted apart, never as passed. */
__attribute__((noreturn, format(printf, 1, 2))) void vm_skip(const char* format, ...);

#define CHECK(condition, ...)                                                                                \
    do {                                                                                                     \
        if (!(condition))                                                                                    \
            vm_fail(__FILE__, __LINE__, __VA_ARGS__);                                                        \
    } while (0)

/* A figure worth reading, printed as `figure NAME: ...`. */
__attribute__((format(printf, 1, 2))) void vm_figure(const char* format, ...);

/* The number behind "vm.NAME=" on the kernel's command line. */
uint64_t vm_word(const char* name, uint64_t otherwise);
/* A seed for the test, printed with its name; fixed by vm.seed=N on the kernel's command line. */
uint64_t vm_seed(void);
/* splitmix64 (Steele, Lea, Flood 2014): the next number of a sequence. */
uint64_t vm_random(uint64_t* state);
/* 0 ... bound - 1. */
uint32_t vm_random_below(uint64_t* state, uint32_t bound);

/*
 * One line of the report: to standard output, and where QEMU gives one (isa-debugcon, port 0xe9), to the
 * host's file of results, into which the kernel's log cannot be mixed.
 */
__attribute__((format(printf, 1, 2))) void vm_report(const char* format, ...);

/* Runs the tests of those groups or of those names; 0 when there were any and all passed. */
int vm_run(char* const* wanted, int count);
/* Prints "group.name" of every test. */
void vm_list(void);

#endif /* VM_HARNESS_H */
