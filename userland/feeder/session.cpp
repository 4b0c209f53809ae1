// SPDX-License-Identifier: GPL-2.0-or-later
#include "feeder/session.hpp"

#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <mutex>
#include <thread>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "feeder/control_socket.hpp"
#include "feeder/path.hpp"
#include "feeder/servo_choice.hpp"
#include "feeder/status_report.hpp"
#include "scene/effect_book.hpp"

namespace phantom::feeder {

namespace {

using Clock = std::chrono::steady_clock;
using nlohmann::json;
using Vector = std::array<double, 3>;

/// The first tick comes within a period of START; a machine that takes this long has no servo.
constexpr std::chrono::milliseconds first_tick_patience{1000};

/// The stall limit in user mode, when none is asked for. The arm is simulated, so nobody is in danger when an
/// ordinary system holds the servo up for a moment, and it does: host stalls of 20 ms are seen.
constexpr std::uint32_t usermode_stall_us = 1'000'000;

/// STOP ramps for start.ramp_ms (default 250 ms); what is waited for beyond that.
constexpr std::chrono::milliseconds stop_patience{2000};

/// Of the thread that builds levels: whatever touches goes first.
constexpr int simplifying_niceness = 19;

/// How far above the scene a simulated tip rests, beyond the contact radius.
constexpr double rest_height_mm = 10.0;

double milliseconds_since(Clock::time_point begin)
{
    return std::chrono::duration<double, std::milli>(Clock::now() - begin).count();
}

/// The kernel's device, or a machine of our own and the sentence for it in `why`.
Result<device::Device> open_device(const SessionOptions& options, std::uint32_t rate_hz, std::string& why)
{
    if (!options.force_usermode) {
        const bool chosen = !options.node.empty();
        std::optional<Error> refusal; // of a device that is there and ours to use
        for (const std::string& node : chosen ? std::vector{options.node} : device::kernel_nodes()) {
            Result<device::Device> kernel = device::Device::open_kernel(device::Access::feeder, node);
            if (kernel)
                return kernel;
            if (why.empty())
                why = fmt::format("no kernel device at {} ({}): user mode", node, kernel.error().what);
            if (!refusal && (chosen || ::access(node.c_str(), R_OK | W_OK) == 0))
                refusal = kernel.error();
        }
        // Busy, or of another version: user mode beside it would be a surprise.
        if (refusal) {
            refusal->remedy = refusal->remedy.empty() ? "--usermode does without it" : refusal->remedy;
            return *refusal;
        }
    }
    device::UsermodeOptions usermode;
    usermode.rate_hz = rate_hz;
    usermode.cpu = options.cpu;
    return device::Device::open_usermode(usermode);
}

Vector rest_position(const scene::Scene& scene)
{
    const mesh::Bounds bounds = scene.bounds();
    return {0.5 * (bounds.low[0] + bounds.high[0]), 0.5 * (bounds.low[1] + bounds.high[1]),
            bounds.high[2] + scene.max_radius_mm() + rest_height_mm};
}

} // namespace

struct Session::Impl {
    SessionOptions options;
    std::optional<control::Lock> lock;
    scene::Scene scene;
    std::optional<fdh::SceneTree<14>> tree;
    std::optional<device::Device> device;
    std::optional<Feeder> feeder;
    phantom_model model{};
    std::atomic<std::uint32_t> rate_hz{0};
    Clock::time_point opened = Clock::now();
    Timings timings;
    bool started = false;
    std::atomic<bool> stop_requested{false};
    mutable std::mutex mutex; ///< protects failure, levels, model and effects
    std::optional<Error> failure;
    std::shared_ptr<const scene::Levels> levels; ///< set once; protected by mutex
    std::optional<scene::EffectBook> effects;    ///< as they are felt now; protected by mutex
    std::jthread feeding;
    std::jthread simplifying;              ///< builds levels
    std::optional<control::Server> server; ///< last: its thread uses all of the above

    void say(const std::string& line) const
    {
        if (options.say)
            options.say(line);
    }

