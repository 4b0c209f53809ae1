// SPDX-License-Identifier: GPL-2.0-or-later
// Times of one float-section tick with 64 patches: median ns of many batches. No test.
#include <algorithm>
#include <chrono>
#include <cstdio>

#include "contact.hpp"
#include "shapes_of_interest.hpp"

namespace {

using namespace phantom;
using namespace phantom::hard;

/// The 64 triangles of a sphere of 50 mm, about 1 mm each, nearest to its top.
std::vector<reference::Triangle> typical()
{
    auto triangles = sphere(5, 50).triangles(1, 2);
    const Vec3 top = unit({0.3, 0.5, 0.9});
    std::partial_sort(
        triangles.begin(), triangles.begin() + 64, triangles.end(),
        [&](const auto& a, const auto& b) { return dot(a.corner[0], top) > dot(b.corner[0], top); });
    triangles.resize(64);
    return triangles;
}

/// 64 layers, 0.01 mm apart: every one is in contact.
std::vector<reference::Triangle> layers()
{
    std::vector<reference::Triangle> out;
    for (std::uint32_t i = 0; i < 64; ++i) {
        reference::Triangle t;
        t.corner = {Vec3{2, 0, -0.01 * i}, Vec3{-1, 1.7, -0.01 * i}, Vec3{-1, -1.7, -0.01 * i}};
        for (std::size_t k = 0; k < 3; ++k)
            t.normal[k] = on_unit_grid(unit({0.1 * t.corner[k][0], 0.1 * t.corner[k][1], 1}));
        t.vertex = {3 * i, 3 * i + 1, 3 * i + 2};
        t.radius = 3;
        out.push_back(t);
    }
    return out;
}

/// Bunny near a random vertex: what a scan asks for. Empty without glmark2-data.
std::vector<reference::Triangle> scan()
{
    auto triangles = bunny(120).triangles(1, 1);
    if (triangles.empty())
        return triangles;
    const Vec3 at = triangles[20000].corner[0];
    std::partial_sort(triangles.begin(), triangles.begin() + 64, triangles.end(),
                      [&](const auto& a, const auto& b) {
                          return length(subtract(a.corner[0], at)) < length(subtract(b.corner[0], at));
                      });
    triangles.resize(64);
    return triangles;
}

double median_ns(Contact& contact, const std::vector<Vec3>& tips)
{
    constexpr int batches = 400, ticks = 200;
    std::vector<double> ns;
    for (int batch = 0; batch < batches; ++batch) {
        const auto begin = std::chrono::steady_clock::now();
        for (int i = 0; i < ticks; ++i)
            contact.tick(tips[static_cast<std::size_t>(i) % tips.size()]);
        const std::chrono::duration<double, std::nano> took = std::chrono::steady_clock::now() - begin;
        ns.push_back(took.count() / ticks);
    }
    std::nth_element(ns.begin(), ns.begin() + batches / 2, ns.end());
    return ns[batches / 2];
}

void measure(const char* name, const std::vector<reference::Triangle>& triangles, double low, double high)
{
    if (triangles.empty())
        return;
    std::mt19937 random(1);
    std::vector<Vec3> tips;
    for (int i = 0; i < 32; ++i)
        tips.push_back(point_near({triangles[0], triangles[1], triangles[2]}, random, low, high));
    for (const phantom_float_ops* ops : sections()) {
        Settings settings;
        settings.model = PHANTOM_MODEL_PAPER;
        settings.proxy = PHANTOM_PROXY_PAPER;
        Contact paper(*ops, triangles, settings);
        std::printf("%-10s %-7s paper %7.0f", name, ops->name, median_ns(paper, tips));
        settings.model = PHANTOM_MODEL_PROJECTED;
        for (settings.newton_steps = 1; settings.newton_steps <= 3; ++settings.newton_steps) {
            Contact projected(*ops, triangles, settings);
            std::printf("  projected/%u %7.0f", settings.newton_steps, median_ns(projected, tips));
        }
        settings.model = PHANTOM_MODEL_OFF;
        Contact off(*ops, triangles, settings);
        std::printf("  (call alone %4.0f) ns\n", median_ns(off, tips));
    }
}

} // namespace

int main()
{
    measure("typical", typical(), 0.1, 1.8);
    measure("layers", layers(), 0.5, 1.5);
    measure("bunny", scan(), 0.1, 0.9);
    return 0;
}
