// SPDX-License-Identifier: GPL-3.0-or-later
#include "light/sky/corner_shares.h"

#include "measure/visible/sobol_points.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>

namespace lodestone::light {
namespace {

// The steps of a unit normal's coordinates within which flat triangles face the same way.
// Taste: a larger value smooths less over folds.
constexpr double kNormalSteps = 32;
// How often corners hand on what their rays met.
// Taste: each time blurs what is near by 8 degrees more, on balls of 1,280 triangles, for less noise.
constexpr int kHandedOn = 2;
// The rays that see the sky where another one did and speak for leaves that are lit evenly, so that
// a few do not tell otherwise by chance.
// Taste: a larger value changes small meshes less.
constexpr double kEvenRays = 32;

double sum(const std::array<double, 3>& values) {
    return values[0] + values[1] + values[2];
}

}  // namespace

size_t CornerShares::CornerKeyHash::operator()(const CornerKey& key) const {
    uint64_t out = key.vertex * uint64_t{4} + (key.opaque ? 1 : 0) + (key.behind ? 2 : 0);
    for (const int part : key.normal)
        out = measure::scramble(out + static_cast<uint64_t>(part + 64));
    return static_cast<size_t>(out);
}

double CornerShares::GroupShares::share(const UnevenSky* sky) const {
    if (!(rays > 0))
        return all_rays > 0 ? all_seen / all_rays : 0;
    // Few rays may have met more or less of an uneven sky than all would.
    double chance = 1;
    if (sky != nullptr && sky->share_of(uneven.open) > 0)
        chance = sky->share_of(uneven.expected) / sky->share_of(uneven.open);
    const double side = rays / 2;
    return chance *
           (opaque ? 1 : of_side_that_is_seen((seen - back) / side, back / side, count / 2)) *
           seen / rays;
}

CornerShares::CornerShares(const Mesh& mesh, std::span<const uint32_t> welded,
                           const SkySurface& surface, const UnevenSky* sky)
    : mesh_(mesh),
      welded_(welded),
      surface_(surface),
      sky_(sky),
      group_of_(3 * mesh.triangles.size()),
      areas_(mesh.triangles.size(), 0) {
    known_.reserve(mesh.triangles.size());
}

CornerShares::CornerKey CornerShares::key_of(size_t triangle, int corner, bool behind) const {
    const uint32_t vertex = mesh_.triangles[triangle][corner];
    glm::dvec3 normal =
        mesh_.normals.empty() ? area_vector(mesh_, triangle) : glm::dvec3(mesh_.normals[vertex]);
    const double length = glm::length(normal);
    CornerKey key{welded_[vertex], {}, opaque(triangle), behind};
    if (length > 0 && std::isfinite(length)) {
        for (int i = 0; i < 3; ++i)
            key.normal[static_cast<size_t>(i)] =
                static_cast<int>(std::lround(kNormalSteps * normal[i] / length));
    }
    return key;
}

void CornerShares::add(size_t triangle, const TriangleShares& shares, double area, bool behind) {
    areas_[triangle] = area;
    const double rays = sum(shares.rays) + sum(shares.inside_rays);
    for (int corner = 0; corner < 3; ++corner) {
        const size_t at = static_cast<size_t>(corner);
        const auto [found, fresh] = known_.try_emplace(key_of(triangle, corner, behind),
                                                       static_cast<uint32_t>(groups_.size()));
        if (fresh)
            groups_.emplace_back();
        group_of_[3 * triangle + at] = found->second;
        if (!(rays > 0))
            continue;
        GroupShares& group = groups_[found->second];
        group.opaque = opaque(triangle);
        const double weight = area / rays;
        group.all_seen += weight * shares.seen[at];
        group.all_rays += weight * (shares.rays[at] + shares.inside_rays[at]);
        if (!shares.inside) {
            group.seen += weight * shares.seen[at];
            group.rays += weight * shares.rays[at];
            group.back += weight * shares.back[at];
            group.count += shares.rays[at];
            group.uneven.add(shares.uneven[at], weight);
        }
    }
}

void CornerShares::GroupShares::add(const GroupShares& other) {
    seen += other.seen;
    rays += other.rays;
    back += other.back;
    count += other.count;
    all_seen += other.all_seen;
    all_rays += other.all_rays;
    uneven.add(other.uneven, 1);
}

void CornerShares::share_rays() {
    for (int i = 0; i < kHandedOn; ++i) {
        const std::vector<GroupShares> own = groups_;
        for (size_t corner = 0; corner < group_of_.size(); ++corner) {
            GroupShares& group = groups_[group_of_[corner]];
            const size_t first = corner - corner % 3;
            group.add(own[group_of_[first + (corner + 1) % 3]]);
            group.add(own[group_of_[first + (corner + 2) % 3]]);
        }
    }
}

double CornerShares::mean_of_corners(size_t triangle) const {
    double out = 0;
    for (size_t corner = 0; corner < 3; ++corner)
        out += groups_[group_of_[3 * triangle + corner]].share(sky_) / 3;
    return out;
}

double CornerShares::of_places_that_are_seen(std::span<const TriangleShares> shares) const {
    double rays = 0;
    double area = 0;
    double both = 0;  // what second rays saw of what the first saw
    double even = 0;  // and would have, if all places near a corner saw as much
    for (size_t i = 0; i < shares.size(); ++i) {
        if (!(shares[i].again > 0) || opaque(i))
            continue;
        const double weight = areas_[i] / shares[i].again;
        rays += shares[i].again;
        area += areas_[i];
        both += weight * shares[i].both_seen;
        even += weight * shares[i].again_seen * mean_of_corners(i);
    }
    if (!(area > 0))
        return 1;
    const double level = kEvenRays / rays * area;
    return std::max(1.0, (both + level) / (even + level));
}

void CornerShares::finish(std::span<const TriangleShares> shares, SkyShares& out) const {
    const double lighter = of_places_that_are_seen(shares);
    double seen = 0;
    double area = 0;
    double all_seen = 0;  // those inside of something too
    double all_area = 0;
    for (size_t i = 0; i < shares.size(); ++i) {
        const double rays = sum(shares[i].rays);
        const double inside_rays = sum(shares[i].inside_rays);
        if (rays + inside_rays > 0) {
            all_seen += areas_[i] * shares[i].share() * rays / (rays + inside_rays);
            all_area += areas_[i];
        }
        if (rays > 0 && !shares[i].inside) {
            seen += areas_[i] *
                    (opaque(i) ? shares[i].share() : std::min(1.0, lighter * mean_of_corners(i)));
            area += areas_[i];
        }
    }
    out.mean = area > 0 ? seen / area : (all_area > 0 ? all_seen / all_area : 1);
    out.mean = std::min(1.0, out.mean);  // rays may meet more of an uneven sky than there is
    out.corners.reserve(group_of_.size());
    for (const uint32_t index : group_of_) {
        const GroupShares& group = groups_[index];
        const double share = group.rays > 0 || group.all_rays > 0 ? group.share(sky_) : out.mean;
        out.corners.push_back(share_byte(group.opaque ? share : std::min(1.0, lighter * share)));
        if (sky_ != nullptr && !sky_->one_hue()) {
            const glm::dvec3 color = group.uneven.likely();
            const double bright = sky_->share_of(color);
            out.tints.push_back(tint_byte(color.x, bright));
            out.tints.push_back(tint_byte(color.z, bright));
        }
    }
}

}  // namespace lodestone::light
