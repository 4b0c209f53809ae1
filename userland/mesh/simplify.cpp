// SPDX-License-Identifier: GPL-2.0-or-later
// The one file that includes OpenMesh: it takes seconds to compile. Its meshes are built from our arrays, in
// doubles; its readers, which pass coordinates through float, are not used.
#include "mesh/simplify.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>
#include <vector>

#if defined(__GNUC__) && !defined(__clang__)
// GCC 12 takes what a new property is copied from for uninitialised, at -O1.
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wmaybe-uninitialized"
#endif
#include <OpenMesh/Core/Mesh/TriMesh_ArrayKernelT.hh>
#include <OpenMesh/Core/System/omstream.hh>
#include <OpenMesh/Tools/Decimater/DecimaterT.hh>
#include <OpenMesh/Tools/Decimater/ModAspectRatioT.hh>
#include <OpenMesh/Tools/Decimater/ModHausdorffT.hh>
#include <OpenMesh/Tools/Decimater/ModNormalFlippingT.hh>
#include <OpenMesh/Tools/Decimater/ModQuadricT.hh>
#if defined(__GNUC__) && !defined(__clang__)
#pragma GCC diagnostic pop
#endif

#include "mesh/hausdorff.hpp"
#include "mesh/vector.hpp"

namespace phantom::mesh {

namespace {

struct Traits : OpenMesh::DefaultTraits {
    using Point = OpenMesh::Vec3d;
    using Normal = OpenMesh::Vec3d;
    VertexAttributes(OpenMesh::Attributes::Status);
    EdgeAttributes(OpenMesh::Attributes::Status);
    HalfedgeAttributes(OpenMesh::Attributes::Status | OpenMesh::Attributes::PrevHalfedge);
    FaceAttributes(OpenMesh::Attributes::Status | OpenMesh::Attributes::Normal);
};
using HalfEdgeMesh = OpenMesh::TriMesh_ArrayKernelT<Traits>;
using OpenMesh::EdgeHandle;
using OpenMesh::FaceHandle;
using OpenMesh::HalfedgeHandle;
using OpenMesh::VertexHandle;

/// Normals at an edge's end that differ more are a feature.
constexpr double same_normal_cosine = 0.9998; // 1.1 degrees

/// Of the distance measured after a run: for every face that there was, but not more than
constexpr std::size_t samples_per_face = 8, samples_max = 400'000;

/// Where no error is named, a border or crease may leave its place by that part of an edge's length.
constexpr double line_part = 0.05;

/// The decimater's bounds hold at vertices, centres and middles; where it is more between them it runs again,
/// more strictly.
constexpr int runs_max = 4;

/// A vertex on a feature moves along it only, and the line that goes round it no more than a distance from
/// the line that was there at first.
template <class MeshT>
class ModLineT : public OpenMesh::Decimater::ModBaseT<MeshT> {
  public:
    DECIMATING_MODULE(ModLineT, MeshT, Line);

    explicit ModLineT(MeshT& mesh) : Base(mesh, true), mesh_(mesh) { mesh_.add_property(moved_); }
    ~ModLineT() override { mesh_.remove_property(moved_); }
    ModLineT(const ModLineT&) = delete;
    ModLineT& operator=(const ModLineT&) = delete;

    /// 0: line_part of what it becomes as long as.
    void set_bound(double bound_mm) { bound_mm_ = bound_mm; }
    void initialize() override
    {
        for (const auto edge : mesh_.edges())
            mesh_.property(moved_, edge) = 0;
    }
    float collapse_priority(const CollapseInfo& info) override
    {
        if (!mesh_.status(info.v0).feature())
            return Base::LEGAL_COLLAPSE;
        const EdgeHandle other = other_feature(info);
        if (!other.is_valid())
            return Base::ILLEGAL_COLLAPSE;
        const double bound_mm =
            bound_mm_ > 0 ? bound_mm_ : line_part * (mesh_.point(far_end(info, other)) - info.p1).norm();
        return moved_mm(info, other) <= bound_mm ? Base::LEGAL_COLLAPSE : Base::ILLEGAL_COLLAPSE;
    }
    void preprocess_collapse(const CollapseInfo& info) override
    {
        next_ = mesh_.status(info.v0).feature() ? other_feature(info) : EdgeHandle();
        next_mm_ = next_.is_valid() ? moved_mm(info, next_) : 0;
    }
    void postprocess_collapse(const CollapseInfo&) override
    {
        if (next_.is_valid())
            mesh_.property(moved_, next_) = next_mm_;
    }

