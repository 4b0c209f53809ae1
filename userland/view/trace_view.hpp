// SPDX-License-Identifier: GPL-2.0-or-later
// A recorded trace: its path over the scene, and the moment of its largest force.
#pragma once

#include "base/result.hpp"
#include "view/options.hpp"

namespace phantom::view {

/// Loads scene and trace, writes the pictures asked for or opens a window. A display must be there.
Status run_trace_view(const Options& options);

} // namespace phantom::view
