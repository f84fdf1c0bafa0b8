// SPDX-License-Identifier: GPL-3.0-or-later
#include "ray/mesh_scene.h"

#include "base/maths.h"
#include "ray/closest_tree.h"
#include "ray/embree_tree.h"

#include <algorithm>
#include <cmath>
#include <mutex>
#include <optional>

namespace lodestone::ray {
namespace {

/// Everything is scaled into the unit sphere; rays start at most on a sphere of this radius.
/// Taste: a sixteenth more than 1 is enough for rounding; a larger value spends precision on
/// nothing.
constexpr double kRimRadius = 1.0625;
/// Directions whose squared length is this near to 1 are of unit length but for rounding.
/// Taste: well above double precision's 2e-16; a larger value makes distances wrong.
constexpr double kUnitLength = 1e-12;

}  // namespace

bool available(std::string* reason) {
    if (reason != nullptr)
        *reason = why_no_embree();
    return why_no_embree().empty();
}

struct MeshScene::Data {
    glm::dvec3 center{0.0};  // local = (point - center) * scale
    double scale = 1;
    std::vector<glm::vec3> positions;  // local, and one more for Embree's wide loads
    std::vector<Triangle> triangles;
    std::unique_ptr<MeshCover> cover;  // null: opaque
    SceneUse uses = SceneUse::Everything;
    std::optional<EmbreeTree> tree;  // none: no ray can hit
    std::once_flag once;
    std::optional<ClosestTree> boxes;  // made for the first closest point

    glm::dvec3 corner(uint32_t triangle, int i) const {
        return glm::dvec3(positions[triangles[triangle][i]]);
    }

    /// The part of a ray that can hit, in the local frame.
    struct RaySegment {
        glm::dvec3 origin;
        glm::dvec3 direction;  // unit
        double skipped = 0;    // local length from the ray's origin to this one
        double far = 0;        // local length of the ray that can hit
        double unit = 1;       // local length of t = 1
    };

