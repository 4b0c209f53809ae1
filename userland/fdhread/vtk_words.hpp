// SPDX-License-Identifier: GPL-2.0-or-later
// VTK's errors, which it prints wherever they happen, caught in one place.
#pragma once

#include <string>

#include <vtkOutputWindow.h>

namespace phantom::fdhread {

/// Takes the place of VTK's own output for the whole program; prints nothing.
class VtkWords : public vtkOutputWindow {
  public:
    static VtkWords* New();
    vtkTypeMacro(VtkWords, vtkOutputWindow);

    void DisplayText(const char*) override {}
    void DisplayWarningText(const char*) override {}
    void DisplayErrorText(const char* text) override;

    /// The first error in a line, without VTK's source position and object; empty when there was none.
    [[nodiscard]] const std::string& first_error() const { return first_error_; }

  private:
    std::string first_error_;
};

} // namespace phantom::fdhread
