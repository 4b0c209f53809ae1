// SPDX-License-Identifier: GPL-2.0-or-later
#include "view/live_view.hpp"

#include <atomic>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <iostream>
#include <optional>
#include <thread>

#include <unistd.h>

#include <nlohmann/json.hpp>
#include <vtkCallbackCommand.h>
#include <vtkCommand.h>
#include <vtkNew.h>
#include <vtkRenderWindowInteractor.h>

#include "feeder/session.hpp"
#include "view/chart_picture.hpp"
#include "view/hand_thread.hpp"
#include "view/history.hpp"
#include "view/live_panel.hpp"
#include "view/mouse_arm.hpp"
#include "view/mouse_style.hpp"
#include "view/script.hpp"
#include "view/servo_switch.hpp"
#include "view/stage.hpp"
#include "view/surface_picker.hpp"

namespace phantom::view {

namespace {

using Clock = std::chrono::steady_clock;

constexpr unsigned long frame_ms = 30;
constexpr double offscreen_seconds = 2; ///< without --seconds
constexpr double chart_window_s = 10;
constexpr double spot_time_constant_s = 0.2; ///< of the close-up's calm way to where it should look
constexpr double least_full_scale_n = 0.5;   ///< of arrows and chart, before there was more force

std::atomic<bool> interrupted{false};

class LiveView : public MouseHandler {
  public:
    LiveView(const Options& options, feeder::Session& session);

    Status run_in_window();
    Status run_without_window(const Script& script);
    [[nodiscard]] Status save_pictures();
    void print_summary();
    /// A press on what the first view shows in its middle, when nobody gives a script.
    [[nodiscard]] Script default_script() const;

    void press(int x, int y) override;
    void drag(int x, int y) override;
    void push(double clicks) override;
    void key(const std::string& name) override;

  private:
    static void on_timer(vtkObject* caller, unsigned long event, void* self, void* data);
    [[nodiscard]] double seconds() const;
    [[nodiscard]] bool over() const;
    void read_ticks();
    void show(double blend);
    void frame();
    void report(const Status& status);
    void apply_arm();
    void follow(const MouseMoment& moment);
    [[nodiscard]] double radius_mm() const { return session_.scene().max_radius_mm(); }

