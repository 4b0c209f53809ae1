// SPDX-License-Identifier: GPL-2.0-only
/*
 * platform.c - the seam's user-mode side: allocation, the caller's memory, mutexes, wait queues
 * and float sections, with the kernel's names.
 */
#define _GNU_SOURCE
#include <stdio.h>
#include <stdlib.h>
#include <sys/mman.h>
#include <time.h>

#include <phantom_platform.h>
#include "platform_inject.h"

/* Float units want their sets on cache lines; malloc gives 16 bytes. */
#define PLATFORM_ALIGN 64

/* Nobody's memory: below the lowest address that Linux maps for anyone (vm.mmap_min_addr). */
#define PLATFORM_USER_FIRST 65536UL

/* ---- float sections ------------------------------------------------------ */

static _Thread_local bool platform_in_section;

bool phantom_platform_in_section(void)
{
	return platform_in_section;
}

void phantom_platform_may_sleep(const char *what)
{
	if (platform_in_section) {
		fprintf(stderr, "phantom_rt: %s inside a float section\n", what);
		abort();
	}
}

struct task_struct *phantom_platform_current(void)
{
	/* an address that no other living thread has */
	return (struct task_struct *)&platform_in_section;
}

void phantom_platform_broken(const char *rule, const char *where)
{
	fprintf(stderr, "phantom_rt: context rule broken in %s(): %s\n", where, rule);
	abort();
}

void kernel_fpu_begin(void)
{
	phantom_platform_may_sleep("kernel_fpu_begin()");
	platform_in_section = true;
}

void kernel_fpu_end(void)
{
	platform_in_section = false;
}

bool phantom_platform_has_avx2(void)
{
	return __builtin_cpu_supports("avx2");
}

bool phantom_platform_has_avx512(void)
{
	return __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512dq");
}

/* ---- numbers and time ---------------------------------------------------- */

u32 int_sqrt64(u64 value)
{
	u64 root = 0;
	u64 bit = 1ULL << 62;

	while (bit > value)
		bit >>= 2;
	for (; bit; bit >>= 2) {
		if (value >= root + bit) {
			value -= root + bit;
			root = (root >> 1) + bit;
		} else {
			root >>= 1;
		}
	}
	return (u32)root;
}

u64 ktime_get_ns(void)
{
	struct timespec now;

	clock_gettime(CLOCK_MONOTONIC, &now);
	return (u64)now.tv_sec * NSEC_PER_SEC + (u64)now.tv_nsec;
}

/* ---- allocation ---------------------------------------------------------- */

static _Thread_local u32 platform_fail_in;

void phantom_um_inject_allocation_failure(uint32_t nth)
{
	platform_fail_in = nth;
}

bool phantom_platform_allocation_fails(void)
{
	phantom_platform_may_sleep("an allocation");
	return platform_fail_in && --platform_fail_in == 0;
}

void *vzalloc(unsigned long size)
{
	size_t rounded = (size + PLATFORM_ALIGN - 1) & ~(size_t)(PLATFORM_ALIGN - 1);
	void *memory;

	if (phantom_platform_allocation_fails() || rounded < size)
		return NULL;
	memory = aligned_alloc(PLATFORM_ALIGN, rounded);
	if (memory)
		memset(memory, 0, rounded);
	return memory;
}

void vfree(const void *memory)
{
	phantom_platform_may_sleep("vfree()");
	free((void *)memory);
}

void *kzalloc(size_t size, gfp_t flags)
{
	(void)flags;
	return vzalloc(size);
}

void kfree(const void *memory)
{
	vfree(memory);
}

/* ---- the caller's memory ------------------------------------------------- */

static bool platform_is_nobodys(const void *memory)
{
	return (uintptr_t)memory < PLATFORM_USER_FIRST;
}

unsigned long copy_from_user(void *to, const void *from, unsigned long size)
{
	phantom_platform_may_sleep("copy_from_user()");
	if (size && platform_is_nobodys(from))
		return size;
	if (size)
		memcpy(to, from, size);
	return 0;
}

