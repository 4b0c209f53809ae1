// SPDX-License-Identifier: GPL-2.0-or-later
#include "study/peers/contenders.hpp"

#include <algorithm>

#include "study/peers/hulls.hpp"

namespace phantom::peers {

namespace {

struct Library {
    const char* name;
    const char* package; ///< of Debian
    std::unique_ptr<Contender> (*make)();
};

#ifdef PHANTOM_PEER_EMBREE
constexpr auto embree = make_embree;
#else
constexpr std::unique_ptr<Contender> (*embree)() = nullptr;
#endif
#ifdef PHANTOM_PEER_CGAL
constexpr auto cgal = make_cgal;
#else
constexpr std::unique_ptr<Contender> (*cgal)() = nullptr;
#endif
#ifdef PHANTOM_PEER_BULLET
constexpr auto bullet = make_bullet;
#else
constexpr std::unique_ptr<Contender> (*bullet)() = nullptr;
#endif
#ifdef PHANTOM_PEER_FCL
constexpr auto fcl = make_fcl;
#else
constexpr std::unique_ptr<Contender> (*fcl)() = nullptr;
#endif
#ifdef PHANTOM_PEER_VTK
constexpr auto vtk = make_vtk;
#else
constexpr std::unique_ptr<Contender> (*vtk)() = nullptr;
#endif

constexpr Library libraries[] = {{yardstick, "libembree-dev", embree},
                                 {"Bullet", "libbullet-dev", bullet},
                                 {"CGAL", "libcgal-dev", cgal},
                                 {"FCL", "libfcl-dev", fcl},
                                 {"VTK", "libvtk9-dev", vtk}};

std::string name_of(const std::unique_ptr<Contender>& contender)
{
    return contender->name();
}
std::string name_of(const Absent& absent)
{
    return absent.name;
}

} // namespace

Result<Field> field_for(const Mesh& mesh, const std::vector<std::string>& only)
{
    Field field;
    field.contenders = own_contenders(mesh);
    for (const Library& library : libraries) {
        if (!library.make) {
            field.absent.push_back({library.name, std::string("not built in; Debian has it in ") +
                                                      library.package + ", and make bench looks for it"});
            continue;
        }
        auto contender = library.make();
        if (mesh.triangles.size() > contender->largest_mesh())
            field.absent.push_back({library.name, "takes too long or too much memory for this mesh"});
        else
            field.contenders.push_back(std::move(contender));
    }
    if (only.empty())
        return field;
    for (const std::string& name : only) {
        const auto is_named = [&name](const auto& one) { return name == name_of(one); };
        if (std::ranges::none_of(field.contenders, is_named) && std::ranges::none_of(field.absent, is_named))
            return Error{name, "no such contender", "FDH6, Embree or another name of a table's row"};
    }
    const auto unwanted = [&only](const auto& one) {
        return std::ranges::find(only, name_of(one)) == only.end();
    };
    field.contenders.erase(std::remove_if(field.contenders.begin() + 1, field.contenders.end(), unwanted),
                           field.contenders.end());
    std::erase_if(field.absent, unwanted);
    return field;
}

} // namespace phantom::peers
