// SPDX-License-Identifier: GPL-2.0-or-later
// Whether two answers to the same query are the same. Time counts only for right answers.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "base/result.hpp"
#include "fdh/hull.hpp"
#include "study/peers/mesh.hpp"

namespace phantom::peers {

/// How far two distances [mm] of the same triangle may differ: what the hull library promises of its grid
/// (`accuracy`, of both ends), and float arithmetic on coordinates relative to the point.
double tolerance_mm(double accuracy, double radius);

/// Compares the sorted distances of the 64 nearest; which triangle has which distance is open, as neighbours
/// that share a corner tie. Beyond the radius nothing counts: a triangle at its very end may be in one answer
/// and not in the other. Empty if they agree, otherwise what differs.
std::optional<std::string> disagreement(std::vector<double> answer, std::vector<double> expected,
                                        double radius, double tolerance);

/// The 64 smallest distances within the radius, of all triangles one by one.
std::vector<double> brute_force(const Mesh& mesh, const fdh::Point& p, double radius);

} // namespace phantom::peers
