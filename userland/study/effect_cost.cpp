// SPDX-License-Identifier: GPL-2.0-or-later
#include "study/effect_cost.hpp"

#include <algorithm>
#include <random>

#include "device/device.hpp"
#include "feeder/feeder.hpp"
#include "feeder/path.hpp"
#include "study/tick_cost.hpp"

namespace phantom::study {

namespace {

constexpr std::size_t sets = 32;

/// Everybody takes turns so often, and the quickest turn counts: others use this machine too.
constexpr int turns = 3;

/// The scene with that effect and no other.
scene::Scene only(const scene::Scene& scene, const std::string& effect)
{
    scene::Scene out = scene;
    for (scene::Material& material : out.materials) {
        const auto keep = [&effect](const char* name, auto& slot) {
            if (effect != name)
                slot.reset();
        };
        keep("damping", material.damping_ns_m);
        keep("magnet", material.magnet);
        keep("friction", material.friction);
        keep("texture", material.texture);
        keep("height_map", material.height_map);
        keep("impact", material.impact);
    }
    std::erase_if(out.effects, [&effect](const scene::SpaceEffect& of) { return of.kind() != effect; });
    return out;
}

struct Measured {
    double tick_ns = 0;
    std::size_t contact_bytes = 0, table_bytes = 0;
};

class Ticks {
  public:
    Ticks(const scene::Scene& scene, const fdh::SceneTree<14>& tree, device::Device& device,
          std::uint32_t budget)
        : tree_(tree), device_(device), builder_(scene), budget_(budget)
    {
    }

    Result<Measured> measure(const std::vector<Vec3>& points)
    {
        Measured out;
        std::mt19937_64 random(2);
        std::vector<double> samples;
        for (const Vec3& point : points) {
            near_.clear();
            tree_.nearest(point, budget_, feeder::FeederOptions{}.search_radius_mm, near_);
            near_.sort();
            builder_.build(near_, point, set_);
            out.contact_bytes =
                std::max(out.contact_bytes, sizeof set_.header + set_.patches.size() * sizeof(phantom_patch) +
                                                set_.materials.size() * sizeof(phantom_material) +
                                                set_.objects.size() * sizeof(phantom_object));
            out.table_bytes = std::max(out.table_bytes, set_.effect_tables.size() * sizeof(std::uint64_t));
            if (Status status = tick_through(wander(point, random), samples); !status)
                return status.error();
        }
        out.tick_ns = Distribution::of(std::move(samples)).median;
        return out;
    }

  private:
    Status tick_through(const std::vector<Vec3>& tips, std::vector<double>& samples)
    {
        if (Result<bool> taken = device_.try_submit(set_); !taken)
            return taken.error();
        if (!started_) {
            phantom_start start{};
            start.flags = PHANTOM_START_LIMITS_OFF;
            if (Status status = device_.start(start); !status)
                return status;
            started_ = true;
        }
        return time_whole_ticks(device_, tips, samples);
    }

    const fdh::SceneTree<14>& tree_;
    device::Device& device_;
    feeder::SetBuilder builder_;
    std::uint32_t budget_;
    bool started_ = false;
    fdh::Nearest near_;
    device::PatchSet set_;
};

Result<Measured> measure_once(const scene::Scene& scene, const fdh::SceneTree<14>& tree,
                              const std::vector<Vec3>& points, phantom_model model, std::uint32_t isa,
                              std::uint32_t budget)
{
    Result<device::Device> device = open_to_measure(model, isa);
    if (!device)
        return device.error();
    return Ticks(scene, tree, *device, budget).measure(points);
}

} // namespace

Result<std::vector<EffectCost>> measure_effects(const scene::Scene& scene, const fdh::SceneTree<14>& tree,
                                                phantom_model model, std::uint32_t isa, std::uint32_t budget)
{
    std::vector<std::string> names = scene.effects_called_for();
    names.insert(names.begin(), contact_alone);
    std::vector<EffectCost> costs;
    const std::vector<Vec3> points = points_near_surface(scene, sets, 1);
    for (int turn = 0; turn < turns; ++turn)
        for (std::size_t i = 0; i < names.size(); ++i) {
            const Result<Measured> measured =
                measure_once(only(scene, names[i]), tree, points, model, isa, budget);
            if (!measured)
                return measured.error();
            if (turn == 0)
                costs.push_back(
                    {names[i], measured->tick_ns, i == 0 ? measured->contact_bytes : measured->table_bytes});
            costs[i].tick_ns = std::min(costs[i].tick_ns, measured->tick_ns);
        }
    for (std::size_t i = 1; i < costs.size(); ++i)
        costs[i].tick_ns = std::max(0.0, costs[i].tick_ns - costs[0].tick_ns);
    return costs;
}

} // namespace phantom::study
