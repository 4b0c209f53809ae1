// SPDX-License-Identifier: GPL-2.0-or-later
// A scene being touched: scene, hierarchy, device, feeder thread and control socket in one object.
// `fdhctl load` and `fdhview` are two faces of it.
#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "device/device.hpp"
#include "feeder/feeder.hpp"
#include "scene/scene.hpp"

namespace phantom::feeder {

struct SessionOptions {
    std::filesystem::path scene;
    scene::LoadOptions load;
    FeederOptions feeder;
    bool force_usermode = false;          ///< do not look for the kernel's device
    std::string node{};                   ///< the kernel's device, that or none; else the first that opens
    std::optional<std::uint32_t> rate_hz; ///< else the scene's [servo] rate, else 1000
    std::optional<phantom_model> model;   ///< else what `servo` and the scene's [servo] say
    std::optional<scene::LevelWish> levels{}; ///< else the scene's, else where an object needs them
    scene::ServoSettings servo{};             ///< word by word over the scene's [servo]
    int cpu = -1;                             ///< user mode: pin the servo to that CPU
    /// Where the simulated tip begins; else above the scene, out of reach of its surface.
    std::optional<std::array<double, 3>> start_tip_mm{};
    phantom_start start{};                         ///< zero fields: the scene's, else the module's defaults
    bool control_socket = true;                    ///< let `fdhctl status|rate|model|stop` reach us
    std::function<void(const std::string&)> say{}; ///< progress lines for a person, may be empty
};

class Session {
  public:
    /// Reads and prepares the scene, builds the hierarchy, opens the device (kernel, else user mode, and says
    /// which).
    static Result<Session> open(SessionOptions options);
    Session(Session&&) noexcept;
    Session& operator=(Session&&) noexcept;
    ~Session(); ///< stop()

    /// Feeds a first set, starts the servo (force ramps up), the feeder thread and the control socket. Levels
    /// of detail are built meanwhile by a thread of low priority: the feeder takes them when they are there.
    Status start();
    /// Ramps the force down, stops servo and threads. Idempotent.
    Status stop();
    [[nodiscard]] bool running() const;
    /// True once somebody asked for the end over the control socket.
    [[nodiscard]] bool stop_requested() const;
    /// Why the feeder ended by itself; nothing while all is well.
    [[nodiscard]] std::optional<Error> failure() const;

    [[nodiscard]] const scene::Scene& scene() const;
    [[nodiscard]] const fdh::SceneTree<14>& tree() const;
    /// Nothing as long as there are none.
    [[nodiscard]] std::shared_ptr<const scene::Levels> levels() const;
    /// What the feeder's hits of that level are of.
    [[nodiscard]] const scene::Scene& scene_of(std::uint32_t level) const;
    [[nodiscard]] device::Device& device();
    [[nodiscard]] Feeder& feeder();
    /// Where the time from open() to the first force went, in ms.
    struct Timings {
        double read_prepare_ms = 0, build_ms = 0, first_force_ms = 0;
    };
    [[nodiscard]] Timings timings() const;
    /// Rate and model as chosen at open().
    [[nodiscard]] std::uint32_t rate_hz() const;
    [[nodiscard]] const phantom_model& model() const;
    /// What START is asked: the options, the scene's [device], and a patient stall limit in user mode.
    [[nodiscard]] phantom_start start_request() const;

  private:
    struct Impl;
    explicit Session(std::unique_ptr<Impl> impl);
    std::unique_ptr<Impl> impl_;
};

} // namespace phantom::feeder
