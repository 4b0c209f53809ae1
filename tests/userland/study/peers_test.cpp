// SPDX-License-Identifier: GPL-2.0-or-later
// The comparison with other libraries: that a wrong answer cannot pass for a fast one, that what libraries
// leave to us is right, that paths and ratios are what they are said to be, and that the program runs.
#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <numeric>
#include <random>
#include <sstream>

#include "base/vector.hpp"
#include "mesh/nearest_on_triangle.hpp"
#include "study/peers/agreement.hpp"
#include "study/peers/hulls.hpp"
#include "study/peers/measure.hpp"
#include "study/peers/nearest_keeper.hpp"
#include "study/peers/report.hpp"

namespace phantom::peers {

namespace {

// Those of FloatVector, which is of this namespace, would hide them.
using phantom::operator-, phantom::operator+, phantom::cross;

std::vector<double> ladder()
{
    std::vector<double> distances(wanted);
    std::iota(distances.begin(), distances.end(), 1.0);
    return distances;
}

TEST(PeersAgreement, HoldsWhateverTheOrder)
{
    std::vector<double> shuffled = ladder();
    std::ranges::reverse(shuffled);
    EXPECT_FALSE(disagreement(shuffled, ladder(), 100, 1e-6));
}

TEST(PeersAgreement, ATriangleThatWasMissedIsFound)
{
    std::vector<double> answer = ladder();
    answer[10] = 65; // the 65th in its place
    EXPECT_TRUE(disagreement(answer, ladder(), 100, 1e-6));
    answer.erase(answer.begin() + 10);
    EXPECT_TRUE(disagreement(answer, ladder(), 100, 1e-6));
    answer = ladder();
    answer.pop_back(); // the last one, from among others that are right
    EXPECT_TRUE(disagreement(answer, ladder(), 100, 1e-6));
}

TEST(PeersAgreement, ATriangleCountedTwiceIsFound)
{
    std::vector<double> answer = ladder();
    answer[20] = answer[19];
    EXPECT_TRUE(disagreement(answer, ladder(), 100, 1e-6));
    answer = ladder();
    answer.push_back(64);
    EXPECT_TRUE(disagreement(answer, ladder(), 100, 1e-6));
}

TEST(PeersAgreement, NoNumberIsNoDistance)
{
    std::vector<double> answer = ladder();
    for (const double none : {std::numeric_limits<double>::quiet_NaN(), -1.0}) {
        answer[0] = none;
        EXPECT_TRUE(disagreement(answer, ladder(), 100, 2.0)) << none;
    }
}

TEST(PeersAgreement, OnlyTheRadiusEndIsOpen)
{
    std::vector<double> at_the_end = ladder();
    at_the_end.resize(31); // 1 ... 31; the 32nd lies at the radius
    std::vector<double> with_it = at_the_end;
    with_it.push_back(31.5);
    EXPECT_FALSE(disagreement(at_the_end, with_it, 31.5, 1e-6));
    EXPECT_TRUE(disagreement(at_the_end, with_it, 31.6, 1e-6));
}

/// Random triangles, some of them needles, caps, segments and points.
Mesh soup(std::size_t count)
{
    std::mt19937_64 random(11);
    std::uniform_real_distribution<float> place(-10, 10), small(-1, 1);
    Mesh mesh;
    const auto add = [&mesh](const FloatVector& p) {
        mesh.points.push_back({p.x, p.y, p.z, 0});
        mesh.vertices.push_back({p.x, p.y, p.z});
    };
    for (std::size_t i = 0; i < count; ++i) {
        const FloatVector a{place(random), place(random), place(random)};
        const FloatVector e{small(random), small(random), small(random)};
        const FloatVector f{small(random), small(random), small(random)};
        const float flat = i % 5 == 0 ? 1e-6F : 1.0F, length = i % 7 == 0 ? 0.0F : 1.0F;
        const auto first = static_cast<std::uint32_t>(mesh.points.size());
        add(a);
        add(a - (-length) * e);
        add(a - (-0.5F * length) * e - flat * f);
        mesh.triangles.push_back({first, first + 1, first + 2});
    }
    return mesh;
}

TEST(PeersKeeper, HasTheSameNearestAsBruteForce)
{
    const Mesh mesh = soup(3000);
    std::mt19937_64 random(12);
    std::uniform_real_distribution<float> place(-10, 10);
    NearestKeeper keeper;
    std::vector<double> kept;
    for (const double radius : {0.5, 2.0, 5.0, 50.0}) {
        for (int i = 0; i < 20; ++i) {
            const fdh::Point p{place(random), place(random), place(random)};
            keeper.start(mesh, p, radius);
            for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t)
                keeper.offer(t);
            keeper.finish();
            keeper.distances(kept);
            const auto wrong = disagreement(kept, brute_force(mesh, p, radius), radius, 1e-5);
            EXPECT_FALSE(wrong) << *wrong;
        }
    }
}

TEST(PeersKeeper, ShrinksItsBoundToTheFarthestItKeeps)
{
    const Mesh mesh = soup(1000);
    NearestKeeper keeper;
    keeper.start(mesh, {0, 0, 0}, 100);
    int shrunk = 0;
    for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t)
        shrunk += keeper.offer(t);
    EXPECT_GT(shrunk, 1);
    keeper.finish();
    std::vector<double> kept;
    keeper.distances(kept);
    ASSERT_EQ(kept.size(), wanted);
    EXPECT_NEAR(std::sqrt(keeper.bound2()), std::ranges::max(kept), 1e-6);
}

