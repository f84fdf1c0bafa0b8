// SPDX-License-Identifier: GPL-3.0-or-later
#include "ray/embree_tree.h"

#include "base/error.h"

#include <embree3/rtcore.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <dlfcn.h>
#include <exception>
#include <limits>
#include <new>
#include <thread>
#include <tuple>
#include <vector>

#if defined(__SSE2__)
#include <immintrin.h>
#endif

namespace lodestone::ray {
namespace {

constexpr char kFileName[] = "libembree3.so.3";

/// Embree's functions, looked up in the one library that was opened. Linking to Embree instead
/// would bind to whichever version the host program has loaded, with other signatures: no crash,
/// no hits.
struct EmbreeFunctions {
    decltype(&rtcNewDevice) new_device = nullptr;
    decltype(&rtcReleaseDevice) release_device = nullptr;
    decltype(&rtcGetDeviceProperty) get_device_property = nullptr;
    decltype(&rtcGetDeviceError) get_device_error = nullptr;
    decltype(&rtcNewScene) new_scene = nullptr;
    decltype(&rtcReleaseScene) release_scene = nullptr;
    decltype(&rtcSetSceneFlags) set_scene_flags = nullptr;
    decltype(&rtcCommitScene) commit_scene = nullptr;
    decltype(&rtcAttachGeometry) attach_geometry = nullptr;
    decltype(&rtcNewGeometry) new_geometry = nullptr;
    decltype(&rtcReleaseGeometry) release_geometry = nullptr;
    decltype(&rtcCommitGeometry) commit_geometry = nullptr;
    decltype(&rtcSetSharedGeometryBuffer) set_shared_buffer = nullptr;
    decltype(&rtcSetGeometryIntersectFilterFunction) set_intersect_filter = nullptr;
    decltype(&rtcSetGeometryOccludedFilterFunction) set_occluded_filter = nullptr;
    decltype(&rtcSetGeometryUserData) set_user_data = nullptr;
    decltype(&rtcIntersect1) intersect = nullptr;
    decltype(&rtcOccluded1) occluded = nullptr;
    RTCDevice device = nullptr;
    std::string reason;  // why it cannot be used; empty when it can

    bool usable() const { return reason.empty(); }
};

template <typename Function>
void look_up(void* library, const char* name, Function& function, std::string& missing) {
    void* const symbol = dlsym(library, name);
    if (symbol == nullptr)
        missing = name;
    else
        function = reinterpret_cast<Function>(symbol);
}

/// The crossings of one ray while they are found.
struct CrossingList {
    std::vector<RayCrossing>& out;
    size_t first;  // of `out`
    size_t most;
    const EndsRay& ends;
    double limit = std::numeric_limits<double>::infinity();  // as many are nearer
    std::exception_ptr failed = {};

