// SPDX-License-Identifier: GPL-2.0-or-later
// The slow task: chooses the triangles near the tip and hands them to the servo as a set.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <stop_token>
#include <vector>

#include "device/device.hpp"
#include "fdh/scene_tree.hpp"
#include "scene/levels.hpp"
#include "scene/live_scene.hpp"
#include "scene/scene.hpp"

namespace phantom::feeder {

class EffectTables;

struct FeederOptions {
    std::uint32_t budget = 64; ///< triangles in a set
    bool all = false;          ///< one set with every triangle of the scene; user mode only
    /// Double the budget (to PHANTOM_PATCHES_MAX) while the set does not cover R and the way to the next.
    bool grow_budget = true;
    /// Of detail, where there are several (use()): that, or the coarsest. Else it is chosen by speed.
    std::optional<std::uint32_t> level{};
    double search_radius_mm = 50.0; ///< no triangle farther than this is looked for
    double rate_hz = 250.0;         ///< of run()
};

/// What one round did.
struct FeedReport {
    std::uint64_t set_id = 0; ///< 0: every slot of the servo was in use, the set before stays
    std::uint32_t patches = 0;
    std::uint32_t level = 0; ///< of detail; hits are of its scene
    double coverage_mm = 0;
    double query_us = 0; ///< hull query alone
    double build_us = 0; ///< query to the set's last byte
    std::vector<fdh::Hit> hits;
};

/// When a set is of, where something moves.
struct SetTime {
    std::uint64_t time_ns = 0;             ///< CLOCK_MONOTONIC, of the poses
    const scene::Moment* moment = nullptr; ///< nothing moves without one
    std::span<const std::uint32_t> near{}; ///< objects that move and may come near before the next set
};

/// Turns hits into a set: world coordinates, origin = the centre, adjacency inside the set. Patches are
/// ordered by object and face, whatever the order of the hits: the same triangles give the same bits. The
/// faces' fans follow them in the same order, then the rims that the force over some of the faces fades at.
/// An object that moves is in its frame (Placement), round the centre as seen from there.
class SetBuilder {
  public:
    /// patches_max: what the device takes in a set; build_all() does not ask.
    /// effects: of that scene, for several builders together; nullptr: the scene's as they are now.
    explicit SetBuilder(const scene::Scene& scene, std::uint32_t patches_max = PHANTOM_PATCHES_MAX,
                        std::shared_ptr<EffectTables> effects = nullptr);
    /// nearest: the answer to a query at the centre (world mm), sorted. Patches, materials or objects beyond
    /// what a set can carry cut it short: the coverage then ends at the first left out.
    void build(const fdh::Nearest& nearest, const std::array<double, 3>& centre_mm, device::PatchSet& out,
               const SetTime& when = {});
    /// Every triangle of the scene, covering everything. centre in world mm.
    void build_all(const std::array<double, 3>& centre_mm, device::PatchSet& out, const SetTime& when = {});

  private:
    /// What an object's patches are written in.
    struct Frame {
        fdh::Pose pose; ///< from the object
        std::array<std::int64_t, 3> origin_nm;
    };
    void begin(const std::array<double, 3>& centre_mm, const SetTime& when, device::PatchSet& out);
    bool claim_object(std::uint32_t object, device::PatchSet& out);
    void start_over(device::PatchSet& out);
    [[nodiscard]] fdh::Pose pose_now(std::uint32_t object) const;
    const Frame& frame_of(std::uint32_t object) const { return frames_[object_slot_[object]]; }
    /// False when the set has no room for the face's material or object.
    bool claim(std::uint32_t object, std::uint32_t face, device::PatchSet& out);
    /// Forgets the numbers that claim() gave for these faces.
    void release(const std::vector<std::array<std::uint32_t, 2>>& faces);
    void fill(const std::vector<std::array<std::uint32_t, 2>>& faces, device::PatchSet& out);
    /// The rims that a set of the first so many hits needs: those within R of what it covers, on the surfaces
    /// that it has faces of.
    void find_rims(const std::vector<fdh::Hit>& hits, const std::array<double, 3>& centre_mm,
                   double coverage_mm);
    void add_rim(std::uint32_t object, std::uint32_t rim, device::PatchSet& out) const;
    void add_fans(std::uint32_t object, std::uint32_t face, device::PatchSet& out) const;
    phantom_patch patch(std::uint32_t object, std::uint32_t face) const;

