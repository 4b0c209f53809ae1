// SPDX-License-Identifier: GPL-2.0-or-later
#include "study/peers/agreement.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "mesh/nearest_on_triangle.hpp"
#include "study/peers/contender.hpp"

namespace phantom::peers {

namespace {

/// Rounding of a distance in float, in parts of the radius: coordinates relative to the point are exact or
/// nearly so, a dozen operations follow.
constexpr double float_rounding = 1e-5;

/// Sorted, one for each of the 64 places; a place nothing was found for stands at the radius.
void complete(std::vector<double>& distances, double radius)
{
    for (double& distance : distances)
        distance = std::min(distance, radius);
    if (distances.size() < wanted)
        distances.resize(wanted, radius);
    std::sort(distances.begin(), distances.end());
}

} // namespace

double tolerance_mm(double accuracy, double radius)
{
    return 2 * accuracy + float_rounding * radius;
}

std::optional<std::string> disagreement(std::vector<double> answer, std::vector<double> expected,
                                        double radius, double tolerance)
{
    if (answer.size() > wanted)
        return fmt::format("{} triangles instead of {}", answer.size(), wanted);
    for (const double distance : answer)
        if (!(distance >= 0))
            return fmt::format("{} is no distance", distance);
    complete(answer, radius);
    complete(expected, radius);
    for (std::size_t i = 0; i < wanted; ++i)
        if (std::abs(answer[i] - expected[i]) > tolerance)
            return fmt::format("number {} of the nearest is at {:.9g} mm, not {:.9g} (tolerance {:.2g})",
                               i + 1, answer[i], expected[i], tolerance);
    return std::nullopt;
}

std::vector<double> brute_force(const Mesh& mesh, const fdh::Point& p, double radius)
{
    std::vector<double> near;
    for (std::size_t i = 0; i < mesh.triangles.size(); ++i)
        if (const double distance = mesh::distance_to_triangle(p, mesh.corners(i)); distance <= radius)
            near.push_back(distance);
    const std::size_t kept = std::min(wanted, near.size());
    std::partial_sort(near.begin(), near.begin() + static_cast<std::ptrdiff_t>(kept), near.end());
    near.resize(kept);
    return near;
}

} // namespace phantom::peers
