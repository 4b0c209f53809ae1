// SPDX-License-Identifier: GPL-2.0-or-later
#include "view/hand.hpp"

#include <algorithm>

namespace phantom::view {

const Vec3& Hand::step(double dt_s, const Vec3& force_n)
{
    // b x' = K (target - x) + F, no mass: x(t + dt) with F held. The spring's part is exact, so a late
    // step never overshoots.
    const double spring = settings_.spring_n_mm();
    const Vec3 rest = target_ + (1 / spring) * force_n;
    const double part = 1 - std::exp(-dt_s * spring / settings_.damping_ns_mm());
    Vec3 move = part * (rest - tip_);
    const double longest = settings_.max_speed_mm_s * dt_s;
    if (length(move) > longest)
        move = (longest / length(move)) * move;
    tip_ = tip_ + move;
    return tip_;
}

} // namespace phantom::view
