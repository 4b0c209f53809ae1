// SPDX-License-Identifier: GPL-2.0-or-later
// Starts fdhread and takes what it sends. It lies beside the program that runs, or where $PHANTOM_FDHREAD
// says.
#include <fcntl.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <filesystem>

#include "mesh/formats.hpp"
#include "mesh/polygon_stream.hpp"

namespace phantom::mesh {

namespace {

/// The two ends of a pipe, closed with it.
struct Pipe {
    int read = -1, write = -1;
    Pipe()
    {
        int ends[2] = {-1, -1};
        if (::pipe2(ends, O_CLOEXEC) == 0) {
            read = ends[0];
            write = ends[1];
        }
    }
    ~Pipe()
    {
        close(read);
        close(write);
    }
    Pipe(const Pipe&) = delete;
    Pipe& operator=(const Pipe&) = delete;
    static void close(int& end)
    {
        if (end >= 0)
            ::close(end);
        end = -1;
    }
};

/// 0 or an errno. VTK's own words go nowhere: fdhread says what matters.
int start(const std::string& program, const std::string& file, int output, pid_t& process)
{
    posix_spawn_file_actions_t actions;
    ::posix_spawn_file_actions_init(&actions);
    ::posix_spawn_file_actions_addopen(&actions, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
    ::posix_spawn_file_actions_addopen(&actions, STDERR_FILENO, "/dev/null", O_WRONLY, 0);
    ::posix_spawn_file_actions_adddup2(&actions, output, STDOUT_FILENO);
    std::string name = program, argument = file;
    char* const words[] = {name.data(), argument.data(), nullptr};
    const int error = ::posix_spawn(&process, program.c_str(), &actions, nullptr, words, environ);
    ::posix_spawn_file_actions_destroy(&actions);
    return error;
}

std::string reader()
{
    // NOLINTNEXTLINE(concurrency-mt-unsafe): nobody sets it
    if (const char* chosen = std::getenv("PHANTOM_FDHREAD"))
        return chosen;
    std::error_code ignored;
    return (std::filesystem::read_symlink("/proc/self/exe", ignored).parent_path() / "fdhread").string();
}

std::string read_all(int from)
{
    std::string bytes;
    std::string part(1 << 20, '\0');
    for (;;) {
        const ssize_t got = ::read(from, part.data(), part.size());
        if (got < 0 && errno == EINTR)
            continue;
        if (got <= 0)
            return bytes;
        bytes.append(part, 0, static_cast<std::size_t>(got));
    }
}

int wait_for(pid_t process)
{
    int status = 0;
    while (::waitpid(process, &status, 0) < 0 && errno == EINTR) {
    }
    return status;
}

} // namespace

Result<PolygonSoup> read_vtk(const std::string& name)
{
    const std::string program = reader();
    if (::access(program.c_str(), X_OK) != 0)
        return Error{
            name, "needs " + program + ", which reads this format and is not there: it was built without VTK",
            "make all builds it"};
    Pipe pipe;
    if (pipe.read < 0)
        return Error{name, std::string("cannot be read: ") + std::strerror(errno)};
    pid_t process = 0;
    if (const int error = start(program, name, pipe.write, process); error != 0)
        return Error{name, program + " cannot be started: " + std::strerror(error)};
    Pipe::close(pipe.write);
    const std::string bytes = read_all(pipe.read);
    const int status = wait_for(process);
    if (WIFSIGNALED(status) && WTERMSIG(status) == SIGXCPU)
        return Error{name, "cannot be read: the reader did not come to an end (damaged file?)"};
    if (WIFSIGNALED(status))
        return Error{name, "cannot be read: the reader broke down over it (damaged file?)"};
    auto polygons = received_polygons(bytes);
    if (!polygons)
        return Error{name, polygons.error().what};
    return polygons;
}

} // namespace phantom::mesh
