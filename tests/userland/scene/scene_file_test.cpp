// SPDX-License-Identifier: GPL-2.0-or-later
// Faulty scene files: one line with the file, the line, the key and what was expected.
#include <gtest/gtest.h>

#include "folder.hpp"
#include "scene/scene.hpp"

namespace phantom::scene::test {
namespace {

/// The error of loading this text, without the folder's name; empty when it was loaded.
std::string error_of(const std::string& text)
{
    static const Folder folder;
    folder.write("part.obj", tetrahedron);
    const auto scene = load(folder.write("a.toml", text), {});
    if (scene.ok())
        return "";
    std::string error = scene.error().text();
    EXPECT_EQ(error.find('\n'), std::string::npos) << error;
    const std::string prefix = folder.path().string() + "/";
    for (std::size_t at = error.find(prefix); at != std::string::npos; at = error.find(prefix))
        error.erase(at, prefix.size());
    return error;
}

/// `text` on line 4 and after, below a sound object.
std::string below_object(const std::string& text)
{
    return error_of("[[object]]\nmesh = \"part.obj\"\n\n" + text);
}

/// `text` on line 3, inside the object.
std::string in_object(const std::string& text)
{
    return error_of("[[object]]\nmesh = \"part.obj\"\n" + text);
}

TEST(SceneFile, SoundFileLoads)
{
    EXPECT_EQ(
        error_of(
            "unit = \"cm\"\n[[object]]\nname = \"a\"\nmesh = \"part.obj\"\nunit = \"in\"\nfit_mm = "
            "50\nweld_mm = 0.1\n"
            "material = \"soft\"\npose = { translation_mm = [1, 2.5, -3], axis = [0, 0, 2], angle_deg = 90 "
            "}\n"
            "[[object]]\nshape = \"box\"\nsize_mm = [10, 20, 30]\n[object.pose]\nquaternion = [1, 0, 0, 0]\n"
            "[material.soft]\nstiffness_n_mm = 0.5\nradius_mm = 2\ndamping_ns_m = 3\n"
            "[material.soft.magnet]\nrange_mm = 0.5\nforce_n = 0.3\n"
            "[material.soft.friction]\nstatic = 0.6\ndynamic = 0.4\nstiffness_n_mm = 2\nstribeck_mm_s = 10\n"
            "[material.soft.texture]\namplitude_mm = 0.05\nwavelength_mm = 1\ndirection = [1, 1, 0]\n"
            "second = { amplitude_mm = 0.04, wavelength_mm = 0.8, direction = [1, -1, 0] }\n"
            "[effect.gravity]\nkind = \"constant\"\nforce_n = [0, 0, -0.5]\n"
            "[effect.honey]\nkind = \"viscosity\"\nviscosity_ns_m = 3\ndrag_ns2_m2 = 1\ncentre_mm = [1, 2, "
            "3]\n"
            "radius_mm = 20\nborder_mm = 5\n"
            "[effect.rail]\nkind = \"guide\"\nto = \"line\"\npoint_mm = [0, 0, 50]\ndirection = [1, 0, 0]\n"
            "stiffness_n_mm = 0.5\nforce_n = 2\nreach_mm = 10\n"
            "[device]\nmax_force_n = 3.3\nslew_n_per_ms = 1\nramp_ms = 250\n"
            "[servo]\nrate_hz = 3000\nmodel = \"projected\"\ncombine = \"bounded\"\n"
            "proxy = \"constrained\"\narith = \"float\"\nsteps = 2\ncrossfade_ms = 50\n"),
        "");
}

TEST(SceneFile, UnknownKeysAreNamedWithTheirLine)
{
    EXPECT_EQ(error_of("units = \"mm\"\n[[object]]\nmesh = \"part.obj\"\n"),
              "a.toml:1: units: unknown key, expected unit, levels, object, material, effect, device, servo");
    EXPECT_EQ(in_object("colour = \"red\"\n"), "a.toml:3: object 1: colour: unknown key, expected name, "
                                               "mesh, shape, unit, fit_mm, weld_mm, split_mm, "
                                               "two_sided, pose, material, materials, motion, deform");
    EXPECT_EQ(error_of("[[object]]\nradius = 3\nshape = \"torus\"\n"),
              "a.toml:2: object 1: radius: unknown key, expected name, shape, split_mm, pose, material, "
              "two_sided, motion, deform, "
              "radius_mm, tube_radius_mm, chord_mm");
    EXPECT_EQ(below_object("[material.soft]\nstifness_n_mm = 1\n"),
              "a.toml:5: material.soft.stifness_n_mm: unknown key, expected stiffness_n_mm, radius_mm, "
              "damping_ns_m, magnet, friction, texture, height_map, impact");
    EXPECT_EQ(below_object("[material.soft.friction]\nsliding = 1\nstatic = 1\n"),
              "a.toml:5: material.soft.friction.sliding: unknown key, expected static, dynamic, "
              "stiffness_n_mm, stribeck_mm_s");
    EXPECT_EQ(
        below_object("[device]\nforce = 1\n"),
        "a.toml:5: device.force: unknown key, expected max_force_n, slew_n_per_ms, ramp_ms, encoder_mm, "
        "hand, mass_kg, damping_ns_m, friction_n, delay_ms, amplifier");
    EXPECT_EQ(below_object("[servo]\nrate = 1\n"),
              "a.toml:5: servo.rate: unknown key, expected rate_hz, model, combine, proxy, arith, steps, "
              "crossfade_ms");
    EXPECT_EQ(in_object("pose = { translation = [0, 0, 0] }\n"),
              "a.toml:3: object 1: pose.translation: unknown key, expected translation_mm, axis, angle_deg, "
              "quaternion");
}

TEST(SceneFile, WrongTypes)
{
    EXPECT_EQ(error_of("unit = 1\n[[object]]\nmesh = \"part.obj\"\n"),
              "a.toml:1: unit: is 1, expected a text in quotes");
    EXPECT_EQ(below_object("[material.soft]\nradius_mm = \"wide\"\n"),
              "a.toml:5: material.soft.radius_mm: is \"wide\", expected 0.001 ... 100 mm");
    EXPECT_EQ(below_object("[servo]\nsteps = 1.5\n"),
              "a.toml:5: servo.steps: is 1.5, expected a whole number, 0 ... 3");
    EXPECT_EQ(in_object("pose = 3\n"), "a.toml:3: object 1: pose: is 3, expected a table");
    EXPECT_EQ(in_object("pose = { translation_mm = [1, 2] }\n"),
              "a.toml:3: object 1: pose.translation_mm: is an array of 2, expected [3 numbers]");
    EXPECT_EQ(in_object("pose = { translation_mm = [1, 2, \"3\"] }\n"),
              "a.toml:3: object 1: pose.translation_mm: number 3 is \"3\", expected -1000000 ... 1000000 mm");
    EXPECT_EQ(in_object("two_sided = 1\n"), "a.toml:3: object 1: two_sided: is 1, expected true or false");
    EXPECT_EQ(below_object("device = 3\n"),
              "a.toml:4: object 1: device: unknown key, expected name, mesh, shape, "
              "unit, fit_mm, weld_mm, split_mm, two_sided, pose, material, materials, motion, deform");
    EXPECT_EQ(error_of("servo = 1\nobject = 2\n"), "a.toml:1: servo: is 1, expected a table");
    EXPECT_EQ(error_of("object = [1]\n"), "a.toml:1: object 1: expected a table [[object]]");
    EXPECT_EQ(below_object("[material]\nsoft = 1\n"),
              "a.toml:5: material.soft: is 1, expected a table [material.NAME]");
}

TEST(SceneFile, ValuesOutOfRange)
{
    EXPECT_EQ(below_object("[material.soft]\nstiffness_n_mm = 0\n"),
              "a.toml:5: material.soft.stiffness_n_mm: is 0, expected 0.001 ... 1000 N/mm");
    EXPECT_EQ(below_object("[material.soft]\nradius_mm = nan\n"),
              "a.toml:5: material.soft.radius_mm: is nan, expected 0.001 ... 100 mm");
    EXPECT_EQ(below_object("[material.soft]\ndamping_ns_m = -1\n"),
              "a.toml:5: material.soft.damping_ns_m: is -1, expected 0 ... 1000 N*s/m");
    EXPECT_EQ(below_object("[material.soft.magnet]\nforce_n = 1\n"),
              "a.toml:4: material.soft.magnet.range_mm: is missing, expected 0.000001 ... 1000000 mm");
    EXPECT_EQ(
        below_object("[material.soft.magnet]\nrange_mm = 1\nforce_n = 1\n"),
        "a.toml:5: material.soft.magnet.range_mm: is 1, expected less than the material's radius_mm, 1");
    EXPECT_EQ(below_object("[material.soft.friction]\nstatic = 0.5\ndynamic = 0.6\n"),
              "a.toml:6: material.soft.friction.dynamic: is 0.6, expected no more than static, 0.5");
    EXPECT_EQ(below_object("[material.soft.friction]\nstatic = 5\n"),
              "a.toml:5: material.soft.friction.static: is 5, expected 0 ... 4");
    EXPECT_EQ(
        below_object("[material.soft.texture]\namplitude_mm = 0.2\nwavelength_mm = 1\n"),
        "a.toml:5: material.soft.texture.amplitude_mm: is 0.2, expected at most 0.159 for waves of 1 mm");
    EXPECT_EQ(
        below_object("[material.soft.texture]\namplitude_mm = 0.1\nwavelength_mm = 1\ndirection = [0, 0, "
                     "0]\n"),
        "a.toml:7: material.soft.texture.direction: has no length, expected a direction");
    EXPECT_EQ(below_object("[servo]\nrate_hz = 500\n"),
              "a.toml:5: servo.rate_hz: is 500, expected 1000 ... 10000 Hz");
    EXPECT_EQ(below_object("[servo]\ncrossfade_ms = 0\n"),
              "a.toml:5: servo.crossfade_ms: is 0, expected 1 ... 10000 ms");
    EXPECT_EQ(below_object("[servo]\nsteps = 4\n"),
              "a.toml:5: servo.steps: is 4, expected a whole number, 0 ... 3");
    EXPECT_EQ(below_object("[servo]\nmodel = \"penalty\"\n"),
              "a.toml:5: servo.model: is \"penalty\", expected paper, projected, off");
    EXPECT_EQ(below_object("[device]\nmax_force_n = inf\n"),
              "a.toml:5: device.max_force_n: is inf, expected 0.001 ... 1000 N");
    EXPECT_EQ(in_object("fit_mm = -1\n"),
              "a.toml:3: object 1: fit_mm: is -1, expected 0.000001 ... 1000000 mm");
    EXPECT_EQ(in_object("unit = \"furlong\"\n"),
              "a.toml:3: object 1: unit: is \"furlong\", expected um, mm, cm, m, in");
}

TEST(SceneFile, ASimulatedDevice)
{
    const std::string device = "[device]\nmass_kg = 0.05\n",
                      hand = "hand = { stiffness_n_mm = 0.3, damping_ns_m = 3 }\n";
    EXPECT_EQ(below_object(device + hand +
                           "encoder_mm = 0.05\ndamping_ns_m = 0.3\nfriction_n = 0.05\n"
                           "delay_ms = 1.5\namplifier = { max_force_n = 3, bandwidth_hz = 200 }\n"),
              "");
    EXPECT_EQ(below_object("[device]\nencoder_mm = 0.05\n"), "");
    EXPECT_EQ(below_object(device),
              "a.toml:5: device.mass_kg: has no meaning without hand, which the arm answers");
    EXPECT_EQ(below_object("[device]\n" + hand),
              "a.toml:4: device.mass_kg: is missing, expected 0.001 ... 10 kg of the arm beside hand");
    EXPECT_EQ(below_object("[device]\nfriction_n = 0.1\n"),
              "a.toml:5: device.friction_n: has no meaning without hand, which the arm answers");
    EXPECT_EQ(below_object(device + "hand = { stiffness_n_mm = 0.3 }\n"),
              "a.toml:6: device.hand.damping_ns_m: is missing, expected 0 ... 1000 N*s/m");
    EXPECT_EQ(below_object(device + "hand = 3\n"), "a.toml:6: device.hand: is 3, expected a table");
    EXPECT_EQ(below_object(device + hand + "delay_ms = -1\n"),
              "a.toml:7: device.delay_ms: is -1, expected 0 ... 100 ms");
    EXPECT_EQ(below_object(device + hand + "amplifier = { bandwidth_hz = 0 }\n"),
              "a.toml:7: device.amplifier.bandwidth_hz: is 0, expected 1 ... 10000 Hz");
    EXPECT_EQ(below_object(device + hand + "amplifier = {}\n"),
              "a.toml:7: device.amplifier: is empty, expected max_force_n or bandwidth_hz");
}

TEST(SceneFile, MeshAndShape)
{
    EXPECT_EQ(error_of("[[object]]\n\nmesh = \"gone.ply\"\n"),
              "a.toml:3: object 1: mesh: no such file: gone.ply");
    EXPECT_EQ(error_of("[[object]]\nmesh = \"a.toml\"\n"),
              "a.toml:2: object 1: mesh: is \"a.toml\", expected a file .ply, .obj, .stl, .off, .vtp, .vtk, "
              ".3ds, .gltf or .glb");
    EXPECT_EQ(error_of("[[object]]\nname = \"a\"\n"),
              "a.toml:1: object 1: mesh: is missing, expected mesh = \"FILE\" or shape = \"sphere\" or "
              "\"ellipsoid\" or \"torus\" or \"box\" or \"cylinder\" or \"cone\" or \"superquadric\" or "
              "\"height_field\" or \"nurbs\"");
    EXPECT_EQ(in_object("shape = \"box\"\n"),
              "a.toml:3: object 1: shape: stands beside mesh, expected one of the two");
    EXPECT_EQ(
        error_of("[[object]]\nshape = \"donut\"\n"),
        "a.toml:2: object 1: shape: is \"donut\", expected sphere, ellipsoid, torus, box, cylinder, cone, "
        "superquadric, height_field, nurbs");
    EXPECT_EQ(error_of("[[object]]\nshape = \"sphere\"\n"),
              "a.toml:2: object 1: shape: a sphere needs radius_mm");
    EXPECT_EQ(error_of("[[object]]\nshape = \"box\"\n"),
              "a.toml:2: object 1: shape: a box needs size_mm = [x, y, z]");
    EXPECT_EQ(error_of("[[object]]\nshape = \"box\"\nsize_mm = [1, 2, 3]\nradius_mm = 3\n"),
              "a.toml:4: object 1: radius_mm: has no meaning with shape = \"box\"");
    EXPECT_EQ(error_of("[[object]]\nshape = \"sphere\"\nradius_mm = 3\ntwo_sided = true\n"),
              "a.toml:4: object 1: two_sided: has no meaning with shape: it is closed");
    EXPECT_EQ(in_object("size_mm = [1, 2, 3]\n"), "a.toml:3: object 1: size_mm: has no meaning with mesh");
    EXPECT_EQ(error_of("[[object]]\nshape = \"sphere\"\nradius_mm = 3\nfit_mm = 3\n"),
              "a.toml:4: object 1: fit_mm: has no meaning with shape: sizes are in mm");
    EXPECT_EQ(error_of("[servo]\nrate_hz = 1000\n"), "a.toml:1: object: expected at least one [[object]]");
}

TEST(SceneFile, NamesAndMaterials)
{
    EXPECT_EQ(in_object("material = \"soft\"\n"),
              "a.toml:3: object 1: material: no [material.soft] in this file");
    EXPECT_EQ(
        error_of(
            "[[object]]\nname = \"a\"\nmesh = \"part.obj\"\n[[object]]\nmesh = \"part.obj\"\nname = \"a\"\n"),
        "a.toml:6: object 2: name: \"a\" is taken by the object at a.toml:1, expected another name");
    EXPECT_EQ(error_of("[[object]]\nmesh = \"part.obj\"\n[[object]]\nmesh = \"part.obj\"\n"),
              "a.toml:3: object 2: name: \"part\" is taken by the object at a.toml:1, expected another name");
}

TEST(SceneFile, Poses)
{
    EXPECT_EQ(in_object("pose = { axis = [1, 0, 0] }\n"),
              "a.toml:3: object 1: pose.axis: axis and angle_deg belong together, one is missing");
    EXPECT_EQ(in_object("pose = { angle_deg = 5 }\n"),
              "a.toml:3: object 1: pose.angle_deg: axis and angle_deg belong together, one is missing");
    EXPECT_EQ(in_object("pose = { axis = [0, 0, 0], angle_deg = 5 }\n"),
              "a.toml:3: object 1: pose.axis: is zero, expected a direction");
    EXPECT_EQ(
        in_object("pose = { quaternion = [1, 1, 0, 0] }\n"),
        "a.toml:3: object 1: pose.quaternion: has the length 1.41421, expected [w, x, y, z] of length 1");
    EXPECT_EQ(
        in_object("pose = { quaternion = [1, 0, 0, 0], axis = [1, 0, 0], angle_deg = 1 }\n"),
        "a.toml:3: object 1: pose.quaternion: stands beside axis and angle_deg, expected one of the two");
}

TEST(SceneFile, TheFaultNearestToTheTopIsTold)
{
    EXPECT_EQ(
        error_of("[[object]]\nmesh = \"part.obj\"\nfit_mm = -1\n[servo]\nrate = 1\n[device]\nforce = 1\n")
            .substr(0, 8),
        "a.toml:3");
}

TEST(SceneFile, NotToml)
{
    const std::string error = error_of("[[object]]\nmesh = \n");
    EXPECT_EQ(error.find("a.toml:2: is not TOML: "), 0U) << error;
    EXPECT_EQ(error_of("\x01\x02\x03").find("a.toml:1: is not TOML: "), 0U);
    EXPECT_EQ(error_of(""), "a.toml: is empty");
}

TEST(SceneFile, DamagedMeshIsToldByItsOwnPlace)
{
    const Folder folder;
    folder.write("bad.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 9\n");
    const auto scene = load(folder.write("a.toml", "[[object]]\nmesh = \"bad.obj\"\n"), {});
    ASSERT_FALSE(scene.ok());
    EXPECT_NE(scene.error().text().find("bad.obj:4: "), std::string::npos);
}

} // namespace
} // namespace phantom::scene::test
