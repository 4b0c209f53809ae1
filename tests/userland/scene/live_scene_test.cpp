// SPDX-License-Identifier: GPL-2.0-or-later
// Scenes that move and deform, against brute force over every triangle where it is said to be.
#include "scene/live_scene.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "folder.hpp"
#include "mesh/nearest_on_triangle.hpp"

namespace phantom::scene::test {
namespace {

/// A turned box that swings, a drum on a turntable, and a sphere at rest.
constexpr const char* const orchestra = R"(
[[object]]
name = "box"
shape = "box"
size_mm = [30, 20, 10]
split_mm = 6
pose = { translation_mm = [60, 0, 5], axis = [1, 1, 0], angle_deg = 30 }
motion = { kind = "oscillation", direction = [1, 0, 2], amplitude_mm = 8, frequency_hz = 2, ramp_s = 0.2 }

[[object]]
name = "drum"
shape = "cylinder"
radius_mm = 30
height_mm = 20
split_mm = 4
pose = { translation_mm = [-20, 5, 0], axis = [0, 1, 0], angle_deg = 20 }
motion = { kind = "turntable", axis = [0, 0, 1], centre_mm = [-10, 0, 0], rev_per_s = 1.5, ramp_s = 0.3 }
deform = { shape = "drum", centre_mm = [0, 0, 10], radius_mm = 29, depth_mm = 15, amplitude_mm = 4, frequency_hz = 1.5, ramp_s = 0.1 }

[[object]]
name = "ball"
shape = "sphere"
radius_mm = 10
pose = { translation_mm = [0, 60, 0] }
)";

Scene scene_of(const std::string& text)
{
    const Folder folder;
    auto scene = load(folder.write("a.toml", text), {});
    EXPECT_TRUE(scene) << scene.error().text();
    return scene ? std::move(*scene) : Scene{};
}

Vec3 posed(const fdh::Pose& pose, const Vec3& v)
{
    Vec3 out = pose.translation;
    for (std::size_t row = 0; row < 3; ++row)
        for (std::size_t column = 0; column < 3; ++column)
            out[row] += pose.rotation[3 * row + column] * v[column];
    return out;
}

/// Where the vertex is at t, by the formulas alone.
Vec3 place_at(const Object& rest, const Vec3& vertex, double displacement_mm, double t_s)
{
    Vec3 local = vertex;
    if (rest.deformation)
        local = local + displacement_mm * rest.deformation->profile(vertex) * rest.deformation->axis;
    const Vec3 world = posed(rest.pose, local);
    if (!rest.motion)
        return world;
    const Placement now = rest.motion->at(t_s);
    return now.to_world(world - now.centre_mm);
}

TEST(LiveScene, QueriesAnswerForWhereEverythingIsNow)
{
    const Scene rest = scene_of(orchestra);
    const auto tree = build_tree<14>(rest);
    LiveScene live(rest, tree);
    std::mt19937_64 random(1);
    std::uniform_real_distribution<double> place(-70, 70);
    double shaped_s = -1;
    std::uint32_t revision = 0;
    fdh::Nearest found;
    for (double t = -0.02; t < 1.5; t += t < 0.1 ? 0.004 : 0.0731) {
        live.advance(t);
        const Moment& moment = *live.moment();
        if (moment.objects[1].revision != revision)
            shaped_s = t;
        revision = moment.objects[1].revision;
        const double displacement = rest.objects[1].deformation->displacement_mm(shaped_s);
        for (int i = 0; i < 3; ++i) {
            const Vec3 p = {place(random), place(random), 0.3 * place(random)};
            std::vector<double> distances;
            for (const Object& object : rest.objects)
                for (const mesh::Triple& face : object.mesh.faces) {
                    std::array<Vec3, 3> x;
                    for (std::size_t k = 0; k < 3; ++k)
                        x[k] = place_at(object, object.mesh.vertices[face[k]], displacement, t);
                    distances.push_back(mesh::distance_to_triangle(p, x));
                }
            std::sort(distances.begin(), distances.end());
            live.tree().nearest(p, 20, 500, found);
            found.sort();
            ASSERT_EQ(found.hits.size(), 20U);
            for (std::size_t n = 0; n < 20; ++n)
                ASSERT_NEAR(found.hits[n].distance, distances[n], 1e-4) << t << ' ' << n;
        }
    }
    EXPECT_GT(revision, 20U);
}

TEST(LiveScene, TheSceneItWasMadeFromStaysAtRest)
{
    const Scene rest = scene_of(orchestra);
    const std::vector<Vec3> before = rest.objects[1].mesh.vertices.to_vector();
    const auto tree = build_tree<14>(rest);
    LiveScene live(rest, tree);
    live.advance(0.9);
    EXPECT_EQ(rest.objects[1].mesh.vertices.to_vector(), before);
    EXPECT_NE(live.scene().objects[1].mesh.vertices.to_vector(), before);
    EXPECT_EQ(tree.pose(0).translation, rest.objects[0].pose.translation);
    // What stands still is shared, not copied.
    EXPECT_EQ(live.scene().objects[2].mesh.vertices.data(), rest.objects[2].mesh.vertices.data());
    EXPECT_EQ(live.moment()->objects[2].vertices.size(), 0U);
}

TEST(LiveScene, ShapesChangeNoMoreOftenThanTheirInterval)
{
    const Scene rest = scene_of(orchestra);
    const auto tree = build_tree<14>(rest);
    LiveScene live(rest, tree);
    live.advance(-0.5);
    live.advance(0);
    EXPECT_EQ(live.moment()->objects[1].revision, 0U);
    for (int millisecond = 1; millisecond <= 500; ++millisecond)
        live.advance(1e-3 * millisecond);
    EXPECT_EQ(live.moment()->objects[1].revision, 50U);
    EXPECT_DOUBLE_EQ(revision_interval_s(20000), 0.01);
    EXPECT_DOUBLE_EQ(revision_interval_s(100000), 0.05);
}

TEST(LiveScene, AnotherLevelFollowsTheFinest)
{
    const Scene rest = scene_of(orchestra);
    const auto tree = build_tree<14>(rest);
    LiveScene finest(rest, tree), level(rest, tree);
    finest.advance(0.4);
    finest.advance(0.7);
    level.follow(finest);
    fdh::Nearest a, b;
    for (const Vec3& p : {Vec3{60, 0, 20}, Vec3{-20, 5, 15}, Vec3{0, 40, 0}}) {
        finest.tree().nearest(p, 30, 100, a);
        level.tree().nearest(p, 30, 100, b);
        a.sort();
        b.sort();
        ASSERT_EQ(a.hits.size(), b.hits.size());
        for (std::size_t i = 0; i < a.hits.size(); ++i)
            EXPECT_EQ(a.hits[i].triangle, b.hits[i].triangle);
    }
    EXPECT_EQ(level.moment(), finest.moment());
}

/// Normals of a smooth shape under a deformation: those of the formula.
TEST(DeformingSurface, NormalsAreThoseOfTheDeformedShape)
{
    const Scene rest = scene_of("[[object]]\nshape = \"sphere\"\nradius_mm = 20\nchord_mm = 0.2\n"
                                "deform = { shape = \"drum\", centre_mm = [1, 2, 3], axis = [1, 2, 2], "
                                "radius_mm = 30, depth_mm = 40, amplitude_mm = 3, frequency_hz = 1 }");
    const Object& object = rest.objects.front();
    const Deformation& drum = *object.deformation;
    DeformingSurface surface(object, drum);
    const auto place = [&drum](const Vec3& x) { return x + 2.5 * drum.profile(x) * drum.axis; };
    const mesh::Mesh& mesh = surface.displaced(2.5).mesh;
    double worst = 0;
    for (std::size_t f = 0; f < mesh.faces.size(); ++f)
        for (std::size_t i = 0; i < 3; ++i) {
            const Vec3 x = object.mesh.vertices[mesh.faces[f][i]];
            const Vec3 n = unit(x), u = perpendicular(n, {1, 0, 0}), v = cross(n, u);
            constexpr double h = 1e-4;
            const Vec3 along_u = place(x + h * u) - place(x - h * u);
            const Vec3 along_v = place(x + h * v) - place(x - h * v);
            worst = std::max(worst,
                             length(mesh.normals[mesh.face_normals[f][i]] - unit(cross(along_u, along_v))));
            EXPECT_LT(length(mesh.vertices[mesh.faces[f][i]] - place(x)), 1e-12);
        }
    EXPECT_LT(worst, 1e-7);
    // Displaced by nothing it is the rest, to the last bits.
    const mesh::Mesh& back = surface.displaced(0).mesh;
    EXPECT_EQ(back.vertices.to_vector(), object.mesh.vertices.to_vector());
    for (std::size_t f = 0; f < back.faces.size(); ++f)
        EXPECT_LT(length(back.normals[back.face_normals[f][0]] -
                         object.mesh.normals[object.mesh.face_normals[f][0]]),
                  1e-15);
}

TEST(DeformingSurface, FansKeepTheNormalsOfTheFacesTheyLieBetween)
{
    const Scene rest = scene_of("[[object]]\nshape = \"box\"\nsize_mm = [40, 30, 20]\nsplit_mm = 5\n"
                                "deform = { shape = \"wave\", across = [1, 1, 0], wavelength_mm = 60, "
                                "depth_mm = 40, amplitude_mm = 3, frequency_hz = 1 }");
    const Object& object = rest.objects.front();
    ASSERT_GT(object.fans.fans.size(), 20U);
    DeformingSurface surface(object, *object.deformation);
    const Surface& now = surface.displaced(2);
    const mesh::Fans made = mesh::make_fans(now.mesh);
    ASSERT_EQ(now.fans.fans.size(), made.fans.size());
    for (std::size_t i = 0; i < made.fans.size(); ++i) {
        EXPECT_EQ(now.fans.fans[i].corners, made.fans[i].corners);
        for (std::size_t k = 0; k < 3; ++k)
            EXPECT_LT(length(now.fans.fans[i].normals[k] - made.fans[i].normals[k]), 1e-12);
    }
}

TEST(DeformingSurface, RimsAreFoundWhereTheyHaveGone)
{
    const Scene rest = scene_of("[[object]]\nshape = \"cone\"\nradius_mm = 20\nheight_mm = 30\nsplit_mm = 6\n"
                                "deform = { shape = \"wave\", wavelength_mm = 50, amplitude_mm = 6, "
                                "frequency_hz = 0.1 }\n[material.default]\nradius_mm = 3\n");
    Surface open = rest.objects.front();
    // Without its bottom.
    mesh::Soup soup;
    soup.vertices = open.mesh.vertices.to_vector();
    for (const mesh::Triple& face : open.mesh.faces)
        if (open.mesh.vertices[face[0]][2] + open.mesh.vertices[face[1]][2] + open.mesh.vertices[face[2]][2] >
            -44.9)
            soup.faces.push_back(face);
    auto prepared = mesh::prepare(std::move(soup), {}, "cone");
    ASSERT_TRUE(prepared.ok());
    Surface surface;
    surface.mesh = prepared->mesh;
    surface.rims = mesh::make_rims(surface.mesh, 3);
    ASSERT_GT(surface.rims.edges.size(), 20U);
    DeformingSurface deforming(surface, *rest.objects.front().deformation);
    const Surface& now = deforming.displaced(-6);
    for (std::uint32_t i = 0; i < now.rims.edges.size(); ++i) {
        std::vector<mesh::Rims::Near> near;
        now.rims.within(now.mesh, now.mesh.vertices[now.rims.edges[i].from], 1e-6, near);
        EXPECT_TRUE(std::any_of(near.begin(), near.end(), [i](const auto& n) { return n.rim == i; })) << i;
    }
}

TEST(LiveScene, AShapeThatRisesFasterThanTheServoCarriesIsRefused)
{
    const Folder folder;
    const auto text = [](double amplitude) {
        return "[[object]]\nshape = \"sphere\"\nradius_mm = 10\n"
               "deform = { shape = \"drum\", radius_mm = 9, frequency_hz = 10, amplitude_mm = " +
               std::to_string(amplitude) + " }\n";
    };
    EXPECT_TRUE(load(folder.write("a.toml", text(0.79)), {}).ok());
    const auto scene = load(folder.write("a.toml", text(0.8)), {});
    ASSERT_FALSE(scene.ok());
    const std::string error = scene.error().text();
    EXPECT_EQ(error.substr(error.find("a.toml")),
              "a.toml:4: sphere: deform: rises by 1.01 mm in the 20 ms between two shapes of 5120 triangles, "
              "expected no more than the contact radius, 1 mm (a smaller amplitude_mm or frequency_hz)");
}

} // namespace
} // namespace phantom::scene::test
