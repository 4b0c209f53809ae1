// SPDX-License-Identifier: GPL-2.0-or-later
// Every scene of scenes/ is stroked for a second by the module's own code, with the limits of a real device.
#include <algorithm>
#include <cmath>
#include <sstream>

#include <gtest/gtest.h>

#include "study/stroke.hpp"
#include "study/trace.hpp"

namespace phantom::test {
namespace {

std::vector<std::filesystem::path> shipped_scenes()
{
    std::vector<std::filesystem::path> out;
    for (const auto& entry :
         std::filesystem::directory_iterator(std::filesystem::path(PHANTOM_ROOT) / "scenes"))
        if (entry.path().extension() == ".toml")
            out.push_back(entry.path());
    std::sort(out.begin(), out.end());
    return out;
}

class ShippedScene : public testing::TestWithParam<std::filesystem::path> {};

TEST_P(ShippedScene, IsFeltWithoutAFault)
{
    if (GetParam().stem() == "bunny" && !std::filesystem::exists("/usr/share/glmark2/models/bunny.obj"))
        GTEST_SKIP() << "package glmark2-data is not installed";
    const auto scene = scene::load(GetParam(), {});
    ASSERT_TRUE(scene) << scene.error().text();
    const fdh::SceneTree<14> tree = scene::build_tree<14>(*scene);
    study::StrokeOptions stroke;
    stroke.seconds = 1;
    stroke.speed_limit_mm_s = 500; // some scenes are wide
    stroke.rate_hz = scene->servo.rate_hz.value_or(1000);
    const auto path = study::make_stroke(*scene, tree, stroke);
    ASSERT_TRUE(path) << path.error().text();
    study::TraceOptions options;
    options.limits = true;
    const auto run = study::run_trace(*scene, *path, options);
    ASSERT_TRUE(run) << run.error().text();
    EXPECT_EQ(run->summary.faults, "none");
    EXPECT_EQ(run->summary.saturated, 0U);
    EXPECT_EQ(run->summary.uncovered_ticks, 0U);
    EXPECT_GT(run->summary.contact_ticks, path->size() / 20);
    EXPECT_GT(run->summary.force_max_n, 0.05);
    EXPECT_LT(run->summary.force_max_n, 10.0);
    EXPECT_EQ(run->csv.find("nan"), std::string::npos);
    EXPECT_EQ(run->csv.find("inf,"), std::string::npos);
}

INSTANTIATE_TEST_SUITE_P(Shipped, ShippedScene, testing::ValuesIn(shipped_scenes()),
                         [](const auto& scene) { return scene.param.stem().string(); });

} // namespace
} // namespace phantom::test
