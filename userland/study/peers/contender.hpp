// SPDX-License-Identifier: GPL-2.0-or-later
// The one interface that this project's hulls and every other library are measured through.
#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "study/peers/mesh.hpp"

namespace phantom::peers {

/// Triangles that every query asks for.
inline constexpr std::size_t wanted = 64;

/// One way to find the 64 nearest triangles. A mesh outlives the contender that was given it.
class Contender {
  public:
    Contender() = default;
    Contender(const Contender&) = delete;
    Contender& operator=(const Contender&) = delete;
    virtual ~Contender() = default;

    /// Names the row; unique.
    [[nodiscard]] virtual std::string name() const = 0;
    /// What it does, in a few words, for the reader of the table.
    [[nodiscard]] virtual std::string method() const = 0;
    /// Triangles beyond which it is left out (its memory or its building time goes out of bounds).
    [[nodiscard]] virtual std::size_t largest_mesh() const { return std::size_t{1} << 31; }

    /// What the library wants as input, made of the mesh; not measured. Drops what was built.
    virtual void prepare(const Mesh& mesh) = 0;
    /// Builds the hierarchy; measured. Drops an earlier one first, by itself or in prepare().
    virtual void build(unsigned threads) = 0;
    /// False if build() takes over what another contender built.
    [[nodiscard]] virtual bool builds() const { return true; }
    /// True if build() can use more than one thread.
    [[nodiscard]] virtual bool builds_parallel() const { return false; }
    /// Memory of the hierarchy [byte], without the mesh's own arrays.
    [[nodiscard]] virtual std::size_t bytes() const = 0;

    /// Finds the 64 nearest triangles within the radius; measured. The answer stays with the contender.
    virtual void query(const fdh::Point& p, double radius) = 0;
    /// Distances of the last answer's triangles, in no order.
    virtual void distances(std::vector<double>& out) const = 0;
    /// Leaves that the last query looked at, where that is known.
    [[nodiscard]] virtual std::optional<double> leaves() const { return std::nullopt; }

    /// True if refit() can be called.
    [[nodiscard]] virtual bool refits() const { return false; }
    /// True if refit() can use more than one thread.
    [[nodiscard]] virtual bool refits_parallel() const { return false; }
    /// What a refit on so many threads wants beforehand; not measured. `moved` has the triangles of the mesh
    /// and other vertices, and outlives the contender or its next prepare().
    virtual void prepare_refit(const Mesh& /*moved*/, unsigned /*threads*/) {}
    /// Takes the hierarchy to the moved vertices, its structure as it is; measured. May be called again.
    virtual void refit() {}
};

} // namespace phantom::peers
