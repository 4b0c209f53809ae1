// SPDX-License-Identifier: GPL-2.0-only
/*
 * shared_page.c - memory that the module writes and everyone else can only read, as a mapping of
 * the device node is: the same pages at two addresses, the second one read-only.
 */
#define _GNU_SOURCE
#include <sys/mman.h>

#include <phantom_platform.h>
#include "platform_inject.h"

void *phantom_platform_share(size_t size)
{
	void *page;

	if (phantom_platform_allocation_fails())
		return NULL;
	page = mmap(NULL, size, PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0);
	return page == MAP_FAILED ? NULL : page;
}

const void *phantom_platform_view(void *page, size_t size)
{
	/* an old size of 0 asks for a second mapping of shared pages */
	void *view = mremap(page, 0, size, MREMAP_MAYMOVE);

	if (view == MAP_FAILED)
		return NULL;
	if (mprotect(view, size, PROT_READ)) {
		munmap(view, size);
		return NULL;
	}
	return view;
}

void phantom_platform_unshare(const void *page, size_t size)
{
	munmap((void *)page, size);
}
