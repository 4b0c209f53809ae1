// SPDX-License-Identifier: GPL-2.0-or-later
#include <gtest/gtest.h>

#include "folder.hpp"
#include "scene/scene.hpp"

namespace phantom::scene::test {
namespace {

Scene loaded(const std::filesystem::path& file, const LoadOptions& options = {})
{
    auto scene = load(file, options);
    EXPECT_TRUE(scene.ok()) << scene.error().text();
    return scene.ok() ? *std::move(scene) : Scene{};
}

Scene loaded_text(const std::string& text, const LoadOptions& options = {})
{
    const Folder folder;
    folder.write("part.obj", tetrahedron);
    return loaded(folder.write("a.toml", text), options);
}

double extent(const Scene& scene)
{
    return scene.bounds().extent();
}

TEST(Scene, MeshFileIsAnObjectOfTheDefaultMaterial)
{
    const Folder folder;
    const Scene scene = loaded(folder.write("part.obj", tetrahedron));
    ASSERT_EQ(scene.objects.size(), 1U);
    EXPECT_EQ(scene.objects[0].name, "part");
    EXPECT_EQ(scene.triangles(), 4U);
    ASSERT_EQ(scene.materials.size(), 1U);
    EXPECT_EQ(scene.materials[0].name, "default");
    EXPECT_EQ(scene.max_radius_mm(), 1.0);
    EXPECT_NEAR(extent(scene), 40, 1e-12);
    EXPECT_FALSE(scene.servo.rate_hz.has_value());
}

TEST(Scene, MissingFileAndUnknownExtension)
{
    const auto missing = load("/nonexistent/a.toml", {});
    ASSERT_FALSE(missing.ok());
    EXPECT_EQ(missing.error().text(), "/nonexistent/a.toml: no such file");
    const Folder folder;
    const auto unknown = load(folder.write("a.json", "{}"), {});
    ASSERT_FALSE(unknown.ok());
    EXPECT_NE(
        unknown.error().text().find("unknown extension \".json\", expected a scene file .toml or a mesh"),
        std::string::npos)
        << unknown.error().text();
}

TEST(Scene, TwoSidedSheetsAndCreasesBringTheirFans)
{
    const Folder folder;
    folder.write("sheet.obj", "v 0 0 0\nv 10 0 0\nv 10 10 0\nv 0 10 0\nf 1 2 3 4\n");
    const Scene one = loaded(folder.write("one.toml", "[[object]]\nmesh = \"sheet.obj\"\n"));
    EXPECT_EQ(one.triangles(), 2U);
    EXPECT_EQ(one.patches(), 2U + 4U) << "four rims";
    const Scene both =
        loaded(folder.write("both.toml", "[[object]]\nmesh = \"sheet.obj\"\ntwo_sided = true\n"));
    EXPECT_EQ(both.triangles(), 4U);
    // over each of 4 sides 180 degrees in two steps of two fans; the corners' are counted in tests of fans
    EXPECT_GE(both.patches(), 4U + 16U);
    const Scene box =
        loaded(folder.write("box.toml", "[[object]]\nshape = \"box\"\nsize_mm = [20, 30, 40]\n"));
    EXPECT_EQ(box.patches(), 12U + 24U + 8U);
}

TEST(Scene, UnitOfObjectThenOfScene)
{
    EXPECT_NEAR(extent(loaded_text("[[object]]\nmesh = \"part.obj\"\n")), 40, 1e-12);
    EXPECT_NEAR(extent(loaded_text("unit = \"cm\"\n[[object]]\nmesh = \"part.obj\"\n")), 400, 1e-9);
    EXPECT_NEAR(extent(loaded_text("unit = \"cm\"\n[[object]]\nmesh = \"part.obj\"\nunit = \"in\"\n")), 1016,
                1e-9);
    EXPECT_NEAR(extent(loaded_text("unit = \"m\"\n[[object]]\nmesh = \"part.obj\"\n")), 40000, 1e-7);
    EXPECT_NEAR(extent(loaded_text("unit = \"um\"\n[[object]]\nmesh = \"part.obj\"\n")), 0.04, 1e-12);
}

TEST(Scene, OptionsReplaceUnitFitStiffnessAndRadius)
{
    const std::string text =
        "unit = \"cm\"\n[[object]]\nmesh = \"part.obj\"\nfit_mm = 70\nmaterial = \"soft\"\n"
        "[material.soft]\nstiffness_n_mm = 0.5\nradius_mm = 2\n";
    EXPECT_NEAR(extent(loaded_text(text)), 70, 1e-9);
    LoadOptions fit;
    fit.prepare.fit_mm = 90;
    EXPECT_NEAR(extent(loaded_text(text, fit)), 90, 1e-9);
    LoadOptions unit;
    unit.unit = "m";
    EXPECT_NEAR(extent(loaded_text("[[object]]\nmesh = \"part.obj\"\nunit = \"cm\"\n", unit)), 40000, 1e-7);
    LoadOptions material;
    material.stiffness_n_mm = 3;
    material.radius_mm = 4;
    const Scene scene = loaded_text(text, material);
    EXPECT_EQ(scene.materials[0].stiffness_n_mm, 3);
    EXPECT_EQ(scene.max_radius_mm(), 4);
}

TEST(Scene, WeldDistanceOfTheFileUnlessTheOptionsHaveOne)
{
    const Folder folder;
    folder.write("part.obj",
                 "v 0 0 0\nv 50 0 0\nv 0 50 0\nv 0.04 0 0\nv 0 -50 0\nv 50 0.04 0\nf 1 2 3\nf 4 5 6\n");
    const auto edges = [&folder](const std::string& key, double weld_mm) {
        LoadOptions options;
        options.prepare.weld_mm = weld_mm;
        const auto scene = load(folder.write("a.toml", "[[object]]\nmesh = \"part.obj\"\n" + key), options);
        EXPECT_TRUE(scene.ok()) << scene.error().text();
        return scene.ok() ? scene->objects[0].report.boundary_edges : 0;
    };
    EXPECT_EQ(edges("", 0), 6U);
    EXPECT_EQ(edges("weld_mm = 0.1\n", 0), 4U);
    EXPECT_EQ(edges("", 0.1), 4U);
    EXPECT_EQ(edges("weld_mm = 0.1\n", 0.001), 6U);
}

TEST(Scene, BadOptionsAreRefusedByTheirName)
{
    const auto refused = [](const LoadOptions& options, const std::string& name) {
        const Folder folder;
        const auto scene = load(folder.write("part.obj", tetrahedron), options);
        return !scene.ok() && scene.error().text().find(name) == 0;
    };
    LoadOptions options;
    options.unit = "furlong";
    EXPECT_TRUE(refused(options, "--unit: "));
    options = {};
    options.stiffness_n_mm = -1;
    EXPECT_TRUE(refused(options, "--stiffness: "));
    options = {};
    options.radius_mm = 0;
    EXPECT_TRUE(refused(options, "--radius: "));
}

TEST(Scene, PosesAreRigidAndRightHanded)
{
    const Scene scene =
        loaded_text("[[object]]\nmesh = \"part.obj\"\n"
                    "pose = { translation_mm = [100, 200, 300], axis = [0, 0, 5], angle_deg = 90 }\n");
    // The long side turns from +x to +y.
    const mesh::Bounds bounds = scene.bounds();
    EXPECT_NEAR(bounds.low[0], 80, 1e-9);
    EXPECT_NEAR(bounds.high[0], 100, 1e-9);
    EXPECT_NEAR(bounds.high[1], 240, 1e-9);
    EXPECT_NEAR(bounds.high[2], 320, 1e-9);
    for (const char* pose : {"axis = [1, 2, -3], angle_deg = 77", "quaternion = [0.5, -0.5, 0.5, 0.5]",
                             "quaternion = [0.924, 0, 0, 0.383]"}) {
        const Scene turned =
            loaded_text(std::string("[[object]]\nmesh = \"part.obj\"\npose = { ") + pose + " }\n");
        const auto& r = turned.objects[0].pose.rotation;
        for (std::size_t i = 0; i < 3; ++i) {
            for (std::size_t j = 0; j < 3; ++j) {
                double product = 0;
                for (std::size_t k = 0; k < 3; ++k)
                    product += r[3 * i + k] * r[3 * j + k];
                EXPECT_NEAR(product, i == j, 1e-14) << pose;
            }
        }
        const double determinant = r[0] * (r[4] * r[8] - r[5] * r[7]) - r[1] * (r[3] * r[8] - r[5] * r[6]) +
                                   r[2] * (r[3] * r[7] - r[4] * r[6]);
        EXPECT_NEAR(determinant, 1, 1e-14) << pose;
    }
}

TEST(Scene, AxisAngleAndQuaternionAgree)
{
    const auto rotation = [](const char* pose) {
        return loaded_text(std::string("[[object]]\nmesh = \"part.obj\"\npose = { ") + pose + " }\n")
            .objects[0]
            .pose.rotation;
    };
    const auto a = rotation("axis = [1, 1, 1], angle_deg = 120"),
               b = rotation("quaternion = [0.5, 0.5, 0.5, 0.5]");
    for (std::size_t i = 0; i < 9; ++i) {
        EXPECT_NEAR(a[i], b[i], 1e-15);
        EXPECT_NEAR(a[i], i == 2 || i == 3 || i == 7, 1e-15); // x to y to z to x
    }
}

TEST(Scene, FacesAndVerticesAreNumberedThroughTheScene)
{
    const Scene scene =
        loaded_text("[[object]]\nmesh = \"part.obj\"\n[[object]]\nshape = \"box\"\nsize_mm = [9, 9, 9]\n"
                    "[[object]]\nshape = \"sphere\"\nradius_mm = 9\n");
    ASSERT_EQ(scene.objects.size(), 3U);
    EXPECT_EQ(scene.objects[0].first_face, 0U);
    EXPECT_EQ(scene.objects[1].first_face, 4U);
    EXPECT_EQ(scene.objects[2].first_face, 16U);
    EXPECT_EQ(scene.objects[1].first_vertex, 4U);
    EXPECT_EQ(scene.objects[2].first_vertex, 12U);
    EXPECT_EQ(scene.triangles(), 16U + scene.objects[2].mesh.faces.size());
}

TEST(Scene, EffectsAreCalledForByMaterialsThatNameThem)
{
    const std::string object = "[[object]]\nmesh = \"part.obj\"\nmaterial = \"m\"\n[material.m]\n";
    const Scene without = loaded_text(object);
    EXPECT_TRUE(without.effects_called_for().empty());
    EXPECT_EQ(without.effects_not_called_for(),
              (std::vector<std::string>{"damping", "magnet", "friction", "texture", "height_map", "impact",
                                        "constant", "viscosity", "guide", "field", "tip"}));
    const Scene with = loaded_text(object + "damping_ns_m = 0\n[material.m.friction]\nstatic = 0.5\n");
    EXPECT_EQ(with.effects_called_for(), (std::vector<std::string>{"damping", "friction"}));
    EXPECT_EQ(with.effects_not_called_for(),
              (std::vector<std::string>{"magnet", "texture", "height_map", "impact", "constant", "viscosity",
                                        "guide", "field", "tip"}));
}

TEST(Scene, DefaultMaterialMayBeDefined)
{
    const Scene scene =
        loaded_text("[[object]]\nmesh = \"part.obj\"\n[material.default]\nstiffness_n_mm = 5\n");
    ASSERT_EQ(scene.materials.size(), 1U);
    EXPECT_EQ(scene.materials[scene.objects[0].material].stiffness_n_mm, 5);
}

TEST(Scene, ObjectsFindTheirMaterials)
{
    const Scene scene = loaded_text("[[object]]\nname = \"a\"\nmesh = \"part.obj\"\nmaterial = \"x\"\n"
                                    "[[object]]\nname = \"b\"\nmesh = \"part.obj\"\n"
                                    "[[object]]\nname = \"c\"\nmesh = \"part.obj\"\nmaterial = \"w\"\n"
                                    "[material.x]\nradius_mm = 3\n[material.w]\nradius_mm = 5\n");
    const auto material = [&scene](std::size_t object) {
        return scene.materials[scene.objects[object].material];
    };
    EXPECT_EQ(material(0).radius_mm, 3);
    EXPECT_EQ(material(1).name, "default");
    EXPECT_EQ(material(2).radius_mm, 5);
    EXPECT_EQ(scene.max_radius_mm(), 5);
}

TEST(Scene, MaxRadiusCountsOnlyMaterialsInUse)
{
    EXPECT_EQ(
        loaded_text("[[object]]\nmesh = \"part.obj\"\n[material.unused]\nradius_mm = 50\n").max_radius_mm(),
        1);
}

TEST(Scene, TreeFindsWhatIsNearInTheWorld)
{
    const Scene scene = loaded_text("[[object]]\nname = \"a\"\nmesh = \"part.obj\"\n"
                                    "[[object]]\nname = \"b\"\nmesh = \"part.obj\"\n"
                                    "pose = { translation_mm = [500, 0, 0] }\n");
    const fdh::SceneTree<14> tree = build_tree<14>(scene, 1);
    EXPECT_EQ(tree.objects(), 2U);
    EXPECT_EQ(tree.triangles(), 8U);
    fdh::Nearest nearest;
    tree.nearest({505, 5, -1}, 1, 50, nearest);
    ASSERT_EQ(nearest.hits.size(), 1U);
    EXPECT_EQ(nearest.hits[0].object, 1U);
    EXPECT_NEAR(nearest.hits[0].distance, 1, 1e-9);
    EXPECT_EQ(build_tree<6>(scene).triangles(), 8U);
    EXPECT_EQ(build_tree<18>(scene).triangles(), 8U);
    EXPECT_EQ(build_tree<26>(scene).triangles(), 8U);
}

} // namespace
} // namespace phantom::scene::test
