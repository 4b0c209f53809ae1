// SPDX-License-Identifier: GPL-2.0-or-later
#include "script.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <limits>

#include "shapes.hpp"
#include "subject.hpp"

namespace phantom::fuzz {

namespace {

/// What an input may cost, in patches looked at. The overlap test of `paper` grows with the square.
constexpr std::int64_t work_max = 60'000;

std::int64_t tick_work(std::size_t patches)
{
    const auto n = std::int64_t(patches);
    return 1 + n + n * n / 64;
}

/// Translation from the set's origin, origin in the frame, rotation, velocities.
void read_motion(Bytes& in, const Ruler& ruler, phantom_object& object)
{
    object.flags = PHANTOM_OBJECT_MOVES;
    const Point translation = ruler.point(in), origin = ruler.point(in);
    std::array<double, 4> turn{};
    double square = 0;
    for (double& part : turn) {
        part = in.raw<std::int8_t>();
        square += part * part;
    }
    for (std::size_t i = 0; i < 4 && square > 0; ++i)
        object.rotation_q30[i] = std::int32_t(std::lround(turn[i] / std::sqrt(square) * PHANTOM_Q30_ONE));
    for (std::size_t axis = 0; axis < 3; ++axis) {
        object.translation_nm[axis] = translation[axis];
        object.origin_nm[axis] = origin[axis];
        object.velocity_nm_s[axis] = in.raw<std::int8_t>() * 16'000'000;
    }
    // up to 95 rad/s each: some are refused
    for (std::int32_t& about : object.angular_velocity_urad_s)
        about = in.raw<std::int8_t>() * 750'000;
}

class Script {
  public:
    Script(Bytes& in, Subject& subject) : in_(in), subject_(subject) {}

    void run()
    {
        while (!in_.empty() && work_ > 0)
            step();
        subject_.finish();
    }

  private:
    void step();
    void submit(bool spoiled);
    void model();
    void place();
    void touch();
    void move();
    void jump();
    void ticks_to(const Point& target, std::int64_t count);
    void tick(const Point& tip);

