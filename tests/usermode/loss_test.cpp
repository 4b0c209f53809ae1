// SPDX-License-Identifier: GPL-2.0-or-later
// A set that no longer does (phantom_abi.h, COVERAGE): left behind, emptied, stale, cut short by its budget.
// The force fades to zero within PHANTOM_FADE_NS, and comes back as smoothly; with the default limits on, in
// contact and under the surface, at rest and on the move, no step is above the slew limit.
#include "machine.hpp"

namespace phantom::test {
namespace {

enum class Cause { left_coverage, emptied, stale, budget_cut };

struct Loss {
    Cause cause;
    std::int64_t z; ///< of the tip over the plane, nm
    std::uint32_t rate_hz, slew_un_per_ms;
};

class LossOfSets : public MachineTest {
  protected:
    static constexpr std::uint32_t stale_ms = 600;
    static constexpr double speed_nm_s = 100e6; // along the surface

    void run(const Loss& loss);
    std::uint32_t slew() const { return loss_.slew_un_per_ms ? loss_.slew_un_per_ms : 1'000'000; }
    /// A tick; true to what this file is about.
    phantom_tick tick(File& feeder)
    {
        feeder.move(x_, 0, z_);
        step();
        const auto records = feeder.read(4);
        EXPECT_EQ(records.size(), 1u);
        const phantom_tick now = records.empty() ? last_ : records.back();
        EXPECT_LE(distance(now.force_un, last_.force_un), 1e3 * slew() / loss_.rate_hz + 2);
        EXPECT_EQ(now.faults, 0u);
        last_ = now;
        return now;
    }
    void ticks(File& feeder, double seconds)
    {
        for (int i = 0; i < seconds * loss_.rate_hz; ++i)
            tick(feeder);
    }
    void slide() { x_ += std::int64_t(speed_nm_s / loss_.rate_hz); }
    /// The set with which the cause begins; none for the set that is left behind or gets old.
    void cut(File& feeder)
    {
        Plane next(3, 50'000'000, 12 * mm);
        if (loss_.cause == Cause::emptied)
            next.patches.clear();
        else if (loss_.cause == Cause::budget_cut)
            next.header.radius_nm = 2 * mm; // less than R; not as far as from proxy to tip
        else
            return;
        if (loss_.cause == Cause::budget_cut && z_ < 0)
            next.header.centre_nm[2] = std::int32_t(z_);
        ASSERT_EQ(feeder.submit(next), 0);
    }
    /// The tick that the cause counts from.
    bool begun(const phantom_tick& tick) const
    {
        switch (loss_.cause) {
        case Cause::emptied:
            return tick.set_id == 3;
        case Cause::stale:
            return tick.flags & PHANTOM_TICK_STALE;
        default:
            return tick.flags & PHANTOM_TICK_UNCOVERED;
        }
    }

    Loss loss_{};
    std::int64_t x_ = 0, z_ = 0;
    phantom_tick last_{};
};

void LossOfSets::run(const Loss& loss_of)
{
    loss_ = loss_of;
    create({.rate_hz = loss_.rate_hz});
    x_ = 0;
    last_ = {};
    File feeder(machine);
    Plane plane(1, 50'000'000, 12 * mm);
    ASSERT_EQ(feeder.submit(plane), 0);
    z_ = 4 * mm;
    phantom_start start{};
    start.stale_ms = stale_ms;
    start.slew_un_per_ms = loss_.slew_un_per_ms;
    feeder.move(0, 0, z_);
    ASSERT_EQ(feeder.start(start), 0);
    ticks(feeder, 0.26); // the ramp
    while (z_ > loss_.z) {
        z_ = std::max(z_ - 100 * mm / loss_.rate_hz, loss_.z);
        tick(feeder);
    }
    ticks(feeder, 0.02);
    const double full = std::min(3e6 - double(z_), 10e6);
    if (loss_.slew_un_per_ms == 0) {
        ASSERT_NEAR(norm(last_.force_un), full, 100);
    }

    Plane fresh(2, 50'000'000, 12 * mm);
    ASSERT_EQ(feeder.submit(fresh), 0);
    tick(feeder);
    cut(feeder);
    const auto loss = [&] {
        for (std::uint32_t i = 0; i < loss_.rate_hz && !begun(last_); ++i) {
            if (loss_.cause != Cause::stale)
                slide();
            tick(feeder);
        }
        ASSERT_TRUE(begun(last_));
        const std::uint64_t begin = last_.time_ns;
        double before = norm(last_.force_un);
        while (last_.time_ns < begin + PHANTOM_FADE_NS) {
            slide();
            tick(feeder);
            if (loss_.slew_un_per_ms == 0) { // else the force may still be on its way up
                EXPECT_LE(norm(last_.force_un), before + 2) << "no force from a part of the surroundings";
            }
            before = norm(last_.force_un);
        }
        // a slew limit below force / PHANTOM_FADE_NS takes as long as it takes
        if (loss_.slew_un_per_ms == 0) {
            EXPECT_EQ(norm(last_.force_un), 0.0);
        }
        ticks(feeder, 0.03);
    };
    loss();

    Plane back(4, 50'000'000, 40 * mm, {x_, 0, 0});
    back.header.centre_nm[0] = 0;
    ASSERT_EQ(feeder.submit(back), 0);
    ticks(feeder, 0.1);
    if (loss_.slew_un_per_ms != 0)
        return;
    if (loss_.cause == Cause::emptied && z_ < 0) {
        EXPECT_EQ(norm(last_.force_un), 0.0) << "a surface that was not there is not one that was crossed";
    } else {
        EXPECT_NEAR(norm(last_.force_un), full, 100);
    }
}

TEST_F(LossOfSets, FadesWithinTheDocumentedTimeAndComesBackWithoutAStep)
{
    for (const Cause cause : {Cause::left_coverage, Cause::emptied, Cause::stale, Cause::budget_cut}) {
        for (const std::int64_t z : {mm, -5 * mm, -9 * mm}) { // 2 N, 8 N, and what the clamp leaves of 12 N
            for (const std::uint32_t rate_hz : {1000U, 10'000U}) {
                for (const std::uint32_t slew : {0U, 50'000U}) {
                    SCOPED_TRACE(::testing::Message() << "cause " << int(cause) << ", z " << z << " nm, "
                                                      << rate_hz << " Hz, slew " << slew << " uN/ms");
                    run({cause, z, rate_hz, slew});
                }
            }
        }
    }
}

} // namespace
} // namespace phantom::test
