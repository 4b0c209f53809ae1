// SPDX-License-Identifier: GPL-2.0-or-later
/*
 * What only the kernel of tools/vm-debug can say, after the module has gone. Its other checks complain in the
 * log, which leftover.c and the host read.
 */
#define _GNU_SOURCE
#include <fcntl.h>
#include <stdio.h>
#include <string.h>
#include <unistd.h>

#include "device.h"
#include "harness.h"
#include "module.h"

#define KMEMLEAK "/sys/kernel/debug/kmemleak"

static void scan_memory(void)
{
    int fd = open(KMEMLEAK, O_WRONLY);

    CHECK(fd >= 0, "no " KMEMLEAK ": is it a kernel with CONFIG_DEBUG_KMEMLEAK?");
    CHECK(write(fd, "scan", 4) == 4, "kmemleak does not scan: it has turned itself off");
    close(fd);
}

/* kmemleak's leaks: objects that are 5 s old and to which two scans have found no pointer. */
VM_TEST(debug, kmemleak_finds_no_leak, 600)
{
    static char text[1 << 16];

    vm_sleep_ns(6 * VM_NS_PER_S);
    scan_memory();
    vm_sleep_ns(VM_NS_PER_S);
    scan_memory();
    vm_read_file(KMEMLEAK, text, sizeof(text));
    CHECK(text[0] == 0, "leaked: %.800s", text);
}

/* lockdep turns itself off after its first report, and when it runs out of memory for what it has seen. */
VM_TEST(debug, lockdep_has_watched_to_the_end, 10)
{
    static char text[1 << 16];
    const char* at;
    int on = 0;

    vm_read_file("/proc/lockdep_stats", text, sizeof(text));
    at = strstr(text, "debug_locks:");
    CHECK(at && sscanf(at, "debug_locks: %d", &on) == 1, "no debug_locks in /proc/lockdep_stats");
    CHECK(on == 1, "lockdep is off");
}
