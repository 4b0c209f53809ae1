// SPDX-License-Identifier: GPL-2.0-or-later
// Plays every input that is kept, as the fuzzer would.
#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "finding.hpp"
#include "script.hpp"

// Of the sanitizers, where they are linked: called before they end the process.
extern "C" void __sanitizer_set_death_callback(void (*)()) __attribute__((weak));

namespace {

using namespace phantom::fuzz;

std::string playing;

void say_which()
{
    std::fprintf(stderr, "while playing %s\n", playing.c_str());
}

std::vector<std::filesystem::path> corpus()
{
    std::vector<std::filesystem::path> files;
    for (const auto& entry : std::filesystem::directory_iterator(PHANTOM_CORPUS))
        files.push_back(entry.path());
    std::sort(files.begin(), files.end());
    return files;
}

TEST(Corpus, PlaysWithoutAFinding)
{
    if (__sanitizer_set_death_callback)
        __sanitizer_set_death_callback(say_which);
    const auto files = corpus();
    ASSERT_FALSE(files.empty()) << "no input in " << PHANTOM_CORPUS;
    for (const auto& file : files) {
        playing = file.filename();
        std::ifstream in(file, std::ios::binary);
        const std::vector<char> bytes{std::istreambuf_iterator<char>(in), {}};
        try {
            play(reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size());
        } catch (const Finding& finding) {
            ADD_FAILURE() << playing << ": " << finding.what();
        }
    }
}

} // namespace
