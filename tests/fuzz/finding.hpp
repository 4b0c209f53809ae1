// SPDX-License-Identifier: GPL-2.0-or-later
// What is thrown where a result is wrong although nothing crashed. The fuzzer aborts on it, the corpus
// test fails.
#pragma once

#include <stdexcept>
#include <string>

namespace phantom::fuzz {

struct Finding : std::runtime_error {
    using std::runtime_error::runtime_error;
};

inline void must(bool holds, const char* sentence)
{
    if (!holds)
        throw Finding(sentence);
}

} // namespace phantom::fuzz
