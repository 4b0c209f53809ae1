// SPDX-License-Identifier: GPL-2.0-or-later
// Who is there to be measured.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "study/peers/contender.hpp"

namespace phantom::peers {

/// The name of the contender that ratios are against.
inline constexpr const char* yardstick = "Embree";

struct Absent {
    std::string name, why;
};

/// Everyone that this program was built with and that takes a mesh of this size, our own first, the yardstick
/// second; and who is missing.
struct Field {
    std::vector<std::unique_ptr<Contender>> contenders;
    std::vector<Absent> absent;
};
/// With `only`, ours first and of the others those that it names; a name that nobody has is an error.
Result<Field> field_for(const Mesh& mesh, const std::vector<std::string>& only = {});

// Each in a file of its own, which is built where its library is installed.
std::unique_ptr<Contender> make_embree();
std::unique_ptr<Contender> make_cgal();
std::unique_ptr<Contender> make_bullet();
std::unique_ptr<Contender> make_fcl();
std::unique_ptr<Contender> make_vtk();

} // namespace phantom::peers