    const Options& options_;
    feeder::Session& session_;
    Stage stage_;
    SurfacePicker picker_;
    ServoSwitch servo_;
    History history_;
    std::optional<HandThread> hand_; ///< only where the arm is simulated
    std::optional<MouseArm> arm_;
    vtkNew<vtkRenderWindowInteractor> interactor_;
    Clock::time_point begin_ = Clock::now(), last_frame_ = begin_;
    Vec3 normal_{0, 0, 1};
    bool quit_ = false, pressed_ = false;
    std::string message_; ///< the latest thing that went wrong, or was done
    std::uint64_t frames_ = 0;
    std::optional<Error> failure_;
};

LiveView::LiveView(const Options& options, feeder::Session& session)
    : options_(options),
      session_(session),
      stage_(session.scene(), options.width, options.height, options.offscreen()),
      picker_(session.scene(), stage_.surfaces()),
      servo_(session)
{
    stage_.set_camera(options.camera.value_or(CameraAngles{}));
    stage_.set_full_scale(least_full_scale_n);
    const phantom_status status = session.device().status();
    const Touch touch = touch_of(status, status.time_ns);
    if ((session.device().info().features & PHANTOM_FEATURE_SIM_MOVE) != 0) {
        HandSettings settings;
        for (const scene::Material& material : session.scene().materials)
            settings.contact_n_mm = std::max(settings.contact_n_mm, material.stiffness_n_mm);
        hand_.emplace(session.device(), settings, touch.tip_mm);
        arm_.emplace(stage_.whole(), picker_, touch.tip_mm);
    } else {
        message_ = "The arm is a real one: the mouse only turns the view.";
    }
}

double LiveView::seconds() const
{
    return std::chrono::duration<double>(Clock::now() - begin_).count();
}

bool LiveView::over() const
{
    return quit_ || interrupted || failure_ || session_.stop_requested() ||
           (options_.seconds && seconds() > *options_.seconds);
}

void LiveView::report(const Status& status)
{
    if (!status)
        message_ = status.error().text();
}

void LiveView::read_ticks()
{
    // A call gives at most 4096 records; at 10 kHz a slow frame leaves more.
    for (;;) {
        auto ticks = session_.device().read_ticks();
        if (!ticks)
            return report(ticks.error());
        history_.append(*ticks);
        if (ticks->size() < 4096)
            break;
    }
    if (session_.failure())
        failure_ = session_.failure();
    if (hand_ && hand_->failure())
        failure_ = hand_->failure();
}

void LiveView::show(double blend)
{
    const phantom_status status = session_.device().status();
    Touch touch = touch_of(status, history_.start_ns());
    if (status.state == PHANTOM_STATE_IDLE && hand_) {
        // No tick reports where the arm is; the hand that holds it knows.
        touch.tip_mm = touch.proxy_mm = hand_->tip_mm();
        touch.force_n = {};
        touch.contacts = 0;
        touch.inside = false;
    }
    const feeder::FeedReport fed = session_.feeder().last();
    const Vec3 reported{static_cast<double>(status.normal_q30[0]), static_cast<double>(status.normal_q30[1]),
                        static_cast<double>(status.normal_q30[2])};
    if (length(reported) > 0)
        normal_ = unit_or(reported, normal_);
    else if (touch.force_norm_n() > 1e-3)
        normal_ = unit_or(touch.force_n, normal_);
    const std::shared_ptr<const scene::Moment> moment = session_.feeder().moment();
    if (moment)
        picker_.follow(session_.scene(), *moment);
    stage_.show(touch, fed.hits, session_.scene_of(fed.level), moment.get(), normal_, radius_mm(), blend);
    stage_.set_panel(
        live_panel(session_.scene(), status, fed, servo_.is_off(), message_, !options_.offscreen()));
    const auto& samples = history_.samples();
    const double now_s = samples.empty() ? 0 : samples.back().time_s;
    stage_.chart().show(samples, std::max(0.0, now_s - chart_window_s), std::max(now_s, 1.0),
                        least_full_scale_n);
}

void LiveView::frame()
{
    read_ticks();
    const auto now = Clock::now();
    const double passed_s = std::chrono::duration<double>(now - last_frame_).count();
    last_frame_ = now;
    show(1 - std::exp(-passed_s / spot_time_constant_s));
    stage_.render();
    ++frames_;
    if (over())
        interactor_->TerminateApp();
}

void LiveView::on_timer(vtkObject* /*caller*/, unsigned long /*event*/, void* self, void* /*data*/)
{
    static_cast<LiveView*>(self)->frame();
}

Status LiveView::run_in_window()
{
    vtkNew<MouseStyle> style;
    style->set_handler(this);
    interactor_->SetRenderWindow(stage_.window());
    interactor_->SetInteractorStyle(style);
    vtkNew<vtkCallbackCommand> timer;
    timer->SetCallback(&LiveView::on_timer);
    timer->SetClientData(this);
    interactor_->AddObserver(vtkCommand::TimerEvent, timer);
    interactor_->Initialize();
    begin_ = last_frame_ = Clock::now();
    frame();
    interactor_->CreateRepeatingTimer(frame_ms);
    if (!over())
        interactor_->Start();
    style->set_handler(nullptr);
    return failure_ ? Status(*failure_) : success();
}

void LiveView::follow(const MouseMoment& moment)
{
    const int* size = stage_.whole()->GetSize();
    const double x = moment.x * size[0], y = moment.y * size[1];
    if (!arm_ || !moment.press) {
        pressed_ = false;
        return;
    }
    if (!pressed_)
        arm_->press(x, y, hand_->tip_mm());
    pressed_ = true;
    arm_->drag(x, y);
    arm_->set_depth(moment.depth_mm);
    apply_arm();
}

Status LiveView::run_without_window(const Script& script)
{
    const double wanted_s = options_.seconds.value_or(std::max(offscreen_seconds, script.rows.back().time_s));
    show(1);
    stage_.render(); // makes the window and the camera's clipping range, which sight lines need
    begin_ = Clock::now();
    while (!over() && seconds() < wanted_s) {
        follow(script.at(seconds()));
        read_ticks();
        std::this_thread::sleep_for(std::chrono::milliseconds(5));
    }
    show(1);
    return failure_ ? Status(*failure_) : success();
}

Script LiveView::default_script() const
{
    const double wanted_s = options_.seconds.value_or(offscreen_seconds);
    Script script;
    script.rows = {{0, 0.5, 0.5, true, 0},
                   {0.4 * wanted_s, 0.5, 0.5, true, 0},
                   {0.8 * wanted_s, 0.5, 0.5, true, radius_mm()}};
    return script;
}

void LiveView::apply_arm()
{
    if (arm_ && hand_)
        hand_->set_target(arm_->target_mm());
}

void LiveView::press(int x, int y)
{
    if (arm_)
        arm_->press(x, y, hand_->tip_mm());
    apply_arm();
}

void LiveView::drag(int x, int y)
{
    if (arm_)
        arm_->drag(x, y);
    apply_arm();
}

void LiveView::push(double clicks)
{
    // Half a contact radius: a few clicks from the first touch to a firm press.
    if (arm_)
        arm_->push(0.5 * radius_mm() * clicks);
    apply_arm();
}

void LiveView::key(const std::string& name)
{
    message_.clear();
    if (name == "space")
        report(servo_.toggle());
    else if (name == "q")
        quit_ = true;
    else if (name == "c")
        report(session_.device().clear_fault());
    else if (name == "r")
        stage_.set_camera(options_.camera.value_or(CameraAngles{}));
    else if (name == "Up")
        push(1);
    else if (name == "Down")
        push(-1);
    else if (name == "s") {
        const auto file = options_.screenshot.value_or("fdhview.png");
        const Status saved = stage_.save_png(file);
        message_ = saved ? "Picture: " + file.string() : saved.error().text();
    }
}

Status LiveView::save_pictures()
{
    if (options_.screenshot) {
        Status saved = stage_.save_png(*options_.screenshot);
        if (!saved)
            return saved;
    }
    if (options_.chart && !history_.samples().empty())
        return save_chart(history_.samples(), std::nullopt, options_, *options_.chart);
    return success();
}

void LiveView::print_summary()
{
    const phantom_status status = session_.device().status();
    nlohmann::json summary;
    summary["device"] = session_.device().name();
    summary["state"] = device::state_name(status.state);
    summary["rate_hz"] = status.rate_hz;
    summary["ticks"] = status.tick;
    summary["missed"] = status.missed;
    summary["sets"] = status.sets;
    summary["faults"] = device::fault_names(status.faults);
    summary["max_force_n"] = history_.max_force_n();
    summary["force_n"] = touch_of(status, 0).force_norm_n();
    summary["contacts"] = status.contacts;
    summary["tip_mm"] = touch_of(status, 0).tip_mm;
    summary["frames"] = frames_;
    summary["seconds"] = seconds();
    std::cout << summary.dump(2) << std::endl;
}

/// Ctrl-C and kill end the application as q does: the force ramps down.
void catch_signals()
{
    struct sigaction action {};
    action.sa_handler = [](int) { interrupted = true; };
    sigemptyset(&action.sa_mask);
    sigaction(SIGINT, &action, nullptr);
    sigaction(SIGTERM, &action, nullptr);
}

feeder::SessionOptions session_options(const Options& options)
{
    feeder::SessionOptions session;
    session.scene = options.scene;
    session.load = options.load;
    session.force_usermode = options.usermode;
    session.rate_hz = options.rate_hz;
    session.control_socket = options.control;
    session.say = [](const std::string& line) { std::fprintf(stderr, "%s\n", line.c_str()); };
    return session;
}

} // namespace

Status run_live_view(const Options& options)
{
    std::optional<Script> script;
    if (options.script) {
        auto read = read_script(*options.script);
        if (!read)
            return read.error();
        script = std::move(*read);
    }
    catch_signals();
    auto session = feeder::Session::open(session_options(options));
    if (!session)
        return session.error();
    if (Status started = session->start(); !started)
        return started;

    Status result = success();
    {
        LiveView view(options, *session);
        if (options.offscreen() || script)
            result = view.run_without_window(script ? *script : view.default_script());
        else
            result = view.run_in_window();
        if (options.json)
            view.print_summary();
        if (result)
            result = view.save_pictures();
    }
    if (Status stopped = session->stop(); !stopped && result)
        return stopped;
    return result;
}

} // namespace phantom::view
