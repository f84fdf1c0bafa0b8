// SPDX-License-Identifier: GPL-3.0-or-later
#include "hierarchy/evaluators/brightness_match.h"

#include "hierarchy/evaluators/traced_candidate.h"
#include "hierarchy/lamp_materials.h"
#include "solids/stand_in_material.h"

#include <glm/common.hpp>

#include <algorithm>
#include <cmath>

namespace lodestone::hierarchy {
namespace {

// An error over the radius. A level that is used up to this error is seen where the whole is 24
// pixels large or more, and is matched to look alike.
// Taste: a larger value matches fewer levels.
constexpr double kUsedNear = 1.0 / 12;
// An error over the radius. A solid that is used from this error on is seen where the whole is 16
// pixels large or less: few samples tell how bright it is, but not how bright single leaves are.
// Law: an eighth of the radius is a sixteenth of the size.
constexpr double kUsedFar = 1.0 / 8;

// The samples of all pictures for each triangle, from which on few a side tell how bright every part
// is, as if they were single leaves.
// Taste: a larger value takes more samples of simple meshes.
constexpr size_t kSamplesOfTriangle = 16;

/// Whether few samples tell how bright a candidate is, which is off by that much on its own.
bool few_tell(const StandInCandidate& candidate, double own, const MeasuredFinest& finest) {
    using Pictures = measure::AgreementReference;
    constexpr size_t kSamples = Pictures::kViews * Pictures::kFewSide * Pictures::kFewSide;
    return own >= kUsedFar * finest.size &&
           (candidate.kind != Kind::Mesh ||
            kSamplesOfTriangle * finest.mesh.triangles.size() <= kSamples);
}

/// Makes what glows of a candidate glow as much as the finest does.
void match_glow(StandInCandidate& candidate,
                const measure::AgreementReference::TracedPictures& traced,
                const MeasuredFinest& finest, FinestPictures& pictures, const Job& job) {
    // The most by which glow changes.
    // Taste: a larger value mends by light what is wrong by its shape.
    constexpr double kMost = 4;
    const glm::dvec3& glow = pictures.glow(job);
    const glm::dvec3 now =
        light_over_emitted(pictures.taken(), traced, candidate.materials, finest);
    glm::dvec3 more(1.0);
    for (int i = 0; i < 3; ++i) {
        const double ratio = now[i] / glow[i];
        if (now[i] != 1 && glow[i] != 1 && std::isfinite(ratio))  // 1: none of that color
            more[i] = std::clamp(ratio, 1 / kMost, kMost);
    }
    for (Material& material : candidate.materials)
        emit_more(material, more);
}

}  // namespace

bool is_matched(const MeasuredFinest& finest, double used_to) {
    return !finest.options.environment && (used_to >= kUsedNear * finest.size || finest.glows);
}

void match_brightness(StandInCandidate& candidate, const MeasuredFinest& finest,
                      FinestPictures& pictures, double used_to, const Job& job) {
    // The relative difference of light that counts as none.
    // Taste: nobody sees this much; a larger value leaves visible differences.
    constexpr double kAlikeBright = 0.01;
    // The most by which a round changes a color.
    // Taste: a larger value may overshoot where light is scattered many times.
    constexpr double kMost = 2;
    // Materials that glow or are clear have no part in the correction: further rounds come nearer.
    // Taste: more come nearer still, for a shading of the pictures each.
    constexpr int kRounds = 3;
    if (candidate.state != CandidateState::Measured || !is_matched(finest, used_to))
        return;
    using Pictures = measure::AgreementReference;
    const double child_error = finest.options.child_error;
    const double own = candidate.error - child_error;
    const Pictures& reference = finest.glows ? pictures.take(finest.mesh, Pictures::kSide, job)
                                : few_tell(candidate, own, finest)
                                    ? pictures.take_few(job)
                                    : pictures.take(finest.mesh, Pictures::kBrightSide, job);
    ray::SkinPtr current = finest.skin_of(candidate.materials);
    Mesh solid;
    const auto traced = reference.trace(traced_mesh(candidate, solid), current, job);
    if (finest.glows) {
        match_glow(candidate, traced, finest, pictures, job);
        current = finest.skin_of(candidate.materials);
    }
    for (int round = 0; round < kRounds; ++round) {
        const glm::dvec3 light = reference.brightness_of(traced, current).light;
        const glm::dvec3 off = glm::abs(light - 1.0);
        if (!(std::max({off.x, off.y, off.z}) > kAlikeBright))
            break;
        for (Material& material : candidate.materials) {
            // The color of glass is that of what is seen through it.
            if (!(material.transmission * (1 - material.metallic) > 0.5))
                solids::brighten(material,
                                 glm::clamp(light, glm::dvec3(1 / kMost), glm::dvec3(kMost)));
        }
        current = finest.skin_of(candidate.materials);
    }
    come_to(candidate, CandidateState::Matched);
    if (candidate.kind != Kind::Mesh || finest.layered)
        return;
    // Near something else that is left a point may have been all that closed a gap. Where the error
    // is as large as the pictures' pixels all that they show counts, half.
    const double seen = own < kUsedNear * finest.size
                            ? reference.gap_error(traced, current, own)
                            : kPictures * reference.of(traced, current).error;
    candidate.error = std::max(candidate.error, seen + child_error);
    candidate.max_error = std::max(candidate.max_error, seen + child_error);
}

}  // namespace lodestone::hierarchy
