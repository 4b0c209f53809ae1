// SPDX-License-Identifier: GPL-2.0-or-later
// Prints what building and querying cost. The query is the servo's: the 64 nearest within the radius of the
// median sphere that holds 64. "walk" moves along the surface by 1/2000 of the mesh's diagonal per query,
// "jump" goes anywhere on it. Medians and 99th percentiles; differences of a few percent are noise.
//
//   fdh_bench [ISA...]      scalar sse2 avx2 avx512; default: the best
#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstring>

#include "fdh/tree.hpp"
#include "meshes.hpp"

namespace phantom::fdh::test {

namespace {

using Clock = std::chrono::steady_clock;
constexpr std::size_t wanted = 64;

/// A point on a random face, and one of its edges' directions.
struct Place {
    Point point, along;
};

Place random_place(const Mesh& mesh, std::mt19937_64& random)
{
    std::uniform_real_distribution<double> unit(0, 1);
    const auto& t = mesh.triangles[random() % mesh.triangles.size()];
    const auto &a = mesh.vertices[t[0]], &b = mesh.vertices[t[1]], &c = mesh.vertices[t[2]];
    double s = unit(random), r = unit(random);
    if (s + r > 1)
        s = 1 - s, r = 1 - r;
    Place place;
    double length = 0;
    for (int axis = 0; axis < 3; axis++) {
        place.point[axis] = a[axis] + s * (b[axis] - a[axis]) + r * (c[axis] - a[axis]);
        place.along[axis] = b[axis] - a[axis];
        length += place.along[axis] * place.along[axis];
    }
    for (double& x : place.along)
        x /= std::sqrt(length);
    return place;
}

double diagonal(const Mesh& mesh)
{
    const auto hull = TriangleTree<6>::build(mesh.view()).hull();
    double sum = 0;
    for (const auto& [low, high] : hull)
        sum += (high - low) * (high - low);
    return std::sqrt(sum);
}

struct Times {
    double median, p99; // [ns]
};

template <int K>
Times time_queries(const TriangleTree<K>& tree, const std::vector<Point>& points, double radius)
{
    Nearest found;
    std::vector<double> times;
    for (const Point& p : points)
        tree.nearest(p, wanted, radius, found); // warm
    times.reserve(points.size());
    for (const Point& p : points) {
        const auto start = Clock::now();
        tree.nearest(p, wanted, radius, found);
        times.push_back(std::chrono::duration<double, std::nano>(Clock::now() - start).count());
    }
    std::sort(times.begin(), times.end());
    return {times[times.size() / 2], times[times.size() * 99 / 100]};
}

/// Best of several, [million triangles per second].
template <int K>
double build_rate(const Mesh& mesh, unsigned threads)
{
    double best = 0;
    for (int i = 0; i < 5; i++) {
        const auto start = Clock::now();
        const auto tree = TriangleTree<K>::build(mesh.view(), {.threads = threads});
        const std::chrono::duration<double> taken = Clock::now() - start;
        best = std::max(best, static_cast<double>(tree.triangles()) / taken.count() / 1e6);
    }
    return best;
}

struct Workload {
    double radius;
    std::vector<Point> walk, jump;
};

Workload make_workload(const Mesh& mesh)
{
    std::mt19937_64 random(1);
    const auto tree = TriangleTree<14>::build(mesh.view());
    std::vector<double> reach;
    Nearest found;
    for (int i = 0; i < 1001; i++) {
        tree.nearest(random_place(mesh, random).point, wanted, 1e300, found);
        reach.push_back(found.hits.back().distance);
    }
    std::nth_element(reach.begin(), reach.begin() + 500, reach.end());
    Workload load{reach[500], {}, {}};
    const double step = diagonal(mesh) / 2000;
    constexpr int queries = 20000, steps_per_stroke = 50;
    for (int i = 0; i < queries; i++) {
        load.jump.push_back(random_place(mesh, random).point);
        if (i % steps_per_stroke)
            continue;
        // A stroke: along an edge's direction, pulled back to the surface at every step.
        Place place = random_place(mesh, random);
        for (int s = 0; s < steps_per_stroke; s++) {
            load.walk.push_back(place.point);
            for (int axis = 0; axis < 3; axis++)
                place.point[axis] += step * place.along[axis];
            tree.nearest(place.point, 1, 1e300, found);
            const auto& corner = mesh.vertices[mesh.triangles[found.hits[0].triangle][0]];
            const double pull = found.hits[0].distance /
                                (1e-300 + std::hypot(corner[0] - place.point[0], corner[1] - place.point[1],
                                                     corner[2] - place.point[2]));
            for (int axis = 0; axis < 3; axis++)
                place.point[axis] += pull * (corner[axis] - place.point[axis]);
        }
    }
    return load;
}

template <int K>
void row(const char* name, const Mesh& mesh, const Workload& load, Isa isa)
{
    const auto tree = TriangleTree<K>::build(mesh.view(), {.isa = isa});
    const double one = build_rate<K>(mesh, 1), all = build_rate<K>(mesh, 0);
    const Times walk = time_queries(tree, load.walk, load.radius),
                jump = time_queries(tree, load.jump, load.radius);
    const Times open = time_queries(tree, load.jump, 1e300);
    double leaves = 0;
    Nearest found;
    for (const Point& p : load.jump) {
        tree.nearest(p, wanted, load.radius, found);
        leaves += static_cast<double>(found.counts.leaves);
    }
    std::printf(
        "%-12s %9zu  FDH%-2d  %-6s  %6.2f %6.2f  %5.1f  %6.0f %6.0f  %6.0f %6.0f  %6.0f %6.0f  %6.1f\n", name,
        mesh.triangles.size(), K, isa_name(resolve_isa(isa)), one, all,
        static_cast<double>(tree.bytes()) / static_cast<double>(mesh.triangles.size()), walk.median, walk.p99,
        jump.median, jump.p99, open.median, open.p99, leaves / static_cast<double>(load.jump.size()));
    std::fflush(stdout);
}

void table(const char* name, const Mesh& mesh, const std::vector<Isa>& isas)
{
    const Workload load = make_workload(mesh);
    for (Isa isa : isas) {
        row<6>(name, mesh, load, isa);
        row<14>(name, mesh, load, isa);
        row<18>(name, mesh, load, isa);
        row<26>(name, mesh, load, isa);
    }
}

int run(int argc, char** argv)
{
    std::vector<Isa> isas;
    for (int i = 1; i < argc; i++) {
        const Isa all[] = {Isa::best, Isa::scalar, Isa::sse2, Isa::avx2, Isa::avx512};
        const auto it = std::find_if(std::begin(all), std::end(all),
                                     [&](Isa isa) { return std::strcmp(isa_name(isa), argv[i]) == 0; });
        if (it == std::end(all) || !isa_available(*it)) {
            std::fprintf(stderr, "fdh_bench: %s: not an instruction set of this machine\n", argv[i]);
            return 2;
        }
        isas.push_back(*it);
    }
    if (isas.empty())
        isas = {Isa::best};
    std::printf(
        "                               build Mtri/s          walk ns        jump ns        no radius ns\n"
        "mesh         triangles  hull   isa        1 core   all   B/tri  median    p99  median    p99  "
        "median    p99  leaves\n");
    if (const auto mesh = bunny())
        table("bunny", *mesh, isas);
    table("sphere", sphere(6, 60), isas);
    table("sphere", sphere(8, 60), isas);
    return 0;
}

} // namespace

} // namespace phantom::fdh::test

int main(int argc, char** argv)
{
    return phantom::fdh::test::run(argc, argv);
}
