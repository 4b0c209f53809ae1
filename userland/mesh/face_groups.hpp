// SPDX-License-Identifier: GPL-2.0-or-later
// Parts of a mesh that its file tells apart: OBJ materials or groups, PLY material indices or face colours.
// A face has the number of its group, so that a scene can give each a material of its own.
#pragma once

#include <cstdint>
#include <string>
#include <unordered_map>
#include <vector>

namespace phantom::mesh {

/// A mesh has at most so many; one with more (a scan with a colour for each face) is read as one without.
inline constexpr std::size_t face_groups_max = 256;

/// Numbers groups by their names, in the order of their first faces, face by face.
class FaceGroups {
  public:
    /// The next face's; "" for one that has no name.
    void add(const std::string& name);
    /// Of the faces so far, as a soup has them: both empty when no face has a name, or there are more than
    /// face_groups_max.
    void give(std::vector<std::uint8_t>& face_groups, std::vector<std::string>& names);
    [[nodiscard]] bool too_many() const { return numbers_.size() > face_groups_max; }

  private:
    std::unordered_map<std::string, std::uint32_t> numbers_;
    std::vector<std::string> names_;
    std::vector<std::uint8_t> of_face_;
    std::string last_;
    std::uint32_t last_number_ = 0;
};

} // namespace phantom::mesh
