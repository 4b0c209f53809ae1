// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include <string>
#include <vector>

namespace phantom::fdhctl {

/// Becomes fdhview with these arguments. Comes back only when that fails: it has been told, and the exit
/// status is given.
int exec_view(const std::vector<std::string>& arguments);

} // namespace phantom::fdhctl
