// SPDX-License-Identifier: GPL-2.0-or-later
// The proxy under the surface of bumpy spheres, beside what CHAI3D 3.3 and HAPI 1.3 do there. No test: it
// prints a table. Usage: penetration_bench [seconds per case, default 20 [frequency of the one
// mesh to run]]
#include <algorithm>
#include <array>
#include <cstdio>
#include <cstdlib>

#include <fmt/format.h>

#include "study/penetration.hpp"

namespace {

using namespace phantom;

constexpr std::array<double, 3> speeds_mm_s{20, 100, 500};

/// Error against the nearest point, N, p50 / p99; the same meshes, depth, stiffness and speeds at 1 kHz,
/// with the whole mesh at hand.
struct Peers {
    unsigned frequency;
    double speed_mm_s;
    const char *chai3d, *hapi;
};
constexpr std::array<Peers, 9> peers{{{32, 20, "0.026 / 0.10", "0.000 / 0.17"},
                                      {32, 100, "0.025 / 0.10", "0.000 / 0.17"},
                                      {32, 500, "0.034 / 28", "0.000 / 0.23"},
                                      {100, 20, "", ""},
                                      {100, 100, "0.009 / 46, stuck", "0.000 / 0.06"},
                                      {100, 500, "0.21 / 49", "fell through"},
                                      {316, 20, "0.002 / 0.012", "0.000 / 0.018"},
                                      {316, 100, "23 / 38, stuck", "0.008 / 1.77, 5% lost"},
                                      {316, 500, "28 / 49", "fell through"}}};

void print(const study::PenetrationOptions& options, const study::PenetrationResult& r, const char* beside)
{
    fmt::print(
        "{:4.0f} mm/s {:3.0f} kHz  every {:4.1f} ms {:4} | under {:6} lost {:5} through {:4} stuck {:4} "
        "kept {:4} | error {:.4f} / {:.4f} / {:.4f} step {:.4f}  {}\n",
        options.path.speed_mm_s, options.path.rate_hz * 1e-3, 1e3 * options.feed_every / options.path.rate_hz,
        r.patches_max, r.under, r.lost, r.fell_through, r.stuck, r.kept, r.error_p50, r.error_p99,
        r.error_max, r.step_max, beside);
    std::fflush(stdout);
}

bool run_mesh(unsigned frequency, double seconds)
{
    Result<mesh::Mesh> mesh = study::bumpy_sphere(frequency);
    if (!mesh)
        return false;
    const scene::Scene scene = study::penetration_scene(std::move(*mesh));
    const fdh::SceneTree<14> tree = scene::build_tree<14>(scene);
    const study::BruteForce oracle(scene.objects[0].mesh);
    fmt::print("\n{} triangles; error of the force in N: p50 / p99 / max\n", scene.triangles());
    const auto run = [&](study::PenetrationOptions options, const char* beside) {
        options.path.seconds = seconds;
        options.check_every = options.path.rate_hz > 2000 ? 16 : 4;
        const auto result = study::run_penetration(scene, tree, oracle, options);
        if (result)
            print(options, *result, beside);
        return static_cast<bool>(result);
    };
    for (const double speed : speeds_mm_s) {
        for (const double rate : {1000.0, 3000.0, 10000.0}) {
            std::string beside;
            for (const Peers& peer : peers)
                if (peer.frequency == frequency && peer.speed_mm_s == speed && rate == 1000.0)
                    beside = fmt::format("CHAI3D {}, HAPI {}", peer.chai3d, peer.hapi);
            if (!run({.path = {.speed_mm_s = speed, .rate_hz = rate}}, beside.c_str()))
                return false;
        }
    }
    for (const double speed : speeds_mm_s)
        for (const std::uint32_t ms : {1U, 2U, 5U, 10U})
            if (!run({.path = {.speed_mm_s = speed, .rate_hz = 3000},
                      .grow_budget = true,
                      .feed_every = 3 * ms},
                     "sets grow"))
                return false;
    return run({.path = {.speed_mm_s = 100}, .proxy = "paper"}, "proxy=paper");
}

} // namespace

int main(int argc, char** argv)
{
    const double seconds = argc > 1 ? std::atof(argv[1]) : 20;
    if (!(seconds > 0)) {
        std::fprintf(stderr, "penetration_bench: %s: expected seconds per case\n", argv[1]);
        return 2;
    }
    if (argc > 2)
        return run_mesh(static_cast<unsigned>(std::max(1, std::atoi(argv[2]))), seconds) ? 0 : 1;
    for (const unsigned frequency : {32U, 100U, 316U})
        if (!run_mesh(frequency, seconds))
            return 1;
    return 0;
}
