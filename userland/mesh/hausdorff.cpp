// SPDX-License-Identifier: GPL-2.0-or-later
#include "mesh/hausdorff.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <mutex>
#include <vector>

#include "fdh/parallel.hpp"
#include "mesh/nearest_on_triangle.hpp"
#include "mesh/vector.hpp"

namespace phantom::mesh {

namespace {

using Corners = std::array<Vec3, 3>;

/// A first look goes at least that far, as a part of the other surface's size.
constexpr double first_look = 1e-3;

/// A little more, so that rounding leaves nothing out.
constexpr double slack = 1.001;

/// A face is cut into at most the square of that many parts.
constexpr double cuts_max = 64;

Corners corners_of(const Mesh& mesh, std::size_t face)
{
    const Triple& at = mesh.faces[face];
    return {mesh.vertices[at[0]], mesh.vertices[at[1]], mesh.vertices[at[2]]};
}

std::vector<std::uint32_t> used_vertices(const Mesh& mesh)
{
    std::vector<bool> used(mesh.vertices.size(), false);
    for (const Triple& face : mesh.faces)
        for (const std::uint32_t v : face)
            used[v] = true;
    std::vector<std::uint32_t> out;
    for (std::uint32_t v = 0; v < used.size(); ++v)
        if (used[v])
            out.push_back(v);
    return out;
}

class OneSided {
  public:
    OneSided(const Mesh& from, const Mesh& to, const fdh::TriangleTree<14>& tree, unsigned threads)
        : from_(from),
          to_(to),
          tree_(tree),
          threads_(fdh::thread_count(threads)),
          first_look_mm_(first_look * bounds_of(to.vertices).diagonal())
    {
    }

    double farthest(std::size_t samples) const
    {
        const std::vector<std::uint32_t> vertices = used_vertices(from_);
        const std::size_t faces = from_.faces.size(), elements = vertices.size() + faces;
        samples = std::max<std::size_t>(samples, 1);
        const std::size_t every = (elements + samples - 1) / samples;
        const double spare = static_cast<double>(samples > elements ? samples - vertices.size() : faces);
        const int cuts =
            static_cast<int>(std::clamp(std::sqrt(spare / static_cast<double>(faces)), 1.0, cuts_max));
        const double at_vertices = largest(vertices.size(), every, [&](std::size_t i, Walk& walk) {
            return distance_from(from_.vertices[vertices[i]], walk);
        });
        const double in_faces = largest(faces, every, [&](std::size_t i, Walk& walk) {
            return distance_of_parts(corners_of(from_, i), cuts, walk);
        });
        return std::max(at_vertices, in_faces);
    }

  private:
    /// One thread's samples: the next is not farther from the surface than the last one and the way between.
    struct Walk {
        fdh::Nearest found;
        Vec3 at{};
        double distance = 0; ///< of `at`
    };

    /// Of value(i, walk) for i = 0, every, 2 every ... < count.
    template <typename Value>
    double largest(std::size_t count, std::size_t every, const Value& value) const
    {
        double all = 0;
        std::mutex mutex;
        fdh::parallel_for(0, (count + every - 1) / every, threads_, [&](std::size_t begin, std::size_t end) {
            Walk walk;
            walk.at = to_.vertices[to_.faces[0][0]];
            double mine = 0;
            for (std::size_t i = begin; i < end; ++i)
                mine = std::max(mine, value(i * every, walk));
            const std::lock_guard lock(mutex);
            all = std::max(all, mine);
        });
        return all;
    }

    double distance_from(const Vec3& at, Walk& walk) const
    {
        const double most = slack * (walk.distance + distance(at, walk.at)) + first_look_mm_;
        const double look = std::min(most, std::max(first_look_mm_, 2.0 * walk.distance));
        walk.found.clear();
        tree_.nearest(at, 1, look, walk.found);
        if (walk.found.hits.empty())
            tree_.nearest(at, 1, most, walk.found);
        if (walk.found.hits.empty()) // beyond what the tree takes
            return std::numeric_limits<double>::infinity();
        walk.at = at;
        walk.distance = distance_to_triangle(at, corners_of(to_, walk.found.hits.front().triangle));
        return walk.distance;
    }

    /// From the centres of cuts^2 equal parts of a face.
    double distance_of_parts(const Corners& x, int cuts, Walk& walk) const
    {
        double farthest = 0;
        for (int i = 0; i < cuts; ++i) {
            for (int j = 0; i + j < cuts; ++j) {
                for (const int turned : {1, 2}) { // parts like the face, and those upside down between them
                    const double b = (i + turned / 3.0) / cuts, c = (j + turned / 3.0) / cuts;
                    if (turned == 2 && i + j + 2 > cuts)
                        continue;
                    const Vec3 at = add(add(scaled(x[0], 1.0 - b - c), scaled(x[1], b)), scaled(x[2], c));
                    farthest = std::max(farthest, distance_from(at, walk));
                }
            }
        }
        return farthest;
    }

    const Mesh& from_;
    const Mesh& to_;
    const fdh::TriangleTree<14>& tree_;
    unsigned threads_;
    double first_look_mm_;
};

} // namespace

double one_sided_hausdorff_mm(const Mesh& from, const Mesh& to, const fdh::TriangleTree<14>& to_tree,
                              std::size_t samples, unsigned threads)
{
    if (from.faces.empty())
        return 0;
    if (to.faces.empty())
        return std::numeric_limits<double>::infinity();
    return OneSided(from, to, to_tree, threads).farthest(samples);
}

} // namespace phantom::mesh