unsigned long copy_to_user(void *to, const void *from, unsigned long size)
{
	phantom_platform_may_sleep("copy_to_user()");
	if (size && platform_is_nobodys(to))
		return size;
	if (size)
		memcpy(to, from, size);
	return 0;
}

/* ---- mutexes ------------------------------------------------------------- */

static void platform_lock_init(pthread_mutex_t *lock)
{
	pthread_mutexattr_t attributes;

	pthread_mutexattr_init(&attributes);
	pthread_mutexattr_setprotocol(&attributes, PTHREAD_PRIO_INHERIT);
	pthread_mutex_init(lock, &attributes);
	pthread_mutexattr_destroy(&attributes);
}

void mutex_init(struct mutex *mutex)
{
	platform_lock_init(&mutex->lock);
	mutex->holder = NULL;
}

void mutex_destroy(struct mutex *mutex)
{
	pthread_mutex_destroy(&mutex->lock);
}

void mutex_lock(struct mutex *mutex)
{
	phantom_platform_may_sleep("mutex_lock()");
	pthread_mutex_lock(&mutex->lock);
	WRITE_ONCE(mutex->holder, current);
}

void mutex_unlock(struct mutex *mutex)
{
	WRITE_ONCE(mutex->holder, NULL);
	pthread_mutex_unlock(&mutex->lock);
}

bool lockdep_is_held(const struct mutex *mutex)
{
	return READ_ONCE(mutex->holder) == current;
}

/* ---- wait queues --------------------------------------------------------- */

void init_waitqueue_head(wait_queue_head_t *queue)
{
	pthread_condattr_t attributes;

	platform_lock_init(&queue->lock);
	pthread_condattr_init(&attributes);
	pthread_condattr_setclock(&attributes, CLOCK_MONOTONIC);
	pthread_cond_init(&queue->changed, &attributes);
	pthread_condattr_destroy(&attributes);
	queue->sleepers = 0;
}

void phantom_platform_wait_destroy(wait_queue_head_t *queue)
{
	pthread_cond_destroy(&queue->changed);
	pthread_mutex_destroy(&queue->lock);
}

void phantom_platform_wait_begin(wait_queue_head_t *queue)
{
	phantom_platform_may_sleep("a wait");
	pthread_mutex_lock(&queue->lock);
	/* a full barrier: the condition is looked at after the waker can see us */
	__atomic_add_fetch(&queue->sleepers, 1, __ATOMIC_SEQ_CST);
}

bool phantom_platform_wait(wait_queue_head_t *queue, u64 deadline_ns)
{
	struct timespec deadline = {
		.tv_sec = (time_t)(deadline_ns / NSEC_PER_SEC),
		.tv_nsec = (long)(deadline_ns % NSEC_PER_SEC),
	};

	if (deadline_ns == U64_MAX)
		return !pthread_cond_wait(&queue->changed, &queue->lock);
	return pthread_cond_timedwait(&queue->changed, &queue->lock, &deadline) != ETIMEDOUT;
}

void phantom_platform_wait_end(wait_queue_head_t *queue)
{
	__atomic_sub_fetch(&queue->sleepers, 1, __ATOMIC_SEQ_CST);
	pthread_mutex_unlock(&queue->lock);
}

bool wq_has_sleeper(wait_queue_head_t *queue)
{
	smp_mb(); /* what the sleeper waits for is stored before we look for a sleeper */
	return __atomic_load_n(&queue->sleepers, __ATOMIC_SEQ_CST) != 0;
}

void wake_up_interruptible(wait_queue_head_t *queue)
{
	phantom_platform_may_sleep("wake_up_interruptible()");
	pthread_mutex_lock(&queue->lock);
	pthread_cond_broadcast(&queue->changed);
	pthread_mutex_unlock(&queue->lock);
}
