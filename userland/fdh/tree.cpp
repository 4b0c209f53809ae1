// SPDX-License-Identifier: GPL-2.0-or-later
#include "fdh/tree.hpp"

#include <cstdint>
#include <stdexcept>
#include <string>

#include "fdh/collector.hpp"
#include "fdh/parallel.hpp"
#include "fdh/region_search.hpp"
#include "fdh/tree_impl.hpp"

namespace phantom::fdh {

namespace {

void check_isa(Isa isa)
{
    if (!isa_available(isa))
        throw std::invalid_argument(std::string("fdh: this processor or build has no ") + isa_name(isa));
}

/// The elements that the bytes are, or nothing if they are none.
template <typename T>
std::optional<std::span<const T>> elements_of(std::span<const std::byte> bytes)
{
    if (bytes.size() % sizeof(T) != 0 || reinterpret_cast<std::uintptr_t>(bytes.data()) % alignof(T) != 0)
        return std::nullopt;
    return std::span(reinterpret_cast<const T*>(bytes.data()), bytes.size() / sizeof(T));
}

} // namespace

template <int K>
TriangleTree<K>::TriangleTree(std::shared_ptr<const Impl> impl) : impl_(std::move(impl))
{
}

template <int K>
TriangleTree<K> TriangleTree<K>::build(const MeshView& mesh, const BuildOptions& options)
{
    check_isa(options.isa);
    return TriangleTree(std::make_shared<const Impl>(
        build_tree<K>(mesh, thread_count(options.threads), options.isa), options.isa));
}

template <int K>
TriangleTree<K> TriangleTree<K>::refitted(const MeshView& mesh, const BuildOptions& options) const
{
    check_isa(options.isa);
    return TriangleTree(std::make_shared<const Impl>(
        refit_tree(impl_->data, mesh, thread_count(options.threads)), options.isa));
}

template <int K>
double TriangleTree<K>::spread() const
{
    return impl_->data.spread;
}

template <int K>
TreeImage TriangleTree<K>::image() const
{
    const TreeData<K>& data = impl_->data;
    return {data.grid.origin,
            data.grid.step,
            data.longest_edge,
            data.spread,
            data.triangles,
            std::as_bytes(data.nodes),
            std::as_bytes(data.leaves)};
}

template <int K>
std::optional<TriangleTree<K>> TriangleTree<K>::open(const TreeImage& image,
                                                     std::shared_ptr<const void> keeper, Isa isa)
{
    check_isa(isa);
    const auto nodes = elements_of<Node<K>>(image.nodes);
    const auto leaves = elements_of<Leaf>(image.leaves);
    if (!nodes || !leaves || !(image.step > 0) || image.triangles >= most_triangles)
        return std::nullopt;
    TreeData<K> data{{image.origin, image.step, 1 / image.step},
                     *nodes,
                     *leaves,
                     image.triangles,
                     image.longest_edge,
                     image.spread,
                     std::move(keeper)};
    if (!consistent(data))
        return std::nullopt;
    return TriangleTree(std::make_shared<const Impl>(std::move(data), isa));
}

template <int K>
void TriangleTree<K>::nearest(const Point& p, std::size_t count, double max_radius, Nearest& out) const
{
    if (!valid_query(p, max_radius)) {
        out.clear();
        return;
    }
    NearestCollector collector(out, count, max_radius);
    impl_->collect(p, 0, collector);
    collector.finish();
}

template <int K>
void TriangleTree<K>::within(const Point& p, double radius, std::vector<Hit>& out) const
{
    out.clear();
    if (!valid_query(p, radius))
        return;
    WithinCollector collector(out, radius);
    impl_->collect(p, 0, collector);
}

template <int K>
void TriangleTree<K>::along(const Point& from, const Point& to, double radius, std::vector<Hit>& out) const
{
    out.clear();
    if (valid_segment({from, to}, radius))
        search_along<K>(impl_->view, impl_->data.grid, {from, to}, radius, 0, out);
}

template <int K>
void TriangleTree<K>::in_box(const Box& box, std::vector<Hit>& out) const
{
    out.clear();
    if (valid_box(box))
        search_box<K>(impl_->view, impl_->data.grid, {}, box, 0, out);
}

template <int K>
double TriangleTree<K>::accuracy(const Point& p, double distance) const
{
    return impl_->error_from(impl_->data.grid.to_steps(p)).at(distance);
}

template <int K>
std::array<std::array<double, 2>, K / 2> TriangleTree<K>::hull() const
{
    constexpr auto directions = hull_directions<K>();
    const auto& data = impl_->data;
    std::array<std::array<double, 2>, K / 2> result;
    const Hull<K> hull = data.nodes.empty() ? Hull<K>::empty() : hull_of(data.nodes[0]);
    for (int k = 0; k < K / 2; k++) {
        double shift = 0, magnitude = 0;
        int terms = 0;
        for (int axis = 0; axis < 3; axis++) {
            shift += directions[k][axis] * data.grid.origin[axis];
            magnitude += std::abs(data.grid.origin[axis]) + Grid::half_extent_steps * data.grid.step;
            terms += std::abs(directions[k][axis]);
        }
        // Half a step of rounding per coordinate, and that of the sums here.
        const double slack = terms * 0.5001 * data.grid.step + Grid::arithmetic * magnitude;
        result[k] = {hull.low[k] * data.grid.step + shift - slack,
                     hull.high[k] * data.grid.step + shift + slack};
    }
    return result;
}

template <int K>
std::size_t TriangleTree<K>::triangles() const
{
    return impl_->data.triangles;
}

template <int K>
std::size_t TriangleTree<K>::bytes() const
{
    return sizeof(Impl) + impl_->data.nodes.size_bytes() + impl_->data.leaves.size_bytes();
}

template <int K>
Isa TriangleTree<K>::isa() const
{
    return impl_->isa;
}

template class TriangleTree<6>;
template class TriangleTree<14>;
template class TriangleTree<18>;
template class TriangleTree<26>;

} // namespace phantom::fdh
