// SPDX-License-Identifier: GPL-2.0-or-later
// The paper's preprocessing (Kabelac 2001, section 4.1): a soup becomes a mesh that can be touched.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "base/result.hpp"
#include "mesh/mesh.hpp"
#include "mesh/simplify.hpp"

namespace phantom::mesh {

struct PrepareOptions {
    bool full = true;         ///< false: faces and normals as the file gives them; missing normals
                              ///< are angle-weighted, no crease; nothing welded, dropped or split
    double scale = 1.0;       ///< file units to mm; before fit
    double fit_mm = 0.0;      ///< > 0: scale the longest side to this and centre at the origin
    double weld_mm = 0.0;     ///< distance under which vertices are one; 0: only equal ones
    double crease_deg = 60.0; ///< edges sharper than this keep two normals
    double split_mm = 0.0;    ///< edges longer than this are bisected; 0: off
    bool two_sided = false;   ///< faces get backs, see two_sided.hpp
    std::optional<SimplifyOptions> simplify{}; ///< before the split; its crease_deg is the one above
    std::function<void(double)> progress{};    ///< 0 ... 1, may be empty
};

/// Every option that the result depends on, in words: two that differ give different words.
std::string words_of(const PrepareOptions& options);

/// What was found and what was done about it. Every input face is in faces or in exactly one dropped count:
/// faces_read (polygons cut into triangles) = faces - faces_split - faces_cut + faces_simplified +
/// faces_zero_area + faces_duplicate + faces_nonfinite.
struct Findings {
    std::uint64_t vertices_read = 0, faces_read = 0;
    std::uint64_t polygons_crossed = 0; ///< cross themselves: their triangles overlap
    std::uint64_t vertices_welded = 0;
    std::uint64_t faces_zero_area = 0; ///< dropped: two corners equal or collinear
    std::uint64_t faces_duplicate = 0; ///< dropped: same three vertices, same sense
    std::uint64_t faces_nonfinite = 0; ///< dropped: a corner is not a finite point
    std::uint64_t faces_flipped = 0;   ///< turned so that neighbours agree
    std::uint64_t components = 0;
    std::uint64_t components_turned = 0;    ///< closed and pointing into their solid: turned
    std::uint64_t cavities = 0;             ///< closed components inside a solid: they point into the hollow
    std::uint64_t vertices_sewn = 0;        ///< at a boundary: moved onto another one, which closed a crack
    std::uint64_t t_junctions = 0;          ///< vertices on another face's boundary edge, which was cut there
    std::uint64_t faces_cut = 0;            ///< faces added by that
    std::uint64_t nonmanifold_edges = 0;    ///< shared by more than two faces; these were paired
    std::uint64_t nonmanifold_vertices = 0; ///< where several fans of faces met, ends of such edges included
    std::uint64_t vertices_separated = 0;   ///< added, so that each fan of faces has a vertex of its own
    std::uint64_t boundary_edges = 0;       ///< over which a face has no neighbour
    /// At which a surface ends, by their points, one-sided; what hangs together of them is one rim. See
    /// rims.hpp.
    std::uint64_t rim_edges = 0, rims = 0;
    std::uint64_t unorientable_edges = 0; ///< two faces that cannot agree on a side (a Moebius strip)
    std::uint64_t crease_edges = 0;
    std::uint64_t normals_repaired = 0;    ///< corner normals that cancelled to zero or did not fit
    std::uint64_t faces_simplified = 0;    ///< faces that simplification left out
    double simplify_error_mm = 0;          ///< how far it took the surface, and the surface it, by samples
    std::uint64_t faces_split = 0;         ///< faces added by bisection
    std::uint64_t vertices = 0, faces = 0; ///< of the result
    double moved_max_mm = 0; ///< no part of the surface was moved farther by welding, sewing and cutting
    double edge_min_mm = 0, edge_median_mm = 0, edge_max_mm = 0;
    bool too_many_groups = false; ///< of faces, more than face_groups_max: there are none
    bool watertight = false;      ///< every face has a neighbour over each of its edges
    double size_mm[3] = {0, 0, 0};
    /// Places where the result is not what it should be, by the last step's checks (validate.cpp). Not 0 is a
    /// fault of this program.
    std::uint64_t faults = 0;
};

struct Report : Findings {
    std::vector<std::string> warnings; ///< one line each; names the option that helps, where there is one
};

struct Prepared {
    Mesh mesh;
    Report report;
};

/// The steps in their order: scale, drop what is not finite or has no area, fit, weld, drop again,
/// duplicates, orientation, cracks and T-junctions, long edges, neighbours (edges of more than two faces
/// paired), a vertex for every fan, normals, backs, and checks of the result. `name` stands in errors. Fails
/// when no usable face is left, or when an option is out of range or would give more than 20 million faces.
///
/// Preparing what it gave once more, with the same options but scale and two_sided, changes nothing, bit for
/// bit; but for a fit together with a weld distance or a gap to be closed, which may move the outline by
/// that.
Result<Prepared> prepare(Soup soup, const PrepareOptions& options, const std::string& name);

/// Writes binary little-endian PLY with doubles and vertex normals (corners with different
/// normals become vertices of their own); atomically (temporary file, then rename).
Status write_ply(const Mesh& mesh, const std::string& file);

} // namespace phantom::mesh
