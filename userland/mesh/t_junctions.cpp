// SPDX-License-Identifier: GPL-2.0-or-later
#include <algorithm>
#include <array>
#include <cmath>

#include "mesh/box_tree.hpp"
#include "mesh/steps.hpp"
#include "mesh/stitch.hpp"
#include "mesh/vector.hpp"

namespace phantom::mesh {

namespace {

/// A tolerance beyond this part of an edge would see its ends in its middle.
constexpr double part_of_edge = 0.25;

/// A vertex on an edge.
struct Hit {
    HalfEdge half;
    double part; ///< of the way from the edge's first end to its second
    std::uint32_t vertex;
    double away; ///< from the edge, mm
    bool operator<(const Hit& b) const
    {
        if (half != b.half)
            return half < b.half;
        return part != b.part ? part < b.part : vertex < b.vertex;
    }
};

/// The boundary as lines between points.
class Lines {
  public:
    Lines(const Soup& soup, const std::vector<HalfEdge>& boundary, double tolerance_mm)
        : soup_(soup), boundary_(boundary), tolerance_(tolerance_mm)
    {
        for (const HalfEdge half : boundary) {
            const Vec3 &a = from(half), &b = to(half);
            Bounds box = bounds_of(std::array{a, b});
            for (std::size_t axis = 0; axis < 3; ++axis) {
                box.low[axis] -= tolerance_;
                box.high[axis] += tolerance_;
            }
            boxes_.push_back(box);
            ends_.push_back({from_vertex(soup.faces, half), to_vertex(soup.faces, half)});
            ends_.push_back({to_vertex(soup.faces, half), from_vertex(soup.faces, half)});
        }
        std::sort(ends_.begin(), ends_.end());
    }

    /// Vertices on edges along which their own boundary goes on, by edge and along it.
    [[nodiscard]] std::vector<Hit> hits() const
    {
        std::vector<Hit> found;
        const BoxTree tree(boxes_);
        for (std::size_t i = 0; i < ends_.size(); ++i) {
            if (i > 0 && ends_[i].vertex == ends_[i - 1].vertex)
                continue;
            const std::uint32_t vertex = ends_[i].vertex;
            const Vec3& point = soup_.vertices[vertex];
            tree.visit_meeting({point, point}, [&](std::uint32_t line) {
                const Hit hit = on_line(boundary_[line], vertex);
                if (hit.vertex != no_neighbour && goes_on(hit, i))
                    found.push_back(hit);
            });
        }
        std::sort(found.begin(), found.end());
        // two vertices at one place of an edge: the crack between them comes first, in the next round
        const auto same_place = [this](const Hit& a, const Hit& b) {
            return a.half == b.half && (b.part - a.part) * size(a.half) <= within(a.half);
        };
        found.erase(std::unique(found.begin(), found.end(), same_place), found.end());
        return found;
    }

  private:
    struct End {
        std::uint32_t vertex, other;
        bool operator<(const End& b) const
        {
            return vertex != b.vertex ? vertex < b.vertex : other < b.other;
        }
    };

    [[nodiscard]] const Vec3& from(HalfEdge half) const
    {
        return soup_.vertices[from_vertex(soup_.faces, half)];
    }
    [[nodiscard]] const Vec3& to(HalfEdge half) const { return soup_.vertices[to_vertex(soup_.faces, half)]; }
    [[nodiscard]] double size(HalfEdge half) const { return distance(from(half), to(half)); }
    [[nodiscard]] double within(HalfEdge half) const
    {
        return std::min(tolerance_, part_of_edge * size(half));
    }

    /// The vertex as a hit, with no_neighbour for its number when it does not lie inside of the edge.
    [[nodiscard]] Hit on_line(HalfEdge half, std::uint32_t vertex) const
    {
        const Triple& face = soup_.faces[half / 3];
        const Hit none{half, 0, no_neighbour, 0};
        if (std::find(face.begin(), face.end(), vertex) != face.end())
            return none;
        const Vec3& a = from(half);
        const Vec3 along = subtract(to(half), a), out = subtract(soup_.vertices[vertex], a);
        const double whole = length(along), part = dot(along, out) / (whole * whole);
        const double away = length(subtract(out, scaled(along, part)));
        const double most = within(half);
        const bool inside = part * whole > most && (1 - part) * whole > most && away <= most;
        return inside ? Hit{half, part, vertex, away} : none;
    }

    /// Whether an edge of the vertex's own runs along the one that it lies on; ends_[first] is its first.
    [[nodiscard]] bool goes_on(const Hit& hit, std::size_t first) const
    {
        const Vec3 &a = from(hit.half), &b = to(hit.half), &v = soup_.vertices[hit.vertex];
        const Vec3 along = subtract(b, a);
        const double whole = length(along), most = within(hit.half);
        for (std::size_t i = first; i < ends_.size() && ends_[i].vertex == hit.vertex; ++i) {
            const Vec3& w = soup_.vertices[ends_[i].other];
            const double part = dot(along, subtract(w, a)) / (whole * whole);
            if (std::abs(part - hit.part) * whole <= most)
                continue;
            // the end of what they have in common: w, or that end of the edge that w lies beyond
            const bool inside = part >= 0 && part <= 1;
            const Vec3& end = inside ? w : part < 0 ? a : b;
            if (inside ? off_line(a, b, end) <= most : off_line(v, w, end) <= most)
                return true;
        }
        return false;
    }

