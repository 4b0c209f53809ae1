// SPDX-License-Identifier: GPL-2.0-or-later
// Force over time as a picture of its own.
#pragma once

#include <deque>
#include <filesystem>
#include <optional>

#include "base/result.hpp"
#include "view/options.hpp"
#include "view/touch.hpp"

namespace phantom::view {

/// |F| and its components over all samples (at least one), with a mark at marked_s, as PNG of the
/// options' width and half their height.
Status save_chart(const std::deque<Touch>& samples, std::optional<double> marked_s, const Options& options,
                  const std::filesystem::path& file);

} // namespace phantom::view
