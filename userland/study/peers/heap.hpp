// SPDX-License-Identifier: GPL-2.0-or-later
// Memory in use, for libraries that do not tell what theirs is.
#pragma once

#include <malloc.h>

#include <cstddef>

namespace phantom::peers {

/// Bytes that malloc has given out and not got back.
inline std::size_t heap_bytes()
{
    const struct mallinfo2 info = mallinfo2();
    return info.uordblks + info.hblkhd;
}

} // namespace phantom::peers
