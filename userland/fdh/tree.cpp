// SPDX-License-Identifier: GPL-2.0-or-later
#include "fdh/tree.hpp"

#include <stdexcept>
#include <string>

#include "fdh/collector.hpp"
#include "fdh/parallel.hpp"
#include "fdh/tree_impl.hpp"

namespace phantom::fdh {

template <int K>
TriangleTree<K>::TriangleTree(std::unique_ptr<Impl> impl) : impl_(std::move(impl))
{
}
template <int K>
TriangleTree<K>::TriangleTree(TriangleTree&&) noexcept = default;
template <int K>
TriangleTree<K>& TriangleTree<K>::operator=(TriangleTree&&) noexcept = default;
template <int K>
TriangleTree<K>::~TriangleTree() = default;

template <int K>
TriangleTree<K> TriangleTree<K>::build(const MeshView& mesh, const BuildOptions& options)
{
    if (!isa_available(options.isa))
        throw std::invalid_argument(std::string("fdh: this processor or build has no ") +
                                    isa_name(options.isa));
    auto impl = std::make_unique<Impl>();
    impl->data = build_tree<K>(mesh, thread_count(options.threads));
    impl->isa = resolve_isa(options.isa);
    impl->kernels = &search_kernels<K>(impl->isa);
    return TriangleTree(std::move(impl));
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
    collector.finish();
}

template <int K>
double TriangleTree<K>::accuracy(const Point& p) const
{
    return impl_->data.grid.distance_error(impl_->data.grid.to_steps(p));
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
    return sizeof(Impl) + impl_->data.nodes.capacity() * sizeof(Node<K>) +
           impl_->data.leaves.capacity() * sizeof(Leaf);
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
