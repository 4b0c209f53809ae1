// SPDX-License-Identifier: GPL-2.0-or-later
// The float sections without the module round them: as many ticks a second as they can do.
#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <limits>
#include <new>
#include <vector>

#include "border.h"
#include "finding.hpp"
#include "subject.hpp"

extern "C" {
#include "phantom_float.h"
}

namespace phantom::fuzz {

namespace {

/// A tick is done after that many pieces, whatever the set holds: 512 patches in contact, of either model,
/// end below a thousand.
constexpr unsigned sections_max = 4096;

/// Of |F| against its bound: float32 over a sum of a few terms, and the uN it is rounded to.
constexpr double relative_tolerance = 1e-5;
constexpr double absolute_tolerance_un = 2;

struct Free {
    void operator()(void* p) const { std::free(p); }
};
using Memory = std::unique_ptr<void, Free>;

/// What bounds the force of a set, in N and mm.
struct Bounds {
    double stiffness = 0, radius = 0, damping = 0, product = 0;
    double factor = 1;             ///< of contact, by what plays on its surface
    double added = 0, viscous = 0; ///< N, and N per mm/s, beside contact
    double rounding = 0;           ///< rounding_mm() of the set, or more
    Point least{}, greatest{};     ///< of the vertices and the origin, nm

    Bounds() = default;
    Bounds(const phantom_material* materials, std::uint32_t count, const phantom_patch* patches,
           std::uint32_t patch_count)
    {
        for (std::uint32_t i = 0; i < count; ++i) {
            const double k = materials[i].stiffness_mn_mm * 1e-3, r = materials[i].radius_nm * 1e-6;
            stiffness = std::max(stiffness, k);
            radius = std::max(radius, r);
            product = std::max(product, k * r);
            damping = std::max(damping, materials[i].damping_mns_m * 1e-6);
        }
        for (std::uint32_t f = 0; f < patch_count; ++f) {
            for (const auto& vertex : patches[f].vertex_nm) {
                for (std::size_t axis = 0; axis < 3; ++axis) {
                    least[axis] = std::min<std::int64_t>(least[axis], vertex[axis]);
                    greatest[axis] = std::max<std::int64_t>(greatest[axis], vertex[axis]);
                }
            }
        }
        double longest = 0;
        for (std::uint32_t f = 0; f < patch_count; ++f)
            for (int i = 0; i < 3; ++i)
                longest =
                    std::max(longest, distance(patches[f].vertex_nm[i], patches[f].vertex_nm[(i + 1) % 3]));
        rounding = 1e-6 * (1 + longest + radius);
    }

    /// What effects may add: their headers.
    void feel(const phantom_effects& effects)
    {
        constexpr double still_mm = 4e-6; // stick points are in whole nm
        if (effects.magnet)
            added += PHANTOM_EFFECT_FORCE_MAX_UN * 1e-6;
        if (effects.friction) {
            factor += PHANTOM_FRICTION_MAX_PPM * 1e-6;
            added += PHANTOM_EFFECT_STIFFNESS_MAX_MN_MM * 1e-3 * still_mm;
        }
        // of either relief, a slope of 1
        const double slope = (effects.texture != nullptr) + ((effects.mask & PHANTOM_EFFECT_HEIGHT_MAP) != 0);
        if (slope > 0)
            factor += 1.5 * std::sqrt(2.25 + slope * slope);
        if (effects.impact)
            added += PHANTOM_EFFECT_FORCE_MAX_UN * 1e-6;
        if (effects.field)
            added += 2 * PHANTOM_EFFECT_FORCE_MAX_UN * 1e-6; // along each axis
        if (effects.constant)
            added += norm(effects.constant->force_un) * 1e-6;
        if (effects.viscosity)
            viscous += PHANTOM_VISCOSITY_MAX_MNS_M * 1e-6;
        for (std::uint32_t i = 0; i < effects.guide_count; ++i)
            added += effects.guide[i].force_un * 1e-6;
    }

