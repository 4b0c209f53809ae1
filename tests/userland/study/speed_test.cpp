// SPDX-License-Identifier: GPL-2.0-or-later
// Fast jabs at thin, small and narrow things, with every limit on and sets that come late: the whole chain
// from query to force. Up to the documented speed (start.max_speed_um_s, 5 m/s) the tip is held; beyond it
// there is a fault and no force. A force is never larger than what its depth asks for, never pulls, never
// steps by more than the slew limit.
#include <cmath>
#include <functional>
#include <optional>
#include <stdexcept>

#include <gtest/gtest.h>

#include "base/vector.hpp"
#include "device/device.hpp"
#include "feeder/feeder.hpp"
#include "feeder/path.hpp"
#include "mesh/fans.hpp"
#include "mesh/prepare.hpp"
#include "scenes.hpp"

namespace phantom::test {
namespace {

constexpr double stiffness_n_mm = 1.0, radius_mm = 2.0, rate_hz = 1000.0;
constexpr double slew_n_per_tick = 1.0; ///< the default: 1 N per ms
constexpr double rounding_n = 1e-4;

/// Corners to +-half on every side, in squares of about `grid_mm`.
mesh::Soup block(const Vec3& half, double grid_mm)
{
    mesh::Soup soup;
    for (int side = 0; side < 6; ++side) {
        const int axis = side / 2, u = (axis + 1) % 3, v = (axis + 2) % 3;
        const double sign = side % 2 ? -1.0 : 1.0;
        const auto squares = [&](int along) {
            return std::max(1U, static_cast<unsigned>(std::ceil(2 * half[along] / grid_mm)));
        };
        const unsigned columns = squares(u), rows = squares(v);
        const auto base = static_cast<std::uint32_t>(soup.vertices.size());
        for (unsigned j = 0; j <= rows; ++j) {
            for (unsigned i = 0; i <= columns; ++i) {
                Vec3 at{};
                at[axis] = sign * half[axis];
                at[u] = half[u] * (2.0 * i / columns - 1);
                at[v] = half[v] * (2.0 * j / rows - 1);
                soup.vertices.push_back(at);
            }
        }
        for (unsigned j = 0; j < rows; ++j) {
            for (unsigned i = 0; i < columns; ++i) {
                const std::uint32_t a = base + j * (columns + 1) + i, b = a + 1, c = b + columns + 1,
                                    d = c - 1;
                soup.faces.push_back(sign > 0 ? mesh::Triple{a, b, c} : mesh::Triple{a, c, b});
                soup.faces.push_back(sign > 0 ? mesh::Triple{a, c, d} : mesh::Triple{a, d, c});
            }
        }
    }
    return soup;
}

/// Two walls that meet in the line x = z = 0 at that angle, 20 mm high, 40 mm long, open above.
mesh::Soup groove(double degrees)
{
    constexpr double high_mm = 20, long_mm = 20;
    constexpr unsigned rows = 20;
    const double wide_mm = high_mm * std::tan(degrees / 2 * M_PI / 180);
    mesh::Soup soup;
    for (unsigned j = 0; j <= rows; ++j)
        for (const double x : {-wide_mm, 0.0, wide_mm})
            soup.vertices.push_back({x, long_mm * (2.0 * j / rows - 1), x == 0 ? 0.0 : high_mm});
    for (unsigned j = 0; j < rows; ++j) {
        for (unsigned i = 0; i < 2; ++i) {
            const std::uint32_t a = 3 * j + i, b = a + 1, c = b + 3, d = c - 1;
            soup.faces.push_back({a, b, c});
            soup.faces.push_back({a, c, d});
        }
    }
    return soup;
}

scene::Scene scene_of(const mesh::Soup& soup)
{
    Result<mesh::Prepared> prepared = mesh::prepare(soup, {}, "a shape");
    if (!prepared)
        throw std::runtime_error(prepared.error().text());
    scene::Scene scene;
    scene.materials.push_back({"hard", stiffness_n_mm, radius_mm, {}});
    add_object(scene, std::move(prepared->mesh), {}, 0);
    scene.objects[0].fans = mesh::make_fans(scene.objects[0].mesh);
    return scene;
}

void check(const Status& status)
{
    if (!status)
        throw std::runtime_error(status.error().text());
}

/// A hand that holds the arm, its servo with the default limits, and a feeder that knows where the tip was
/// a tick ago.
class Hand {
  public:
    Hand(const mesh::Soup& soup, unsigned feed_every)
        : scene_(scene_of(soup)), tree_(scene::build_tree<14>(scene_)), feed_every_(feed_every)
    {
        device::UsermodeOptions options;
        options.virtual_clock = true;
        Result<device::Device> device = device::Device::open_usermode(options);
        if (!device)
            throw std::runtime_error(device.error().text());
        device_.emplace(std::move(*device));
        feeder_.emplace(scene_, tree_, *device_, feeder::FeederOptions{});
    }

