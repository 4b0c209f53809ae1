// SPDX-License-Identifier: GPL-2.0-or-later
// The space bar: force to zero and the servo stopped, or both back.
#pragma once

#include "feeder/session.hpp"

namespace phantom::view {

class ServoSwitch {
  public:
    explicit ServoSwitch(feeder::Session& session) : session_(session) {}

    /// Off: the model is set to none, which takes the force to zero within PHANTOM_FADE_NS (STOP alone
    /// ramps for 250 ms), then STOP. On: the model as it was, then START, whose force ramps up.
    Status toggle();
    [[nodiscard]] bool is_off() const { return off_; }

  private:
    feeder::Session& session_;
    phantom_model model_{}; ///< in force before it was switched off
    bool off_ = false;
};

} // namespace phantom::view
