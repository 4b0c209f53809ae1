// SPDX-License-Identifier: GPL-2.0-or-later
// A set of patches under construction. Everything that is added is such that the border accepts it;
// spoil() is the exception. Lengths nm, relative to the set's origin.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <map>
#include <vector>

#include "phantom_abi.h"

namespace phantom::fuzz {

using Point = std::array<std::int64_t, 3>; ///< nm
using Direction = std::array<double, 3>;   ///< unit length, unless its maker says otherwise

Direction normalized(const Direction& v, const Direction& otherwise = {0, 0, 1});
/// Unit normal of a triangle; +z where it has none.
Direction plane_normal(const std::array<Point, 3>& corner);

/// What one shape made, for the operations that go through it again.
struct Range {
    std::size_t begin = 0, end = 0;
};

class SetBuilder {
  public:
    static constexpr std::size_t patches_max = PHANTOM_PATCHES_MAX;

    SetBuilder() { clear(); }
    /// One material, one object, no patch; coverage of 2 m round the origin.
    void clear();

    void triangle(const std::array<Point, 3>& corner, const std::array<Direction, 3>& normal);
    /// Over an edge (two corners equal) or a vertex (all three); turned so that its shell has not folded
    /// over.
    void fan(const std::array<Point, 3>& corner, const std::array<Direction, 3>& normal);
    /// The faces so far are one surface; rims where it is open, as many as there is room for.
    void end_surface();
    /// Faces added from now on are of this material or object. The 17th is the first again. feel: feel.hpp
    void material(const phantom_material& material, std::uint8_t feel);
    void object(const phantom_object& object);
    void cover(const Point& centre, std::uint32_t radius_nm);
    void origin(const Point& origin) { origin_ = origin; }
    /// With false, equal corners get vertex numbers of their own and no face has a neighbour.
    void weld(bool on) { weld_ = on; }
    /// Faces in that range once more, moved; flipped: seen from behind.
    void repeat(Range faces, const Point& by, bool flipped);

    [[nodiscard]] std::size_t face_count() const { return faces_.size(); }
    [[nodiscard]] std::size_t patch_count() const { return faces_.size() + fans_.size() + rims_.size(); }
    /// A point over a face at those barycentric coordinates, along its normals.
    [[nodiscard]] Point over(std::size_t face, double b0, double b1, double height_nm) const;
    /// Contact radius of a face's material; of the material in use where there is no such face.
    [[nodiscard]] double radius_nm(std::size_t face) const;

    /// The set, ready to submit, in memory that is valid until the next call. The arrays have room for all
    /// that the border reads whatever their counts are spoiled to.
    phantom_set& request(std::uint64_t id);
    /// Overwrites a 32-bit word of what request() made last: nothing of it need be valid any more.
    enum class Part : std::uint32_t { Header, Material, Object, Patch };
    void spoil(Part part, std::uint32_t word, std::uint32_t value);

  private:
    std::uint32_t vertex_number(const Point& point);
    void append(std::vector<phantom_patch>& to, const std::array<Point, 3>& corner,
                const std::array<Direction, 3>& normal);
    /// A number of its own for each object that moves, 0 for the others.
    [[nodiscard]] std::uint32_t frame(const phantom_patch& patch) const;
    void link_neighbours();

    std::vector<phantom_patch> faces_, fans_, rims_;
    std::vector<phantom_material> materials_;
    std::vector<std::uint8_t> feels_; ///< of each material
    std::vector<phantom_object> objects_;
    std::map<Point, std::uint32_t> numbers_;
    std::uint32_t next_number_ = 0, next_face_ = 0, material_ = 0, object_ = 0;
    Point centre_{}, origin_{};
    std::uint32_t radius_nm_ = 0;
    bool weld_ = true;

    phantom_set header_{};
    std::array<phantom_patch, patches_max> sent_patches_{};
    /// As many as a spoiled header may ask for, and the tables behind them.
    static constexpr std::size_t sent_materials_max =
        PHANTOM_MATERIALS_MAX + PHANTOM_EFFECT_BYTES_MAX / sizeof(phantom_material);
    std::array<phantom_material, sent_materials_max> sent_materials_{};
    std::uint32_t sent_tables_ = 0; ///< bytes behind them, whatever the header says
    std::array<phantom_object, PHANTOM_OBJECTS_MAX> sent_objects_{};
};

} // namespace phantom::fuzz
