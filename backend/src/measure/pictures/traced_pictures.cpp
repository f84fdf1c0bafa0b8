// SPDX-License-Identifier: GPL-3.0-or-later
// AgreementReference::trace(): what the samples of pictures show of a mesh, and the light there.
#include "base/parallel.h"
#include "measure/pictures/cube_views.h"
#include "measure/pictures/glass_rays.h"
#include "measure/pictures/picture_agreement.h"
#include "measure/visible/visible_sampler.h"
#include "ray/parallel_rays.h"

#include <glm/common.hpp>

#include <cmath>
#include <limits>
#include <optional>
#include <utility>

namespace lodestone::measure {
namespace {

/// A view of a picture.
struct PictureView {
    glm::dmat3 frame{1.0};  // columns: right, up, towards the viewer
    glm::dvec3 sun{0.0};

    PictureView(const glm::dvec3& towards, size_t number, PictureViews views) {
        frame = picture_frame(towards);
        // The suns stand around the views by the golden angle: each view has its own. Those of what
        // stands fill the half sphere above: against the light a crown has that of leaves that face
        // aside.
        const double turn = kGoldenAngle * static_cast<double>(number);
        sun = views == PictureViews::AllAround
                  ? glm::normalize(towards + std::cos(turn) * frame[0] + std::sin(turn) * frame[1])
                  : sky_direction(number);
    }
};

/// Along one of each opposite pair of 26 directions: in turns, or the upper ones.
std::vector<PictureView> views_of(PictureViews views) {
    std::vector<glm::dvec3> directions = cube_directions();
    directions.resize(directions.size() / 2);
    std::vector<PictureView> out;
    for (size_t i = 0; i < directions.size(); ++i) {
        const bool opposite = views == PictureViews::AllAround ? i % 2 == 1 : directions[i].z < 0;
        out.emplace_back(opposite ? -directions[i] : directions[i], i, views);
    }
    return out;
}

/// The rectangle around all that a mesh has in a view, in half sides of the picture from its
/// middle.
struct ViewExtent {
    glm::dvec2 low{std::numeric_limits<double>::infinity()};
    glm::dvec2 high{-std::numeric_limits<double>::infinity()};

    ViewExtent(const Mesh& mesh, const PictureView& view, const glm::dvec3& center, double radius) {
        // The doubt about where rays hit, over the radius.
        // Taste: well above single precision's 6e-8; a larger value casts a few rays more.
        constexpr double kRounding = 1e-5;
        for (const glm::vec3& position : mesh.positions) {
            const glm::dvec3 arm = glm::dvec3(position) - center;
            const glm::dvec2 at(glm::dot(arm, view.frame[0]), glm::dot(arm, view.frame[1]));
            if (!std::isfinite(at.x + at.y))
                continue;
            low = glm::min(low, at / radius - kRounding);
            high = glm::max(high, at / radius + kRounding);
        }
    }
    bool has(double x, double y) const {
        return x >= low.x && x <= high.x && y >= low.y && y <= high.y;
    }
};

/// A point that a sample shows: where its shadow ray starts, and the cosine of the sun's angle.
struct ShownPoint {
    glm::dvec3 from{0.0};
    double facing = 0;

