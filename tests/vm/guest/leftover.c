// SPDX-License-Identifier: GPL-2.0-or-later
// After rmmod: nothing is left, and the kernel has not complained.
#define _GNU_SOURCE
#include <ctype.h>
#include <dirent.h>
#include <ftw.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/klog.h>
#include <unistd.h>

#include "harness.h"
#include "module.h"

static const char* found;

static int look(const char* path, const struct stat* entry, int type, struct FTW* walk)
{
    (void)entry;
    (void)type;
    if (!strstr(path + walk->base, VM_MODULE_NAME))
        return 0;
    found = strdup(path);
    return 1;
}

VM_TEST(leftover, no_entry_in_dev_sys_debug_proc, 60)
{
    static const char* const roots[] = {"/dev", "/sys", "/sys/kernel/debug"};
    char text[1 << 16];

    CHECK(!vm_module_is_loaded(), "the module is loaded");
    for (size_t i = 0; i < sizeof(roots) / sizeof(roots[0]); i++) {
        /* The walk does not cross into debugfs by itself. */
        nftw(roots[i], look, 20, FTW_PHYS | FTW_MOUNT);
        CHECK(!found, "left behind: %s", found);
    }
    vm_read_file("/proc/misc", text, sizeof(text));
    CHECK(!strstr(text, VM_MODULE_NAME), "left in /proc/misc");
    vm_read_file("/proc/modules", text, sizeof(text));
    CHECK(!strstr(text, VM_MODULE_NAME), "left in /proc/modules");
    vm_read_file("/proc/vmallocinfo", text, sizeof(text));
    CHECK(!strstr(text, VM_MODULE_NAME), "left in /proc/vmallocinfo");
}

VM_TEST(leftover, no_thread, 10)
{
    DIR* folder = opendir("/proc");
    struct dirent* entry;
    int processes = 0;

    CHECK(folder, "no /proc");
    while ((entry = readdir(folder))) {
        char path[300], name[64];

        if (!isdigit((unsigned char)entry->d_name[0]))
            continue;
        processes++;
        snprintf(path, sizeof(path), "/proc/%s/comm", entry->d_name);
        vm_read_file(path, name, sizeof(name));
        CHECK(strncmp(name, "phantom", strlen("phantom")) != 0, "thread %s is left: %s", entry->d_name, name);
    }
    closedir(folder);
    CHECK(processes > 10, "%d processes", processes);
}

/* Documentation/admin-guide/tainted-kernels.rst */
#define TAINT_OUT_OF_TREE (1ul << 12)
#define TAINT_UNSIGNED (1ul << 13)

VM_TEST(leftover, no_taint_but_out_of_tree_and_unsigned, 10)
{
    char text[64];
    unsigned long taint;

    vm_read_file("/proc/sys/kernel/tainted", text, sizeof(text));
    taint = strtoul(text, NULL, 10);
    CHECK(isdigit((unsigned char)text[0]), "no taint number");
    CHECK((taint & ~(TAINT_OUT_OF_TREE | TAINT_UNSIGNED)) == 0, "taint %#lx", taint);
    CHECK(taint & TAINT_OUT_OF_TREE, "no taint at all: was the module loaded?");
}

VM_TEST(leftover, no_complaint_in_the_kernels_log, 10)
{
    static const char* const complaints[] = {
        "WARNING:",
        "BUG:",
        "Oops",
        "Call Trace:",
        "rcu: INFO:",
        "rcu_preempt self-detected",
        "hung task",
        "blocked for more than",
        "soft lockup",
        "scheduling while atomic",
        "sleeping function called",
        "general protection",
        "refcount_t:",
        "UBSAN",
        "KASAN",
        "the force had not ramped to zero in time",
        "list_add corruption",
        "list_del corruption",
    };
    static char log[1 << 20];
    int size = klogctl(3 /* SYSLOG_ACTION_READ_ALL */, log, sizeof(log) - 1);

    CHECK(size > 0, "no kernel log");
    log[size] = 0;
    for (size_t i = 0; i < sizeof(complaints) / sizeof(complaints[0]); i++) {
        const char* at = strstr(log, complaints[i]);

        CHECK(!at, "the kernel's log says: %.200s", at);
    }
    CHECK(strstr(log, "phantom_rt"), "the module has said nothing at all");
}
