// SPDX-License-Identifier: GPL-3.0-or-later
#include "cards/coverage_fit.h"

#include "base/parallel.h"
#include "cards/card_views.h"
#include "measure/visible/sobol_points.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <numeric>

namespace lodestone::cards {
namespace {

/// A view, and the coverage that it lacked over rounds.
struct ViewToFit {
    CardView view;
    float owed = 0;  // the sum of what was lacking, as a share of what is wanted
};

using FitViews = std::vector<ViewToFit>;

/// The findings of a round: by texel, the coverage that its pixels lack, and over how much of it.
struct Lacking {
    std::vector<float> coverage;
    std::vector<float> weight;

    explicit Lacking(size_t texels) : coverage(texels, 0), weight(texels, 0) {}

    void add(ViewToFit& fit, const CardPicture& picture) {
        // How much the share that a view lacks in all counts beside that of a pixel.
        // Taste: a larger value covers as much from each side, and less in the right places.
        constexpr float kNow = 0.5F;
        // The same of what it lacked in all rounds: what no pixel can mend, others make up for.
        // Taste: as kNow; much larger ones let texels come and go in turns.
        constexpr float kOwed = 0.3F;
        // The most that is owed.
        // Taste: a larger one lets a view that no cards can cover rule all others.
        constexpr float kMostOwed = 3;
        const CardView& view = fit.view;
        std::vector<uint8_t> shown(view.crossings.size());
        for (size_t i = 0; i < shown.size(); ++i)
            shown[i] = view.crossings[i].shows(picture) ? 1 : 0;
        std::vector<int> covers(view.samples(), 0);
        std::vector<float> missing = view.wanted;
        for (size_t sample = 0; sample < view.samples(); ++sample) {
            for (uint32_t i = view.begin[sample]; i < view.begin[sample + 1]; ++i)
                covers[sample] += shown[i];
            if (covers[sample] > 0)
                missing[CardView::pixel_of(sample)] -= CardView::share_of_sample();
        }
        const float share =
            view.all_wanted > 0
                ? std::accumulate(missing.begin(), missing.end(), 0.0F) / view.all_wanted
                : 0.0F;
        fit.owed = std::clamp(fit.owed + kOwed * share, -kMostOwed, kMostOwed);
        const float in_all = fit.owed + kNow * share;
        for (size_t sample = 0; sample < view.samples(); ++sample) {
            for (uint32_t i = view.begin[sample]; i < view.begin[sample + 1]; ++i) {
                if (covers[sample] > shown[i])
                    continue;  // another card covers it in any case
                const CardCrossing& at = view.crossings[i];
                for (size_t k = 0; k < at.texels.size(); ++k) {
                    coverage[at.texels[k]] +=
                        at.parts[k] * (missing[CardView::pixel_of(sample)] + in_all);
                    weight[at.texels[k]] += at.parts[k];
                }
            }
        }
    }
};

/// Adds change(index) to the shares of a patch's texels.
template <typename Change>
void change_shares(CardPicture& picture, const CardPatch& patch, const Change& change) {
    for (int row = patch.top; row < patch.top + patch.height; ++row) {
        for (int column = patch.left; column < patch.left + patch.width; ++column) {
            const size_t at = picture.index(column, row);
            float& share = picture.texels[at].w;
            share = std::clamp(share + change(at), 0.0F, 1.0F);
        }
    }
}

/// Brings texels to what their pixels lack.
void fit_texels(CardPicture& picture, std::vector<FitViews>& sets, const Job& job) {
    // Taste: more rounds come a little nearer, in time in proportion.
    constexpr size_t kRounds = 48;
    // The part of what is lacking that the first round adds.
    // Taste: a larger value needs fewer rounds, and lets texels come and go in turns.
    constexpr float kStep = 0.25F;
    // The rounds after which it is half of that, a third after twice as many, and so on.
    // Taste: a larger value keeps texels coming and going.
    constexpr float kHalved = 16;
    for (size_t round = 0; round < kRounds; ++round) {
        job.check();
        Lacking lacking(picture.texels.size());
        for (ViewToFit& fit : sets[round % sets.size()])
            lacking.add(fit, picture);
        const float step = kStep / (1 + static_cast<float>(round) / kHalved);
        for (const CardPatch& patch : picture.patches) {
            change_shares(picture, patch, [&](size_t at) {
                return lacking.weight[at] > 0 ? step * lacking.coverage[at] / lacking.weight[at]
                                              : 0.0F;
            });
        }
    }
}

/// Adds a number to all shares of a plane that are not 0, one plane after another, so that the
/// cards cover as much as the mesh in the mean of the views that face the plane.
void level_coverage(CardPicture& picture, std::span<const CardPlane> planes,
                    const std::vector<CardView>& views, const Job& job) {
    // The most that is added.
    // Taste: a larger value lets cards grow over what they were cast from.
    constexpr float kMost = 0.5F;
    // Law: halving the range so often leaves less than the 8 bits of the picture hold.
    constexpr int kHalvings = 8;
    // Each plane changes what the others have to cover.
    // Taste: more come a little nearer, in time in proportion.
    constexpr int kSweeps = 3;
    const CardPicture before = picture;
    for (int sweep = 0; sweep < kSweeps; ++sweep) {
        for (size_t plane = 0; plane < planes.size(); ++plane) {
            const auto sum_with = [&](float added) {
                change_shares(picture, picture.patches[plane], [&](size_t at) {
                    const float share = before.texels[at].w;
                    return (share > 0 ? share + added : 0.0F) - picture.texels[at].w;
                });
                std::vector<double> parts(views.size(), 0);
                parallel_for(views.size(), [&](size_t i) {
                    const double facing = glm::dot(planes[plane].normal(), views[i].towards);
                    if (views[i].all_wanted > 0)
                        parts[i] = facing * facing * views[i].too_much(picture) /
                                   double{views[i].all_wanted};
                });
                return std::accumulate(parts.begin(), parts.end(), 0.0);
            };
            float low = -kMost;
            float high = kMost;
            for (int i = 0; i < kHalvings; ++i) {
                job.check();
                const float middle = 0.5F * (low + high);
                (sum_with(middle) > 0 ? high : low) = middle;
            }
        }
    }
}

}  // namespace

void fit_coverage(CardPicture& picture, std::span<const CardPlane> planes,
                  const ray::MeshScene& scene, uint64_t seed, const Job& job) {
    // Views that take turns: texels that follow the same ones alone cover otherwise between them.
    // Taste: more fit views better that are not among them, and need rays in proportion.
    constexpr size_t kSets = 2;
    // Radians by which views that check the others are turned.
    // Law: nothing of 1 is a part of a turn or of the golden angle.
    constexpr double kAside = 1;
    std::vector<FitViews> sets(kSets);
    SkyDirections directions;
    for (size_t set = 0; set < kSets; ++set) {
        directions.first = set;
        directions.step = kSets;
        for (CardView& view :
             card_views(picture, planes, scene, directions, measure::scramble(seed + set), job))
            sets[set].push_back({std::move(view)});
    }
    fit_texels(picture, sets, job);
    // Texels follow the samples that they were fitted to; others tell what that adds up to.
    level_coverage(picture, planes,
                   card_views(picture, planes, scene, {directions.count, 0, 1, kAside},
                              measure::scramble(seed + kSets), job),
                   job);
}

}  // namespace lodestone::cards
