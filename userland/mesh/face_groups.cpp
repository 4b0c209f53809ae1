// SPDX-License-Identifier: GPL-2.0-or-later
#include "mesh/face_groups.hpp"

#include <utility>

namespace phantom::mesh {

void FaceGroups::add(const std::string& name)
{
    if (too_many())
        return;
    // Faces of a group follow one another.
    if (numbers_.empty() || name != last_) {
        const auto [at, added] = numbers_.try_emplace(name, static_cast<std::uint32_t>(numbers_.size()));
        if (added && names_.size() < face_groups_max)
            names_.push_back(name);
        last_ = name;
        last_number_ = at->second;
    }
    of_face_.push_back(static_cast<std::uint8_t>(last_number_));
}

void FaceGroups::give(std::vector<std::uint8_t>& face_groups, std::vector<std::string>& names)
{
    const bool nameless = numbers_.size() == 1 && numbers_.contains("");
    if (nameless || numbers_.empty() || too_many())
        return;
    face_groups = std::move(of_face_);
    names = std::move(names_);
}

} // namespace phantom::mesh
