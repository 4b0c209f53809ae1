// SPDX-License-Identifier: GPL-2.0-or-later
#include "scene/scene.hpp"

namespace phantom::scene {

namespace {

fdh::MeshView view_of(const mesh::Mesh& mesh)
{
    return {mesh.vertices, mesh.faces};
}

template <int K>
fdh::TriangleTree<K> hulls_of(const Surface& surface, unsigned threads)
{
    if constexpr (K == 14)
        if (surface.tree)
            return *surface.tree;
    return fdh::TriangleTree<K>::build(view_of(surface.mesh), {.threads = threads});
}

} // namespace

void Surface::build_hulls()
{
    if (!tree)
        tree = fdh::TriangleTree<14>::build(view_of(mesh));
}

template <int K>
fdh::SceneTree<K> build_tree(const Scene& scene, unsigned threads)
{
    fdh::SceneTree<K> tree;
    for (const Object& object : scene.objects)
        tree.add(hulls_of<K>(object, threads), object.pose);
    tree.update();
    return tree;
}

template fdh::SceneTree<6> build_tree<6>(const Scene&, unsigned);
template fdh::SceneTree<14> build_tree<14>(const Scene&, unsigned);
template fdh::SceneTree<18> build_tree<18>(const Scene&, unsigned);
template fdh::SceneTree<26> build_tree<26>(const Scene&, unsigned);

} // namespace phantom::scene
