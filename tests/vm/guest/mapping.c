// SPDX-License-Identifier: GPL-2.0-or-later
// mmap of the status page: read-only, whole, and alive as long as it is mapped.
#define _GNU_SOURCE
#include <errno.h>
#include <fcntl.h>
#include <signal.h>
#include <string.h>
#include <sys/mman.h>
#include <sys/wait.h>
#include <unistd.h>

#include "device.h"
#include "harness.h"

#define PAGE 4096u

static int try_map(int fd, size_t size, int protection, int flags, off_t offset)
{
    void* page = mmap(NULL, size, protection, flags, fd, offset);

    return page == MAP_FAILED ? -errno : 0;
}

VM_TEST(mapping, writable_or_executable_is_refused, 10)
{
    int fd = vm_open_feeder();
    size_t size = vm_status_size(fd);

    for (int protection = 0; protection < 8; protection++)
        for (int shared = 0; shared < 2; shared++) {
            int rc = try_map(fd, size, protection, shared ? MAP_SHARED : MAP_PRIVATE, 0);
            int expected = protection & (PROT_WRITE | PROT_EXEC) ? -EPERM : 0;

            CHECK(rc == expected, "protection %d, %s gave %s", protection, shared ? "shared" : "private",
                  vm_error_name(rc));
        }
}

VM_TEST(mapping, cannot_become_writable_or_executable, 10)
{
    int fd = vm_open_feeder();
    size_t size = vm_status_size(fd);
    void* page = (void*)vm_map(fd);

    CHECK(mprotect(page, size, PROT_READ | PROT_WRITE) < 0 && errno == EACCES, "mprotect writable");
    CHECK(mprotect(page, size, PROT_WRITE) < 0 && errno == EACCES, "mprotect write-only");
    CHECK(mprotect(page, size, PROT_READ | PROT_EXEC) < 0 && errno == EACCES, "mprotect executable");
    CHECK(mprotect(page, size, PROT_READ) == 0, "mprotect readable");
}

VM_TEST(mapping, a_write_ends_the_writer_and_changes_nothing, 10)
{
    int fd = vm_open_feeder();
    const struct phantom_status* page = vm_map(fd);
    int status;
    pid_t child = fork();

    if (child == 0) {
        ((volatile struct phantom_status*)(uintptr_t)page)->abi_version = 99;
        _exit(0);
    }
    CHECK(waitpid(child, &status, 0) == child, "waitpid");
    CHECK(WIFSIGNALED(status) && WTERMSIG(status) == SIGSEGV, "status %#x", status);
    CHECK(page->abi_version == PHANTOM_ABI_VERSION, "abi_version %u", page->abi_version);
}

VM_TEST(mapping, wrong_offset_or_size_is_refused, 10)
{
    int fd = vm_open_feeder();
    size_t size = vm_status_size(fd);

    CHECK(try_map(fd, size, PROT_READ, MAP_SHARED, PAGE) == -EINVAL, "offset of one page");
    CHECK(try_map(fd, PAGE, PROT_READ, MAP_SHARED, (off_t)size) == -EINVAL, "offset right behind it");
    CHECK(try_map(fd, PAGE, PROT_READ, MAP_SHARED, (off_t)1 << 40) == -EINVAL, "offset of 1 TB");
    CHECK(try_map(fd, PAGE, PROT_READ, MAP_SHARED, (off_t)0x7ffffffffffff000) != 0, "the last offset");
    CHECK(try_map(fd, size + PAGE, PROT_READ, MAP_SHARED, 0) == -EINVAL, "one page too long");
    CHECK(try_map(fd, (size_t)1 << 30, PROT_READ, MAP_SHARED, 0) == -EINVAL, "1 GB");
    CHECK(try_map(fd, 1, PROT_READ, MAP_SHARED, 0) == 0, "one byte (one page)");
    CHECK(try_map(fd, size, PROT_READ, MAP_SHARED, 0) == 0, "all of it");
}

VM_TEST(mapping, may_not_be_stretched, 10)
{
    int fd = vm_open_feeder();
    size_t size = vm_status_size(fd);
    void* page = (void*)vm_map(fd);
    void* larger = mremap(page, size, size + 16 * PAGE, MREMAP_MAYMOVE);

    /* Stretching the mapping must not show what lies behind the page. */
    CHECK(larger == MAP_FAILED, "mremap gave more than the page");
}

VM_TEST(mapping, outlives_its_file, 10)
{
    int fd = vm_open_feeder();
    int observer = vm_open(O_RDONLY);
    const struct phantom_status* page = vm_map(observer);
    struct phantom_status status;

    CHECK(close(observer) == 0, "close");
    vm_touch(fd, page);
    vm_status(page, &status);
    CHECK(status.state == PHANTOM_STATE_RUNNING && status.force_un[2] > 0, "state %u, force %d uN",
          status.state, status.force_un[2]);
}

VM_TEST(mapping, survives_fork_and_partial_unmapping, 10)
{
    int fd = vm_open_feeder();
    const struct phantom_status* page = vm_map(fd);
    size_t size = vm_status_size(fd);
    int status;
    pid_t child = fork();

    if (child == 0) {
        vm_wait_ticks(page, 0);
        _exit(munmap((char*)(uintptr_t)page, size));
    }
    CHECK(waitpid(child, &status, 0) == child && status == 0, "the child ended with %#x", status);
    if (size > PAGE)
        CHECK(munmap((char*)(uintptr_t)page + PAGE, size - PAGE) == 0, "munmap of the tail");
    CHECK(page->abi_version == PHANTOM_ABI_VERSION, "abi_version %u", page->abi_version);
}

VM_TEST(mapping, is_consistent_under_ten_khz, 10)
{
    int fd = vm_open_feeder();
    const struct phantom_status* page = vm_map(fd);
    struct phantom_status status;

    vm_set_rate(fd, 10000);
    vm_touch(fd, page);
    for (int i = 0; i < 20000; i++) {
        uint64_t last = i ? status.tick : 0;

        vm_status(page, &status);
        CHECK(status.tick >= last, "the tick went back from %llu to %llu", (unsigned long long)last,
              (unsigned long long)status.tick);
        CHECK(status.time_ns >= status.start_ns, "time before start");
        CHECK(status.tip_nm[2] == VM_CONTACT_HEIGHT_NM && status.state == PHANTOM_STATE_RUNNING,
              "torn page: tip %lld, state %u", (long long)status.tip_nm[2], status.state);
    }
}
