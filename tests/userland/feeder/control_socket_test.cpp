// SPDX-License-Identifier: GPL-2.0-or-later
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/un.h>
#include <unistd.h>

#include <cstdlib>
#include <cstring>
#include <filesystem>

#include <gtest/gtest.h>

#include "feeder/control_socket.hpp"

namespace phantom::test {
namespace {

namespace control = feeder::control;

/// A runtime folder of the test's own.
class ControlSocket : public ::testing::Test {
  protected:
    ControlSocket()
    {
        char name[] = "/tmp/phantom_control_XXXXXX";
        folder_ = ::mkdtemp(name);
        ::setenv("XDG_RUNTIME_DIR", folder_.c_str(), 1);
    }
    ~ControlSocket() override { std::filesystem::remove_all(folder_); }
    std::filesystem::path socket() const { return folder_ / "phantom_rt0.sock"; }
    std::filesystem::path folder_;
};

std::string echo(const std::string& line)
{
    return "answer to " + line;
}

TEST_F(ControlSocket, ALineIsAnswered)
{
    const auto server = control::Server::listen(echo);
    ASSERT_TRUE(server.ok()) << server.error().text();
    for (int i = 0; i < 3; ++i) {
        const auto answer = control::request("question");
        ASSERT_TRUE(answer.ok()) << answer.error().text();
        EXPECT_EQ(*answer, "answer to question");
    }
}

TEST_F(ControlSocket, OnlyTheOwnerMayConnect)
{
    const auto server = control::Server::listen(echo);
    ASSERT_TRUE(server.ok());
    struct stat info {};
    ASSERT_EQ(::stat(socket().c_str(), &info), 0);
    EXPECT_EQ(info.st_mode & 0777U, 0600U);
}

TEST_F(ControlSocket, WithoutASessionTheClientSaysSo)
{
    const auto answer = control::request("question");
    ASSERT_FALSE(answer.ok());
    EXPECT_NE(answer.error().text().find("nothing is running"), std::string::npos);
    EXPECT_EQ(control::running_pid(), 0);
}

TEST_F(ControlSocket, ADeadSocketFileIsReplaced)
{
    // As a crash leaves it: bound, and nobody listens.
    sockaddr_un address{};
    address.sun_family = AF_UNIX;
    std::strcpy(address.sun_path, socket().c_str());
    const int fd = ::socket(AF_UNIX, SOCK_STREAM, 0);
    ASSERT_EQ(::bind(fd, reinterpret_cast<sockaddr*>(&address), sizeof address), 0);
    ::close(fd);
    ASSERT_TRUE(std::filesystem::exists(socket()));
    EXPECT_FALSE(control::request("question").ok());
    const auto server = control::Server::listen(echo);
    ASSERT_TRUE(server.ok()) << server.error().text();
    EXPECT_TRUE(control::request("question").ok());
}

TEST_F(ControlSocket, TheSocketGoesWithTheServer)
{
    {
        const auto server = control::Server::listen(echo);
        ASSERT_TRUE(server.ok());
    }
    EXPECT_FALSE(std::filesystem::exists(socket()));
}

TEST_F(ControlSocket, ASecondSessionIsRefusedAndToldWhoRuns)
{
    auto first = std::make_unique<Result<control::Lock>>(control::Lock::take());
    ASSERT_TRUE(first->ok()) << first->error().text();
    EXPECT_EQ(control::running_pid(), ::getpid());
    const auto second = control::Lock::take();
    ASSERT_FALSE(second.ok());
    EXPECT_NE(second.error().text().find(std::to_string(::getpid())), std::string::npos);
    first.reset();
    EXPECT_EQ(control::running_pid(), 0);
    EXPECT_TRUE(control::Lock::take().ok());
}

TEST_F(ControlSocket, AnOverlongLineIsDroppedAndTheServerGoesOn)
{
    const auto server = control::Server::listen(echo);
    ASSERT_TRUE(server.ok());
    EXPECT_FALSE(control::request(std::string(3 * control::line_max, 'x')).ok());
    EXPECT_TRUE(control::request("question").ok());
}

TEST_F(ControlSocket, ANameTooLongForASocketIsTold)
{
    const std::filesystem::path deep = folder_ / std::string(120, 'd');
    std::filesystem::create_directory(deep);
    ::setenv("XDG_RUNTIME_DIR", deep.c_str(), 1);
    const auto server = control::Server::listen(echo);
    ASSERT_FALSE(server.ok());
    EXPECT_NE(server.error().text().find("longer"), std::string::npos);
}

} // namespace
} // namespace phantom::test
