// SPDX-License-Identifier: GPL-2.0-or-later
#include "scene/shapes/soup_builder.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <fmt/format.h>

namespace phantom::scene {

void stitch(SoupBuilder& builder, std::span<const ChainCorner> right, std::span<const ChainCorner> left)
{
    std::size_t r = 0, l = 0;
    while (r + 1 < right.size() || l + 1 < left.size()) {
        const bool right_next =
            l + 1 == left.size() || (r + 1 < right.size() && right[r + 1].at <= left[l + 1].at);
        if (right_next) {
            builder.face(right[r].corner, right[r + 1].corner, left[l].corner);
            ++r;
        } else {
            builder.face(right[r].corner, left[l + 1].corner, left[l].corner);
            ++l;
        }
    }
}

namespace {

/// The ring as a chain once round, its first corner at both ends.
std::vector<ChainCorner> chain_of(std::span<const std::uint32_t> ring, std::uint32_t normal, bool down)
{
    std::vector<ChainCorner> chain;
    const std::size_t count = ring.size();
    for (std::size_t i = 0; i <= count; ++i) {
        const std::size_t corner = down ? (count - i) % count : i % count;
        chain.push_back({{ring[corner], normal}, static_cast<double>(i) / static_cast<double>(count)});
    }
    return chain;
}

} // namespace

void cap(SoupBuilder& builder, std::span<const std::uint32_t> ring, double radius_mm, double z_mm, bool down)
{
    constexpr std::size_t innermost = 8; // corners that a middle point serves
    const std::uint32_t normal = builder.normal({0, 0, down ? -1.0 : 1.0});
    std::vector<std::uint32_t> outer(ring.begin(), ring.end());
    double radius = radius_mm;
    while (outer.size() > innermost) {
        const std::size_t count = std::max(innermost, (outer.size() + 1) / 2);
        // As far inward as the outer ring's corners stand apart.
        radius *= 1 - 0.9 * 2 * std::numbers::pi / static_cast<double>(outer.size());
        std::vector<std::uint32_t> inner;
        for (std::size_t i = 0; i < count; ++i) {
            const double angle = 2 * std::numbers::pi * static_cast<double>(i) / static_cast<double>(count);
            inner.push_back(builder.vertex({radius * std::cos(angle), radius * std::sin(angle), z_mm}));
        }
        stitch(builder, chain_of(outer, normal, down), chain_of(inner, normal, down));
        outer = std::move(inner);
    }
    const std::uint32_t middle = builder.vertex({0, 0, z_mm});
    const std::vector<ChainCorner> chain = chain_of(outer, normal, down);
    for (std::size_t i = 0; i + 1 < chain.size(); ++i)
        builder.face(chain[i].corner, chain[i + 1].corner, {middle, normal});
}

double circle_segments(double radius_mm, double chord_mm, double least)
{
    // The sagitta of 1/n of a circle is r (1 - cos(pi/n)) = 2 r sin^2(pi/2n).
    if (2 * chord_mm >= radius_mm)
        return least;
    const double half_angle = 2 * std::asin(std::sqrt(0.5 * chord_mm / radius_mm));
    return std::max(least, std::ceil(std::numbers::pi / half_angle));
}

Status check_count(double triangles, double chord_mm)
{
    if (triangles <= static_cast<double>(shape_triangles_max))
        return success();
    return Error{"chord_mm",
                 fmt::format("of {:g} mm takes {:.2g} triangles, expected at most {}: a larger one", chord_mm,
                             triangles, shape_triangles_max)};
}

} // namespace phantom::scene
