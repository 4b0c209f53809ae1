// SPDX-License-Identifier: GPL-2.0-or-later
// Longest-edge bisection (Rivara 1984). The longest edge of the whole mesh is cut first, in every
// face that has it, so no face keeps an edge whose neighbour was cut: no T-junction. In each of these
// faces it is the longest edge too, so the new edge from the midpoint is at most sqrt(3)/2 of it: it ends.
#include <queue>
#include <unordered_map>

#include <fmt/format.h>

#include "mesh/edge_index.hpp"
#include "mesh/steps.hpp"
#include "mesh/vector.hpp"

namespace phantom::mesh {

namespace {

constexpr std::size_t faces_max = 20'000'000; ///< about 2 GB while splitting

std::uint64_t edge_key(std::uint32_t a, std::uint32_t b)
{
    return static_cast<std::uint64_t>(std::min(a, b)) << 32 | std::max(a, b);
}

class Bisection {
  public:
    Bisection(Soup& soup, double split_mm)
        : soup_(soup), split_mm_(split_mm), with_normals_(!soup.face_normals.empty())
    {
        root_.resize(soup.faces.size());
        for (std::uint32_t f = 0; f < root_.size(); ++f) {
            root_[f] = f;
            for (std::uint32_t i = 0; i < 3; ++i)
                attach(soup.faces[f][i], soup.faces[f][(i + 1) % 3], f);
        }
    }

    /// False when there would be too many faces.
    bool run()
    {
        while (!queue_.empty()) {
            const Edge edge = queue_.top();
            queue_.pop();
            const auto found = faces_of_.find(edge_key(edge.low, edge.high));
            const std::vector<std::uint32_t> faces = std::move(found->second);
            faces_of_.erase(found);
            const auto middle = static_cast<std::uint32_t>(soup_.vertices.size());
            soup_.vertices.push_back(scaled(add(soup_.vertices[edge.low], soup_.vertices[edge.high]), 0.5));
            for (const std::uint32_t face : faces)
                bisect(face, edge, middle);
            if (soup_.faces.size() > faces_max)
                return false;
        }
        sort_by_root();
        return true;
    }

  private:
    struct Edge {
        double size;
        std::uint32_t low, high;
        bool operator<(const Edge& other) const
        {
            if (size != other.size)
                return size < other.size;
            return edge_key(low, high) > edge_key(other.low, other.high); // any fixed order
        }
    };

    /// Notes that the face has this edge; only edges to be cut are kept.
    void attach(std::uint32_t a, std::uint32_t b, std::uint32_t face)
    {
        const double size = distance(soup_.vertices[a], soup_.vertices[b]);
        if (size <= split_mm_)
            return;
        std::vector<std::uint32_t>& faces = faces_of_[edge_key(a, b)];
        if (faces.empty())
            queue_.push({size, std::min(a, b), std::max(a, b)});
        faces.push_back(face);
    }

    void replace(std::uint32_t a, std::uint32_t b, std::uint32_t face, std::uint32_t by)
    {
        const auto found = faces_of_.find(edge_key(a, b));
        if (found != faces_of_.end())
            std::replace(found->second.begin(), found->second.end(), face, by);
    }

    /// (a, b, c) becomes (a, m, c) in place and (m, b, c) at the end, where a-b is the edge.
    void bisect(std::uint32_t face, const Edge& edge, std::uint32_t middle)
    {
        const Triple old = soup_.faces[face];
        std::uint32_t i = 0;
        while (edge_key(old[i], old[(i + 1) % 3]) != edge_key(edge.low, edge.high))
            ++i;
        const std::uint32_t j = (i + 1) % 3, k = (i + 2) % 3;
        const auto child = static_cast<std::uint32_t>(soup_.faces.size());
        Triple second = old;
        second[i] = middle;
        soup_.faces.push_back(second);
        soup_.faces[face][j] = middle;
        root_.push_back(root_[face]);
        if (with_normals_)
            bisect_normals(face, i, j);
        replace(old[j], old[k], face, child);
        attach(old[i], middle, face);
        attach(middle, old[j], child);
        attach(middle, old[k], face);
        attach(middle, old[k], child);
    }

    void bisect_normals(std::uint32_t face, std::uint32_t i, std::uint32_t j)
    {
        const Triple old = soup_.face_normals[face];
        const auto number = static_cast<std::uint32_t>(soup_.normals.size());
        soup_.normals.push_back(normalized(add(soup_.normals[old[i]], soup_.normals[old[j]])));
        Triple second = old;
        second[i] = number;
        soup_.face_normals.push_back(second);
        soup_.face_normals[face][j] = number;
    }

    /// Puts children where their parent was (counting sort, stable).
    void sort_by_root()
    {
        const std::size_t faces = soup_.faces.size();
        std::vector<std::uint32_t> next(faces + 1, 0);
        for (const std::uint32_t root : root_)
            ++next[root + 1];
        for (std::size_t f = 0; f < faces; ++f)
            next[f + 1] += next[f];
        std::vector<Triple> sorted(faces), sorted_normals(with_normals_ ? faces : 0);
        std::vector<std::uint32_t> smoothing(soup_.smoothing.empty() ? 0 : faces);
        std::vector<std::uint8_t> groups(soup_.face_groups.empty() ? 0 : faces);
        for (std::size_t f = 0; f < faces; ++f) {
            const std::uint32_t to = next[root_[f]]++;
            sorted[to] = soup_.faces[f];
            if (with_normals_)
                sorted_normals[to] = soup_.face_normals[f];
            if (!smoothing.empty())
                smoothing[to] = soup_.smoothing[root_[f]];
            if (!groups.empty())
                groups[to] = soup_.face_groups[root_[f]];
        }
        soup_.smoothing = std::move(smoothing);
        soup_.face_groups = std::move(groups);
        soup_.faces = std::move(sorted);
        soup_.face_normals = std::move(sorted_normals);
    }

    Soup& soup_;
    double split_mm_;
    bool with_normals_;
    std::vector<std::uint32_t> root_; ///< per face: the face of the input that it is part of
    std::unordered_map<std::uint64_t, std::vector<std::uint32_t>> faces_of_;
    std::priority_queue<Edge> queue_;
};

/// A triangle with no side over s has an area of at most sqrt(3)/4 s^2: so many faces there will be at least.
double least_faces(const Soup& soup, double split_mm)
{
    double area = 0;
    for (const Triple& face : soup.faces) {
        const Vec3 a = subtract(soup.vertices[face[1]], soup.vertices[face[0]]);
        const Vec3 b = subtract(soup.vertices[face[2]], soup.vertices[face[0]]);
        area += 0.5 * length(cross(a, b));
    }
    return area / (0.4330127018922193 * split_mm * split_mm);
}

} // namespace

Status split_long_edges(Soup& soup, double split_mm, const std::string& name, Report& report)
{
    const std::size_t before = soup.faces.size();
    const Error too_many{
        name, fmt::format("splitting edges over {:g} mm gives more than {} faces", split_mm, faces_max),
        "a larger --split, or --unit if the size is wrong"};
    if (least_faces(soup, split_mm) > static_cast<double>(faces_max))
        return too_many;
    if (!Bisection(soup, split_mm).run())
        return too_many;
    report.faces_split = soup.faces.size() - before;
    return success();
}

} // namespace phantom::mesh
