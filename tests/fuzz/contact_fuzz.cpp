// SPDX-License-Identifier: GPL-2.0-or-later
// libFuzzer's entry.
#include <cstdio>
#include <cstdlib>

#include "finding.hpp"
#include "script.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size)
{
    try {
        phantom::fuzz::play(data, size);
    } catch (const phantom::fuzz::Finding& finding) {
        std::fprintf(stderr, "contact_fuzz: %s\n", finding.what());
        std::abort();
    }
    return 0;
}
