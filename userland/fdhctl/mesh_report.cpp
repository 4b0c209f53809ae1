// SPDX-License-Identifier: GPL-2.0-or-later
#include "fdhctl/mesh_report.hpp"

#include <fmt/format.h>

namespace phantom::fdhctl {

nlohmann::json report_json(const mesh::Report& report)
{
    return {{"vertices_read", report.vertices_read},
            {"faces_read", report.faces_read},
            {"vertices_welded", report.vertices_welded},
            {"faces_zero_area", report.faces_zero_area},
            {"faces_duplicate", report.faces_duplicate},
            {"faces_flipped", report.faces_flipped},
            {"components", report.components},
            {"components_turned", report.components_turned},
            {"nonmanifold_edges", report.nonmanifold_edges},
            {"boundary_edges", report.boundary_edges},
            {"rim_edges", report.rim_edges},
            {"rims", report.rims},
            {"crease_edges", report.crease_edges},
            {"normals_repaired", report.normals_repaired},
            {"faces_split", report.faces_split},
            {"vertices", report.vertices},
            {"faces", report.faces},
            {"edge_min_mm", report.edge_min_mm},
            {"edge_median_mm", report.edge_median_mm},
            {"edge_max_mm", report.edge_max_mm},
            {"watertight", report.watertight},
            {"size_mm", report.size_mm},
            {"warnings", report.warnings}};
}

std::string report_text(const mesh::Report& report)
{
    std::string text;
    const auto add = [&text](const char* name, const std::string& value) {
        text += fmt::format("{:<11} {}\n", name, value);
    };
    add("read", fmt::format("{} vertices, {} faces", report.vertices_read, report.faces_read));
    add("repaired",
        fmt::format("{} vertices welded, {} faces without area and {} duplicates dropped, {} faces "
                    "flipped, {} components turned, {} normals",
                    report.vertices_welded, report.faces_zero_area, report.faces_duplicate,
                    report.faces_flipped, report.components_turned, report.normals_repaired));
    add("has",
        fmt::format("{} component{}, {} boundary edges, {} rim{}, {} non-manifold edges, {} creases: {}",
                    report.components, report.components == 1 ? "" : "s", report.boundary_edges, report.rims,
                    report.rims == 1 ? "" : "s", report.nonmanifold_edges, report.crease_edges,
                    report.watertight ? "watertight" : "not watertight"));
    if (report.faces_split)
        add("split", fmt::format("{} faces added", report.faces_split));
    add("result", fmt::format("{} vertices, {} faces, {:.4g} x {:.4g} x {:.4g} mm", report.vertices,
                              report.faces, report.size_mm[0], report.size_mm[1], report.size_mm[2]));
    add("edges", fmt::format("{:.4g} / {:.4g} / {:.4g} mm (shortest, median, longest)", report.edge_min_mm,
                             report.edge_median_mm, report.edge_max_mm));
    return text;
}

} // namespace phantom::fdhctl
