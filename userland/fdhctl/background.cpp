// SPDX-License-Identifier: GPL-2.0-or-later
#include "fdhctl/background.hpp"

#include <fcntl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstring>

#include "fdhctl/command_line.hpp"

namespace phantom::fdhctl {

Result<Background> Background::fork()
{
    int ends[2];
    if (::pipe2(ends, O_CLOEXEC) != 0)
        return Error{"", std::string("cannot go to the background: ") + std::strerror(errno)};
    feeder::FileDescriptor read_end(ends[0]), write_end(ends[1]);
    std::fflush(nullptr);
    const pid_t pid = ::fork();
    if (pid < 0)
        return Error{"", std::string("cannot go to the background: ") + std::strerror(errno)};
    Background background;
    background.child_ = pid;
    background.pipe_ = std::move(pid > 0 ? read_end : write_end);
    if (pid == 0)
        ::setsid();
    return background;
}

int Background::wait_for_child()
{
    char detached = 0;
    ssize_t size;
    do
        size = ::read(pipe_.get(), &detached, 1);
    while (size < 0 && errno == EINTR);
    if (size == 1) {
        std::printf("running in the background: process %d (fdhctl stop ends it)\n",
                    static_cast<int>(child_));
        return exit_success;
    }
    int status = 0;
    while (::waitpid(child_, &status, 0) < 0 && errno == EINTR) {
    }
    return WIFEXITED(status) && WEXITSTATUS(status) != 0 ? WEXITSTATUS(status) : exit_failed;
}

void Background::detach()
{
    if (!pipe_)
        return;
    std::fflush(nullptr);
    const int null = ::open("/dev/null", O_RDWR);
    if (null >= 0) {
        for (const int stream : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO})
            ::dup2(null, stream);
        if (null > STDERR_FILENO)
            ::close(null);
    }
    const char detached = 1;
    if (::write(pipe_.get(), &detached, 1) != 1) {
        // The parent is gone already: nobody waits for the word.
    }
    pipe_ = feeder::FileDescriptor();
}

} // namespace phantom::fdhctl
