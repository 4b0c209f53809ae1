// SPDX-License-Identifier: GPL-2.0-or-later
// Vectors of space, one in each lane. Included only by units compiled for their instruction set; see the
// rules in search_kernels.hpp.
#pragma once

#include "fdh/layout.hpp"
#include "fdh/simd.hpp"

namespace phantom::fdh {

template <Isa I>
struct LaneMath {
    using S = Simd<I>;
    using V = typename S::Float;

    struct Vector {
        V x, y, z;
    };
    static V dot(const Vector& a, const Vector& b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
    static Vector minus(const Vector& a, const Vector& b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
    static Vector plus(const Vector& a, const Vector& b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
    static Vector cross(const Vector& a, const Vector& b)
    {
        return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
    }
    static Vector load(const float (&field)[3][lanes], int lane)
    {
        return {S::load(field[0] + lane), S::load(field[1] + lane), S::load(field[2] + lane)};
    }
};

} // namespace phantom::fdh
