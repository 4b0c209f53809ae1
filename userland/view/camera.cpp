// SPDX-License-Identifier: GPL-2.0-or-later
#include "view/camera.hpp"

#include <algorithm>
#include <array>
#include <numbers>

#include <vtkCamera.h>

namespace phantom::view {

namespace {

constexpr double view_angle_deg = 22; ///< vertical; a long lens: little distortion
constexpr double margin = 1.08;
constexpr double degree = std::numbers::pi / 180;

} // namespace

void frame_all(vtkRenderer* renderer, std::span<const Vec3> points, const CameraAngles& angles,
               const Room& room)
{
    const Vec3 back = angles.direction();
    const Vec3 right = unit_or(cross({0, 1, 0}, back), {1, 0, 0});
    const Vec3 up = cross(back, right);
    const std::array<Vec3, 3> axes{right, up, back};

    std::array<double, 3> low{1e300, 1e300, 1e300}, high{-1e300, -1e300, -1e300};
    for (const Vec3& point : points) {
        for (std::size_t i = 0; i < 3; ++i) {
            low[i] = std::min(low[i], dot(point, axes[i]));
            high[i] = std::max(high[i], dot(point, axes[i]));
        }
    }
    if (points.empty())
        low = high = {0, 0, 0};
    Vec3 focus{};
    for (std::size_t i = 0; i < 3; ++i)
        focus = focus + 0.5 * (low[i] + high[i]) * axes[i];

    // Each point must lie inside the lens' pyramid: |y| <= (distance - depth) tan(angle / 2).
    // The pyramid of the room that is left is lower than the viewport's.
    const double free_height = std::max(room.height - room.header - room.footer, 0.25 * room.height);
    const double slope = std::tan(0.5 * view_angle_deg * degree);
    const double slope_y = slope * free_height / room.height, slope_x = slope * room.width / room.height;
    double distance = 1e-3;
    for (const Vec3& point : points) {
        const Vec3 at = point - focus;
        const double reach = std::max(std::abs(dot(at, right)) / slope_x, std::abs(dot(at, up)) / slope_y);
        distance = std::max(distance, margin * reach + dot(at, back));
    }
    const Vec3 position = focus + (distance / angles.zoom) * back;
    vtkCamera* camera = renderer->GetActiveCamera();
    camera->ParallelProjectionOff();
    camera->SetViewAngle(view_angle_deg);
    camera->SetFocalPoint(focus.data());
    camera->SetPosition(position.data());
    camera->SetViewUp(0, 1, 0);
    // In units of half the viewport; the focus goes to the middle of the free part.
    camera->SetWindowCenter(0, (room.header - room.footer) / room.height);
}

void frame_spot(vtkRenderer* renderer, const Vec3& centre, const Vec3& normal, const Vec3& towards_viewer,
                double half_height_mm)
{
    constexpr double tilt_deg = 24; // above the surface's plane: triangles show, and the arrow's length
    const Vec3 side = perpendicular(normal, towards_viewer);
    const Vec3 back = std::cos(tilt_deg * degree) * side + std::sin(tilt_deg * degree) * normal;
    const Vec3 position = centre + 20 * half_height_mm * back;
    vtkCamera* camera = renderer->GetActiveCamera();
    camera->ParallelProjectionOn();
    camera->SetParallelScale(half_height_mm);
    camera->SetFocalPoint(centre.data());
    camera->SetPosition(position.data());
    camera->SetViewUp(normal.data());
}

} // namespace phantom::view
