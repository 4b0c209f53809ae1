// SPDX-License-Identifier: GPL-2.0-or-later
// A float section as a test drives it: a set from triangles, one tick at a time. Units as the
// reference's: mm, N.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "meshes.hpp"
#include "reference.hpp"

extern "C" {
#include "phantom_float.h"
}

namespace phantom::hard {

struct Settings {
    std::uint32_t model = PHANTOM_MODEL_PROJECTED;
    std::uint32_t newton_steps = 3;
    std::uint32_t combine = PHANTOM_COMBINE_BOUNDED;
    std::uint32_t proxy = PHANTOM_PROXY_OFF;
    std::uint32_t effects = 0;
    double damping = 0; ///< of every material, N s/m
};

/// With the proxy of the paper.
inline Settings with_proxy(std::uint32_t model = PHANTOM_MODEL_PROJECTED)
{
    Settings settings;
    settings.model = model;
    settings.proxy = PHANTOM_PROXY_PAPER;
    return settings;
}

struct Touch {
    Vec3 force{}, normal{}, proxy{};
    unsigned contacts = 0, folded = 0, saturated = 0;
    bool inside = false, invalid = false;
    phantom_float_job job{}; ///< as the section left it
};

/// The sections that this CPU can run: avx512, avx2 (if it has them), sse2, double, fixed.
std::vector<const phantom_float_ops*> sections();
/// Those of them that must give the bits that SSE2 gives.
std::vector<const phantom_float_ops*> wide_sections();

class Contact {
  public:
    /// Faces, then fans, then rims.
    Contact(const phantom_float_ops& ops, const std::vector<reference::Triangle>& triangles,
            Settings settings);

    /// One tick; the path runs from the last tick's tip.
    Touch tick(const Vec3& tip, const Vec3& velocity_mm_s = {});
    /// The next tick has no path and is outside.
    void restart();

    [[nodiscard]] std::string name() const { return ops_->name; }
    [[nodiscard]] unsigned refused() const { return refused_; }
    /// Float sections that ticks have taken beside their first one.
    [[nodiscard]] unsigned more_sections() const { return sections_; }
    phantom_float_job& job() { return job_; }

  private:
    struct Free {
        void operator()(void* p) const;
    };
    const phantom_float_ops* ops_;
    std::unique_ptr<void, Free> set_;
    phantom_float_job job_{};
    unsigned refused_ = 0;
    unsigned sections_ = 0;
};

} // namespace phantom::hard
