// SPDX-License-Identifier: GPL-2.0-or-later
// A program run as a user runs it.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include <sys/types.h>

#include "temporary_folder.hpp"

namespace phantom::view::test {

struct Ended {
    int status = -1;        ///< exit status, or 128 + signal
    std::string out, error; ///< what it wrote
};

class Process {
  public:
    /// environment: variables to set; an empty value removes the variable.
    Process(const std::vector<std::string>& command, const std::map<std::string, std::string>& environment);
    Process(const Process&) = delete;
    Process& operator=(const Process&) = delete;
    ~Process(); ///< kills it if it still runs

    [[nodiscard]] pid_t pid() const { return pid_; }
    Ended wait();
    [[nodiscard]] bool running();

  private:
    TemporaryFolder folder_; ///< of its output
    pid_t pid_ = -1;
    std::optional<int> status_;
};

/// Runs to the end.
Ended run(const std::vector<std::string>& command,
          const std::map<std::string, std::string>& environment = {});

/// fdhview with a runtime folder of its own, so that tests do not meet a session of the user's.
std::vector<std::string> fdhview(const std::vector<std::string>& arguments);

/// Whether a program is on the PATH.
bool installed(const std::string& program);

} // namespace phantom::view::test