    /// Distance of a point from the line through a and b.
    static double off_line(const Vec3& a, const Vec3& b, const Vec3& point)
    {
        const Vec3 along = subtract(b, a), out = subtract(point, a);
        return length(subtract(out, scaled(along, dot(along, out) / dot(along, along))));
    }

    const Soup& soup_;
    const std::vector<HalfEdge>& boundary_;
    double tolerance_;
    std::vector<Bounds> boxes_; ///< of the edges, larger by the tolerance
    std::vector<End> ends_;     ///< every edge from either end, by vertex
};

/// A face and what it becomes.
struct Piece {
    Triple corners, normals;
};

/// Makes room for pieces in a soup, face by face in order.
class Cutter {
  public:
    explicit Cutter(Soup& soup) : soup_(soup), with_normals_(!soup.face_normals.empty()) {}

    /// Cuts the face at hits on its edges, sorted; returns how many it took. An edge is left as it is where a
    /// piece would have no area or lie the other way round.
    std::size_t cut(std::uint32_t face, std::span<const Hit> hits)
    {
        pieces_.assign(1, {soup_.faces[face], with_normals_ ? soup_.face_normals[face] : Triple{}});
        const Triple whole = soup_.faces[face];
        std::size_t taken = 0;
        for (std::size_t begin = 0, end = 0; begin < hits.size(); begin = end) {
            while (end < hits.size() && hits[end].half == hits[begin].half)
                ++end;
            const std::uint32_t edge = hits[begin].half % 3;
            taken += cut_edge(whole[edge], whole[(edge + 1) % 3], hits.subspan(begin, end - begin));
        }
        return taken;
    }

    [[nodiscard]] const std::vector<Piece>& pieces() const { return pieces_; }
    /// How far the surface was moved at most.
    [[nodiscard]] double moved_mm() const { return moved_mm_; }
    [[nodiscard]] bool with_normals() const { return with_normals_; }

  private:
    std::size_t cut_edge(std::uint32_t from, std::uint32_t to, std::span<const Hit> hits)
    {
        const auto piece = std::find_if(pieces_.begin(), pieces_.end(), [&](const Piece& p) {
            return corner(p, from) < 3 && p.corners[(corner(p, from) + 1) % 3] == to;
        });
        const std::size_t i = corner(*piece, from), j = (i + 1) % 3, k = (i + 2) % 3;
        const Piece old = *piece;
        std::vector<Piece> fan;
        Piece rest = old;
        for (const Hit& hit : hits) {
            Piece next = rest;
            next.corners[j] = rest.corners[i] = hit.vertex;
            if (with_normals_)
                next.normals[j] = rest.normals[i] = normal_between(old.normals[i], old.normals[j], hit.part);
            fan.push_back(next);
        }
        fan.push_back(rest);
        const Vec3 before = face_normal(soup_, old.corners);
        for (const Piece& p : fan) {
            if (p.corners[j] == old.corners[k] || p.corners[i] == old.corners[k] ||
                has_no_area(soup_.vertices, p.corners) || !(dot(face_normal(soup_, p.corners), before) > 0))
                return 0;
        }
        for (const Hit& hit : hits)
            moved_mm_ = std::max(moved_mm_, hit.away);
        *piece = fan.front();
        pieces_.insert(piece + 1, fan.begin() + 1, fan.end());
        return hits.size();
    }

    static std::size_t corner(const Piece& piece, std::uint32_t vertex)
    {
        return static_cast<std::size_t>(std::find(piece.corners.begin(), piece.corners.end(), vertex) -
                                        piece.corners.begin());
    }

    /// Number of a new normal; one without direction is the next steps' to repair.
    std::uint32_t normal_between(std::uint32_t from, std::uint32_t to, double part)
    {
        soup_.normals.push_back(
            normalized(add(scaled(soup_.normals[from], 1 - part), scaled(soup_.normals[to], part))));
        return static_cast<std::uint32_t>(soup_.normals.size() - 1);
    }

    Soup& soup_;
    bool with_normals_;
    std::vector<Piece> pieces_;
    double moved_mm_ = 0;
};

} // namespace

bool cut_t_junctions(Soup& soup, const std::vector<HalfEdge>& boundary, double tolerance_mm, Report& report)
{
    const std::vector<Hit> hits = Lines(soup, boundary, tolerance_mm).hits();
    if (hits.empty())
        return false;
    Cutter cutter(soup);
    std::vector<Triple> faces, face_normals;
    std::vector<std::uint32_t> smoothing;
    std::vector<std::uint8_t> face_groups;
    faces.reserve(soup.faces.size() + hits.size());
    std::size_t taken = 0, at = 0;
    for (std::uint32_t f = 0; f < soup.faces.size(); ++f) {
        const std::size_t begin = at;
        while (at < hits.size() && hits[at].half / 3 == f)
            ++at;
        taken += cutter.cut(f, std::span(hits).subspan(begin, at - begin));
        for (const Piece& piece : cutter.pieces()) {
            faces.push_back(piece.corners);
            if (cutter.with_normals())
                face_normals.push_back(piece.normals);
            if (!soup.smoothing.empty())
                smoothing.push_back(soup.smoothing[f]);
            if (!soup.face_groups.empty())
                face_groups.push_back(soup.face_groups[f]);
        }
    }
    report.moved_max_mm += cutter.moved_mm();
    report.t_junctions += taken;
    report.faces_cut += faces.size() - soup.faces.size();
    soup.faces = std::move(faces);
    soup.face_normals = std::move(face_normals);
    soup.smoothing = std::move(smoothing);
    soup.face_groups = std::move(face_groups);
    return taken > 0;
}

} // namespace phantom::mesh
