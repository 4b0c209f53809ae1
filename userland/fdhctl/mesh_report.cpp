// SPDX-License-Identifier: GPL-2.0-or-later
#include "fdhctl/mesh_report.hpp"

#include <fmt/format.h>

namespace phantom::fdhctl {

namespace {

/// "3 faces", "1 face"
std::string counted(std::uint64_t count, const char* one, const char* more)
{
    return fmt::format("{} {}", count, count == 1 ? one : more);
}

/// Parts of one line; those that count nothing are left out.
class Parts {
  public:
    Parts& add(std::uint64_t count, const char* one, const char* more)
    {
        return count == 0 ? *this : add(counted(count, one, more));
    }
    Parts& add(const std::string& part)
    {
        text_ += (text_.empty() ? "" : ", ") + part;
        return *this;
    }
    [[nodiscard]] const std::string& text() const { return text_; }

  private:
    std::string text_;
};

/// The steps in their order, each with what it did.
std::string steps_text(const mesh::Report& r)
{
    std::string text;
    const auto line = [&text](const char* name, const Parts& parts) {
        if (!parts.text().empty())
            text += fmt::format("{:<11} {}\n", name, parts.text());
    };
    line("welded", Parts().add(r.vertices_welded, "vertex", "vertices"));
    line("dropped", Parts()
                        .add(r.faces_zero_area, "face without area", "faces without area")
                        .add(r.faces_duplicate, "duplicate", "duplicates")
                        .add(r.faces_nonfinite, "face that is not finite", "faces that are not finite"));
    line("turned",
         Parts()
             .add(r.faces_flipped, "face", "faces")
             .add(r.components_turned, "component that was inside out", "components that were inside out"));
    Parts closed;
    closed.add(r.vertices_sewn, "vertex sewn at cracks", "vertices sewn at cracks")
        .add(r.t_junctions, "T-junction", "T-junctions");
    if (r.faces_cut > 0)
        closed.add(counted(r.faces_cut, "face added", "faces added"));
    line("closed", closed);
    line("separated",
         Parts()
             .add(r.nonmanifold_edges, "edge of more than two faces", "edges of more than two faces")
             .add(r.nonmanifold_vertices, "vertex of several fans", "vertices of several fans")
             .add(r.vertices_separated, "vertex added", "vertices added"));
    if (r.faces_simplified)
        text += fmt::format("{:<11} {} faces left out, {:.4g} mm at most from what was there\n", "simplified",
                            r.faces_simplified, r.simplify_error_mm);
    line("split", Parts().add(r.faces_split, "face added", "faces added"));
    line("normals", Parts().add(r.normals_repaired, "repaired", "repaired"));
    if (r.moved_max_mm > 0)
        line("moved", Parts().add(fmt::format("{:.3g} mm at most", r.moved_max_mm)));
    return text;
}

std::string result_text(const scene::Object& object)
{
    const mesh::Report& r = object.report;
    std::string text;
    const auto line = [&text](const char* name, const std::string& value) {
        text += fmt::format("{:<11} {}\n", name, value);
    };
    Parts has;
    has.add(counted(r.components, "component", "components"))
        .add(r.cavities, "cavity", "cavities")
        .add(counted(r.boundary_edges, "boundary edge", "boundary edges"))
        .add(counted(r.rims, "rim", "rims"))
        .add(r.unorientable_edges, "edge without a common outside", "edges without a common outside")
        .add(counted(r.crease_edges, "crease edge", "crease edges"));
    line("has", has.text() + (r.watertight ? ": watertight" : ": not watertight"));
    line("result", fmt::format("{} vertices, {} triangles, {:.4g} x {:.4g} x {:.4g} mm", r.vertices, r.faces,
                               r.size_mm[0], r.size_mm[1], r.size_mm[2]));
    line("edges", fmt::format("{:.4g} / {:.4g} / {:.4g} mm (shortest, median, longest)", r.edge_min_mm,
                              r.edge_median_mm, r.edge_max_mm));
    line("patches", fmt::format("{} triangles, {} in fans over creases, {} rim edges",
                                object.mesh.faces.size(), object.fans.fans.size(), object.rims.edges.size()));
    if (r.faults > 0)
        line("faults", counted(r.faults, "face is not as it should be", "faces are not as they should be"));
    return text;
}

} // namespace

nlohmann::json report_json(const scene::Object& object)
{
    const mesh::Report& report = object.report;
    return {{"vertices_read", report.vertices_read},
            {"faces_read", report.faces_read},
            {"polygons_crossed", report.polygons_crossed},
            {"vertices_welded", report.vertices_welded},
            {"faces_zero_area", report.faces_zero_area},
            {"faces_duplicate", report.faces_duplicate},
            {"faces_nonfinite", report.faces_nonfinite},
            {"faces_flipped", report.faces_flipped},
            {"components", report.components},
            {"components_turned", report.components_turned},
            {"cavities", report.cavities},
            {"vertices_sewn", report.vertices_sewn},
            {"t_junctions", report.t_junctions},
            {"faces_cut", report.faces_cut},
            {"nonmanifold_edges", report.nonmanifold_edges},
            {"nonmanifold_vertices", report.nonmanifold_vertices},
            {"vertices_separated", report.vertices_separated},
            {"boundary_edges", report.boundary_edges},
            {"rim_edges", report.rim_edges},
            {"rims", report.rims},
            {"unorientable_edges", report.unorientable_edges},
            {"crease_edges", report.crease_edges},
            {"normals_repaired", report.normals_repaired},
            {"faces_simplified", report.faces_simplified},
            {"simplify_error_mm", report.simplify_error_mm},
            {"faces_split", report.faces_split},
            {"vertices", report.vertices},
            {"faces", report.faces},
            {"patches",
             {{"faces", object.mesh.faces.size()},
              {"fans", object.fans.fans.size()},
              {"rims", object.rims.edges.size()}}},
            {"moved_max_mm", report.moved_max_mm},
            {"edge_min_mm", report.edge_min_mm},
            {"edge_median_mm", report.edge_median_mm},
            {"edge_max_mm", report.edge_max_mm},
            {"watertight", report.watertight},
            {"size_mm", report.size_mm},
            {"faults", report.faults},
            {"warnings", report.warnings}};
}

std::string report_text(const scene::Object& object)
{
    Parts read;
    read.add(counted(object.report.vertices_read, "vertex", "vertices"))
        .add(counted(object.report.faces_read, "triangle", "triangles"));
    read.add(object.report.polygons_crossed, "polygon that crosses itself", "polygons that cross themselves");
    return fmt::format("{:<11} {}\n", "read", read.text()) + steps_text(object.report) + result_text(object);
}

} // namespace phantom::fdhctl