  private:
    /// Where the feature goes on from v0; nothing where that is a face of the collapsing edge.
    EdgeHandle other_feature(const CollapseInfo& info) const
    {
        EdgeHandle found;
        for (const auto half : mesh_.voh_range(info.v0)) {
            const EdgeHandle edge{mesh_.edge_handle(half).idx()};
            const VertexHandle end = mesh_.to_vertex_handle(half);
            if (!mesh_.status(edge).feature() || end == info.v1)
                continue;
            if (found.is_valid() || end == info.vl || end == info.vr)
                return EdgeHandle();
            found = edge;
        }
        return found;
    }
    VertexHandle far_end(const CollapseInfo& info, EdgeHandle other) const
    {
        const auto half = mesh_.halfedge_handle(other, 0);
        const VertexHandle to = mesh_.to_vertex_handle(half);
        return to == info.v0 ? mesh_.from_vertex_handle(half) : to;
    }
    double moved_mm(const CollapseInfo& info, EdgeHandle other) const
    {
        const auto end = mesh_.point(far_end(info, other));
        const auto along = info.p1 - end, from = info.p0 - end;
        const double squared = along.sqrnorm();
        const double part = squared > 0 ? std::clamp((from | along) / squared, 0.0, 1.0) : 0.0;
        const double before =
            std::max(mesh_.property(moved_, other), mesh_.property(moved_, mesh_.edge_handle(info.v0v1)));
        return before + (from - part * along).norm();
    }

    MeshT& mesh_;
    OpenMesh::EPropHandleT<double> moved_; ///< how far the line may be from where it was, mm
    double bound_mm_ = 0;
    EdgeHandle next_;
    double next_mm_ = 0;
};

/// New faces lie near the surface that was there at first: their centres, and the middles of new edges.
/// (ModHausdorffT looks at it the other way round: that points of the old surface are near to new faces.)
template <class MeshT>
class ModNearT : public OpenMesh::Decimater::ModBaseT<MeshT> {
  public:
    DECIMATING_MODULE(ModNearT, MeshT, Near);

    explicit ModNearT(MeshT& mesh) : Base(mesh, true), mesh_(mesh) {}

    void set_bound(const fdh::TriangleTree<14>& surface, double bound_mm)
    {
        surface_ = &surface;
        bound_mm_ = bound_mm;
    }
    float collapse_priority(const CollapseInfo& info) override
    {
        for (const auto half : mesh_.voh_range(info.v0)) {
            const VertexHandle a = mesh_.to_vertex_handle(half);
            if (a == info.v1)
                continue;
            const auto pa = mesh_.point(a);
            if (a != info.vl && a != info.vr && !is_near(0.5 * (pa + info.p1)))
                return Base::ILLEGAL_COLLAPSE;
            if (mesh_.is_boundary(half))
                continue;
            const VertexHandle b{
                mesh_.to_vertex_handle(mesh_.next_halfedge_handle(HalfedgeHandle(half.idx()))).idx()};
            if (b != info.v1 && !is_near((pa + mesh_.point(b) + info.p1) / 3.0))
                return Base::ILLEGAL_COLLAPSE;
        }
        return Base::LEGAL_COLLAPSE;
    }

  private:
    bool is_near(const OpenMesh::Vec3d& point)
    {
        found_.clear();
        surface_->nearest({point[0], point[1], point[2]}, 1, bound_mm_, found_);
        return !found_.hits.empty();
    }

