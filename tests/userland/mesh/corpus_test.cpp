// SPDX-License-Identifier: GPL-2.0-or-later
// What preparation promises of every mesh, however bad: nothing lost silently, every normal usable, the
// second time nothing to do, the surface where it was.
#include <array>
#include <set>

#include <gtest/gtest.h>

#include "corpus.hpp"
#include "mesh/fans.hpp"
#include "mesh/read.hpp"

namespace phantom::mesh::test {
namespace {

using Place = std::array<Vec3, 3>; ///< where a face is; begins with its lowest corner

Place place_of(const Vec3& a, const Vec3& b, const Vec3& c)
{
    Place place = {a, b, c};
    std::rotate(place.begin(), std::min_element(place.begin(), place.end()), place.end());
    return place;
}

Place turned(const Place& place)
{
    return {place[0], place[2], place[1]};
}

template <typename AnyMesh>
Place place_of_face(const AnyMesh& mesh, std::size_t f)
{
    return place_of(mesh.vertices[mesh.faces[f][0]], mesh.vertices[mesh.faces[f][1]],
                    mesh.vertices[mesh.faces[f][2]]);
}

bool finite(const Place& place)
{
    return is_finite(place[0]) && is_finite(place[1]) && is_finite(place[2]);
}

/// By the height over the longest side, in long double: not the code that drops faces.
bool has_area(const Place& place)
{
    if (!finite(place))
        return false;
    std::array<std::array<long double, 3>, 2> side{};
    for (std::size_t i = 0; i < 3; ++i) {
        side[0][i] = static_cast<long double>(place[1][i]) - place[0][i];
        side[1][i] = static_cast<long double>(place[2][i]) - place[0][i];
    }
    long double square = 0, longest = 0;
    for (std::size_t i = 0; i < 3; ++i) {
        const std::size_t j = (i + 1) % 3;
        const long double c = side[0][i] * side[1][j] - side[0][j] * side[1][i];
        square += c * c;
    }
    for (const auto& [a, b] : {std::pair{0, 1}, std::pair{1, 2}, std::pair{2, 0}}) {
        const long double d = distance(place[a], place[b]);
        longest = std::max(longest, d);
    }
    return std::sqrt(square) > 2e-12L * longest * longest;
}

double distance_to_segment(const Vec3& p, const Vec3& a, const Vec3& b)
{
    const Vec3 along = subtract(b, a), out = subtract(p, a);
    const double part = std::clamp(dot(along, out) / dot(along, along), 0.0, 1.0);
    return length(subtract(out, scaled(along, part)));
}

double distance_to_face(const Vec3& p, const Place& x)
{
    double least = std::min({distance_to_segment(p, x[0], x[1]), distance_to_segment(p, x[1], x[2]),
                             distance_to_segment(p, x[2], x[0])});
    const Vec3 normal = normalized(cross(subtract(x[1], x[0]), subtract(x[2], x[0])));
    for (std::size_t i = 0; i < 3; ++i) {
        if (dot(cross(normal, subtract(x[(i + 1) % 3], x[i])), subtract(p, x[i])) < 0)
            return least;
    }
    return std::min(least, std::abs(dot(normal, subtract(p, x[0]))));
}

/// Farthest of some points of one surface (corners, centres) from the other. Plain search: every n-th only.
double one_sided_distance(const std::vector<Place>& from, const std::vector<Place>& to)
{
    const std::size_t step = std::max<std::size_t>(1, from.size() * to.size() / 60'000);
    double farthest = 0;
    for (std::size_t f = 0; f < from.size(); f += step) {
        const Vec3 centre = scaled(add(add(from[f][0], from[f][1]), from[f][2]), 1.0 / 3);
        for (const Vec3& p : {centre, from[f][f % 3], scaled(add(from[f][0], from[f][1]), 0.5)}) {
            double nearest = std::numeric_limits<double>::infinity();
            for (const Place& face : to)
                nearest = std::min(nearest, distance_to_face(p, face));
            farthest = std::max(farthest, nearest);
        }
    }
    return farthest;
}

template <typename AnyMesh>
std::vector<Place> places_of(const AnyMesh& mesh)
{
    std::vector<Place> places;
    for (std::size_t f = 0; f < mesh.faces.size(); ++f) {
        const Place place = place_of_face(mesh, f);
        if (has_area(place))
            places.push_back(place);
    }
    return places;
}

/// By the points: over every edge as many faces one way as the other, and two in all.
bool closed_by_points(const std::vector<Place>& places)
{
    std::map<std::pair<Vec3, Vec3>, int> edges;
    for (const Place& place : places)
        for (std::size_t i = 0; i < 3; ++i)
            ++edges[{place[i], place[(i + 1) % 3]}];
    return std::all_of(edges.begin(), edges.end(), [&edges](const auto& edge) {
        const auto back = edges.find({edge.first.second, edge.first.first});
        return edge.second == 1 && back != edges.end() && back->second == 1;
    });
}

void expect_accounted(const Report& r, const Soup& given)
{
    EXPECT_EQ(r.faces_read, given.faces.size());
    EXPECT_EQ(r.faces_read, r.faces - r.faces_split - r.faces_cut + r.faces_zero_area + r.faces_duplicate +
                                r.faces_nonfinite);
    EXPECT_EQ(r.faults, 0U);
}

void expect_valid(const Mesh& mesh)
{
    ASSERT_EQ(mesh.face_normals.size(), mesh.faces.size());
    ASSERT_EQ(mesh.neighbours.size(), mesh.faces.size());
    for (const Vec3& normal : mesh.normals)
        ASSERT_NEAR(length(normal), 1, 1e-12);
    for (std::uint32_t f = 0; f < mesh.faces.size(); ++f) {
        for (std::size_t i = 0; i < 3; ++i) {
            ASSERT_GT(dot(mesh.normals[mesh.face_normals[f][i]], normal_of(mesh, f)), 0) << "face " << f;
            const Vec3 &a = mesh.vertices[mesh.faces[f][i]], &b = mesh.vertices[mesh.faces[f][(i + 1) % 3]];
            ASSERT_GT(distance(a, b), 0) << "face " << f;
            const std::uint32_t other = mesh.neighbours[f][i];
            if (other == no_neighbour)
                continue;
            bool mutual = false;
            for (std::size_t j = 0; j < 3; ++j)
                mutual = mutual || (mesh.vertices[mesh.faces[other][j]] == b &&
                                    mesh.vertices[mesh.faces[other][(j + 1) % 3]] == a &&
                                    mesh.neighbours[other][j] == f);
            ASSERT_TRUE(mutual) << "faces " << f << " and " << other;
        }
    }
    // A fan over an edge has the edge's length, over a vertex none: nothing between.
    for (const Fan& fan : make_fans(mesh).fans) {
        std::set<std::uint32_t> corners(fan.corners.begin(), fan.corners.end());
        ASSERT_LE(corners.size(), 2U);
        if (corners.size() == 2) {
            ASSERT_GT(distance(mesh.vertices[*corners.begin()], mesh.vertices[*corners.rbegin()]), 0);
        }
        for (const Vec3& normal : fan.normals)
            ASSERT_NEAR(length(normal), 1, 1e-12);
    }
}

void expect_idempotent(const Prepared& once, const PrepareOptions& options)
{
    const auto twice = prepare(soup_of(once.mesh), options, "again");
    ASSERT_TRUE(twice.ok()) << twice.error().text();
    EXPECT_EQ(twice->mesh.vertices, once.mesh.vertices);
    EXPECT_EQ(twice->mesh.faces, once.mesh.faces);
    EXPECT_EQ(twice->mesh.normals, once.mesh.normals);
    EXPECT_EQ(twice->mesh.face_normals, once.mesh.face_normals);
    EXPECT_EQ(twice->mesh.neighbours, once.mesh.neighbours);
    const Report& r = twice->report;
    EXPECT_EQ(r.faces_zero_area + r.faces_duplicate + r.faces_nonfinite + r.faces_flipped + r.faces_split +
                  r.faces_cut + r.components_turned + r.vertices_sewn + r.t_junctions + r.normals_repaired,
              0U);
    EXPECT_EQ(r.vertices_welded, r.vertices_separated);
    EXPECT_EQ(r.moved_max_mm, 0);
}

/// Faces that no step had to touch are where they were, with the normals that they had.
void expect_untouched(const Soup& given, const Prepared& out)
{
    std::map<Place, std::size_t> number;
    for (std::size_t f = 0; f < given.faces.size(); ++f)
        number.try_emplace(place_of_face(given, f), f);
    std::uint64_t elsewhere = 0;
    for (std::size_t f = 0; f < out.mesh.faces.size(); ++f) {
        const Place place = place_of_face(out.mesh, f);
        const auto found = number.find(place);
        if (found == number.end()) {
            elsewhere += number.count(turned(place)) == 0;
            continue;
        }
        if (given.face_normals.empty())
            continue;
        for (std::size_t i = 0; i < 3; ++i) {
            for (std::size_t j = 0; j < 3; ++j) {
                if (given.vertices[given.faces[found->second][j]] != out.mesh.vertices[out.mesh.faces[f][i]])
                    continue;
                const Vec3& before = given.normals[given.face_normals[found->second][j]];
                const Vec3& after = out.mesh.normals[out.mesh.face_normals[f][i]];
                if (dot(before, normal_of(out.mesh, f)) > 1e-9) {
                    ASSERT_EQ(after, before) << "face " << f;
                }
            }
        }
    }
    if (out.report.faces_split == 0 && out.report.moved_max_mm == 0) {
        EXPECT_LE(elsewhere, 2 * out.report.faces_cut);
    }
}

void expect_all(const Soup& given, const PrepareOptions& options, const Prepared& out)
{
    expect_accounted(out.report, given);
    expect_valid(out.mesh);
    expect_idempotent(out, options);
    if (options.fit_mm > 0 || ::testing::Test::HasFatalFailure())
        return;
    expect_untouched(given, out);
    const std::vector<Place> before = places_of(given), after = places_of(out.mesh);
    if (closed_by_points(before)) {
        EXPECT_TRUE(out.report.watertight);
    }
    // Beside what was moved on purpose only rounding, of the coordinates as they are.
    const Bounds bounds = bounds_of(out.mesh.vertices);
    const double rounding = 1e-11 * bounds.diagonal() + 1e-15 * length(bounds.high);
    EXPECT_LE(one_sided_distance(before, after), out.report.moved_max_mm + rounding);
    EXPECT_LE(one_sided_distance(after, before), out.report.moved_max_mm + rounding);
}

class MeshCorpus : public ::testing::TestWithParam<Sample> {};

TEST_P(MeshCorpus, HoldsWhatIsPromised)
{
    const Sample& sample = GetParam();
    const Soup given = sample.make();
    const auto out = prepare(given, sample.options, sample.name);
    ASSERT_TRUE(out.ok()) << out.error().text();
    expect_all(given, sample.options, *out);
    if (sample.expect)
        sample.expect(out->report);
}

std::string name_of(const ::testing::TestParamInfo<Sample>& sample)
{
    return sample.param.name;
}

INSTANTIATE_TEST_SUITE_P(Solids, MeshCorpus, ::testing::ValuesIn(solid_samples()), name_of);
INSTANTIATE_TEST_SUITE_P(Defects, MeshCorpus, ::testing::ValuesIn(defect_samples()), name_of);
INSTANTIATE_TEST_SUITE_P(Junctions, MeshCorpus, ::testing::ValuesIn(junction_samples()), name_of);
INSTANTIATE_TEST_SUITE_P(Normals, MeshCorpus, ::testing::ValuesIn(normal_samples()), name_of);

/// Meshes that other packages bring, where they are installed.
void expect_file_sound(const std::filesystem::path& file)
{
    SCOPED_TRACE(file.string());
    auto soup = read(file);
    ASSERT_TRUE(soup.ok()) << soup.error().text();
    const Soup given = *soup;
    const auto out = prepare(*std::move(soup), {}, file.string());
    ASSERT_TRUE(out.ok()) << out.error().text();
    expect_all(given, {}, *out);
}

TEST(MeshCorpusFiles, StanfordBunny)
{
    const std::filesystem::path bunny = "/usr/share/glmark2/models/bunny.obj";
    if (!std::filesystem::exists(bunny))
        GTEST_SKIP() << "package glmark2-data is not installed";
    expect_file_sound(bunny);
}

/// Holes, cracks, T-junctions, fins, solids inside out: what geometers collect to try their programs on.
TEST(MeshCorpusFiles, MeshesOfCgal)
{
    const std::filesystem::path archive = "/usr/share/doc/libcgal-demo/data.tar.gz";
    if (!std::filesystem::exists(archive))
        GTEST_SKIP() << "package libcgal-demo is not installed";
    const Folder folder;
    const std::string command =
        "tar -xzf " + archive.string() + " -C " + folder.path().string() + " data/meshes";
    ASSERT_EQ(std::system(command.c_str()), 0);
    std::size_t meshes = 0;
    for (const auto& entry : std::filesystem::directory_iterator(folder / "data" / "meshes")) {
        if (!is_mesh_file(entry.path()) || entry.file_size() > 25'000)
            continue;
        if (!read(entry.path()).ok())
            continue; // point clouds, which have no faces
        expect_file_sound(entry.path());
        ++meshes;
    }
    EXPECT_GT(meshes, 30U);
}

TEST(MeshCorpusFiles, ModelsOfAssimp)
{
    const std::filesystem::path models = "/usr/share/assimp/models";
    if (!std::filesystem::exists(models))
        GTEST_SKIP() << "package assimp-testmodels is not installed";
    for (const auto& entry : std::filesystem::recursive_directory_iterator(models)) {
        // Some are broken on purpose: those are refused, in one line.
        if (is_mesh_file(entry.path()) && entry.file_size() <= 25'000 && read(entry.path()).ok())
            expect_file_sound(entry.path());
    }
}

} // namespace
} // namespace phantom::mesh::test
