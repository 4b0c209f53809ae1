// SPDX-License-Identifier: GPL-2.0-or-later
// This project's hulls as contenders.
#pragma once

#include <memory>
#include <vector>

#include "study/peers/contender.hpp"

namespace phantom::peers {

/// The name of the contender that goals are held against: FDH14, this machine's best instruction set.
inline constexpr const char* own_name = "FDH14";
/// The same with memory of its last answer.
inline constexpr const char* coherent_name = "FDH14 coherent";
/// The same with boxes for hulls.
inline constexpr const char* boxes_name = "FDH6";

/// FDH14 first, then coherent, then both with narrower instruction sets that this processor runs; FDH6, FDH18
/// and FDH26; fewer of them for meshes of tens of millions.
std::vector<std::unique_ptr<Contender>> own_contenders(const Mesh& mesh);

} // namespace phantom::peers
