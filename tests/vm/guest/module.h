// SPDX-License-Identifier: GPL-2.0-or-later
// module.h - loading and unloading phantom_rt.ko.
#ifndef VM_MODULE_H
#define VM_MODULE_H

#include <stdbool.h>
#include <stddef.h>

#define VM_MODULE_FILE "/phantom_rt.ko"
#define VM_MODULE_NAME "phantom_rt"

/* 0 or -errno of finit_module(2), with parameters as insmod takes them. */
int vm_module_load(const char* parameters);
/* 0 or -errno of delete_module(2), never waiting. */
int vm_module_unload(void);
bool vm_module_is_loaded(void);

/* Reads a whole small file; "" when it is not there. */
void vm_read_file(const char* path, char* text, size_t size);

#endif /* VM_MODULE_H */
