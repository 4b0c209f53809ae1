// SPDX-License-Identifier: GPL-2.0-or-later
#include "mesh/prepare.hpp"

#include <algorithm>
#include <cmath>
#include <memory>

#include <fmt/format.h>

#include "mesh/steps.hpp"
#include "mesh/stitch.hpp"
#include "mesh/two_sided.hpp"
#include "mesh/vector.hpp"

namespace phantom::mesh {

namespace {

Status check_options(const PrepareOptions& options)
{
    const auto bad = [](const char* option, double value, const char* expected) {
        return Error{option, fmt::format("{:g} is out of range, expected {}", value, expected)};
    };
    // Negated comparisons: NaN is refused as well.
    if (!(options.scale > 0) || !std::isfinite(options.scale))
        return bad("scale", options.scale, "a number above 0");
    if (!(options.fit_mm >= 0) || !std::isfinite(options.fit_mm))
        return bad("--fit", options.fit_mm, "a size in mm above 0, or 0 for none");
    if (!(options.weld_mm >= 0) || !std::isfinite(options.weld_mm))
        return bad("weld", options.weld_mm, "a distance in mm of 0 or more");
    if (!(options.split_mm >= 0) || !std::isfinite(options.split_mm))
        return bad("--split", options.split_mm, "a length in mm above 0, or 0 for none");
    if (options.simplify && !options.full)
        return Error{"--simplify", "needs a mesh that was repaired", "--prepare full"};
    if (!(options.crease_deg >= 0 && options.crease_deg <= 180))
        return bad("--crease", options.crease_deg, "an angle of 0 ... 180 degrees");
    return success();
}

/// Indices a caller made itself could be wrong; read() never gives such.
bool indices_in_range(const Soup& soup)
{
    const auto within = [](const std::vector<Triple>& triples, std::size_t count) {
        return std::all_of(triples.begin(), triples.end(), [count](const Triple& t) {
            return std::max({t[0], t[1], t[2]}) < count;
        });
    };
    return within(soup.faces, soup.vertices.size()) && within(soup.face_normals, soup.normals.size()) &&
           (soup.face_normals.empty() || soup.face_normals.size() == soup.faces.size()) &&
           (soup.smoothing.empty() || soup.smoothing.size() == soup.faces.size()) &&
           (soup.face_groups.empty() || soup.face_groups.size() == soup.faces.size());
}

/// Bounds of what the faces use: a stray vertex far away does not count.
Bounds used_bounds(const Soup& soup)
{
    std::vector<Vec3> used;
    used.reserve(soup.vertices.size());
    std::vector<bool> seen(soup.vertices.size(), false);
    for (const Triple& face : soup.faces) {
        for (const std::uint32_t v : face) {
            if (!seen[v] && is_finite(soup.vertices[v]))
                used.push_back(soup.vertices[v]);
            seen[v] = true;
        }
    }
    return bounds_of(used);
}

/// Scales the longest side to fit_mm and centres it at the origin.
Status fit(Soup& soup, double fit_mm, const std::string& name)
{
    const Bounds bounds = used_bounds(soup);
    if (!(bounds.extent() > 0))
        return Error{name, "has no extent, so it cannot be fitted to a size", "leave out --fit"};
    const double factor = fit_mm / bounds.extent();
    const Vec3 centre = scaled(add(bounds.low, bounds.high), 0.5);
    // Already fitted: leave every bit as it is.
    if (std::abs(factor - 1.0) < 1e-14 && length(centre) < 1e-12 * fit_mm)
        return success();
    for (Vec3& vertex : soup.vertices)
        vertex = scaled(subtract(vertex, centre), factor);
    return success();
}

/// Sews and cuts until there is nothing more to do; returns whether there was something. `edges` is the
/// soup's, before and after.
bool close_gaps(Soup& soup, std::unique_ptr<EdgeIndex>& edges, double weld_mm, Report& report)
{
    // Every round closes something; one that needs more than this is left to the report.
    constexpr int rounds_max = 16;
    const double tolerance_mm = stitch_tolerance_mm(soup, weld_mm);
    int rounds = 0;
    while (rounds < rounds_max && stitch(soup, *edges, tolerance_mm, report)) {
        ++rounds;
        drop_degenerate(soup, report);
        edges.reset();
        edges = std::make_unique<EdgeIndex>(soup.faces, soup.vertices.size());
    }
    if (rounds == 0)
        return false;
    drop_unused_vertices(soup);
    edges.reset();
    edges = std::make_unique<EdgeIndex>(soup.faces, soup.vertices.size());
    return true;
}

/// With the normals that the result will have, but for what is left out.
void simplify_soup(Soup& soup, const EdgeIndex& edges, const PrepareOptions& options, Report& report)
{
    Report own; // what the steps count is counted once more, of what is left
    const std::vector<Triple> neighbours = neighbours_of(soup, edges, own, true);
    separate_fans(soup, neighbours, report);
    corner_normals(soup, neighbours, options.crease_deg, own);
    report.normals_repaired += own.normals_repaired;
    SimplifyOptions wanted = *options.simplify;
    wanted.crease_deg = options.crease_deg;
    const SimplifyResult result = simplify(soup, wanted);
    drop_unused_vertices(soup);
    report.faces_simplified = result.faces_removed;
    report.simplify_error_mm = result.error_mm;
    if (result.faces_removed == 0)
        report.warnings.push_back("no triangle could be left out within the bounds (a larger "
                                  "--simplify-error, --simplify-normal or "
                                  "--simplify-aspect)");
    if (result.faces_aside > 0)
        report.warnings.push_back(fmt::format("{} faces were not simplified: they do not fit together with "
                                              "those round them",
                                              result.faces_aside));
}

Error no_usable_face(const Report& report, const std::string& name)
{
    return Error{name, fmt::format("has no usable face: {} without area, {} not finite, of {}",
                                   report.faces_zero_area, report.faces_nonfinite, report.faces_read)};
}

} // namespace

std::string words_of(const PrepareOptions& options)
{
    // By structured binding: an option that is added and left out here does not compile.
    const auto& [full, scale, fit_mm, weld_mm, crease_deg, split_mm, two_sided, simplify, progress] = options;
    static_cast<void>(progress);
    // Doubles in hexadecimal, so that not a bit is lost.
    std::string words =
        fmt::format("{} scale {:a} fit {:a} weld {:a} crease {:a} split {:a}{}", full ? "full" : "none",
                    scale, fit_mm, weld_mm, crease_deg, split_mm, two_sided ? " two-sided" : "");
    if (simplify)
        words += fmt::format(" simplify {} {:a} {:a} {:a}", simplify->faces, simplify->error_mm,
                             simplify->normal_deg, simplify->aspect);
    return words;
}

Result<Prepared> prepare(Soup soup, const PrepareOptions& options, const std::string& name)
{
    if (const auto status = check_options(options); !status)
        return status.error();
    if (!indices_in_range(soup))
        return Error{name, "has an index out of range"};
    const auto progress = [&options](double part) {
        if (options.progress)
            options.progress(part);
    };
    Report report;
    report.vertices_read = soup.vertices.size();
    report.faces_read = soup.faces.size();
    report.polygons_crossed = soup.polygons_crossed;
    report.too_many_groups = soup.too_many_groups;
    progress(0);
    for (Vec3& vertex : soup.vertices)
        vertex = scaled(vertex, options.scale);
    // Before the fit: what will be dropped must not count for the size.
    if (options.full) {
        drop_degenerate(soup, report);
    } else {
        drop_nonfinite(soup, report);
        if (!std::all_of(soup.vertices.begin(), soup.vertices.end(), is_finite))
            drop_unused_vertices(soup);
    }
    if (soup.faces.empty())
        return no_usable_face(report, name);
    if (options.fit_mm > 0) {
        if (const auto status = fit(soup, options.fit_mm, name); !status)
            return status.error();
    }

    std::unique_ptr<EdgeIndex> edges;
    const auto index_again = [&] {
        edges.reset(); // before the next: each is as large as the soup
        edges = std::make_unique<EdgeIndex>(soup.faces, soup.vertices.size());
    };
    if (options.full) {
        weld(soup, options.weld_mm, report);
        drop_degenerate(soup, report);
        drop_unused_vertices(soup);
        progress(0.3);
        index_again();
        orient(soup, edges, report);
        if (close_gaps(soup, edges, options.weld_mm, report))
            orient(soup, edges, report);
        if (soup.faces.empty())
            return no_usable_face(report, name);
        progress(0.6);
        if (options.simplify) {
            simplify_soup(soup, *edges, options, report);
            index_again();
        }
        if (options.split_mm > 0) {
            if (const auto status = split_long_edges(soup, options.split_mm, name, report); !status)
                return status.error();
            index_again();
        }
    } else {
        index_again();
    }
    Mesh mesh;
    std::vector<Triple> neighbours = neighbours_of(soup, *edges, report, options.full);
    report.components = count_components(neighbours);
    measure_edges(soup, *edges, report);
    edges.reset();
    if (options.full)
        separate_fans(soup, neighbours, report);
    progress(0.8);
    if (options.full)
        corner_normals(soup, neighbours, options.crease_deg, report);
    else if (soup.face_normals.empty())
        vertex_normals(soup);
    mesh.neighbours = std::move(neighbours);
    mesh.vertices = std::move(soup.vertices);
    mesh.faces = std::move(soup.faces);
    mesh.normals = std::move(soup.normals);
    mesh.face_normals = std::move(soup.face_normals);
    mesh.face_groups = std::move(soup.face_groups);
    mesh.group_names = std::move(soup.group_names);
    finish_report(mesh, options.two_sided, report);
    if (options.two_sided && !make_two_sided(mesh))
        return Error{name, "has too many faces to have two sides", "leave out two_sided"};
    if (options.full && (report.faults = count_faults(mesh)) > 0)
        report.warnings.push_back(
            fmt::format("{} faces of the result are not as they should be, a fault of this "
                        "program: please report it with the mesh",
                        report.faults));
    progress(1);
    return Prepared{std::move(mesh), std::move(report)};
}

} // namespace phantom::mesh
