// SPDX-License-Identifier: GPL-2.0-or-later
#include "fdh/search.hpp"

#include <algorithm>
#include <limits>

#include "fdh/grid.hpp"

namespace phantom::fdh {

template <int K>
ProjectedPoint<K> project(const Point& p)
{
    constexpr auto directions = hull_directions<K>();
    constexpr double farthest = 0x1p61;
    // Three terms, two additions: far below 2^-50 of the sum of magnitudes.
    const double slack = 0x1p-50 * (std::abs(p[0]) + std::abs(p[1]) + std::abs(p[2]));
    ProjectedPoint<K> result;
    for (int k = 0; k < K / 2; k++) {
        const auto& d = directions[k];
        const double x = d[0] * p[0] + d[1] * p[1] + d[2] * p[2];
        result.low[k] = round_down(std::clamp(x - slack, -farthest, farthest));
        result.high[k] = round_up(std::clamp(x + slack, -farthest, farthest));
    }
    return result;
}

float search_limit(double limit2)
{
    constexpr float infinity = std::numeric_limits<float>::infinity();
    constexpr double largest = std::numeric_limits<float>::max();
    const double padded = limit2 * (1 + 0x1p-19);
    return padded < largest / 2 ? next_up(round_up(padded)) : infinity;
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

template ProjectedPoint<6> project<6>(const Point&);
template ProjectedPoint<14> project<14>(const Point&);
template ProjectedPoint<18> project<18>(const Point&);
template ProjectedPoint<26> project<26>(const Point&);
template const SearchKernels<6>& search_kernels<6>(Isa);
template const SearchKernels<14>& search_kernels<14>(Isa);
template const SearchKernels<18>& search_kernels<18>(Isa);
template const SearchKernels<26>& search_kernels<26>(Isa);

} // namespace phantom::fdh
