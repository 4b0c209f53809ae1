// SPDX-License-Identifier: GPL-2.0-or-later
// A machine, its files and sets to feed it, for the tests of the module in user mode.
#pragma once

#include <algorithm>
#include <array>
#include <cerrno>
#include <chrono>
#include <cmath>
#include <cstring>
#include <fcntl.h>
#include <memory>
#include <poll.h>
#include <vector>

#include <gtest/gtest.h>

#include "phantom_usermode.h"

namespace phantom::test {

inline constexpr std::int64_t mm = 1'000'000; // nm; and with k = 1 N/mm, the uN of that much depth

/// Memory in which "not written" shows.
template <class T>
T dirty()
{
    T value;
    std::memset(static_cast<void*>(&value), 0xcc, sizeof(value));
    return value;
}

inline double norm(const std::int32_t (&v)[3])
{
    return std::hypot(double(v[0]), double(v[1]), double(v[2]));
}

inline double distance(const std::int32_t (&a)[3], const std::int32_t (&b)[3])
{
    return std::hypot(double(a[0]) - b[0], double(a[1]) - b[1], double(a[2]) - b[2]);
}

/// A set on the stack of a test: a square of two faces in the plane z = height, normal +z.
struct Plane {
    phantom_set header{};
    std::vector<phantom_patch> patches;
    std::vector<phantom_material> materials;
    std::vector<phantom_object> objects;
    std::vector<std::uint64_t> tables; ///< of effects, sent behind the materials
    std::vector<std::uint64_t> sent;   ///< materials and tables, as set() left them

    /// Corners at +-half_nm round (0, 0, height_nm), all in world coordinates; origin where the caller likes.
    explicit Plane(std::uint64_t id, std::int32_t half_nm = 50'000'000, std::int32_t radius_nm = 40'000'000,
                   std::array<std::int64_t, 3> origin = {0, 0, 0}, std::int64_t height_nm = 0)
    {
        header.id = id;
        for (int axis = 0; axis < 3; ++axis) {
            header.origin_nm[axis] = origin[axis];
            header.centre_nm[axis] = std::int32_t((axis == 2 ? height_nm : 0) - origin[axis]);
        }
        header.radius_nm = std::uint32_t(radius_nm);
        const std::int64_t corner[4][2] = {
            {-half_nm, -half_nm}, {half_nm, -half_nm}, {half_nm, half_nm}, {-half_nm, half_nm}};
        const int faces[2][3] = {{0, 1, 2}, {0, 2, 3}};
        for (int f = 0; f < 2; ++f) {
            phantom_patch patch{};
            for (int c = 0; c < 3; ++c) {
                patch.vertex_nm[c][0] = std::int32_t(corner[faces[f][c]][0] - origin[0]);
                patch.vertex_nm[c][1] = std::int32_t(corner[faces[f][c]][1] - origin[1]);
                patch.vertex_nm[c][2] = std::int32_t(height_nm - origin[2]);
                patch.normal_q30[c][2] = PHANTOM_Q30_ONE;
                patch.vertex[c] = std::uint32_t(faces[f][c]);
                patch.neighbour[c] = PHANTOM_PATCH_NONE;
            }
            patch.face = std::uint32_t(f);
            patch.neighbour[f == 0 ? 2 : 0] = std::uint32_t(1 - f);
            patches.push_back(patch);
        }
        phantom_material material{};
        material.stiffness_mn_mm = 1000; // 1 N/mm
        material.radius_nm = 3'000'000;
        materials.push_back(material);
        phantom_object object{};
        object.rotation_q30[0] = PHANTOM_Q30_ONE;
        objects.push_back(object);
    }

    /// The next table, or the next entry of one.
    template <class T>
    void add_table(const T& entry)
    {
        static_assert(sizeof(T) % sizeof(tables[0]) == 0);
        tables.resize(tables.size() + sizeof(T) / sizeof(tables[0]));
        std::memcpy(&tables[tables.size() - sizeof(T) / sizeof(tables[0])], &entry, sizeof(T));
    }

    /// The samples of a table, and a zero if their number is odd.
    void add_integers(const std::int32_t* from, std::size_t count)
    {
        const std::size_t before = tables.size();
        tables.resize(before + (count + 1) / 2);
        std::memcpy(&tables[before], from, count * sizeof(*from));
    }

