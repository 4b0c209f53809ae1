// SPDX-License-Identifier: GPL-2.0-or-later
#include "suite.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

#include "distance.hpp"

namespace phantom::hard {

namespace {

/// Where the force changes faster than that (of k), 3 times as fast as towards a plane, it is looked at
/// every 1 um, and what is left of such a step on 3 nm is the jump.
constexpr double steep = 3;
constexpr double finest_mm = 3e-6;

std::vector<Vec3> samples_of(const Path& path, double step_mm, std::vector<bool>& place)
{
    std::vector<Vec3> out;
    for (std::size_t i = 0; i < path.places.size(); ++i) {
        const Vec3 to = on_grid(path.places[i]);
        if (i > 0 && step_mm > 0) {
            const Vec3 from = out.back(), way = subtract(to, from);
            const int steps = static_cast<int>(std::ceil(length(way) / step_mm - 1e-9));
            for (int s = 1; s < steps; ++s)
                out.push_back(on_grid(add(from, scale(static_cast<double>(s) / steps, way))));
        }
        place.resize(out.size(), false);
        out.push_back(to);
        place.push_back(true);
    }
    return out;
}

} // namespace

std::span<const std::uint32_t> proxies_of(const Case& hard)
{
    static constexpr std::array<std::uint32_t, 2> both{PHANTOM_PROXY_CONSTRAINED, PHANTOM_PROXY_PAPER};
    return std::span(both).first(hard.penetrates ? 2 : 1);
}

double rounding_of(const phantom_float_ops& ops, const Case& hard)
{
    const double micronewton = 1e-6 / (hard.stiffness * hard.radius); // forces are whole ones

    switch (ops.isa) {
    case PHANTOM_ISA_FIXED:
        return 1e-4 + 2 * micronewton;
    default: // float32; in float64 too, a tip that near to a plane counts as on it
        return 2e-5 + 2 * micronewton;
    }
}

void Measured::Step::add(const Step& other)
{
    step = std::max(step, other.step);
    if (other.jump > jump) {
        jump = other.jump;
        jump_at = other.jump_at;
    }
}

void Measured::add(const Measured& other)
{
    const auto place = [](std::uint64_t before, std::uint64_t more, Vec3& at, const Vec3& from) {
        if (before == 0 && more > 0)
            at = from;
    };
    place(gaps, other.gaps, gap_at, other.gap_at);
    place(doubles, other.doubles, double_at, other.double_at);
    place(fallen, other.fallen, fallen_at, other.fallen_at);
    samples += other.samples;
    force = std::max(force, other.force);
    excess = std::max(excess, other.excess);
    outside.add(other.outside);
    inside.add(other.inside);
    gaps += other.gaps;
    doubles += other.doubles;
    not_numbers += other.not_numbers;
    fallen += other.fallen;
    saturated += other.saturated;
    wrapped += other.wrapped;
    refused = std::max(refused, other.refused);
}

Course::Course(const Case& hard, double coarseness)
    : case_(&hard), fine_mm_(std::max(1e-6, 1e-3 * std::min(1.0, hard.radius)))
{
    for (const Path& path : hard.paths) {
        place_.emplace_back();
        samples_.push_back(samples_of(path, coarseness * path.step_mm, place_.back()));
    }
}

/// One run over the paths of a course.
class Run {
  public:
    Run(const Course& course, const phantom_float_ops& ops, const Variant& variant, std::uint32_t proxy)
        : course_(course),
          case_(*course.case_),
          k_r_(case_.stiffness * case_.radius),
          rounding_(rounding_of(ops, case_))
    {
        Settings settings;
        settings.model = variant.model;
        settings.combine = variant.combine;
        settings.newton_steps = variant.newton_steps;
        settings.proxy = proxy;
        for (const Triangles& set : case_.sets) {
            contacts_.emplace_back(ops, set, settings);
            out_.refused = std::max(out_.refused, contacts_.back().refused());
        }
    }

    Measured all()
    {
        for (std::size_t path = 0; path < case_.paths.size(); ++path)
            walk(path);
        return out_;
    }

  private:
    struct State {
        phantom_float_job job;
        std::size_t turn;
    };

    [[nodiscard]] State save() { return {contacts_[turn_].job(), turn_}; }
    void restore(const State& state)
    {
        turn_ = state.turn;
        contacts_[turn_].job() = state.job;
    }

