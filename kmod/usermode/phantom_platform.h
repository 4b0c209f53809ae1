/* SPDX-License-Identifier: GPL-2.0-only */
/*
 * phantom_platform.h - the seam between the module and what it runs on, a process's side.
 *
 * The names are the kernel's and mean the same; only what the module uses is here. Behind them are
 * pthreads and the C library (platform.c). The checks of a debug kernel come with it: sleeping,
 * allocating or nesting inside a float section aborts, and so does a broken context rule.
 *
 * x86-64 only, as the float sections are: the memory barriers lean on its ordering (stores are
 * not reordered with stores, nor loads with loads), so that the thread sanitizer, which knows no
 * fences, sees nothing but atomic accesses.
 */
#ifndef PHANTOM_PLATFORM_H
#define PHANTOM_PLATFORM_H

#ifndef __x86_64__
#error "the user-mode build needs x86-64"
#endif

#include <errno.h>
#include <fcntl.h>
#include <limits.h>
#include <poll.h>
#include <pthread.h>
#include <stdint.h>
#include <string.h>
#include <sys/types.h>

#include <phantom_platform_types.h>

#define U64_MAX UINT64_MAX
#define U32_MAX UINT32_MAX
#define S32_MAX INT32_MAX
#define S32_MIN INT32_MIN

#define NSEC_PER_SEC 1000000000L
#define NSEC_PER_MSEC 1000000L
#define NSEC_PER_USEC 1000L

#define __user
#define __must_check __attribute__((warn_unused_result))
#define static_assert _Static_assert
#define ARRAY_SIZE(array) (sizeof(array) / sizeof((array)[0]))
#define container_of(pointer, type, member) ((type *)((char *)(pointer)-offsetof(type, member)))
#define u64_to_user_ptr(value) ((void *)(uintptr_t)(value))

/* Never returned here: no call is restarted. */
#define ERESTARTSYS 512

/* ---- numbers ------------------------------------------------------------- */
#define min(a, b)                                                                                  \
	({                                                                                         \
		__typeof__(a) min_a_ = (a);                                                        \
		__typeof__(b) min_b_ = (b);                                                        \
		min_a_ < min_b_ ? min_a_ : min_b_;                                                 \
	})
#define max(a, b)                                                                                  \
	({                                                                                         \
		__typeof__(a) max_a_ = (a);                                                        \
		__typeof__(b) max_b_ = (b);                                                        \
		max_a_ > max_b_ ? max_a_ : max_b_;                                                 \
	})
#define min_t(type, a, b) min((type)(a), (type)(b))
#define max_t(type, a, b) max((type)(a), (type)(b))
#define clamp_t(type, value, low, high) min_t(type, max_t(type, value, low), high)

static inline u32 ilog2(u32 value)
{
	return 31 - (u32)__builtin_clz(value);
}

u32 int_sqrt64(u64 value); /* floor */

/* ---- errors carried in pointers ------------------------------------------ */
static inline void *ERR_PTR(long error)
{
	return (void *)error;
}

static inline long PTR_ERR(const void *pointer)
{
	return (long)pointer;
}

static inline bool IS_ERR(const void *pointer)
{
	return (uintptr_t)pointer >= (uintptr_t)-4095;
}

/* ---- memory order -------------------------------------------------------- */
#define READ_ONCE(x) __atomic_load_n(&(x), __ATOMIC_RELAXED)
#define WRITE_ONCE(x, value) __atomic_store_n(&(x), (value), __ATOMIC_RELAXED)
#define smp_load_acquire(pointer) __atomic_load_n((pointer), __ATOMIC_ACQUIRE)
#define smp_store_release(pointer, value) __atomic_store_n((pointer), (value), __ATOMIC_RELEASE)
#define xchg(pointer, value) __atomic_exchange_n((pointer), (value), __ATOMIC_SEQ_CST)
#define smp_rmb() __asm__ volatile("" ::: "memory")
#define smp_wmb() __asm__ volatile("" ::: "memory")
#define smp_mb() __asm__ volatile("lock; addl $0, -4(%%rsp)" ::: "memory", "cc")

typedef struct {
	int counter;
} atomic_t;

static inline int atomic_read(const atomic_t *value)
{
	return READ_ONCE(value->counter);
}

