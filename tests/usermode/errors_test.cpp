// SPDX-License-Identifier: GPL-2.0-or-later
// Every call with every wrong field, against the table of errors in phantom_abi.h.
#include <functional>
#include <limits>

#include "machine.hpp"

namespace phantom::test {
namespace {

constexpr std::int64_t too_far = PHANTOM_POSITION_MAX_NM + 1;
/// Nobody's address that is not NULL.
void* const nowhere = reinterpret_cast<void*>(std::uintptr_t{4096});

class Errors : public MachineTest {};

TEST_F(Errors, UnknownNumberIsENOTTY)
{
    File feeder(machine), observer(machine, O_RDONLY);
    EXPECT_EQ(feeder.ioctl(_IO(PHANTOM_IOC_MAGIC, 0x08)), -ENOTTY);
    EXPECT_EQ(feeder.ioctl(_IO(PHANTOM_IOC_MAGIC, 0x00)), -ENOTTY) << "same call, another size";
    EXPECT_EQ(feeder.ioctl(_IO('k', 0x04)), -ENOTTY);
    EXPECT_EQ(feeder.ioctl(0x1'0000'e704UL), -ENOTTY) << "more than 32 bits";
    EXPECT_EQ(observer.ioctl(_IO(PHANTOM_IOC_MAGIC, 0x08)), -ENOTTY);
}

TEST_F(Errors, ObserverMayOnlyAsk)
{
    File observer(machine, O_RDONLY);
    auto info = dirty<phantom_info>();
    EXPECT_EQ(observer.ioctl(PHANTOM_GET_INFO, &info), 0);
    phantom_rate rate{2000, 0};
    phantom_model model{};
    phantom_start start{};
    phantom_sim_move move{};
    Plane plane(1);
    EXPECT_EQ(observer.ioctl(PHANTOM_SET_RATE, &rate), -EBADF);
    EXPECT_EQ(observer.ioctl(PHANTOM_SET_MODEL, &model), -EBADF);
    EXPECT_EQ(observer.ioctl(PHANTOM_START, &start), -EBADF);
    EXPECT_EQ(observer.ioctl(PHANTOM_STOP), -EBADF);
    EXPECT_EQ(observer.ioctl(PHANTOM_SUBMIT_SET, &plane.set()), -EBADF);
    EXPECT_EQ(observer.ioctl(PHANTOM_SIM_MOVE, &move), -EBADF);
    EXPECT_EQ(observer.ioctl(PHANTOM_CLEAR_FAULT), -EBADF);
    EXPECT_EQ(observer.status().rate_hz, 1000u) << "and nothing changed";
}

TEST_F(Errors, UnreadableArgumentIsEFAULT)
{
    File feeder(machine);
    for (void* bad : {static_cast<void*>(nullptr), nowhere})
        for (unsigned long number : {PHANTOM_GET_INFO, PHANTOM_SET_RATE, PHANTOM_SET_MODEL, PHANTOM_START,
                                     PHANTOM_SUBMIT_SET, PHANTOM_SIM_MOVE})
            EXPECT_EQ(feeder.ioctl(number, bad), -EFAULT) << std::hex << number;
}

TEST_F(Errors, UnreadableArrayIsEFAULT)
{
    File feeder(machine);
    Plane plane(1);
    plane.set().patches = 0;
    EXPECT_EQ(feeder.ioctl(PHANTOM_SUBMIT_SET, &plane.header), -EFAULT);
    plane.set().materials = 4096;
    EXPECT_EQ(feeder.ioctl(PHANTOM_SUBMIT_SET, &plane.header), -EFAULT);
    plane.set().objects = 0;
    EXPECT_EQ(feeder.ioctl(PHANTOM_SUBMIT_SET, &plane.header), -EFAULT);
    EXPECT_EQ(feeder.submit(plane), 0) << "the id was not used up";
}

TEST_F(Errors, InfoIsWrittenWhole)
{
    File feeder(machine);
    auto info = dirty<phantom_info>();
    ASSERT_EQ(feeder.ioctl(PHANTOM_GET_INFO, &info), 0);
    EXPECT_EQ(info.abi_version, std::uint32_t(PHANTOM_ABI_VERSION));
    EXPECT_EQ(info.device, std::uint32_t(PHANTOM_DEVICE_SIM));
    EXPECT_EQ(info.patches_max, std::uint32_t(PHANTOM_PATCHES_MAX));
    EXPECT_EQ(info.tick_size, sizeof(phantom_tick));
    EXPECT_GE(info.status_size, sizeof(phantom_status));
    EXPECT_TRUE(info.features & PHANTOM_FEATURE_SIM_MOVE);
    EXPECT_FALSE(info.features & PHANTOM_FEATURE_ARITH_DOUBLE) << "only when the machine was made for it";
    EXPECT_EQ(info.max_force_un, 10'000'000u);
    for (std::uint32_t word : info.reserved)
        EXPECT_EQ(word, 0u);
}

TEST_F(Errors, SetRate)
{
    File feeder(machine);
    for (std::uint32_t hz : {0u, 1u, 999u, 10001u, 0xffffffffu})
        EXPECT_EQ(feeder.rate(hz), -EINVAL) << hz;
    phantom_rate rate{1000, 1};
    EXPECT_EQ(feeder.ioctl(PHANTOM_SET_RATE, &rate), -EINVAL);
    for (std::uint32_t hz : {1000u, 3000u, 10000u}) {
        EXPECT_EQ(feeder.rate(hz), 0);
        EXPECT_EQ(feeder.status().rate_hz, hz);
    }
}

TEST_F(Errors, SetModel)
{
    File feeder(machine);
    const phantom_model good{PHANTOM_MODEL_PAPER, 3, PHANTOM_COMBINE_PAPER, PHANTOM_PROXY_PAPER,
                             PHANTOM_ARITH_FLOAT, {}};
    const auto with = [&](auto change) {
        phantom_model model = good;
        change(model);
        return feeder.ioctl(PHANTOM_SET_MODEL, &model);
    };
    EXPECT_EQ(with([](phantom_model&) {}), 0);
    EXPECT_EQ(feeder.status().model.model, std::uint32_t(PHANTOM_MODEL_PAPER));
    EXPECT_EQ(with([](phantom_model& m) { m.model = 3; }), -EINVAL);
    EXPECT_EQ(with([](phantom_model& m) { m.model = 0x101; }), -EINVAL);
    EXPECT_EQ(with([](phantom_model& m) { m.newton_steps = 4; }), -EINVAL);
    EXPECT_EQ(with([](phantom_model& m) { m.combine = 2; }), -EINVAL);
    EXPECT_EQ(with([](phantom_model& m) { m.proxy = 3; }), -EINVAL);
    EXPECT_EQ(with([](phantom_model& m) { m.arith = 3; }), -EINVAL);
    for (int i = 0; i < 3; ++i)
        EXPECT_EQ(with([i](phantom_model& m) { m.reserved[i] = 1; }), -EINVAL);
    EXPECT_EQ(with([](phantom_model& m) { m.arith = PHANTOM_ARITH_FIXED; }), 0);
    EXPECT_EQ(with([](phantom_model& m) { m.arith = PHANTOM_ARITH_DOUBLE; }), -EOPNOTSUPP);
    EXPECT_EQ(with([](phantom_model& m) { m.model = PHANTOM_MODEL_OFF; }), 0);
}

TEST_F(Errors, DoubleIsOfferedWhenAskedFor)
{
    create({.isa = PHANTOM_ISA_DOUBLE});
    File feeder(machine);
    phantom_info info{};
    ASSERT_EQ(feeder.ioctl(PHANTOM_GET_INFO, &info), 0);
    EXPECT_TRUE(info.features & PHANTOM_FEATURE_ARITH_DOUBLE);
    phantom_model model{PHANTOM_MODEL_PROJECTED, 2, PHANTOM_COMBINE_BOUNDED, PHANTOM_PROXY_PAPER,
                        PHANTOM_ARITH_DOUBLE,    {}};
    EXPECT_EQ(feeder.ioctl(PHANTOM_SET_MODEL, &model), 0);
}

TEST_F(Errors, Start)
{
    File feeder(machine);
    const auto with = [&](auto change) {
        phantom_start start{};
        change(start);
        return feeder.start(start);
    };
    EXPECT_EQ(with([](phantom_start& s) { s.flags = 2; }), -EINVAL);
    EXPECT_EQ(with([](phantom_start& s) { s.crossfade_ms = PHANTOM_RAMP_MAX_MS + 1; }), -EINVAL);
    EXPECT_EQ(with([](phantom_start& s) { s.max_force_un = 10'000'001; }), -EINVAL);
    EXPECT_EQ(with([](phantom_start& s) { s.ramp_ms = PHANTOM_RAMP_MAX_MS + 1; }), -EINVAL);
    EXPECT_EQ(feeder.status().state, std::uint32_t(PHANTOM_STATE_IDLE));
    EXPECT_EQ(with([](phantom_start& s) { s.max_force_un = 10'000'000; }), 0);
    EXPECT_EQ(feeder.start(), -EBUSY);
}

TEST_F(Errors, SimMove)
{
    File feeder(machine);
    phantom_sim_move move{{1, 2, 3}, 1};
    EXPECT_EQ(feeder.ioctl(PHANTOM_SIM_MOVE, &move), -EINVAL);
    EXPECT_EQ(feeder.move(too_far, 0, 0), -EINVAL);
    EXPECT_EQ(feeder.move(0, -too_far, 0), -EINVAL);
    EXPECT_EQ(feeder.move(0, 0, std::numeric_limits<std::int64_t>::min()), -EINVAL);
    EXPECT_EQ(feeder.move(PHANTOM_POSITION_MAX_NM, -PHANTOM_POSITION_MAX_NM, 0), 0);
}

struct BadSet {
    const char* what;
    std::function<void(Plane&)> spoil; ///< before counts and pointers are filled in
    std::function<void(phantom_set&)> spoil_header = {};
};

class BadSets : public MachineTest, public ::testing::WithParamInterface<BadSet> {
  protected:
    void SetUp() override { MachineTest::SetUp(); }
};

TEST_P(BadSets, IsEINVALAndChangesNothing)
{
    File feeder(machine);
    Plane good(1);
    ASSERT_EQ(feeder.submit(good), 0);

    Plane bad(2);
    if (GetParam().spoil)
        GetParam().spoil(bad);
    bad.set();
    if (GetParam().spoil_header)
        GetParam().spoil_header(bad.header);
    EXPECT_EQ(feeder.ioctl(PHANTOM_SUBMIT_SET, &bad.header), -EINVAL) << GetParam().what;

    ASSERT_EQ(feeder.start_unlimited(), 0);
    step();
    EXPECT_EQ(feeder.status().set_id, 1u);
    Plane next(2);
    EXPECT_EQ(feeder.submit(next), 0) << "the refused set's id is still free";
}

/// A fan over the first edge of the first patch, or over its end; well made.
phantom_patch& add_fan(Plane& plane, std::uint32_t kind = PHANTOM_PATCH_EDGE)
{
    phantom_patch fan = plane.patches[0];
    fan.kind = kind;
    fan.face = PHANTOM_PATCH_NONE;
    for (int corner = 0; corner < 3; ++corner)
        fan.neighbour[corner] = PHANTOM_PATCH_NONE;
    for (int corner = kind == PHANTOM_PATCH_EDGE ? 2 : 1; corner < 3; ++corner) {
        std::copy_n(fan.vertex_nm[0], 3, fan.vertex_nm[corner]);
        fan.vertex[corner] = fan.vertex[0];
    }
    plane.patches.push_back(fan);
    return plane.patches.back();
}

/// The first edge of the first patch as a rim; well made.
phantom_patch& add_rim(Plane& plane)
{
    phantom_patch rim = plane.patches[0];
    rim.kind = PHANTOM_PATCH_RIM;
    rim.face = PHANTOM_PATCH_NONE;
    rim.surface = 1;
    for (auto& neighbour : rim.neighbour)
        neighbour = PHANTOM_PATCH_NONE;
    std::copy_n(rim.vertex_nm[1], 3, rim.vertex_nm[2]);
    plane.patches.push_back(rim);
    return plane.patches.back();
}

/// A second object, that may move; no patch is its.
phantom_object& mover(Plane& plane)
{
    phantom_object object = plane.objects[0];
    object.object = 1;
    object.flags = PHANTOM_OBJECT_MOVES;
    plane.objects.push_back(object);
    return plane.objects.back();
}

const BadSet bad_sets[] = {
    {"id 0", {}, [](phantom_set& s) { s.id = 0; }},
    {"id of the last set", {}, [](phantom_set& s) { s.id = 1; }},
    {"flags", {}, [](phantom_set& s) { s.flags = 1; }},
    {"tables that no effect calls for", {}, [](phantom_set& s) { s.effect_bytes = 8; }},
    {"tables longer than any", {}, [](phantom_set& s) { s.effect_bytes = 0xfffffff8; }},
    {"513 patches", {}, [](phantom_set& s) { s.patch_count = PHANTOM_PATCHES_MAX + 1; }},
    {"2^32-1 patches", {}, [](phantom_set& s) { s.patch_count = 0xffffffff; }},
    {"17 materials", {}, [](phantom_set& s) { s.material_count = PHANTOM_MATERIALS_MAX + 1; }},
    {"17 objects", {}, [](phantom_set& s) { s.object_count = PHANTOM_OBJECTS_MAX + 1; }},
    {"unknown effect", {}, [](phantom_set& s) { s.effects = 1u << 31; }},
    {"effect that no material names", {}, [](phantom_set& s) { s.effects = PHANTOM_EFFECT_DAMPING; }},
    {"material's effect missing in the union",
     [](Plane& p) { p.materials[0].effects = PHANTOM_EFFECT_DAMPING; }},
    {"origin too far", {}, [](phantom_set& s) { s.origin_nm[1] = too_far; }},
    {"origin too far below", {}, [](phantom_set& s) { s.origin_nm[2] = -too_far; }},
    {"centre too far", {}, [](phantom_set& s) { s.centre_nm[0] = PHANTOM_COORDINATE_MAX_NM + 1; }},
    {"no objects", [](Plane& p) { p.objects.clear(); }},
    {"no materials", [](Plane& p) { p.materials.clear(); }},
    {"vertex too far", [](Plane& p) { p.patches[1].vertex_nm[2][0] = PHANTOM_COORDINATE_MAX_NM + 1; }},
    {"vertex too far below", [](Plane& p) { p.patches[1].vertex_nm[0][2] = -PHANTOM_COORDINATE_MAX_NM - 1; }},
    {"vertex at the end of s32", [](Plane& p) { p.patches[0].vertex_nm[0][0] = INT32_MIN; }},
    {"zero normal", [](Plane& p) { p.patches[0].normal_q30[1][2] = 0; }},
    {"normal too short", [](Plane& p) { p.patches[0].normal_q30[1][2] = PHANTOM_Q30_ONE - (1 << 20) - 1; }},
    {"normal too long", [](Plane& p) { p.patches[0].normal_q30[1][2] = PHANTOM_Q30_ONE + (1 << 20) + 1; }},
    {"normal at the end of s32",
     [](Plane& p) {
         for (auto& component : p.patches[0].normal_q30[2])
             component = INT32_MIN;
     }},
    {"neighbour out of range", [](Plane& p) { p.patches[0].neighbour[1] = 2; }},
    {"object out of range", [](Plane& p) { p.patches[1].object = 1; }},
    {"material out of range", [](Plane& p) { p.patches[1].material = 1; }},
    {"unknown kind", [](Plane& p) { p.patches[1].kind = PHANTOM_PATCH_RIM + 1; }},
    {"edge with three points", [](Plane& p) { add_fan(p).vertex_nm[2][1] += 1; }},
    {"edge that is a point", [](Plane& p) { add_fan(p, PHANTOM_PATCH_CORNER).kind = PHANTOM_PATCH_EDGE; }},
    {"corner that is an edge", [](Plane& p) { add_fan(p).kind = PHANTOM_PATCH_CORNER; }},
    {"fan with a face number", [](Plane& p) { add_fan(p).face = 7; }},
    {"fan with a neighbour", [](Plane& p) { add_fan(p).neighbour[0] = 0; }},
    {"fan as a neighbour",
     [](Plane& p) {
         add_fan(p);
         p.patches[0].neighbour[0] = 2;
     }},
    {"face after a fan",
     [](Plane& p) {
         add_fan(p);
         p.patches.push_back(p.patches[0]);
     }},
    {"rim that is a face", [](Plane& p) { add_rim(p).vertex_nm[2][1] += 1; }},
    {"rim that is a point",
     [](Plane& p) {
         phantom_patch& rim = add_rim(p);
         std::copy_n(rim.vertex_nm[0], 3, rim.vertex_nm[1]);
         std::copy_n(rim.vertex_nm[0], 3, rim.vertex_nm[2]);
     }},
    {"rim begun with the end that stands twice",
     [](Plane& p) {
         phantom_patch& rim = add_rim(p);
         std::copy_n(rim.vertex_nm[0], 3, rim.vertex_nm[2]);
     }},
    {"rim with a face number", [](Plane& p) { add_rim(p).face = 7; }},
    {"rim with a neighbour", [](Plane& p) { add_rim(p).neighbour[2] = 0; }},
    {"rim without a surface", [](Plane& p) { add_rim(p).surface = 0; }},
    {"rim with a zero normal", [](Plane& p) { add_rim(p).normal_q30[0][2] = 0; }},
    {"rim as a neighbour",
     [](Plane& p) {
         add_rim(p);
         p.patches[0].neighbour[0] = 2;
     }},
    {"face after a rim",
     [](Plane& p) {
         add_rim(p);
         p.patches.push_back(p.patches[0]);
     }},
    {"fan after a rim",
     [](Plane& p) {
         add_rim(p);
         add_fan(p);
     }},
    {"patch reserved", [](Plane& p) { p.patches[1].reserved = 1; }},
    {"radius 0", [](Plane& p) { p.materials[0].radius_nm = 0; }},
    {"damping without the effect", [](Plane& p) { p.materials[0].damping_mns_m = 1; }},
    {"unknown material effect", [](Plane& p) { p.materials[0].effects = 1u << 31; },
     [](phantom_set& s) { s.effects = 1u << 31; }},
    {"material reserved", [](Plane& p) { p.materials[0].reserved[3] = 1; }},
    {"resting object moved", [](Plane& p) { p.objects[0].translation_nm[1] = 1; }},
    {"resting object turned", [](Plane& p) { p.objects[0].rotation_q30[3] = 1; }},
    {"resting object without a rotation", [](Plane& p) { p.objects[0].rotation_q30[0] = 0; }},
    {"resting object moving", [](Plane& p) { p.objects[0].velocity_nm_s[2] = 1; }},
    {"resting object turning", [](Plane& p) { p.objects[0].angular_velocity_urad_s[0] = 1; }},
    {"resting object with an origin", [](Plane& p) { p.objects[0].origin_nm[0] = -1; }},
    {"object reserved", [](Plane& p) { p.objects[0].reserved = 1; }},
    {"object flag", [](Plane& p) { p.objects[0].flags = PHANTOM_OBJECT_MOVES << 1; }},
    {"moving object reserved", [](Plane& p) { mover(p).reserved = 1; }},
    {"moving object with another flag", [](Plane& p) { mover(p).flags |= 1u << 31; }},
    {"moving object without a rotation", [](Plane& p) { mover(p).rotation_q30[0] = 0; }},
    {"rotation too short", [](Plane& p) { mover(p).rotation_q30[0] = PHANTOM_Q30_ONE - (1 << 20) - 1; }},
    {"rotation too long", [](Plane& p) { mover(p).rotation_q30[0] = PHANTOM_Q30_ONE + (1 << 20) + 1; }},
    {"rotation too long in its last part", [](Plane& p) { mover(p).rotation_q30[3] = PHANTOM_Q30_ONE; }},
    {"rotation at the end of s32",
     [](Plane& p) {
         for (auto& component : mover(p).rotation_q30)
             component = INT32_MIN;
     }},
    {"moved too far", [](Plane& p) { mover(p).translation_nm[2] = too_far; }},
    {"moved too far below", [](Plane& p) { mover(p).translation_nm[0] = -too_far; }},
    {"moving origin too far", [](Plane& p) { mover(p).origin_nm[1] = PHANTOM_OBJECT_REACH_NM + 1LL; }},
    {"moving origin too far below", [](Plane& p) { mover(p).origin_nm[2] = -PHANTOM_OBJECT_REACH_NM - 1LL; }},
    {"turning too fast",
     [](Plane& p) { mover(p).angular_velocity_urad_s[1] = -PHANTOM_OBJECT_TURN_MAX_URAD_S - 1; }},
    {"turning too fast about two axes",
     [](Plane& p) {
         mover(p).angular_velocity_urad_s[0] = 71'000'000;
         mover(p).angular_velocity_urad_s[2] = -71'000'000;
     }},
    {"turning at the end of s32",
     [](Plane& p) {
         for (auto& about : mover(p).angular_velocity_urad_s)
             about = INT32_MIN;
     }},
    {"four moving objects",
     [](Plane& p) {
         for (std::uint32_t i = 0; i <= PHANTOM_MOVING_MAX; ++i)
             mover(p).object = i + 1;
     }},
    {"neighbour in the scene of a face that moves",
     [](Plane& p) {
         mover(p);
         p.patches[1].object = 1;
     }},
    {"neighbour of another moving object",
     [](Plane& p) {
         mover(p);
         mover(p).object = 2;
         p.patches[0].object = 1;
         p.patches[1].object = 2;
     }},
    {"the same object twice", [](Plane& p) { p.objects.push_back(p.objects[0]); }},
};

INSTANTIATE_TEST_SUITE_P(Field, BadSets, ::testing::ValuesIn(bad_sets),
                         [](const auto& info) { return "Case" + std::to_string(info.index); });

TEST_F(Errors, LimitsThemselvesAreAccepted)
{
    File feeder(machine);
    Plane plane(0xffff'ffff'ffff'0000);
    plane.patches[0].normal_q30[0][2] = PHANTOM_Q30_ONE - (1 << 20);
    plane.patches[0].normal_q30[1][2] = PHANTOM_Q30_ONE + (1 << 20);
    plane.patches[1].vertex_nm[2][0] = PHANTOM_COORDINATE_MAX_NM;
    plane.patches[1].vertex_nm[2][1] = -PHANTOM_COORDINATE_MAX_NM;
    plane.header.radius_nm = 0xffffffff;
    plane.materials.resize(PHANTOM_MATERIALS_MAX, plane.materials[0]);
    plane.materials[3].effects = PHANTOM_EFFECT_DAMPING;
    plane.materials[3].damping_mns_m = 5;
    plane.header.effects = PHANTOM_EFFECT_DAMPING;
    plane.objects.resize(PHANTOM_OBJECTS_MAX, plane.objects[0]);
    for (std::uint32_t i = 0; i < plane.objects.size(); ++i)
        plane.objects[i].object = i;
    plane.patches.resize(PHANTOM_PATCHES_MAX, plane.patches[0]);
    EXPECT_EQ(feeder.submit(plane), 0);
}

TEST_F(Errors, LimitsOfAMovingObjectAreAccepted)
{
    File feeder(machine);
    Plane plane(1);
    for (std::uint32_t i = 0; i < PHANTOM_MOVING_MAX; ++i) {
        phantom_object& object = mover(plane);
        object.object = i + 1;
        object.rotation_q30[0] = PHANTOM_Q30_ONE + (i ? -1 : 1) * (1 << 20);
        for (int axis = 0; axis < 3; ++axis) {
            object.translation_nm[axis] = i ? PHANTOM_POSITION_MAX_NM : -PHANTOM_POSITION_MAX_NM;
            object.origin_nm[axis] = i ? PHANTOM_OBJECT_REACH_NM : -std::int64_t{PHANTOM_OBJECT_REACH_NM};
            object.velocity_nm_s[axis] = i ? INT32_MAX : INT32_MIN;
        }
        object.angular_velocity_urad_s[i % 3] =
            i ? -PHANTOM_OBJECT_TURN_MAX_URAD_S : PHANTOM_OBJECT_TURN_MAX_URAD_S;
    }
    plane.patches[0].object = plane.patches[1].object = 2;
    EXPECT_EQ(feeder.submit(plane), 0);
    for (phantom_patch& patch : plane.patches)
        for (auto& neighbour : patch.neighbour)
            neighbour = PHANTOM_PATCH_NONE;
    plane.header.id = 2;
    plane.patches[1].object = 3;
    EXPECT_EQ(feeder.submit(plane), 0) << "two faces in two frames";
}

TEST_F(Errors, FansAfterTheFacesAreAccepted)
{
    File feeder(machine);
    Plane plane(1);
    add_fan(plane);
    add_fan(plane, PHANTOM_PATCH_CORNER);
    EXPECT_EQ(feeder.submit(plane), 0);
}

TEST_F(Errors, RimsAfterTheFansAreAccepted)
{
    File feeder(machine);
    Plane plane(1);
    plane.patches[0].surface = plane.patches[1].surface = 0xffffffff;
    add_fan(plane).surface = 0xffffffff;
    add_rim(plane).surface = 0xffffffff;
    add_rim(plane);
    EXPECT_EQ(feeder.submit(plane), 0);
    Plane alone(2);
    const phantom_patch rim = add_rim(alone);
    alone.patches = {rim};
    EXPECT_EQ(feeder.submit(alone), 0) << "no face, no fan: nothing to touch";
}

TEST_F(Errors, EmptySetIsASet)
{
    File feeder(machine);
    Plane plane(1);
    plane.patches.clear();
    plane.materials.clear();
    plane.objects.clear();
    plane.set();
    plane.header.patches = plane.header.materials = plane.header.objects = 0;
    EXPECT_EQ(feeder.ioctl(PHANTOM_SUBMIT_SET, &plane.header), 0);
}

TEST(Create, RefusesWhatItCannotBe)
{
    const auto error_of = [](phantom_um_config config) {
        int error = 0;
        phantom_um* machine = phantom_um_create(&config, &error);
        EXPECT_EQ(machine == nullptr, error != 0);
        if (machine)
            phantom_um_destroy(machine);
        return error;
    };
    EXPECT_EQ(error_of({.clock = 2, .rate_hz = 0, .cpu = -1, .max_force_un = 0, .isa = 0, .patches_max = 0}),
              -EINVAL);
    EXPECT_EQ(
        error_of({.clock = 1, .rate_hz = 999, .cpu = -1, .max_force_un = 0, .isa = 0, .patches_max = 0}),
        -EINVAL);
    EXPECT_EQ(
        error_of(
            {.clock = 1, .rate_hz = 0, .cpu = -1, .max_force_un = 100'000'001, .isa = 0, .patches_max = 0}),
        -EINVAL);
    EXPECT_EQ(error_of({.clock = 1,
                        .rate_hz = 0,
                        .cpu = -1,
                        .max_force_un = 0,
                        .isa = PHANTOM_ISA_FIXED + 1,
                        .patches_max = 0}),
              -EINVAL);
    EXPECT_EQ(
        error_of({.clock = 1, .rate_hz = 10000, .cpu = -1, .max_force_un = 1, .isa = 1, .patches_max = 0}),
        0);
}

} // namespace
} // namespace phantom::test
