// SPDX-License-Identifier: GPL-2.0-or-later
// fdhread FILE: the polygons of a file that VTK reads, to standard output. No program for people: fdhctl and
// fdhview start it when they are given such a file.
#include <sys/resource.h>
#include <unistd.h>

#include <cstdio>
#include <exception>
#include <filesystem>
#include <new>

#include <vtkLogger.h>
#include <vtkNew.h>

#include "fdhread/vtk_polygons.hpp"
#include "fdhread/vtk_words.hpp"
#include "mesh/polygon_stream.hpp"

namespace {

using namespace phantom;

/// A damaged file must not take the machine with it. Far more than any sound file of this size needs.
void limit_resources(const std::string& file)
{
    std::error_code ignored;
    const std::uintmax_t size = std::filesystem::file_size(file, ignored);
    const rlim_t bytes = ignored ? 0 : static_cast<rlim_t>(size);
    const rlim_t memory = (rlim_t{4} << 30) + 60 * bytes, seconds = 2 + bytes / 1000000;
    const rlimit address_space{memory, memory}, cpu{seconds, seconds + 5}, no_core{0, 0};
    ::setrlimit(RLIMIT_AS, &address_space);
    ::setrlimit(RLIMIT_CPU, &cpu);
    ::setrlimit(RLIMIT_CORE, &no_core);
}

bool answer(const std::string& file)
{
    vtkNew<fdhread::VtkWords> words;
    vtkOutputWindow::SetInstance(words);
    try {
        const auto polygons = fdhread::read_polygons(file);
        if (!words->first_error().empty())
            return mesh::send_error("cannot be read: " + words->first_error(), stdout);
        return polygons ? mesh::send_polygons(*polygons, stdout)
                        : mesh::send_error(polygons.error().what, stdout);
    } catch (const std::bad_alloc&) {
        return mesh::send_error("does not fit into memory (damaged file?)", stdout);
    } catch (const std::exception& error) {
        return mesh::send_error(std::string("cannot be read: ") + error.what(), stdout);
    }
}

} // namespace

int main(int argc, char** argv)
{
    if (argc != 2 || ::isatty(STDOUT_FILENO)) {
        std::fprintf(stderr,
                     "fdhread reads .vtp, .vtk, .3ds, .gltf and .glb files for fdhctl and fdhview.\n");
        return 2;
    }
    // What VTK logs on its own, before and beside its output window.
    vtkLogger::SetStderrVerbosity(vtkLogger::VERBOSITY_OFF);
    limit_resources(argv[1]);
    const bool sent = answer(argv[1]);
    std::fflush(stdout);
    // VTK's static objects may be in any state after a damaged file.
    ::_exit(sent ? 0 : 1);
}
