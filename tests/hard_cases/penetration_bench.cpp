// SPDX-License-Identifier: GPL-2.0-or-later
// The proxy under the surface of bumpy spheres, beside what CHAI3D 3.3 and HAPI 1.3 do there. No test: it
// prints a table.
//
//     penetration_bench [--seconds S] [--sphere F] [--markdown]
//
// S seconds of each case, 20 by default (some six minutes in all); F: the one sphere to run, of frequency
// 32, 100 or 316.
#include <algorithm>
#include <array>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <string>

#include <fmt/format.h>

#include "study/penetration.hpp"

namespace {

using namespace phantom;

constexpr std::array<double, 3> speeds_mm_s{20, 100, 500};

/// Each sphere's levels of detail are itself and those after it.
constexpr std::array<unsigned, 6> frequencies{316, 158, 100, 50, 32, 20};
constexpr std::array<unsigned, 3> spheres{32, 100, 316};

/// Error against the nearest point, N, p50 / p99, measured with CHAI3D 3.3 (its finger-proxy, point) and HAPI
/// 1.3 (god-object on its AABB tree) on the same meshes and path: 3 mm deep, 0.5 N/mm, 1 kHz, 20 s, with the
/// whole mesh at hand. Empty: not measured.
struct Peers {
    unsigned frequency;
    double speed_mm_s;
    const char *chai3d, *hapi;
};
constexpr std::array<Peers, 9> all_peers{{{32, 20, "0.026 / 0.10", "0.000 / 0.17"},
                                          {32, 100, "0.025 / 0.10", "0.000 / 0.17"},
                                          {32, 500, "0.034 / 28", "0.000 / 0.23"},
                                          {100, 20, "", ""},
                                          {100, 100, "0.009 / 46, stuck", "0.000 / 0.06"},
                                          {100, 500, "0.21 / 49", "fell through"},
                                          {316, 20, "0.002 / 0.012", "0.000 / 0.018"},
                                          {316, 100, "23 / 38, stuck", "0.008 / 1.77, 5% lost"},
                                          {316, 500, "28 / 49", "fell through"}}};

struct Arguments {
    double seconds = 20;
    unsigned sphere = 0; ///< 0: all
    bool markdown = false;
};

/// What a case did on which sphere, in words.
class Table {
  public:
    explicit Table(bool markdown) : markdown_(markdown) {}

    void begin(const study::PenetrationSurface& surface) const
    {
        const std::vector<unsigned>& frequency = surface.frequencies();
        fmt::print("\n{} triangles (f = {}), 64 in a set\n", surface.scene().triangles(), frequency[0]);
        for (std::size_t level = 0; level < frequency.size(); ++level)
            fmt::print("  {}level f {:3}: 64 triangles reach {:.2f} mm, {:.4f} mm from the finest\n",
                       markdown_ ? "- " : "", frequency[level], surface.levels()->coverage(level).p1_mm,
                       surface.levels()->error_mm(level));
        if (markdown_)
            fmt::print(
                "\n| mm/s | kHz | sets | level | error N p50 / p99 / max | largest step N | lost | fell "
                "through | stuck | CHAI3D 3.3 | HAPI 1.3 |\n|{}\n",
                " --- |" + repeat(" --- |", 10));
        else
            fmt::print("\n{:>6} {:>4} {:>14} {:>9}  {:<24} {:>7} {:>7} {:>5} {:>7} {:>5}  {}\n", "mm/s",
                       "kHz", "sets", "level", "error N p50 / p99 / max", "step N", "under", "lost",
                       "through", "stuck", "CHAI3D p50 / p99; HAPI");
    }
    void row(const study::PenetrationSurface& surface, const study::PenetrationOptions& options,
             const study::PenetrationResult& r) const
    {
        const double rate = options.path.rate_hz;
        const std::string sets =
            options.timely ? "every tick" : fmt::format("every {:g} ms", 1e3 * options.feed_every / rate);
        const std::string error =
            fmt::format("{:.4f} / {:.4f} / {:.4f}", r.error_p50, r.error_p99, r.error_max);
        const double speed = options.path.speed_mm_s, swing = speed * options.path.swing;
        const std::string mm_s = swing > 0 ? fmt::format("{:.0f}-{:.0f}", speed - swing, speed + swing)
                                           : fmt::format("{:g}", speed);
        const Peers* peers = options.timely && rate == 1000.0
                                 ? find(surface.frequencies()[0], options.path.speed_mm_s)
                                 : nullptr;
        if (markdown_)
            fmt::print("| {} | {:g} | {} | {} | {} | {:.3f} | {} | {} | {} | {} | {} |\n", mm_s, rate * 1e-3,
                       sets, levels(surface, r), error, r.step_max, r.lost, r.fell_through, r.stuck,
                       peers ? peers->chai3d : "", peers ? peers->hapi : "");
        else
            fmt::print("{:>6} {:4g} {:>14} {:>9}  {:<24} {:7.4f} {:7} {:5} {:7} {:5}  {}\n", mm_s,
                       rate * 1e-3, sets, levels(surface, r), error, r.step_max, r.under, r.lost,
                       r.fell_through, r.stuck,
                       peers && *peers->chai3d ? fmt::format("{}; {}", peers->chai3d, peers->hapi) : "");
        std::fflush(stdout);
    }

