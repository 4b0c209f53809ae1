// SPDX-License-Identifier: GPL-2.0-or-later
#include "view/display.hpp"

#include <array>
#include <cerrno>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <utility>

#include <fcntl.h>
#include <poll.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <X11/Xlib.h>
#undef Status // a macro of Xlib's, a type of ours

#include <fmt/format.h>

namespace phantom::view {

namespace {

constexpr int start_timeout_ms = 20000; ///< Xvfb needs 0.1 s; a loaded CI machine far longer
constexpr int exec_failed = 127;
constexpr const char* install_xvfb = "sudo apt install xvfb";

/// Whether VTK can draw on the environment's display; if not, `why` says what is missing.
bool environment_display_works(std::string& why)
{
    const char* name = std::getenv("DISPLAY");
    if (name == nullptr || *name == '\0') {
        why = "there is no X display (DISPLAY is not set)";
        return false;
    }
    ::Display* display = XOpenDisplay(nullptr);
    if (display == nullptr) {
        why = fmt::format("the X display {} cannot be opened", name);
        return false;
    }
    int opcode = 0, event = 0, error = 0;
    const bool glx = XQueryExtension(display, "GLX", &opcode, &event, &error) != 0;
    XCloseDisplay(display);
    if (!glx)
        why = fmt::format("the X display {} has no GLX (OpenGL)", name);
    return glx;
}

/// In the forked child: becomes Xvfb, or leaves with exec_failed.
[[noreturn]] void become_server(int number_fd, pid_t parent, const std::string& screen,
                                const std::string& fd_text)
{
    // Even when VTK aborts us or somebody kills us, the server must not stay behind.
    prctl(PR_SET_PDEATHSIG, SIGTERM);
    if (getppid() != parent)
        _exit(exec_failed);
    // Ctrl-C on the terminal is ours to handle; the server goes when we are done with it.
    setpgid(0, 0);
    const int null = open("/dev/null", O_RDWR | O_CLOEXEC);
    for (int fd : {0, 1, 2})
        dup2(null, fd);
    fcntl(number_fd, F_SETFD, 0);
    execlp("Xvfb", "Xvfb", "-displayfd", fd_text.c_str(), "-screen", "0", screen.c_str(), "+extension", "GLX",
           "-nolisten", "tcp", "-noreset", static_cast<char*>(nullptr));
    _exit(exec_failed);
}

/// The display number that the server writes once it listens, or empty.
std::string read_number(int fd)
{
    std::string text;
    pollfd ready{fd, POLLIN, 0};
    while (text.find('\n') == std::string::npos) {
        const int events = poll(&ready, 1, start_timeout_ms);
        if (events < 0 && errno == EINTR)
            continue;
        std::array<char, 16> buffer{};
        const ssize_t size = events > 0 ? read(fd, buffer.data(), buffer.size()) : 0;
        if (size <= 0)
            return {};
        text.append(buffer.data(), static_cast<std::size_t>(size));
    }
    return text.substr(0, text.find('\n'));
}

/// Whether the child is gone for want of the program. Its pipe closes a little before it can be reaped.
bool exec_has_failed(pid_t server)
{
    for (int wait_ms = 0; wait_ms < 500; wait_ms += 10) {
        int status = 0;
        if (waitpid(server, &status, WNOHANG) == server)
            return WIFEXITED(status) && WEXITSTATUS(status) == exec_failed;
        poll(nullptr, 0, 10);
    }
    return false;
}

} // namespace

Result<Display> Display::acquire(Need need, int width, int height)
{
    std::string why;
    if (environment_display_works(why))
        return Display(0);
    if (need == Need::window)
        return Error{"fdhview", why, "for a picture without a display use --screenshot FILE.png"};
    return start_private(width, height);
}

Result<Display> Display::start_private(int width, int height)
{
    std::array<int, 2> pipe_ends{};
    if (pipe2(pipe_ends.data(), O_CLOEXEC) != 0)
        return Error{"Xvfb", fmt::format("no pipe: {}", std::strerror(errno))};
    const std::string screen = fmt::format("{}x{}x24", width, height);
    const std::string fd_text = std::to_string(pipe_ends[1]);
    const pid_t parent = getpid();
    const pid_t server = fork();
    if (server == 0)
        become_server(pipe_ends[1], parent, screen, fd_text);
    close(pipe_ends[1]);
    if (server < 0) {
        close(pipe_ends[0]);
        return Error{"Xvfb", fmt::format("no process: {}", std::strerror(errno))};
    }
    Display display(server);
    const std::string number = read_number(pipe_ends[0]);
    close(pipe_ends[0]);
    if (number.empty()) {
        if (exec_has_failed(server)) {
            display.server_ = 0;
            return Error{"fdhview", "no X display, and Xvfb is not installed to draw without one",
                         install_xvfb};
        }
        return Error{"fdhview", "no X display, and Xvfb does not start", "run Xvfb :99 to see why"};
    }
    setenv("DISPLAY", (":" + number).c_str(), 1);
    // Software rendering takes every core it finds. The servo's thread in this process needs one.
    setenv("LP_NUM_THREADS", "1", 0);
    return display;
}

Display::Display(Display&& other) noexcept : server_(std::exchange(other.server_, 0)) {}

Display& Display::operator=(Display&& other) noexcept
{
    std::swap(server_, other.server_);
    return *this;
}

Display::~Display()
{
    if (server_ <= 0)
        return;
    kill(server_, SIGTERM);
    while (waitpid(server_, nullptr, 0) < 0 && errno == EINTR) {
    }
}

} // namespace phantom::view
