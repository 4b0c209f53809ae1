// SPDX-License-Identifier: GPL-2.0-or-later
#include "scene/shapes/shape_keys.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace phantom::scene {

namespace {

using Words = std::span<const std::string_view>;

// Barr's exponents: beyond 2 the surface is not convex, near 2 its edges are sharp to rounding.
constexpr Range exponent{0.1, 1.9, "0.1 ... 1.9"};
constexpr Range radius_or_tip{0.0, 1e6, "0 ... 1000000 mm"};

template <std::size_t N>
using Keys = std::array<std::string_view, N>;
constexpr Keys<2> sphere_keys{"radius_mm", "chord_mm"};
constexpr Keys<2> ellipsoid_keys{"size_mm", "chord_mm"};
constexpr Keys<3> torus_keys{"radius_mm", "tube_radius_mm", "chord_mm"};
constexpr Keys<1> box_keys{"size_mm"};
constexpr Keys<3> cylinder_keys{"radius_mm", "height_mm", "chord_mm"};
constexpr Keys<4> cone_keys{"radius_mm", "top_radius_mm", "height_mm", "chord_mm"};
constexpr Keys<3> superquadric_keys{"size_mm", "exponents", "chord_mm"};
constexpr Keys<6> height_field_keys{"image", "size_mm", "height_mm", "base_mm", "closed", "chord_mm"};
constexpr Keys<7> nurbs_keys{"file", "degree", "points_mm", "weights", "knots_u", "knots_v", "chord_mm"};

constexpr Keys<9> words{"sphere", "ellipsoid",    "torus",        "box",  "cylinder",
                        "cone",   "superquadric", "height_field", "nurbs"};
constexpr std::array<Words, words.size()> keys_of{sphere_keys,       ellipsoid_keys,    torus_keys,
                                                  box_keys,          cylinder_keys,     cone_keys,
                                                  superquadric_keys, height_field_keys, nurbs_keys};
constexpr Keys<16> all_keys{"radius_mm", "size_mm",   "tube_radius_mm", "top_radius_mm",
                            "height_mm", "exponents", "image",          "base_mm",
                            "closed",    "file",      "degree",         "points_mm",
                            "weights",   "knots_u",   "knots_v",        "chord_mm"};

/// The keys of one shape, with the article that its messages begin with.
class ShapeReader {
  public:
    ShapeReader(TomlReader& object, std::string_view word) : object_(object), word_(word) {}

    double number(std::string_view key, const Range& range)
    {
        need(key, "");
        return object_.number(key, range).value_or(0);
    }
    template <std::size_t N>
    std::array<double, N> numbers(std::string_view key, const Range& range, const char* form)
    {
        need(key, form);
        std::array<double, N> values{};
        object_.numbers(key, range, values);
        return values;
    }
    void need(std::string_view key, const char* form)
    {
        if (!object_.has(key))
            object_.fault("shape", fmt::format("{} {} needs {}{}", word_ == "ellipsoid" ? "an" : "a", word_,
                                               key, form));
    }
    TomlReader& object() { return object_; }

