// SPDX-License-Identifier: GPL-2.0-or-later
// A superquadric with exponents up to 2 is the unit ball of a norm N (a p-norm of p-norms): convex, and every
// ray from the middle meets it once. An octahedron is refined by bisecting longest edges (Rivara 1984), each
// new corner moved outward along its ray, until every face is near enough.
//
// How near, without sampling: N is convex and homogeneous, so N(q) >= grad N(x) . q at every corner x. With
// G_ij = grad N(x_i) . x_j and q = sum b_j x_j, N(q) >= max_i (G b)_i >= min_j (w G)_j for all weights w >= 0
// of sum 1. The best of these, beta, bounds the distance along the ray through q by |q| (1 / beta - 1).
#include <algorithm>
#include <cmath>
#include <unordered_map>

#include "mesh/vector.hpp"
#include "scene/shapes/soup_builder.hpp"

namespace phantom::scene {

namespace {

using mesh::Triple;
using mesh::Vec3;

/// Work that will end in too many triangles is not begun when so many times too many are expected.
constexpr double early_factor = 10;

/// cos of the angle between a face and the normals at its corners; none may be wider, or the shell over the
/// face would be thin. Edges of an octahedron need 0.58.
constexpr double normal_cosine = 0.3;

/// Of the longest half axis: faces smaller than this are not refined for the sake of their normals.
constexpr double smallest = 1e-4;

class Norm {
  public:
    explicit Norm(const Superquadric& s) : p_(2 / s.north_south), q_(2 / s.east_west) {}

    [[nodiscard]] double of(const Vec3& x) const
    {
        return p_norm(p_, p_norm(q_, std::abs(x[0]), std::abs(x[1])), std::abs(x[2]));
    }
    /// At a point of norm 1.
    [[nodiscard]] Vec3 gradient(const Vec3& x) const
    {
        const double flat = p_norm(q_, std::abs(x[0]), std::abs(x[1]));
        const double by_flat = std::pow(flat, p_ - 1);
        const auto part = [&](double c) {
            return flat > 0 ? std::copysign(by_flat * std::pow(std::abs(c) / flat, q_ - 1), c) : 0.0;
        };
        return {part(x[0]), part(x[1]), std::copysign(std::pow(std::abs(x[2]), p_ - 1), x[2])};
    }

  private:
    static double p_norm(double p, double a, double b)
    {
        const double larger = std::max(a, b);
        if (larger == 0)
            return 0;
        return larger * std::pow(std::pow(a / larger, p) + std::pow(b / larger, p), 1 / p);
    }
    double p_, q_;
};

/// The largest min_j (w G)_j found.
double game_value(const std::array<Vec3, 3>& g)
{
    const auto value = [&g](const Vec3& w) {
        double least = INFINITY;
        for (std::size_t j = 0; j < 3; ++j)
            least = std::min(least, w[0] * g[0][j] + w[1] * g[1][j] + w[2] * g[2][j]);
        return least;
    };
    double best = value({1.0 / 3, 1.0 / 3, 1.0 / 3});
    // The weights that make all three equal: w G = (v, v, v), the optimum where none is negative.
    const Vec3 c0{g[0][0], g[1][0], g[2][0]}, c1{g[0][1], g[1][1], g[2][1]}, c2{g[0][2], g[1][2], g[2][2]};
    const Vec3 w = mesh::add(mesh::add(mesh::cross(c1, c2), mesh::cross(c2, c0)), mesh::cross(c0, c1));
    const double sum = w[0] + w[1] + w[2];
    if (sum != 0 && w[0] / sum >= 0 && w[1] / sum >= 0 && w[2] / sum >= 0)
        best = std::max(best, value(mesh::scaled(w, 1 / sum)));
    for (std::size_t i = 0; i < 3; ++i) {
        Vec3 pair{0.5, 0.5, 0.5};
        pair[i] = 0;
        best = std::max(best, value(pair));
    }
    return best;
}

class Refinement {
  public:
    Refinement(const Superquadric& s, double chord_mm)
        : norm_(s), axes_(mesh::scaled(s.size_mm, 0.5)), chord_mm_(chord_mm)
    {
        for (const Vec3& x :
             {Vec3{1, 0, 0}, Vec3{0, 1, 0}, Vec3{-1, 0, 0}, Vec3{0, -1, 0}, Vec3{0, 0, 1}, Vec3{0, 0, -1}})
            add(x);
        for (std::uint32_t i = 0; i < 4; ++i) {
            faces_.push_back(ordered({i, (i + 1) % 4, 4}));
            faces_.push_back(ordered({(i + 1) % 4, i, 5}));
        }
    }

