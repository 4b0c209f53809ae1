// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include "base/result.hpp"
#include "view/options.hpp"

namespace phantom::view {

/// --survey: the scene from two sides, with its creases, rims, faults and thin coverage in colour and a
/// legend.
Status run_survey_view(const Options& options);

} // namespace phantom::view
