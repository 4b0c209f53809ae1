// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include <string>

namespace phantom::fdhread {

/// What is wrong with the chunks of a 3DS file: one that ends outside of what it lies in, which VTK's reader
/// would follow for ever; empty when nothing is.
std::string bad_chunk(const std::string& file);

} // namespace phantom::fdhread
