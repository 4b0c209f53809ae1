// SPDX-License-Identifier: GPL-2.0-or-later
#include "study/peers/measure.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <numeric>
#include <random>
#include <span>
#include <thread>

#include "study/peers/agreement.hpp"
#include "study/peers/hulls.hpp"
#include "study/peers/stopwatch.hpp"

namespace phantom::peers {

namespace {

/// Point-triangle distances that brute force may spend on one mesh.
constexpr std::size_t brute_force_budget = 100'000'000;
constexpr std::size_t most_brute_force = 50;
/// However slow a contender is, so many of its queries are looked at.
constexpr std::size_t fewest_queries = 4;
/// Refits of one contender on a mesh, and how far they move it, in parts of the diagonal.
constexpr std::size_t refits = 5;
constexpr double wave_part = 1e-3;
constexpr double absent = std::numeric_limits<double>::quiet_NaN();

/// Of one contender on one path.
struct Samples {
    std::vector<double> ns;
    double spent_ns = 0; ///< with what is not timed
    double leaves = 0;   ///< all together
};

class Run {
  public:
    Run(const Mesh& mesh, Field field, const MeasureOptions& options)
        : mesh_(mesh), options_(options), field_(std::move(field)), random_(7)
    {
        result_.mesh = mesh.name;
        result_.triangles = mesh.triangles.size();
        result_.absent = field_.absent;
        result_.threads = std::max(1U, std::thread::hardware_concurrency());
        for (const auto& contender : field_.contenders)
            result_.figures.push_back({.name = contender->name(), .method = contender->method()});
    }

    Result<MeshFigures> run()
    {
        say("paths");
        work_ = make_workload(mesh_, options_.rounds, options_.lead_in + options_.block);
        result_.radius_mm = work_.radius;
        build_all();
        say("checking");
        for (const auto* path : {&work_.walk, &work_.jump})
            if (Status status = check(*path); !status)
                return status.error();
        if (Status status = time_path(work_.walk, "walk", &Figures::walk); !status)
            return status.error();
        if (Status status = time_path(work_.jump, "jump", &Figures::jump); !status)
            return status.error();
        if (Status status = refit_all(); !status)
            return status.error();
        return std::move(result_);
    }

  private:
    void say(const std::string& what) const
    {
        if (options_.progress)
            options_.progress(what);
    }

    std::vector<std::size_t> shuffled()
    {
        std::vector<std::size_t> order(field_.contenders.size());
        std::iota(order.begin(), order.end(), 0);
        std::shuffle(order.begin(), order.end(), random_);
        return order;
    }

    /// Million triangles a second that `work` handles: per second of computing on one thread, of the clock on
    /// several.
    double rate(unsigned threads, const std::function<void()>& work)
    {
        const double cpu_begin = cpu_ns();
        const std::uint64_t begin = Stopwatch::now();
        work();
        const double clock = watch_.ns(begin, Stopwatch::now());
        const double ns = threads == 1 ? cpu_ns() - cpu_begin : clock;
        return 1e3 * static_cast<double>(mesh_.triangles.size()) / std::max(1.0, ns);
    }

    double build(std::size_t who, unsigned threads)
    {
        Contender& contender = *field_.contenders[who];
        contender.prepare(mesh_);
        return rate(threads, [&] { contender.build(threads); });
    }

    /// What takes over another's tree is built after all others, once.
    void build_all()
    {
        say("building");
        std::vector<double> spent(field_.contenders.size(), 0);
        for (std::size_t round = 0; round < options_.most_builds; ++round) {
            for (const std::size_t who : shuffled()) {
                const Contender& contender = *field_.contenders[who];
                Figures& figures = result_.figures[who];
                const bool compared = figures.name == own_name || figures.name == yardstick;
                const bool enough =
                    round >= (compared ? options_.fewest_builds : 1) && spent[who] > options_.build_seconds;
                if (!contender.builds() || enough)
                    continue;
                const std::uint64_t begin = Stopwatch::now();
                figures.build_one.push_back(build(who, 1));
                if (contender.builds_parallel())
                    figures.build_all.push_back(build(who, result_.threads));
                const double seconds = 1e-9 * watch_.ns(begin, Stopwatch::now());
                spent[who] += seconds * static_cast<double>(field_.contenders.size());
            }
        }
        for (std::size_t who = 0; who < field_.contenders.size(); ++who)
            if (!field_.contenders[who]->builds())
                build(who, 1);
        for (std::size_t who = 0; who < field_.contenders.size(); ++who)
            result_.figures[who].bytes_per_triangle = static_cast<double>(field_.contenders[who]->bytes()) /
                                                      static_cast<double>(mesh_.triangles.size());
    }

