// SPDX-License-Identifier: GPL-2.0-or-later
// How many threads VTK's filters run on. In a file of its own because g++ takes vtkSMPTools.h of VTK 9.1 up
// to C++17 only.
#include "study/peers/vtk_threads.hpp"

#include <vtkSMPTools.h>

namespace phantom::peers {

void set_vtk_threads(unsigned threads)
{
    vtkSMPTools::Initialize(static_cast<int>(threads));
}

} // namespace phantom::peers
