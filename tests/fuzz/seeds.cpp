// SPDX-License-Identifier: GPL-2.0-or-later
// Writes the inputs that fuzzing begins with: real contact, so that no time goes into finding a face.
//
//   fuzz_seeds DIRECTORY
#include <array>
#include <cstdint>
#include <cstdio>
#include <fstream>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "phantom_abi.h"
#include "script.hpp"
#include "shapes.hpp"
#include "subject.hpp"

namespace {

using namespace phantom::fuzz;
using Control = Subject::Control;

/// The counterpart of script.cpp and shapes.cpp, one function for each thing they read.
class Writer {
  public:
    Writer& byte(int value)
    {
        bytes_.push_back(static_cast<char>(value));
        return *this;
    }
    template <class T>
    Writer& raw(T value)
    {
        for (std::size_t i = 0; i < sizeof(T); ++i)
            byte(int(std::uint64_t(value) >> (8 * i) & 0xff));
        return *this;
    }
    Writer& steps(int value) { return raw(std::int16_t(value)); }
    Writer& point(int x, int y, int z) { return steps(x).steps(y).steps(z); }
    Writer& operation(Operation o) { return byte(int(o)); }

    enum ShapeKind { Triangle, Sliver, Grid, Ball, Box, EdgeFan, CornerFan };
    Writer& rims() { return operation(Operation::Shape).byte(shape_rims); }
    enum NormalRule { Plane, Radial, Bent, Any };
    Writer& shape(ShapeKind kind) { return operation(Operation::Shape).byte(kind); }
    /// A square of 2 x 2 x `side`^2 faces round the origin; relief in steps for each corner's byte.
    Writer& grid(int side, int step, NormalRule rule, const std::vector<int>& relief = {}, int z = 0)
    {
        shape(Grid).byte(rule).byte(side - 1).point(-side * step / 2, -side * step / 2, z).steps(step);
        steps(relief.empty() ? 0 : step);
        for (const int height : relief)
            byte(height);
        return *this;
    }
    Writer& ball(int splits, bool hollow, int radius, int faces)
    {
        return shape(Ball).byte(splits | (hollow ? 4 : 0)).point(0, 0, 0).steps(radius).byte(faces - 1);
    }
    Writer& box(bool room, int size)
    {
        return shape(Box).byte(room).point(-size / 2, -size / 2, -size / 2).point(size, size, size);
    }
    Writer& material(int stiffness_code, int radius_code, int damping_code)
    {
        operation(Operation::Material).byte(stiffness_code).byte(radius_code).byte(damping_code);
        return damping_code ? *this : byte(0);
    }
    Writer& model(std::uint32_t model, std::uint32_t newton_steps, std::uint32_t combine, std::uint32_t proxy,
                  std::uint32_t arith = PHANTOM_ARITH_FLOAT)
    {
        for (int code = 0; code < 256; ++code)
            if (std::uint32_t(code % 3) == model && std::uint32_t(code / 4 % 4) == newton_steps &&
                std::uint32_t(code / 16 % 2) == combine && std::uint32_t(code / 32 % 3) == proxy)
                return operation(Operation::Model).byte(code).byte(int(arith));
        return *this;
    }
    /// Steps from the set's origin; a 127th of 2 m/s and of 95 rad/s. Turned by some 37 degrees about z.
    Writer& mover(int number, std::array<int, 3> at, std::array<int, 3> velocity, std::array<int, 3> about)
    {
        operation(Operation::Object).byte(number).byte(0).point(at[0], at[1], at[2]).point(0, 0, 0);
        byte(120).byte(0).byte(0).byte(40);
        for (const auto& part : {velocity, about})
            for (const int x : part)
                byte(x & 0xff);
        return *this;
    }
    Writer& submit() { return operation(Operation::Submit); }
    /// Height in 1/64 of R; in so many ticks.
    Writer& touch(int face, int where, int height, int ticks = 4, int nm = 0)
    {
        return operation(Operation::Touch).byte(face).byte(where).byte(height).byte(nm).byte(ticks - 1);
    }
    Writer& move(int x, int y, int z, int ticks)
    {
        return operation(Operation::Move).point(x, y, z).byte(ticks - 1);
    }
    Writer& jump(std::int32_t x, std::int32_t y, std::int32_t z)
    {
        return operation(Operation::Jump).byte(1).raw(x).raw(y).raw(z);
    }
    Writer& rest(int ticks) { return operation(Operation::Rest).byte(ticks - 1); }
    Writer& control(Control what, std::uint32_t value = 0)
    {
        return operation(Operation::Control).byte(int(what)).raw(value);
    }
    /// Down to a face, through it, along below it and out again; exactly over its corners, edges and middle.
    Writer& tour(int faces)
    {
        for (int i = 0; i < 6; ++i) {
            const int face = i * 5 % faces;
            touch(face, 21, 70, 1).touch(face, 21, 20).touch(face, i * 7, 10, 2);
            touch(face, 21, 1, 2).touch(face, 21, -10).touch(face, i * 11, -40, 6);
            touch((face + 1) % faces, i, -100, 6).touch(face, 21, -3).touch(face, 14, 40, 5);
        }
        return touch(0, 0, 0, 3).touch(0, 1, 0, 2, 1).touch(0, 2, 0, 2, -1).jump(0, 0, 0);
    }
    [[nodiscard]] const std::string& bytes() const { return bytes_; }

