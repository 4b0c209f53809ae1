// SPDX-License-Identifier: GPL-2.0-or-later
// The whole machine under a surface: real queries, sets of 64 triangles, the module on its virtual clock,
// against the nearest point by brute force. penetration_bench prints the large version.
#include <gtest/gtest.h>

#include "study/penetration.hpp"

namespace {

using namespace phantom;

class Penetration : public testing::Test {
  protected:
    static void SetUpTestSuite()
    {
        scene_ = new scene::Scene(study::penetration_scene(*study::bumpy_sphere(32)));
        tree_ = new fdh::SceneTree<14>(scene::build_tree<14>(*scene_));
        oracle_ = new study::BruteForce(scene_->objects[0].mesh);
    }
    static void TearDownTestSuite()
    {
        delete oracle_;
        delete tree_;
        delete scene_;
    }
    static study::PenetrationResult run(double speed_mm_s, double rate_hz, std::uint32_t feed_every)
    {
        study::PenetrationOptions options;
        options.path = {
            .speed_mm_s = speed_mm_s, .seconds = 1.2, .rate_hz = rate_hz, .lift_s = 0.6, .lifting_s = 0.1};
        options.feed_every = feed_every;
        options.grow_budget = feed_every > 1;
        options.check_every = 8;
        const auto result = study::run_penetration(*scene_, *tree_, *oracle_, options);
        EXPECT_TRUE(result) << result.error().text();
        return *result;
    }
    static void expect_held(const study::PenetrationResult& result)
    {
        EXPECT_GT(result.under, 80U);
        EXPECT_GT(result.outside, 10U);
        EXPECT_EQ(result.lost, 0U);
        EXPECT_EQ(result.fell_through, 0U);
        EXPECT_EQ(result.stuck, 0U);
        EXPECT_EQ(result.kept, 0U);
        EXPECT_LE(result.error_p99, 0.001);
    }

    static scene::Scene* scene_;
    static fdh::SceneTree<14>* tree_;
    static study::BruteForce* oracle_;
};

scene::Scene* Penetration::scene_ = nullptr;
fdh::SceneTree<14>* Penetration::tree_ = nullptr;
study::BruteForce* Penetration::oracle_ = nullptr;

TEST_F(Penetration, OfABumpySphereIsHeldAtTheNearestPointAtEverySpeed)
{
    for (const double speed_mm_s : {20.0, 100.0, 500.0}) {
        SCOPED_TRACE(speed_mm_s);
        expect_held(run(speed_mm_s, 1000, 1));
    }
}

TEST_F(Penetration, WithSetsTenMillisecondsOldIsTheSame)
{
    for (const double speed_mm_s : {20.0, 500.0}) {
        SCOPED_TRACE(speed_mm_s);
        expect_held(run(speed_mm_s, 1000, 10));
    }
}

} // namespace
