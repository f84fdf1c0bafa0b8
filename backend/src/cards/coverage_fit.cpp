// SPDX-License-Identifier: GPL-3.0-or-later
#include "cards/coverage_fit.h"

#include "base/parallel.h"
#include "measure/pictures/cube_views.h"
#include "measure/visible/sobol_points.h"

#include <glm/common.hpp>

#include <algorithm>
#include <array>
#include <cmath>

namespace lodestone::cards {
namespace {

// Pixels along a side of a view.
// Taste: more see smaller differences, in time that grows with the square.
constexpr int kPixels = 40;
// Samples along a side of a pixel.
// Taste: more know the coverage of pixels better, in time that grows with the square.
constexpr int kSamples = 2;
constexpr int kRow = kPixels * kSamples;

/// A place where a ray meets a card: the four texels that are interpolated there.
struct CardCrossing {
    std::array<uint32_t, 4> texels{};
    std::array<float, 4> parts{};  // of each in the interpolated share

    float share(const CardPicture& picture) const {
        float out = 0;
        for (size_t i = 0; i < texels.size(); ++i)
            out += parts[i] * picture.texels[texels[i]].w;
        return out;
    }
};

/// Where a ray meets a card; nothing beside it, or where it is seen too flat to show anything.
std::optional<CardCrossing> cross(const CardPlane& plane, const CardPatch& patch,
                                  const CardPicture& picture, const glm::dvec3& origin,
                                  const glm::dvec3& along) {
    // The cosine from which on a card shows something.
    // Taste: a larger value fits fewer views of each card.
    constexpr double kFlat = 0.05;
    const double facing = glm::dot(along, plane.normal());
    if (std::abs(facing) < kFlat)
        return std::nullopt;
    const double t = glm::dot(plane.middle - origin, plane.normal()) / facing;
    const glm::dvec3 arm = origin + t * along - plane.middle;
    const double x = glm::dot(arm, plane.right) / plane.half_size.x;
    const double y = glm::dot(arm, plane.up) / plane.half_size.y;
    if (!(std::abs(x) <= 1 && std::abs(y) <= 1))
        return std::nullopt;
    // Texels have their values in their middles; those of the clear border around a card exist too.
    const double column = patch.left + 0.5 * (1 + x) * patch.width - 0.5;
    const double row = patch.top + 0.5 * (1 - y) * patch.height - 0.5;
    const auto left = static_cast<int>(column);
    const auto top = static_cast<int>(row);
    const auto fx = static_cast<float>(column - left);
    const auto fy = static_cast<float>(row - top);
    CardCrossing out;
    out.parts = {(1 - fx) * (1 - fy), fx * (1 - fy), (1 - fx) * fy, fx * fy};
    for (int i = 0; i < 4; ++i)
        out.texels[static_cast<size_t>(i)] =
            static_cast<uint32_t>(picture.index(left + i % 2, top + i / 2));
    return out;
}

/// All rays of one view.
struct CardView {
    std::vector<CardCrossing> crossings;
    std::vector<uint32_t> begin;  // by sample, its first crossing; one more at the end
    std::vector<float> wanted;    // by pixel: the share of it in which the mesh is seen
};

size_t pixel_of(int sample) {
    const auto row = static_cast<size_t>(sample / kRow / kSamples);
    return row * kPixels + static_cast<size_t>(sample % kRow / kSamples);
}

/// The share of a pixel that a sample stands for.
/// Law: all of its samples are the whole pixel.
constexpr float kOfPixel = 1.0F / (kSamples * kSamples);

/// The sphere around all cards.
struct CardBall {
    glm::dvec3 center{0.0};
    double radius = 0;

    explicit CardBall(std::span<const CardPlane> planes) {
        Box3 box;
        for (const CardPlane& plane : planes) {
            for (const double x : {-1.0, 1.0}) {
                box.add(plane.at(x, -1));
                box.add(plane.at(x, 1));
            }
        }
        center = box.center();
        radius = 0.5 * glm::length(box.size());
    }
};

CardView taken(const CardPicture& picture, std::span<const CardPlane> planes, const CardBall& ball,
               const ray::MeshScene& scene, const glm::dvec3& towards, uint64_t seed) {
    const ray::FlushDenormals burst;
    const glm::dmat3 frame = measure::picture_frame(towards);
    CardView out;
    out.wanted.assign(size_t{kPixels} * kPixels, 0);
    for (int sample = 0; sample < kRow * kRow; ++sample) {
        out.begin.push_back(static_cast<uint32_t>(out.crossings.size()));
        const std::array<double, 2> u = measure::jitter(seed, static_cast<uint64_t>(sample));
        const int line = sample / kRow;
        const double x = 2 * (sample % kRow + u[0]) / kRow - 1;
        const double y = 2 * (line + u[1]) / kRow - 1;
        const glm::dvec3 origin = ball.center + ball.radius * (frame * glm::dvec3(x, y, 2));
        for (size_t card = 0; card < planes.size(); ++card) {
            const auto crossing =
                cross(planes[card], picture.patches[card], picture, origin, -towards);
            if (crossing)
                out.crossings.push_back(*crossing);
        }
        if (scene.first_hit(origin, -towards).hit)
            out.wanted[pixel_of(sample)] += kOfPixel;
    }
    out.begin.push_back(static_cast<uint32_t>(out.crossings.size()));
    return out;
}

/// The findings of a round: by texel, the coverage that its pixels lack, and over how much of it.
struct Lacking {
    std::vector<float> coverage;
    std::vector<float> weight;

