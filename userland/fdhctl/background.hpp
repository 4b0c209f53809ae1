// SPDX-License-Identifier: GPL-2.0-or-later
// Going to the background once it is known that the work has begun well.
#pragma once

#include <sys/types.h>

#include "base/result.hpp"
#include "feeder/file_descriptor.hpp"

namespace phantom::fdhctl {

/// fork() comes before any thread; the parent waits until the child detaches or ends.
class Background {
  public:
    /// In the foreground: detach() does nothing.
    Background() = default;
    static Result<Background> fork();

    [[nodiscard]] bool is_parent() const { return child_ > 0; }
    /// Parent: prints the child's process number when it detached; else its exit status.
    int wait_for_child();
    /// Child: leaves the terminal and lets the parent go.
    void detach();

  private:
    pid_t child_ = 0; ///< in the parent
    feeder::FileDescriptor pipe_;
};

} // namespace phantom::fdhctl