    static double norm(const std::int32_t v[3])
    {
        return std::hypot(double(v[0]), double(v[1]), double(v[2]));
    }

    static double distance(const std::int32_t a[3], const std::int32_t b[3])
    {
        return 1e-6 * std::hypot(double(a[0]) - b[0], double(a[1]) - b[1], double(a[2]) - b[2]);
    }
};

/// One section: its layout of the set, and its tip.
class Section {
  public:
    explicit Section(const phantom_float_ops& ops) : ops_(&ops) { forget(); }

    void take(const phantom_set& set, const border_set& border);
    /// As the servo does: false where the set does not cover what the tick needs.
    bool tick(const Point& tip, const phantom_model& model, const std::int32_t velocity_nm_s[3]);
    void forget();
    [[nodiscard]] const phantom_float_job& job() const { return job_; }
    [[nodiscard]] std::uint32_t refused() const { return refused_; }
    [[nodiscard]] bool fixed() const { return ops_->integer; }

  private:
    bool settle_place(const Point& tip);
    void check() const;

    const phantom_float_ops* ops_;
    Memory memory_;
    Bounds bounds_;
    border_set border_{};
    phantom_float_job job_{};
    std::uint32_t refused_ = 0;
    std::uint32_t effects_ = 0;
    bool valid_ = false, inside_ = false, stuck_ = false;
    Point previous_{}, proxy_{}, anchor_{};
    std::uint32_t coefficient_q24_ = 0;
    phantom_ring ring_{};
    std::uint32_t proxy_face_ = PHANTOM_PATCH_NONE;
};

void Section::forget()
{
    valid_ = inside_ = stuck_ = false;
    ring_ = {};
    proxy_face_ = PHANTOM_PATCH_NONE;
}

void Section::take(const phantom_set& set, const border_set& border)
{
    const auto* patches = reinterpret_cast<const phantom_patch*>(set.patches);
    const phantom_material* materials = border.materials;
    bounds_ = Bounds(materials, set.material_count, patches, set.patch_count);
    border_ = border;
    effects_ = set.effects & ~PHANTOM_EFFECT_TIP;
    if (!(effects_ & PHANTOM_EFFECT_IMPACT))
        ring_ = {};
    stuck_ = stuck_ && effects_ & PHANTOM_EFFECT_FRICTION;
    std::size_t bytes = ops_->set_bytes(set.patch_count);
    if (border.effects) {
        bounds_.feel(*border.effects);
        bytes += ops_->effect_bytes(border.effects, set.material_count);
    }
    // exactly as long as the section asks for: what it touches beyond is found
    void* memory = nullptr;
    if (posix_memalign(&memory, PHANTOM_FLOAT_SET_ALIGN, bytes))
        throw std::bad_alloc();
    memory_.reset(memory);
    std::memset(memory_.get(), 0xa5, bytes);
    phantom_float_prepare prepare{};
    prepare.set = static_cast<phantom_float_set*>(memory_.get());
    prepare.patches = patches;
    prepare.materials = materials;
    prepare.patch_count = set.patch_count;
    prepare.face_count = border.face_count;
    prepare.rim_count = border.rim_count;
    prepare.material_count = set.material_count;
    prepare.effects = border.effects;
    std::copy_n(set.origin_nm, 3, prepare.origin_nm);
    do {
        prepare.count = std::min<std::uint32_t>(set.patch_count - prepare.first, PHANTOM_FLOAT_PREPARE_MAX);
        ops_->prepare(&prepare);
        prepare.first += prepare.count;
    } while (prepare.first < set.patch_count);
    refused_ = prepare.refused;
    must(refused_ <= set.patch_count, "more patches refused than there are");
}

bool Section::settle_place(const Point& tip)
{
    if (!memory_ || !border_relative(&border_, tip.data(), job_.tip_nm))
        return false;
    job_.path_valid = valid_ && border_relative(&border_, previous_.data(), job_.previous_nm);
    if (!job_.path_valid)
        std::copy_n(job_.tip_nm, 3, job_.previous_nm);
    job_.inside = inside_;
    job_.proxy_face = proxy_face_;
    if (!inside_) {
        std::copy_n(job_.tip_nm, 3, job_.proxy_nm);
        return border_covers(&border_, job_.tip_nm, border_.reach_nm);
    }
    return border_relative(&border_, proxy_.data(), job_.proxy_nm) &&
           border_covers(&border_, job_.proxy_nm, 0) && border_covers(&border_, job_.tip_nm, 0);
}

bool Section::tick(const Point& tip, const phantom_model& model, const std::int32_t velocity_nm_s[3])
{
    job_ = {};
    if (!settle_place(tip))
        return false;
    job_.set = static_cast<const phantom_float_set*>(memory_.get());
    job_.model = model;
    job_.effects = effects_;
    job_.period_ns = 1'000'000;
    job_.ring = ring_;
    job_.stick.coefficient_q24 = coefficient_q24_;
    job_.stick.held = stuck_ && border_relative(&border_, anchor_.data(), job_.stick.anchor_nm);
    std::copy_n(velocity_nm_s, 3, job_.velocity_nm_s);
    std::copy_n(border_.centre_nm, 3, job_.centre_nm);
    constexpr std::int64_t most = std::numeric_limits<std::int32_t>::max();
    for (std::size_t axis = 0; axis < 3; ++axis)
        must(job_.tip_nm[axis] - bounds_.least[axis] <= most &&
                 bounds_.greatest[axis] - job_.tip_nm[axis] <= most,
             "a tip that counts as covered is so far from a vertex that the difference wraps");
    job_.radius_nm = border_.radius_nm;
    unsigned sections = 1;
    while (ops_->tick(&job_))
        must(++sections < sections_max, "a tick does not end");
    job_.set = nullptr;
    check();
    valid_ = true;
    previous_ = tip;
    inside_ = job_.inside != 0;
    proxy_face_ = inside_ ? job_.proxy_face : PHANTOM_PATCH_NONE;
    stuck_ = effects_ & PHANTOM_EFFECT_FRICTION && job_.stick_next.held;
    ring_ = effects_ & PHANTOM_EFFECT_IMPACT ? job_.ring_next : phantom_ring{};
    coefficient_q24_ = job_.stick_next.coefficient_q24;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        proxy_[axis] = border_.origin_nm[axis] + job_.proxy_nm[axis];
        anchor_[axis] = border_.origin_nm[axis] + job_.stick_next.anchor_nm[axis];
    }
    return true;
}

/// CONTACT: |F| <= k (R + depth), and what effects add to it.
void Section::check() const
{
    must(!job_.invalid, "the force of an accepted set is no number");
    must(job_.inside <= 1, "`inside` is neither 0 nor 1");
    must(job_.more == 0, "a tick that is done wants more");
    const double depth = job_.inside ? Bounds::distance(job_.proxy_nm, job_.tip_nm) : 0;
    double most = bounds_.product + bounds_.stiffness * (depth + bounds_.rounding);
    const double speed_mm_s = Bounds::norm(job_.velocity_nm_s) * 1e-6;
    if (job_.effects & PHANTOM_EFFECT_DAMPING)
        most += bounds_.damping * speed_mm_s;
    most = most * bounds_.factor + bounds_.added + bounds_.viscous * speed_mm_s;
    // saturated, a component is at the end of its range, and the force was larger
    must(Bounds::norm(job_.force_un) <= most * (1 + relative_tolerance) * 1e6 + absolute_tolerance_un,
         "the force is larger than k (R + depth)");
    for (const std::int32_t component : job_.force_un)
        must(job_.saturated || (component != std::numeric_limits<std::int32_t>::max() &&
                                component != std::numeric_limits<std::int32_t>::min()),
             "a force at the end of its range is not counted as saturated");
    must(Bounds::norm(job_.normal_q30) <= PHANTOM_Q30_ONE * (1 + relative_tolerance),
         "the contact's normal is longer than 1");
    if (!job_.contacts && !job_.inside && !(job_.effects & (PHANTOM_EFFECTS_SPACE | PHANTOM_EFFECT_IMPACT)))
        must(Bounds::norm(job_.force_un) == 0, "there is a force without a contact");
}

class Direct final : public Subject {
  public:
    explicit Direct(std::uint32_t choice) : free_velocity_(choice & 1)
    {
        sections_.emplace_back(phantom_float_sse2);
        if (__builtin_cpu_supports("avx2"))
            sections_.emplace_back(phantom_float_avx2);
        if (__builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512dq"))
            sections_.emplace_back(phantom_float_avx512);
        same_bits_ = sections_.size();
        sections_.emplace_back(phantom_float_double);
        sections_.emplace_back(phantom_float_fixed);
        model_.model = PHANTOM_MODEL_PROJECTED;
        model_.newton_steps = 2;
        model_.combine = PHANTOM_COMBINE_BOUNDED;
        model_.proxy = PHANTOM_PROXY_CONSTRAINED;
    }

    bool submit(const phantom_set& set) override;
    void model(const phantom_model& model) override;
    void tick(const Point& tip_nm) override;
    void control(Control what, std::uint32_t value) override;

  private:
    std::vector<Section> sections_;
    std::size_t same_bits_ = 0; ///< the first so many agree bit by bit
    phantom_model model_{};
    bool free_velocity_; ///< the velocity is any number, not the path's
    std::int32_t velocity_[3] = {0, 0, 0};
    Point last_{};
    std::uint64_t last_id_ = 0;
};

bool Direct::submit(const phantom_set& set)
{
    border_set border{};
    if (border_check(&set, last_id_, &border))
        return false;
    last_id_ = set.id;
    if (!set.patch_count) // no section sees an empty set
        return false;
    for (Section& section : sections_)
        section.take(set, border);
    for (std::size_t i = 1; i < sections_.size(); ++i)
        must(sections_[i].refused() == sections_[0].refused() ||
                 // fixed point has no room for the terms of some that are small
                 (sections_[i].fixed() && sections_[i].refused() > sections_[0].refused()),
             "sections refuse different patches of the same set");
    return true;
}

void Direct::model(const phantom_model& model)
{
    if (model.newton_steps > PHANTOM_NEWTON_STEPS_MAX)
        return;
    model_ = model;
    model_.arith = PHANTOM_ARITH_FLOAT; // each section knows its own
    if (model_.model == PHANTOM_MODEL_OFF || model_.proxy == PHANTOM_PROXY_OFF)
        for (Section& section : sections_)
            section.forget();
}

void Direct::tick(const Point& tip_nm)
{
    if (!free_velocity_) {
        constexpr double ticks_s = 1000, most = std::numeric_limits<std::int32_t>::max();
        for (std::size_t axis = 0; axis < 3; ++axis)
            velocity_[axis] =
                std::int32_t(std::clamp(ticks_s * double(tip_nm[axis] - last_[axis]), -most, most));
    }
    last_ = tip_nm;
    bool first = false;
    for (std::size_t i = 0; i < sections_.size(); ++i) {
        const bool ticked = sections_[i].tick(tip_nm, model_, velocity_);
        if (i == 0)
            first = ticked;
        if (i == 0 || i >= same_bits_)
            continue;
        must(ticked == first &&
                 std::memcmp(&sections_[i].job(), &sections_[0].job(), sizeof(phantom_float_job)) == 0,
             "two instruction sets give different bits");
    }
}

/// Of what a device has, only its velocity means something here, and that the tip's past is forgotten.
void Direct::control(Control what, std::uint32_t value)
{
    if (what == Control::Start)
        for (Section& section : sections_)
            section.forget();
    velocity_[value % 3] = std::int32_t(value);
}

} // namespace

std::unique_ptr<Subject> make_direct(std::uint32_t choice)
{
    return std::make_unique<Direct>(choice);
}

} // namespace phantom::fuzz
