// SPDX-License-Identifier: GPL-2.0-or-later
// The slow task: chooses the triangles near the tip and hands them to the servo as a set.
#pragma once

#include <atomic>
#include <cstdint>
#include <stop_token>
#include <vector>

#include "device/device.hpp"
#include "fdh/scene_tree.hpp"
#include "scene/scene.hpp"

namespace phantom::feeder {

struct FeederOptions {
    std::uint32_t budget = 64; ///< triangles in a set; all: every triangle of the scene, user mode only
    bool all = false;
    bool grow_budget =
        true; ///< double the budget (to 512) while the set does not cover R and the way to the next
    double search_radius_mm = 50.0; ///< no triangle farther than this is looked for
    double rate_hz = 250.0;         ///< of run()
};

/// What one round did.
struct FeedReport {
    std::uint64_t set_id = 0;
    std::uint32_t patches = 0;
    double coverage_mm = 0;
    double query_us = 0; ///< hull query alone
    double build_us = 0; ///< query to the set's last byte
    std::vector<fdh::Hit> hits;
};

/// Turns hits into a set: world coordinates, origin near the centre, adjacency inside the set.
class SetBuilder {
  public:
    explicit SetBuilder(const scene::Scene& scene);
    /// centre in world mm; coverage in mm as the query gave it.
    void build(const std::vector<fdh::Hit>& hits, const std::array<double, 3>& centre_mm, double coverage_mm,
               device::PatchSet& out);

  private:
    const scene::Scene& scene_;
    std::vector<std::uint32_t> slot_; ///< scratch: face number to index in the set
};

/// One feeder per device. Not thread-safe but for last().
class Feeder {
  public:
    Feeder(const scene::Scene& scene, const fdh::SceneTree<14>& tree, device::Device& device,
           const FeederOptions& options);

    /// Queries round the tip (inside: round the middle of tip and proxy) and submits one set.
    Result<FeedReport> feed(const std::array<double, 3>& tip_mm, const std::array<double, 3>& proxy_mm,
                            bool inside);
    /// As above, with tip and proxy from the status page.
    Result<FeedReport> feed();
    /// Feeds at rate_hz until stopped; early when the servo asks. Returns the first error.
    Status run(std::stop_token stop);

    struct Totals {
        std::uint64_t sets = 0;
        std::vector<float> query_us, interval_ms; ///< the last 65536 of each
    };
    [[nodiscard]] Totals totals() const;
    /// The latest report, for a viewer in another thread.
    [[nodiscard]] FeedReport last() const;

  private:
    struct Impl;
    std::shared_ptr<Impl> impl_;
};

} // namespace phantom::feeder
