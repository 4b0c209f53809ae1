// SPDX-License-Identifier: GPL-2.0-or-later
// What buttons, wheel and keys do in the window: the left button moves the arm, the others the camera.
#pragma once

#include <string>

#include <vtkInteractorStyleTrackballCamera.h>

namespace phantom::view {

/// Who obeys. Positions in pixels of the window, from its lower left.
class MouseHandler {
  public:
    virtual ~MouseHandler() = default;
    virtual void press(int x, int y) = 0;
    virtual void drag(int x, int y) = 0;
    /// clicks > 0: into the picture, along the line of sight.
    virtual void push(double clicks) = 0;
    /// An X key name: "space", "q", ...
    virtual void key(const std::string& name) = 0;
};

class MouseStyle : public vtkInteractorStyleTrackballCamera {
  public:
    static MouseStyle* New();
    vtkTypeMacro(MouseStyle, vtkInteractorStyleTrackballCamera);

    void set_handler(MouseHandler* handler) { handler_ = handler; }

    void OnLeftButtonDown() override;
    void OnLeftButtonUp() override;
    void OnRightButtonDown() override;
    void OnRightButtonUp() override;
    void OnMiddleButtonDown() override;
    void OnMiddleButtonUp() override;
    void OnMouseMove() override;
    void OnMouseWheelForward() override;
    void OnMouseWheelBackward() override;
    void OnKeyPress() override;
    /// VTK's own keys (wireframe, exit, fly ...) are not wanted.
    void OnChar() override {}

  private:
    void wheel(double clicks);
    MouseHandler* handler_ = nullptr;
    bool holding_ = false;
};

} // namespace phantom::view
