// SPDX-License-Identifier: GPL-2.0-or-later
// fdhctl load: touch a scene until Ctrl-C, `fdhctl stop`, the end of a path or of a time.
#include <unistd.h>

#include <chrono>
#include <cstdio>
#include <memory>
#include <optional>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "base/progress_bar.hpp"
#include "fdhctl/background.hpp"
#include "fdhctl/command_line.hpp"
#include "fdhctl/end_signals.hpp"
#include "fdhctl/level_report.hpp"
#include "fdhctl/touch_record.hpp"
#include "fdhctl/touch_summary.hpp"
#include "fdhctl/view.hpp"
#include "feeder/path_player.hpp"
#include "feeder/session.hpp"
#include "feeder/status_report.hpp"

namespace phantom::fdhctl {

namespace {

using Clock = std::chrono::steady_clock;

struct Options {
    SceneOptions scene;
    ServoOptions servo;
    BudgetOptions budget;
    LevelsOption levels;
    bool view = false, detach = false, usermode = false, json = false;
    std::string path, record, summary, node;
    double seconds = 0; ///< 0: until somebody stops it
    double feed_rate_hz = feeder::FeederOptions{}.rate_hz;
    std::uint32_t crossfade_ms = 0; ///< 0: the scene's
    int cpu = -1;
};

/// Records are read this often; the module's ring holds far more.
constexpr std::chrono::milliseconds collect_period{20};

/// The live status: rewritten in place on a terminal, a line a second elsewhere.
class StatusLine {
  public:
    explicit StatusLine(bool on) : on_(on), terminal_(::isatty(STDOUT_FILENO) == 1) {}
    void show(const device::Device& device)
    {
        const auto now = Clock::now();
        if (!on_ || now < next_)
            return;
        next_ = now + (terminal_ ? std::chrono::milliseconds(100) : std::chrono::milliseconds(1000));
        const std::string line = feeder::status_line(device.status());
        // No wrap while it is drawn: a narrow terminal cuts the line instead of scrolling.
        std::printf(terminal_ ? "\r\033[K\033[?7l%s\033[?7h" : "%s\n", line.c_str());
        std::fflush(stdout);
    }
    void end()
    {
        if (on_ && terminal_)
            std::printf("\r\033[K");
    }