  private:
    std::string bytes_;
};

struct Scene {
    const char* name;
    int faces;
    std::function<void(Writer&)> build;
};

std::vector<Scene> scenes()
{
    const std::vector<int> groove{-60, 0, 60, -60, 0, 60, -60, 0, 60};
    const std::vector<int> bumps{10, -20, 30, 0, 40, -30, 20, -10, 5, 15, -25, 35, 0, -5, 25, 8};
    return {
        {"plate", 8, [](Writer& w) { w.grid(2, 4000, Writer::Plane); }},
        {"groove", 8, [=](Writer& w) { w.grid(2, 3000, Writer::Plane, groove); }},
        {"bumps", 18, [=](Writer& w) { w.grid(3, 2000, Writer::Plane, bumps); }},
        {"ball", 128, [](Writer& w) { w.ball(2, false, 10000, 128); }},
        {"ball-piece", 13, [](Writer& w) { w.ball(1, false, 5000, 13); }},
        {"hollow-ball-of-less-than-its-radius", 32, [](Writer& w) { w.ball(1, true, 1500, 32); }},
        {"box-with-fans", 12, [](Writer& w) { w.box(false, 6000); }},
        {"room-of-less-than-its-radius", 12, [](Writer& w) { w.box(true, 1500); }},
        {"thin-plate", 16,
         [](Writer& w) {
             w.grid(2, 4000, Writer::Plane);
             w.operation(Operation::Repeat).byte(1).point(0, 0, -200);
         }},
        {"opposite-faces", 16,
         [](Writer& w) {
             w.grid(2, 4000, Writer::Plane);
             w.operation(Operation::Repeat).byte(1).point(0, 0, 0);
         }},
        {"normals-that-point-anywhere", 8, [](Writer& w) { w.grid(2, 2000, Writer::Any); }},
        {"bent-normals", 8, [](Writer& w) { w.grid(2, 2000, Writer::Bent); }},
        {"slivers", 5,
         [](Writer& w) {
             for (const int height : {1, 15, 17, 300, 9000})
                 w.shape(Writer::Sliver).point(0, 0, 100 * height % 400).steps(20000).steps(height).byte(90);
         }},
        {"degenerate", 4,
         [](Writer& w) {
             w.shape(Writer::Triangle).byte(Writer::Plane).point(0, 0, 0).point(0, 0, 0).point(0, 0, 0);
             w.shape(Writer::Triangle).byte(Writer::Plane).point(0, 0, 0).point(9, 0, 0).point(9, 0, 0);
             w.shape(Writer::Triangle).byte(Writer::Plane).point(-9, -9, 0).point(0, 0, 0).point(9, 9, 0);
             w.shape(Writer::Triangle)
                 .byte(Writer::Radial)
                 .point(-9000, 0, 10)
                 .point(9000, 0, 10)
                 .point(0, 9000, 10);
         }},
        {"crossing-surfaces", 20, [](Writer& w) { w.grid(2, 4000, Writer::Plane).box(false, 3000); }},
        {"lone-fans", 1,
         [](Writer& w) {
             w.shape(Writer::EdgeFan).point(0, 0, 0).point(900, 0, 0).raw<std::uint64_t>(0x1020304050607080);
             w.shape(Writer::CornerFan).point(0, 0, 0).raw<std::uint64_t>(0x7001020371102030);
         }},
        {"two-metres", 8,
         [](Writer& w) {
             w.operation(Operation::Ruler).byte(6).material(80, 200, 0).grid(2, 900, Writer::Plane);
         }},
        {"ten-micrometres", 18,
         [=](Writer& w) {
             w.operation(Operation::Ruler).byte(0).material(120, 90, 0).grid(3, 4000, Writer::Plane, bumps);
         }},
        {"full-set", 504,
         [](Writer& w) {
             w.ball(2, false, 4000, 128);
             for (int i = 0; i < 3; ++i)
                 w.operation(Operation::Repeat).byte(0).point(1000 * i, 300, 0);
         }},
        {"plate-with-a-rim", 8, [](Writer& w) { w.grid(2, 4000, Writer::Plane).rims(); }},
        {"bumps-with-a-rim", 18, [=](Writer& w) { w.grid(3, 2000, Writer::Plane, bumps).rims(); }},
        {"open-ball-smaller-than-its-radius", 13, [](Writer& w) { w.ball(1, false, 1500, 13).rims(); }},
        {"two-plates-with-rims", 16,
         [](Writer& w) {
             w.grid(2, 4000, Writer::Plane).rims();
             w.operation(Operation::Repeat).byte(0).point(3000, 100, -300).rims();
         }},
        {"damped-stiff", 32, [](Writer& w) { w.material(120, 168, 90).ball(1, false, 9000, 32); }},
    };
}

struct Seed {
    std::string name;
    Writer script;
};

/// A scene under one model; the rest of it goes round.
Seed touched(const Scene& scene, bool life, std::uint32_t model, std::uint32_t proxy, std::uint32_t round)
{
    Writer w;
    w.byte(life ? 0x11 : 0).model(model, round % 4, round / 2 % 2, proxy);
    scene.build(w);
    w.submit().tour(scene.faces);
    const std::string to = life ? "-life" : proxy == PHANTOM_PROXY_PAPER ? "-proxy-paper" : "-constrained";
    return {std::string(scene.name) + (model == PHANTOM_MODEL_PAPER ? "-paper" : "-projected") + to, w};
}

/// Each scene under both models and both proxies, and once as a life, which costs two machines.
void add_scenes(std::vector<Seed>& to)
{
    std::uint32_t round = 0;
    for (const Scene& scene : scenes()) {
        for (const std::uint32_t model : {PHANTOM_MODEL_PAPER, PHANTOM_MODEL_PROJECTED})
            for (const std::uint32_t proxy : {PHANTOM_PROXY_PAPER, PHANTOM_PROXY_CONSTRAINED})
                to.push_back(touched(scene, false, model, proxy, ++round));
        ++round;
        to.push_back(touched(scene, true, PHANTOM_MODEL_PAPER + round % 2, PHANTOM_PROXY_CONSTRAINED, round));
    }
}

void add_lives(std::vector<Seed>& to)
{
    Writer w;
    w.byte(0x11).ball(1, false, 9000, 32).submit().touch(0, 21, -10, 8);
    w.grid(2, 4000, Writer::Plane, {}, 9000).submit().touch(0, 21, -20, 8);
    w.operation(Operation::Clear).submit().rest(30);
    to.push_back({"another-set-in-mid-contact", w});

    w = {};
    w.byte(0x01)
        .box(false, 6000)
        .submit()
        .touch(0, 21, 20, 30)
        .control(Control::Stop)
        .control(Control::Start, 2);
    w.touch(0, 21, -20, 30).control(Control::Stall, 30000000).rest(3).control(Control::ClearFault).rest(20);
    w.control(Control::DeviceError, 2)
        .rest(2)
        .control(Control::DeviceError, 1)
        .control(Control::ClearFault)
        .rest(9);
    w.control(Control::Sleep).rest(2).control(Control::Sleep).rest(3).control(Control::ClearFault).rest(9);
    w.control(Control::Rate, 2000).rest(9).control(Control::Reopen, 1).submit().rest(9);
    to.push_back({"faults-sleep-and-another-feeder", w});

    w = {};
    w.byte(0x11).control(Control::Allocation, 0).grid(1, 4000, Writer::Plane).submit().submit().rest(2);
    for (std::uint32_t call = 0; call < 6; ++call)
        w.control(Control::Call, call).control(Control::Call, 256 + call);
    for (int part = 0; part < 4; ++part)
        w.operation(Operation::Spoil)
            .byte(0)
            .byte(part)
            .raw<std::uint16_t>(std::uint16_t(9 + part))
            .raw(0x80000000U);
    to.push_back({"calls-that-are-refused", w});

    // a disc that turns, a plate that rises through the tip, another set with them and one without
    w = {};
    w.byte(0x11).material(80, 60, 0).grid(1, 4000, Writer::Plane);
    w.mover(240, {0, 0, -100}, {0, 0, 90}, {0, 0, 17}).grid(2, 900, Writer::Plane);
    w.mover(243, {50, -50, -300}, {0, 0, 60}, {0, 3, 0}).ball(1, false, 1500, 20);
    w.submit().control(Control::Start, 0).touch(0, 21, 20, 9).rest(60).submit().rest(30);
    w.touch(3, 21, -20, 9).rest(9).submit().tour(12);
    w.operation(Operation::Clear).grid(1, 4000, Writer::Plane).submit().rest(99).touch(0, 21, 5).rest(30);
    to.push_back({"what-moves-comes-and-goes", w});

    w = {};
    w.byte(0x13)
        .model(PHANTOM_MODEL_PROJECTED, 3, 1, 2, PHANTOM_ARITH_DOUBLE)
        .ball(1, false, 9000, 32)
        .submit()
        .tour(32);
    to.push_back({"float64-life", w});

    w = {};
    w.byte(0x02)
        .operation(Operation::Ruler)
        .byte(6)
        .material(60, 240, 60)
        .grid(1, 1900, Writer::Plane)
        .submit();
    w.jump(2147483647, 0, -5)
        .jump(-2147483647 - 1, 5, 5)
        .jump(1000000000, 1000000000, -1)
        .jump(0, 0, -1000000000);
    to.push_back({"limits-of-the-integers", w});

    // the stiffest material there is
    w = {};
    w.byte(0).material(255, 170, 0).grid(2, 4000, Writer::Plane).submit().tour(8);
    to.push_back({"forces-that-saturate", w});

    // rounding is a micrometre on a patch of a metre, and normals that graze it make it much more
    w = {};
    w.byte(0).model(PHANTOM_MODEL_PROJECTED, 3, 1, PHANTOM_PROXY_OFF).operation(Operation::Ruler).byte(6);
    w.material(80, 160, 0).shape(Writer::Triangle).byte(Writer::Any);
    w.point(-500, -500, 0).point(500, -500, 0).point(0, 500, 0);
    w.byte(126).byte(0).byte(126).byte(0).byte(126).byte(0).submit();
    for (const int nm : {100, 10, 1, 0, -1, -10, -100, -127})
        w.touch(0, 21, 0, 1, nm);
    to.push_back({"just-below-a-grazed-face", w});

    // behind a slope, its nearest point on the face and three metres from a corner
    for (const std::uint32_t proxy : {PHANTOM_PROXY_PAPER, PHANTOM_PROXY_CONSTRAINED}) {
        w = {};
        w.byte(0).model(PHANTOM_MODEL_PROJECTED, 2, 1, proxy).operation(Operation::Ruler).byte(6);
        w.material(80, 160, 0).shape(Writer::Triangle).byte(Writer::Plane);
        w.point(-1000, -1000, 1000).point(-1000, 1000, 1000).point(1000, 0, -1000);
        w.operation(Operation::Cover).point(1000, 0, 0).steps(1000).submit();
        w.touch(0, 21, 10).touch(0, 21, -10).jump(2147483647, 0, 500000000).jump(2147483647, 1000, 499000000);
        to.push_back({"three-metres-from-a-corner-" + std::to_string(proxy), w});
    }
}

} // namespace

int main(int argc, char** argv)
{
    if (argc != 2) {
        std::fprintf(stderr, "usage: fuzz_seeds DIRECTORY\n");
        return 2;
    }
    std::vector<Seed> seeds;
    add_scenes(seeds);
    add_lives(seeds);
    for (const Seed& seed : seeds) {
        const std::string path = std::string(argv[1]) + "/" + seed.name;
        std::ofstream out(path, std::ios::binary);
        out << seed.script.bytes();
        if (!out.flush()) {
            std::fprintf(stderr, "fuzz_seeds: %s cannot be written: is %s a directory?\n", path.c_str(),
                         argv[1]);
            return 1;
        }
    }
    std::printf("%zu inputs in %s\n", seeds.size(), argv[1]);
    return 0;
}
