// SPDX-License-Identifier: GPL-2.0-or-later
// The suite that runs inside the virtual machine. `vmtest GROUP | GROUP.NAME ...` runs, `vmtest` lists.
#include "harness.h"

int main(int argc, char** argv)
{
    if (argc == 1) {
        vm_list();
        return 0;
    }
    return vm_run(argv + 1, argc - 1);
}
