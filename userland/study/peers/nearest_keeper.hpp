// SPDX-License-Identifier: GPL-2.0-or-later
// The 64 nearest of the triangles that a library finds near enough. No library here keeps them itself or
// knows more than boxes, so distance and choice are ours, and as quick as they can be made one triangle at a
// time, since their time is charged to it: a buffer, thinned out by a selection without branches when it is
// full.
#pragma once

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <vector>

#include "study/peers/contender.hpp"
#include "study/peers/triangle_distance.hpp"

namespace phantom::peers {

class NearestKeeper {
  public:
    void start(const Mesh& mesh, const fdh::Point& p, double radius)
    {
        points_ = mesh.points.data();
        triangles_ = mesh.triangles.data();
        p_ = {static_cast<float>(p[0]), static_cast<float>(p[1]), static_cast<float>(p[2])};
        size_ = 0;
        bound2_ = static_cast<float>(radius) * static_cast<float>(radius);
    }

    /// True if the bound shrank.
    bool offer(std::uint32_t triangle)
    {
        const fdh::Triangle& t = triangles_[triangle];
        const float distance2 = squared_distance(p_, as_vector(points_[t[0]]), as_vector(points_[t[1]]),
                                                 as_vector(points_[t[2]]));
        if (!(distance2 <= bound2_))
            return false;
        // Floats that are not negative sort as their bits do.
        kept_[size_++] = std::uint64_t{std::bit_cast<std::uint32_t>(distance2)} << 32 | triangle;
        if (size_ < capacity)
            return false;
        select();
        return true;
    }

    /// Leaves the 64 nearest, unsorted.
    void finish()
    {
        if (size_ > wanted)
            select();
    }

    /// Squared distance beyond which nothing is wanted.
    [[nodiscard]] float bound2() const { return bound2_; }

    void distances(std::vector<double>& out) const
    {
        out.clear();
        for (std::size_t i = 0; i < size_; ++i)
            out.push_back(std::sqrt(double{distance2_of(kept_[i])}));
    }

  private:
    static constexpr std::size_t capacity = 2 * wanted;

    static float distance2_of(std::uint64_t key)
    {
        return std::bit_cast<float>(static_cast<std::uint32_t>(key >> 32));
    }

    /// Brings the 64 smallest to the front (quickselect; Lomuto's partition without branches).
    void select()
    {
        std::size_t low = 0, high = size_; // the 64th lies in [low, high)
        while (high - low > 1) {
            const std::uint64_t a = kept_[low], b = kept_[(low + high) / 2], c = kept_[high - 1];
            const std::uint64_t pivot = std::max(std::min(a, b), std::min(std::max(a, b), c));
            std::size_t below = low;
            for (std::size_t i = low; i < high; ++i) {
                const std::uint64_t key = kept_[i];
                kept_[i] = kept_[below];
                kept_[below] = key;
                below += key < pivot;
            }
            if (below == wanted)
                break;
            if (below > wanted)
                high = below;
            else if (below > low)
                low = below;
            else
                low = move_equal(low, high, pivot);
            if (low >= wanted)
                break;
        }
        size_ = wanted;
        bound2_ = distance2_of(*std::max_element(kept_, kept_ + wanted));
    }

    /// Nothing is below the pivot: what equals it goes to the front. Returns where the rest begins.
    std::size_t move_equal(std::size_t low, std::size_t high, std::uint64_t pivot)
    {
        for (std::size_t i = low; i < high; ++i)
            if (kept_[i] == pivot)
                std::swap(kept_[i], kept_[low++]);
        return low;
    }

    const std::array<float, 4>* points_ = nullptr;
    const fdh::Triangle* triangles_ = nullptr;
    FloatVector p_{};
    std::uint64_t kept_[capacity];
    std::size_t size_ = 0;
    float bound2_ = 0;
};

} // namespace phantom::peers
