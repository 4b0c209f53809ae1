// SPDX-License-Identifier: GPL-2.0-or-later
// The live application: feeder, servo, mouse and picture.
#pragma once

#include "base/result.hpp"
#include "view/options.hpp"

namespace phantom::view {

/// Opens the scene and a device, and shows them: in a window until the user ends it, or for a while
/// without one when a picture is asked for. A display must be there.
Status run_live_view(const Options& options);

} // namespace phantom::view
