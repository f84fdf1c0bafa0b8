// SPDX-License-Identifier: GPL-3.0-or-later
#include "hierarchy/evaluators/picture_error.h"

#include "base/error.h"
#include "hierarchy/evaluators/traced_candidate.h"
#include "hierarchy/lamp_materials.h"
#include "solids/stand_in_material.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace lodestone::hierarchy {
namespace {

void compare_to(const measure::AgreementReference& reference, StandInCandidate& candidate,
                std::span<const uint16_t> tinted, const MeasuredFinest& finest, const Job& job) {
    // The relative difference of light that counts as none.
    // Taste: nobody sees this much; a larger value leaves visible differences.
    constexpr double kAlikeBright = 0.02;
    // Some of a mesh's light comes from other slots, so that one round is not enough.
    // Taste: more rounds come nearer, for a shading of the pictures each.
    constexpr int kRounds = 2;
    std::vector<uint16_t> all(candidate.materials.size());
    std::iota(all.begin(), all.end(), uint16_t{0});
    ray::SkinPtr current = finest.skin_of(candidate.materials);
    Mesh solid;
    const auto traced = reference.trace(traced_mesh(candidate, solid), current, job);
    const auto match = [&](std::span<const uint16_t> slots, int rounds) {
        for (int round = 0; round < rounds && !slots.empty(); ++round) {
            const glm::dvec3 light = reference.brightness_of(traced, current).light;
            const glm::dvec3 off = glm::abs(light - 1.0);
            if (std::max({off.x, off.y, off.z}) <= kAlikeBright)
                break;
            // Light that is scattered once is in proportion to the color.
            for (const uint16_t slot : slots) {
                if (slot < all.size())
                    solids::brighten(candidate.materials[slot], light);
            }
            current = finest.skin_of(candidate.materials);
        }
    };
    match(tinted, kRounds);
    match(all, 1);  // what these cannot make up for, as of a house of many boards
    candidate.error = finest.error_at(reference.of(traced, current).error);
    candidate.max_error = candidate.error;
}

}  // namespace

const measure::AgreementReference& FinestPictures::take(const Mesh& seen, int side,
                                                        const Job& job) {
    if (!pictures_) {
        if (finest_->is_whole(seen))
            pictures_.emplace(seen, finest_->scene(), finest_->skin, finest_->options.seed, side,
                              job);
        else
            pictures_.emplace(seen, finest_->skin, finest_->options.seed, side, job);
    }
    return *pictures_;
}

const measure::AgreementReference& FinestPictures::from_above(const Mesh& seen, const Job& job) {
    using Pictures = measure::AgreementReference;
    if (!above_)
        above_.emplace(seen, ray::MeshScene(seen, finest_->skin), finest_->skin,
                       finest_->options.seed, Pictures::kCoarseSide, job,
                       measure::PictureViews::FromAbove);
    return *above_;
}

const measure::AgreementReference& FinestPictures::of_crown(const Job& job) {
    using Pictures = measure::AgreementReference;
    if (!crown_)
        crown_.emplace(finest_->mesh, finest_->scene(), finest_->skin, finest_->options.seed,
                       Pictures::kSide, job, measure::PictureViews::OfCrowns);
    return *crown_;
}

const measure::AgreementReference& FinestPictures::take_fine(const Job& job) {
    if (!fine_)
        fine_.emplace(finest_->mesh, finest_->scene(), finest_->skin, finest_->options.seed,
                      measure::AgreementReference::kFineSide, job);
    return *fine_;
}

const measure::AgreementReference& FinestPictures::take_few(const Job& job) {
    if (!few_)
        few_.emplace(finest_->mesh, finest_->scene(), finest_->skin, finest_->options.seed,
                     measure::AgreementReference::kFewSide, job);
    return *few_;
}

const measure::AgreementReference& FinestPictures::taken() const {
    if (!pictures_)
        fail(Status::Internal, "no pictures were taken of the finest");
    return *pictures_;
}

const glm::dvec3& FinestPictures::glow(const Job& job) {
    if (!glow_)
        glow_ = light_over_emitted(taken(), taken().trace(finest_->mesh, finest_->skin, job),
                                   finest_->materials, *finest_);
    return *glow_;
}

glm::dvec3 light_over_emitted(const measure::AgreementReference& pictures,
                              const measure::AgreementReference::TracedPictures& traced,
                              std::span<const Material> materials, const MeasuredFinest& finest) {
    std::vector<Material> dark;
    for (const Material& material : materials)
        dark.push_back(unlit(material));
    return pictures.brightness_of(traced, finest.skin_of(dark)).light;
}

void compare_pictures(StandInCandidate& candidate, std::span<const uint16_t> tinted,
                      const MeasuredFinest& finest, const FinestPictures& pictures,
                      const Job& job) {
    compare_to(pictures.taken(), candidate, tinted, finest, job);
    come_to(candidate, CandidateState::Pictured);
}

void compare_pictures(StandInCandidate& candidate, const MeasuredFinest& finest,
                      const measure::AgreementReference& pictures, const Job& job) {
    compare_to(pictures, candidate, {}, finest, job);
    come_to(candidate, CandidateState::Pictured);
}

bool agrees_everywhere(const StandInCandidate& candidate, const MeasuredFinest& finest,
                       const FinestPictures& pictures) {
    return candidate.error <= finest.error_at(pictures.taken().least_error());
}

void compare_finely(StandInCandidate& candidate, std::span<const uint16_t> tinted,
                    const MeasuredFinest& finest, FinestPictures& pictures, const Job& job) {
    compare_to(pictures.take_fine(job), candidate, tinted, finest, job);
}

void compare_crowns(StandInCandidate& candidate, const MeasuredFinest& finest,
                    FinestPictures& pictures, const Job& job) {
    const ray::SkinPtr skin = finest.skin_of(candidate.materials);
    candidate.error = finest.error_at(pictures.of_crown(job).of(candidate.mesh(), skin, job).error);
    candidate.max_error = candidate.error;
    come_to(candidate, CandidateState::Pictured);
    candidate.viewed = true;
}

bool looks_alike(const Mesh& drawn, std::span<const Material> materials, double error,
                 const MeasuredFinest& finest, FinestPictures& pictures, const Job& job) {
    // The most by which the mean light may differ, relatively.
    // Taste: a larger value accepts levels that are visibly darker or brighter.
    constexpr double kMostOff = 0.1;
    const measure::AgreementReference& reference =
        pictures.take(finest.mesh, measure::AgreementReference::kCoarseSide, job);
    const ray::SkinPtr skin = finest.skin_of(materials);
    const auto traced = reference.trace(drawn, skin, job);
    const measure::PictureAgreement seen = reference.of(traced, skin);
    const double light = (seen.light.x + seen.light.y + seen.light.z) / 3;
    return std::abs(light - 1) <= kMostOff &&
           kPictures * seen.error + finest.options.child_error <= error;
}

}  // namespace lodestone::hierarchy
