// SPDX-License-Identifier: GPL-2.0-or-later
#include "view/hand_thread.hpp"

#include <algorithm>
#include <chrono>

#include "feeder/path.hpp"

namespace phantom::view {

namespace {

using Clock = std::chrono::steady_clock;
constexpr auto period = std::chrono::milliseconds(1);
/// After a pause of the thread the arm goes on as if it had been this long: a leap would be an overspeed.
constexpr double longest_step_s = 0.0015;

} // namespace

HandThread::HandThread(device::Device& device, const HandSettings& settings, const Vec3& tip_mm)
    : device_(device), hand_(settings, tip_mm), thread_([this](const std::stop_token& stop) { run(stop); })
{
}

HandThread::~HandThread() = default;

void HandThread::set_target(const Vec3& target_mm)
{
    const std::lock_guard guard(mutex_);
    hand_.set_target(target_mm);
}

Vec3 HandThread::target_mm() const
{
    const std::lock_guard guard(mutex_);
    return hand_.target_mm();
}

Vec3 HandThread::tip_mm() const
{
    const std::lock_guard guard(mutex_);
    return hand_.tip_mm();
}

std::optional<Error> HandThread::failure() const
{
    const std::lock_guard guard(mutex_);
    return failure_;
}

void HandThread::run(const std::stop_token& stop)
{
    auto before = Clock::now();
    while (!stop.stop_requested()) {
        std::this_thread::sleep_for(period);
        const auto now = Clock::now();
        const double passed_s = std::chrono::duration<double>(now - before).count();
        before = now;

        const phantom_status status = device_.status();
        Vec3 force_n{};
        if (status.state == PHANTOM_STATE_RUNNING)
            for (std::size_t i = 0; i < 3; ++i)
                force_n[i] = 1e-6 * status.force_un[i];
        Vec3 tip_mm{};
        {
            const std::lock_guard guard(mutex_);
            tip_mm = hand_.step(std::min(passed_s, longest_step_s), force_n);
        }
        if (Status moved = device_.move_simulated_tip(feeder::to_nanometres(tip_mm)); !moved) {
            const std::lock_guard guard(mutex_);
            failure_ = moved.error();
            return;
        }
    }
}

} // namespace phantom::view
