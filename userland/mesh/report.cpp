// SPDX-License-Identifier: GPL-2.0-or-later
#include <algorithm>

#include <fmt/format.h>

#include "mesh/edge_index.hpp"
#include "mesh/face_groups.hpp"
#include "mesh/rims.hpp"
#include "mesh/steps.hpp"
#include "mesh/vector.hpp"

namespace phantom::mesh {

namespace {

/// The hand works in a space of some decimetres: anything else is most likely another unit.
void warn_size(double extent_mm, Report& report)
{
    if (extent_mm < 10.0)
        report.warnings.push_back(
            fmt::format("only {:.3g} mm across: another unit? (--unit m, or --fit 100)", extent_mm));
    else if (extent_mm > 1000.0)
        report.warnings.push_back(fmt::format(
            "{:.3g} m across: another unit? (--unit mm, --unit um, or --fit 100)", extent_mm / 1000.0));
}

void warn_defects(bool two_sided, Report& report)
{
    const auto warn = [&report](std::uint64_t count, const char* what) {
        if (count > 0)
            report.warnings.push_back(fmt::format("{} {}", count, what));
    };
    if (!two_sided && report.rims > 0)
        report.warnings.push_back(fmt::format(
            "{} boundary edges in {} rim{}: the mesh is open, the force fades over the last contact radius "
            "before a rim, and a tip can get behind it (two_sided = true in a scene file closes it, --weld "
            "MM "
            "closes cracks of that width)",
            report.rim_edges, report.rims, report.rims == 1 ? "" : "s"));
    else if (!two_sided)
        warn(report.boundary_edges, "boundary edges whose points are others' as well: no proxy slides across "
                                    "them (--prepare full welds)");
    warn(report.nonmanifold_edges,
         "non-manifold edges (more than two faces): faces that belong together were "
         "paired, the others end there");
    warn(report.unorientable_edges,
         "edges whose two faces disagree on the outside: no proxy slides across them");
    warn(report.faces_zero_area, "faces without area dropped (--prepare none keeps them)");
    warn(report.faces_duplicate, "duplicate faces dropped (--prepare none keeps them)");
    warn(report.faces_nonfinite, "faces with a corner that is no finite point dropped");
    warn(report.polygons_crossed, "polygons cross themselves: their triangles overlap, and are felt twice");
    if (report.too_many_groups)
        report.warnings.push_back(fmt::format("more than {} groups of faces (materials or colours): they are "
                                              "not told apart",
                                              face_groups_max));
}

} // namespace

void measure_edges(const Soup& soup, const EdgeIndex& edges, Report& report)
{
    std::vector<double> sizes;
    sizes.reserve(3 * soup.faces.size() / 2);
    edges.for_each([&](std::uint32_t low, std::uint32_t high, std::span<const HalfEdge>) {
        sizes.push_back(distance(soup.vertices[low], soup.vertices[high]));
    });
    if (sizes.empty())
        return;
    const auto [least, most] = std::minmax_element(sizes.begin(), sizes.end());
    report.edge_min_mm = *least;
    report.edge_max_mm = *most;
    const auto middle = sizes.begin() + static_cast<std::ptrdiff_t>(sizes.size() / 2);
    std::nth_element(sizes.begin(), middle, sizes.end());
    report.edge_median_mm = *middle;
}

void finish_report(const Mesh& mesh, bool two_sided, Report& report)
{
    report.vertices = mesh.vertices.size();
    report.faces = mesh.faces.size();
    const Rims rims = make_rims(mesh, 0);
    report.rim_edges = rims.edges.size();
    report.rims = rims.loops;
    const Bounds bounds = bounds_of(mesh.vertices);
    for (std::size_t axis = 0; axis < 3; ++axis)
        report.size_mm[axis] = bounds.high[axis] - bounds.low[axis];
    warn_size(bounds.extent(), report);
    warn_defects(two_sided, report);
}

} // namespace phantom::mesh
