// SPDX-License-Identifier: GPL-2.0-or-later
// Embree 3: rtcPointQuery, which visits boxes near to far; its callback shrinks the radius as the 64 nearest
// are found. Default scene: medium quality is the best that can be asked for, since high quality splits
// triangles and calls back for the same one several times; compact and robust scenes are slower in every
// query.
#include <embree3/rtcore.h>

#include <atomic>
#include <cstdio>
#include <cstdlib>
#include <utility>

#include "study/peers/contenders.hpp"
#include "study/peers/nearest_keeper.hpp"

namespace phantom::peers {

namespace {

class Embree final : public Contender {
  public:
    ~Embree() override { drop(); }

    [[nodiscard]] std::string name() const override { return "Embree"; }
    [[nodiscard]] std::string method() const override { return "rtcPointQuery, radius shrinks"; }

    void prepare(const Mesh& mesh) override
    {
        drop();
        mesh_ = &mesh;
    }

    void build(unsigned threads) override
    {
        drop();
        open_device(threads);
        commit_scene(RTC_SCENE_FLAG_NONE, RTC_BUILD_QUALITY_MEDIUM, RTC_BUILD_QUALITY_MEDIUM);
    }
    [[nodiscard]] bool builds_parallel() const override { return true; }
    [[nodiscard]] std::size_t bytes() const override { return static_cast<std::size_t>(bytes_.load()); }

    void query(const fdh::Point& p, double radius) override
    {
        RTCPointQuery query;
        query.x = static_cast<float>(p[0]);
        query.y = static_cast<float>(p[1]);
        query.z = static_cast<float>(p[2]);
        query.time = 0;
        query.radius = static_cast<float>(radius);
        keeper_.start(*mesh_, p, radius);
        RTCPointQueryContext context;
        rtcInitPointQueryContext(&context);
        rtcPointQuery(scene_, &query, &context, &visit, &keeper_);
        keeper_.finish();
    }
    void distances(std::vector<double>& out) const override { keeper_.distances(out); }

    [[nodiscard]] bool refits() const override { return mesh_->triangles.size() <= refits_up_to; }
    [[nodiscard]] bool refits_parallel() const override { return true; }
    /// A scene that can be refitted is of another kind than one that is only queried: low quality, with a
    /// tree for each geometry.
    void prepare_refit(const Mesh& moved, unsigned threads) override
    {
        drop();
        open_device(threads);
        commit_scene(RTC_SCENE_FLAG_DYNAMIC, RTC_BUILD_QUALITY_LOW, RTC_BUILD_QUALITY_REFIT);
        mesh_ = &moved;
        share_points(rtcGetGeometry(scene_, 0));
    }
    void refit() override
    {
        const RTCGeometry geometry = rtcGetGeometry(scene_, 0);
        rtcUpdateGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0);
        rtcCommitGeometry(geometry);
        rtcCommitScene(scene_);
    }

  private:
    /// Beyond, its dynamic scene takes too much memory.
    static constexpr std::size_t refits_up_to = 5'000'000;

    static bool visit(RTCPointQueryFunctionArguments* arguments)
    {
        NearestKeeper& keeper = *static_cast<NearestKeeper*>(arguments->userPtr);
        if (!keeper.offer(arguments->primID))
            return false;
        arguments->query->radius = std::sqrt(keeper.bound2());
        return true;
    }

    void open_device(unsigned threads)
    {
        device_ = rtcNewDevice(("threads=" + std::to_string(threads)).c_str());
        if (!device_) {
            std::fprintf(stderr, "peers_bench: Embree has no device: error %d\n", rtcGetDeviceError(nullptr));
            std::exit(1);
        }
        bytes_ = 0;
        rtcSetDeviceMemoryMonitorFunction(
            device_,
            [](void* self, ssize_t bytes, bool) {
                static_cast<Embree*>(self)->bytes_ += bytes;
                return true;
            },
            this);
    }

    void share_points(RTCGeometry geometry) const
    {
        rtcSetSharedGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3,
                                   mesh_->points.data(), 0, sizeof(mesh_->points[0]), mesh_->points.size());
    }

    void commit_scene(RTCSceneFlags flags, RTCBuildQuality quality, RTCBuildQuality geometry_quality)
    {
        scene_ = rtcNewScene(device_);
        rtcSetSceneFlags(scene_, flags);
        rtcSetSceneBuildQuality(scene_, quality);
        const RTCGeometry geometry = rtcNewGeometry(device_, RTC_GEOMETRY_TYPE_TRIANGLE);
        rtcSetGeometryBuildQuality(geometry, geometry_quality);
        share_points(geometry);
        rtcSetSharedGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3,
                                   mesh_->triangles.data(), 0, sizeof(mesh_->triangles[0]),
                                   mesh_->triangles.size());
        rtcCommitGeometry(geometry);
        rtcAttachGeometry(scene_, geometry);
        rtcReleaseGeometry(geometry);
        rtcCommitScene(scene_);
    }

    void drop()
    {
        if (scene_)
            rtcReleaseScene(std::exchange(scene_, nullptr));
        if (device_)
            rtcReleaseDevice(std::exchange(device_, nullptr));
    }

    const Mesh* mesh_ = nullptr;
    RTCDevice device_ = nullptr;
    RTCScene scene_ = nullptr;
    std::atomic<std::ptrdiff_t> bytes_ = 0;
    NearestKeeper keeper_;
};

} // namespace

std::unique_ptr<Contender> make_embree()
{
    return std::make_unique<Embree>();
}

} // namespace phantom::peers
