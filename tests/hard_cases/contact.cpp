// SPDX-License-Identifier: GPL-2.0-or-later
#include "contact.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <new>

#include "phantom_usermode.h"

namespace phantom::hard {

namespace {

void to_nm(const Vec3& mm, s32 out[3])
{
    for (std::size_t axis = 0; axis < 3; ++axis)
        out[axis] = static_cast<s32>(std::llround(mm[axis] * 1e6));
}

Vec3 from_integers(const s32 in[3], double unit)
{
    return {in[0] * unit, in[1] * unit, in[2] * unit};
}

/// Materials of the triangles, each pair (k, R) once; `patches` point to them.
std::vector<phantom_material> materials_of(const std::vector<reference::Triangle>& triangles,
                                           const Settings& settings, std::vector<phantom_patch>& patches)
{
    std::vector<phantom_material> materials;
    for (std::size_t f = 0; f < triangles.size(); ++f) {
        phantom_material m{};
        m.stiffness_mn_mm = static_cast<u32>(std::lround(triangles[f].stiffness * 1e3));
        m.radius_nm = static_cast<u32>(std::lround(triangles[f].radius * 1e6));
        m.damping_mns_m = static_cast<u32>(std::lround(settings.damping * 1e3));
        m.effects = settings.damping > 0 ? PHANTOM_EFFECT_DAMPING : 0;
        const auto same = [&m](const phantom_material& o) {
            return o.stiffness_mn_mm == m.stiffness_mn_mm && o.radius_nm == m.radius_nm;
        };
        auto at = std::find_if(materials.begin(), materials.end(), same);
        if (at == materials.end())
            at = materials.insert(at, m);
        patches[f].material = static_cast<u32>(at - materials.begin());
    }
    return materials;
}

} // namespace

void Contact::Free::operator()(void* p) const
{
    std::free(p); // NOLINT: from std::aligned_alloc
}

std::vector<const phantom_float_ops*> sections()
{
    const phantom_float_ops* const* all = phantom_um_sections();
    std::size_t count = 0;
    while (all[count])
        ++count;
    return {all, all + count};
}

std::vector<const phantom_float_ops*> wide_sections()
{
    std::vector<const phantom_float_ops*> out = sections();
    std::erase_if(out, [](const phantom_float_ops* ops) {
        return ops->isa != PHANTOM_ISA_AVX2 && ops->isa != PHANTOM_ISA_AVX512;
    });
    return out;
}

Contact::Contact(const phantom_float_ops& ops, const std::vector<reference::Triangle>& triangles,
                 Settings settings)
    : ops_(&ops)
{
    const auto count = static_cast<u32>(triangles.size());
    std::vector<phantom_patch> patches(count);
    u32 faces = 0, rims = 0;
    for (u32 f = 0; f < count; ++f) {
        for (std::size_t i = 0; i < 3; ++i) {
            to_nm(triangles[f].corner[i], patches[f].vertex_nm[i]);
            patches[f].vertex[i] = triangles[f].vertex[i];
            patches[f].neighbour[i] = PHANTOM_PATCH_NONE;
            for (std::size_t axis = 0; axis < 3; ++axis)
                patches[f].normal_q30[i][axis] =
                    static_cast<s32>(std::lround(triangles[f].normal[i][axis] * PHANTOM_Q30_ONE));
        }
        const auto& x = triangles[f].corner;
        const bool corner = x[0] == x[1] && x[1] == x[2];
        const bool face = !triangles[f].fan && !triangles[f].rim;
        patches[f].face = !face                                     ? PHANTOM_PATCH_NONE
                          : triangles[f].face != PHANTOM_PATCH_NONE ? triangles[f].face
                                                                    : f;
        patches[f].kind = face               ? PHANTOM_PATCH_FACE
                          : triangles[f].rim ? PHANTOM_PATCH_RIM
                          : corner           ? PHANTOM_PATCH_CORNER
                                             : PHANTOM_PATCH_EDGE;
        patches[f].surface = triangles[f].surface;
        faces += face;
        rims += triangles[f].rim;
    }
    const auto materials = materials_of(triangles, settings, patches);
    set_.reset(std::aligned_alloc(PHANTOM_FLOAT_SET_ALIGN, ops.set_bytes(count)));
    if (!set_)
        throw std::bad_alloc();
    phantom_float_prepare prepare{};
    prepare.set = static_cast<phantom_float_set*>(set_.get());
    prepare.patches = patches.data();
    prepare.materials = materials.data();
    prepare.patch_count = count;
    prepare.face_count = faces;
    prepare.rim_count = rims;
    prepare.material_count = static_cast<u32>(materials.size());
    do {
        prepare.count = std::min<u32>(PHANTOM_FLOAT_PREPARE_MAX, count - prepare.first);
        ops.prepare(&prepare);
        prepare.first += prepare.count;
    } while (prepare.first < count);
    refused_ = prepare.refused;
    job_.set = prepare.set;
    job_.model.model = settings.model;
    job_.model.newton_steps = settings.newton_steps;
    job_.model.combine = settings.combine;
    job_.model.proxy = settings.proxy;
    job_.model.arith = ops.isa == PHANTOM_ISA_DOUBLE  ? PHANTOM_ARITH_DOUBLE
                       : ops.isa == PHANTOM_ISA_FIXED ? PHANTOM_ARITH_FIXED
                                                      : PHANTOM_ARITH_FLOAT;
    job_.effects = settings.effects;
    job_.radius_nm = 2000000000; // a whole mesh
    restart();
}

void Contact::restart()
{
    job_.path_valid = 0;
    job_.inside = 0;
    job_.proxy_face = PHANTOM_PATCH_NONE;
}

Touch Contact::tick(const Vec3& tip, const Vec3& velocity_mm_s)
{
    std::copy_n(job_.tip_nm, 3, job_.previous_nm);
    to_nm(tip, job_.tip_nm);
    to_nm(velocity_mm_s, job_.velocity_nm_s);
    while (ops_->tick(&job_))
        ++sections_;
    job_.path_valid = 1;

    Touch touch;
    touch.force = from_integers(job_.force_un, 1e-6);
    touch.normal = from_integers(job_.normal_q30, 1.0 / PHANTOM_Q30_ONE);
    touch.inside = job_.inside != 0;
    touch.proxy = touch.inside ? from_integers(job_.proxy_nm, 1e-6) : tip;
    touch.contacts = job_.contacts;
    touch.folded = job_.folded;
    touch.saturated = job_.saturated;
    touch.invalid = job_.invalid != 0;
    touch.job = job_;
    return touch;
}

} // namespace phantom::hard
