// SPDX-License-Identifier: GPL-2.0-or-later
#include "scene/coverage.hpp"

#include <gtest/gtest.h>

#include "surfaces.hpp"

namespace phantom::test {
namespace {

scene::Scene scene_of(std::initializer_list<mesh::Mesh> meshes)
{
    scene::Scene scene;
    scene.materials.push_back({});
    for (const mesh::Mesh& mesh : meshes) {
        scene.objects.emplace_back();
        scene.objects.back().mesh = mesh;
    }
    return scene;
}

TEST(Coverage, OfAFlatSheetIsTheDiscOfTheBudgetsArea)
{
    const scene::Scene scene = scene_of({prepared(sheet(100, [](double, double) { return 0.0; }))});
    const fdh::SceneTree<14> tree = scene::build_tree<14>(scene);
    const scene::Coverage coverage = scene::measure_coverage(scene, tree, 64);
    EXPECT_EQ(coverage.samples, 4096U);
    EXPECT_EQ(coverage.budget, 64U);
    const double disc_mm = std::sqrt(64 * 0.5 / std::numbers::pi); // faces of 0.5 mm^2
    EXPECT_LT(coverage.median_mm, disc_mm);
    EXPECT_GT(coverage.median_mm, 0.7 * disc_mm); // some of the 64 lie half outside
    EXPECT_LE(coverage.min_mm, coverage.p1_mm);
    EXPECT_LE(coverage.p1_mm, coverage.median_mm);
    EXPECT_NEAR(scene::measure_coverage(scene, tree, 256).median_mm, 2 * coverage.median_mm,
                0.25 * coverage.median_mm);
}

/// Points are spread by area: a tenth of it that is cut fine does not show in the median, however many faces
/// it has; nor does its share of faces.
TEST(Coverage, CountsAreaAndNotFaces)
{
    mesh::Soup soup = sheet(10, [](double, double) { return 0.0; }); // 10,000 mm^2
    for (mesh::Vec3& vertex : soup.vertices)
        vertex[2] += 100;
    const mesh::Mesh coarse = prepared(soup), fine = prepared(cut_cube(60)); // 9,600 mm^2 of 43,200 faces
    const scene::Scene both = scene_of({coarse, fine}), alone = scene_of({fine});
    const scene::Coverage of_both = scene::measure_coverage(both, scene::build_tree<14>(both), 64);
    const scene::Coverage of_fine = scene::measure_coverage(alone, scene::build_tree<14>(alone), 64);
    EXPECT_NEAR(of_both.p1_mm, of_fine.p1_mm, 0.1 * of_fine.p1_mm);
    EXPECT_GT(of_both.median_mm, 2 * of_fine.median_mm) << "half of the area is coarse";
}

TEST(Coverage, OfOneInAHundredIsThatOfAFinePart)
{
    mesh::Soup small = sheet(80, [](double, double) { return 0.0; });
    for (mesh::Vec3& vertex : small.vertices)
        vertex = mesh::add(mesh::scaled(vertex, 0.2), {0, 0, 100}); // 400 mm^2: four in a hundred
    const scene::Scene scene =
        scene_of({prepared(sheet(10, [](double, double) { return 0.0; })), prepared(small)});
    const scene::Coverage coverage = scene::measure_coverage(scene, scene::build_tree<14>(scene), 64);
    EXPECT_LT(coverage.p1_mm, 2);
    EXPECT_GT(coverage.median_mm, 20);
}

TEST(Coverage, OfASceneWithinTheBudgetHasNoEnd)
{
    const scene::Scene scene = scene_of({prepared(cut_cube(1))});
    const scene::Coverage coverage = scene::measure_coverage(scene, scene::build_tree<14>(scene), 64);
    EXPECT_EQ(coverage.min_mm, scene::coverage_max_mm);
}

TEST(Coverage, AtVerticesIsWhatSetsThereHold)
{
    scene::Scene scene = scene_of({prepared(waves(40))});
    scene.objects[0].pose.translation = {100, -20, 3};
    const fdh::SceneTree<14> tree = scene::build_tree<14>(scene);
    const std::vector<float> at = scene::vertex_coverage(scene.objects[0], tree, 64);
    ASSERT_EQ(at.size(), scene.objects[0].mesh.vertices.size());
    for (std::size_t v = 0; v < at.size(); v += 97) {
        std::vector<double> distances;
        for (std::size_t f = 0; f < scene.objects[0].mesh.faces.size(); ++f)
            distances.push_back(mesh::distance_to_triangle(scene.objects[0].mesh.vertices[v],
                                                           corners(scene.objects[0].mesh, f)));
        std::nth_element(distances.begin(), distances.begin() + 64, distances.end());
        EXPECT_NEAR(at[v], distances[64], 1e-4) << v;
    }
}

TEST(Coverage, OfAReachIsTheSpeedThatNeedsIt)
{
    for (const double speed : {0.0, 10.0, 500.0})
        EXPECT_NEAR(scene::speed_allowed_mm_s(scene::reach_needed_mm(1.5, speed, 0.004), 1.5, 0.004), speed,
                    1e-9);
    EXPECT_EQ(scene::speed_allowed_mm_s(0.9, 1.0, 0.004), 0) << "not even at rest";
}

} // namespace
} // namespace phantom::test
