// SPDX-License-Identifier: GPL-2.0-or-later
#include "scene/scene.hpp"

namespace phantom::scene {

template <int K>
fdh::SceneTree<K> build_tree(const Scene& scene, unsigned threads)
{
    fdh::SceneTree<K> tree;
    for (const Object& object : scene.objects) {
        const fdh::MeshView view{object.mesh.vertices, object.mesh.faces};
        tree.add(fdh::TriangleTree<K>::build(view, {.threads = threads}), object.pose);
    }
    tree.update();
    return tree;
}

template fdh::SceneTree<6> build_tree<6>(const Scene&, unsigned);
template fdh::SceneTree<14> build_tree<14>(const Scene&, unsigned);
template fdh::SceneTree<18> build_tree<18>(const Scene&, unsigned);
template fdh::SceneTree<26> build_tree<26>(const Scene&, unsigned);

} // namespace phantom::scene