    MeshT& mesh_;
    const fdh::TriangleTree<14>* surface_ = nullptr;
    double bound_mm_ = 0;
    fdh::Nearest found_;
};

std::uint32_t corner_of(const Triple& face, std::uint32_t vertex)
{
    return face[0] == vertex ? 0 : face[1] == vertex ? 1 : 2;
}

class Simplification {
  public:
    /// The tree is the soup's.
    Simplification(const Soup& soup, const fdh::TriangleTree<14>& tree, const SimplifyOptions& options)
        : soup_(soup), tree_(tree), options_(options)
    {
    }

    /// The faces left, in order, as numbers of vertices of the soup.
    std::size_t run(double error_mm, std::vector<Triple>& faces, std::vector<std::uint32_t>& faces_from)
    {
        mesh_.clear();
        build();
        mark_features();
        const std::size_t aside = aside_.size();
        decimate(error_mm, options_.faces > aside ? options_.faces - aside : 0);
        faces.clear();
        faces_from.clear();
        for (std::uint32_t f = 0; f < soup_.faces.size(); ++f) {
            const FaceHandle face = face_of_[f];
            if (face.is_valid() && mesh_.status(face).deleted())
                continue;
            Triple corners = soup_.faces[f];
            if (face.is_valid()) {
                // Round the same way from the same corner as before, if that is still there.
                std::size_t i = 0;
                for (const auto vertex : mesh_.fv_range(face))
                    corners[i++] = static_cast<std::uint32_t>(vertex.idx());
                for (const std::uint32_t v : soup_.faces[f]) {
                    if (corners[corner_of(corners, v)] != v)
                        continue;
                    while (corner_of(corners, v) != corner_of(soup_.faces[f], v))
                        std::rotate(corners.begin(), corners.begin() + 1, corners.end());
                    break;
                }
            }
            faces.push_back(corners);
            faces_from.push_back(f);
        }
        return aside;
    }

  private:
    void build()
    {
        aside_.clear();
        face_of_.assign(soup_.faces.size(), FaceHandle());
        for (const Vec3& vertex : soup_.vertices)
            mesh_.add_vertex({vertex[0], vertex[1], vertex[2]});
        ::omerr().disable(); // what it refuses is kept aside
        for (std::uint32_t f = 0; f < soup_.faces.size(); ++f) {
            const Triple& at = soup_.faces[f];
            const auto handle = [](std::uint32_t v) { return VertexHandle(static_cast<int>(v)); };
            face_of_[f] = FaceHandle(mesh_.add_face(handle(at[0]), handle(at[1]), handle(at[2])).idx());
            if (!face_of_[f].is_valid())
                aside_.push_back(f);
        }
        ::omerr().enable();
        mesh_.update_face_normals();
        soup_face_.assign(mesh_.n_faces(), no_neighbour);
        for (std::uint32_t f = 0; f < soup_.faces.size(); ++f)
            if (face_of_[f].is_valid())
                soup_face_[static_cast<std::size_t>(face_of_[f].idx())] = f;
    }

    /// The normals of an edge's two faces differ at one of its ends.
    bool parted(HalfedgeHandle half) const
    {
        const std::uint32_t f = soup_face_[static_cast<std::size_t>(mesh_.face_handle(half).idx())];
        const std::uint32_t g = soup_face_[static_cast<std::size_t>(
            mesh_.face_handle(mesh_.opposite_halfedge_handle(half)).idx())];
        for (const VertexHandle end : {mesh_.from_vertex_handle(half), mesh_.to_vertex_handle(half)}) {
            const auto v = static_cast<std::uint32_t>(end.idx());
            const Vec3& a = soup_.normals[soup_.face_normals[f][corner_of(soup_.faces[f], v)]];
            const Vec3& b = soup_.normals[soup_.face_normals[g][corner_of(soup_.faces[g], v)]];
            if (dot(a, b) < same_normal_cosine)
                return true;
        }
        return false;
    }

