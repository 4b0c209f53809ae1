/* SPDX-License-Identifier: GPL-2.0-only */
/* platform_inject.h - where the user-mode platform lets a test make an allocation fail. */
#ifndef PHANTOM_PLATFORM_INJECT_H
#define PHANTOM_PLATFORM_INJECT_H

#include <stdbool.h>
#include "phantom_usermode.h"

/* Counts one allocation of this thread; true when it is the one to fail. */
bool phantom_platform_allocation_fails(void);

#endif /* PHANTOM_PLATFORM_INJECT_H */
