// SPDX-License-Identifier: GPL-2.0-or-later
#include "feeder/control_socket.hpp"

#include <fcntl.h>
#include <poll.h>
#include <sys/file.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstdlib>
#include <cstring>

#include <fmt/format.h>

#include "feeder/control_line.hpp"
#include "feeder/file_descriptor.hpp"

namespace phantom::feeder::control {

namespace {

using std::chrono::steady_clock;

bool is_own_folder(const std::filesystem::path& path)
{
    struct stat info {};
    return ::lstat(path.c_str(), &info) == 0 && S_ISDIR(info.st_mode) && info.st_uid == ::geteuid();
}

pid_t pid_in(int fd)
{
    char text[32] = {};
    const ssize_t size = ::pread(fd, text, sizeof text - 1, 0);
    return size > 0 ? static_cast<pid_t>(std::strtol(text, nullptr, 10)) : 0;
}

} // namespace

Result<std::filesystem::path> folder()
{
    if (const char* runtime = std::getenv("XDG_RUNTIME_DIR"); runtime && is_own_folder(runtime))
        return std::filesystem::path(runtime);
    const std::filesystem::path own = fmt::format("/tmp/phantom_rt-{}", ::geteuid());
    if (::mkdir(own.c_str(), 0700) != 0 && errno != EEXIST)
        return Error{own.string(), fmt::format("cannot be made: {}", std::strerror(errno))};
    // In /tmp anybody may have been faster: a folder or link of somebody else's is not used.
    if (!is_own_folder(own))
        return Error{own.string(), "belongs to somebody else", "set XDG_RUNTIME_DIR to a folder of your own"};
    ::chmod(own.c_str(), 0700);
    return own;
}

Result<sockaddr_un> address_of(const std::filesystem::path& socket)
{
    sockaddr_un address{};
    address.sun_family = AF_UNIX;
    const std::string text = socket.string();
    if (text.size() >= sizeof address.sun_path)
        return Error{
            text,
            fmt::format("is longer than a socket's name may be ({} bytes)", sizeof address.sun_path - 1),
            "set XDG_RUNTIME_DIR to a shorter one"};
    std::memcpy(address.sun_path, text.c_str(), text.size() + 1);
    return address;
}

std::optional<std::string> receive_line(int fd, std::chrono::milliseconds timeout)
{
    const auto end = steady_clock::now() + timeout;
    std::string line;
    char chunk[4096];
    while (line.size() <= line_max) {
        const auto rest = std::chrono::ceil<std::chrono::milliseconds>(end - steady_clock::now());
        pollfd entry{fd, POLLIN, 0};
        if (rest.count() <= 0)
            return std::nullopt;
        const int ready = ::poll(&entry, 1, static_cast<int>(rest.count()));
        if (ready < 0 && errno == EINTR)
            continue;
        if (ready <= 0)
            return std::nullopt;
        const ssize_t size = ::recv(fd, chunk, sizeof chunk, 0);
        if (size < 0 && errno == EINTR)
            continue;
        if (size <= 0)
            return std::nullopt;
        line.append(chunk, static_cast<std::size_t>(size));
        if (const std::size_t newline = line.find('\n'); newline != std::string::npos) {
            line.resize(newline);
            return line;
        }
    }
    return std::nullopt;
}

bool send_line(int fd, const std::string& line)
{
    const std::string text = line + "\n";
    std::size_t sent = 0;
    while (sent < text.size()) {
        const ssize_t size = ::send(fd, text.data() + sent, text.size() - sent, MSG_NOSIGNAL);
        if (size < 0 && errno == EINTR)
            continue;
        if (size <= 0)
            return false;
        sent += static_cast<std::size_t>(size);
    }
    return true;
}

pid_t running_pid()
{
    const Result<std::filesystem::path> place = folder();
    if (!place)
        return 0;
    const FileDescriptor file(::open((*place / lock_name).c_str(), O_RDONLY | O_CLOEXEC));
    if (!file)
        return 0;
    // A shared lock is to be had only where nobody holds the exclusive one.
    if (::flock(file.get(), LOCK_SH | LOCK_NB) == 0)
        return 0;
    return pid_in(file.get());
}

Lock::Lock(Lock&& other) noexcept : fd_(std::exchange(other.fd_, -1)) {}

Lock& Lock::operator=(Lock&& other) noexcept
{
    std::swap(fd_, other.fd_);
    return *this;
}

Lock::~Lock()
{
    if (fd_ >= 0)
        ::close(fd_);
}

Result<Lock> Lock::take()
{
    const Result<std::filesystem::path> place = folder();
    if (!place)
        return place.error();
    const std::string file = (*place / lock_name).string();
    const int fd = ::open(file.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0600);
    if (fd < 0)
        return Error{file, fmt::format("cannot be written: {}", std::strerror(errno))};
    Lock lock(fd);
    // running_pid() of another process may hold the lock for a moment: ask again.
    constexpr int attempts = 20;
    for (int attempt = 0; ::flock(fd, LOCK_EX | LOCK_NB) != 0; ++attempt) {
        if (attempt == attempts)
            return Error{"", fmt::format("a session is running already (process {})", pid_in(fd)),
                         "fdhctl stop ends it"};
        ::usleep(5000);
    }
    const std::string text = fmt::format("{}\n", ::getpid());
    if (::ftruncate(fd, 0) != 0 || ::pwrite(fd, text.data(), text.size(), 0) < 0)
        return Error{file, fmt::format("cannot be written: {}", std::strerror(errno))};
    return lock;
}

} // namespace phantom::feeder::control