static inline void atomic_add(int amount, atomic_t *value)
{
	__atomic_fetch_add(&value->counter, amount, __ATOMIC_RELAXED);
}

/* ---- allocation: may be told to fail (phantom_usermode.h) ---------------- */
typedef unsigned int gfp_t;
#define GFP_KERNEL 0U

void *kzalloc(size_t size, gfp_t flags);
void kfree(const void *memory);
void *vzalloc(unsigned long size);
void vfree(const void *memory);

/* Zeroed memory that others may look at; a multiple of the page size. NULL without memory. */
void *phantom_platform_share(size_t size);
/* Of what share() gave, or of a view. */
void phantom_platform_unshare(const void *page, size_t size);
/* The same memory once more, read-only. NULL without memory. */
const void *phantom_platform_view(void *page, size_t size);

/* ---- the caller's memory ------------------------------------------------- */
/* Bytes not copied. The first 64 KiB of the address space are nobody's; all else is believed. */
unsigned long copy_from_user(void *to, const void *from, unsigned long size);
unsigned long copy_to_user(void *to, const void *from, unsigned long size);

/* ---- mutexes with priority inheritance, as on PREEMPT_RT ----------------- */
struct task_struct; /* a thread; never looked into */
struct task_struct *phantom_platform_current(void);
#define current phantom_platform_current()

struct mutex {
	pthread_mutex_t lock;
	struct task_struct *holder; /* word */
};

void mutex_init(struct mutex *mutex);
void mutex_destroy(struct mutex *mutex);
void mutex_lock(struct mutex *mutex);
void mutex_unlock(struct mutex *mutex);

/* ---- contexts: what a debug kernel warns of ends the process, in every build */
bool lockdep_is_held(const struct mutex *mutex);
bool phantom_platform_in_section(void);
/* Aborts when inside a float section. */
void phantom_platform_may_sleep(const char *what);
__attribute__((noreturn)) void phantom_platform_broken(const char *rule, const char *where);
#define lockdep_assert(rule) ((rule) ? (void)0 : phantom_platform_broken(#rule, __func__))
#define lockdep_assert_held(mutex) lockdep_assert(lockdep_is_held(mutex))
#define lockdep_assert_not_held(mutex) lockdep_assert(!lockdep_is_held(mutex))
#define lockdep_assert_preemption_disabled() lockdep_assert(phantom_platform_in_section())
#define lockdep_assert_preemption_enabled() lockdep_assert(!phantom_platform_in_section())
#define might_sleep() phantom_platform_may_sleep(__func__)

/* ---- wait queues --------------------------------------------------------- */
typedef struct {
	pthread_mutex_t lock;
	pthread_cond_t changed; /* on CLOCK_MONOTONIC */
	u32 sleepers;
} wait_queue_head_t;

void init_waitqueue_head(wait_queue_head_t *queue);
void phantom_platform_wait_destroy(wait_queue_head_t *queue);
void phantom_platform_wait_begin(wait_queue_head_t *queue);
/* False when deadline_ns (CLOCK_MONOTONIC; U64_MAX = never) has passed. */
bool phantom_platform_wait(wait_queue_head_t *queue, u64 deadline_ns);
void phantom_platform_wait_end(wait_queue_head_t *queue);
bool wq_has_sleeper(wait_queue_head_t *queue);
void wake_up_interruptible(wait_queue_head_t *queue);

/* Nothing interrupts it here: 0. */
#define wait_event_interruptible(queue, condition)                                                 \
	({                                                                                         \
		phantom_platform_wait_begin(&(queue));                                             \
		while (!(condition))                                                               \
			phantom_platform_wait(&(queue), U64_MAX);                                  \
		phantom_platform_wait_end(&(queue));                                               \
		0;                                                                                 \
	})

typedef unsigned int __poll_t;
#define EPOLLIN POLLIN
#define EPOLLERR POLLERR
#define EPOLLHUP POLLHUP
#define EPOLLPRI POLLPRI
#define EPOLLRDNORM POLLRDNORM

/* ---- float sections ------------------------------------------------------ */
void kernel_fpu_begin(void);
void kernel_fpu_end(void);
bool phantom_platform_has_avx2(void);
bool phantom_platform_has_avx512(void); /* F and DQ */

u64 ktime_get_ns(void);

#endif /* PHANTOM_PLATFORM_H */