    /// The next tick, with the set whose turn it is; the state goes on.
    Touch tick(const Vec3& p)
    {
        const phantom_float_job before = contacts_[turn_].job();
        turn_ = (turn_ + 1) % contacts_.size();
        phantom_float_job& job = contacts_[turn_].job();
        const phantom_float_set* set = job.set;
        job = before;
        job.set = set;
        Touch touch = contacts_[turn_].tick(p);
        judge(p, touch);
        return touch;
    }

    void judge(const Vec3& p, const Touch& touch)
    {
        ++out_.samples;
        const double force = length(touch.force);
        const double depth = touch.inside ? length(subtract(touch.proxy, p)) : 0;
        out_.not_numbers += touch.invalid;
        out_.saturated += touch.saturated > 0;
        out_.force = std::max(out_.force, force / k_r_);
        out_.excess = std::max(out_.excess, force / (case_.stiffness * (case_.radius + depth)));
        // a component that was cut stands at the limit on the side that it is on
        Vec3 whole = scale(k_r_, touch.normal);
        if (touch.inside)
            whole = add(whole, scale(case_.stiffness, subtract(touch.proxy, p)));
        for (std::size_t axis = 0; axis < 3 && touch.saturated > 0; ++axis)
            out_.wrapped += std::abs(whole[axis]) > 1 && (whole[axis] > 0) != (touch.force[axis] > 0);
        if (touch.inside)
            return;
        const bool none = touch.contacts == 0;
        if (case_.near_mm > 0 && none) {
            const Nearest at = nearest(case_.sets[0], p);
            if (at.in_front && at.distance < case_.near_mm && out_.gaps++ == 0)
                out_.gap_at = p;
        }
        if (case_.convex && !none) {
            const double most = case_.stiffness * (case_.radius - nearest(case_.sets[0], p).distance);
            if (force > most + 2 * rounding_ * k_r_ && out_.doubles++ == 0)
                out_.double_at = p;
        }
    }

    void expect_side(const Vec3& p, bool inside, bool expected)
    {
        if (inside != expected && out_.fallen++ == 0)
            out_.fallen_at = p;
    }

    /// What of the step from `a` (where `at_a` was saved) to `b` is left on 3 nm, by bisection.
    double what_is_left(State at_a, Vec3 a, Vec3 fa, Vec3 b, Vec3 fb)
    {
        while (length(subtract(a, b)) > finest_mm) {
            const Vec3 middle = on_grid(scale(0.5, add(a, b)));
            if (middle == a || middle == b)
                break;
            restore(at_a);
            const Vec3 fm = tick(middle).force;
            if (length(subtract(fa, fm)) > length(subtract(fm, fb))) {
                b = middle;
                fb = fm;
            } else {
                at_a = save();
                a = middle;
                fa = fm;
            }
        }
        return length(subtract(fa, fb)) / k_r_;
    }

    /// From a to b again, every 1 um.
    Touch look_closer(const State& at_a, const Vec3& a, const Touch& touch_a, const Vec3& b)
    {
        restore(at_a);
        const double fine_mm = course_.fine_mm_;
        const int steps = std::max(1, static_cast<int>(std::ceil(length(subtract(b, a)) / fine_mm - 1e-6)));
        Vec3 before = a;
        Touch touch = touch_a;
        for (int i = 1; i <= steps; ++i) {
            const State state = save();
            const Vec3 p = on_grid(add(a, scale(static_cast<double>(i) / steps, subtract(b, a))));
            const Touch last = touch;
            touch = tick(p);
            Measured::Step& of = last.inside || touch.inside ? out_.inside : out_.outside;
            Measured::Step here{length(subtract(touch.force, last.force)) / k_r_, 0, p};
            if (here.step * k_r_ > steep * case_.stiffness * fine_mm && here.step > of.jump) {
                const State after = save();
                here.jump = what_is_left(state, before, last.force, p, touch.force);
                restore(after);
            }
            of.add(here);
            before = p;
        }
        return touch;
    }

