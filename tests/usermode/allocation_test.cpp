// SPDX-License-Identifier: GPL-2.0-or-later
// Every allocation fails once: the call says ENOMEM, nothing leaks, and the next try works.
#include "machine.hpp"

namespace phantom::test {
namespace {

/// Calls `attempt` with the 1st, 2nd, ... allocation failing, until it no longer reaches the failing one.
/// Returns how many failed.
template <class Attempt>
int fail_each_allocation(Attempt attempt)
{
    for (int nth = 1; nth < 100; ++nth) {
        phantom_um_inject_allocation_failure(std::uint32_t(nth));
        const int error = attempt();
        phantom_um_inject_allocation_failure(0);
        if (!error)
            return nth - 1;
        EXPECT_EQ(error, -ENOMEM) << "allocation " << nth;
    }
    ADD_FAILURE() << "never succeeds";
    return 100;
}

TEST(Allocation, CreateSurvivesEachFailure)
{
    const phantom_um_config config{PHANTOM_UM_CLOCK_VIRTUAL, 0, -1, 0, PHANTOM_ISA_NONE, 0};
    const int failed = fail_each_allocation([&] {
        int error = 0;
        phantom_um* machine = phantom_um_create(&config, &error);
        EXPECT_EQ(machine == nullptr, error != 0);
        phantom_um_destroy(machine);
        return error;
    });
    EXPECT_EQ(failed, 4) << "machine, device, page, ring";
}

class AllocationOfAMachine : public MachineTest {};

TEST_F(AllocationOfAMachine, OpenSurvivesEachFailureAndLeavesTheFeederFree)
{
    const int failed = fail_each_allocation([&] {
        File file(machine);
        return file.error();
    });
    EXPECT_EQ(failed, 2);
    File file(machine);
    EXPECT_EQ(file.error(), 0);
}

TEST_F(AllocationOfAMachine, SubmitSurvivesEachFailureAndKeepsTheSetInUse)
{
    File feeder(machine);
    Plane plane(1);
    const int failed = fail_each_allocation([&] { return feeder.submit(plane); });
    EXPECT_EQ(failed, 2) << "the copy, the slot";
    feeder.move(0, 0, 2'000'000);
    ASSERT_EQ(feeder.start_unlimited(), 0);
    step(30);
    Plane next(2);
    const int failed_again = fail_each_allocation([&] { return feeder.submit(next); });
    EXPECT_EQ(failed_again, 1) << "a second slot";
    step();
    EXPECT_EQ(feeder.status().set_id, 2u);
    EXPECT_NEAR(feeder.status().force_un[2], 1'000'000, 5);
}

TEST_F(AllocationOfAMachine, SetWhoseObjectsMoveSurvivesEachFailureOnceASlot)
{
    File feeder(machine);
    const auto moving = [](std::uint64_t id) {
        Plane plane(id);
        plane.objects[0].flags = PHANTOM_OBJECT_MOVES;
        phantom_object beside = plane.objects[0];
        beside.object = 1;
        plane.objects.push_back(beside); // without patches, and so without memory
        return plane;
    };
    feeder.move(0, 0, 2'000'000);
    ASSERT_EQ(feeder.start_unlimited(), 0);
    Plane first = moving(1);
    EXPECT_EQ(fail_each_allocation([&] { return feeder.submit(first); }), 3)
        << "the copy; room to sort it; the object's frame, the scene's is there";
    step(30);
    Plane next = moving(2);
    EXPECT_EQ(fail_each_allocation([&] { return feeder.submit(next); }), 2) << "a second slot";
    step();
    EXPECT_EQ(feeder.status().set_id, 2u);
    EXPECT_NEAR(feeder.status().force_un[2], 1'000'000, 5);
    for (std::uint64_t id = 3; id <= 8; ++id) {
        Plane more = moving(id);
        ASSERT_EQ(feeder.submit(more), 0);
        step(id % 2);
    }
    phantom_um_inject_allocation_failure(1);
    for (std::uint64_t id = 9; id <= 20; ++id) {
        Plane more = moving(id);
        EXPECT_EQ(feeder.submit(more), 0);
        step(id % 3);
    }
    phantom_um_inject_allocation_failure(0);
}

TEST_F(AllocationOfAMachine, SlotsAreReusedWithoutAllocating)
{
    File feeder(machine);
    ASSERT_EQ(feeder.start_unlimited(), 0);
    for (std::uint64_t id = 1; id <= 8; ++id) {
        Plane plane(id);
        ASSERT_EQ(feeder.submit(plane), 0);
        if (id % 2)
            step();
    }
    phantom_um_inject_allocation_failure(1);
    for (std::uint64_t id = 9; id <= 50; ++id) {
        Plane plane(id);
        plane.patches.resize(PHANTOM_PATCHES_MAX, plane.patches[0]);
        EXPECT_EQ(feeder.submit(plane), 0);
        step(id % 3);
    }
    phantom_um_inject_allocation_failure(0);
}

TEST_F(AllocationOfAMachine, LargerReferenceSetThatDoesNotFitLeavesTheOldOne)
{
    create({.patches_max = 4000});
    File feeder(machine);
    Plane plane(1);
    ASSERT_EQ(feeder.submit(plane), 0);
    feeder.move(0, 0, 2'000'000);
    ASSERT_EQ(feeder.start_unlimited(), 0);
    step(30);
    Plane large(2);
    large.patches.resize(4000, large.patches[0]);
    EXPECT_EQ(fail_each_allocation([&] { return feeder.submit(large); }), 2);
    step();
    EXPECT_EQ(feeder.status().set_patches, 4000u);
}

} // namespace
} // namespace phantom::test
