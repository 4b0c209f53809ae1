// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

namespace phantom::peers {

void set_vtk_threads(unsigned threads);

} // namespace phantom::peers