    Bytes& in_;
    Subject& subject_;
    SetBuilder set_;
    Ruler ruler_;
    Range last_;
    Point tip_{};
    std::uint64_t id_ = 0;
    std::size_t submitted_ = 0; ///< patches of the set in use
    std::int64_t work_ = work_max;
};

void Script::tick(const Point& tip)
{
    if (work_ <= 0)
        return;
    work_ -= tick_work(submitted_);
    for (std::size_t axis = 0; axis < 3; ++axis)
        tip_[axis] = std::clamp<std::int64_t>(tip[axis], -PHANTOM_POSITION_MAX_NM, PHANTOM_POSITION_MAX_NM);
    subject_.tick(tip_);
}

void Script::ticks_to(const Point& target, std::int64_t count)
{
    const Point from = tip_;
    for (std::int64_t i = 1; i <= count; ++i) {
        Point at = target;
        for (std::size_t axis = 0; axis < 3; ++axis)
            at[axis] -= (target[axis] - from[axis]) / count * (count - i);
        tick(at);
    }
}

void Script::submit(bool spoiled)
{
    phantom_set& set = set_.request(++id_);
    if (spoiled) {
        for (std::uint32_t left = 1 + in_.choose(4); left; --left) {
            const SetBuilder::Part part{in_.choose(4)};
            const auto word = in_.raw<std::uint16_t>();
            set_.spoil(part, word, in_.raw<std::uint32_t>());
        }
    }
    --work_;
    if (!subject_.submit(set))
        return;
    submitted_ = set.patch_count;
    id_ = std::max(id_, std::uint64_t(set.id));
    id_ = std::min(id_, std::numeric_limits<std::uint64_t>::max() - 1);
}

void Script::model()
{
    phantom_model model{};
    const std::uint8_t code = in_.byte(), more = in_.byte();
    model.model = code % 3;
    model.newton_steps = code / 4 % 4;
    model.combine = code / 16 % 2;
    model.proxy = code / 32 % 3;
    model.arith = more % 4;
    if (more > 250) // any value, known or not
        model.newton_steps = in_.raw<std::uint32_t>();
    subject_.model(model);
}

/// The point of a face that bytes name, exactly on a corner or an edge more often than not.
void Script::touch()
{
    constexpr double parts[] = {0, 1, 0.5, 1.0 / 3, 0.25, 0.9};
    const std::size_t face = set_.face_count() ? in_.byte() % set_.face_count() : 0;
    const std::uint8_t where = in_.byte();
    double b0 = parts[where % 6], b1 = parts[where / 6 % 6];
    if (where >= 216) {
        b0 = in_.byte() / 255.0;
        b1 = in_.byte() / 255.0 * (1 - b0);
    } else if (b0 + b1 > 1) {
        b1 = 1 - b0;
    }
    const double height = static_cast<std::int8_t>(in_.byte()) / 64.0 * set_.radius_nm(face);
    Point target = set_.over(face, b0, b1, height);
    target[2] += static_cast<std::int8_t>(in_.byte()); // nm
    ticks_to(target, 1 + in_.choose(32));
}

void Script::move()
{
    const Point way = ruler_.point(in_);
    // positions are within +-1e18: nothing overflows
    ticks_to({tip_[0] + way[0], tip_[1] + way[1], tip_[2] + way[2]}, 1 + in_.choose(64));
}

void Script::jump()
{
    Point at{};
    switch (in_.choose(3)) {
    case 0:
        at = ruler_.point(in_);
        break;
    case 1: // what a set's own coordinates can hold
        for (std::int64_t& x : at)
            x = in_.raw<std::int32_t>();
        break;
    default:
        for (std::int64_t& x : at)
            x = in_.raw<std::int64_t>();
        break;
    }
    tick(at);
}

void Script::place()
{
    Point origin{};
    switch (in_.choose(3)) {
    case 0:
        origin = ruler_.point(in_);
        break;
    case 1:
        origin.fill(std::int64_t(in_.raw<std::int16_t>()) * 1'000'000'000'000);
        break;
    default:
        for (std::int64_t& x : origin)
            x = in_.raw<std::int64_t>();
        break;
    }
    set_.origin(origin);
}

void Script::step()
{
    switch (Operation{std::uint8_t(in_.choose(operations))}) {
    case Operation::Shape:
        last_ = add_shape(in_, ruler_, set_);
        break;
    case Operation::Material: {
        std::uint8_t feel = 0;
        const phantom_material material = read_material(in_, feel);
        set_.material(material, feel);
        break;
    }
    case Operation::Object: {
        phantom_object object{};
        object.object = in_.byte();
        object.revision = in_.byte();
        object.rotation_q30[0] = PHANTOM_Q30_ONE;
        if (object.object >= first_mover)
            read_motion(in_, ruler_, object);
        set_.object(object);
        break;
    }
    case Operation::Ruler:
        ruler_.unit_nm = 1000;
        for (std::uint32_t tens = in_.choose(8); tens; --tens)
            ruler_.unit_nm *= 10;
        break;
    case Operation::Cover: {
        const Point centre = ruler_.point(in_);
        set_.cover(centre, std::uint32_t(std::abs(ruler_.length(in_)) * 2));
        break;
    }
    case Operation::Origin:
        place();
        break;
    case Operation::Weld:
        set_.weld(in_.byte() & 1);
        break;
    case Operation::Repeat: {
        const bool flipped = in_.byte() & 1;
        set_.repeat(last_, ruler_.point(in_), flipped);
        break;
    }
    case Operation::Clear:
        set_.clear();
        break;
    case Operation::Submit:
        submit(false);
        break;
    case Operation::Spoil:
        submit(true);
        break;
    case Operation::Model:
        model();
        break;
    case Operation::Touch:
        touch();
        break;
    case Operation::Move:
        move();
        break;
    case Operation::Jump:
        jump();
        break;
    case Operation::Rest:
        ticks_to(tip_, 1 + in_.byte());
        break;
    case Operation::Control: {
        const Subject::Control what{in_.choose(Subject::controls)};
        work_ -= 100;
        subject_.control(what, in_.raw<std::uint32_t>());
        break;
    }
    }
}

} // namespace

void play(const std::uint8_t* data, std::size_t size)
{
    Bytes in(data, size);
    const std::uint8_t choice = in.byte();
    const std::unique_ptr<Subject> subject = choice & 1 ? make_life(choice >> 1) : make_direct(choice >> 1);
    Script(in, *subject).run();
}

} // namespace phantom::fuzz
