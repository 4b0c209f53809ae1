// SPDX-License-Identifier: GPL-2.0-or-later
#include "scene/live_scene.hpp"

#include <algorithm>
#include <limits>
#include <utility>

namespace phantom::scene {

namespace {

constexpr double never_s = -std::numeric_limits<double>::infinity();

} // namespace

fdh::Pose Moment::pose(const Scene& rest, std::uint32_t object) const
{
    const std::optional<Placement>& placement = objects[object].placement;
    return placement ? placement->carried(rest.objects[object].pose) : rest.objects[object].pose;
}

bool LiveScene::is_called_for(const Scene& scene)
{
    return std::any_of(scene.objects.begin(), scene.objects.end(), [](const Object& object) {
        return object.motion.has_value() || object.deformation.has_value();
    });
}

LiveScene::LiveScene(const Scene& rest, const fdh::SceneTree<14>& tree)
    : scene_(rest), shapes_(rest.objects.size()), shaped_s_(rest.objects.size(), never_s)
{
    auto moment = std::make_shared<Moment>();
    moment->t_s = -1;
    moment->objects.resize(scene_.objects.size());
    for (std::uint32_t i = 0; i < scene_.objects.size(); ++i) {
        Object& object = scene_.objects[i];
        object.tree = tree.tree(i);
        tree_.add(tree.tree(i), object.pose);
        if (object.deformation) {
            shapes_[i].emplace(object, *object.deformation);
            take_shape(i, shapes_[i]->now());
            moment->objects[i].vertices = object.mesh.vertices;
            moment->objects[i].normals = object.mesh.normals;
        }
        if (object.motion)
            moment->objects[i].placement = object.motion->at(moment->t_s);
    }
    tree_.update();
    moment_ = std::move(moment);
}

void LiveScene::take_shape(std::uint32_t object, const Surface& surface)
{
    static_cast<Surface&>(scene_.objects[object]) = surface;
    tree_.set_tree(object, *surface.tree);
}

void LiveScene::take_poses(const Moment& moment)
{
    for (std::uint32_t i = 0; i < scene_.objects.size(); ++i)
        if (moment.objects[i].placement)
            tree_.set_pose(i, moment.pose(scene_, i));
    tree_.update();
}

void LiveScene::advance(double t_s)
{
    auto next = std::make_shared<Moment>(*moment_);
    next->t_s = t_s;
    for (std::uint32_t i = 0; i < scene_.objects.size(); ++i) {
        const Object& object = scene_.objects[i];
        Moment::ObjectNow& now = next->objects[i];
        if (object.motion)
            now.placement = object.motion->at(t_s);
        if (!shapes_[i])
            continue;
        // At rest there is one shape. A hair for the rounding of times.
        const double since_s = t_s - shaped_s_[i];
        const bool due = since_s < 0 || since_s > 0.999 * revision_interval_s(object.mesh.faces.size());
        if (!due || (t_s <= 0 && moment_->t_s <= 0))
            continue;
        take_shape(i, shapes_[i]->displaced(object.deformation->displacement_mm(t_s)));
        shaped_s_[i] = t_s;
        ++now.revision;
        now.vertices = object.mesh.vertices;
        now.normals = object.mesh.normals;
    }
    take_poses(*next);
    moment_ = std::move(next);
}

void LiveScene::follow(const LiveScene& finest)
{
    for (std::uint32_t i = 0; i < scene_.objects.size(); ++i)
        if (shapes_[i] && moment_->objects[i].revision != finest.moment_->objects[i].revision)
            take_shape(i, finest.scene_.objects[i]);
    take_poses(*finest.moment_);
    moment_ = finest.moment_;
}

} // namespace phantom::scene
