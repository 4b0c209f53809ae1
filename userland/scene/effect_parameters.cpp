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

bool is_map_side(std::uint32_t samples)
{
    return samples >= 4 && samples <= 64 && (samples & (samples - 1)) == 0; // PHANTOM_MAP_SIZE_MIN, _MAX
}

double length(const std::array<double, 3>& a)
{
    return std::hypot(a[0], a[1], a[2]);
}

} // namespace

double HeightMap::steepest() const
{
    double along = 0, across = 0;
    for (std::uint32_t row = 0; row < samples.height; ++row)
        for (std::uint32_t column = 0; column < samples.width; ++column) {
            const double here = samples.at(column, row);
            along = std::max(along, std::abs(samples.at((column + 1) % samples.width, row) - here));
            across = std::max(across, std::abs(samples.at(column, (row + 1) % samples.height) - here));
        }
    return along + across;
}

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

void parameters(HeightMap& map, Parameters& out)
{
    out.file("image", map.image, [&map](const std::filesystem::path& file) -> Status {
        Result<GreyImage> image = read_grey_image(file);
        if (!image)
            return image.error();
        if (!is_map_side(image->width) || !is_map_side(image->height))
            return Error{file.string(),
                         fmt::format("is {} x {}, expected 4, 8, 16, 32 or 64 samples each way", image->width,
                                     image->height)};
        map.samples = std::move(*image);
        return success();
    });
    out.number("spacing_mm", map.spacing_mm, range::map_spacing_mm, Need::required);
    out.number("height_mm", map.height_mm, range::amplitude_mm, Need::required);
}

void parameters(Impact& impact, Parameters& out)
{
    out.number("gain_ns_m", impact.gain_ns_m, range::impact_gain_ns_m, Need::required);
    out.number("frequency_hz", impact.frequency_hz, range::impact_frequency_hz, Need::required);
    out.number("decay_ms", impact.decay_ms, range::impact_decay_ms, Need::required);
    out.number("force_n", impact.force_n, range::effect_force_n, Need::required);
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

void parameters(ForceField& field, Parameters& out)
{
    out.file("file", field.file, [&field](const std::filesystem::path& file) -> Status {
        Result<ForceGrid> grid = read_force_grid(file);
        if (!grid)
            return grid.error();
        field.grid = std::move(*grid);
        return success();
    });
    out.number("scale", field.scale, range::field_scale, Need::optional);
    out.number("border_mm", field.border_mm, range::region_mm);
}

void parameters(BallTip& tip, Parameters& out)
{
    out.number("radius_mm", tip.radius_mm, range::tip_radius_mm, Need::fixed);
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

std::optional<Contradiction> contradiction(const HeightMap& map)
{
    // Steps along rows and columns may add up to the spacing: 45 degrees.
    const double most =
        slope_max * map.spacing_mm / std::max(1e-9, map.samples.samples.empty() ? 0 : map.steepest());
    if (map.height_mm > most)
        return Contradiction{"height_mm",
                             fmt::format("is {:g}, expected at most {:.3g} with that image and a spacing "
                                         "of {:g} mm: no steeper than 45 degrees",
                                         map.height_mm, most, map.spacing_mm)};
    return std::nullopt;
}

std::optional<Contradiction> contradiction(const Impact& impact)
{
    // PHANTOM_IMPACT_GAIN_MAX_MNS_M_PER_HZ
    const double most = 0.125 * std::round(impact.frequency_hz);
    if (impact.gain_ns_m > most)
        return Contradiction{"gain_ns_m", fmt::format("is {:g}, expected at most {:g} at {:g} Hz",
                                                      impact.gain_ns_m, most, impact.frequency_hz)};
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

std::optional<Contradiction> contradiction(const ForceField& field)
{
    if (field.grid.force_n.empty())
        return std::nullopt;
    const double force = std::abs(field.scale) * field.grid.force_max_n();
    const double slope = std::abs(field.scale) * field.grid.slope_max_n_mm();
    const double most_border = 0.5 * field.grid.shortest_side_mm();
    if (force > range::effect_force_n.high)
        return Contradiction{"scale", fmt::format("makes forces of {:g} N, expected at most {:g} N", force,
                                                  range::effect_force_n.high)};
    if (slope > slope_max * range::effect_stiffness_n_mm.high)
        return Contradiction{"scale",
                             fmt::format("makes a force change by {:g} N/mm, expected less than {:g} N/mm",
                                         slope, range::effect_stiffness_n_mm.high)};
    if (field.border_mm && *field.border_mm > most_border)
        return Contradiction{"border_mm",
                             fmt::format("is {:g}, expected at most half of the shortest side, {:g}",
                                         *field.border_mm, most_border)};
    if (most_border < range::region_mm.low)
        return Contradiction{"file", fmt::format("has a side of {:g} mm, expected at least {:g}",
                                                 2 * most_border, 2 * range::region_mm.low)};
    return std::nullopt;
}

std::optional<Contradiction> contradiction(const BallTip&)
{
    return std::nullopt;
}

SpaceEffect make_space_effect(std::string name, std::string_view kind)
{
    if (kind == space_kinds[0])
        return {std::move(name), ConstantForce{}};
    if (kind == space_kinds[1])
        return {std::move(name), Viscosity{}};
    if (kind == space_kinds[2])
        return {std::move(name), Guide{}};
    if (kind == space_kinds[3])
        return {std::move(name), ForceField{}};
    return {std::move(name), BallTip{}};
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
            continue;
        }
        const bool several =
            std::holds_alternative<Viscosity>(effect.law) || std::holds_alternative<Guide>(effect.law);
        const std::size_t most = several ? regions_max : 1;
        if (++count[effect.law.index()] > most)
            return SpaceContradiction{
                effect.name,
                fmt::format("is one too many, expected at most {} of the kind \"{}\"", most, effect.kind())};
    }
    return std::nullopt;
}

} // namespace phantom::scene
