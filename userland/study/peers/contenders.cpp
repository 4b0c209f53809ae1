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

} // namespace

Field field_for(const Mesh& mesh)
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
    return field;
}

} // namespace phantom::peers
