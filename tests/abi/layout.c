// SPDX-License-Identifier: GPL-2.0-or-later
// The ABI's layout as a C program sees it. Compiles or does not; also compiled for 32 bits, where nothing may
// differ.
#include "phantom_abi.h"

#define SIZE(type, bytes)                                                                                    \
    _Static_assert(sizeof(struct type) == (bytes), "size of " #type);                                        \
    _Static_assert((bytes) % 8 == 0, "size of " #type " is no multiple of 8");
#define OFFSET(type, field, bytes)                                                                           \
    _Static_assert(__builtin_offsetof(struct type, field) == (bytes), "offset of " #type "." #field);
#define NUMBER(name, value) _Static_assert((name) == (value), "number of " #name);
#include "layout.inc"

// A file without a declaration of its own is no C program.
extern int phantom_abi_layout_is_checked;
