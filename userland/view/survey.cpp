// SPDX-License-Identifier: GPL-2.0-or-later
#include "view/survey.hpp"

#include <algorithm>
#include <set>

#include "scene/coverage.hpp"
#include "view/scene_actors.hpp"
#include "view/scene_words.hpp"

namespace phantom::view {

namespace {

/// Unit normals farther apart than this, of 10 degrees, can be felt as an edge. The generators of a cone,
/// which part near its tip, cannot.
constexpr double felt = 0.174;

const Vec3& normal_at(const mesh::Mesh& mesh, std::size_t face, std::uint32_t vertex)
{
    std::size_t corner = 0;
    while (corner < 2 && mesh.faces[face][corner] != vertex)
        ++corner;
    return mesh.normals[mesh.face_normals[face][corner]];
}

void add_edges(const scene::Object& object, Survey& survey)
{
    const mesh::Mesh& mesh = object.mesh;
    const auto line = [&](std::uint32_t a, std::uint32_t b) {
        return SurveyLine{to_world(object.pose, mesh.vertices[a]), to_world(object.pose, mesh.vertices[b])};
    };
    std::set<std::array<std::uint32_t, 3>> rims; // face, from, to
    for (const mesh::Rim& rim : object.rims.edges) {
        rims.insert({rim.face, rim.from, rim.to});
        survey.rims.push_back(line(rim.from, rim.to));
    }
    survey.loops += object.rims.loops;
    for (std::size_t f = 0; f < mesh.faces.size(); ++f) {
        for (std::size_t i = 0; i < 3; ++i) {
            const std::uint32_t a = mesh.faces[f][i], b = mesh.faces[f][(i + 1) % 3];
            const std::uint32_t other = mesh.neighbours[f][i];
            if (other == mesh::no_neighbour) {
                if (!rims.contains({static_cast<std::uint32_t>(f), a, b}))
                    survey.faults.push_back(line(a, b));
            } else if (other > f && (length(normal_at(mesh, f, a) - normal_at(mesh, other, a)) > felt ||
                                     length(normal_at(mesh, f, b) - normal_at(mesh, other, b)) > felt)) {
                survey.creases.push_back(line(a, b));
            }
        }
    }
}

/// Counts of all objects, biggest matters first.
std::vector<std::string> repairs_of(const scene::Scene& scene)
{
    struct Repair {
        std::uint64_t mesh::Findings::*count;
        const char* what;
    };
    constexpr std::array<Repair, 11> kinds{{
        {&mesh::Findings::faces_nonfinite, "faces that were not finite dropped"},
        {&mesh::Findings::faces_zero_area, "faces without area dropped"},
        {&mesh::Findings::faces_duplicate, "duplicate faces dropped"},
        {&mesh::Findings::faces_flipped, "faces turned"},
        {&mesh::Findings::components_turned, "parts turned"},
        {&mesh::Findings::nonmanifold_edges, "edges of more than two faces paired"},
        {&mesh::Findings::nonmanifold_vertices, "vertices of several fans parted"},
        {&mesh::Findings::vertices_sewn, "cracks sewn"},
        {&mesh::Findings::t_junctions, "T-junctions closed"},
        {&mesh::Findings::vertices_welded, "vertices welded"},
        {&mesh::Findings::normals_repaired, "normals made anew"},
    }};
    std::vector<std::string> repairs;
    for (const Repair& kind : kinds) {
        std::uint64_t count = 0;
        for (const scene::Object& object : scene.objects)
            count += object.report.*kind.count;
        if (count > 0)
            repairs.push_back(grouped(count) + " " + kind.what);
    }
    return repairs;
}

/// The band of every face by its middle, and the bands' share of the surface.
void add_speeds(const scene::Scene& scene, std::uint32_t budget, double feed_hz, Survey& survey)
{
    const auto tree = scene::build_tree<14>(scene);
    double whole = 0;
    for (const scene::Object& object : scene.objects) {
        const mesh::Mesh& mesh = object.mesh;
        std::vector<Vec3> middles;
        std::vector<double> areas;
        for (const mesh::Triple& face : mesh.faces) {
            const Vec3 a = to_world(object.pose, mesh.vertices[face[0]]);
            const Vec3 b = to_world(object.pose, mesh.vertices[face[1]]);
            const Vec3 c = to_world(object.pose, mesh.vertices[face[2]]);
            middles.push_back((1.0 / 3) * (a + b + c));
            areas.push_back(0.5 * length(cross(b - a, c - a)));
        }
        const std::vector<float> reaches = scene::coverage_at(tree, middles, budget);
        std::vector<unsigned char>& bands = survey.bands.emplace_back();
        for (std::size_t f = 0; f < reaches.size(); ++f) {
            const double speed = scene::speed_allowed_mm_s(
                reaches[f], scene.materials[object.material_of(static_cast<std::uint32_t>(f))].radius_mm,
                1 / feed_hz);
            std::size_t band = survey.speeds.size() - 1;
            while (band > 0 && speed < survey.speeds[band].from_mm_s)
                --band;
            bands.push_back(static_cast<unsigned char>(band));
            survey.speeds[band].area_part += areas[f];
            whole += areas[f];
        }
    }
    for (SpeedBand& band : survey.speeds)
        band.area_part /= whole > 0 ? whole : 1;
}

} // namespace

Survey survey_of(const scene::Scene& scene, std::uint32_t budget, double feed_hz)
{
    Survey survey;
    survey.speeds = {{{0, palette::thin[0]},
                      {50, palette::thin[1]},
                      {200, palette::thin[2]},
                      {scene::fastest_hand_mm_s, palette::surface}}};
    for (const scene::Object& object : scene.objects)
        add_edges(object, survey);
    survey.repairs = repairs_of(scene);
    add_speeds(scene, budget, feed_hz, survey);
    return survey;
}

} // namespace phantom::view
