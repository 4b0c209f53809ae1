// SPDX-License-Identifier: GPL-2.0-or-later
// The closing summary of `fdhctl load`.
#pragma once

#include <string>

#include <nlohmann/json.hpp>

#include "fdhctl/touch_record.hpp"
#include "feeder/session.hpp"

namespace phantom::fdhctl {

class TouchSummary {
  public:
    TouchRecord::Totals touched;
    double path_late_s = 0; ///< by how much a path ran late
    std::string recorded;   ///< what a recording holds, in words

    /// Before the servo stops: what it did in the `seconds` since its start.
    void take(feeder::Session& session, double seconds);
    [[nodiscard]] nlohmann::json json() const;
    [[nodiscard]] std::string text() const;

  private:
    nlohmann::json facts_;
};

} // namespace phantom::fdhctl