    explicit Lacking(size_t texels) : coverage(texels, 0), weight(texels, 0) {}

    void add(const CardView& view, const CardPicture& picture) {
        std::vector<uint8_t> shown(view.crossings.size());
        std::vector<int> covers(size_t{kRow} * kRow, 0);
        std::vector<float> missing = view.wanted;
        for (int sample = 0; sample < kRow * kRow; ++sample) {
            const auto s = static_cast<size_t>(sample);
            for (uint32_t i = view.begin[s]; i < view.begin[s + 1]; ++i) {
                shown[i] = view.crossings[i].share(picture) >= kCardCutoff ? 1 : 0;
                covers[s] += shown[i];
            }
            if (covers[s] > 0)
                missing[pixel_of(sample)] -= kOfPixel;
        }
        for (int sample = 0; sample < kRow * kRow; ++sample) {
            const auto s = static_cast<size_t>(sample);
            for (uint32_t i = view.begin[s]; i < view.begin[s + 1]; ++i) {
                if (covers[s] > shown[i])
                    continue;  // another card covers it in any case
                const CardCrossing& at = view.crossings[i];
                for (size_t k = 0; k < at.texels.size(); ++k) {
                    coverage[at.texels[k]] += at.parts[k] * missing[pixel_of(sample)];
                    weight[at.texels[k]] += at.parts[k];
                }
            }
        }
    }
};

using CardViews = std::vector<CardView>;

CardViews all_views(const CardPicture& picture, std::span<const CardPlane> planes,
                    const ray::MeshScene& scene, uint64_t seed, const Job& job) {
    std::vector<glm::dvec3> directions = measure::cube_directions();
    directions.resize(directions.size() / 2);  // the opposite ones cover the same
    const CardBall ball(planes);
    CardViews out(directions.size());
    parallel_for(out.size(), [&](size_t i) {
        job.check();
        out[i] = taken(picture, planes, ball, scene, directions[i], measure::scramble(seed + i));
    });
    return out;
}

template <typename Change>
void change_shares(CardPicture& picture, const Change& change) {
    for (const CardPatch& patch : picture.patches) {
        for (int row = patch.top; row < patch.top + patch.height; ++row) {
            for (int column = patch.left; column < patch.left + patch.width; ++column) {
                const size_t at = picture.index(column, row);
                float& share = picture.texels[at].w;
                share = std::clamp(share + change(at), 0.0F, 1.0F);
            }
        }
    }
}

/// By how much the cards cover more than the mesh in all views together, in pixels.
double too_much(const CardViews& views, const CardPicture& picture) {
    double out = 0;
    for (const CardView& view : views) {
        for (const float share : view.wanted)
            out -= double{share};
        for (size_t s = 0; s + 1 < view.begin.size(); ++s) {
            const auto shown = [&](const CardCrossing& at) {
                return at.share(picture) >= kCardCutoff;
            };
            const auto* first = view.crossings.data() + view.begin[s];
            const auto* last = view.crossings.data() + view.begin[s + 1];
            if (std::any_of(first, last, shown))
                out += double{kOfPixel};
        }
    }
    return out;
}

/// Adds one number to all shares that are not 0, so that the cards cover as much as the mesh in all.
void level_coverage(CardPicture& picture, const CardViews& views) {
    // The most that is added.
    // Taste: a larger value lets cards grow over what they were cast from.
    constexpr float kMost = 0.25F;
    // Law: halving the range so often leaves less than the 8 bits of the picture hold.
    constexpr int kHalvings = 8;
    const CardPicture before = picture;
    float low = -kMost;
    float high = kMost;
    for (int i = 0; i < kHalvings; ++i) {
        const float middle = 0.5F * (low + high);
        picture = before;
        change_shares(picture, [&](size_t at) { return before.texels[at].w > 0 ? middle : 0.0F; });
        (too_much(views, picture) > 0 ? high : low) = middle;
    }
}

}  // namespace

void fit_coverage(CardPicture& picture, std::span<const CardPlane> planes,
                  const ray::MeshScene& scene, uint64_t seed, const Job& job) {
    // Taste: more rounds come a little nearer, in time in proportion.
    constexpr int kRounds = 24;
    // The part of what is lacking that a round adds.
    // Taste: a larger value needs fewer rounds, and lets texels come and go in turns.
    constexpr float kStep = 0.25F;
    const CardViews views = all_views(picture, planes, scene, seed, job);
    for (int round = 0; round < kRounds; ++round) {
        job.check();
        Lacking lacking(picture.texels.size());
        for (const CardView& view : views)
            lacking.add(view, picture);
        change_shares(picture, [&](size_t at) {
            return lacking.weight[at] > 0 ? kStep * lacking.coverage[at] / lacking.weight[at]
                                          : 0.0F;
        });
    }
    // Texels follow the samples that they were fitted to; other samples tell what that adds up to.
    level_coverage(picture, all_views(picture, planes, scene, measure::scramble(seed), job));
}

}  // namespace lodestone::cards
