// SPDX-License-Identifier: GPL-2.0-or-later
#include <poll.h>
#include <sys/eventfd.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <thread>

#include <fmt/format.h>

#include "feeder/control_line.hpp"
#include "feeder/control_socket.hpp"
#include "feeder/file_descriptor.hpp"

namespace phantom::feeder::control {

namespace {

/// A client that connects and says nothing holds the others up no longer than this.
constexpr std::chrono::milliseconds question_patience{500};

} // namespace

struct Server::Impl {
    Impl(std::filesystem::path path, FileDescriptor listener, FileDescriptor wake, Handler handle)
        : file(std::move(path)),
          socket(std::move(listener)),
          end(std::move(wake)),
          handler(std::move(handle)),
          thread([this] { serve(); })
    {
    }
    Impl(const Impl&) = delete;
    Impl& operator=(const Impl&) = delete;
    ~Impl()
    {
        ::eventfd_write(end.get(), 1);
        thread.join();
        ::unlink(file.c_str());
    }

    void serve()
    {
        for (;;) {
            pollfd entries[2] = {{socket.get(), POLLIN, 0}, {end.get(), POLLIN, 0}};
            if (::poll(entries, 2, -1) < 0 && errno != EINTR)
                return;
            if (entries[1].revents)
                return;
            if (!(entries[0].revents & POLLIN))
                continue;
            const FileDescriptor client(::accept4(socket.get(), nullptr, nullptr, SOCK_CLOEXEC));
            if (!client)
                continue;
            if (const std::optional<std::string> line = receive_line(client.get(), question_patience))
                send_line(client.get(), handler(*line));
        }
    }

    std::filesystem::path file;
    FileDescriptor socket, end;
    Handler handler;
    std::thread thread; ///< last: started when all else is there
};

Server::Server(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
Server::Server(Server&&) noexcept = default;
Server& Server::operator=(Server&&) noexcept = default;
Server::~Server() = default;

Result<Server> Server::listen(Handler handler)
{
    const Result<std::filesystem::path> place = folder();
    if (!place)
        return place.error();
    const std::filesystem::path file = *place / socket_name;
    const Result<sockaddr_un> address = address_of(file);
    if (!address)
        return address.error();
    FileDescriptor socket(::socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0));
    FileDescriptor end(::eventfd(0, EFD_CLOEXEC));
    if (!socket || !end)
        return Error{file.string(), fmt::format("no socket: {}", std::strerror(errno))};
    ::unlink(file.c_str());
    if (::bind(socket.get(), reinterpret_cast<const sockaddr*>(&*address), sizeof(sockaddr_un)) != 0 ||
        ::chmod(file.c_str(), 0600) != 0 || ::listen(socket.get(), 8) != 0)
        return Error{file.string(), fmt::format("cannot listen: {}", std::strerror(errno))};
    return Server(std::make_unique<Impl>(file, std::move(socket), std::move(end), std::move(handler)));
}

} // namespace phantom::feeder::control
