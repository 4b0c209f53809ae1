// SPDX-License-Identifier: GPL-2.0-or-later
#include "fdh/search.hpp"

#include <algorithm>
#include <cmath>

#include "fdh/grid.hpp"

namespace phantom::fdh {

template <int K>
SearchPoint<K> search_point(const Point& steps, double longest_edge, bool prefetch)
{
    constexpr auto directions = hull_directions<K>();
    SearchPoint<K> point;
    float rounded[3];
    for (int i = 0; i < 3; i++) {
        constexpr double to_whole = 0x1.8p52; // where doubles are one apart
        const double whole = steps[i] + to_whole - to_whole;
        point.exact[i] = steps[i];
        point.whole[i] = static_cast<float>(whole);
        point.fraction[i] = static_cast<float>(steps[i] - whole);
        rounded[i] = static_cast<float>(steps[i]);
    }
    for (int k = 0; k < K / 2; k++) {
        const auto& d = directions[k];
        point.projected[k] = static_cast<float>(d[0]) * rounded[0] + static_cast<float>(d[1]) * rounded[1] +
                             static_cast<float>(d[2]) * rounded[2];
    }
    // A coordinate is off by one step at most, the sum of three by six; a bound by no more than the root of
    // the diagonals' Σ e² / 4: six. The search's own rounding is allowed for there.
    constexpr double projection_steps = 8;
    point.hull_slack = static_cast<float>(projection_steps + 1.01 * float_error * longest_edge);
    point.prefetch = prefetch;
    return point;
}

float search_limit2(double limit)
{
    // More than the square of any distance from within farthest_point.
    constexpr double largest = 0x1p60;
    return next_up(round_up(std::min(limit * limit, largest)));
}

template <int K>
const SearchKernels<K>& search_kernels(Isa isa)
{
    switch (resolve_isa(isa)) {
#ifdef PHANTOM_FDH_X86
    case Isa::sse2:
        return kernels_of<Isa::sse2, K>();
    case Isa::avx2:
        return kernels_of<Isa::avx2, K>();
    case Isa::avx512:
        return kernels_of<Isa::avx512, K>();
#endif
    default:
        return kernels_of<Isa::scalar, K>();
    }
}

#define PHANTOM_FDH_SEARCH_FOR(K)                                                                            \
    template SearchPoint<K> search_point<K>(const Point&, double, bool);                                     \
    template const SearchKernels<K>& search_kernels<K>(Isa);
PHANTOM_FDH_SEARCH_FOR(6)
PHANTOM_FDH_SEARCH_FOR(14)
PHANTOM_FDH_SEARCH_FOR(18)
PHANTOM_FDH_SEARCH_FOR(26)

} // namespace phantom::fdh
