// SPDX-License-Identifier: GPL-2.0-or-later
#include "fdh/split.hpp"

#include <algorithm>
#include <cstddef>
#include <limits>
#include <utility>

#include "fdh/parallel.hpp"

namespace phantom::fdh {

namespace {

typedef float Float4 __attribute__((vector_size(16)));
typedef std::int32_t Int4 __attribute__((vector_size(16)));

constexpr float infinity = std::numeric_limits<float>::infinity();

Float4 min(Float4 a, Float4 b)
{
    return a < b ? a : b;
}
Float4 max(Float4 a, Float4 b)
{
    return a > b ? a : b;
}
/// Three coordinates and a zero, for what stands there is no number.
Float4 load(const void* address)
{
    constexpr Int4 coordinates = {-1, -1, -1, 0};
    Int4 v;
    __builtin_memcpy(&v, address, sizeof v);
    return Float4(v & coordinates);
}
Float4 low_of(const PrimitiveBox& box)
{
    return load(&box);
}
Float4 high_of(const PrimitiveBox& box)
{
    return load(reinterpret_cast<const char*>(&box) + offsetof(PrimitiveBox, high));
}

struct Box {
    Float4 low = {infinity, infinity, infinity, infinity};
    Float4 high = {-infinity, -infinity, -infinity, -infinity};

    void grow(Float4 l, Float4 h)
    {
        low = min(low, l);
        high = max(high, h);
    }
    /// Half the surface, a step thicker than the box is: flat boxes, lines and points are not free.
    [[nodiscard]] float area() const
    {
        constexpr float step = 1;
        const float x = high[0] - low[0] + step, y = high[1] - low[1] + step, z = high[2] - low[2] + step;
        return x * (y + z) + y * z;
    }
};

/// Of a set of primitives.
struct Bounds {
    Box box;
    Box centres; ///< of twice the primitives' centres: the factor cancels

    void add(const PrimitiveBox& primitive)
    {
        const Float4 low = low_of(primitive), high = high_of(primitive), centre = low + high;
        box.grow(low, high);
        centres.grow(centre, centre);
    }
};

/// An inner node of the binary tree, stored at the index where its range is split: no two nodes share it, so
/// threads write without a lock and the result does not depend on them. 0 stands for a leaf.
struct BinaryNode {
    std::uint32_t left, right; ///< where the children are split
    /// How best to make of this subtree a forest of i + 1 trees: so many of them from the left child, the
    /// others from the right; 0: one tree less is no worse. The last entry is for the children of a node made
    /// of this one.
    std::uint8_t from_left[lanes];
};

/// A subtree of the binary tree and what the best eight-wide forest of i + 1 trees made of it costs.
struct Subtree {
    std::uint32_t split = 0; ///< 0: a leaf
    float cost[lanes - 1] = {};
};

class Splitter {
  public:
    Splitter(std::span<PrimitiveBox> boxes, unsigned leaf_size)
        : boxes_(boxes), leaf_size_(leaf_size), nodes_(boxes.size())
    {
    }

    /// Splits all down to the leaves.
    Subtree divide(unsigned threads)
    {
        const auto count = static_cast<std::uint32_t>(boxes_.size());
        return divide(0, count, bounds(0, count), 0, threads);
    }

    Shape collapse(std::uint32_t root)
    {
        Shape shape;
        shape.nodes.reserve(boxes_.size() / (4 * leaf_size_) + 1);
        emit(shape, {0, static_cast<std::uint32_t>(boxes_.size()), root});
        return shape;
    }

  private:
    static constexpr int most_bins = 16;

    struct Bins {
        Box box[3];
        std::uint32_t count[3] = {};
    };
    struct Range {
        std::uint32_t begin, end, split;
    };
    struct Cut {
        float cost = infinity;
        int axis = -1, bin = 0; ///< bins up to and including `bin` go left
    };
    /// Where a range was split, and the bounds of the two parts.
    struct Halves {
        std::uint32_t middle = 0; ///< 0: not split
        Bounds left, right;
    };

    [[nodiscard]] Bounds bounds(std::uint32_t begin, std::uint32_t end) const
    {
        Bounds result;
        for (std::uint32_t i = begin; i < end; i++)
            result.add(boxes_[i]);
        return result;
    }

