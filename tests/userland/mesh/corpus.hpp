// SPDX-License-Identifier: GPL-2.0-or-later
// Meshes as people have them: sound ones, and every defect that tools and scanners leave. What holds of all
// of them after preparation is corpus_test.cpp.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "meshes.hpp"

namespace phantom::mesh::test {

struct Sample {
    std::string name; ///< letters and digits
    std::function<Soup()> make;
    PrepareOptions options{};
    /// What the report has to say beside the invariants; may be empty.
    std::function<void(const Report&)> expect{};
};

/// Closed surfaces: inside one another, touching, inside out, far away, tiny.
std::vector<Sample> solid_samples();
/// Defects of faces and vertices: holes, flips, duplicates, slivers, soups, numbers that are none.
std::vector<Sample> defect_samples();
/// Surfaces that do not fit together: junctions, cracks, fins, crossings, strips with one side.
std::vector<Sample> junction_samples();
/// Normals of the file: missing, zero, wrong, split at creases, by smoothing group.
std::vector<Sample> normal_samples();

/// Numbers from -1 to 1 that are the same everywhere: the distributions of <random> are not.
class Noise {
  public:
    explicit Noise(std::uint32_t seed) : random_(seed) {}
    double operator()() { return random_() / 2147483648.0 - 1; }
    Vec3 vector(double size)
    {
        const double x = (*this)(), y = (*this)(), z = (*this)();
        return {size * x, size * y, size * z};
    }
    bool one_in(std::uint32_t count) { return random_() % count == 0; }

  private:
    std::mt19937 random_;
};

} // namespace phantom::mesh::test
