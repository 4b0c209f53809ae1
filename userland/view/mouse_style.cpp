// SPDX-License-Identifier: GPL-2.0-or-later
#include "view/mouse_style.hpp"

#include <vtkObjectFactory.h>
#include <vtkRenderWindowInteractor.h>
#include <vtkRenderer.h>

namespace phantom::view {

vtkStandardNewMacro(MouseStyle);

void MouseStyle::OnLeftButtonDown()
{
    const int* at = Interactor->GetEventPosition();
    vtkRenderer* poked = Interactor->FindPokedRenderer(at[0], at[1]);
    if (handler_ == nullptr || poked == nullptr || poked->GetInteractive() == 0 || State != VTKIS_NONE)
        return;
    holding_ = true;
    handler_->press(at[0], at[1]);
}

void MouseStyle::OnLeftButtonUp()
{
    holding_ = false;
}

void MouseStyle::OnRightButtonDown()
{
    FindPokedRenderer(Interactor->GetEventPosition()[0], Interactor->GetEventPosition()[1]);
    if (CurrentRenderer == nullptr || CurrentRenderer->GetInteractive() == 0)
        return;
    if (Interactor->GetShiftKey() != 0)
        StartPan();
    else
        StartRotate();
}

void MouseStyle::OnRightButtonUp()
{
    if (State == VTKIS_PAN)
        EndPan();
    else if (State == VTKIS_ROTATE)
        EndRotate();
}

void MouseStyle::OnMiddleButtonDown()
{
    FindPokedRenderer(Interactor->GetEventPosition()[0], Interactor->GetEventPosition()[1]);
    if (CurrentRenderer != nullptr && CurrentRenderer->GetInteractive() != 0)
        StartDolly();
}

void MouseStyle::OnMiddleButtonUp()
{
    if (State == VTKIS_DOLLY)
        EndDolly();
}

void MouseStyle::OnMouseMove()
{
    if (holding_ && handler_ != nullptr)
        handler_->drag(Interactor->GetEventPosition()[0], Interactor->GetEventPosition()[1]);
    else
        Superclass::OnMouseMove();
}

void MouseStyle::wheel(double clicks)
{
    if (handler_ != nullptr)
        handler_->push(clicks);
}

void MouseStyle::OnMouseWheelForward()
{
    if (Interactor->GetControlKey() != 0)
        Superclass::OnMouseWheelForward();
    else
        wheel(1);
}

void MouseStyle::OnMouseWheelBackward()
{
    if (Interactor->GetControlKey() != 0)
        Superclass::OnMouseWheelBackward();
    else
        wheel(-1);
}

void MouseStyle::OnKeyPress()
{
    const char* name = Interactor->GetKeySym();
    if (handler_ != nullptr && name != nullptr)
        handler_->key(name);
}

} // namespace phantom::view
