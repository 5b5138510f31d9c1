// Embree's scene, and the filter for surfaces that let light pass.
#include "trace/rays.h"

#if LOBELIA_EMBREE == 3
#include <embree3/rtcore.h>
#else
#include <embree4/rtcore.h>
#endif

#include <algorithm>
#include <array>
#include <cassert>
#include <cstring>
#include <new>
#include <utility>

#include "lobelia/simd.h"

namespace lobelia {
namespace {

#if LOBELIA_EMBREE == 3
using Context = RTCIntersectContext;
constexpr RTCSceneFlags k_filter_flag = RTC_SCENE_FLAG_CONTEXT_FILTER_FUNCTION;
void start(Context& context) {
    rtcInitIntersectContext(&context);
    context.flags = RTC_INTERSECT_CONTEXT_FLAG_INCOHERENT;
}
void intersect(RTCScene scene, Context& context, RTCFilterFunctionN filter, RTCRayHit& ray) {
    context.filter = filter;
    rtcIntersect1(scene, &context, &ray);
}
void occlude(RTCScene scene, Context& context, RTCFilterFunctionN filter, RTCRay& ray) {
    context.filter = filter;
    rtcOccluded1(scene, &context, &ray);
}
#else
using Context = RTCRayQueryContext;
constexpr RTCSceneFlags k_filter_flag = RTC_SCENE_FLAG_FILTER_FUNCTION_IN_ARGUMENTS;
void start(Context& context) { rtcInitRayQueryContext(&context); }
template <class Arguments>
void prepare(Arguments& arguments, Context& context, RTCFilterFunctionN filter) {
    arguments.context = &context;
    arguments.filter = filter;
    arguments.flags =
        filter == nullptr
            ? RTC_RAY_QUERY_FLAG_INCOHERENT
            : static_cast<RTCRayQueryFlags>(RTC_RAY_QUERY_FLAG_INCOHERENT | RTC_RAY_QUERY_FLAG_INVOKE_ARGUMENT_FILTER);
}
void intersect(RTCScene scene, Context& context, RTCFilterFunctionN filter, RTCRayHit& ray) {
    RTCIntersectArguments arguments;
    rtcInitIntersectArguments(&arguments);
    prepare(arguments, context, filter);
    rtcIntersect1(scene, &ray, &arguments);
}
void occlude(RTCScene scene, Context& context, RTCFilterFunctionN filter, RTCRay& ray) {
    RTCOccludedArguments arguments;
    rtcInitOccludedArguments(&arguments);
    prepare(arguments, context, filter);
    rtcOccluded1(scene, &ray, &arguments);
}
#endif

/// Data of the filter; Embree passes a pointer to the context.
struct FilterContext {
    Context embree;  // first, so that a pointer to it is a pointer to this
    const std::uint8_t* kinds;
    const Transparency* transparency;
    std::uint32_t salt;
    std::uint8_t passing;  ///< kinds that let light pass
};

/// Rejects hits that let light pass. Embree calls this for each hit, with one ray at a time.
void reject_passable_hits(const RTCFilterFunctionNArguments* a) {
    assert(a->N == 1);
    const auto& context = *reinterpret_cast<const FilterContext*>(a->context);
    const auto& ray = *reinterpret_cast<const RTCRay*>(a->ray);
    const auto& hit = *reinterpret_cast<const RTCHit*>(a->hit);
    const std::uint8_t kind = context.kinds[hit.primID] & context.passing;
    if (kind == 0 || a->valid[0] == 0) return;
    const float along = ray.dir_x * hit.Ng_x + ray.dir_y * hit.Ng_y + ray.dir_z * hit.Ng_z;
    const bool from_behind = (kind & k_one_sided) != 0 && along > 0;
    if (from_behind ||
        ((kind & k_transparent) != 0 && context.transparency->passes(hit.primID, hit.u, hit.v, context.salt)))
        a->valid[0] = 0;
}

constexpr std::uint8_t passing(Backs backs) {
    return backs == Backs::pass ? k_one_sided | k_transparent : k_transparent;
}

RTCRay make_ray(Vec3 origin, Vec3 direction, float farthest) {
    RTCRay ray;
    ray.org_x = origin.x, ray.org_y = origin.y, ray.org_z = origin.z;
    ray.dir_x = direction.x, ray.dir_y = direction.y, ray.dir_z = direction.z;
    ray.tnear = 0, ray.tfar = farthest;
    ray.time = 0;
    ray.mask = 0xffffffffu;
    ray.id = ray.flags = 0;
    return ray;
}

RayHit find(RTCScene scene, Context& context, RTCFilterFunctionN filter, RTCRay ray) {
    RTCRayHit query;
    query.ray = ray;
    query.hit.geomID = RTC_INVALID_GEOMETRY_ID;
    query.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
    intersect(scene, context, filter, query);
    if (query.hit.geomID == RTC_INVALID_GEOMETRY_ID) return {k_infinite, 0, 0, 0};
    return {query.ray.tfar, query.hit.primID, query.hit.u, query.hit.v};
}

/// Tells Embree whether to continue building.
bool go_on(void* stop, double /*done*/) { return !static_cast<const StopFlag*>(stop)->is_set(); }

/// Lets Embree use the instruction set of the kernels: what hits a ray reports differs in the last bits, too.
const char* device_configuration() {
    constexpr std::array sets = {std::pair{"AVX3", "isa=avx512"}, std::pair{"AVX2", "isa=avx2"},
                                 std::pair{"SSE4", "isa=sse4.2"}, std::pair{"SCALAR", "isa=sse2"}};
    for (const auto& [target, configuration] : sets)
        if (simd_target() == target) return configuration;
    return nullptr;
}

}  // namespace

struct RayScene::Handles {
    RTCDevice device = nullptr;
    RTCScene scene = nullptr;
};

RayScene::RayScene(const World& world, std::vector<std::uint8_t> kinds, const Transparency& transparency, StopFlag stop)
    : kinds_(std::move(kinds)), transparency_(&transparency), handles_(new Handles), all_kinds_(0) {
    for (const std::uint8_t kind : kinds_) all_kinds_ |= kind;
    assert(kinds_.size() == world.triangles.size());
    handles_->device = rtcNewDevice(device_configuration());
    handles_->scene = rtcNewScene(handles_->device);
    rtcSetSceneFlags(handles_->scene, static_cast<RTCSceneFlags>(RTC_SCENE_FLAG_ROBUST | k_filter_flag));
    rtcSetSceneBuildQuality(handles_->scene, RTC_BUILD_QUALITY_HIGH);
    if (!world.triangles.empty()) {
        RTCGeometry geometry = rtcNewGeometry(handles_->device, RTC_GEOMETRY_TYPE_TRIANGLE);
        const auto copy = [&](RTCBufferType type, RTCFormat format, const auto& from) {
            constexpr std::size_t size = sizeof(from[0]);
            void* to = rtcSetNewGeometryBuffer(geometry, type, 0, format, size, from.size());
            if (to == nullptr) throw std::bad_alloc();
            std::memcpy(to, from.data(), size * from.size());
        };
        copy(RTC_BUFFER_TYPE_VERTEX, RTC_FORMAT_FLOAT3, world.positions);
        copy(RTC_BUFFER_TYPE_INDEX, RTC_FORMAT_UINT3, world.triangles);
        rtcCommitGeometry(geometry);
        rtcAttachGeometry(handles_->scene, geometry);
        rtcReleaseGeometry(geometry);
    }
    // Embree asks now and then whether to go on building.
    rtcSetSceneProgressMonitorFunction(handles_->scene, go_on, &stop);
    rtcCommitScene(handles_->scene);
    rtcSetSceneProgressMonitorFunction(handles_->scene, nullptr, nullptr);
    if (!stop.is_set()) return;
    release();
    throw Stopped{};
}

RayScene::~RayScene() { release(); }

void RayScene::release() {
    rtcReleaseScene(handles_->scene);
    rtcReleaseDevice(handles_->device);
    delete handles_;
}

RayHit RayScene::closest(Vec3 origin, Vec3 direction, float farthest) const {
    Context context;
    start(context);
    return find(handles_->scene, context, nullptr, make_ray(origin, direction, farthest));
}

RayHit RayScene::closest_stop(Vec3 origin, Vec3 direction, std::uint32_t salt, Backs backs) const {
    FilterContext context{{}, kinds_.data(), transparency_, salt, passing(backs)};
    start(context.embree);
    return find(handles_->scene, context.embree, reject_passable_hits, make_ray(origin, direction, k_infinite));
}

bool RayScene::stopped(Vec3 origin, Vec3 direction, float distance, std::uint32_t salt, Backs backs) const {
    FilterContext context{{}, kinds_.data(), transparency_, salt, passing(backs)};
    start(context.embree);
    RTCRay ray = make_ray(origin, direction, distance);
    const bool all_stop = (all_kinds_ & context.passing) == 0;
    occlude(handles_->scene, context.embree, all_stop ? nullptr : reject_passable_hits, ray);
    return ray.tfar < 0;
}

}  // namespace lobelia