    /// Whether the ray ends at one more.
    bool add(const RTCHit& hit, double t, double alpha) {
        if (t > limit)
            return false;
        const bool stops = ends(hit.primID, alpha);
        out.push_back(
            {hit.primID, static_cast<double>(hit.u), static_cast<double>(hit.v), t, stops});
        if (out.size() - first >= 2 * most) {
            const auto begin = out.begin() + static_cast<std::ptrdiff_t>(first);
            const auto last = begin + static_cast<std::ptrdiff_t>(most) - 1;
            std::nth_element(begin, last, out.end(),
                             [](const RayCrossing& a, const RayCrossing& b) {
                                 return std::tie(a.t, a.triangle) < std::tie(b.t, b.triangle);
                             });
            limit = last->t;
            out.resize(first + most);
        }
        return stops;
    }
};

/// A ray context that remembers the best hit so far, for ties; or lists all hits.
struct TieContext {
    RTCIntersectContext embree;
    float t;
    unsigned triangle;
    CrossingList* crossings;  // null: the first hit is wanted
};

/// Keeps the lowest triangle among hits at one distance: else the answer would depend on the order
/// of leaves, and with it on the number of threads that built the tree.
void keep_lowest_of(const RTCFilterFunctionNArguments* arguments, double alpha) {
    auto* best =
        reinterpret_cast<TieContext*>(const_cast<RTCIntersectContext*>(arguments->context));
    const auto* ray = reinterpret_cast<const RTCRay*>(arguments->ray);
    const auto* hit = reinterpret_cast<const RTCHit*>(arguments->hit);
    if (best->crossings != nullptr) {
        // Nothing may be thrown through Embree.
        try {
            if (!best->crossings->add(*hit, static_cast<double>(ray->tfar), alpha))
                arguments->valid[0] = 0;
        } catch (...) {
            best->crossings->failed = std::current_exception();
        }
        return;
    }
    if (ray->tfar == best->t && hit->primID > best->triangle) {
        arguments->valid[0] = 0;
        return;
    }
    best->t = ray->tfar;
    best->triangle = hit->primID;
}

void keep_lowest(const RTCFilterFunctionNArguments* arguments) {
    keep_lowest_of(arguments, 1);
}

/// The alpha of a hit where it stops its ray; else 0.
double stopping_alpha(const RTCFilterFunctionNArguments* arguments) {
    const auto* hit = reinterpret_cast<const RTCHit*>(arguments->hit);
    const auto u = static_cast<double>(hit->u);
    const auto v = static_cast<double>(hit->v);
    const double alpha =
        static_cast<const MeshCover*>(arguments->geometryUserPtr)->alpha(hit->primID, u, v);
    return MeshCover::ends_ray(alpha, hit->primID, u, v) ? alpha : 0;
}

void keep_lowest_that_stops(const RTCFilterFunctionNArguments* arguments) {
    const double alpha = stopping_alpha(arguments);
    if (alpha > 0)
        keep_lowest_of(arguments, alpha);
    else
        arguments->valid[0] = 0;
}

void keep_what_stops(const RTCFilterFunctionNArguments* arguments) {
    if (!(stopping_alpha(arguments) > 0))
        arguments->valid[0] = 0;
}

/// A ray context that is told which triangle blocks the ray.
struct BlockerContext {
    RTCIntersectContext embree;
    unsigned triangle;
};

void tell_blocker(const RTCFilterFunctionNArguments* arguments) {
    auto* context =
        reinterpret_cast<BlockerContext*>(const_cast<RTCIntersectContext*>(arguments->context));
    context->triangle = reinterpret_cast<const RTCHit*>(arguments->hit)->primID;
}

RTCScene new_scene(const EmbreeFunctions& embree, const std::vector<glm::vec3>& padded,
                   const std::vector<Triangle>& triangles, const MeshCover* cover) {
    RTCScene scene = embree.new_scene(embree.device);
    RTCGeometry geometry = embree.new_geometry(embree.device, RTC_GEOMETRY_TYPE_TRIANGLE);
    if (scene != nullptr && geometry != nullptr) {
        // Robust: boxes are tested conservatively and edges are watertight.
        embree.set_scene_flags(scene,
                               static_cast<RTCSceneFlags>(RTC_SCENE_FLAG_ROBUST |
                                                          RTC_SCENE_FLAG_CONTEXT_FILTER_FUNCTION));
        embree.set_shared_buffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3,
                                 padded.data(), 0, sizeof(glm::vec3), padded.size() - 1);
        embree.set_shared_buffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3,
                                 triangles.data(), 0, sizeof(Triangle), triangles.size());
        if (cover != nullptr) {
            embree.set_user_data(geometry, const_cast<MeshCover*>(cover));
            embree.set_intersect_filter(geometry, keep_lowest_that_stops);
            embree.set_occluded_filter(geometry, keep_what_stops);
        } else {
            embree.set_intersect_filter(geometry, keep_lowest);
        }
        embree.commit_geometry(geometry);
        embree.attach_geometry(scene, geometry);
        embree.commit_scene(scene);
    }
    if (geometry != nullptr)
        embree.release_geometry(geometry);
    const RTCError error = embree.get_device_error(embree.device);
    if (scene != nullptr && error == RTC_ERROR_NONE)
        return scene;
    if (scene != nullptr)
        embree.release_scene(scene);
    if (error == RTC_ERROR_OUT_OF_MEMORY)
        throw std::bad_alloc();
    fail(Status::Internal, "Embree could not build a scene of ", triangles.size(),
         " triangles (error ", static_cast<int>(error), ")");
}

RTCRayHit trace(const EmbreeFunctions& embree, RTCScene scene, const glm::dvec3& origin,
                const glm::dvec3& direction, double far, TieContext& context) {
    rtcInitIntersectContext(&context.embree);
    context.t = std::numeric_limits<float>::infinity();
    context.triangle = kNoTriangle;
    RTCRayHit ray{};
    ray.ray.org_x = static_cast<float>(origin.x);
    ray.ray.org_y = static_cast<float>(origin.y);
    ray.ray.org_z = static_cast<float>(origin.z);
    ray.ray.dir_x = static_cast<float>(direction.x);
    ray.ray.dir_y = static_cast<float>(direction.y);
    ray.ray.dir_z = static_cast<float>(direction.z);
    ray.ray.tfar = static_cast<float>(far);
    ray.ray.mask = ~0u;
    ray.hit.geomID = RTC_INVALID_GEOMETRY_ID;
    ray.hit.primID = RTC_INVALID_GEOMETRY_ID;
    ray.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
    embree.intersect(scene, &context.embree, &ray);
    return ray;
}

