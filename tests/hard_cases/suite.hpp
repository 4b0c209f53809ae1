// SPDX-License-Identifier: GPL-2.0-or-later
// The runner: one hard case, one model, one arithmetic; what came out and what was promised.
#pragma once

#include <array>
#include <span>

#include "contact.hpp"
#include "corpus.hpp"

namespace phantom::hard {

/// The models as the suite runs them.
struct Variant {
    const char* name;
    std::uint32_t model, combine, newton_steps;
};
inline constexpr std::array<Variant, 5> variants{{
    {"projected, 3 steps", PHANTOM_MODEL_PROJECTED, PHANTOM_COMBINE_BOUNDED, 3},
    {"projected, 2 steps", PHANTOM_MODEL_PROJECTED, PHANTOM_COMBINE_BOUNDED, 2},
    {"projected, 1 step", PHANTOM_MODEL_PROJECTED, PHANTOM_COMBINE_BOUNDED, 1},
    {"paper, bounded", PHANTOM_MODEL_PAPER, PHANTOM_COMBINE_BOUNDED, 3},
    {"paper, combine=paper", PHANTOM_MODEL_PAPER, PHANTOM_COMBINE_PAPER, 3},
}};

/// With fewer steps `projected` is bounded and no more. Where triangles are coarse beside R neighbours
/// do not find the same root at their wall then, and a tip on it counts twice or half.
inline constexpr std::uint32_t exact_steps = 2;

/// The proxies that a case is run with: `constrained`, and `paper` too where the tip goes inside.
std::span<const std::uint32_t> proxies_of(const Case& hard);

/// What rounding may do to a force, as a part of kR.
double rounding_of(const phantom_float_ops& ops, const Case& hard);

struct Measured {
    std::uint64_t samples = 0;
    double force = 0;  ///< largest |F|, kR
    double excess = 0; ///< largest |F| / k (R + depth)
    struct Step {
        double step = 0; ///< largest of the force on 1 um, kR
        double jump = 0; ///< what was left of one on 3 nm, kR
        Vec3 jump_at{};
        void add(const Step& other);
    };
    Step outside, inside;          ///< inside: at either end of it
    std::uint64_t gaps = 0;        ///< near the front of a face and without contact
    std::uint64_t doubles = 0;     ///< more force than one full contact has
    std::uint64_t not_numbers = 0; ///< results that were no number
    std::uint64_t fallen = 0;      ///< behind the surface and not inside, or the other way round
    std::uint64_t saturated = 0;   ///< forces cut by the border
    std::uint64_t wrapped = 0;     ///< of them: not at its limit
    unsigned refused = 0;          ///< faces
    Vec3 gap_at{}, double_at{}, fallen_at{};

    void add(const Measured& other);
};

/// A case with what its samples are to be judged by, made once for all runs. Keep the case as long.
class Course {
  public:
    /// `coarseness` times the step of the paths.
    Course(const Case& hard, double coarseness);
    [[nodiscard]] Measured run(const phantom_float_ops& ops, const Variant& variant,
                               std::uint32_t proxy) const;
    /// Of every path, in order.
    [[nodiscard]] const std::vector<std::vector<Vec3>>& samples() const { return samples_; }

  private:
    friend class Run;
    const Case* case_;
    std::vector<std::vector<Vec3>> samples_;
    std::vector<std::vector<bool>> place_; // is the sample a place of its path
    double fine_mm_;
};

/// One sentence for each promise that was not kept.
std::vector<std::string> broken(const Case& hard, const phantom_float_ops& ops, const Variant& variant,
                                const Measured& measured);

/// A mesh as OBJ text, to look at a case that failed.
std::string as_obj(const Triangles& triangles);

} // namespace phantom::hard
