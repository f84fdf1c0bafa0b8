// SPDX-License-Identifier: GPL-3.0-or-later
#include "light/sky/sky_sampler.h"

#include "base/maths.h"
#include "measure/visible/convex_bound.h"

#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include <algorithm>
#include <cmath>

namespace lodestone::light {
namespace {

// A triangle that sees less may lie inside of something.
// Taste: a larger value looks more often, for up to seven rays each, and as many times three flat ones.
constexpr double kDark = 0.06;
// The rays that meet a near back for it to do so, and those that do not for it not to.
// Taste: more tell it better; most dark triangles lie in the shade alone.
constexpr int kInsideRays = 4;
constexpr int kOutsideRays = 4;  // Taste: as kInsideRays
// The hidden rays of a triangle that are looked at for near backs, where none of them meets one.
// Taste: more find smaller parts of triangles inside of something; looking takes as long as casting.
constexpr int kLooks = 12;
// Triangles side by side take different parts of the Sobol sequence, so that a corner is told about
// as much as if all of its rays were one triangle's.
// Taste: about the triangles at a corner; more parts are less even where these are few.
constexpr uint32_t kParts = 8;
// The rays that tell what lies in a ground from what lies below a roof of one sheet, and how much
// they rise. Below a roof most of them leave it at its sides.
// Taste: more tell it better; flatter ones leave wider roofs, and meet more of a hilly ground.
constexpr int kLowRays = 3;
constexpr double kLowHeight = 0.25;  // Taste: as kLowRays
// Where a ray begins, above its triangle, in parts of the triangle's longest edge and of the mesh.
// Law: rays have single precision (6e-8 of the mesh); this is a large margin.
constexpr double kAboveTriangle = 1e-4;
constexpr double kAboveMesh = 4e-6;  // Law: as kAboveTriangle
// And in parts of how far the thing is from where the coordinates of all that hides the sky begin.
// Law: eight times the rounding of single precision; a ray and what it meets are rounded once each.
constexpr double kAboveRounding = 4.8e-7;
// Every how many places of a leaf rays are cast once more.
// Taste: a smaller value tells better how uneven a mesh's leaves are lit, and less about corners. It is
// odd, for of the sequence every fourth point lies in the same quarter of a triangle.
constexpr uint32_t kAgain = 5;
// The rays of a triangle from which on it does so.
// Taste: fewer do not tell its sides apart either, by which places must be lit otherwise.
constexpr int kFewestAgain = 8;
// How far on both sides of a level its original is looked for, in parts of the level's error.
// Law: the level is nowhere farther from it, and twice is a margin.
constexpr double kReach = 2;
// How far a place on the original moves from an edge, in parts of the way to its triangle's middle.
// Taste: a larger value blurs what lies along edges.
constexpr double kInward = 0.01;
// The faces that are passed on the way to one that faces alike.
// Taste: more find what lies behind more sheets.
constexpr int kMostCovers = 4;

/// The map of normals: the transposed inverse, but for its length, where there is one. Under a
/// placement that flattens all it is that of the flat side.
glm::dmat3 normal_map_of(const glm::dmat3& linear) {
    const glm::dmat3 cofactors(glm::cross(linear[1], linear[2]), glm::cross(linear[2], linear[0]),
                               glm::cross(linear[0], linear[1]));
    return glm::determinant(linear) < 0 ? -cofactors : cofactors;
}

}  // namespace

double of_side_that_is_seen(double front, double back, double rays) {
    if (!(front + back > 0) || !(rays > 1))
        return 1;
    const double by_chance = (front * (1 - front) + back * (1 - back)) / (rays - 1);
    const double apart = std::max(0.0, (front - back) * (front - back) - by_chance);
    return 1 + apart / ((front + back) * (front + back));
}

SkySampler::SkySampler(const SkyRequest& request)
    : request_(request), normal_map_(normal_map_of(request.world.linear)) {
    Box3 box;
    for (const glm::vec3& position : request.surface.mesh->positions) {
        if (finite(position))
            box.add(glm::dvec3(position));
    }
    size_ = glm::length(box.size());
    to_own_.linear = glm::inverse(request.world.linear);
    flat_ = !to_own_.finite();
    above_ = kAboveMesh * size_;
    if (request.around != nullptr) {
        enlarged_ = stretch(request.world);
        above_ += request.original == nullptr ? request.error : 0;
        Bound bound;
        bound.box = box;
        const Box3 placed = transformed(bound, request.world).box;
        const glm::dvec3& origin = request.around->origin();
        const double away =
            glm::length(glm::max(glm::abs(placed.low - origin), glm::abs(placed.high - origin)));
        if (!placed.empty() && std::isfinite(away))
            above_world_ = kAboveRounding * away;
    }
}

std::optional<SkySampler::PlacedTriangle> SkySampler::placed(const Mesh& mesh,
                                                             size_t triangle) const {
    const Triangle& t = mesh.triangles[triangle];
    PlacedTriangle out;
    for (int i = 0; i < 3; ++i)
        out.at[static_cast<size_t>(i)] = glm::dvec3(mesh.positions[t[i]]);
    const glm::dvec3 face = area_vector(mesh, triangle);
    const glm::dvec3 up = normal_map_ * face;
    const double length = glm::length(face);
    const double up_length = glm::length(up);
    if (!(length > 0) || !std::isfinite(length) || !(up_length > 0) || !std::isfinite(up_length))
        return {};
    out.face = face / length;
    out.up = up / up_length;
    for (size_t i = 0; i < 3; ++i)
        out.longest = std::max(out.longest, glm::length(out.at[(i + 1) % 3] - out.at[i]));
    const glm::dmat3& m = request_.world.linear;
    out.area = glm::length(glm::cross(m * (out.at[1] - out.at[0]), m * (out.at[2] - out.at[0])));
    return out;
}

bool SkySampler::hidden(const SkyRay& ray, uint32_t& blocker) const {
    return request_.around != nullptr
               ? request_.around->hides(ray.from_world, ray.direction, blocker)
               : hidden_alone(ray);
}

bool SkySampler::hidden_alone(const SkyRay& ray) const {
    return !flat_ && self().scene->occluded(ray.from, to_own_.linear * ray.direction);
}

glm::dvec3 SkySampler::color(const SkyRay& ray, bool placed) const {
    if (request_.uneven == nullptr)
        return glm::dvec3(1.0);
    if (request_.horizon.upright) {
        const glm::dvec3 own = to_own_.linear * ray.direction;
        return request_.uneven->at_height(glm::dot(own, request_.horizon.up) / glm::length(own));
    }
    return placed ? request_.uneven->toward(ray.direction) : glm::dvec3(1.0);
}

glm::dvec3 SkySampler::expected(const SkyPlace& place, bool both, const glm::dvec3& open) const {
    // Law: where the placements of copies face is not known.
    if (request_.around == nullptr || request_.horizon.upright)
        return open;
    return request_.uneven->received(place.normal) +
           request_.uneven->received(both ? -place.normal : place.normal);
}

SkySampler::PlacedTriangle SkySampler::PlacedTriangle::back() const {
    PlacedTriangle out = *this;
    out.face = -face;
    out.up = -up;
    out.turned = !turned;
    return out;
}

TriangleShares SkySampler::shares(const Mesh& mesh, size_t triangle, int rays, bool behind) const {
    const std::optional<PlacedTriangle> placed = this->placed(mesh, triangle);
    if (!placed)
        return {};
    if (behind)
        return shares_of_front(mesh, triangle, placed->back(), rays);
    TriangleShares out = shares_of_front(mesh, triangle, *placed, rays);
    if (request_.original == nullptr || !out.inside)
        return out;
    const TriangleShares back = shares_of_front(mesh, triangle, placed->back(), rays);
    return back.inside ? out : back;
}

TriangleShares SkySampler::shares_of_front(const Mesh& mesh, size_t triangle,
                                           const PlacedTriangle& placed, int rays) const {
    TriangleShares out;
    const bool both = !request_.surface.opaque_slot(mesh.slot(triangle));
    const uint32_t first = static_cast<uint32_t>(triangle % kParts) * static_cast<uint32_t>(rays);
    uint32_t blocker = ray::PlacedScenes::kNothing;
    uint32_t near = ray::kNoTriangle;
    int looks = 0;
    bool any_inside = false;
    // Rays are cast in pairs: from one point to both sides of the normal, or from both sides of
    // the triangle. Where one of the first kind begins inside of something, so does the other.
    for (int i = 0; i < rays; i += 2) {
        const uint32_t number = first + static_cast<uint32_t>(i / 2);
        const SkyPlace place = this->place(mesh, triangle, placed, number, near);
        const double reach = place.longest * enlarged_;
        const SkyRay pair[] = {ray(place, false),
                               both ? ray(place, true) : ray(place, false, true)};
        double seen = 0;
        double back = 0;
        double passed = 0;
        UnevenLight uneven;
        bool inside = false;
        for (const SkyRay& one : pair) {
            const double part = this->passed(one, blocker);
            double own = part;
            if (request_.uneven != nullptr) {
                const glm::dvec3 color = this->color(one, request_.around != nullptr);
                own = part * request_.uneven->share_of(color);
                uneven.seen += part * color;
                uneven.open += light(one) * color;
            }
            passed += part;
            seen += own;
            back = both ? own : 0;  // of the second one
            const bool look = !inside && !both && part == 0 && one.open && light(one) > 0 &&
                              (any_inside || looks < kLooks);
            looks += look ? 1 : 0;
            inside = inside || (look && meets_near_back(one, reach) && lies_below_backs(place));
        }
        any_inside = any_inside || inside;
        if (request_.uneven != nullptr)
            uneven.expected = expected(place, both, uneven.open);
        out.passed += inside ? 0 : passed;
        if (both && rays >= kFewestAgain && number % kAgain == 0) {
            const SkyPlace other = again(place, uint64_t{triangle} << 32u | number);
            const double front_again = this->seen(ray(other, false), blocker);
            const double back_again = this->seen(ray(other, true), blocker);
            out.again += 2;
            out.again_seen += front_again + back_again;
            out.both_seen += (seen - back) * front_again + back * back_again;
            i += 2;  // as many rays in all
        }
        for (size_t corner = 0; corner < 3; ++corner) {
            const double weight = pair[0].weights[corner];
            (inside ? out.inside_rays : out.rays)[corner] += 2 * weight;
            if (!inside) {
                out.seen[corner] += seen * weight;
                out.back[corner] += back * weight;
                out.uneven[corner].add(uneven, weight);
            }
        }
    }
    const bool dark = !both && out.open_share() < kDark;
    out.inside = dark && lies_inside(mesh, triangle, placed);
    if (dark && !out.inside && !closed_ && !placed.turned && !request_.one_side)
        add_back(mesh, triangle, placed, rays, out);
    return out;
}

void SkySampler::face_of(const Mesh& mesh, size_t triangle, const PlacedTriangle& placed,
                         const glm::dmat3& normal_map, const std::array<double, 3>& weights,
                         SkyPlace& out) {
    out.at = glm::dvec3(0.0);
    glm::dvec3 smooth(0.0);
    const Triangle& t = mesh.triangles[triangle];
    for (size_t i = 0; i < 3; ++i) {
        out.at += weights[i] * placed.at[i];
        if (!mesh.normals.empty())
            smooth += weights[i] * glm::dvec3(mesh.normals[t[static_cast<int>(i)]]);
    }
    out.face = placed.face;
    out.up = placed.up;
    out.longest = placed.longest;
    const glm::dvec3 normal = normal_map * (placed.turned ? -smooth : smooth);
    const double length = glm::length(normal);
    out.normal = length > 0 && std::isfinite(length) && glm::dot(normal, placed.up) > 0
                     ? normal / length
                     : placed.up;
}

SkySampler::SkyPlace SkySampler::place(const Mesh& mesh, size_t triangle,
                                       const PlacedTriangle& placed, uint32_t number,
                                       uint32_t& near) const {
    SkyPlace out;
    out.point = points_.point(number);
    const glm::dvec2 weights = measure::uniform_in_triangle(out.point[0], out.point[1]);
    out.weights = {1 - weights.x - weights.y, weights.x, weights.y};
    face_of(mesh, triangle, placed, normal_map_, out.weights, out);
    if (request_.original == nullptr)
        return out;
    const uint16_t slot = mesh.slot(triangle);
    if (!shows_own_picture(slot) || !move_to_pictured(out))
        move_to_original(!request_.surface.opaque_slot(slot), out, near);
    return out;
}

bool SkySampler::shows_own_picture(uint16_t slot) const {
    const std::vector<Hash>& masks = request_.surface.masks;
    const std::vector<Hash>& known = request_.original->masks;
    return slot < masks.size() && masks[slot] != 0 &&
           std::find(known.begin(), known.end(), masks[slot]) == known.end();
}

bool SkySampler::move_to_pictured(SkyPlace& place) const {
    const SkySurface& original = *request_.original;
    // Law: from this far outside of it, whatever the place, all of the original is before.
    const double far = 2 * size_;
    const ray::RayHit hit =
        original.scene->first_hit(place.at + far * place.face, -place.face, 2 * far);
    const std::optional<PlacedTriangle> there =
        hit.hit ? placed(*original.mesh, hit.triangle) : std::nullopt;
    if (!there)
        return false;
    const bool flipped = glm::dot(there->face, place.face) < 0;
    face_of(*original.mesh, hit.triangle, flipped ? there->back() : *there, normal_map_,
            {1 - hit.u - hit.v, hit.u, hit.v}, place);
    return true;
}

void SkySampler::move_to_original(bool both, SkyPlace& place, uint32_t& near) const {
    if (!both && move_to_outermost(place))
        return;
    const SkySurface& original = *request_.original;
    // Beside the original: a face that points the same way comes first, for the front of a thin
    // board is not its back.
    ray::ClosestPoint found;
    if (!both)
        found = original.scene->closest_facing(place.at, place.face, kReach * request_.error, near);
    if (found.triangle == ray::kNoTriangle)
        found = original.scene->closest_facing(place.at, glm::dvec3(0.0), kInfinity, near);
    if (found.triangle == ray::kNoTriangle)
        return;
    near = found.triangle;
    const std::optional<PlacedTriangle> there = placed(*original.mesh, found.triangle);
    if (!there)
        return;
    // Many nearest places lie on edges, where a ray may begin in the next face.
    const double inward = kInward / 3;
    const double u = (1 - kInward) * found.u + inward;
    const double v = (1 - kInward) * found.v + inward;
    const bool flipped = glm::dot(there->face, place.face) < 0;
    face_of(*original.mesh, found.triangle, *there, normal_map_, {1 - u - v, u, v}, place);
    if (flipped) {
        place.face = -place.face;
        place.up = -place.up;
        place.normal = -place.normal;
    }
}

bool SkySampler::move_to_outermost(SkyPlace& place) const {
    const SkySurface& original = *request_.original;
    const glm::dvec3 inward = -place.face;
    double left = 2 * kReach * request_.error;
    if (!std::isfinite(left))
        return false;
    glm::dvec3 from = place.at - 0.5 * left * inward;
    for (int i = 0; i < kMostCovers && left > 0; ++i) {
        const ray::RayHit hit = original.scene->first_hit(from, inward, left);
        if (!hit.hit)
            return false;
        const std::optional<PlacedTriangle> there = placed(*original.mesh, hit.triangle);
        if (there && original.opaque_slot(original.mesh->slot(hit.triangle)) &&
            glm::dot(there->face, place.face) > 0) {
            face_of(*original.mesh, hit.triangle, *there, normal_map_,
                    {1 - hit.u - hit.v, hit.u, hit.v}, place);
            return true;
        }
        const double step = hit.t + above_ + (there ? kAboveTriangle * there->longest : 0);
        from += step * inward;
        left -= step;
    }
    return false;
}

SkySampler::SkyRay SkySampler::ray(const SkyPlace& place, bool back, bool opposite) const {
    const double side = back ? -1 : 1;
    SkyRay out;
    out.weights = place.weights;
    out.direction = measure::cosine_direction(side * place.normal, place.point[3],
                                              opposite ? place.point[2] + 0.5 : place.point[2]);
    out.from = place.at + side * (above_ + kAboveTriangle * place.longest) * place.face;
    out.from_world = request_.world(out.from) + side * above_world_ * place.up;
    out.open = side * glm::dot(out.direction, place.up) > 0;
    return out;
}

SkySampler::SkyPlace SkySampler::again(const SkyPlace& place, uint64_t seed) {
    SkyPlace out = place;
    const uint64_t bits = measure::scramble(seed);
    out.point[2] = static_cast<double>(bits >> 32u) * 0x1p-32;
    out.point[3] = static_cast<double>(bits & 0xffffffffu) * 0x1p-32;
    return out;
}

bool SkySampler::lies_inside(const Mesh& mesh, size_t triangle,
                             const PlacedTriangle& placed) const {
    int backs = 0;
    int others = 0;
    uint32_t near = ray::kNoTriangle;
    while (backs < kInsideRays && others < kOutsideRays) {
        const auto number = static_cast<uint32_t>(backs + others);
        const SkyPlace from = place(mesh, triangle, placed, number, near);
        const bool back =
            meets_near_back(ray(from, false), size_ * enlarged_) && lies_below_backs(from);
        ++(back ? backs : others);
    }
    return backs == kInsideRays;
}

void SkySampler::add_back(const Mesh& mesh, size_t triangle, const PlacedTriangle& placed, int rays,
                          TriangleShares& out) const {
    std::array<double, 3> seen{};
    std::array<double, 3> weights{};
    std::array<UnevenLight, 3> uneven{};
    uint32_t blocker = ray::PlacedScenes::kNothing;
    uint32_t near = ray::kNoTriangle;
    for (int i = 0; i < rays; ++i) {
        const SkyRay ray =
            this->ray(place(mesh, triangle, placed, static_cast<uint32_t>(i), near), true);
        const bool above = request_.around != nullptr ? ray.direction.z > 0 : !down(ray);
        const bool free = ray.open && above && !hidden(ray, blocker);
        const double sky = free ? brightness(ray, request_.around != nullptr) : 0;
        for (size_t corner = 0; corner < 3; ++corner) {
            weights[corner] += ray.weights[corner];
            seen[corner] += ray.weights[corner] * sky;
            if (free)
                uneven[corner].seen += ray.weights[corner] * color(ray, request_.around != nullptr);
        }
    }
    for (size_t corner = 0; corner < 3; ++corner) {
        const double back = weights[corner] > 0 ? seen[corner] / weights[corner] : 0;
        out.seen[corner] = (out.seen[corner] + back * out.rays[corner]) / 2;
        if (weights[corner] > 0)
            out.uneven[corner].add(uneven[corner], out.rays[corner] / weights[corner]);
    }
}

bool SkySampler::seen_by_eye(const SkyPlace& place) const {
    if (!request_.eye || request_.around == nullptr)
        return false;
    const glm::dvec3 from = ray(place, false).from_world;
    const glm::dvec3 way = *request_.eye - from;
    const double distance = glm::length(way);
    return glm::dot(way, place.up) > 0 && std::isfinite(distance) &&
           request_.around->first_block(from, way / distance, distance).t >= distance;
}

bool SkySampler::lies_below_backs(const SkyPlace& place) const {
    if (seen_by_eye(place))
        return false;
    const bool alone = request_.around == nullptr;
    if (alone && !request_.horizon.upright)
        return true;
    const glm::dvec3 up = alone ? request_.horizon.up : glm::dvec3(0, 0, 1);
    const glm::dvec3 side = perpendicular(up);
    const glm::dvec3 other = glm::cross(up, side);
    SkyRay low = ray(place, false);
    int backs = 0;
    int others = 0;
    for (int i = 0; 2 * std::max(backs, others) <= kLowRays; ++i) {
        const double turn = 2 * kPi * (place.point[2] + i / double{kLowRays});
        const glm::dvec3 flat = std::cos(turn) * side + std::sin(turn) * other;
        low.direction = kLowHeight * up + flat;
        if (glm::dot(low.direction, place.up) < 0)
            low.direction = kLowHeight * up - flat;
        low.direction = glm::normalize(low.direction);
        const bool back = glm::dot(low.direction, place.up) < 0 || meets_near_back(low, kInfinity);
        ++(back ? backs : others);
    }
    return backs > others;
}

bool SkySampler::meets_near_back(const SkyRay& ray, double reach) const {
    const SkyScene::SkyBlock block =
        request_.around != nullptr
            ? request_.around->first_block(ray.from_world, ray.direction, reach)
            : first_block(self(), ray.from, to_own_.linear * ray.direction, reach);
    return block.back && block.t <= reach;
}

}  // namespace lodestone::light
