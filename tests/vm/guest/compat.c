// SPDX-License-Identifier: GPL-2.0-or-later
/*
 * 32-bit callers, through the kernel's 32-bit entry (int $0x80), which takes the compat_ioctl way. What
 * they pass lies below 4 GB; the layouts are the same for both by the header's rules.
 */
#define _GNU_SOURCE
#include <errno.h>
#include <fcntl.h>
#include <setjmp.h>
#include <signal.h>
#include <string.h>
#include <sys/mman.h>
#include <unistd.h>

#include "device.h"
#include "harness.h"

/* Numbers of arch/x86/entry/syscalls/syscall_32.tbl. */
enum { NR32_READ = 3, NR32_OPEN = 5, NR32_GETPID = 20, NR32_IOCTL = 54 };

static long call32(long number, long first, long second, long third)
{
    long result;

    __asm__ volatile("int $0x80"
                     : "=a"(result)
                     : "a"(number), "b"(first), "c"(second), "d"(third)
                     : "memory", "r8", "r9", "r10", "r11");
    return (int)result;
}

static sigjmp_buf no_entry;

static void on_segv(int signal)
{
    (void)signal;
    siglongjmp(no_entry, 1);
}

static void need_compat(void)
{
    signal(SIGSEGV, on_segv);
    if (sigsetjmp(no_entry, 1))
        vm_skip("the kernel has no 32-bit entry");
    if (call32(NR32_GETPID, 0, 0, 0) != getpid())
        vm_skip("the kernel's 32-bit entry is turned off");
    signal(SIGSEGV, SIG_DFL);
}

/* Memory that a 32-bit pointer reaches. */
static void* low_memory(size_t size)
{
    void* memory = mmap(NULL, size, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS | MAP_32BIT, -1, 0);

    CHECK(memory != MAP_FAILED, "mmap below 4 GB: %s", strerror(errno));
    return memory;
}

static int ioctl32(int fd, unsigned long request, const void* argument)
{
    return (int)call32(NR32_IOCTL, fd, (long)request, (long)(uintptr_t)argument);
}

struct arguments {
    char node[sizeof(PHANTOM_DEVICE_NODE)];
    struct phantom_info info;
    struct phantom_rate rate;
    struct phantom_model model;
    struct phantom_start start;
    struct phantom_sim_move move;
    struct vm_plate plate;
    struct phantom_tick records[64];
};

VM_TEST(compat, every_call_works_from_32_bit, 10)
{
    struct arguments* low;
    int fd;

    need_compat();
    low = low_memory(sizeof(*low));
    strcpy(low->node, PHANTOM_DEVICE_NODE);
    fd = (int)call32(NR32_OPEN, (long)(uintptr_t)low->node, O_RDWR, 0);
    CHECK(fd >= 0, "open gave %s", vm_error_name(fd));
    low->rate.rate_hz = 2000;
    low->model = (struct phantom_model){.model = PHANTOM_MODEL_PROJECTED, .newton_steps = 2, .combine = 1};
    low->start.stale_ms = 60000;
    low->move.tip_nm[2] = VM_CONTACT_HEIGHT_NM;
    vm_plate_make(&low->plate, 1);
    CHECK(ioctl32(fd, PHANTOM_GET_INFO, &low->info) == 0, "GET_INFO");
    CHECK(low->info.abi_version == PHANTOM_ABI_VERSION, "abi_version %u", low->info.abi_version);
    CHECK(ioctl32(fd, PHANTOM_SET_RATE, &low->rate) == 0, "SET_RATE");
    CHECK(ioctl32(fd, PHANTOM_SET_MODEL, &low->model) == 0, "SET_MODEL");
    CHECK(ioctl32(fd, PHANTOM_SIM_MOVE, &low->move) == 0, "SIM_MOVE");
    CHECK(ioctl32(fd, PHANTOM_SUBMIT_SET, &low->plate.set) == 0, "SUBMIT_SET");
    CHECK(ioctl32(fd, PHANTOM_START, &low->start) == 0, "START");
    vm_sleep_ns(20 * VM_NS_PER_MS);
    CHECK(call32(NR32_READ, fd, (long)(uintptr_t)low->records, sizeof(low->records)) > 0, "read");
    CHECK(low->records[0].tip_nm[2] == VM_CONTACT_HEIGHT_NM, "record's tip %lld nm",
          (long long)low->records[0].tip_nm[2]);
    CHECK(ioctl32(fd, PHANTOM_CLEAR_FAULT, NULL) == 0, "CLEAR_FAULT");
    CHECK(ioctl32(fd, PHANTOM_STOP, NULL) == 0, "STOP");
}

VM_TEST(compat, errors_are_the_same_from_32_bit, 10)
{
    struct arguments* low;
    int fd, rc;

    need_compat();
    low = low_memory(sizeof(*low));
    fd = vm_open_feeder();
    low->rate.rate_hz = 999;
    CHECK((rc = ioctl32(fd, PHANTOM_SET_RATE, &low->rate)) == -EINVAL, "999 Hz gave %s", vm_error_name(rc));
    CHECK((rc = ioctl32(fd, PHANTOM_SET_RATE, NULL)) == -EFAULT, "NULL gave %s", vm_error_name(rc));
    CHECK((rc = ioctl32(fd, PHANTOM_SET_RATE, (void*)0xfffff000ul)) == -EFAULT, "the top page gave %s",
          vm_error_name(rc));
    CHECK((rc = ioctl32(fd, 0xE7FFul, NULL)) == -ENOTTY, "an unknown number gave %s", vm_error_name(rc));
    vm_plate_make(&low->plate, 1);
    low->plate.set.patches |= 0xdead00000000ull; /* must not be cut to 32 bits */
    CHECK((rc = ioctl32(fd, PHANTOM_SUBMIT_SET, &low->plate.set)) == -EFAULT, "a 48-bit pointer gave %s",
          vm_error_name(rc));
    fd = vm_open(O_RDONLY);
    CHECK((rc = ioctl32(fd, PHANTOM_STOP, NULL)) == -EBADF, "STOP by an observer gave %s", vm_error_name(rc));
}