TEST(PeersTriangleDistance, IsTheExactOneFromEverySide)
{
    const Mesh mesh = soup(2000);
    std::mt19937_64 random(13);
    std::uniform_real_distribution<float> near(-2, 2);
    for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
        const auto x = mesh.corners(i);
        const fdh::Triangle& t = mesh.triangles[i];
        const FloatVector a = as_vector(mesh.points[t[0]]);
        const FloatVector p = a - FloatVector{near(random), near(random), near(random)};
        const float squared =
            squared_distance(p, a, as_vector(mesh.points[t[1]]), as_vector(mesh.points[t[2]]));
        EXPECT_NEAR(std::sqrt(squared), mesh::distance_to_triangle({p.x, p.y, p.z}, x), 1e-5) << i;
    }
}

TEST(PeersMesh, SpheresHaveTheTrianglesTheyAreNamedFor)
{
    EXPECT_EQ(make_mesh("sphere-20k")->triangles.size(), 20480U);
    EXPECT_EQ(make_mesh("sphere-3")->triangles.size(), 180U);
    const Result<Mesh> spot = make_mesh("spot-50");
    ASSERT_TRUE(spot);
    // Two fifths of them in the spot, on a sphere of half a million times their area.
    const auto in_spot = std::ranges::count_if(spot->triangles, [&](const fdh::Triangle& t) {
        return length(spot->vertices[t[1]] - spot->vertices[t[0]]) < 0.3;
    });
    EXPECT_NEAR(static_cast<double>(in_spot) / static_cast<double>(spot->triangles.size()), 0.4, 0.1);
}

TEST(PeersMesh, ClosedToTheLastTriangle)
{
    // The sum of all area vectors vanishes where nothing is left out and all turn the same way.
    const Result<Mesh> mesh = make_mesh("sphere-20");
    ASSERT_TRUE(mesh);
    Vec3 sum{};
    double area = 0;
    for (std::size_t i = 0; i < mesh->triangles.size(); ++i) {
        const auto x = mesh->corners(i);
        const Vec3 vector = cross(x[1] - x[0], x[2] - x[0]);
        sum = sum + vector;
        area += length(vector);
    }
    EXPECT_LT(length(sum), 1e-6 * area);
}

TEST(PeersMesh, NamesThatMeanNothingAreRefusedInOneLine)
{
    for (const char* name : {"sphere-0", "sphere-2001", "sphere-20q", "cube", "/nowhere/x.ply"}) {
        const Result<Mesh> mesh = make_mesh(name);
        ASSERT_FALSE(mesh) << name;
        EXPECT_EQ(mesh.error().text().find('\n'), std::string::npos);
        EXPECT_NE(mesh.error().text().find(name), std::string::npos);
    }
}