  private:
    bool on_, terminal_;
    Clock::time_point next_{};
};

feeder::SessionOptions session_options(const Options& options, const feeder::Path& path, ProgressBar& bar)
{
    feeder::SessionOptions session;
    session.scene = options.scene.scene;
    session.load = options.scene.load_options();
    session.load.prepare.progress = bar.callback();
    options.budget.apply(session.feeder);
    session.feeder.rate_hz = options.feed_rate_hz;
    session.force_usermode = options.usermode;
    session.node = options.node;
    session.servo = options.servo.words;
    session.levels = options.levels.wish();
    session.start.crossfade_ms = options.crossfade_ms;
    session.cpu = options.cpu;
    if (!path.empty())
        session.start_tip_mm = path.front().tip_mm;
    std::FILE* out = options.json ? stderr : stdout;
    session.say = [out](const std::string& line) {
        std::fprintf(out, "%s\n", line.c_str());
        std::fflush(out);
    };
    return session;
}

Status collect(feeder::Session& session, TouchRecord& record)
{
    return record.collect(session.device(),
                          [&session](std::uint64_t set_id) { return session.feeder().query_us(set_id); });
}

/// Why the touch ended before its time; nothing when it did not.
using Trouble = std::optional<Error>;

/// Until the end of the path or the time, a signal, `stop`, or trouble.
Trouble touch(const Options& options, feeder::Session& session, const EndSignals& signals,
              const feeder::PathPlayer* player, TouchRecord& record)
{
    StatusLine line(!options.json);
    const auto begin = Clock::now();
    Trouble trouble;
    while (!trouble && !signals.wait(collect_period) && !session.stop_requested()) {
        if (Status status = collect(session, record); !status)
            trouble = status.error();
        else if (!session.running())
            trouble = session.failure();
        line.show(session.device());
        const phantom_status now = session.device().status();
        if (player && now.state == PHANTOM_STATE_FAULT)
            trouble = Error{session.device().name(),
                            "the path ended early: fault " + device::fault_names(now.faults)};
        if (player && player->finished())
            break;
        if (options.seconds > 0 &&
            std::chrono::duration<double>(Clock::now() - begin).count() >= options.seconds)
            break;
    }
    line.end();
    return trouble;
}

Status write_summary(const Options& options, const TouchSummary& summary)
{
    if (!options.summary.empty())
        if (Status status = write_file(options.summary, summary.json().dump(2) + "\n"); !status)
            return status;
    if (options.json)
        std::printf("%s\n", summary.json().dump().c_str());
    else
        std::printf("%s", summary.text().c_str());
    return success();
}

int run_touch(const Options& options, Background& background)
{
    const EndSignals signals;
    feeder::Path path;
    if (!options.path.empty()) {
        Result<feeder::Path> read = feeder::read_path(options.path);
        if (!read)
            return fail(read.error());
        path = std::move(*read);
    }
    std::optional<TickFile> ticks;
    if (!options.record.empty()) {
        Result<TickFile> file = TickFile::open(options.record);
        if (!file)
            return fail(file.error());
        ticks.emplace(std::move(*file));
    }
    // Before the session: it listens to the session's device as long as that lives.
    TouchRecord record(std::move(ticks));

    Result<feeder::Session> session = [&] {
        ProgressBar bar("preparing");
        return feeder::Session::open(session_options(options, path, bar));
    }();
    if (!session)
        return fail(session.error());
    print_warnings(session->scene());
    if (!path.empty() && session->device().info().device != PHANTOM_DEVICE_SIM)
        return fail({options.path, "only a simulated device can be driven along a path", "--usermode"});
    if (Status status = record.begin(session->device(), true, options.scene.scene); !status)
        return fail(status.error());
    if (Status status = session->start(); !status)
        return fail(status.error());
    std::fprintf(options.json ? stderr : stdout, "first force after %.2f s: %u Hz, %s%s%s\n",
                 session->timings().first_force_ms * 1e-3, session->rate_hz(),
                 device::model_text(session->model()).c_str(), session->device().is_kernel() ? "" : ", ",
                 session->device().thread_text().c_str());
    background.detach();

    const auto begin = Clock::now();
    TouchSummary summary;
    std::optional<feeder::PathPlayer> player;
    if (!path.empty())
        player.emplace(session->device(), path, session->rate_hz());
    Trouble trouble = touch(options, *session, signals, player ? &*player : nullptr, record);
    summary.take(*session, std::chrono::duration<double>(Clock::now() - begin).count());
    summary.path_late_s = player ? player->late_s() : 0.0;
    player.reset();
    if (Status status = session->stop(); !status && !trouble)
        trouble = status.error();
    if (Status status = collect(*session, record); !status && !trouble)
        trouble = status.error();
    summary.touched = record.totals();
    summary.recorded = record.file_text();
    if (Status status = record.commit(); !status && !trouble)
        trouble = status.error();
    if (Status status = write_summary(options, summary); !status && !trouble)
        trouble = status.error();
    return trouble ? fail(*trouble) : exit_success;
}

int run(const Options& options)
{
    if (options.view) {
        std::vector<std::string> words = options.scene.arguments();
        if (options.usermode)
            words.emplace_back("--usermode");
        if (options.servo.words.rate_hz)
            words.insert(words.end(), {"--rate", fmt::format("{:.0f}", *options.servo.words.rate_hz)});
        if (options.seconds > 0)
            words.insert(words.end(), {"--seconds", fmt::format("{}", options.seconds)});
        return exec_view(words);
    }
    Result<Background> background = options.detach ? Background::fork() : Result<Background>(Background());
    if (!background)
        return fail(background.error());
    if (background->is_parent())
        return background->wait_for_child();
    return run_touch(options, *background);
}

} // namespace

Run add_load(CLI::App& app)
{
    auto options = std::make_shared<Options>();
    options->scene.add(app);
    CLI::Option* view = app.add_flag("--view", options->view, "in a window (fdhview)");
    CLI::Option* detach = app.add_flag("--detach", options->detach,
                                       "go to the background after the first force; prints the process");
    CLI::Option* usermode =
        app.add_flag("--usermode", options->usermode, "do not look for the kernel's device");
    add_device_option(app, options->node)->excludes(usermode)->excludes(view);
    app.add_option("--rate", options->servo.words.rate_hz, "servo rate [1000, or the scene's]")
        ->check(CLI::Range(double{PHANTOM_RATE_MIN_HZ}, double{PHANTOM_RATE_MAX_HZ}))
        ->type_name("HZ");
    options->servo.add(app);
    options->budget.add(app, false);
    options->levels.add(app, "auto, or the scene's; built while it is touched");
    add_feed_rate(app, options->feed_rate_hz, "sets per second at rest; more when the tip asks");
    app.add_option("--crossfade", options->crossfade_ms,
                   "to another level of detail or revision of an object [20, or the scene's]")
        ->check(CLI::Range(1, PHANTOM_RAMP_MAX_MS))
        ->type_name("MS")
        ->excludes(view);
    app.add_option("--cpu", options->cpu, "user mode: pin the servo's thread to this CPU")
        ->check(CLI::Range(0, 1023))
        ->type_name("N");
    app.add_option("--path", options->path, "drive the simulated device along this path, then end")
        ->type_name("P.csv")
        ->excludes(view);
    app.add_option("--record", options->record,
                   "every tick: as a trace (CSV), written whole or not at all; as FILE.rec with all that it "
                   "came from, "
                   "for fdhctl replay")
        ->type_name("T.csv|FILE.rec")
        ->excludes(view);
    app.add_option("--seconds", options->seconds, "end after this time")->check(positive())->type_name("S");
    app.add_option("--summary", options->summary, "the closing summary as a JSON file")
        ->type_name("FILE.json")
        ->excludes(view);
    app.add_flag("--json", options->json, "the closing summary as JSON on stdout, no status line");
    detach->excludes(view);
    return [options] { return run(*options); };
}

} // namespace phantom::fdhctl
