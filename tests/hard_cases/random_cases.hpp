// SPDX-License-Identifier: GPL-2.0-or-later
// Cases out of a number: a random mesh with random ways of the tip. The same number gives the same case.
#pragma once

#include "corpus.hpp"

namespace phantom::hard {

Case random_case(std::uint64_t seed);

} // namespace phantom::hard