TEST(PeersWorkload, WalksAlongTheSurfaceInStepsAndJumpsOntoIt)
{
    const Result<Mesh> mesh = make_mesh("sphere-10");
    ASSERT_TRUE(mesh);
    constexpr std::size_t strokes = 3, steps = 40;
    const Workload work = make_workload(*mesh, strokes, steps);
    ASSERT_EQ(work.walk.size(), strokes * steps);
    ASSERT_EQ(work.jump.size(), strokes * steps);
    const double step = walk_step_part * mesh->diagonal;
    for (std::size_t i = 0; i < work.walk.size(); ++i) {
        EXPECT_LT(brute_force(*mesh, work.walk[i], 1e9).front(), 1e-4);
        EXPECT_LT(brute_force(*mesh, work.jump[i], 1e9).front(), 1e-4);
        if (i % steps != 0) {
            EXPECT_NEAR(length(work.walk[i] - work.walk[i - 1]), step, 0.3 * step);
        }
    }
    // Half of all spheres hold 64.
    const auto full = std::ranges::count_if(
        work.jump, [&](const auto& p) { return brute_force(*mesh, p, work.radius).size() == wanted; });
    EXPECT_NEAR(static_cast<double>(full) / static_cast<double>(work.jump.size()), 0.5, 0.2);
}

TEST(PeersRatio, IsTheMedianOverRoundsThatBothTookPartIn)
{
    const double none = std::numeric_limits<double>::quiet_NaN();
    EXPECT_EQ(ratio({6, none, 8, 100, 4}, {2, 1, none, 10, 4}), 3);
    EXPECT_EQ(ratio({none}, {1}), std::nullopt);
    EXPECT_EQ(ratio({}, {1}), std::nullopt);
}

/// Answers right until it does not.
class Liar final : public Contender {
  public:
    explicit Liar(int honest) : honest_(honest) {}
    [[nodiscard]] std::string name() const override { return "Liar"; }
    [[nodiscard]] std::string method() const override { return "forgets one"; }
    void prepare(const Mesh& mesh) override { mesh_ = &mesh; }
    void build(unsigned /*threads*/) override {}
    [[nodiscard]] std::size_t bytes() const override { return 0; }
    void query(const fdh::Point& p, double radius) override
    {
        answer_ = brute_force(*mesh_, p, radius);
        if (--honest_ < 0)
            answer_.erase(answer_.begin());
    }
    void distances(std::vector<double>& out) const override { out = answer_; }

  private:
    const Mesh* mesh_ = nullptr;
    std::vector<double> answer_;
    int honest_;
};

MeasureOptions short_run()
{
    MeasureOptions options;
    options.rounds = 2;
    options.block = 10;
    options.lead_in = 2;
    options.checked = 10;
    options.build_seconds = 0;
    return options;
}

TEST(PeersMeasure, AWrongAnswerIsAFailureAndNoTime)
{
    const Result<Mesh> mesh = make_mesh("sphere-6");
    ASSERT_TRUE(mesh);
    // Found before the timing, and in it: 20 checked queries, then 4 blocks of 12.
    for (const int honest : {0, 15, 25}) {
        Result<Field> field = field_for(*mesh, {"FDH6"});
        ASSERT_TRUE(field);
        field->contenders.push_back(std::make_unique<Liar>(honest));
        const auto figures = measure(*mesh, std::move(*field), short_run());
        ASSERT_FALSE(figures) << honest;
        EXPECT_NE(figures.error().text().find("Liar is wrong at"), std::string::npos);
    }
    Result<Field> field = field_for(*mesh, {"FDH6"});
    field->contenders.push_back(std::make_unique<Liar>(1000));
    EXPECT_TRUE(measure(*mesh, std::move(*field), short_run()));
}

