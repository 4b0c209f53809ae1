// SPDX-License-Identifier: GPL-2.0-or-later
#include "view/renderer_look.hpp"

#include <vtkLightKit.h>
#include <vtkNew.h>

namespace phantom::view {

void light(vtkRenderer* renderer)
{
    vtkNew<vtkLightKit> kit;
    kit->SetKeyLightIntensity(0.82);
    kit->SetKeyLightAngle(42, -28);
    kit->SetKeyToFillRatio(2.6);
    kit->SetKeyToBackRatio(3.2);
    kit->SetKeyToHeadRatio(3.4);
    kit->SetKeyLightWarmth(0.54);
    kit->SetFillLightWarmth(0.46);
    kit->AddLightsToRenderer(renderer);
}

void set_background(vtkRenderer* renderer, const Colour& bottom, const Colour& top)
{
    renderer->GradientBackgroundOn();
    renderer->SetBackground(bottom[0], bottom[1], bottom[2]);
    renderer->SetBackground2(top[0], top[1], top[2]);
}

} // namespace phantom::view
