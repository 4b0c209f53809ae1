// SPDX-License-Identifier: GPL-2.0-or-later
#include "mesh/simplify_chain.hpp"

#include <algorithm>
#include <cstddef>
#include <optional>
#include <utility>

#include "mesh/edge_collapse.hpp"
#include "mesh/hausdorff.hpp"
#include "mesh/two_sided.hpp"
#include "mesh/vector.hpp"

namespace phantom::mesh {

namespace {

/// A level has at most this part of the triangles of the one before,
constexpr double part_max = 0.75;
/// and at least that, however little error more would cost: its reach grows by no more than two.
constexpr double part_min = 0.25;

constexpr double error_factor = 2.0;

/// Of the mesh's longest side: no level is made with more quadric error than that.
constexpr double error_max = 0.05;

/// Samples of a surface's distance from another: for every face of the mesh, but not more than
constexpr std::size_t samples_per_face = 8, samples_max = 400'000;

double longest_edge_mm(const Mesh& mesh)
{
    double longest = 0;
    for (const Triple& face : mesh.faces)
        for (std::size_t i = 0; i < 3; ++i)
            longest = std::max(longest, distance(mesh.vertices[face[i]], mesh.vertices[face[(i + 1) % 3]]));
    return longest;
}

/// Whether it is as make_two_sided() leaves it: the second half of the faces are backs of the first.
bool has_backs(const Mesh& mesh)
{
    const std::size_t fronts = mesh.faces.size() / 2;
    for (std::size_t f = 0; f < fronts; ++f) {
        const Triple &front = mesh.faces[f], &back = mesh.faces[fronts + f];
        if (back != Triple{front[0], front[2], front[1]})
            return false;
    }
    return mesh.faces.size() % 2 == 0;
}

class Chain {
  public:
    Chain(const Mesh& mesh, const fdh::TriangleTree<14>& tree, const ChainOptions& options)
        : mesh_(mesh),
          tree_(tree),
          options_(options),
          has_backs_(has_backs(mesh)),
          collapse_(
              wedges_of(mesh, has_backs_ ? mesh.faces.size() / 2 : mesh.faces.size(), options.crease_deg),
              options.threads),
          error_max_mm_(error_max * bounds_of(mesh.vertices).extent())
    {
    }

    /// Nothing at the end of the chain.
    std::optional<ChainLevel> next()
    {
        if (cancelled() || !collapse() || cancelled())
            return std::nullopt;
        Mesh mesh = mesh_of(collapse_.wedges());
        if (longest_edge_mm(mesh) > options_.edge_max_mm || (has_backs_ && !make_two_sided(mesh)))
            return std::nullopt;
        auto tree = fdh::TriangleTree<14>::build({mesh.vertices, mesh.faces}, {.threads = options_.threads});
        if (cancelled())
            return std::nullopt;
        const std::size_t samples = std::min(samples_max, samples_per_face * mesh_.faces.size());
        // Never less than that of a finer level: the order of the levels is that of their errors.
        error_mm_ =
            std::max({error_mm_, one_sided_hausdorff_mm(mesh, mesh_, tree_, samples, options_.threads),
                      one_sided_hausdorff_mm(mesh_, mesh, tree, samples, options_.threads)});
        return ChainLevel{std::move(mesh), std::move(tree), error_mm_};
    }

  private:
    [[nodiscard]] bool cancelled() const { return options_.cancelled && options_.cancelled(); }

    /// False when there is not enough to be left out.
    bool collapse()
    {
        const double faces = static_cast<double>(collapse_.wedges().faces.size());
        const auto few = [&] {
            return static_cast<double>(collapse_.wedges().faces.size()) <= part_max * faces;
        };
        if (quadric_mm_ == 0) {
            const std::optional<double> median = collapse_.median_error_mm();
            if (!median)
                return false;
            quadric_mm_ = *median;
        } else {
            quadric_mm_ *= error_factor;
        }
        for (;; quadric_mm_ *= error_factor) {
            collapse_.run(std::min(quadric_mm_, error_max_mm_), static_cast<std::size_t>(part_min * faces));
            if (few() || quadric_mm_ >= error_max_mm_ || cancelled())
                return few();
        }
    }

    const Mesh& mesh_;
    const fdh::TriangleTree<14>& tree_;
    const ChainOptions& options_;
    bool has_backs_;
    EdgeCollapse collapse_;
    double error_max_mm_;
    double quadric_mm_ = 0; ///< of the last level
    double error_mm_ = 0;   ///< Hausdorff distance of the last level
};

} // namespace

std::vector<ChainLevel> simplify_chain(const Mesh& mesh, const fdh::TriangleTree<14>& tree,
                                       const ChainOptions& options)
{
    std::vector<ChainLevel> levels;
    if (mesh.faces.empty())
        return levels;
    Chain chain(mesh, tree, options);
    while (levels.size() < options.levels_max) {
        std::optional<ChainLevel> level = chain.next();
        if (!level)
            break;
        levels.push_back(std::move(*level));
        if (options.enough(levels.back()))
            break;
    }
    return levels;
}

} // namespace phantom::mesh
