// SPDX-License-Identifier: GPL-2.0-or-later
// rmmod while somebody needs the module: refused, and without consequences.
#define _GNU_SOURCE
#include <errno.h>
#include <fcntl.h>
#include <poll.h>
#include <pthread.h>
#include <sys/mman.h>
#include <unistd.h>

#include "device.h"
#include "harness.h"
#include "module.h"

static void refused(const char* when)
{
    int rc = vm_module_unload();

    CHECK(rc == -EWOULDBLOCK || rc == -EBUSY, "rmmod %s gave %s", when, vm_error_name(rc));
}

VM_TEST(unload, refused_while_open_running_or_in_contact, 20)
{
    int fd = vm_open_feeder();
    const struct phantom_status* page = vm_map(fd);
    struct phantom_status before, after;

    refused("while open");
    vm_start(fd);
    refused("while running");
    vm_expect(fd, PHANTOM_STOP, NULL, 0, "STOP");
    vm_touch(fd, page);
    vm_status(page, &before);
    for (int i = 0; i < 100; i++)
        refused("in contact");
    vm_wait_ticks(page, before.tick + 50);
    vm_status(page, &after);
    CHECK(after.state == PHANTOM_STATE_RUNNING && after.missed == 0, "state %u, %llu missed", after.state,
          (unsigned long long)after.missed);
    CHECK(after.force_un[2] == before.force_un[2], "force %d uN, was %d", after.force_un[2],
          before.force_un[2]);
}

VM_TEST(unload, refused_while_only_mapped, 10)
{
    int fd = vm_open(O_RDONLY);
    const struct phantom_status* page = vm_map(fd);

    CHECK(close(fd) == 0, "close");
    refused("while the status page is mapped");
    CHECK(page->abi_version == PHANTOM_ABI_VERSION, "the mapping is broken");
}

static void* wait_in_read(void* argument)
{
    struct phantom_tick record;

    while (read(*(int*)argument, &record, sizeof(record)) > 0)
        ;
    return NULL;
}

VM_TEST(unload, refused_while_a_reader_waits, 10)
{
    int fd = vm_open_feeder();
    int observer = vm_open(O_RDONLY);
    pthread_t thread;

    vm_start(fd);
    CHECK(pthread_create(&thread, NULL, wait_in_read, &observer) == 0, "pthread_create");
    for (int i = 0; i < 20; i++) {
        refused("under a waiting reader");
        vm_sleep_ns(VM_NS_PER_MS);
    }
    vm_expect(fd, PHANTOM_STOP, NULL, 0, "STOP");
    pthread_join(thread, NULL);
}