    Status load()
    {
        Result<scene::Scene> loaded = scene::load(options.scene, options.load);
        if (!loaded)
            return loaded.error();
        scene = std::move(*loaded);
        effects.emplace(scene);
        timings.read_prepare_ms = milliseconds_since(opened) - scene.hulls_ms;
        const auto begin = Clock::now();
        tree.emplace(scene::build_tree<14>(scene));
        timings.build_ms = milliseconds_since(begin) + scene.hulls_ms;
        const mesh::Bounds bounds = scene.bounds();
        const bool cached = std::all_of(scene.objects.begin(), scene.objects.end(),
                                        [](const scene::Object& object) { return object.from_cache; });
        say(fmt::format("{}: {} triangles, {:.1f} x {:.1f} x {:.1f} mm, {} in {:.0f} ms, "
                        "FDH14 hierarchy in {:.0f} ms",
                        options.scene.filename().string(), scene.triangles(), bounds.high[0] - bounds.low[0],
                        bounds.high[1] - bounds.low[1], bounds.high[2] - bounds.low[2],
                        cached ? "from the cache" : "read and prepared", timings.read_prepare_ms,
                        timings.build_ms));
        return check_reach(scene, options.feeder);
    }

    scene::LevelWish level_wish() const
    {
        return options.levels.value_or(scene::LevelWish{.on = scene.levels.value_or(true)});
    }

    /// What the levels shall last for: the feeder's own pace, if that is slower than what is promised for.
    scene::LevelOptions level_options() const
    {
        scene::LevelOptions out;
        out.budget = options.feeder.budget;
        out.delay_s = std::max(scene::slow_feed_s, 1.0 / options.feeder.rate_hz);
        out.edge_max_mm = edge_max_mm(options.feeder);
        out.cache = options.load.cache;
        return out;
    }

    void build_levels(const scene::LevelOptions& wanted)
    {
        auto built = std::make_shared<const scene::Levels>(scene::build_levels(scene, *tree, wanted));
        {
            const std::lock_guard guard(mutex);
            levels = built;
        }
        if (built->size() > 1)
            feeder->use(std::move(built));
    }

    /// A level that was asked for is there from the first set on; else none is waited for.
    void begin_levels()
    {
        const scene::LevelWish wish = level_wish();
        if (!wish.on || options.feeder.all || wish.fixed)
            return;
        simplifying = std::jthread([this](const std::stop_token& stop) {
            // On Linux of this thread, and of those that it starts. Refused or not, it goes on.
            (void)::setpriority(PRIO_PROCESS, static_cast<id_t>(::gettid()), simplifying_niceness);
            scene::LevelOptions wanted = level_options();
            wanted.cancelled = [&stop] { return stop.stop_requested(); };
            build_levels(wanted);
        });
    }

    Status open_servo()
    {
        scene::ServoSettings asked = options.servo;
        if (options.rate_hz)
            asked.rate_hz = *options.rate_hz;
        const Result<std::uint32_t> rate = choose_rate(asked, scene.servo);
        if (!rate)
            return rate.error();
        rate_hz = *rate;
        std::string why;
        Result<device::Device> opened_device = open_device(options, *rate, why);
        if (!opened_device)
            return opened_device.error();
        device.emplace(std::move(*opened_device));
        if (!why.empty())
            say(why);
        if (Status status = device->set_rate(*rate); !status)
            return status;
        Result<phantom_model> chosen =
            options.model ? Result<phantom_model>(*options.model)
                          : choose_model(options.servo, scene.servo, device->info().features);
        if (!chosen)
            return chosen.error();
        model = *chosen;
        if (Status status = device->set_model(model); !status)
            return status;
        const scene::LevelWish wish = level_wish();
        FeederOptions feeding_options = options.feeder;
        feeding_options.level = wish.fixed;
        feeder.emplace(scene, *tree, *device, feeding_options);
        if (wish.fixed && !options.feeder.all)
            build_levels(level_options());
        return success();
    }

    phantom_start start_request() const
    {
        phantom_start start = choose_start(options.start, scene.device, scene.servo);
        if (!device->is_kernel() && start.stall_us == 0)
            start.stall_us = usermode_stall_us;
        return start;
    }