    /// Puts the tip there and waits until the ramp is over.
    void begin(const Vec3& at)
    {
        tip_ = at;
        check(device_->move_simulated_tip(feeder::to_nanometres(tip_)));
        phantom_start start{};
        start.ramp_ms = 20;
        check(device_->start(start));
        stay(0.03);
    }
    void stay(double seconds)
    {
        for (int i = 0; i < seconds * rate_hz; ++i)
            tick(tip_);
    }
    void go(const Vec3& to, double speed_m_s)
    {
        const Vec3 from = tip_;
        const double way = length(to - from), step = speed_m_s * 1e3 / rate_hz;
        for (double gone = step; gone < way; gone += step)
            tick(from + (gone / way) * (to - from));
        tick(to);
    }

    [[nodiscard]] const phantom_tick& last() const { return last_; }
    [[nodiscard]] Vec3 force() const { return force_; }
    [[nodiscard]] bool inside() const { return (last_.flags & PHANTOM_TICK_INSIDE) != 0; }

    /// What this place asks for; or what is left of a larger force that the slew limit or a fade takes away.
    void expect_no_more_than(double newtons) const
    {
        const bool fading = (last_.flags & PHANTOM_TICK_FADING) != 0;
        const double left = length(before_) - (fading ? 0.0 : slew_n_per_tick);
        EXPECT_LE(length(force_), std::max(newtons, left) + rounding_n) << "tick " << last_.tick;
    }

    std::function<void(const Hand&)> rule; ///< after every tick

  private:
    void tick(const Vec3& tip)
    {
        if (number_++ % feed_every_ == 0) {
            const Result<feeder::FeedReport> report = feeder_->feed();
            if (!report)
                throw std::runtime_error(report.error().text());
        }
        tip_ = tip;
        check(device_->move_simulated_tip(feeder::to_nanometres(tip)));
        check(device_->step(1));
        const auto ticks = device_->read_ticks();
        if (!ticks || ticks->size() != 1)
            throw std::runtime_error("expected one record a tick");
        before_ = force_;
        last_ = ticks->front();
        force_ = {1e-6 * last_.force_un[0], 1e-6 * last_.force_un[1], 1e-6 * last_.force_un[2]};
        if (last_.faults) {
            EXPECT_EQ(length(force_), 0.0) << "a force in FAULT";
        } else {
            EXPECT_LE(length(force_ - before_), slew_n_per_tick + rounding_n) << "tick " << last_.tick;
        }
        if (rule)
            rule(*this);
    }

