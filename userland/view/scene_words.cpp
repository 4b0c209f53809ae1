// SPDX-License-Identifier: GPL-2.0-or-later
#include "view/scene_words.hpp"

#include <fmt/format.h>

#include "base/vector.hpp"

namespace phantom::view {

std::string grouped(std::uint64_t number)
{
    if (number < 1000)
        return std::to_string(number);
    return fmt::format("{},{:03}", grouped(number / 1000), number % 1000);
}

std::string scene_size_text(const scene::Scene& scene)
{
    const auto bounds = scene.bounds();
    const Vec3 size = bounds.high - bounds.low;
    return fmt::format("{} triangles · {:.0f} × {:.0f} × {:.0f} mm", grouped(scene.triangles()), size[0],
                       size[1], size[2]);
}

} // namespace phantom::view