/// Casts one hit and one miss with known answers. Empty when both are right.
std::string test(const EmbreeFunctions& embree) {
    const std::vector<glm::vec3> padded{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 0}};
    const std::vector<Triangle> triangles{{0, 1, 2}};
    const FlushDenormals flush;
    RTCScene scene = new_scene(embree, padded, triangles, nullptr);
    TieContext first{};
    const RTCRayHit hit = trace(embree, scene, {0.25, 0.5, 2}, {0, 0, -1}, 4, first);
    TieContext second{};
    const RTCRayHit miss = trace(embree, scene, {0.75, 0.5, 2}, {0, 0, -1}, 4, second);
    embree.release_scene(scene);
    const auto near = [](double a, double b) { return std::abs(a - b) < 1e-5; };
    if (hit.hit.geomID == RTC_INVALID_GEOMETRY_ID || hit.hit.primID != 0 ||
        !near(hit.hit.u, 0.25) || !near(hit.hit.v, 0.5) || !near(hit.ray.tfar, 2) ||
        miss.hit.geomID != RTC_INVALID_GEOMETRY_ID)
        return "a ray with a known hit came back with another answer";
    return {};
}

/// Opens one candidate; the reason says why it cannot be used. A library that was opened stays
/// open: its worker threads may be running its code.
EmbreeFunctions open(const std::string& path) {
    EmbreeFunctions embree;
    void* library = dlopen(path.c_str(), RTLD_NOW | RTLD_LOCAL);
    if (library == nullptr) {
        const char* why = dlerror();
        embree.reason = why != nullptr ? why : path + " could not be opened";
        return embree;
    }
    std::string missing;
    look_up(library, "rtcNewDevice", embree.new_device, missing);
    look_up(library, "rtcReleaseDevice", embree.release_device, missing);
    look_up(library, "rtcGetDeviceProperty", embree.get_device_property, missing);
    look_up(library, "rtcGetDeviceError", embree.get_device_error, missing);
    look_up(library, "rtcNewScene", embree.new_scene, missing);
    look_up(library, "rtcReleaseScene", embree.release_scene, missing);
    look_up(library, "rtcSetSceneFlags", embree.set_scene_flags, missing);
    look_up(library, "rtcCommitScene", embree.commit_scene, missing);
    look_up(library, "rtcAttachGeometry", embree.attach_geometry, missing);
    look_up(library, "rtcNewGeometry", embree.new_geometry, missing);
    look_up(library, "rtcReleaseGeometry", embree.release_geometry, missing);
    look_up(library, "rtcCommitGeometry", embree.commit_geometry, missing);
    look_up(library, "rtcSetSharedGeometryBuffer", embree.set_shared_buffer, missing);
    look_up(library, "rtcSetGeometryIntersectFilterFunction", embree.set_intersect_filter, missing);
    look_up(library, "rtcSetGeometryOccludedFilterFunction", embree.set_occluded_filter, missing);
    look_up(library, "rtcSetGeometryUserData", embree.set_user_data, missing);
    look_up(library, "rtcIntersect1", embree.intersect, missing);
    look_up(library, "rtcOccluded1", embree.occluded, missing);
    if (!missing.empty()) {
        embree.reason = text(path, " has no function ", missing);
        return embree;
    }
    embree.device = embree.new_device(nullptr);
    if (embree.device == nullptr) {
        embree.reason = text(path, " could not make a device (error ",
                             static_cast<int>(embree.get_device_error(nullptr)), ")");
        return embree;
    }
    const auto version = embree.get_device_property(embree.device, RTC_DEVICE_PROPERTY_VERSION);
    if (version < 31300 || version >= 40000)
        embree.reason = text(path, " is version ", version, ", not 3.13 or a later 3");
    else
        embree.reason = test(embree);
    if (!embree.usable()) {
        embree.release_device(embree.device);
        embree.device = nullptr;
    }
    return embree;
}

EmbreeFunctions find() noexcept {
    EmbreeFunctions embree;
    try {
        std::vector<std::string> paths;
        Dl_info us{};
        if (dladdr(reinterpret_cast<void*>(&find), &us) != 0 && us.dli_fname != nullptr) {
            const std::string file = us.dli_fname;
            const size_t slash = file.rfind('/');
            if (slash != std::string::npos) {
                paths.push_back(file.substr(0, slash + 1) + kFileName);
                paths.push_back(file.substr(0, slash + 1) + "lib/" + kFileName);
            }
        }
        paths.emplace_back(kFileName);
        for (const std::string& path : paths) {
            embree = open(path);
            if (embree.usable())
                break;
        }
    } catch (const std::exception& error) {
        embree.reason = error.what();
    }
    return embree;
}