    scene::Scene scene_;
    fdh::SceneTree<14> tree_;
    unsigned feed_every_, number_ = 0;
    std::optional<device::Device> device_;
    std::optional<feeder::Feeder> feeder_;
    Vec3 tip_{}, force_{}, before_{};
    phantom_tick last_{};
};

struct Jab {
    double speed_m_s;
    unsigned feed_every;
};

class Speed : public ::testing::TestWithParam<Jab> {
  protected:
    [[nodiscard]] bool allowed() const { return GetParam().speed_m_s < 5; }
    void expect_outcome(const Hand& hand) const
    {
        EXPECT_EQ(hand.last().faults, allowed() ? 0U : PHANTOM_FAULT_OVERSPEED);
    }
};

TEST_P(Speed, ThroughAPlateOfAFifthOfAMillimetreIsHeldOrAFault)
{
    constexpr double top_mm = 0.1;
    for (const double grid_mm : {40.0, 2.0}) { // 12 triangles; 64 of them reach some 6 mm
        for (const double aside_mm : {0.0, 30.0}) {
            SCOPED_TRACE(testing::Message() << grid_mm << " mm grid, aside " << aside_mm);
            Hand hand(block({40, 40, top_mm}, grid_mm), GetParam().feed_every);
            hand.rule = [&](const Hand& h) {
                const double depth = top_mm - 1e-6 * static_cast<double>(h.last().tip_nm[2]);
                EXPECT_GE(h.force()[2], -rounding_n) << "pulls";
                h.expect_no_more_than(stiffness_n_mm * std::max(0.0, radius_mm + depth));
                EXPECT_LE(std::hypot(h.force()[0], h.force()[1]), 0.01) << "not along the normal";
            };
            hand.begin({-aside_mm, 3, 60});
            hand.go({0, 3, -3}, GetParam().speed_m_s);
            hand.stay(0.05);
            expect_outcome(hand);
            if (!allowed())
                continue;
            EXPECT_TRUE(hand.inside());
            EXPECT_NEAR(hand.force()[2], stiffness_n_mm * (radius_mm + top_mm + 3), 1e-3);
            hand.go({10, -7, -3}, GetParam().speed_m_s);
            hand.stay(0.05);
            EXPECT_NEAR(hand.force()[2], stiffness_n_mm * (radius_mm + top_mm + 3), 1e-3);
            hand.go({10, -7, 1.1}, GetParam().speed_m_s);
            hand.stay(0.05);
            EXPECT_FALSE(hand.inside());
            EXPECT_NEAR(hand.force()[2], stiffness_n_mm * (radius_mm - 1), 1e-3);
        }
    }
}

TEST_P(Speed, IntoABoxSmallerThanTheContactRadiusIsHeldOrAFault)
{
    Hand hand(block({0.6, 0.5, 0.4}, 40), GetParam().feed_every);
    hand.rule = [&](const Hand& h) {
        Vec3 tip{}, proxy{};
        for (int axis = 0; axis < 3; ++axis) {
            tip[axis] = 1e-6 * static_cast<double>(h.last().tip_nm[axis]);
            proxy[axis] = 1e-6 * static_cast<double>(h.last().proxy_nm[axis]);
        }
        h.expect_no_more_than(stiffness_n_mm * (radius_mm + length(tip - proxy)));
    };
    hand.begin({0.1, 0.1, 60});
    hand.go({0.1, 0.1, -0.3}, GetParam().speed_m_s);
    hand.stay(0.05);
    expect_outcome(hand);
    if (!allowed())
        return;
    EXPECT_TRUE(hand.inside());
    EXPECT_NEAR(hand.force()[2], stiffness_n_mm * (radius_mm + 0.7), 1e-3) << "by the side it came in";
    hand.go({0.1, 0.1, 1.4}, GetParam().speed_m_s);
    hand.stay(0.05);
    EXPECT_FALSE(hand.inside());
    EXPECT_NEAR(hand.force()[2], stiffness_n_mm * (radius_mm - 1.0), 1e-3) << "its exact distance";
    hand.go({0.1, 0.1, -3}, GetParam().speed_m_s); // through it in a tick or two
    hand.stay(0.05);
    EXPECT_TRUE(hand.inside());
    EXPECT_NEAR(hand.force()[2], stiffness_n_mm * (radius_mm + 3.4), 1e-3) << "as a thin plate does";
}

TEST_P(Speed, IntoAGrooveOfFiveDegreesIsHeldAtItsBottomOrAFault)
{
    Hand hand(groove(5), GetParam().feed_every);
    hand.rule = [&](const Hand& h) {
        const double z = 1e-6 * static_cast<double>(h.last().tip_nm[2]);
        // between the walls both push, against each other: bounded, never more than one of them
        h.expect_no_more_than(stiffness_n_mm * (radius_mm + std::max(0.0, -z)));
        EXPECT_NEAR(h.force()[1], 0, 0.01);
        // The signed sum takes one folded shell away over the bottom edge, where both walls' shells lie: on
        // walls so steep that outweighs their lift, and draws the tip down by that much at most.
        EXPECT_GE(h.force()[2], -stiffness_n_mm * std::max(0.0, radius_mm - z) - rounding_n);
    };
    hand.begin({0, 0.3, 15});
    if (!allowed())
        hand.go({0, 0.3, 60}, 1); // a way that is long enough to be too fast on
    hand.go({0, 0.3, -1}, GetParam().speed_m_s);
    hand.stay(0.05);
    expect_outcome(hand);
    if (!allowed())
        return;
    EXPECT_TRUE(hand.inside());
    EXPECT_NEAR(hand.force()[2], stiffness_n_mm * (radius_mm + 1), 1e-3);
    EXPECT_NEAR(hand.force()[0], 0, 1e-3);
    hand.go({0, 0.3, 10}, GetParam().speed_m_s);
    hand.stay(0.05);
    EXPECT_FALSE(hand.inside());
    EXPECT_LE(std::abs(hand.force()[0]), 0.01) << "one wall as the other";
}

INSTANTIATE_TEST_SUITE_P(MetresPerSecond, Speed,
                         ::testing::Values(Jab{1, 1}, Jab{3, 1}, Jab{4.9, 1}, Jab{1, 4}, Jab{3, 4},
                                           Jab{5.3, 1}, Jab{10, 1}, Jab{10, 4}),
                         [](const auto& info) {
                             return std::to_string(static_cast<int>(info.param.speed_m_s * 10)) +
                                    "TenthsSetEvery" + std::to_string(info.param.feed_every);
                         });

} // namespace
} // namespace phantom::test