  private:
    TomlReader& object_;
    std::string_view word_;
};

constexpr const char* three_sizes = " = [x, y, z]";

Torus read_torus(ShapeReader& reader)
{
    const Torus torus{reader.number("radius_mm", range::length_mm),
                      reader.number("tube_radius_mm", range::length_mm)};
    if (torus.radius_mm > 0 && torus.tube_radius_mm >= torus.radius_mm)
        reader.object().fault("tube_radius_mm", fmt::format("is {:g}, expected less than radius_mm = {:g}",
                                                            torus.tube_radius_mm, torus.radius_mm));
    return torus;
}

Superquadric read_superquadric(ShapeReader& reader)
{
    const mesh::Vec3 size = reader.numbers<3>("size_mm", range::length_mm, three_sizes);
    const auto exponents = reader.numbers<2>("exponents", exponent, " = [north_south, east_west]");
    return {size, exponents[0], exponents[1]};
}

/// A file that the shape is made of.
std::filesystem::path read_path(TomlReader& object, std::string_view key, const std::filesystem::path& scene)
{
    const auto text = object.text(key);
    if (!text)
        return {};
    std::filesystem::path file = scene.parent_path() / *text;
    std::error_code ignored;
    if (!std::filesystem::exists(file, ignored))
        object.fault(key, "no such file: " + file.string());
    return file;
}

HeightField read_height_field(ShapeReader& reader, const std::filesystem::path& scene)
{
    reader.need("image", " = \"FILE\"");
    HeightField field;
    field.image = read_path(reader.object(), "image", scene);
    field.size_mm = reader.numbers<2>("size_mm", range::length_mm, " = [x, y]");
    field.height_mm = reader.number("height_mm", range::length_mm);
    field.closed = reader.object().flag("closed").value_or(true);
    field.base_mm = reader.object().number("base_mm", range::length_mm).value_or(field.height_mm);
    if (!field.closed && reader.object().has("base_mm"))
        reader.object().fault("base_mm", "has no meaning with closed = false");
    return field;
}

/// degree + 1 equal knots at either end, the others one apart.
std::vector<double> uniform_knots(std::uint32_t degree, std::uint32_t count)
{
    std::vector<double> knots;
    for (std::uint32_t i = 0; i < count + degree + 1; ++i)
        knots.push_back(
            std::clamp(static_cast<double>(i) - degree, 0.0, static_cast<double>(count) - degree));
    return knots;
}

/// What is wrong with a direction's knots; empty when nothing is.
std::string bad_knots(const NurbsPatch::Direction& d)
{
    const std::size_t expected = d.count + d.degree + 1;
    if (d.knots.size() != expected)
        return fmt::format("has {} numbers, expected {}: {} control points and degree {} + 1", d.knots.size(),
                           expected, d.count, d.degree);
    for (std::size_t i = 1; i < d.knots.size(); ++i) {
        if (d.knots[i] < d.knots[i - 1])
            return fmt::format("number {} is {:g} after {:g}, expected ascending numbers", i + 1, d.knots[i],
                               d.knots[i - 1]);
    }
    if (!(d.knots[d.degree] < d.knots[d.count]))
        return fmt::format("numbers {} and {} are equal, expected a range between them", d.degree + 1,
                           d.count + 1);
    // More often, and the patch would fall apart there.
    for (std::size_t i = 0; i + d.degree < d.knots.size(); ++i) {
        const bool inner = d.knots[i] > d.knots[d.degree] && d.knots[i] < d.knots[d.count];
        const std::size_t most = inner ? d.degree : d.degree + 1;
        if (i + most < d.knots.size() && d.knots[i] == d.knots[i + most])
            return fmt::format("has {:g} more than {} times, expected at most the degree{}", d.knots[i], most,
                               inner ? " between the ends" : " + 1 at an end");
    }
    return {};
}

void read_knots(TomlReader& table, std::string_view key, NurbsPatch::Direction& d)
{
    constexpr Range knot{-1e9, 1e9, "a finite number"};
    if (!table.has(key)) {
        d.knots = uniform_knots(d.degree, d.count);
        return;
    }
    d.knots = table.number_list(key, knot);
    if (d.knots.empty())
        return;
    if (const std::string bad = bad_knots(d); !bad.empty())
        table.fault(key, bad);
}

/// The keys of a patch, of an object or a file of its own.
std::optional<NurbsPatch> read_nurbs(TomlReader& table)
{
    for (const std::string_view key : {"degree", "points_mm"}) {
        if (!table.has(key))
            table.fault(key, "is missing");
    }
    NurbsPatch patch;
    std::array<double, 2> degree{};
    constexpr Range degrees{1, nurbs_degree_max, "a whole number, 1 ... 9"};
    if (!table.numbers("degree", degrees, degree))
        return std::nullopt;
    if (degree[0] != std::floor(degree[0]) || degree[1] != std::floor(degree[1])) {
        table.fault("degree",
                    fmt::format("is [{:g}, {:g}], expected whole numbers, 1 ... 9", degree[0], degree[1]));
        return std::nullopt;
    }
    std::size_t columns = 0;
    const std::vector<double> points = table.number_net("points_mm", range::position_mm, 3, columns);
    if (points.empty())
        return std::nullopt;
    patch.u = {
        static_cast<std::uint32_t>(degree[0]), static_cast<std::uint32_t>(points.size() / 3 / columns), {}};
    patch.v = {static_cast<std::uint32_t>(degree[1]), static_cast<std::uint32_t>(columns), {}};
    for (std::size_t i = 0; i < points.size(); i += 3)
        patch.points.push_back({points[i], points[i + 1], points[i + 2]});
    if (patch.u.count <= patch.u.degree || patch.v.count <= patch.v.degree) {
        table.fault("points_mm",
                    fmt::format("has {} rows of {}, expected at least {} of {}: the degree + 1",
                                patch.u.count, patch.v.count, patch.u.degree + 1, patch.v.degree + 1));
        return std::nullopt;
    }
    constexpr Range weight{1e-6, 1e6, "0.000001 ... 1000000"};
    std::size_t weight_columns = columns;
    patch.weights = table.number_net("weights", weight, 1, weight_columns);
    if (!table.has("weights"))
        patch.weights.assign(patch.points.size(), 1.0);
    else if (!patch.weights.empty() &&
             (weight_columns != columns || patch.weights.size() != patch.points.size()))
        table.fault("weights", fmt::format("has {} rows of {}, expected {} of {} as points_mm",
                                           patch.weights.size() / weight_columns, weight_columns,
                                           patch.u.count, patch.v.count));
    read_knots(table, "knots_u", patch.u);
    read_knots(table, "knots_v", patch.v);
    return patch;
}

std::optional<NurbsPatch> read_nurbs_file(TomlReader& object, const std::filesystem::path& scene)
{
    for (const std::string_view key : {"degree", "points_mm", "weights", "knots_u", "knots_v"}) {
        if (object.has(key))
            object.fault(key, "stands beside file, expected one of the two");
    }
    const std::filesystem::path file = read_path(object, "file", scene);
    std::error_code ignored;
    if (!std::filesystem::exists(file, ignored))
        return std::nullopt;
    const auto table = parse_toml(file);
    if (!table) {
        object.fault("file", table.error().text());
        return std::nullopt;
    }
    Faults faults(file.string());
    TomlReader reader(*table, "", {"degree", "points_mm", "weights", "knots_u", "knots_v"}, faults);
    auto patch = read_nurbs(reader);
    if (faults.first())
        object.fault("file", faults.first()->text());
    return patch;
}

} // namespace

