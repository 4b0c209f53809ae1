// SPDX-License-Identifier: GPL-2.0-or-later
// A folder that goes with the test, and a mesh file in it.
#pragma once

#include <filesystem>
#include <fstream>
#include <string>
#include <unistd.h>

namespace phantom::scene::test {

class Folder {
  public:
    Folder()
    {
        std::string name = (std::filesystem::temp_directory_path() / "phantom-test-XXXXXX").string();
        path_ = ::mkdtemp(name.data());
    }
    ~Folder()
    {
        std::error_code ignored;
        std::filesystem::remove_all(path_, ignored);
    }
    Folder(const Folder&) = delete;
    Folder& operator=(const Folder&) = delete;

    [[nodiscard]] const std::filesystem::path& path() const { return path_; }

    std::filesystem::path write(const std::string& name, const std::string& text) const
    {
        const auto file = path_ / name;
        // Truncating an old file and closing it makes some file systems write it out at once.
        std::filesystem::remove(file);
        std::ofstream(file, std::ios::binary) << text;
        return file;
    }

  private:
    std::filesystem::path path_;
};

/// A tetrahedron, 40 units long in x, 20 in y and z.
inline const char* const tetrahedron = "v 0 0 0\nv 40 0 0\nv 0 20 0\nv 0 0 20\n"
                                       "f 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n";

} // namespace phantom::scene::test
