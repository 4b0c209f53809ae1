/* SPDX-License-Identifier: GPL-2.0-only */
/*
 * phantom_platform.h - the seam between the module and what it runs on, the kernel's side.
 *
 * Every <linux/...> include of the module is here. usermode/phantom_platform.h has the same names
 * for a process and is found first by the user-mode build: the rest of the module knows neither.
 */
#ifndef PHANTOM_PLATFORM_H
#define PHANTOM_PLATFORM_H

/* Before the first include: what every line of the log begins with. */
#define pr_fmt(fmt) KBUILD_MODNAME ": " fmt

#include <linux/atomic.h>
#include <linux/bits.h>
#include <linux/cdev.h>
#include <linux/completion.h>
#include <linux/cpu.h>
#include <linux/debugfs.h>
#include <linux/delay.h>
#include <linux/device.h>
#include <linux/err.h>
#include <linux/errno.h>
#include <linux/fcntl.h>
#include <linux/fs.h>
#include <linux/hid.h>
#include <linux/hrtimer.h>
#include <linux/idr.h>
#include <linux/init.h>
#include <linux/jiffies.h>
#include <linux/kernel.h>
#include <linux/kstrtox.h>
#include <linux/kthread.h>
#include <linux/ktime.h>
#include <linux/limits.h>
#include <linux/lockdep.h>
#include <linux/log2.h>
#include <linux/math.h>
#include <linux/math64.h>
#include <linux/minmax.h>
#include <linux/mm.h>
#include <linux/module.h>
#include <linux/mutex.h>
#include <linux/notifier.h>
#include <linux/poll.h>
#include <linux/sched.h>
#include <linux/sched/isolation.h>
#include <linux/seq_file.h>
#include <linux/slab.h>
#include <linux/string.h>
#include <linux/suspend.h>
#include <linux/sysfs.h>
#include <linux/time64.h>
#include <linux/uaccess.h>
#include <linux/version.h>
#include <linux/vmalloc.h>
#include <linux/wait.h>
#include <uapi/linux/sched/types.h>
#include <asm/cpufeature.h>
#include <asm/fpu/api.h>

#include <phantom_platform_types.h>

/*
 * Compatibility. The module is written for the newest kernel; what an older one lacks stands here,
 * each entry with the release that brought it.
 */

/* 6.3: vm_flags became read-only but for helpers that take the lock checks along. */
#if LINUX_VERSION_CODE < KERNEL_VERSION(6, 3, 0)
static inline void vm_flags_clear(struct vm_area_struct *vma, unsigned long flags)
{
	vma->vm_flags &= ~flags;
}
#endif

/* 6.2: class.devnode takes a device that it may not change. */
#if LINUX_VERSION_CODE < KERNEL_VERSION(6, 2, 0)
typedef struct device phantom_devnode_device;
#else
typedef const struct device phantom_devnode_device;
#endif

/* True when the CPU has AVX2 and the kernel saves its registers. */
static inline bool phantom_platform_has_avx2(void)
{
	return boot_cpu_has(X86_FEATURE_AVX2) &&
	       cpu_has_xfeatures(XFEATURE_MASK_SSE | XFEATURE_MASK_YMM, NULL);
}

/* Zeroed memory that user space may map; a multiple of the page size. NULL without memory. */
static inline void *phantom_platform_share(size_t size)
{
	return vmalloc_user(size);
}

static inline void phantom_platform_unshare(const void *page, size_t size)
{
	vfree(page);
}

#endif /* PHANTOM_PLATFORM_H */
