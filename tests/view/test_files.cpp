// SPDX-License-Identifier: GPL-2.0-or-later
#include "test_files.hpp"

#include <cmath>
#include <numbers>

#include <fmt/format.h>

#include "view/trace.hpp"

namespace phantom::view::test {

namespace {

constexpr double sphere_mm = 30;
constexpr int rings = 36, segments = 72;

} // namespace

std::string sphere_off()
{
    constexpr double pi = std::numbers::pi;
    const int vertices = (rings - 1) * segments + 2, faces = 2 * (rings - 1) * segments;
    std::string text = fmt::format("OFF\n{} {} 0\n", vertices, faces);
    for (int ring = 1; ring < rings; ++ring)
        for (int i = 0; i < segments; ++i)
            text += fmt::format("{:.9g} {:.9g} {:.9g}\n",
                                sphere_mm * std::sin(pi * ring / rings) * std::cos(2 * pi * i / segments),
                                sphere_mm * std::cos(pi * ring / rings),
                                -sphere_mm * std::sin(pi * ring / rings) * std::sin(2 * pi * i / segments));
    text += fmt::format("0 {0} 0\n0 -{0} 0\n", sphere_mm);
    const auto at = [](int ring, int i) { return (ring - 1) * segments + i % segments; };
    for (int i = 0; i < segments; ++i) {
        text += fmt::format("3 {} {} {}\n", vertices - 2, at(1, i), at(1, i + 1));
        text += fmt::format("3 {} {} {}\n", vertices - 1, at(rings - 1, i + 1), at(rings - 1, i));
        for (int ring = 1; ring + 1 < rings; ++ring) {
            text += fmt::format("3 {} {} {}\n", at(ring, i), at(ring + 1, i), at(ring + 1, i + 1));
            text += fmt::format("3 {} {} {}\n", at(ring, i), at(ring + 1, i + 1), at(ring, i + 1));
        }
    }
    return text;
}

std::string sphere_trace()
{
    std::string text = std::string(trace_header) + "\n";
    constexpr int rows = 400;
    for (int i = 0; i < rows; ++i) {
        const double part = static_cast<double>(i) / (rows - 1);
        const double angle = -0.6 + 1.2 * part;
        const Vec3 out{std::sin(angle) * 0.9, std::sqrt(1 - 0.81) * 1.0, std::cos(angle) * 0.9};
        const Vec3 normal = unit_or(out, {0, 0, 1});
        const double height_mm = 0.7 + 0.5 * std::cos(2 * std::numbers::pi * part);
        const Vec3 tip = (sphere_mm + height_mm) * normal;
        const Vec3 force = std::max(0.0, 1 - height_mm) * normal;
        text += fmt::format(
            "{:.9g},{:.9g},{:.9g},{:.9g},{:.9g},{:.9g},{:.9g},{},0,{:.9g},{:.9g},{:.9g},{},10,800\n",
            0.001 * i, tip[0], tip[1], tip[2], force[0], force[1], force[2], height_mm < 1 ? 1 : 0, tip[0],
            tip[1], tip[2], 1 + i / 4);
    }
    return text;
}

} // namespace phantom::view::test
