// SPDX-License-Identifier: GPL-2.0-or-later
// What one tick of a section costs with 64 patches. By itself in ns, the median of many batches; under
// callgrind in instructions, one dump for each figure (tools/tick-instructions reads them). No test.
#include <algorithm>
#include <chrono>
#include <cstdio>

#include <fmt/format.h>
#if __has_include(<valgrind/callgrind.h>)
#include <valgrind/callgrind.h>
#define COUNTING (RUNNING_ON_VALGRIND != 0)
#else
#define COUNTING false
#define CALLGRIND_ZERO_STATS
#define CALLGRIND_DUMP_STATS_AT(name) (void)(name)
#endif

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

/// One pass over the tips, then a dump of what it took; the script divides by their number.
void count_instructions(Contact& contact, const std::vector<Vec3>& tips, const std::string& label)
{
    const std::string name = fmt::format("{} / {}", tips.size(), label);
    for (const Vec3& tip : tips) // the first tick after a restart looks for no crossing
        contact.tick(tip);
    CALLGRIND_ZERO_STATS;
    for (const Vec3& tip : tips)
        contact.tick(tip);
    CALLGRIND_DUMP_STATS_AT(name.c_str());
}

void measure(const char* name, const std::vector<reference::Triangle>& triangles, double low, double high)
{
    if (triangles.empty())
        return;
    struct Column {
        const char* name;
        std::uint32_t model, steps;
    };
    std::mt19937 random(1);
    std::vector<Vec3> tips;
    for (int i = 0; i < 32; ++i)
        tips.push_back(point_near({triangles[0], triangles[1], triangles[2]}, random, low, high));
    for (const phantom_float_ops* ops : sections()) {
        if (!COUNTING)
            fmt::print("{:<15} {:<7}", name, ops->name);
        for (const Column& column :
             {Column{"paper", PHANTOM_MODEL_PAPER, 0}, Column{"projected/1", PHANTOM_MODEL_PROJECTED, 1},
              Column{"projected/2", PHANTOM_MODEL_PROJECTED, 2},
              Column{"projected/3", PHANTOM_MODEL_PROJECTED, 3},
              Column{"call alone", PHANTOM_MODEL_OFF, 0}}) {
            Settings settings;
            settings.model = column.model;
            settings.newton_steps = column.steps;
            settings.proxy = PHANTOM_PROXY_CONSTRAINED;
            Contact contact(*ops, triangles, settings);
            if (COUNTING)
                count_instructions(contact, tips, fmt::format("{} / {} / {}", name, ops->name, column.name));
            else
                fmt::print("  {} {:5.0f}", column.name, median_ns(contact, tips));
        }
        if (!COUNTING)
            fmt::print(" ns\n");
    }
}

} // namespace

int main()
{
    measure("typical", typical(), 0.1, 1.8);
    measure("all in contact", layers(), 0.5, 1.5);
    measure("bunny", scan(), 0.1, 0.9);
    return 0;
}
