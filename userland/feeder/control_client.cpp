// SPDX-License-Identifier: GPL-2.0-or-later
#include <sys/socket.h>

#include "feeder/control_line.hpp"
#include "feeder/control_socket.hpp"
#include "feeder/file_descriptor.hpp"

namespace phantom::feeder::control {

namespace {

/// A session answers in well under a millisecond; STOP and a model change wait for nothing.
constexpr std::chrono::milliseconds answer_patience{3000};

} // namespace

Result<std::string> request(const std::string& line)
{
    const Error nobody{"", "nothing is running", "fdhctl load SCENE starts it"};
    const Result<std::filesystem::path> place = folder();
    if (!place)
        return place.error();
    const Result<sockaddr_un> address = address_of(*place / socket_name);
    if (!address)
        return address.error();
    const FileDescriptor socket(::socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0));
    if (!socket ||
        ::connect(socket.get(), reinterpret_cast<const sockaddr*>(&*address), sizeof(sockaddr_un)) != 0)
        return nobody;
    if (!send_line(socket.get(), line))
        return nobody;
    std::optional<std::string> answer = receive_line(socket.get(), answer_patience);
    if (!answer)
        return Error{(*place / socket_name).string(), "the running session does not answer"};
    return *answer;
}

} // namespace phantom::feeder::control