    const scene::Scene& scene_;
    std::uint32_t patches_max_;
    std::shared_ptr<EffectTables> effects_;
    std::vector<std::uint32_t> slot_;                 ///< scratch: face number to index in the set
    std::vector<std::uint32_t> material_slot_;        ///< scratch: scene material to index in the set
    std::vector<std::uint32_t> claimed_;              ///< scratch: scene material of each one in the set
    std::vector<std::uint32_t> object_slot_;          ///< scratch: scene object to index in the set
    std::vector<std::uint32_t> claimed_objects_;      ///< scratch: scene object of each one in the set
    std::vector<Frame> frames_;                       ///< scratch: of each one in the set
    std::array<double, 3> centre_mm_{};               ///< of the set in hand, and
    SetTime when_;                                    ///< its time
    std::uint32_t moving_ = 0;                        ///< objects in it that move
    std::vector<std::array<std::uint32_t, 2>> faces_; ///< scratch: (object, face)
    struct NeededRim {
        std::uint32_t object, rim;
        std::size_t hits; ///< by every set of at least as many of the hits
    };
    std::vector<NeededRim> rims_;                        ///< scratch
    std::vector<std::array<std::uint32_t, 3>> surfaces_; ///< scratch: (object, surface, its first hit)
    std::vector<mesh::Rims::Near> near_rims_;            ///< scratch
    std::vector<std::size_t> rims_from_;                 ///< scratch: how many more with so many hits
};

/// The longest edge that sets can carry: no triangle may reach farther from the tip than their coordinates.
double edge_max_mm(const FeederOptions& options);

/// Whether sets can carry this scene: no triangle may reach farther from the tip than a set's coordinates
/// (1 m) go, and with `all` the whole scene must lie within them.
Status check_reach(const scene::Scene& scene, const FeederOptions& options);

/// One feeder per device. Not thread-safe but for use(), feel(), totals(), last(), moment() and
/// query_us().
class Feeder {
  public:
    Feeder(const scene::Scene& scene, const fdh::SceneTree<14>& tree, device::Device& device,
           const FeederOptions& options);

    /// What moves and deforms begins now; until then it rests. Nothing happens to a scene at rest.
    void begin_motion();

    /// From the next round on the scene's levels of detail are there to choose from (level_choice.hpp), by
    /// the speed on the status page. A set says which it is of, and the servo fades from one to the other.
    void use(std::shared_ptr<const scene::Levels> levels);

    /// From the next round on the scene's materials and effects are these. As many materials, of the same
    /// contact radii.
    void feel(std::vector<scene::Material> materials, std::vector<scene::SpaceEffect> effects);

    /// Queries round the tip (inside: round the middle of tip and proxy) and submits one set. The set also
    /// covers the tip of the round before, so that the servo sees what the path between them crosses.
    Result<FeedReport> feed(const std::array<double, 3>& tip_mm, const std::array<double, 3>& proxy_mm,
                            bool inside);
    /// As above, with tip and proxy from the status page.
    Result<FeedReport> feed();
    /// Feeds at rate_hz until stopped; early when the servo asks. Returns the first error.
    Status run(std::stop_token stop);

    struct Totals {
        std::uint64_t sets = 0;
        std::vector<std::uint64_t> level_sets;    ///< of these: of each level
        std::uint64_t level_changes = 0;          ///< sets of another level than the one before
        std::vector<float> query_us, interval_ms; ///< the last 65536 of each
    };
    [[nodiscard]] Totals totals() const;
    /// The latest report, for a viewer in another thread.
    [[nodiscard]] FeedReport last() const;
    /// Where everything was for the latest set; nothing where nothing moves or deforms.
    [[nodiscard]] std::shared_ptr<const scene::Moment> moment() const;
    /// What the query for that set took, of the last 4096 sets; 0 when not known.
    [[nodiscard]] double query_us(std::uint64_t set_id) const;

  private:
    struct Impl;
    std::shared_ptr<Impl> impl_;
};

} // namespace phantom::feeder