    ShownPoint(const Mesh& mesh, const ray::RayHit& hit, const glm::dvec3& viewer,
               const glm::dvec3& sun, double lift) {
        glm::dvec3 flat = area_vector(mesh, hit.triangle);
        const double area = glm::length(flat);
        flat = area > 0 ? flat / area : viewer;
        if (glm::dot(flat, viewer) < 0)
            flat = -flat;
        from = hit.point + lift * flat;
        facing = glm::dot(mesh.normals.empty() ? flat : normal_at(mesh, hit, viewer), sun);
    }
    double light(bool shaded) const {
        return kSkyShare + (facing > 0 && !shaded ? (1 - kSkyShare) * facing : 0);
    }
};

/// Whether every point of a mesh ends all rays.
bool is_opaque(const Mesh& mesh, const ray::SkinPtr& skin) {
    return !skin || !(skin->see_through(mesh) || skin->transmits());
}

}  // namespace

AgreementReference::TracedPictures AgreementReference::trace(const Mesh& mesh,
                                                             const ray::SkinPtr& skin,
                                                             const Job& job) const {
    return trace(mesh, nullptr, skin, job);
}

AgreementReference::TracedPictures AgreementReference::trace(const Mesh& mesh,
                                                             const ray::MeshScene* scene,
                                                             const ray::SkinPtr& skin,
                                                             const Job& job) const {
    // The samples of a picture for each triangle, from which on drawing triangles is faster than
    // searching a tree.
    // Fitted: to terrains and crowds of boxes of 32 to 6,000 triangles at all five sides, where both
    // ways take the same time at 2 to 10; the script was not kept.
    constexpr size_t kRaysOfTriangle = 2;
    check(mesh);
    TracedPictures out(mesh);
    const auto samples = static_cast<size_t>(side_) * static_cast<size_t>(side_);
    out.samples_.resize(kViews * samples);
    if (mesh.empty() || !(radius_ > 0))
        return out;
    if (kRaysOfTriangle * mesh.triangles.size() <= samples && is_opaque(mesh, skin))
        draw(mesh, out, job);
    else if (scene != nullptr)
        search(mesh, *scene, skin, out, job);
    else
        search(mesh, ray::MeshScene(mesh, skin), skin, out, job);
    for (const TracedPictures::TracedSample& sample : out.samples_) {
        if (sample.triangle == ray::kNoTriangle)
            continue;
        const uint16_t slot = mesh.slot(sample.triangle);
        if (out.by_slot_.size() <= slot)
            out.by_slot_.resize(slot + size_t{1});
        out.by_slot_[slot].light += sample.light;
        ++out.by_slot_[slot].count;
    }
    return out;
}

const std::vector<ray::ParallelRays>& AgreementReference::rays() const {
    std::call_once(aimed_, [&] {
        const std::vector<PictureView> views = views_of(views_);
        const size_t samples = places_.size() / kViews;
        std::vector<glm::dvec3> origins(samples);
        std::vector<ray::ParallelRays> out;
        for (size_t view = 0; view < kViews; ++view) {
            for (size_t i = 0; i < samples; ++i) {
                const glm::dvec2& place = places_[view * samples + i];
                origins[i] = glm::dot(place, place) > 1 ? glm::dvec3(kInfinity)
                                                        : origin_of(views[view].frame, place);
            }
            out.emplace_back(-views[view].frame[2], origins);
        }
        rays_ = std::move(out);
    });
    return rays_;
}

void AgreementReference::draw(const Mesh& mesh, TracedPictures& out, const Job& job) const {
    const double lift = ray_lift(radius_);
    const std::vector<PictureView> views = views_of(views_);
    const std::vector<ray::ParallelRays>& all_rays = rays();
    parallel_for(kViews, [&](size_t number) {
        job.check();
        const PictureView& view = views[number];
        const glm::dvec3& viewer = view.frame[2];
        const std::vector<ray::RayHit> hits = all_rays[number].first_hits(mesh);
        TracedPictures::TracedSample* const samples = &out.samples_[number * hits.size()];
        std::vector<glm::dvec3> origins;  // of rays to the sun
        std::vector<uint32_t> lit;        // samples
        for (uint32_t i = 0; i < hits.size(); ++i) {
            const ray::RayHit& hit = hits[i];
            if (!hit.hit)
                continue;
            const ShownPoint point(mesh, hit, viewer, view.sun, lift);
            samples[i] = {hit.triangle, static_cast<float>(hit.u), static_cast<float>(hit.v),
                          static_cast<float>(point.light(false))};
            if (point.facing > 0) {
                origins.push_back(point.from);
                lit.push_back(i);
            }
        }
        const std::vector<uint8_t> shaded = ray::ParallelRays(view.sun, origins).blocked(mesh);
        for (size_t i = 0; i < lit.size(); ++i) {
            if (shaded[i] != 0)
                samples[lit[i]].light = static_cast<float>(kSkyShare);
        }
    });
}

void AgreementReference::search(const Mesh& mesh, const ray::MeshScene& scene,
                                const ray::SkinPtr& skin, TracedPictures& out,
                                const Job& job) const {
    const auto row = static_cast<size_t>(side_);
    const std::vector<PictureView> views = views_of(views_);
    const double lift = ray_lift(radius_);
    const GlassRays glass(mesh, skin, scene, lift);
    // On most things nine of ten rays would miss: things are long and narrow, and their bound is
    // round.
    std::vector<std::optional<ViewExtent>> frames(kViews);
    parallel_for(kViews, [&](size_t number) {
        frames[number].emplace(mesh, views[number], center_, radius_);
    });
    parallel_for(kViews * row, [&](size_t line) {
        job.check();
        const ray::FlushDenormals burst;
        ray::RecentBlockers blockers;
        const PictureView& view = views[line / row];
        const ViewExtent& frame = *frames[line / row];
        for (size_t column = 0; column < row; ++column) {
            const size_t number = line * row + column;
            const glm::dvec2& place = places_[number];
            if (glm::dot(place, place) > 1 || !frame.has(place.x, place.y))
                continue;
            glm::dvec3 along = -view.frame[2];
            const ray::RayHit hit = glass.first_hit(origin_of(view.frame, place), along);
            if (!hit.hit)
                continue;
            const ShownPoint point(mesh, hit, -along, view.sun, lift);
            const bool shaded =
                point.facing > 0 && glass.opaque().occluded(point.from, view.sun, blockers);
            out.samples_[number] = {hit.triangle, static_cast<float>(hit.u),
                                    static_cast<float>(hit.v),
                                    static_cast<float>(point.light(shaded))};
        }
    });
}

glm::dvec3 AgreementReference::origin_of(const glm::dmat3& frame, const glm::dvec2& place) const {
    return center_ + radius_ * (frame * glm::dvec3(place, 2));
}

}  // namespace lodestone::measure