    Subtree divide(std::uint32_t begin, std::uint32_t end, const Bounds& bounds, int depth, unsigned threads)
    {
        const std::uint32_t count = end - begin;
        if (count <= leaf_size_)
            return {};
        Halves halves;
        if (depth < balanced_depth)
            halves = partition(begin, end, bounds.centres);
        if (halves.middle == 0)
            halves = halve(begin, end, bounds.centres);
        const std::uint32_t middle = halves.middle;
        Subtree left, right;
        auto go_left = [&, this] { left = divide(begin, middle, halves.left, depth + 1, threads / 2); };
        auto go_right = [&, this] {
            right = divide(middle, end, halves.right, depth + 1, threads - threads / 2);
        };
        constexpr std::uint32_t worth_a_thread = 8192;
        if (threads > 1 && count > worth_a_thread) {
            fork_join(go_left, go_right);
        } else {
            go_left();
            go_right();
        }
        return join(middle, bounds.box.area(), left, right);
    }

    /// Notes the node and how it is best collapsed. A node costs as much as it is likely to be visited: its
    /// surface. The leaves are what they are.
    Subtree join(std::uint32_t middle, float area, const Subtree& left, const Subtree& right)
    {
        BinaryNode& node = nodes_[middle];
        node.left = left.split;
        node.right = right.split;
        Subtree result;
        result.split = middle;
        float shared[lanes]; // cost of i + 1 trees, none of which contains both children
        for (int trees = 2; trees <= lanes; trees++) {
            float best = infinity;
            for (int k = 1; k < trees; k++) {
                const float cost = left.cost[k - 1] + right.cost[trees - k - 1];
                if (cost < best) {
                    best = cost;
                    node.from_left[trees - 1] = static_cast<std::uint8_t>(k);
                }
            }
            shared[trees - 1] = best;
        }
        node.from_left[0] = 0;
        result.cost[0] = shared[lanes - 1] + area;
        for (int i = 1; i < lanes - 1; i++) {
            const bool fewer = result.cost[i - 1] < shared[i];
            result.cost[i] = fewer ? result.cost[i - 1] : shared[i];
            if (fewer)
                node.from_left[i] = 0;
        }
        return result;
    }

    /// Leaves a range of this size fills, as a cost: full leaves are cheap.
    [[nodiscard]] float leaves(std::uint32_t count) const
    {
        const std::uint32_t rounded_up = (count + leaf_size_ - 1) / leaf_size_;
        return static_cast<float>(rounded_up);
    }

    void fill(Bins* bins, std::uint32_t begin, std::uint32_t end, Float4 origin, Float4 scale, int last) const
    {
        const Int4 top = {last, last, last, 0};
        for (std::uint32_t i = begin; i < end; i++) {
            const Float4 low = low_of(boxes_[i]), high = high_of(boxes_[i]);
            Int4 bin = __builtin_convertvector((low + high - origin) * scale, Int4);
            bin = bin < top ? bin : top;
            for (int axis = 0; axis < 3; axis++) {
                bins[bin[axis]].box[axis].grow(low, high);
                bins[bin[axis]].count[axis]++;
            }
        }
    }

    /// The cheapest cut along one axis: sweeps from the right for the costs there, then from the left.
    void sweep(const Bins* bins, int axis, int last, Cut& best) const
    {
        float right_cost[most_bins];
        Box box;
        std::uint32_t count = 0;
        for (int b = last; b > 0; b--) {
            box.grow(bins[b].box[axis].low, bins[b].box[axis].high);
            count += bins[b].count[axis];
            right_cost[b] = count ? box.area() * leaves(count) : infinity;
        }
        box = {};
        count = 0;
        for (int b = 0; b < last; b++) {
            box.grow(bins[b].box[axis].low, bins[b].box[axis].high);
            count += bins[b].count[axis];
            const float cost = count ? box.area() * leaves(count) + right_cost[b + 1] : infinity;
            if (cost < best.cost)
                best = {cost, axis, b};
        }
    }