    Status run()
    {
        while (mark_far_faces()) {
            spread_marks();
            bisect_marked();
            // The first faces are too coarse to tell from them how many there will be.
            const bool telling = faces_.size() > 1000 && expected_ > early_factor * shape_triangles_max;
            const double count = telling ? expected_ : static_cast<double>(faces_.size());
            if (Status status = check_count(count, chord_mm_); !status)
                return status;
        }
        return success();
    }

    mesh::Soup take()
    {
        mesh::Soup soup;
        for (std::size_t i = 0; i < unit_.size(); ++i) {
            soup.vertices.push_back(in_mm(unit_[i]));
            soup.normals.push_back(normals_[i]);
        }
        soup.faces = faces_;
        soup.face_normals = std::move(faces_);
        return soup;
    }

  private:
    struct Edge {
        std::uint32_t low, high;
        bool operator==(const Edge&) const = default;
    };
    struct EdgeHash {
        std::size_t operator()(const Edge& e) const
        {
            return (static_cast<std::uint64_t>(e.low) << 32 | e.high) * 0x9e3779b97f4a7c15ULL >> 20;
        }
    };

    [[nodiscard]] Vec3 in_mm(const Vec3& unit) const
    {
        return {axes_[0] * unit[0], axes_[1] * unit[1], axes_[2] * unit[2]};
    }

    std::uint32_t add(const Vec3& direction)
    {
        const Vec3 x = mesh::scaled(direction, 1 / norm_.of(direction));
        unit_.push_back(x);
        gradients_.push_back(norm_.gradient(x));
        const Vec3& g = gradients_.back();
        normals_.push_back(mesh::normalized({g[0] / axes_[0], g[1] / axes_[1], g[2] / axes_[2]}));
        return static_cast<std::uint32_t>(unit_.size() - 1);
    }

    [[nodiscard]] static Edge edge(const Triple& face, std::size_t i)
    {
        const std::uint32_t a = face[i], b = face[(i + 1) % 3];
        return {std::min(a, b), std::max(a, b)};
    }

    [[nodiscard]] double size(const Edge& e) const
    {
        return mesh::distance(in_mm(unit_[e.low]), in_mm(unit_[e.high]));
    }

    /// Its longest edge first: the same edge seen from either face, as equal lengths are told apart by the
    /// corners' numbers.
    [[nodiscard]] Triple ordered(const Triple& face) const
    {
        std::size_t best = 0;
        for (std::size_t i = 1; i < 3; ++i) {
            const Edge a = edge(face, i), b = edge(face, best);
            const double difference = size(a) - size(b);
            if (difference > 0 || (difference == 0 && std::pair(a.low, a.high) < std::pair(b.low, b.high)))
                best = i;
        }
        return {face[best], face[(best + 1) % 3], face[(best + 2) % 3]};
    }

