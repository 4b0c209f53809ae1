// SPDX-License-Identifier: GPL-2.0-or-later
// What was measured, for machines and for readers.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "study/peers/measure.hpp"

namespace phantom::peers {

/// One row per mesh, contender and measure, under the header
/// mesh,triangles,contender,measure,unit,value.
std::string csv(std::span<const MeshFigures> meshes);

/// Markdown: the goals and whether each is met, then one table per mesh.
std::string tables(std::span<const MeshFigures> meshes);

/// SVG: median query time over the number of triangles, for walk and for jump.
std::string chart(std::span<const MeshFigures> meshes);

/// What this project has set itself, as one number per mesh.
struct Goal {
    std::string what;
    double goal = 0;
    std::optional<double> stretch;
    bool at_least = true;                       ///< or at most
    std::vector<std::optional<double>> figures; ///< one per mesh; nothing where it does not apply

    [[nodiscard]] bool meets(double figure, double bound) const
    {
        return at_least ? figure >= bound : figure <= bound;
    }
};
std::vector<Goal> goals(std::span<const MeshFigures> meshes);

} // namespace phantom::peers
