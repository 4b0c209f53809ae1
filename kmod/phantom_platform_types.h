/* SPDX-License-Identifier: GPL-2.0-only */
/*
 * phantom_platform_types.h - u8 ... s64, bool and size_t, and nothing else: all that a float unit
 * may see of its surroundings. The user-mode build has a header of the same name, found first.
 */
#ifndef PHANTOM_PLATFORM_TYPES_H
#define PHANTOM_PLATFORM_TYPES_H

#include <linux/types.h>

#endif /* PHANTOM_PLATFORM_TYPES_H */
