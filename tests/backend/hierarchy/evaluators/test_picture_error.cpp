// SPDX-License-Identifier: GPL-3.0-or-later
// Guards what is said of a group's children that are drawn together: each may be right alone.
#include "base/error.h"
#include "hierarchy/evaluators/picture_error.h"
#include "scenes/small_models.h"
#include "scenes/with_rays.h"

using namespace lodestone;

namespace {

class StandInPictureError : public WithRays {};

constexpr double kThick = 0.04;
constexpr double kCover = 0.003;

Mesh book(double low, uint16_t paper, uint16_t cover) {
    Mesh mesh;
    append(mesh, shapes::box({0, 0, low + kCover}, {0.2, 0.28, low + kThick - kCover}), {}, paper);
    append(mesh, shapes::box({0, 0, low}, {0.2, 0.28, low + kCover}), {}, cover);
    append(mesh, shapes::box({0, 0, low + kThick - kCover}, {0.2, 0.28, low + kThick}), {}, cover);
    return mesh;
}

}  // namespace

TEST_F(StandInPictureError, BooksThatAreDarkTogetherDoNotStandForTheirPile) {
    // Alone a book shows its dark covers above all, in a pile its paper.
    const glm::dvec3 paper(0.8);
    const glm::dvec3 cover(0.05);
    constexpr int kBooks = 12;
    Mesh pile;
    Mesh boxes;
    for (int i = 0; i < kBooks; ++i) {
        append(pile, book(kThick * i, 0, 1), {});
        append(boxes, shapes::box({0, 0, kThick * i}, {0.2, 0.28, kThick * (i + 1)}), {});
    }
    boxes.slots.assign(boxes.triangles.size(), 0);
    const double covers = 2 * 0.2 * 0.28;
    const double sides = 2 * (0.2 + 0.28) * kThick;
    const std::vector<Material> materials{models::colored("paper", paper),
                                          models::colored("cover", cover)};
    image::TexelCache texels;
    hierarchy::FinestOptions options;
    options.child_error = 0.001;
    const hierarchy::MeasuredFinest finest =
        hierarchy::measure_finest(pile, materials, texels, {}, options, {});
    hierarchy::FinestPictures pictures(finest);
    constexpr double kError = 0.2;  // metres: pixels of a third of the pile
    const auto alike = [&](const Mesh& drawn, double brightness, const glm::dvec3& other) {
        return looks_alike(drawn,
                           std::vector<Material>{models::colored("a", brightness * paper),
                                                 models::colored("b", other)},
                           kError, finest, pictures, {});
    };
    EXPECT_TRUE(alike(pile, 1, cover));
    EXPECT_TRUE(alike(pile, 0.95, cover));
    EXPECT_FALSE(alike(pile, 0.8, 0.8 * cover));
    const glm::dvec3 mean = (covers * cover + sides * paper) / (covers + sides);
    EXPECT_FALSE(alike(boxes, mean.x / paper.x, mean));
    EXPECT_FALSE(looks_alike(pile, materials, 0.0005, finest, pictures, {}));  // finer than its own
}

TEST_F(StandInPictureError, PicturesAreTakenOnceByTheFirstWhoNeedsThem) {
    const Mesh ball = shapes::sphere(1, 2);
    const std::vector<Material> materials{models::colored("gray", glm::dvec3(0.5))};
    image::TexelCache texels;
    const hierarchy::MeasuredFinest finest =
        hierarchy::measure_finest(ball, materials, texels, {}, {}, {});
    hierarchy::FinestPictures pictures(finest);
    EXPECT_THROW(static_cast<void>(pictures.taken()), Error);
    using Pictures = measure::AgreementReference;
    const Pictures* first = &pictures.take(ball, Pictures::kCoarseSide, {});
    const ray::SkinPtr skin = finest.skin;
    const double coarse = first->of(shapes::sphere(0.8, 2), skin).error;
    EXPECT_EQ(&pictures.take(ball, Pictures::kSide, {}), first);
    EXPECT_EQ(&pictures.taken(), first);
    EXPECT_EQ(pictures.taken().of(shapes::sphere(0.8, 2), skin).error, coarse);
}

TEST_F(StandInPictureError, ABallAsLargeAndOfAnotherBrightnessIsMadeAsBright) {
    const Mesh ball = shapes::sphere(1, 3);
    const std::vector<Material> materials{models::colored("gray", glm::dvec3(0.5))};
    image::TexelCache texels;
    const hierarchy::MeasuredFinest finest =
        hierarchy::measure_finest(ball, materials, texels, {}, {}, {});
    hierarchy::FinestPictures pictures(finest);
    hierarchy::StandInCandidate candidate;
    candidate.kind = Kind::Ellipsoid;
    candidate.payload = Primitive{{}, glm::dmat3(1.0), glm::dvec3(1)};
    candidate.materials = {models::colored("dark", glm::dvec3(0.3))};
    EXPECT_THROW(compare_pictures(candidate, {}, finest, pictures, {}), Error) << "none are taken";
    pictures.take(ball, measure::AgreementReference::kCoarseSide, {});
    compare_pictures(candidate, {}, finest, pictures, {});
    EXPECT_EQ(candidate.state, hierarchy::CandidateState::Pictured);
    EXPECT_NEAR(candidate.materials[0].base_color.x, 0.5, 0.02);
    hierarchy::StandInCandidate thinner = candidate;
    thinner.state = hierarchy::CandidateState::Measured;
    Primitive thin = thinner.primitive();
    thin.half_size.x = 0.4;
    thinner.payload = thin;
    compare_pictures(thinner, {}, finest, pictures, {});
    EXPECT_GT(thinner.error, 2 * candidate.error);
    EXPECT_THROW(compare_pictures(candidate, {}, finest, pictures, {}), Error) << "it was already";
}
