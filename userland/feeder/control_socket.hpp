// SPDX-License-Identifier: GPL-2.0-or-later
// The control socket: how `fdhctl status`, `rate`, `model`, `effect` and `stop` reach a running session.
//
//   ${XDG_RUNTIME_DIR}/phantom_rt0.sock, or /tmp/phantom_rt-UID/phantom_rt0.sock (folder 0700)
//
// One line of JSON asks, one line answers, then the connection ends:
//   {"command": "status"}                        -> {"ok": true, ...}
//   {"command": "rate", "rate_hz": 3000}         -> {"ok": true}
//   {"command": "model", "model": "paper", ...}  -> {"ok": true, ...}
//   {"command": "effect"}                        -> {"ok": true, "effects": [{"name": "honey", ...}, ...]}
//   {"command": "effect", "name": "honey", "on": false}                 -> {"ok": true, "effect": {...}}
//   {"command": "effect", "name": "honey", "set": {"radius_mm": "9"}}   -> {"ok": true, "effect": {...}}
//   {"command": "stop"}                          -> {"ok": true, "pid": 123}
//   anything else                                -> {"ok": false, "error": "a sentence"}
//
// A file lock beside the socket says who runs: the system takes it back when the process dies, so a socket
// file that a crash left behind is recognised and replaced.
#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <string>

#include <sys/types.h>

#include "base/result.hpp"

namespace phantom::feeder::control {

/// The longest line either side accepts, in bytes.
inline constexpr std::size_t line_max = 65536;

/// Where socket and lock are; makes the folder if it must. Fails when the folder is somebody else's.
Result<std::filesystem::path> folder();

/// Sends one line and returns the answer's line. Fails with a sentence when nobody listens.
Result<std::string> request(const std::string& line);

/// Process number of the session that runs, 0 when there is none.
pid_t running_pid();

/// The right to be the one session. Held until destroyed.
class Lock {
  public:
    /// Fails when a session runs, and says which.
    static Result<Lock> take();
    Lock(Lock&& other) noexcept;
    Lock& operator=(Lock&& other) noexcept;
    ~Lock();

  private:
    explicit Lock(int fd) : fd_(fd) {}
    int fd_ = -1;
};

/// Answers requests in a thread of its own until destroyed.
class Server {
  public:
    using Handler = std::function<std::string(const std::string& line)>;
    /// Only with the Lock held: a socket file that is there is a dead one.
    static Result<Server> listen(Handler handler);
    Server(Server&&) noexcept;
    Server& operator=(Server&&) noexcept;
    ~Server();

  private:
    struct Impl;
    explicit Server(std::unique_ptr<Impl> impl);
    std::unique_ptr<Impl> impl_;
};

} // namespace phantom::feeder::control
