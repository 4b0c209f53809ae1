// SPDX-License-Identifier: GPL-2.0-or-later
#include "program.hpp"

#include <fcntl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <cmath>
#include <csignal>
#include <cstdlib>
#include <fstream>
#include <numbers>
#include <sstream>
#include <stdexcept>

#include <fmt/format.h>

namespace phantom::test {

namespace {

std::string text_of(const std::filesystem::path& file)
{
    std::ifstream stream(file, std::ios::binary);
    std::ostringstream text;
    text << stream.rdbuf();
    return text.str();
}

/// A number for output files, so that programs of one test keep theirs apart.
int next_number()
{
    static int number = 0;
    return ++number;
}

} // namespace

Running::Running(pid_t pid, std::filesystem::path out, std::filesystem::path err)
    : pid_(pid), out_(std::move(out)), err_(std::move(err))
{
}

Running::Running(Running&& other) noexcept
    : pid_(std::exchange(other.pid_, 0)), out_(std::move(other.out_)), err_(std::move(other.err_))
{
}

Running::~Running()
{
    if (pid_ > 0) {
        ::kill(pid_, SIGKILL);
        ::waitpid(pid_, nullptr, 0);
    }
}

void Running::signal(int number) const
{
    ::kill(pid_, number);
}

Outcome Running::wait()
{
    int status = 0;
    while (::waitpid(pid_, &status, 0) < 0 && errno == EINTR) {
    }
    pid_ = 0;
    return {WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status), text_of(out_), text_of(err_)};
}

std::string Running::out() const
{
    return text_of(out_);
}

Program::Program()
{
    char name[] = "/tmp/phantom_fdhctl_XXXXXX";
    folder_ = ::mkdtemp(name);
    ::setenv("XDG_RUNTIME_DIR", folder_.c_str(), 1);
    ::setenv("XDG_CACHE_HOME", folder_.c_str(), 1);
}

Program::~Program()
{
    std::filesystem::remove_all(folder_);
}

Running Program::start(const std::vector<std::string>& arguments) const
{
    const int number = next_number();
    const std::filesystem::path out = folder_ / fmt::format("{}.stdout", number);
    const std::filesystem::path err = folder_ / fmt::format("{}.stderr", number);
    std::vector<std::string> words{FDHCTL};
    words.insert(words.end(), arguments.begin(), arguments.end());
    std::vector<char*> argv;
    for (std::string& word : words)
        argv.push_back(word.data());
    argv.push_back(nullptr);
    const pid_t pid = ::fork();
    if (pid == 0) {
        ::dup2(::open("/dev/null", O_RDONLY), STDIN_FILENO);
        ::dup2(::open(out.c_str(), O_WRONLY | O_CREAT, 0600), STDOUT_FILENO);
        ::dup2(::open(err.c_str(), O_WRONLY | O_CREAT, 0600), STDERR_FILENO);
        ::execv(FDHCTL, argv.data());
        ::_exit(127);
    }
    return Running(pid, out, err);
}

Outcome Program::run(const std::vector<std::string>& arguments) const
{
    return start(arguments).wait();
}

Running Program::start_load(const std::vector<std::string>& arguments) const
{
    std::vector<std::string> words{"load"};
    words.insert(words.end(), arguments.begin(), arguments.end());
    Running running = start(words);
    constexpr int attempts = 500;
    for (int attempt = 0; attempt < attempts; ++attempt) {
        if (run({"status"}).status == 0)
            return running;
        ::usleep(20000);
    }
    throw std::runtime_error("load did not become reachable: " + running.out());
}

std::string Program::write(const std::string& name, const std::string& text) const
{
    std::ofstream(folder_ / name, std::ios::binary) << text;
    return path(name);
}

std::string Program::read(const std::filesystem::path& file)
{
    return text_of(file);
}

std::vector<std::string> Program::files_beginning(const std::string& name) const
{
    std::vector<std::string> names;
    for (const auto& entry : std::filesystem::directory_iterator(folder_))
        if (entry.path().filename().string().starts_with(name))
            names.push_back(entry.path().filename().string());
    return names;
}

std::string Program::plate() const
{
    return write("plate.off",
                 "OFF\n9 8 0\n-10 -10 0\n0 -10 0\n10 -10 0\n-10 0 0\n0 0 0\n10 0 0\n-10 10 0\n0 10 0\n"
                 "10 10 0\n3 0 1 4\n3 0 4 3\n3 1 2 5\n3 1 5 4\n3 3 4 7\n3 3 7 6\n3 4 5 8\n3 4 8 7\n");
}

std::string Program::sphere() const
{
    constexpr int rings = 24, sectors = 48;
    constexpr double radius_mm = 30;
    std::string vertices, faces;
    const auto add = [&](double polar, double turn) {
        const double n[3] = {std::sin(polar) * std::cos(turn), std::sin(polar) * std::sin(turn),
                             std::cos(polar)};
        vertices += fmt::format("{} {} {} {} {} {}\n", radius_mm * n[0], radius_mm * n[1], radius_mm * n[2],
                                n[0], n[1], n[2]);
    };
    const auto face = [&](int a, int b, int c) { faces += fmt::format("3 {} {} {}\n", a, b, c); };
    const auto at = [](int ring, int sector) { return 2 + (ring - 1) * sectors + sector % sectors; };
    add(0, 0);
    add(std::numbers::pi, 0);
    for (int ring = 1; ring < rings; ++ring)
        for (int sector = 0; sector < sectors; ++sector)
            add(std::numbers::pi * ring / rings, 2 * std::numbers::pi * sector / sectors);
    int count = 0;
    for (int sector = 0; sector < sectors; ++sector) {
        face(0, at(1, sector), at(1, sector + 1));
        face(1, at(rings - 1, sector + 1), at(rings - 1, sector));
        count += 2;
        for (int ring = 1; ring + 1 < rings; ++ring, count += 2) {
            face(at(ring, sector), at(ring + 1, sector), at(ring + 1, sector + 1));
            face(at(ring, sector), at(ring + 1, sector + 1), at(ring, sector + 1));
        }
    }
    return write(
        "sphere.ply",
        fmt::format("ply\nformat ascii 1.0\nelement vertex {}\nproperty double x\nproperty double y\n"
                    "property double z\nproperty double nx\nproperty double ny\nproperty double nz\n"
                    "element face {}\nproperty list uchar int vertex_indices\nend_header\n{}{}",
                    2 + (rings - 1) * sectors, count, vertices, faces));
}

std::vector<std::vector<double>> csv_rows(const std::string& text)
{
    std::vector<std::vector<double>> rows;
    std::istringstream lines(text);
    std::string line;
    std::getline(lines, line);
    while (std::getline(lines, line)) {
        rows.emplace_back();
        std::istringstream cells(line);
        std::string cell;
        while (std::getline(cells, cell, ','))
            rows.back().push_back(std::stod(cell));
    }
    return rows;
}

} // namespace phantom::test
