// SPDX-License-Identifier: GPL-3.0-or-later
// Picture errors: from which pixel size on pictures of a candidate and of the finest agree.
#pragma once

#include "hierarchy/candidate.h"
#include "hierarchy/finest.h"
#include "measure/pictures/picture_agreement.h"

#include <optional>

namespace lodestone::hierarchy {

/// The share of the pixel size from which on whole pictures agree that counts as the error of a
/// level whose points are near in space.
/// Taste: a larger value keeps finer levels where pictures differ.
inline constexpr double kPictures = 0.5;

/// The pictures of the finest: taken once, by the first who needs them and as fine as he does. Who
/// comes later makes do with these.
class FinestPictures {
public:
    /// The finest must last.
    explicit FinestPictures(const MeasuredFinest& finest) : finest_(&finest) {}

    /// `seen`: the finest, or what of it can be seen. `side`: one of AgreementReference's.
    const measure::AgreementReference& take(const Mesh& seen, int side, const Job& job);
    /// Many samples of all of the finest, for levels that come close to it.
    const measure::AgreementReference& take_fine(const Job& job);
    /// Few samples of all of the finest, for what is 16 pixels large or less where it is used.
    const measure::AgreementReference& take_few(const Job& job);
    /// Few samples of the finest, or what of it can be seen, as one sees what stands
    /// (PictureViews::FromAbove), taken when they are asked for first.
    const measure::AgreementReference& from_above(const Mesh& seen, const Job& job);
    /// Those of a crown (PictureViews::OfCrowns), taken when they are asked for first.
    const measure::AgreementReference& of_crown(const Job& job);
    /// Those that are there. Throws Error: Internal, where take() was never called.
    const measure::AgreementReference& taken() const;

    /// All light of the finest's pictures over what it emits, by color.
    const glm::dvec3& glow(const Job& job);

private:
    const MeasuredFinest* finest_;
    std::optional<measure::AgreementReference> pictures_;
    std::optional<measure::AgreementReference> fine_;
    std::optional<measure::AgreementReference> few_;
    std::optional<measure::AgreementReference> above_;
    std::optional<measure::AgreementReference> crown_;
    std::optional<glm::dvec3> glow_;
};

/// All light of the finest's pictures over what these materials of something traced emit.
glm::dvec3 light_over_emitted(const measure::AgreementReference& pictures,
                              const measure::AgreementReference::TracedPictures& traced,
                              std::span<const Material> materials, const MeasuredFinest& finest);

/// Fills the errors of a candidate with its own materials by pictures that were taken, and makes it
/// as bright as the finest by its colors, first by those of the slots `tinted`: Pictured.
void compare_pictures(StandInCandidate& candidate, std::span<const uint16_t> tinted,
                      const MeasuredFinest& finest, const FinestPictures& pictures, const Job& job);

/// Fills the same by these pictures of the finest, with no slot first.
void compare_pictures(StandInCandidate& candidate, const MeasuredFinest& finest,
                      const measure::AgreementReference& pictures, const Job& job);

/// Whether it agreed at the smallest pixel of these pictures: it may be nearer than they can tell.
bool agrees_everywhere(const StandInCandidate& candidate, const MeasuredFinest& finest,
                       const FinestPictures& pictures);

/// Fills the errors of such a one again, by more samples.
void compare_finely(StandInCandidate& candidate, std::span<const uint16_t> tinted,
                    const MeasuredFinest& finest, FinestPictures& pictures, const Job& job);

/// Fills the errors of cards, whose points lie anywhere behind what they show, by pictures of a
/// crown in the colors that they have: Pictured.
void compare_crowns(StandInCandidate& candidate, const MeasuredFinest& finest,
                    FinestPictures& pictures, const Job& job);

/// Whether what is drawn of a group's children is about as bright as the finest, and looks like it
/// in pictures of pixels of that error.
bool looks_alike(const Mesh& drawn, std::span<const Material> materials, double error,
                 const MeasuredFinest& finest, FinestPictures& pictures, const Job& job);

}  // namespace lodestone::hierarchy