    /// Splits by the heuristic, unless it knows no split (all centres in one place).
    Halves partition(std::uint32_t begin, std::uint32_t end, const Box& centres)
    {
        const std::uint32_t count = end - begin;
        const int bin_count = count > 256 ? most_bins : most_bins / 2;
        const Float4 origin = centres.low, extent = centres.high - centres.low;
        Float4 scale{};
        for (int axis = 0; axis < 3; axis++)
            if (extent[axis] > 0)
                scale[axis] = static_cast<float>(bin_count) / extent[axis];
        Bins bins[most_bins];
        fill(bins, begin, end, origin, scale, bin_count - 1);
        Cut best;
        for (int axis = 0; axis < 3; axis++)
            if (extent[axis] > 0)
                sweep(bins, axis, bin_count - 1, best);
        if (best.axis < 0)
            return {};
        const int axis = best.axis;
        return arrange(begin, end, [&](const PrimitiveBox& b) {
            const float place = (b.low[axis] + b.high[axis] - origin[axis]) * scale[axis];
            return std::min(static_cast<int>(place), bin_count - 1) <= best.bin;
        });
    }

    /// Moves those that go left to the front.
    template <class GoesLeft>
    Halves arrange(std::uint32_t begin, std::uint32_t end, const GoesLeft& goes_left)
    {
        Halves result;
        std::uint32_t i = begin, j = end;
        for (;;) {
            for (; i < j && goes_left(boxes_[i]); i++)
                result.left.add(boxes_[i]);
            for (; i < j && !goes_left(boxes_[j - 1]); j--)
                result.right.add(boxes_[j - 1]);
            if (i == j)
                break;
            std::swap(boxes_[i], boxes_[j - 1]);
        }
        result.middle = i == begin || i == end ? 0 : i;
        return result;
    }

    /// Splits by count, along the widest axis of the centres, at a whole number of leaves.
    Halves halve(std::uint32_t begin, std::uint32_t end, const Box& centres)
    {
        const Float4 extent = centres.high - centres.low;
        int axis = extent[1] > extent[0] ? 1 : 0;
        axis = extent[2] > extent[axis] ? 2 : axis;
        const std::uint32_t half = (end - begin) / 2;
        const std::uint32_t middle = begin + (half + leaf_size_ - 1) / leaf_size_ * leaf_size_;
        std::nth_element(boxes_.begin() + begin, boxes_.begin() + middle, boxes_.begin() + end,
                         [axis](const PrimitiveBox& a, const PrimitiveBox& b) {
                             const float x = a.low[axis] + a.high[axis], y = b.low[axis] + b.high[axis];
                             return x != y ? x < y : a.index < b.index;
                         });
        return {middle, bounds(begin, middle), bounds(middle, end)};
    }

    /// Appends the roots of the best forest of at most `trees` made of a range.
    void gather(Range range, int trees, Range* roots, int& count) const
    {
        const BinaryNode& node = nodes_[range.split];
        while (range.split != 0 && trees > 1 && node.from_left[trees - 1] == 0)
            trees--;
        if (range.split == 0 || trees == 1) {
            roots[count++] = range;
            return;
        }
        const int left = node.from_left[trees - 1];
        gather({range.begin, range.split, node.left}, left, roots, count);
        gather({range.split, range.end, node.right}, trees - left, roots, count);
    }

    /// Writes the node for a range, then those below it. Returns its index.
    std::uint32_t emit(Shape& shape, Range range)
    {
        Range children[lanes];
        int count = 0;
        if (range.split == 0)
            children[count++] = range; // a tree that is one leaf
        else
            gather(range, lanes, children, count);
        const auto index = static_cast<std::uint32_t>(shape.nodes.size());
        shape.nodes.emplace_back().count = count;
        for (int i = 0; i < count; i++) {
            const bool leaf = children[i].split == 0;
            const std::uint32_t reference = leaf ? shape.leaves++ | leaf_flag : emit(shape, children[i]);
            shape.nodes[index].children[i] = {children[i].begin, children[i].end, reference};
        }
        return index;
    }

    std::span<PrimitiveBox> boxes_;
    std::uint32_t leaf_size_;
    std::vector<BinaryNode> nodes_;
};

} // namespace

Shape split(std::span<PrimitiveBox> boxes, unsigned leaf_size, unsigned threads)
{
    if (boxes.empty())
        return {};
    Splitter splitter(boxes, leaf_size);
    const std::uint32_t root = splitter.divide(threads).split;
    return splitter.collapse(root);
}

} // namespace phantom::fdh
