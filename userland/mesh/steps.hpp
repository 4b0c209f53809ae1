// SPDX-License-Identifier: GPL-2.0-or-later
// The steps of prepare(), in their order. Each works on a soup in mm in place and counts into the report.
//
// Plain arrays and one edge index, not a half-edge mesh: OpenMesh passes coordinates through float and drops
// faces that would make it non-manifold, and here every face must be kept or counted.
#pragma once

#include <memory>
#include <span>

#include "mesh/edge_index.hpp"
#include "mesh/mesh.hpp"
#include "mesh/prepare.hpp"

namespace phantom::mesh {

/// Vertices no farther apart than weld_mm become the first of them; 0: only equal ones. Representatives are
/// pairwise farther apart than weld_mm, so a second run changes nothing.
void weld(Soup& soup, double weld_mm, Report& report);

/// Removes vertices that no face uses; those kept stay in order.
void drop_unused_vertices(Soup& soup);

/// Drops faces with a corner that is no finite point: no step can do anything with them.
void drop_nonfinite(Soup& soup, Report& report);

/// Drops those, and faces without area: two corners equal, or the height
/// over the longest side below 1e-12 of it (rounding of the coordinates themselves).
void drop_degenerate(Soup& soup, Report& report);

/// Drops faces with the same three corners in the same sense as an earlier one, and turns faces so that
/// neighbours agree (the fewer of a component are turned), then every closed component that does not point
/// out of its solid: outward, but into the hollow where it bounds a cavity. `edges` is the soup's, before and
/// after.
void orient(Soup& soup, std::unique_ptr<EdgeIndex>& edges, Report& report);

/// Bisects edges longer than split_mm, longest first, in every face that has them (no T-junctions).
/// Fails when that would give more than 20 million faces. Children take their parent's place in the order.
Status split_long_edges(Soup& soup, double split_mm, const std::string& name, Report& report);

/// Faces over each edge; none across one of two that disagree. Edges of more than two are paired by
/// EdgePairs with pair_more, else they have none. Counts edges.
std::vector<Triple> neighbours_of(const Soup& soup, const EdgeIndex& edges, Report& report,
                                  bool pair_more = false);

/// Gives every fan of faces round a vertex a vertex of its own, behind all others. An EdgeIndex of the soup
/// holds no longer then.
void separate_fans(Soup& soup, const std::vector<Triple>& neighbours, Report& report);

/// Parts that hang together over neighbours.
std::uint64_t count_components(const std::vector<Triple>& neighbours);

/// Angle-weighted normals per corner, faces round a vertex grouped up to creases: edges between faces more
/// than crease_deg apart, but those within a smoothing group, and those between two. A normal of the file
/// stays where it fits its face.
void corner_normals(Soup& soup, const std::vector<Triple>& neighbours, double crease_deg, Report& report);

/// Removes the faces for which drop(number of the face) holds; the rest stays in order. Returns how many.
template <typename Drop>
std::uint64_t remove_faces(Soup& soup, Drop&& drop)
{
    const bool with_normals = !soup.face_normals.empty(), with_smoothing = !soup.smoothing.empty();
    const bool with_groups = !soup.face_groups.empty();
    std::size_t kept = 0;
    for (std::size_t f = 0; f < soup.faces.size(); ++f) {
        if (drop(f))
            continue;
        soup.faces[kept] = soup.faces[f];
        if (with_normals)
            soup.face_normals[kept] = soup.face_normals[f];
        if (with_smoothing)
            soup.smoothing[kept] = soup.smoothing[f];
        if (with_groups)
            soup.face_groups[kept] = soup.face_groups[f];
        ++kept;
    }
    const std::uint64_t dropped = soup.faces.size() - kept;
    soup.faces.resize(kept);
    if (with_normals)
        soup.face_normals.resize(kept);
    if (with_smoothing)
        soup.smoothing.resize(kept);
    if (with_groups)
        soup.face_groups.resize(kept);
    return dropped;
}

/// Normals of `--prepare none`: angle-weighted over all faces with the same vertex number, no crease.
void vertex_normals(Soup& soup);

/// Two corners equal, or collinear as drop_degenerate() means it.
bool has_no_area(std::span<const Vec3> vertices, const Triple& face);

/// Unit normal by the corners' order; zero for a face without area.
Vec3 face_normal(std::span<const Vec3> vertices, const Triple& face);
inline Vec3 face_normal(const Soup& soup, const Triple& face)
{
    return face_normal(soup.vertices, face);
}

/// Faces of a finished mesh that break what every later part relies on: corners that exist and are finite, an
/// area, unit normals within 90 degrees of the face, neighbours that have one another over the same edge, the
/// other way round.
std::uint64_t count_faults(const Mesh& mesh);

/// Shortest, median and longest edge.
void measure_edges(const Soup& soup, const EdgeIndex& edges, Report& report);

/// Sizes, rims, and the warnings that name an option. A mesh that will be two-sided is not warned about its
/// boundary.
void finish_report(const Mesh& mesh, bool two_sided, Report& report);

} // namespace phantom::mesh