    /// Clips a ray; false when it cannot hit. Far origins are brought to the rim in double
    /// precision.
    bool clip(const glm::dvec3& origin, const glm::dvec3& direction, double far,
              RaySegment& part) const {
        if (uses == SceneUse::ClosestPoints)
            fail(Status::Internal, "a scene for closest points was asked for a hit");
        part.direction = direction;
        part.unit = scale;
        const double square_length = glm::dot(direction, direction);
        if (!(std::abs(square_length - 1) <= kUnitLength)) {
            const double length = glm::length(direction);
            if (!(length > 0) || !std::isfinite(length))
                return false;
            part.direction = direction / length;
            part.unit = length * scale;
        }
        if (!tree || !(far >= 0))
            return false;
        part.origin = (origin - center) * scale;
        part.far = far * part.unit;
        const double square = glm::dot(part.origin, part.origin);
        if (square <= kRimRadius * kRimRadius)
            return true;
        const double along = glm::dot(part.origin, part.direction);
        if (!(along <= 0) || !std::isfinite(square))
            return false;
        const glm::dvec3 foot = part.origin - along * part.direction;
        const double rest = kRimRadius * kRimRadius - glm::dot(foot, foot);
        if (!(rest >= 0))
            return false;
        const double half = std::sqrt(rest);
        part.skipped = -along - half;
        part.origin = foot - half * part.direction;
        part.far -= part.skipped;
        return part.far >= 0;
    }
};

MeshScene::MeshScene(const Mesh& mesh, SkinPtr skin, SceneUse uses)
    : data_(std::make_unique<Data>()) {
    require_embree();
    check(mesh);
    Data& data = *data_;
    data.uses = uses;
    data.triangles = mesh.triangles;
    Box3 box;
    for (const Triangle& t : mesh.triangles) {
        for (int corner = 0; corner < 3; ++corner) {
            if (finite(mesh.positions[t[corner]]))
                box.add(glm::dvec3(mesh.positions[t[corner]]));
        }
    }
    if (box.empty())
        return;
    data.center = box.center();
    const double radius = 0.5 * glm::length(box.size());
    if (radius > 0) {
        // A power of two is exact as a scale.
        int exponent = 0;
        std::frexp(radius, &exponent);
        data.scale = std::ldexp(1.0, -exponent);
    }
    data.positions.reserve(mesh.positions.size() + 1);
    for (const glm::vec3& position : mesh.positions) {
        // A point that is not in the unit sphere is not finite or no triangle's; Embree skips NaN.
        const glm::dvec3 local = (glm::dvec3(position) - data.center) * data.scale;
        if (glm::dot(local, local) < 2)
            data.positions.emplace_back(local);
        else
            data.positions.emplace_back(std::numeric_limits<float>::quiet_NaN());
    }
    data.positions.emplace_back(0.0f);
    if (skin && skin->see_through(mesh))
        data.cover = std::make_unique<MeshCover>(mesh, std::move(skin));
    if (uses == SceneUse::Everything)
        data.tree.emplace(data.positions, data.triangles, data.cover.get());
}

MeshScene::~MeshScene() = default;
MeshScene::MeshScene(MeshScene&&) noexcept = default;
MeshScene& MeshScene::operator=(MeshScene&&) noexcept = default;

size_t MeshScene::triangles() const {
    return data_->triangles.size();
}

bool MeshScene::see_through() const {
    return data_->cover != nullptr;
}

bool MeshScene::ends_ray(uint32_t triangle, double u, double v) const {
    return !data_->cover || data_->cover->ends_ray(triangle, u, v);
}

bool MeshScene::shows(uint32_t triangle, double u, double v) const {
    return !data_->cover || data_->cover->shows(triangle, u, v);
}

std::optional<double> MeshScene::uniform_alpha(uint32_t triangle) const {
    return data_->cover ? data_->cover->uniform_alpha(triangle) : 1;
}

RayHit MeshScene::first_hit(const glm::dvec3& origin, const glm::dvec3& direction,
                            double far) const {
    const Data& data = *data_;
    RayHit out;
    Data::RaySegment part;
    if (!data.clip(origin, direction, far, part))
        return out;
    const EmbreeTree::EmbreeHit found = data.tree->first_hit(part.origin, part.direction, part.far);
    if (found.triangle == kNoTriangle)
        return out;
    out.hit = true;
    out.triangle = found.triangle;
    out.u = std::clamp(found.u, 0.0, 1.0);
    out.v = std::clamp(found.v, 0.0, 1.0 - out.u);
    out.t = (part.skipped + found.t) / part.unit;
    const glm::dvec3 local = (1 - out.u - out.v) * data.corner(out.triangle, 0) +
                             out.u * data.corner(out.triangle, 1) +
                             out.v * data.corner(out.triangle, 2);
    out.point = data.center + local / data.scale;
    return out;
}

bool MeshScene::occluded(const glm::dvec3& origin, const glm::dvec3& direction, double far) const {
    const Data& data = *data_;
    Data::RaySegment part;
    return data.clip(origin, direction, far, part) &&
           data.tree->occluded(part.origin, part.direction, part.far);
}

bool MeshScene::occluded(const glm::dvec3& origin, const glm::dvec3& direction,
                         RecentBlockers& blockers) const {
    const Data& data = *data_;
    Data::RaySegment part;
    if (!data.clip(origin, direction, std::numeric_limits<double>::infinity(), part))
        return false;
    if (data.cover)
        return data.tree->occluded(part.origin, part.direction, part.far);
    if (blockers.block(glm::vec3(part.origin), glm::vec3(part.direction)))
        return true;
    const uint32_t by = data.tree->blocker(part.origin, part.direction);
    if (by == kNoTriangle)
        return false;
    const Triangle& t = data.triangles[by];
    blockers.add({data.positions[t.x], data.positions[t.y], data.positions[t.z]});
    return true;
}

void MeshScene::list_crossings(const glm::dvec3& origin, const glm::dvec3& direction, double far,
                               size_t most, const EndsRay& ends,
                               std::vector<RayCrossing>& out) const {
    const Data& data = *data_;
    Data::RaySegment part;
    if (!data.clip(origin, direction, far, part))
        return;
    const size_t first = out.size();
    data.tree->list_crossings(part.origin, part.direction, part.far, most, ends, out);
    for (size_t i = first; i < out.size(); ++i) {
        RayCrossing& one = out[i];
        one.u = std::clamp(one.u, 0.0, 1.0);
        one.v = std::clamp(one.v, 0.0, 1.0 - one.u);
        one.t = (part.skipped + one.t) / part.unit;
    }
}

ClosestPoint MeshScene::closest_point(const glm::dvec3& point, double radius, uint32_t perhaps,
                                      double enough) const {
    const Data& data = *data_;
    std::function<bool(uint32_t, double, double)> shown;
    if (data.cover)
        shown = [&](uint32_t triangle, double u, double v) {
            return data.cover->shows(triangle, u, v);
        };
    ClosestSearch search{data.positions, data.triangles, {}, data.cover ? &shown : nullptr};
    return closest(point, search, radius, perhaps, enough);
}

ClosestPoint MeshScene::closest_facing(const glm::dvec3& point, const glm::dvec3& direction,
                                       double radius, uint32_t perhaps) const {
    ClosestSearch search{data_->positions, data_->triangles, {}};
    search.facing = direction;
    return closest(point, search, radius, perhaps, 0);
}

ClosestPoint MeshScene::closest(const glm::dvec3& point, ClosestSearch& search, double radius,
                                uint32_t perhaps, double enough) const {
    Data& data = *data_;
    ClosestPoint out;
    if (data.positions.empty() || !(radius >= 0) || !std::isfinite(point.x + point.y + point.z))
        return out;
    search.point = (point - data.center) * data.scale;
    const double far =
        std::max({std::abs(search.point.x), std::abs(search.point.y), std::abs(search.point.z)});
    if (perhaps < data.triangles.size())
        search.visit(perhaps);
    // Larger coordinates are searched otherwise.
    // Law: their squares do not fit single precision (3.4e38), with a margin.
    constexpr double kFarthest = 1e15;
    if (far < kFarthest) {
        // The tree is made on this thread alone: one that waits for others could be given work that
        // comes back here.
        std::call_once(data.once, [&] {
            // A mesh with a cover may show one of two triangles in one place.
            data.boxes.emplace(data.positions, data.triangles, data.cover != nullptr);
        });
        // A triangle that the radius alone keeps near is not found yet.
        if (search.triangle == kNoTriangle && radius <= enough)
            enough = 0;
        data.boxes->search(search, std::min(radius * data.scale, std::sqrt(search.square)),
                           enough * data.scale);
    } else {
        for (uint32_t i = 0; i < data.triangles.size(); ++i)
            search.visit(i);
    }
    const double distance = std::sqrt(search.square) / data.scale;
    if (search.triangle == kNoTriangle || distance > radius)
        return out;
    out.distance = distance;
    out.triangle = search.triangle;
    out.u = search.where.u;
    out.v = search.where.v;
    out.point = data.center + search.where.point / data.scale;
    return out;
}

}  // namespace lodestone::ray