  private:
    static std::string repeat(const std::string& text, int times)
    {
        std::string out;
        for (int i = 0; i < times; ++i)
            out += text;
        return out;
    }
    static const Peers* find(unsigned frequency, double speed_mm_s)
    {
        for (const Peers& peers : all_peers)
            if (peers.frequency == frequency && peers.speed_mm_s == speed_mm_s)
                return &peers;
        return nullptr;
    }
    /// The levels that the ticks under the surface used, from the finest to the coarsest.
    static std::string levels(const study::PenetrationSurface& surface, const study::PenetrationResult& r)
    {
        unsigned first = 0, last = 0;
        for (std::size_t level = 0; level < r.level_ticks.size(); ++level) {
            if (r.level_ticks[level] == 0)
                continue;
            last = surface.frequencies()[level];
            first = first ? first : last;
        }
        return first == last ? fmt::format("f {}", first) : fmt::format("f {}-{}", first, last);
    }

    bool markdown_;
};

/// Sets for the tick that takes them at every rate; then late ones; then a hand that hurries and lingers.
std::vector<study::PenetrationOptions> cases(double seconds)
{
    std::vector<study::PenetrationOptions> all;
    const auto add = [&](double speed_mm_s, double rate_hz) -> study::PenetrationOptions& {
        study::PenetrationOptions& options = all.emplace_back();
        options.path.speed_mm_s = speed_mm_s;
        options.path.rate_hz = rate_hz;
        options.path.seconds = seconds;
        options.check_every = rate_hz > 2000 ? 16 : 4;
        return options;
    };
    for (const double rate_hz : {1000.0, 3000.0, 10000.0})
        for (const double speed_mm_s : speeds_mm_s)
            add(speed_mm_s, rate_hz);
    for (const double rate_hz : {1000.0, 3000.0}) {
        for (const double speed_mm_s : speeds_mm_s) {
            for (const std::uint32_t ms : {1U, 2U, 5U, 10U}) {
                study::PenetrationOptions& options = add(speed_mm_s, rate_hz);
                options.timely = false;
                options.feed_every = ms * static_cast<std::uint32_t>(rate_hz / 1000);
            }
        }
    }
    for (const std::uint32_t ms : {1U, 4U, 10U}) {
        study::PenetrationOptions& options = add(250, 1000);
        options.path.swing = 0.95;
        options.timely = false;
        options.feed_every = ms;
    }
    return all;
}

bool run_sphere(unsigned frequency, const Arguments& arguments)
{
    const std::vector<unsigned> chain(std::find(frequencies.begin(), frequencies.end(), frequency),
                                      frequencies.end());
    const auto surface = study::PenetrationSurface::build(chain);
    if (!surface) {
        std::fprintf(stderr, "penetration_bench: %s\n", surface.error().text().c_str());
        return false;
    }
    const Table table(arguments.markdown);
    table.begin(*surface);
    for (const study::PenetrationOptions& options : cases(arguments.seconds)) {
        const auto result = study::run_penetration(*surface, options);
        if (!result) {
            std::fprintf(stderr, "penetration_bench: %s\n", result.error().text().c_str());
            return false;
        }
        table.row(*surface, options, *result);
    }
    return true;
}

bool parse(int argc, char** argv, Arguments& out)
{
    for (int i = 1; i < argc; ++i) {
        const bool more = i + 1 < argc;
        if (std::strcmp(argv[i], "--markdown") == 0)
            out.markdown = true;
        else if (std::strcmp(argv[i], "--seconds") == 0 && more)
            out.seconds = std::atof(argv[++i]);
        else if (std::strcmp(argv[i], "--sphere") == 0 && more)
            out.sphere = static_cast<unsigned>(std::atoi(argv[++i]));
        else
            return false;
    }
    const bool known =
        out.sphere == 0 || std::find(spheres.begin(), spheres.end(), out.sphere) != spheres.end();
    return out.seconds > 0 && known;
}

} // namespace

int main(int argc, char** argv)
{
    Arguments arguments;
    if (!parse(argc, argv, arguments)) {
        std::fprintf(stderr, "usage: penetration_bench [--seconds S] [--sphere 32|100|316] [--markdown]\n");
        return 2;
    }
    for (const unsigned frequency : spheres)
        if (arguments.sphere == 0 || arguments.sphere == frequency)
            if (!run_sphere(frequency, arguments))
                return 1;
    return 0;
}
