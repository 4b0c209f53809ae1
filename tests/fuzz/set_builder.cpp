// SPDX-License-Identifier: GPL-2.0-or-later
#include "set_builder.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <utility>

#include "feel.hpp"

namespace phantom::fuzz {

namespace {

Direction cross(const Direction& a, const Direction& b)
{
    return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

double dot(const Direction& a, const Direction& b)
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

Direction minus(const Direction& a, const Direction& b)
{
    return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
}

Direction plus(const Direction& a, const Direction& b)
{
    return {a[0] + b[0], a[1] + b[1], a[2] + b[2]};
}

Direction between(const Point& a, const Point& b)
{
    return {double(b[0] - a[0]), double(b[1] - a[1]), double(b[2] - a[2])};
}

/// The first term of A(h) = (e1 + h f1) x (e2 + h f2) that does not vanish over a fan.
Direction fan_area(const std::array<Point, 3>& x, const std::array<Direction, 3>& m)
{
    const Direction e1 = between(x[0], x[1]), e2 = between(x[0], x[2]);
    const Direction f1 = minus(m[1], m[0]), f2 = minus(m[2], m[0]);
    return x[0] == x[1] && x[1] == x[2] ? cross(f1, f2) : plus(cross(e1, f2), cross(f1, e2));
}

std::int32_t coordinate(std::int64_t nm)
{
    return std::int32_t(std::clamp<std::int64_t>(nm, -PHANTOM_COORDINATE_MAX_NM, PHANTOM_COORDINATE_MAX_NM));
}

} // namespace

Direction normalized(const Direction& v, const Direction& otherwise)
{
    const double length = std::sqrt(dot(v, v));
    return length > 0 ? Direction{v[0] / length, v[1] / length, v[2] / length} : otherwise;
}

Direction plane_normal(const std::array<Point, 3>& corner)
{
    return normalized(cross(between(corner[0], corner[1]), between(corner[0], corner[2])));
}

void SetBuilder::clear()
{
    faces_.clear();
    fans_.clear();
    rims_.clear();
    numbers_.clear();
    next_number_ = next_face_ = material_ = object_ = 0;
    phantom_material material{};
    material.stiffness_mn_mm = 1000;
    material.radius_nm = 2'000'000;
    materials_ = {material};
    feels_ = {0};
    phantom_object object{};
    object.rotation_q30[0] = PHANTOM_Q30_ONE;
    objects_ = {object};
    centre_ = origin_ = {};
    radius_nm_ = 2'000'000'000;
    weld_ = true;
}

std::uint32_t SetBuilder::vertex_number(const Point& point)
{
    if (!weld_)
        return next_number_++;
    const auto [at, added] = numbers_.try_emplace(point, next_number_);
    next_number_ += added;
    return at->second;
}

void SetBuilder::append(std::vector<phantom_patch>& to, const std::array<Point, 3>& corner,
                        const std::array<Direction, 3>& normal)
{
    if (patch_count() >= patches_max)
        return;
    phantom_patch patch{};
    for (std::size_t i = 0; i < 3; ++i) {
        Point placed{};
        for (std::size_t axis = 0; axis < 3; ++axis) {
            placed[axis] = patch.vertex_nm[i][axis] = coordinate(corner[i][axis]);
            patch.normal_q30[i][axis] = std::int32_t(std::lround(normal[i][axis] * PHANTOM_Q30_ONE));
        }
        patch.vertex[i] = vertex_number(placed);
        patch.neighbour[i] = PHANTOM_PATCH_NONE;
    }
    patch.object = object_;
    patch.material = material_;
    to.push_back(patch);
}

void SetBuilder::triangle(const std::array<Point, 3>& corner, const std::array<Direction, 3>& normal)
{
    const std::size_t before = faces_.size();
    append(faces_, corner, normal);
    if (faces_.size() > before)
        faces_.back().face = next_face_++;
}

void SetBuilder::fan(const std::array<Point, 3>& corner, const std::array<Direction, 3>& normal)
{
    const Direction sum = plus(plus(normal[0], normal[1]), normal[2]);
    const std::size_t before = fans_.size();
    if (dot(fan_area(corner, normal), sum) < 0)
        append(fans_, {corner[0], corner[2], corner[1]}, {normal[0], normal[2], normal[1]});
    else
        append(fans_, corner, normal);
    if (fans_.size() == before)
        return;
    fans_.back().face = PHANTOM_PATCH_NONE;
    fans_.back().kind =
        corner[0] == corner[1] && corner[1] == corner[2] ? PHANTOM_PATCH_CORNER : PHANTOM_PATCH_EDGE;
}

void SetBuilder::end_surface()
{
    const std::uint32_t surface = std::uint32_t(rims_.size()) + 1;
    std::map<std::pair<Point, Point>, const phantom_patch*> edges;
    const auto corner = [](const phantom_patch& patch, std::size_t i) {
        const auto& x = patch.vertex_nm[i % 3];
        return Point{x[0], x[1], x[2]};
    };
    for (phantom_patch& face : faces_) {
        face.surface = surface;
        for (std::size_t i = 0; i < 3; ++i)
            edges.emplace(std::pair{corner(face, i), corner(face, i + 1)}, &face);
    }
    for (phantom_patch& fan : fans_)
        fan.surface = surface;
    for (const auto& [ends, face] : edges) {
        const auto& [from, to] = ends;
        if (from == to || edges.contains({to, from}) || patch_count() >= patches_max)
            continue;
        append(rims_, {from, to, to}, {Direction{0, 0, 1}, {0, 0, 1}, {0, 0, 1}});
        rims_.back().face = PHANTOM_PATCH_NONE;
        rims_.back().kind = PHANTOM_PATCH_RIM;
        rims_.back().surface = surface;
        rims_.back().object = face->object;
    }
}

void SetBuilder::material(const phantom_material& material, std::uint8_t feel)
{
    material_ = std::uint32_t(materials_.size());
    if (faces_.empty() && fans_.empty() && materials_.size() == 1)
        material_ = 0; // in place of the default
    if (material_ == PHANTOM_MATERIALS_MAX)
        material_ = 0;
    else if (material_ == materials_.size())
        materials_.push_back(material);
    else
        materials_[material_] = material;
    feels_.resize(materials_.size());
    feels_[material_] = feel;
}

void SetBuilder::object(const phantom_object& object)
{
    for (std::size_t i = 0; i < objects_.size(); ++i) {
        if (objects_[i].object != object.object)
            continue;
        objects_[i] = object;
        object_ = std::uint32_t(i);
        return;
    }
    object_ = std::uint32_t(objects_.size());
    if (object_ == PHANTOM_OBJECTS_MAX)
        object_ = 0;
    else
        objects_.push_back(object);
}

void SetBuilder::cover(const Point& centre, std::uint32_t radius_nm)
{
    for (std::size_t axis = 0; axis < 3; ++axis)
        centre_[axis] = coordinate(centre[axis]);
    radius_nm_ = radius_nm;
}

void SetBuilder::repeat(Range faces, const Point& by, bool flipped)
{
    for (std::size_t f = faces.begin; f < std::min(faces.end, faces_.size()); ++f) {
        const phantom_patch from = faces_[f];
        std::array<Point, 3> corner{};
        std::array<Direction, 3> normal{};
        for (std::size_t i = 0; i < 3; ++i) {
            const std::size_t to = flipped ? 2 - i : i;
            for (std::size_t axis = 0; axis < 3; ++axis) {
                corner[to][axis] = from.vertex_nm[i][axis] + by[axis];
                normal[to][axis] =
                    (flipped ? -1.0 : 1.0) * from.normal_q30[i][axis] * (1.0 / PHANTOM_Q30_ONE);
            }
        }
        triangle(corner, normal);
    }
}

Point SetBuilder::over(std::size_t face, double b0, double b1, double height_nm) const
{
    if (face >= faces_.size())
        return {0, 0, std::llround(height_nm)};
    const phantom_patch& patch = faces_[face];
    const std::array<double, 3> b{b0, b1, 1 - b0 - b1};
    Point out{};
    for (std::size_t axis = 0; axis < 3; ++axis) {
        double at = 0;
        for (std::size_t i = 0; i < 3; ++i)
            at += b[i] * (patch.vertex_nm[i][axis] +
                          height_nm * patch.normal_q30[i][axis] * (1.0 / PHANTOM_Q30_ONE));
        // an origin beyond the border's limit is refused, but must not overflow here
        out[axis] =
            std::clamp<std::int64_t>(origin_[axis], -PHANTOM_POSITION_MAX_NM, PHANTOM_POSITION_MAX_NM) +
            std::llround(at);
    }
    return out;
}

double SetBuilder::radius_nm(std::size_t face) const
{
    return materials_[face < faces_.size() ? faces_[face].material : material_].radius_nm;
}

std::uint32_t SetBuilder::frame(const phantom_patch& patch) const
{
    return objects_[patch.object].flags & PHANTOM_OBJECT_MOVES ? patch.object + 1 : 0;
}

void SetBuilder::link_neighbours()
{
    std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> edges;
    for (std::size_t f = 0; f < faces_.size(); ++f)
        for (std::size_t i = 0; i < 3; ++i)
            edges.emplace(std::pair{faces_[f].vertex[i], faces_[f].vertex[(i + 1) % 3]}, f);
    for (phantom_patch& patch : faces_) {
        for (std::size_t i = 0; i < 3; ++i) {
            const auto at = edges.find({patch.vertex[(i + 1) % 3], patch.vertex[i]});
            const bool beside = at != edges.end() && frame(faces_[at->second]) == frame(patch);
            patch.neighbour[i] = beside ? at->second : PHANTOM_PATCH_NONE;
        }
    }
}

phantom_set& SetBuilder::request(std::uint64_t id)
{
    link_neighbours();
    header_ = {};
    header_.id = id;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        header_.origin_nm[axis] = origin_[axis];
        header_.centre_nm[axis] = std::int32_t(centre_[axis]);
    }
    header_.radius_nm = radius_nm_;
    header_.patch_count = std::uint32_t(patch_count());
    header_.material_count = std::uint32_t(materials_.size());
    header_.object_count = std::uint32_t(objects_.size());
    for (const phantom_material& material : materials_)
        header_.effects |= material.effects;
    for (const std::uint8_t feel : feels_)
        header_.effects |= space_effects(feel);
    sent_patches_ = {};
    const auto fans = std::copy(faces_.begin(), faces_.end(), sent_patches_.begin());
    std::copy(rims_.begin(), rims_.end(), std::copy(fans_.begin(), fans_.end(), fans));
    sent_materials_ = {};
    std::copy(materials_.begin(), materials_.end(), sent_materials_.begin());
    const std::vector<std::uint8_t> tables = effect_tables(materials_, feels_, header_.origin_nm);
    sent_tables_ = std::uint32_t(tables.size());
    header_.effect_bytes = sent_tables_;
    if (!tables.empty())
        std::memcpy(sent_materials_.data() + materials_.size(), tables.data(), tables.size());
    sent_objects_ = {};
    std::copy(objects_.begin(), objects_.end(), sent_objects_.begin());
    // a frame lies where the set does, or tips would never be near it
    for (phantom_object& object : sent_objects_)
        if (object.flags & PHANTOM_OBJECT_MOVES)
            for (std::size_t axis = 0; axis < 3; ++axis)
                object.translation_nm[axis] += std::clamp<std::int64_t>(
                    origin_[axis], -PHANTOM_POSITION_MAX_NM, PHANTOM_POSITION_MAX_NM);
    header_.patches = reinterpret_cast<std::uintptr_t>(sent_patches_.data());
    header_.materials = reinterpret_cast<std::uintptr_t>(sent_materials_.data());
    header_.objects = reinterpret_cast<std::uintptr_t>(sent_objects_.data());
    return header_;
}

void SetBuilder::spoil(Part part, std::uint32_t word, std::uint32_t value)
{
    // What follows the header's numbers are pointers: the user-mode build believes those.
    constexpr std::size_t header_words = offsetof(phantom_set, patches) / 4;
    const auto write = [value](void* at, std::size_t index) {
        std::memcpy(static_cast<std::uint8_t*>(at) + 4 * index, &value, sizeof(value));
    };
    switch (part) {
    case Part::Header:
        write(&header_, word % header_words);
        break;
    case Part::Material:
        // the tables behind them too
        write(sent_materials_.data(),
              word % ((materials_.size() * sizeof(phantom_material) + sent_tables_) / 4));
        break;
    case Part::Object:
        write(sent_objects_.data(), word % (objects_.size() * sizeof(phantom_object) / 4));
        break;
    case Part::Patch:
        if (patch_count())
            write(sent_patches_.data(), word % (patch_count() * sizeof(phantom_patch) / 4));
        break;
    }
}

} // namespace phantom::fuzz
