// SPDX-License-Identifier: GPL-2.0-or-later
// The instruction sets a query can be answered with. All give the same bits: no contraction, no
// approximate reciprocal, the same order of operations per lane; only the lanes per instruction differ.
#pragma once

namespace phantom::fdh {

enum class Isa {
    best,   ///< the fastest that this processor runs
    scalar, ///< one lane; runs everywhere
    sse2,
    avx2,
    avx512, ///< F, BW, DQ, VL
};

/// Whether this build and this processor have it. `best` and `scalar` always are.
[[nodiscard]] bool isa_available(Isa isa);
/// What `best` stands for here; any other value is returned as it is.
[[nodiscard]] Isa resolve_isa(Isa isa);
[[nodiscard]] const char* isa_name(Isa isa);

} // namespace phantom::fdh