    Status first_force()
    {
        if (device->info().device == PHANTOM_DEVICE_SIM) {
            const Vector tip = options.start_tip_mm.value_or(rest_position(scene));
            if (Status status = device->move_simulated_tip(to_nanometres(tip)); !status)
                return status;
            if (Result<FeedReport> report = feeder->feed(tip, tip, false); !report)
                return report.error();
        } else if (Result<FeedReport> report = feeder->feed(); !report) {
            return report.error();
        }
        if (Status status = device->start(start_request()); !status)
            return status;
        started = true;
        const auto begin = Clock::now();
        while (device->status().tick == 0) {
            if (Clock::now() - begin > first_tick_patience)
                return Error{device->name(), "the servo was started and does not tick"};
            std::this_thread::sleep_for(std::chrono::microseconds(100));
        }
        timings.first_force_ms = milliseconds_since(opened);
        feeder->begin_motion();
        return success();
    }

    void begin_feeding()
    {
        feeding = std::jthread([this](const std::stop_token& stop) {
            if (Status status = feeder->run(stop); !status) {
                const std::lock_guard guard(mutex);
                failure = status.error();
            }
        });
    }

    /// Ramps down; the feeder goes on until the ramp is over, or the set would be stale before it.
    Status stop()
    {
        server.reset();
        Status result = success();
        simplifying.request_stop();
        if (started && device) {
            result = device->stop();
            const auto begin = Clock::now();
            while (result.ok() && device->status().state == PHANTOM_STATE_RUNNING &&
                   Clock::now() - begin < stop_patience)
                std::this_thread::sleep_for(std::chrono::milliseconds(1));
            started = false;
        }
        if (simplifying.joinable())
            simplifying.join();
        if (feeding.joinable()) {
            feeding.request_stop();
            feeding.join();
        }
        return result;
    }

    // ---- control socket -------------------------------------------------------------------------

    json status() const
    {
        json answer = status_json(device->status());
        answer["ok"] = true;
        answer["pid"] = ::getpid();
        answer["device"] = device->name();
        answer["thread"] = device->thread_text();
        answer["scene"] = options.scene.string();
        answer["triangles"] = scene.triangles();
        const FeedReport last = feeder->last();
        const std::size_t count = [this] {
            const std::lock_guard guard(mutex);
            return levels ? levels->size() : 1;
        }();
        answer["levels"] = count;
        answer["feeder"] = {{"patches", last.patches},
                            {"coverage_mm", last.coverage_mm},
                            {"query_us", last.query_us},
                            {"feed_us", last.build_us}};
        return answer;
    }

    json change_rate(const json& request)
    {
        scene::ServoSettings asked;
        asked.rate_hz = request.at("rate_hz").get<double>();
        const Result<std::uint32_t> rate = choose_rate(asked, {});
        if (!rate)
            return refusal(rate.error());
        if (Status status = device->set_rate(*rate); !status)
            return refusal(status.error());
        rate_hz = *rate;
        return {{"ok", true}, {"rate_hz", *rate}};
    }

    json change_model(const json& request)
    {
        const std::lock_guard guard(mutex);
        scene::ServoSettings asked;
        const auto word = [&request](const char* key, std::optional<std::string>& out) {
            if (request.contains(key))
                out = request.at(key).get<std::string>();
        };
        word("model", asked.model);
        word("combine", asked.combine);
        word("proxy", asked.proxy);
        word("arith", asked.arith);
        if (request.contains("steps"))
            asked.steps = request.at("steps").get<int>();
        const Result<phantom_model> chosen = change_model_words(model, asked);
        if (!chosen)
            return refusal(chosen.error());
        if (Status status = device->set_model(*chosen); !status)
            return refusal(status.error());
        model = *chosen;
        return {{"ok", true}, {"model", device::model_text(model)}};
    }

    static json effect_json(const scene::EffectBook::Entry& entry)
    {
        json values = json::object();
        for (const scene::EffectBook::Value& value : entry.values) {
            if (!value.word.empty())
                values[value.key] = value.word;
            else if (value.numbers.size() == 1)
                values[value.key] = value.numbers.front();
            else
                values[value.key] = value.numbers;
        }
        return {{"name", entry.name}, {"kind", entry.kind}, {"on", entry.on}, {"values", values}};
    }

    /// Takes what is asked for, if anything, and hands it to the feeder.
    Status change_effect(const std::string& name, const json& request)
    {
        Status status = success();
        if (request.contains("set")) {
            scene::EffectBook::Words words;
            for (const auto& [key, value] : request.at("set").items())
                words.emplace_back(key, value.get<std::string>());
            status = effects->change(name, words);
        } else if (request.contains("on")) {
            status = effects->turn(name, request.at("on").get<bool>());
        } else {
            return status;
        }
        if (status)
            feeder->feel(effects->materials(), effects->effects());
        return status;
    }