std::span<const std::string_view> shape_words()
{
    return words;
}

std::span<const std::string_view> shape_keys()
{
    return all_keys;
}

std::span<const std::string_view> shape_keys(std::string_view word)
{
    const auto* const found = std::find(words.begin(), words.end(), word);
    return found == words.end() ? Words{} : keys_of[static_cast<std::size_t>(found - words.begin())];
}

namespace {

/// Every key that a shape has no use for.
void refuse_others(TomlReader& object, std::string_view word)
{
    const Words own = shape_keys(word);
    for (const std::string_view key : all_keys) {
        if (object.has(key) && std::find(own.begin(), own.end(), key) == own.end())
            object.fault(key, fmt::format("has no meaning with shape = \"{}\"", word));
    }
}

} // namespace

std::optional<ShapeEntry> read_shape(TomlReader& object, const std::filesystem::path& scene)
{
    const auto word = object.word("shape", words);
    if (!word)
        return std::nullopt;
    refuse_others(object, *word);
    ShapeReader reader(object, *word);
    if (*word == "sphere")
        return ShapeEntry{Sphere{reader.number("radius_mm", range::length_mm)}};
    if (*word == "ellipsoid")
        return ShapeEntry{Ellipsoid{reader.numbers<3>("size_mm", range::length_mm, three_sizes)}};
    if (*word == "torus")
        return ShapeEntry{read_torus(reader)};
    if (*word == "box")
        return ShapeEntry{Box{reader.numbers<3>("size_mm", range::length_mm, three_sizes)}};
    if (*word == "superquadric")
        return ShapeEntry{read_superquadric(reader)};
    if (*word == "height_field") {
        const HeightField field = read_height_field(reader, scene);
        return ShapeEntry{field, !field.closed};
    }
    if (*word == "nurbs") {
        auto patch = object.has("file") ? read_nurbs_file(object, scene) : read_nurbs(object);
        if (!patch)
            return std::nullopt;
        return ShapeEntry{*std::move(patch), true};
    }
    Cone cone{reader.number("radius_mm", range::length_mm), 0, reader.number("height_mm", range::length_mm)};
    cone.top_radius_mm =
        *word == "cylinder" ? cone.radius_mm : object.number("top_radius_mm", radius_or_tip).value_or(0);
    return ShapeEntry{cone};
}

} // namespace phantom::scene
