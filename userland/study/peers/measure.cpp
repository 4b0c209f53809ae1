// SPDX-License-Identifier: GPL-2.0-or-later
#include "study/peers/measure.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <numeric>
#include <random>
#include <thread>

#include "study/peers/agreement.hpp"
#include "study/peers/stopwatch.hpp"

namespace phantom::peers {

namespace {

/// Point-triangle distances that brute force may spend on one mesh.
constexpr std::size_t brute_force_budget = 100'000'000;
constexpr std::size_t most_brute_force = 50;

class Run {
  public:
    Run(const Mesh& mesh, const MeasureOptions& options)
        : mesh_(mesh), options_(options), field_(field_for(mesh)), random_(7)
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
        for (const auto* path : {&work_.walk, &work_.jump})
            if (Status status = check(*path); !status)
                return status.error();
        if (Status status = time_path(work_.walk, "walk", &Figures::walk); !status)
            return status.error();
        if (Status status = time_path(work_.jump, "jump", &Figures::jump); !status)
            return status.error();
        refit_all();
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

    /// Million triangles a second.
    [[nodiscard]] double rate(std::uint64_t begin, std::uint64_t end)
    {
        return 1e3 * static_cast<double>(mesh_.triangles.size()) / std::max(1.0, watch_.ns(begin, end));
    }

    double build(std::size_t who, unsigned threads)
    {
        Contender& contender = *field_.contenders[who];
        contender.prepare(mesh_);
        const std::uint64_t begin = Stopwatch::now();
        contender.build(threads);
        return rate(begin, Stopwatch::now());
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
                if (!contender.builds() || (round > 0 && spent[who] > options_.build_seconds))
                    continue;
                const std::uint64_t begin = Stopwatch::now();
                figures.build_one_mtri_s.push_back(build(who, 1));
                if (contender.builds_parallel())
                    figures.build_all_mtri_s.push_back(build(who, result_.threads));
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
        say("checking");
        const std::size_t by_hand =
            std::clamp(brute_force_budget / mesh_.triangles.size(), std::size_t{1}, most_brute_force);
        const std::size_t points = std::min(options_.checked, path.size());
        for (std::size_t i = 0; i < points; ++i) {
            const fdh::Point& p = path[i];
            std::vector<double> expected;
            for (std::size_t who = 0; who < field_.contenders.size(); ++who) {
                field_.contenders[who]->query(p, work_.radius);
                if (who == 0) {
                    field_.contenders[who]->distances(expected);
                    if (i % (1 + points / by_hand) == 0)
                        if (Status status = compare(who, brute_force(mesh_, p, work_.radius), p); !status)
                            return status;
                } else if (Status status = compare(who, expected, p); !status) {
                    return status;
                }
            }
        }
        return success();
    }

    Status time_path(const std::vector<fdh::Point>& path, const char* name, PathTimes Figures::*times)
    {
        say(name);
        std::vector<std::vector<double>> all_ns(field_.contenders.size());
        std::vector<double> leaves(field_.contenders.size(), 0), expected;
        for (std::size_t round = 0; round < options_.rounds; ++round) {
            const fdh::Point* stroke = path.data() + round * (options_.lead_in + options_.block);
            const fdh::Point& last = stroke[options_.lead_in + options_.block - 1];
            field_.contenders[0]->query(last, work_.radius);
            field_.contenders[0]->distances(expected);
            for (const std::size_t who : shuffled()) {
                const study::Distribution block = time_block(who, stroke, all_ns[who], leaves[who]);
                PathTimes& to = result_.figures[who].*times;
                to.median_ns.push_back(block.median);
                to.p99_ns.push_back(block.p99);
                if (Status status = compare(who, expected, last); !status)
                    return status;
            }
        }
        for (std::size_t who = 0; who < field_.contenders.size(); ++who) {
            PathTimes& to = result_.figures[who].*times;
            if (field_.contenders[who]->leaves())
                to.leaves = leaves[who] / static_cast<double>(all_ns[who].size());
            to.all_ns = study::Distribution::of(std::move(all_ns[who]));
        }
        return success();
    }

    study::Distribution time_block(std::size_t who, const fdh::Point* stroke, std::vector<double>& all_ns,
                                   double& leaves)
    {
        Contender& contender = *field_.contenders[who];
        for (std::size_t i = 0; i < options_.lead_in; ++i)
            contender.query(stroke[i], work_.radius);
        std::vector<double> ns;
        ns.reserve(options_.block);
        for (std::size_t i = options_.lead_in; i < options_.lead_in + options_.block; ++i) {
            const std::uint64_t begin = Stopwatch::now();
            contender.query(stroke[i], work_.radius);
            ns.push_back(watch_.ns(begin, Stopwatch::now()));
            leaves += contender.leaves().value_or(0);
        }
        all_ns.insert(all_ns.end(), ns.begin(), ns.end());
        return study::Distribution::of(std::move(ns));
    }

    void refit_all()
    {
        say("refitting");
        const Mesh moved = waved(mesh_, 1e-3 * mesh_.diagonal);
        for (std::size_t round = 0; round < options_.most_builds; ++round) {
            for (const std::size_t who : shuffled()) {
                Contender& contender = *field_.contenders[who];
                if (!contender.refits())
                    continue;
                if (round == 0)
                    contender.prepare_refit(moved);
                const std::uint64_t begin = Stopwatch::now();
                contender.refit(1);
                result_.figures[who].refit_mtri_s.push_back(rate(begin, Stopwatch::now()));
            }
        }
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
        if (b[i] > 0)
            ratios.push_back(a[i] / b[i]);
    return median(std::move(ratios));
}

Result<MeshFigures> measure(const Mesh& mesh, const MeasureOptions& options)
{
    return Run(mesh, options).run();
}

} // namespace phantom::peers
