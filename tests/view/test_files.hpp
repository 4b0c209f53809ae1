// SPDX-License-Identifier: GPL-2.0-or-later
// Scenes and traces that tests make.
#pragma once

#include <string>

namespace phantom::view::test {

/// A sphere of 30 mm radius round the origin as OFF, of about 5,000 triangles.
std::string sphere_off();

/// A trace of a stroke over that sphere's side to the viewer, at a height between 0.2 and 1.2 mm, with the
/// exact force of R = 1 mm and k = 1 N/mm.
std::string sphere_trace();

} // namespace phantom::view::test
