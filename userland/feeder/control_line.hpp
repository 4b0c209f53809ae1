// SPDX-License-Identifier: GPL-2.0-or-later
// One line over a socket, and the address it goes to. Private to this folder.
#pragma once

#include <sys/un.h>

#include <chrono>
#include <filesystem>
#include <optional>
#include <string>

#include "base/result.hpp"

namespace phantom::feeder::control {

inline constexpr const char* socket_name = "phantom_rt0.sock";
inline constexpr const char* lock_name = "phantom_rt0.lock";

Result<sockaddr_un> address_of(const std::filesystem::path& socket);

/// Up to the newline, without it; nothing on end, error, timeout or a line longer than line_max.
std::optional<std::string> receive_line(int fd, std::chrono::milliseconds timeout);

/// line and a newline; false when the other side is gone.
bool send_line(int fd, const std::string& line);

} // namespace phantom::feeder::control