    phantom_set& set()
    {
        header.patch_count = std::uint32_t(patches.size());
        header.material_count = std::uint32_t(materials.size());
        header.object_count = std::uint32_t(objects.size());
        header.patches = reinterpret_cast<std::uintptr_t>(patches.data());
        const std::size_t words = materials.size() * sizeof(phantom_material) / sizeof(sent[0]);
        // room for all that effect_bytes may be spoiled to: the module in user mode believes it
        sent.assign(words + PHANTOM_EFFECT_BYTES_MAX / sizeof(sent[0]), 0);
        if (words)
            std::memcpy(sent.data(), materials.data(), words * sizeof(sent[0]));
        std::copy(tables.begin(), tables.end(), sent.begin() + std::ptrdiff_t(words));
        header.effect_bytes = std::uint32_t(tables.size() * sizeof(tables[0]));
        header.materials = reinterpret_cast<std::uintptr_t>(sent.data());
        header.objects = reinterpret_cast<std::uintptr_t>(objects.data());
        return header;
    }
};

class File {
  public:
    explicit File(phantom_um* machine, int flags = O_RDWR | O_NONBLOCK)
    {
        file_ = phantom_um_open(machine, flags, &error_);
    }
    ~File() { close(); }
    File(const File&) = delete;
    File& operator=(const File&) = delete;

    void close()
    {
        if (file_)
            phantom_um_close(file_);
        file_ = nullptr;
    }
    [[nodiscard]] int error() const { return error_; }
    [[nodiscard]] phantom_um_file* raw() const { return file_; }

    int ioctl(unsigned long request, void* argument = nullptr)
    {
        return phantom_um_ioctl(file_, request, argument);
    }
    int submit(Plane& plane) { return ioctl(PHANTOM_SUBMIT_SET, &plane.set()); }
    int start(phantom_start start = {}) { return ioctl(PHANTOM_START, &start); }
    int start_unlimited()
    {
        phantom_start start{};
        start.flags = PHANTOM_START_LIMITS_OFF;
        start.stale_ms = 1'000'000;
        return ioctl(PHANTOM_START, &start);
    }
    int stop() { return ioctl(PHANTOM_STOP); }
    int rate(std::uint32_t hz)
    {
        phantom_rate rate{hz, 0};
        return ioctl(PHANTOM_SET_RATE, &rate);
    }
    int move(std::int64_t x, std::int64_t y, std::int64_t z)
    {
        phantom_sim_move move{{x, y, z}, 0};
        return ioctl(PHANTOM_SIM_MOVE, &move);
    }
    int poll(short events, int timeout_ms = 0) { return phantom_um_poll(file_, events, timeout_ms); }
    /// Up to `most` records; empty when there is none.
    std::vector<phantom_tick> read(std::size_t most = 16384)
    {
        std::vector<phantom_tick> records(most);
        const ssize_t bytes = phantom_um_read(file_, records.data(), records.size() * sizeof(phantom_tick));
        records.resize(bytes > 0 ? std::size_t(bytes) / sizeof(phantom_tick) : 0);
        return records;
    }
    /// A consistent copy of the page.
    phantom_status status()
    {
        int error = 0;
        const phantom_status* page = phantom_um_mmap(file_, &error);
        EXPECT_EQ(error, 0);
        phantom_status copy;
        const auto* from = reinterpret_cast<const std::uint64_t*>(page);
        auto* to = reinterpret_cast<std::uint64_t*>(&copy);
        for (;;) {
            const std::uint32_t before = __atomic_load_n(&page->sequence, __ATOMIC_ACQUIRE);
            for (std::size_t word = 0; word < sizeof(copy) / 8; ++word)
                to[word] = __atomic_load_n(from + word, __ATOMIC_ACQUIRE);
            if (!(before & 1) && __atomic_load_n(&page->sequence, __ATOMIC_ACQUIRE) == before)
                return copy;
        }
    }

  private:
    phantom_um_file* file_ = nullptr;
    int error_ = 0;
};

/// A machine on a virtual clock, unless told otherwise, destroyed last.
class MachineTest : public ::testing::Test {
  protected:
    void SetUp() override { create({.clock = PHANTOM_UM_CLOCK_VIRTUAL, .cpu = -1}); }
    void TearDown() override { destroy(); }

    struct Config {
        std::uint32_t clock = PHANTOM_UM_CLOCK_VIRTUAL;
        std::uint32_t rate_hz = 0;
        std::int32_t cpu = -1;
        std::uint32_t max_force_un = 0;
        std::uint32_t isa = PHANTOM_ISA_NONE;
        std::uint32_t patches_max = 0;
    };
    void create(const Config& c)
    {
        destroy();
        const phantom_um_config config{c.clock, c.rate_hz, c.cpu, c.max_force_un, c.isa, c.patches_max};
        int error = 0;
        machine = phantom_um_create(&config, &error);
        ASSERT_EQ(error, 0);
        ASSERT_NE(machine, nullptr);
    }
    void destroy()
    {
        if (machine)
            phantom_um_destroy(machine);
        machine = nullptr;
    }
    int step(std::uint32_t ticks = 1) { return phantom_um_step(machine, ticks); }

    phantom_um* machine = nullptr;
};

} // namespace phantom::test
