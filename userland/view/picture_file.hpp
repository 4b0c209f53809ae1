// SPDX-License-Identifier: GPL-2.0-or-later
// A window's content as a PNG file.
#pragma once

#include <filesystem>

#include <vtkRenderWindow.h>

#include "base/result.hpp"

namespace phantom::view {

/// How much larger pictures are drawn than written, when no person watches.
inline constexpr int picture_oversampling = 2;

/// Writes what the window shows, each side divided by `shrink` (means of squares of pixels). To a temporary
/// file beside it, then renamed: whole or not at all.
Status save_window(vtkRenderWindow* window, const std::filesystem::path& file, int shrink);

} // namespace phantom::view