    /// The two faces of the edge are of different groups.
    bool differs_in_group(HalfedgeHandle half) const
    {
        const auto group_at = [this](HalfedgeHandle side) {
            return soup_.face_groups[soup_face_[static_cast<std::size_t>(mesh_.face_handle(side).idx())]];
        };
        return !soup_.face_groups.empty() &&
               group_at(half) != group_at(HalfedgeHandle(mesh_.opposite_halfedge_handle(half).idx()));
    }

    void mark_features()
    {
        const double cosine = std::cos(options_.crease_deg * std::numbers::pi / 180.0);
        std::vector<std::uint32_t> ends(soup_.vertices.size(), 0); ///< features that end in the vertex
        for (const auto edge : mesh_.edges()) {
            const HalfedgeHandle half{mesh_.halfedge_handle(edge, 0).idx()};
            bool feature = mesh_.is_boundary(edge);
            if (!feature) {
                const auto other = mesh_.opposite_halfedge_handle(half);
                feature = (mesh_.normal(mesh_.face_handle(half)) | mesh_.normal(mesh_.face_handle(other))) <
                              cosine ||
                          parted(half) || differs_in_group(half);
            }
            mesh_.status(edge).set_feature(feature);
            if (feature)
                for (const VertexHandle end : {mesh_.from_vertex_handle(half), mesh_.to_vertex_handle(half)})
                    ++ends[static_cast<std::size_t>(end.idx())];
        }
        for (const auto vertex : mesh_.vertices()) {
            const std::uint32_t count = ends[static_cast<std::size_t>(vertex.idx())];
            mesh_.status(vertex).set_feature(count > 0);
            mesh_.status(vertex).set_locked(count == 1 || count > 2);
        }
        for (const std::uint32_t f : aside_)
            for (const std::uint32_t v : soup_.faces[f])
                mesh_.status(VertexHandle(static_cast<int>(v))).set_locked(true);
    }

    void decimate(double error_mm, std::size_t faces)
    {
        using namespace OpenMesh::Decimater;
        DecimaterT<HalfEdgeMesh> decimater(mesh_);
        ModQuadricT<HalfEdgeMesh>::Handle quadric;
        ModNormalFlippingT<HalfEdgeMesh>::Handle flipping;
        ModAspectRatioT<HalfEdgeMesh>::Handle aspect;
        ModHausdorffT<HalfEdgeMesh>::Handle distance;
        ModLineT<HalfEdgeMesh>::Handle line;
        ModNearT<HalfEdgeMesh>::Handle near;
        decimater.add(quadric);
        decimater.add(flipping);
        decimater.add(aspect);
        decimater.add(line);
        decimater.module(quadric).unset_max_err();
        decimater.module(flipping).set_max_normal_deviation(static_cast<float>(options_.normal_deg));
        decimater.module(aspect).set_aspect_ratio(static_cast<float>(options_.aspect));
        decimater.module(line).set_bound(error_mm);
        if (error_mm > 0) {
            decimater.add(distance);
            decimater.module(distance).set_tolerance(error_mm);
            decimater.add(near);
            decimater.module(near).set_bound(tree_, error_mm);
        }
        if (decimater.initialize())
            decimater.decimate_to_faces(0, faces);
    }

