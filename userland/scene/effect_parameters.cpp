// SPDX-License-Identifier: GPL-2.0-or-later
#include "scene/effect_parameters.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <fmt/format.h>

namespace phantom::scene {

namespace {

constexpr std::array<std::string_view, 3> guide_words = {"point", "line", "plane"};

/// A relief rises 45 degrees at most; the rest is for the rounding of what the module is told.
constexpr double slope_max = 0.999;

/// As the module counts it: the sum over the axes.
double slope_per_mm(const Grating& grating)
{
    double sum = 0;
    for (const double component : grating.direction)
        sum += std::abs(component);
    return 2 * std::numbers::pi * sum / grating.wavelength_mm;
}

double length(const std::array<double, 3>& a)
{
    return std::hypot(a[0], a[1], a[2]);
}

} // namespace

const char* SpaceEffect::kind() const
{
    return space_kinds[law.index()].data();
}

void parameters(Material& material, Parameters& out)
{
    out.number("stiffness_n_mm", material.stiffness_n_mm, range::stiffness_n_mm, Need::optional);
    out.number("damping_ns_m", material.damping_ns_m, range::damping_ns_m);
}

void parameters(Magnet& magnet, Parameters& out)
{
    out.number("range_mm", magnet.range_mm, range::length_mm, Need::required);
    out.number("force_n", magnet.force_n, range::effect_force_n, Need::required);
}

void parameters(Friction& friction, Parameters& out)
{
    out.number("static", friction.statical, range::friction, Need::required);
    out.number("dynamic", friction.dynamic, range::friction);
    out.number("stiffness_n_mm", friction.stiffness_n_mm, range::effect_stiffness_n_mm);
    out.number("stribeck_mm_s", friction.stribeck_mm_s, range::stribeck_mm_s, Need::optional);
}

void parameters(Grating& grating, Parameters& out)
{
    out.number("amplitude_mm", grating.amplitude_mm, range::amplitude_mm, Need::required);
    out.number("wavelength_mm", grating.wavelength_mm, range::wavelength_mm, Need::required);
    out.direction("direction", grating.direction, Need::optional);
}

void parameters(ConstantForce& constant, Parameters& out)
{
    out.vector("force_n", constant.force_n, range::constant_force_n, Need::required);
}

void parameters(Viscosity& viscosity, Parameters& out)
{
    out.number("viscosity_ns_m", viscosity.viscosity_ns_m, range::viscosity_ns_m, Need::optional);
    out.number("drag_ns2_m2", viscosity.drag_ns2_m2, range::drag_ns2_m2, Need::optional);
    out.vector("centre_mm", viscosity.centre_mm, range::position_mm, Need::optional);
    out.number("radius_mm", viscosity.radius_mm, range::region_mm);
    out.number("border_mm", viscosity.border_mm, range::region_mm);
}

void parameters(Guide& guide, Parameters& out)
{
    auto to = static_cast<std::size_t>(guide.to);
    out.word("to", to, guide_words);
    guide.to = static_cast<Guide::Place>(to);
    out.vector("point_mm", guide.point_mm, range::position_mm, Need::required);
    out.direction("direction", guide.direction, Need::optional);
    out.number("stiffness_n_mm", guide.stiffness_n_mm, range::effect_stiffness_n_mm, Need::required);
    out.number("force_n", guide.force_n, range::guide_force_n, Need::required);
    out.number("reach_mm", guide.reach_mm, range::region_mm);
}

std::optional<Contradiction> contradiction(const Magnet& magnet, const Material& of)
{
    if (magnet.range_mm >= of.radius_mm)
        return Contradiction{"range_mm",
                             fmt::format("is {:g}, expected less than the material's radius_mm, {:g}",
                                         magnet.range_mm, of.radius_mm)};
    return std::nullopt;
}

std::optional<Contradiction> contradiction(const Friction& friction)
{
    if (friction.dynamic && *friction.dynamic > friction.statical)
        return Contradiction{"dynamic", fmt::format("is {:g}, expected no more than static, {:g}",
                                                    *friction.dynamic, friction.statical)};
    return std::nullopt;
}

std::optional<Contradiction> contradiction(const Grating& grating, const Grating* other)
{
    const double taken = other ? other->amplitude_mm * slope_per_mm(*other) : 0.0;
    const double most = std::max(0.0, slope_max - taken) / slope_per_mm(grating);
    if (grating.amplitude_mm > most)
        return Contradiction{"amplitude_mm",
                             fmt::format("is {:g}, expected at most {:.3g} for waves of {:g} mm{}",
                                         grating.amplitude_mm, most, grating.wavelength_mm,
                                         other ? " beside the other grating" : "")};
    return std::nullopt;
}

std::optional<Contradiction> contradiction(const ConstantForce&)
{
    return std::nullopt;
}

std::optional<Contradiction> contradiction(const Viscosity& viscosity)
{
    if (!(viscosity.viscosity_ns_m > 0 || viscosity.drag_ns2_m2 > 0))
        return Contradiction{"viscosity_ns_m", "is zero as drag_ns2_m2 is, expected one of them to be more"};
    if (!viscosity.radius_mm && viscosity.border_mm)
        return Contradiction{"border_mm", "has no meaning without radius_mm"};
    if (!viscosity.radius_mm && length(viscosity.centre_mm) > 0)
        return Contradiction{"centre_mm", "has no meaning without radius_mm"};
    if (viscosity.radius_mm && viscosity.border_mm && *viscosity.border_mm > *viscosity.radius_mm)
        return Contradiction{"border_mm", fmt::format("is {:g}, expected no more than radius_mm, {:g}",
                                                      *viscosity.border_mm, *viscosity.radius_mm)};
    return std::nullopt;
}

std::optional<Contradiction> contradiction(const Guide& guide)
{
    const bool points = length(guide.direction) > 0;
    if (guide.to == Guide::Place::point && points)
        return Contradiction{"direction", "has no meaning with to = \"point\""};
    if (guide.to == Guide::Place::line && !points)
        return Contradiction{"direction", "is missing, expected [x, y, z] along the line"};
    if (guide.to == Guide::Place::plane && !points)
        return Contradiction{"direction", "is missing, expected [x, y, z] across the plane"};
    return std::nullopt;
}

SpaceEffect make_space_effect(std::string name, std::string_view kind)
{
    if (kind == space_kinds[0])
        return {std::move(name), ConstantForce{}};
    if (kind == space_kinds[1])
        return {std::move(name), Viscosity{}};
    return {std::move(name), Guide{}};
}

std::optional<SpaceContradiction> contradiction(std::span<const SpaceEffect> effects)
{
    std::array<double, 3> sum{};
    std::array<std::size_t, std::variant_size_v<decltype(SpaceEffect::law)>> count{};
    for (const SpaceEffect& effect : effects) {
        if (const auto* constant = std::get_if<ConstantForce>(&effect.law)) {
            for (std::size_t axis = 0; axis < 3; ++axis) {
                sum[axis] += constant->force_n[axis];
                if (!range::constant_force_n.contains(sum[axis]))
                    return SpaceContradiction{
                        effect.name,
                        fmt::format("all constant forces together are {:g} N along an axis, expected {}",
                                    sum[axis], range::constant_force_n.text)};
            }
        } else if (++count[effect.law.index()] > regions_max) {
            return SpaceContradiction{effect.name,
                                      fmt::format("is one too many, expected at most {} of the kind \"{}\"",
                                                  regions_max, effect.kind())};
        }
    }
    return std::nullopt;
}

} // namespace phantom::scene