TEST(PeersMeasure, OurOwnAnswerIsHeldAgainstEveryTriangle)
{
    const Result<Mesh> mesh = make_mesh("sphere-6");
    Field field;
    field.contenders.push_back(std::make_unique<Liar>(0));
    EXPECT_FALSE(measure(*mesh, std::move(field), short_run()));
}

TEST(PeersGoals, ComparesWithTheYardstickRoundByRound)
{
    Figures own{.name = own_name}, boxes{.name = boxes_name}, yard{.name = yardstick};
    own.walk.median_ns = {10, 20, 30};
    yard.walk.median_ns = {70, 120, 150}; // 7, 6, 5
    boxes.walk.median_ns = {5, 10, 15};
    own.build_one = {9, 9};
    own.build_all = {18, 9}; // 2, 1
    yard.build_one = {3, 3};
    own.bytes_per_triangle = 40;
    MeshFigures mesh;
    mesh.mesh = "sphere-1";
    mesh.triangles = 20;
    mesh.threads = 2;
    mesh.figures = {own, boxes, yard};
    const auto figure = [all = goals(std::span(&mesh, 1))](const std::string& what) {
        const auto goal = std::ranges::find_if(all, [&](const Goal& g) { return g.what.starts_with(what); });
        EXPECT_NE(goal, all.end()) << what;
        return std::pair(goal->figures[0], goal->figures[0] && goal->meets(*goal->figures[0], goal->goal));
    };
    EXPECT_EQ(figure("walk, median, times Embree"), std::pair(std::optional(6.0), true));
    EXPECT_EQ(figure("walk, times FDH6"), std::pair(std::optional(2.0), false));
    EXPECT_EQ(figure("build on one thread"), std::pair(std::optional(3.0), true));
    EXPECT_EQ(figure("build on all threads"), std::pair(std::optional(1.0), false));
    EXPECT_EQ(figure("memory"), std::pair(std::optional(40.0), true));
    EXPECT_EQ(figure("refit").first, std::nullopt);
}

std::string text_of(const std::filesystem::path& file)
{
    std::ostringstream text;
    text << std::ifstream(file).rdbuf();
    return text.str();
}

class PeersBench : public testing::Test {
  protected:
    PeersBench() { std::filesystem::remove_all(folder); }
    ~PeersBench() override { std::filesystem::remove_all(folder); }
    [[nodiscard]] int run(const std::string& arguments) const
    {
        const std::string command = std::string(PEERS_BENCH) + " --quick --rounds 2 --out " +
                                    folder.string() + " " + arguments + " >/dev/null 2>&1";
        return WEXITSTATUS(std::system(command.c_str()));
    }
    std::filesystem::path folder =
        std::filesystem::temp_directory_path() / ("peers_test-" + std::to_string(::getpid()));
};

TEST_F(PeersBench, WritesFiguresTablesAndAChart)
{
    ASSERT_EQ(run("--meshes sphere-8,spot-8"), 0);
    const std::string csv = text_of(folder / "peers.csv"), tables = text_of(folder / "peers.md"),
                      chart = text_of(folder / "peers.svg");
    EXPECT_TRUE(csv.starts_with("mesh,triangles,contender,measure,unit,value\n"));
    for (const char* row : {"sphere-8,1280,FDH14,walk_median,ns,", "spot-8,", ",FDH26,jump_leaves,1,"})
        EXPECT_NE(csv.find(row), std::string::npos) << row;
    EXPECT_NE(tables.find("| memory, B/triangle | ≤ 48 | ≤ 30 |"), std::string::npos);
    EXPECT_TRUE(chart.starts_with("<svg ") && chart.ends_with("</svg>\n"));
    for (const std::string& text : {csv, tables, chart})
        EXPECT_EQ(text.find("nan"), std::string::npos);
}

TEST_F(PeersBench, RefusesWhatItDoesNotKnow)
{
    EXPECT_EQ(run("--meshes cube"), 1);
    EXPECT_EQ(run("--meshes sphere-8 --contenders Nobody"), 1);
    EXPECT_EQ(run("--rounds 0"), 2);
    EXPECT_FALSE(std::filesystem::exists(folder));
}

} // namespace

} // namespace phantom::peers