    const Soup& soup_;
    const fdh::TriangleTree<14>& tree_;
    const SimplifyOptions& options_;
    HalfEdgeMesh mesh_;
    std::vector<FaceHandle> face_of_;      ///< per face of the soup
    std::vector<std::uint32_t> soup_face_; ///< per face of the half-edge mesh
    std::vector<std::uint32_t> aside_;
};

/// Of corners of the soup at the vertex, the normal that fits a face best.
class NormalsAt {
  public:
    explicit NormalsAt(const Soup& soup) : soup_(soup), first_(soup.vertices.size() + 1, 0)
    {
        for (const Triple& face : soup.faces)
            for (const std::uint32_t v : face)
                ++first_[v + 1];
        for (std::size_t v = 0; v + 1 < first_.size(); ++v)
            first_[v + 1] += first_[v];
        corners_.resize(3 * soup.faces.size());
        std::vector<std::uint32_t> next(first_.begin(), first_.end() - 1);
        for (std::size_t f = 0; f < soup.faces.size(); ++f)
            for (std::size_t i = 0; i < 3; ++i)
                corners_[next[soup.faces[f][i]]++] = soup.face_normals[f][i];
    }
    std::uint32_t best(std::uint32_t vertex, const Vec3& face_normal) const
    {
        std::uint32_t best = corners_[first_[vertex]];
        for (std::uint32_t i = first_[vertex]; i < first_[vertex + 1]; ++i)
            if (dot(soup_.normals[corners_[i]], face_normal) > dot(soup_.normals[best], face_normal))
                best = corners_[i];
        return best;
    }

  private:
    const Soup& soup_;
    std::vector<std::uint32_t> first_, corners_; ///< normals at vertex v: corners_[first_[v]] ...
};

std::vector<Triple> normals_of(const Soup& soup, const std::vector<Triple>& faces,
                               const std::vector<std::uint32_t>& faces_from)
{
    const NormalsAt normals(soup);
    std::vector<Triple> out(faces.size());
    for (std::size_t f = 0; f < faces.size(); ++f) {
        const Triple &now = faces[f], &before = soup.faces[faces_from[f]];
        const Vec3& a = soup.vertices[now[0]];
        const Vec3 normal = cross(subtract(soup.vertices[now[1]], a), subtract(soup.vertices[now[2]], a));
        for (std::size_t i = 0; i < 3; ++i) {
            const std::uint32_t j = corner_of(before, now[i]);
            out[f][i] =
                before[j] == now[i] ? soup.face_normals[faces_from[f]][j] : normals.best(now[i], normal);
        }
    }
    return out;
}

double distance_mm(const Mesh& before, const fdh::TriangleTree<14>& tree, const std::vector<Triple>& faces)
{
    Mesh after;
    after.vertices = before.vertices;
    after.faces = faces;
    const auto after_tree = fdh::TriangleTree<14>::build({after.vertices, after.faces});
    const std::size_t samples = std::min(samples_max, samples_per_face * before.faces.size());
    return std::max(one_sided_hausdorff_mm(before, after, after_tree, samples),
                    one_sided_hausdorff_mm(after, before, tree, samples));
}

} // namespace

SimplifyResult simplify(Soup& soup, const SimplifyOptions& options)
{
    SimplifyResult result;
    Mesh before;
    before.vertices = soup.vertices;
    before.faces = soup.faces;
    const auto tree = fdh::TriangleTree<14>::build({before.vertices, before.faces});
    std::vector<Triple> faces;
    std::vector<std::uint32_t> faces_from;
    double bound_mm = options.error_mm;
    for (int run = 1;; ++run) {
        result.faces_aside = Simplification(soup, tree, options).run(bound_mm, faces, faces_from);
        result.error_mm = distance_mm(before, tree, faces);
        if (!(options.error_mm > 0) || result.error_mm <= options.error_mm)
            break;
        if (run == runs_max) { // nothing done is within every bound
            result.error_mm = 0;
            return result;
        }
        bound_mm *= 0.9 * options.error_mm / result.error_mm;
    }
    result.faces_removed = soup.faces.size() - faces.size();
    soup.face_normals = normals_of(soup, faces, faces_from);
    soup.faces = std::move(faces);
    soup.smoothing.clear();
    for (std::size_t f = 0; f < faces_from.size() && !soup.face_groups.empty(); ++f)
        soup.face_groups[f] = soup.face_groups[faces_from[f]];
    soup.face_groups.resize(soup.face_groups.empty() ? 0 : faces_from.size());
    return result;
}

} // namespace phantom::mesh
