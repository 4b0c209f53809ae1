// SPDX-License-Identifier: GPL-2.0-or-later
// An X display to draw on. Debian's VTK aborts the process when there is none, so this comes first.
#pragma once

#include <string>

#include <sys/types.h>

#include "base/result.hpp"

namespace phantom::view {

/// The display of the environment, or a private Xvfb that lives as long as this object. Destroy it
/// after every VTK window.
class Display {
  public:
    enum class Need {
        window,   ///< a person looks at it: only the environment's display will do
        offscreen ///< pictures only: a private one is started when there is none
    };
    /// Checks $DISPLAY, else starts Xvfb (width x height pixels, 24 bit) and sets $DISPLAY to it.
    /// Fails with one line: no display, a display without GLX, Xvfb not installed or not starting.
    static Result<Display> acquire(Need need, int width, int height);

    Display(Display&& other) noexcept;
    Display& operator=(Display&& other) noexcept;
    ~Display(); ///< ends the private server, if any

    [[nodiscard]] bool is_private() const { return server_ > 0; }

  private:
    explicit Display(pid_t server) : server_(server) {}
    static Result<Display> start_private(int width, int height);
    pid_t server_ = 0;
};

} // namespace phantom::view
