// SPDX-License-Identifier: GPL-3.0-or-later
#include "hierarchy/evaluators/solid_settling.h"

#include "solids/keep_on_floor.h"
#include "solids/match_solids.h"
#include "solids/solid_replacement.h"
#include "solids/stand_in_material.h"

#include <algorithm>
#include <cmath>

namespace lodestone::hierarchy {
namespace {

/// The change of a centroid that ends its rays, in parts of the radius of gyration, for a solid of
/// that error: nobody sees a small part of the pixel that its error is when it is used.
double settled_at(double error, double least, const Attributes& of) {
    // The part of the error.
    // Taste: a larger part lets solids stand beside their place, by so much of a pixel.
    constexpr double kOfError = 0.03;
    const glm::dmat3& moments = of.moments;
    const double square = (moments[0][0] + moments[1][1] + moments[2][2]) / of.visible_area;
    return square > 0 ? std::max(least, kOfError * error / std::sqrt(square)) : least;
}

/// Whether the centroid is known as well by the rays that the finest was measured by.
bool is_known(double settled, const Attributes& of) {
    // The doubt about a centroid, in parts of the radius of gyration, times the root of the rays.
    // Fitted: as kRaysOfSolid: 4,096 rays know it to 0.32 %.
    constexpr double kDoubt = 0.0032 * 64;
    return settled * std::sqrt(static_cast<double>(of.rays)) >= kDoubt;
}

/// The finest's attributes by many more rays. What has been measured better serves those who ask
/// for less.
class SureAttributes {
public:
    explicit SureAttributes(const MeasuredFinest& finest) : finest_(finest) {}

    /// By so many rays or more, or until half of them agree with all (`settled`).
    const Attributes& by(uint64_t rays, double settled, const Job& job) {
        if (rays_ < rays || settled_ > settled) {
            measure::VisibleOptions options = finest_.visible_options(rays);
            options.settled = settled;
            attributes_ = measure::measure_visible(finest_.mesh, finest_.sampler(), finest_.skin,
                                                   options, {}, finest_.cast, job)
                              .attributes;
            rays_ = rays;
            settled_ = settled;
        }
        return attributes_;
    }

private:
    const MeasuredFinest& finest_;
    Attributes attributes_;
    uint64_t rays_ = 0;
    double settled_ = 0;
};

void settle_composite(StandInCandidate& candidate, const MeasuredFinest& finest,
                      SureAttributes& sure, double floor, const Job& job) {
    // Solids that hide each other: 32,768 rays know their centroid to 0.1 % of the radius of
    // gyration, 262,144 to 0.04 %.
    // Taste: a larger number knows it better, in time and memory in proportion.
    constexpr uint32_t kRaysOfMany = 262144;
    // Taste: any seed will do.
    constexpr uint64_t kSeedOfMany = 1;
    // The same rays for all (7 MB): making them takes as long as asking them once.
    static const solids::VisibleSolids kVisible(kRaysOfMany, kSeedOfMany);
    Composite composite = candidate.composite();
    const double settled =
        settled_at(candidate.error, solids::kSettledComposite, finest.attributes);
    solids::settle_composite(composite, sure.by(kRaysOfMany, settled, job), floor, kVisible, job);
    candidate.payload = std::make_shared<const Composite>(std::move(composite));
}

void settle_primitive(StandInCandidate& candidate, const MeasuredFinest& finest,
                      SureAttributes& sure, double floor, const Job& job) {
    // The height over the floor, relative to the size, at which a primitive still stands.
    // Law: rounding of doubles, with a large margin.
    constexpr double kStands = 1e-9;
    const bool box = candidate.kind == Kind::Box;
    const bool clear = candidate.materials[0].alpha_mode == AlphaMode::Blend;
    Primitive& primitive = std::get<Primitive>(candidate.payload);
    const bool stands = solids::reach_of(primitive, box).low <= floor + kStands * finest.size;
    if (clear) {
        Material& material = candidate.materials[0];
        const double through = 1 - material.alpha;
        const auto now =
            solids::settled(solids::ClearSolid{primitive, 1 - through * through}, finest.attributes,
                            sure.by(solids::kRaysOfClear * finest.rays, 0, job));
        primitive = now.primitive;
        material.alpha = solids::surface_alpha(now.opacity);
    } else {
        const double settled = settled_at(candidate.error, solids::kSettled, finest.attributes);
        if (is_known(settled, finest.attributes))
            return;
        primitive = solids::settled(primitive, finest.attributes,
                                    sure.by(solids::kRaysOfSolid * finest.rays, settled, job));
    }
    const double low = solids::reach_of(primitive, box).low;
    if (stands || low < floor)
        primitive.center.z += floor - low;
}

}  // namespace

void settle_solids(std::span<StandInCandidate> candidates, const MeasuredFinest& finest,
                   double floor, const Job& job) {
    SureAttributes sure(finest);
    for (StandInCandidate& candidate : candidates) {
        const bool composite = candidate.kind == Kind::Composite;
        if (!candidate.by_few_rays || (finest.options.group && !composite))
            continue;
        candidate.by_few_rays = false;
        // Where all of it is two pixels wide or less nobody sees a few thousandths of that.
        if (candidate.error >= finest.size)
            continue;
        if (composite)
            settle_composite(candidate, finest, sure, floor, job);
        else if (finest.attributes.relative_error > 0)
            settle_primitive(candidate, finest, sure, floor, job);
    }
}

}  // namespace lodestone::hierarchy