    void walk(std::size_t index)
    {
        const Path& path = case_.paths[index];
        const std::vector<Vec3>& samples = course_.samples_[index];
        contacts_[turn_].restart();
        Touch touch = tick(samples[0]);
        const std::uint32_t proxy = contacts_[turn_].job().model.proxy;
        for (std::size_t i = 1; i < samples.size(); ++i) {
            const State state = save();
            const Touch last = touch;
            touch = tick(samples[i]);
            const double way = length(subtract(samples[i], samples[i - 1]));
            const double step = length(subtract(touch.force, last.force));
            if (path.step_mm > 0 && step > steep * case_.stiffness * way)
                touch = look_closer(state, samples[i - 1], last, samples[i]);
            else if (path.step_mm > 0 && way > 0)
                (last.inside || touch.inside ? out_.inside : out_.outside)
                    .add({step / k_r_ * course_.fine_mm_ / way, 0, {}});
            if (case_.closed && proxy != PHANTOM_PROXY_OFF && course_.place_[index][i]) {
                const Nearest at = nearest(case_.sets[0], samples[i]);
                if (at.distance > 1e-4)
                    expect_side(samples[i], touch.inside, !at.in_front);
            }
        }
        if (path.end != End::any && proxy == PHANTOM_PROXY_CONSTRAINED)
            expect_side(samples.back(), touch.inside, path.end == End::inside);
    }

    const Course& course_;
    const Case& case_;
    const double k_r_, rounding_;
    std::vector<Contact> contacts_;
    std::size_t turn_ = 0;
    Measured out_;
};

Measured Course::run(const phantom_float_ops& ops, const Variant& variant, std::uint32_t proxy) const
{
    return Run(*this, ops, variant, proxy).all();
}

std::vector<std::string> broken(const Case& hard, const phantom_float_ops& ops, const Variant& variant,
                                const Measured& m)
{
    std::vector<std::string> out;
    const bool exact = variant.model == PHANTOM_MODEL_PAPER || variant.newton_steps >= exact_steps;
    const auto at = [](const Vec3& p) { return fmt::format("{:.6f}", fmt::join(p, " ")); };
    if (m.not_numbers > 0)
        out.push_back(fmt::format("{} results were no number", m.not_numbers));
    if (m.wrapped > 0)
        out.push_back(fmt::format("{} forces wrapped", m.wrapped));
    if (!hard.fault.empty())
        return out;
    if (m.excess > 1 + rounding_of(ops, hard) && !hard.saturates)
        out.push_back(fmt::format("|F| is {:.6f} k (R + depth)", m.excess));
    if ((m.saturated > 0) != hard.saturates)
        out.push_back(fmt::format("{} forces saturated", m.saturated));
    // fixed point refuses small faces whose terms do not fit, too: the table counts them
    if (m.refused < hard.refused || (m.refused > hard.refused && ops.isa != PHANTOM_ISA_FIXED))
        out.push_back(fmt::format("{} faces refused, not {}", m.refused, hard.refused));
    if (m.gaps > 0 && exact)
        out.push_back(fmt::format("{} gaps, the first at {}", m.gaps, at(m.gap_at)));
    if (m.doubles > 0 && hard.once && exact)
        out.push_back(fmt::format("{} double forces, the first at {}", m.doubles, at(m.double_at)));
    if (m.fallen > 0)
        out.push_back(fmt::format("{} times on the wrong side, first at {}", m.fallen, at(m.fallen_at)));
    const auto judge = [&](const char* where, const Measured::Step& step, double promised, bool continuous) {
        if (step.step > promised)
            out.push_back(
                fmt::format("{}, a step of {:.4f} kR on 1 um, {:.4f} promised", where, step.step, promised));
        if ((continuous || promised < measured) && step.jump > hard.jump)
            out.push_back(fmt::format("{}, a jump of {:.4f} kR at {}", where, step.jump, at(step.jump_at)));
    };
    if (exact && variant.model == PHANTOM_MODEL_PROJECTED)
        judge("outside", m.outside, hard.projected_step, hard.continuous);
    else if (exact && variant.combine == PHANTOM_COMBINE_BOUNDED)
        judge("outside", m.outside, hard.paper_step, false);
    if (exact && variant.combine == PHANTOM_COMBINE_BOUNDED)
        judge("inside", m.inside, hard.inside_step, false);
    return out;
}

std::string as_obj(const Triangles& triangles)
{
    std::string out;
    std::size_t vertex = 0;
    for (const auto& t : triangles) {
        if (t.fan || t.rim)
            continue;
        for (std::size_t i = 0; i < 3; ++i)
            out += fmt::format("v {:.6f}\nvn {:.9f}\n", fmt::join(t.corner[i], " "),
                               fmt::join(t.normal[i], " "));
        out += fmt::format("f {0}//{0} {1}//{1} {2}//{2}\n", vertex + 1, vertex + 2, vertex + 3);
        vertex += 3;
    }
    return out;
}

} // namespace phantom::hard