    Status compare(std::size_t who, const std::vector<double>& expected, const fdh::Point& p) const
    {
        std::vector<double> answer;
        field_.contenders[who]->distances(answer);
        return compare(who, std::move(answer), expected, p);
    }
    Status compare(std::size_t who, std::vector<double> answer, const std::vector<double>& expected,
                   const fdh::Point& p) const
    {
        const auto wrong = disagreement(std::move(answer), expected, work_.radius, tolerance());
        if (!wrong)
            return success();
        return Error{mesh_.name,
                     fmt::format("{} is wrong at ({:.9g}, {:.9g}, {:.9g}), radius {:.9g}: {}",
                                 result_.figures[who].name, p[0], p[1], p[2], work_.radius, *wrong)};
    }

    /// Our first contender against every triangle one by one, all others against it.
    Status check(const std::vector<fdh::Point>& path)
    {
        const std::size_t points = std::min(options_.checked, path.size());
        const std::size_t by_hand =
            std::clamp(brute_force_budget / mesh_.triangles.size(), std::size_t{1}, most_brute_force);
        std::vector<double> spent_ns(field_.contenders.size(), 0), expected;
        for (std::size_t i = 0; i < points; ++i) {
            const fdh::Point& p = path[i];
            for (std::size_t who = 0; who < field_.contenders.size(); ++who) {
                if (i >= fewest_queries && spent_ns[who] > 1e9 * options_.check_seconds)
                    continue;
                const std::uint64_t begin = Stopwatch::now();
                field_.contenders[who]->query(p, work_.radius);
                spent_ns[who] += watch_.ns(begin, Stopwatch::now());
                if (who == 0) {
                    field_.contenders[who]->distances(expected);
                    if (i % (1 + points / by_hand) != 0)
                        continue;
                }
                if (Status status =
                        compare(who, who == 0 ? brute_force(mesh_, p, work_.radius) : expected, p);
                    !status)
                    return status;
            }
        }
        return success();
    }

    Status time_path(const std::vector<fdh::Point>& path, const char* name, PathTimes Figures::*times)
    {
        say(name);
        std::vector<Samples> samples(field_.contenders.size());
        std::vector<double> expected;
        for (std::size_t round = 0; round < options_.rounds; ++round) {
            const std::span<const fdh::Point> stroke(
                path.data() + round * (options_.lead_in + options_.block), options_.lead_in + options_.block);
            for (const std::size_t who : shuffled()) {
                PathTimes& to = result_.figures[who].*times;
                study::Distribution block{.median = absent, .p99 = absent};
                if (round == 0 || samples[who].spent_ns < 1e9 * options_.path_seconds) {
                    const fdh::Point& last = time_block(who, stroke, samples[who], block);
                    std::vector<double> answer;
                    field_.contenders[who]->distances(answer);
                    field_.contenders[0]->query(last, work_.radius);
                    field_.contenders[0]->distances(expected);
                    if (Status status = compare(who, std::move(answer), expected, last); !status)
                        return status;
                }
                to.median_ns.push_back(block.median);
                to.p99_ns.push_back(block.p99);
            }
        }
        for (std::size_t who = 0; who < field_.contenders.size(); ++who) {
            PathTimes& to = result_.figures[who].*times;
            if (field_.contenders[who]->leaves())
                to.leaves = samples[who].leaves / static_cast<double>(samples[who].ns.size());
            to.all_ns = study::Distribution::of(std::move(samples[who].ns));
        }
        return success();
    }

