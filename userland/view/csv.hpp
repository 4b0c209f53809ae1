// SPDX-License-Identifier: GPL-2.0-or-later
// Tables of numbers: a header line, then rows of finite numbers.
#pragma once

#include <filesystem>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "base/result.hpp"

namespace phantom::view {

/// Reads `file` and hands each row to `take`, which may refuse it. Errors name file:line and what was
/// expected. `what` names the kind of file ("trace"), `remedy` what to do when it is missing.
Status read_table(const std::filesystem::path& file, const std::string& header, const std::string& what,
                  const std::string& remedy,
                  const std::function<Status(std::span<const double> row, const std::string& where)>& take);

} // namespace phantom::view
