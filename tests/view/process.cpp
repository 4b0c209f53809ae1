// SPDX-License-Identifier: GPL-2.0-or-later
#include "process.hpp"

#include <csignal>
#include <cstdlib>
#include <sstream>

#include <fcntl.h>
#include <sys/wait.h>

namespace phantom::view::test {

namespace {

std::string content(const std::filesystem::path& file)
{
    std::ostringstream text;
    text << std::ifstream(file).rdbuf();
    return text.str();
}

int status_of(int raw)
{
    return WIFEXITED(raw) ? WEXITSTATUS(raw) : 128 + WTERMSIG(raw);
}

[[noreturn]] void become(const std::vector<std::string>& command,
                         const std::map<std::string, std::string>& environment, const TemporaryFolder& folder)
{
    for (const auto& [name, value] : environment) {
        if (value.empty())
            unsetenv(name.c_str());
        else
            setenv(name.c_str(), value.c_str(), 1);
    }
    dup2(open("/dev/null", O_RDONLY), 0);
    dup2(open((folder / "out").c_str(), O_CREAT | O_WRONLY, 0600), 1);
    dup2(open((folder / "error").c_str(), O_CREAT | O_WRONLY, 0600), 2);
    std::vector<char*> argv;
    for (const std::string& word : command)
        argv.push_back(const_cast<char*>(word.c_str()));
    argv.push_back(nullptr);
    execvp(argv[0], argv.data());
    _exit(127);
}

} // namespace

Process::Process(const std::vector<std::string>& command,
                 const std::map<std::string, std::string>& environment)
{
    pid_ = fork();
    if (pid_ == 0)
        become(command, environment, folder_);
}

Process::~Process()
{
    if (running()) {
        kill(pid_, SIGKILL);
        (void)wait();
    }
}

bool Process::running()
{
    int raw = 0;
    if (!status_ && waitpid(pid_, &raw, WNOHANG) == pid_)
        status_ = status_of(raw);
    return !status_;
}

Ended Process::wait()
{
    int raw = 0;
    while (!status_)
        if (waitpid(pid_, &raw, 0) == pid_)
            status_ = status_of(raw);
    return {*status_, content(folder_ / "out"), content(folder_ / "error")};
}

Ended run(const std::vector<std::string>& command, const std::map<std::string, std::string>& environment)
{
    return Process(command, environment).wait();
}

std::vector<std::string> fdhview(const std::vector<std::string>& arguments)
{
    std::vector<std::string> command{PHANTOM_FDHVIEW};
    command.insert(command.end(), arguments.begin(), arguments.end());
    return command;
}

bool installed(const std::string& program)
{
    std::istringstream folders(std::getenv("PATH") != nullptr ? std::getenv("PATH") : "");
    for (std::string folder; std::getline(folders, folder, ':');)
        if (access((folder + "/" + program).c_str(), X_OK) == 0)
            return true;
    return false;
}

} // namespace phantom::view::test