    json effect(const json& request)
    {
        const std::lock_guard guard(mutex);
        if (!request.contains("name")) {
            json list = json::array();
            for (const scene::EffectBook::Entry& entry : effects->list())
                list.push_back(effect_json(entry));
            return {{"ok", true}, {"effects", list}};
        }
        const std::string name = request.at("name").get<std::string>();
        if (Status status = change_effect(name, request); !status)
            return refusal(status.error());
        const Result<scene::EffectBook::Entry> entry = effects->entry(name);
        if (!entry)
            return refusal(entry.error());
        return {{"ok", true}, {"effect", effect_json(*entry)}};
    }

    static json refusal(const Error& error) { return {{"ok", false}, {"error", error.text()}}; }

    /// One line in, one line out; see control_socket.hpp.
    std::string answer(const std::string& line)
    {
        json reply;
        try {
            const json request = json::parse(line);
            const std::string command = request.at("command").get<std::string>();
            if (command == "status")
                reply = status();
            else if (command == "rate")
                reply = change_rate(request);
            else if (command == "model")
                reply = change_model(request);
            else if (command == "effect")
                reply = effect(request);
            else if (command == "stop") {
                stop_requested = true;
                reply = {{"ok", true}, {"pid", ::getpid()}};
            } else {
                reply = refusal({"", fmt::format("unknown command '{}'", command)});
            }
        } catch (const json::exception& error) {
            reply = refusal({"", fmt::format("the request is not understood: {}", error.what())});
        }
        return reply.dump();
    }
};

Session::Session(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
Session::Session(Session&&) noexcept = default;
Session& Session::operator=(Session&&) noexcept = default;
Session::~Session()
{
    if (impl_)
        (void)impl_->stop();
}

Result<Session> Session::open(SessionOptions options)
{
    auto impl = std::make_unique<Impl>();
    impl->options = std::move(options);
    if (impl->options.control_socket) {
        Result<control::Lock> lock = control::Lock::take();
        if (!lock)
            return lock.error();
        impl->lock.emplace(std::move(*lock));
    }
    if (Status status = impl->load(); !status)
        return status.error();
    if (Status status = impl->open_servo(); !status)
        return status.error();
    return Session(std::move(impl));
}

Status Session::start()
{
    if (Status status = impl_->first_force(); !status)
        return status;
    impl_->begin_feeding();
    impl_->begin_levels();
    if (impl_->options.control_socket) {
        Impl* impl = impl_.get();
        Result<control::Server> server =
            control::Server::listen([impl](const std::string& line) { return impl->answer(line); });
        if (!server)
            return server.error();
        impl_->server.emplace(std::move(*server));
    }
    return success();
}

Status Session::stop()
{
    return impl_->stop();
}

bool Session::running() const
{
    return impl_->started && !failure();
}

bool Session::stop_requested() const
{
    return impl_->stop_requested;
}

std::optional<Error> Session::failure() const
{
    const std::lock_guard guard(impl_->mutex);
    return impl_->failure;
}

const scene::Scene& Session::scene() const
{
    return impl_->scene;
}

const fdh::SceneTree<14>& Session::tree() const
{
    return *impl_->tree;
}

std::shared_ptr<const scene::Levels> Session::levels() const
{
    const std::lock_guard guard(impl_->mutex);
    return impl_->levels;
}

const scene::Scene& Session::scene_of(std::uint32_t level) const
{
    const auto levels = this->levels(); // once they are there they stay
    return level > 0 && levels && level < levels->size() ? levels->coarser[level - 1].scene : impl_->scene;
}

device::Device& Session::device()
{
    return *impl_->device;
}

Feeder& Session::feeder()
{
    return *impl_->feeder;
}

Session::Timings Session::timings() const
{
    return impl_->timings;
}

std::uint32_t Session::rate_hz() const
{
    return impl_->rate_hz;
}

const phantom_model& Session::model() const
{
    return impl_->model;
}

phantom_start Session::start_request() const
{
    return impl_->start_request();
}

} // namespace phantom::feeder