    /// In chord errors, a bound; infinite for a face that cannot be bounded, or whose normals do not fit.
    [[nodiscard]] double distance_of(const Triple& face) const
    {
        std::array<Vec3, 3> g{};
        double reach = 0;
        for (std::size_t i = 0; i < 3; ++i) {
            reach = std::max(reach, mesh::length(in_mm(unit_[face[i]])));
            for (std::size_t j = 0; j < 3; ++j)
                g[i][j] = mesh::dot(gradients_[face[i]], unit_[face[j]]);
        }
        const double beta = game_value(g);
        if (!(beta > 0))
            return INFINITY;
        const Vec3 a = in_mm(unit_[face[0]]);
        const Vec3 normal = mesh::normalized(
            mesh::cross(mesh::subtract(in_mm(unit_[face[1]]), a), mesh::subtract(in_mm(unit_[face[2]]), a)));
        const bool fits = std::all_of(face.begin(), face.end(), [&](std::uint32_t corner) {
            return mesh::dot(normals_[corner], normal) >= normal_cosine;
        });
        if (!fits && size(edge(face, 0)) > smallest * std::max({axes_[0], axes_[1], axes_[2]}))
            return INFINITY;
        return reach * (1 / beta - 1) / chord_mm_;
    }

    bool mark_far_faces()
    {
        middles_.clear();
        // A face that was near stays so: only the last round's have to be looked at.
        near_.resize(faces_.size(), false);
        expected_ = 0;
        for (std::size_t f = 0; f < faces_.size(); ++f) {
            const double distance = near_[f] ? 0 : distance_of(faces_[f]);
            near_[f] = distance <= 1;
            if (distance > 1)
                middles_.try_emplace(edge(faces_[f], 0), mesh::no_neighbour);
            // Half the size, a quarter of the distance.
            expected_ += std::isfinite(distance) ? std::max(1.0, distance) : 1.0;
        }
        return !middles_.empty();
    }

    /// A face with a marked edge has its longest edge marked too: then bisection leaves no T-junction.
    void spread_marks()
    {
        for (bool more = true; more;) {
            more = false;
            for (const Triple& face : faces_) {
                if (middles_.contains(edge(face, 1)) || middles_.contains(edge(face, 2)))
                    more |= middles_.try_emplace(edge(face, 0), mesh::no_neighbour).second;
            }
        }
        // In the order of the faces, not of a hash function: the same triangles everywhere.
        for (const Triple& face : faces_) {
            const auto found = middles_.find(edge(face, 0));
            if (found != middles_.end() && found->second == mesh::no_neighbour)
                found->second = add(mesh::scaled(mesh::add(unit_[face[0]], unit_[face[1]]), 0.5));
        }
    }

    void bisect_marked()
    {
        std::vector<Triple> faces;
        std::vector<bool> near;
        faces.reserve(faces_.size() + 2 * middles_.size());
        for (std::size_t f = 0; f < faces_.size(); ++f) {
            if (middles_.contains(edge(faces_[f], 0)))
                bisect(faces_[f], 0, faces);
            else
                faces.push_back(faces_[f]);
            near.resize(faces.size(), faces.back() == faces_[f] && near_[f]);
        }
        faces_ = std::move(faces);
        near_ = std::move(near);
    }

    /// Cuts a face at its edge i, and the halves at their marked edges.
    void bisect(const Triple& face, std::size_t i, std::vector<Triple>& out)
    {
        const std::uint32_t a = face[i], b = face[(i + 1) % 3], c = face[(i + 2) % 3];
        const std::uint32_t m = middles_.at(edge(face, i));
        for (const Triple& half : {Triple{c, a, m}, Triple{b, c, m}}) {
            if (middles_.contains(edge(half, 0)))
                bisect(half, 0, out);
            else
                out.push_back(ordered(half));
        }
    }

    Norm norm_;
    Vec3 axes_;
    double chord_mm_;
    double expected_ = 0;                          ///< triangles in the end, roughly
    std::vector<Vec3> unit_, gradients_, normals_; ///< per vertex: of norm 1; of the norm there; mm
    std::vector<Triple> faces_;                    ///< longest edge first
    std::vector<bool> near_;                       ///< per face
    std::unordered_map<Edge, std::uint32_t, EdgeHash> middles_; ///< of marked edges
};

} // namespace

Result<mesh::Soup> superquadric_soup(const Superquadric& superquadric, double chord_mm)
{
    Refinement refinement(superquadric, chord_mm);
    if (Status status = refinement.run(); !status)
        return status.error();
    return refinement.take();
}

} // namespace phantom::scene
