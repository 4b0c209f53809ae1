// SPDX-License-Identifier: GPL-2.0-or-later
// One interleaved run over a mesh: everyone in turn, in an order that changes, on the same paths. On a
// machine that others use too, times drift and ratios taken within a round hold.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "base/result.hpp"
#include "study/distribution.hpp"
#include "study/peers/contenders.hpp"
#include "study/peers/workload.hpp"

namespace phantom::peers {

struct MeasureOptions {
    std::size_t rounds = 60;     ///< per path
    std::size_t block = 200;     ///< queries of one contender in a row
    std::size_t lead_in = 16;    ///< queries before them that are not timed: they fetch the upper tree again
    std::size_t checked = 400;   ///< queries per path whose answers are compared before anything is timed
    double path_seconds = 5;     ///< a contender that is too slow for all rounds takes part in fewer
    double check_seconds = 1;    ///< and is checked in fewer queries
    double build_seconds = 12;   ///< about so long everyone's building is repeated, once at least
    std::size_t most_builds = 7; ///< and not oftener; ours and the yardstick's at least
    std::size_t fewest_builds = 2;
    std::function<void(const std::string&)> progress{};
};

/// One contender on one path.
struct PathTimes {
    study::Distribution all_ns;            ///< of every query
    std::vector<double> median_ns, p99_ns; ///< of each round's block
    std::optional<double> leaves;          ///< mean per query
};

/// One contender on one mesh. Rates [million triangles a second] by round, so that ratios can be taken within
/// one; empty: not measured.
struct Figures {
    std::string name{}, method{};
    std::vector<double> build_one{}, build_all{}; ///< on one thread, on all
    std::vector<double> refit_one{}, refit_all{};
    double bytes_per_triangle = 0;
    PathTimes walk{}, jump{};
};

struct MeshFigures {
    std::string mesh;
    std::size_t triangles = 0;
    double radius_mm = 0;
    unsigned threads = 1; ///< "all"
    std::vector<Figures> figures;
    std::vector<Absent> absent;

    [[nodiscard]] const Figures* of(const std::string& name) const;
};

/// Median over the rounds of a[i] / b[i] in which both took part; nothing if there are none.
std::optional<double> ratio(const std::vector<double>& a, const std::vector<double>& b);
/// Nothing if empty.
std::optional<double> median(std::vector<double> samples);

/// The error names the contender whose answer is wrong, and the query. Whoever is in the field is measured;
/// the first is the one whose answers are held against brute force, and all others' against.
Result<MeshFigures> measure(const Mesh& mesh, Field field, const MeasureOptions& options);

} // namespace phantom::peers