const EmbreeFunctions& found() {
    // The library is opened on a thread of its own: Embree waits by working on whatever tasks its
    // thread may take, and a task of the caller's loop could come back here before this is done.
    static const EmbreeFunctions* const kFoundOnce = [] {
        auto* const embree = new EmbreeFunctions;
        try {
            std::thread([embree] { *embree = find(); }).join();
        } catch (const std::exception& error) {
            embree->reason = error.what();
        }
        return embree;
    }();
    return *kFoundOnce;
}

const EmbreeFunctions& embree_or_throw() {
    const EmbreeFunctions& embree = found();
    if (!embree.usable())
        fail(Status::RaysUnavailable,
             "rays cannot be cast because Embree cannot be used: ", embree.reason);
    return embree;
}

}  // namespace

#if defined(__SSE2__)
namespace {
/// Flush to zero, and denormals are zero.
/// Law: bits 15 and 6 of MXCSR (Intel's manual, volume 1, 10.2.3).
constexpr unsigned kFlushDenormals = 0x8040;
}  // namespace

// Flushes denormals until the end: Blender and Python want their own setting back.
FlushDenormals::FlushDenormals() : saved_(_mm_getcsr()) {
    if ((saved_ & kFlushDenormals) != kFlushDenormals)
        _mm_setcsr(saved_ | kFlushDenormals);
}
FlushDenormals::~FlushDenormals() {
    if ((saved_ & kFlushDenormals) != kFlushDenormals)
        _mm_setcsr(saved_);
}
#else
FlushDenormals::FlushDenormals() : saved_(0) {}
FlushDenormals::~FlushDenormals() = default;
#endif

const std::string& why_no_embree() {
    return found().reason;
}

void require_embree() {
    embree_or_throw();
}

EmbreeTree::EmbreeTree(const std::vector<glm::vec3>& positions,
                       const std::vector<Triangle>& triangles, const MeshCover* cover)
    : scene_(new_scene(embree_or_throw(), positions, triangles, cover)) {}

EmbreeTree::~EmbreeTree() {
    found().release_scene(static_cast<RTCScene>(scene_));
}

EmbreeTree::EmbreeHit EmbreeTree::first_hit(const glm::dvec3& origin, const glm::dvec3& direction,
                                            double far) const {
    const FlushDenormals flush;
    TieContext context{};
    const RTCRayHit ray =
        trace(found(), static_cast<RTCScene>(scene_), origin, direction, far, context);
    EmbreeHit out;
    if (ray.hit.geomID == RTC_INVALID_GEOMETRY_ID)
        return out;
    out.triangle = ray.hit.primID;
    out.u = static_cast<double>(ray.hit.u);
    out.v = static_cast<double>(ray.hit.v);
    out.t = static_cast<double>(ray.ray.tfar);
    return out;
}

void EmbreeTree::list_crossings(const glm::dvec3& origin, const glm::dvec3& direction, double far,
                                size_t most, const EndsRay& ends,
                                std::vector<RayCrossing>& out) const {
    const FlushDenormals flush;
    CrossingList list{out, out.size(), std::max<size_t>(most, 1), ends};
    TieContext context{};
    context.crossings = &list;
    trace(found(), static_cast<RTCScene>(scene_), origin, direction, far, context);
    if (list.failed)
        std::rethrow_exception(list.failed);
}

namespace {

/// Whether anything blocks a ray.
bool blocks(RTCScene scene, const glm::dvec3& origin, const glm::dvec3& direction, double far,
            RTCIntersectContext& context) {
    const FlushDenormals flush;
    RTCRay ray{};
    ray.org_x = static_cast<float>(origin.x);
    ray.org_y = static_cast<float>(origin.y);
    ray.org_z = static_cast<float>(origin.z);
    ray.dir_x = static_cast<float>(direction.x);
    ray.dir_y = static_cast<float>(direction.y);
    ray.dir_z = static_cast<float>(direction.z);
    ray.tfar = static_cast<float>(far);
    ray.mask = ~0u;
    found().occluded(scene, &context, &ray);
    return ray.tfar < 0;
}

}  // namespace

bool EmbreeTree::occluded(const glm::dvec3& origin, const glm::dvec3& direction, double far) const {
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    return blocks(static_cast<RTCScene>(scene_), origin, direction, far, context);
}

uint32_t EmbreeTree::blocker(const glm::dvec3& origin, const glm::dvec3& direction) const {
    BlockerContext context{};
    rtcInitIntersectContext(&context.embree);
    context.embree.filter = tell_blocker;
    const bool blocked = blocks(static_cast<RTCScene>(scene_), origin, direction,
                                std::numeric_limits<double>::infinity(), context.embree);
    return blocked ? context.triangle : kNoTriangle;
}

}  // namespace lodestone::ray