    /// Returns the point of the last query.
    const fdh::Point& time_block(std::size_t who, std::span<const fdh::Point> stroke, Samples& samples,
                                 study::Distribution& block)
    {
        Contender& contender = *field_.contenders[who];
        for (const fdh::Point& p : stroke.first(options_.lead_in)) {
            if (samples.spent_ns > 1e9 * options_.path_seconds)
                break;
            const std::uint64_t begin = Stopwatch::now();
            contender.query(p, work_.radius);
            samples.spent_ns += watch_.ns(begin, Stopwatch::now());
        }
        std::vector<double> ns;
        ns.reserve(options_.block);
        const fdh::Point* last = nullptr;
        for (const fdh::Point& p : stroke.subspan(options_.lead_in)) {
            if (ns.size() >= fewest_queries && samples.spent_ns > 1e9 * options_.path_seconds)
                break;
            const std::uint64_t begin = Stopwatch::now();
            contender.query(p, work_.radius);
            ns.push_back(watch_.ns(begin, Stopwatch::now()));
            samples.spent_ns += ns.back();
            samples.leaves += contender.leaves().value_or(0);
            last = &p;
        }
        samples.ns.insert(samples.ns.end(), ns.begin(), ns.end());
        block = study::Distribution::of(std::move(ns));
        return *last;
    }

    Status refit_all()
    {
        const auto can = [](const auto& one) { return one->refits(); };
        if (std::ranges::none_of(field_.contenders, can))
            return success();
        say("refitting");
        for (const auto& contender : field_.contenders)
            if (!contender->refits())
                contender->prepare(mesh_); // gives back what it has built
        const Mesh moved = waved(mesh_, wave_part * mesh_.diagonal);
        for (std::size_t who = 0; who < field_.contenders.size(); ++who) {
            Contender& contender = *field_.contenders[who];
            if (!contender.refits())
                continue;
            refit(contender, moved, 1, result_.figures[who].refit_one);
            if (contender.refits_parallel())
                refit(contender, moved, result_.threads, result_.figures[who].refit_all);
        }
        return check_refits(moved);
    }

    void refit(Contender& contender, const Mesh& moved, unsigned threads, std::vector<double>& rates)
    {
        contender.prepare_refit(moved, threads);
        for (std::size_t i = 0; i < refits; ++i)
            rates.push_back(rate(threads, [&] { contender.refit(); }));
    }

    Status check_refits(const Mesh& moved)
    {
        for (std::size_t i = 0; i < fewest_queries; ++i) {
            const fdh::Point& p = moved.vertices[random_() % moved.vertices.size()];
            const std::vector<double> expected = brute_force(moved, p, work_.radius);
            for (std::size_t who = 0; who < field_.contenders.size(); ++who) {
                if (!field_.contenders[who]->refits())
                    continue;
                field_.contenders[who]->query(p, work_.radius);
                if (Status status = compare(who, expected, p); !status)
                    return status;
            }
        }
        return success();
    }

    [[nodiscard]] double tolerance() const { return tolerance_mm(work_.accuracy, work_.radius); }

    const Mesh& mesh_;
    const MeasureOptions& options_;
    Field field_;
    std::mt19937_64 random_;
    Stopwatch watch_;
    Workload work_;
    MeshFigures result_;
};

} // namespace

const Figures* MeshFigures::of(const std::string& name) const
{
    const auto found = std::find_if(figures.begin(), figures.end(),
                                    [&name](const Figures& one) { return one.name == name; });
    return found == figures.end() ? nullptr : &*found;
}

std::optional<double> median(std::vector<double> samples)
{
    if (samples.empty())
        return std::nullopt;
    return study::Distribution::of(std::move(samples)).median;
}

std::optional<double> ratio(const std::vector<double>& a, const std::vector<double>& b)
{
    std::vector<double> ratios;
    for (std::size_t i = 0; i < std::min(a.size(), b.size()); ++i)
        if (std::isfinite(a[i]) && b[i] > 0)
            ratios.push_back(a[i] / b[i]);
    return median(std::move(ratios));
}

Result<MeshFigures> measure(const Mesh& mesh, Field field, const MeasureOptions& options)
{
    return Run(mesh, std::move(field), options).run();
}

} // namespace phantom::peers
