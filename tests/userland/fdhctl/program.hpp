// SPDX-License-Identifier: GPL-2.0-or-later
// Runs fdhctl in a folder of its own, with a runtime folder of its own, and small files for it.
#pragma once

#include <array>
#include <filesystem>
#include <string>
#include <vector>

#include <sys/types.h>

#include <gtest/gtest.h>

namespace phantom::test {

struct Outcome {
    int status = -1; ///< exit status; 128 + signal when one killed it
    std::string out, err;
};

/// A program that runs beside the test.
class Running {
  public:
    Running(pid_t pid, std::filesystem::path out, std::filesystem::path err);
    Running(Running&&) noexcept;
    Running& operator=(Running&&) = delete;
    ~Running(); ///< kills it if it still runs

    void signal(int number) const;
    Outcome wait();
    /// What it has printed so far.
    [[nodiscard]] std::string out() const;

  private:
    pid_t pid_;
    std::filesystem::path out_, err_;
};

class Program : public ::testing::Test {
  protected:
    Program();
    ~Program() override;

    Outcome run(const std::vector<std::string>& arguments) const;
    [[nodiscard]] Running start(const std::vector<std::string>& arguments) const;
    /// Starts `load` and waits until it is reachable.
    [[nodiscard]] Running start_load(const std::vector<std::string>& arguments) const;

    std::string write(const std::string& name, const std::string& text) const;
    static std::string read(const std::filesystem::path& file);
    [[nodiscard]] std::string path(const std::string& name) const { return (folder_ / name).string(); }
    [[nodiscard]] bool exists(const std::string& name) const
    {
        return std::filesystem::exists(folder_ / name);
    }
    /// Names in the folder that begin so: also temporary files.
    [[nodiscard]] std::vector<std::string> files_beginning(const std::string& name) const;

    /// 20 x 20 mm in the plane z = 0, seen from +z: 8 triangles.
    std::string plate() const;
    /// Latitude-longitude sphere of 30 mm with radial normals, ASCII PLY.
    std::string sphere() const;

    std::filesystem::path folder_;
};

/// Rows of a CSV without its header, as numbers.
std::vector<std::vector<double>> csv_rows(const std::string& text);

} // namespace phantom::test
