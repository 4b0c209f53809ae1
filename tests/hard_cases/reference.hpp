// SPDX-License-Identifier: GPL-2.0-or-later
// The contact models in __float128 over a whole mesh: no selection, no blocks, no tolerance, and
// nothing shared with the float sections. The oracle that they are held to.
//
// Lengths mm, forces N, stiffness N/mm. Positions and results are doubles; all between is __float128.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

namespace phantom::reference {

using Vec3 = std::array<double, 3>;

struct Triangle {
    std::array<Vec3, 3> corner; ///< counter-clockwise seen from outside
    std::array<Vec3, 3> normal; ///< unit, per corner
    std::array<std::uint32_t, 3> vertex{};
    std::uint32_t face = 0xffffffffU; ///< its number in every set; by default its place in the list
    bool fan = false; ///< over an edge or a corner: two or three of the corners are the same point
    bool rim = false; ///< no triangle: the surface ends on the edge from corner 0 to 1; corner 2 = corner 1
    std::uint32_t surface = 0; ///< whose force fades within R of rims with that number; 0: none's
    double stiffness = 1;      ///< k
    double radius = 1;         ///< R
};

enum class Model { paper, projected };
enum class Combine { paper, bounded };

struct Options {
    Model model = Model::projected;
    Combine combine = Combine::bounded;
    bool penetration = true; ///< proxy=paper; else the shell only
    bool all_roots = false;  ///< also roots farther than 2 R, which give no force: for Result::degree
};

struct Result {
    Vec3 force{};
    unsigned contacts = 0; ///< paper: after overlap removal; projected: roots in range; inside: 1
    unsigned dropped = 0;  ///< paper: contacts removed as overlapped
    unsigned folded = 0;   ///< projected: roots in range with the sign -1
    /// projected: roots of sign +1 less roots of sign -1 at any h > 0, also beyond R.
    int degree = 0;
    bool inside = false;
    Vec3 proxy{}; ///< V; the tip outside
    /// How near (mm) a yes or no came to the other answer. A tip closer than rounding to a wall or
    /// to the shell's edge may be decided either way.
    double margin = 1e9;
};

/// A tip nearer than that to a wall, a face or the shell's end may be decided either way in float.
inline constexpr double margin_mm = 2e-4;

class Reference {
  public:
    Reference(std::vector<Triangle> triangles, Options options);

    /// Shell contact alone, no state.
    [[nodiscard]] Result shell(const Vec3& tip) const;

    /// One tick along a path: shell contact and penetration. The first tick has no path.
    Result tick(const Vec3& tip);
    void restart();

    /// Force of the state inside with the proxy on that face.
    [[nodiscard]] Vec3 held(const Vec3& tip, const Vec3& proxy, std::size_t face) const;

  private:
    [[nodiscard]] std::vector<std::size_t> near(const Vec3& at, double reach) const;
    struct Crossing {
        double along;
        std::size_t face;
    };
    [[nodiscard]] std::vector<Crossing> crossings(const Vec3& from, const Vec3& to, bool outward) const;
    [[nodiscard]] bool covered(const Vec3& tip, std::size_t face) const;
    void enter(const Vec3& from, const Vec3& to, const Crossing& at);

    std::vector<Triangle> triangles_, rims_;
    std::vector<double> extents_; // farthest corner from corner 0
    Options options_;
    bool inside_ = false, has_path_ = false;
    Vec3 previous_{}, proxy_{};
    std::size_t face_ = 0;
};

} // namespace phantom::reference
