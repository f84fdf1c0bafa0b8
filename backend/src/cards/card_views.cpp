// SPDX-License-Identifier: GPL-3.0-or-later
#include "cards/card_views.h"

#include "base/parallel.h"
#include "measure/pictures/cube_views.h"
#include "measure/visible/sobol_points.h"

#include <glm/common.hpp>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>

namespace lodestone::cards {
namespace {

// Pixels along a side of a view.
// Taste: more see smaller differences, in time that grows with the square.
constexpr size_t kPixels = 40;
// Samples along a side of a pixel.
// Taste: more know the coverage of pixels better, in time that grows with the square.
constexpr size_t kSamples = 2;
constexpr size_t kRow = kPixels * kSamples;

CardView taken(const CardPicture& picture, std::span<const CardPlane> planes, const CardBall& ball,
               const ray::MeshScene& scene, const glm::dvec3& towards, uint64_t seed) {
    const ray::FlushDenormals burst;
    const glm::dmat3 frame = measure::picture_frame(towards);
    CardView out;
    out.towards = towards;
    out.wanted.assign(kPixels * kPixels, 0);
    for (size_t sample = 0; sample < kRow * kRow; ++sample) {
        out.begin.push_back(static_cast<uint32_t>(out.crossings.size()));
        const std::array<double, 2> u = measure::jitter(seed, sample);
        const size_t line = sample / kRow;
        const size_t column = sample % kRow;
        const double x = 2 * (static_cast<double>(column) + u[0]) / double{kRow} - 1;
        const double y = 2 * (static_cast<double>(line) + u[1]) / double{kRow} - 1;
        const glm::dvec3 origin = ball.center + ball.radius * (frame * glm::dvec3(x, y, 2));
        for (size_t card = 0; card < planes.size(); ++card) {
            const auto crossing =
                crossing_of(planes[card], picture.patches[card], picture, origin, -towards);
            if (crossing)
                out.crossings.push_back(*crossing);
        }
        if (scene.first_hit(origin, -towards).hit)
            out.wanted[CardView::pixel_of(sample)] += CardView::share_of_sample();
    }
    out.begin.push_back(static_cast<uint32_t>(out.crossings.size()));
    out.all_wanted = std::accumulate(out.wanted.begin(), out.wanted.end(), 0.0F);
    return out;
}

}  // namespace

glm::vec4 CardCrossing::texel(const CardPicture& picture) const {
    glm::vec4 out(0.0F);
    for (size_t i = 0; i < texels.size(); ++i)
        out += parts[i] * picture.texels[texels[i]];
    return out;
}

bool CardCrossing::shows(const CardPicture& picture) const {
    float share = 0;
    for (size_t i = 0; i < texels.size(); ++i)
        share += parts[i] * picture.texels[texels[i]].w;
    return share >= kCardCutoff;
}

std::optional<CardCrossing> crossing_of(const CardPlane& plane, const CardPatch& patch,
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
    out.distance = t;
    out.parts = {(1 - fx) * (1 - fy), fx * (1 - fy), (1 - fx) * fy, fx * fy};
    for (int i = 0; i < 4; ++i)
        out.texels[static_cast<size_t>(i)] =
            static_cast<uint32_t>(picture.index(left + i % 2, top + i / 2));
    return out;
}

CardBall::CardBall(std::span<const CardPlane> planes) {
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

std::vector<glm::dvec3> SkyDirections::all() const {
    std::vector<glm::dvec3> out;
    for (size_t i = first; i < count; i += step) {
        const auto number = static_cast<double>(i);
        const double z = number / static_cast<double>(count - 1);
        const double around = kGoldenAngle * number + turn;
        const double across = std::sqrt(1 - z * z);
        out.emplace_back(across * std::cos(around), across * std::sin(around), z);
    }
    return out;
}

size_t CardView::pixel_of(size_t sample) {
    return sample / kRow / kSamples * kPixels + sample % kRow / kSamples;
}

float CardView::share_of_sample() {
    // Law: all of its samples are the whole pixel.
    return 1.0F / float{kSamples * kSamples};
}

double CardView::too_much(const CardPicture& picture) const {
    double out = -double{all_wanted};
    for (size_t sample = 0; sample < samples(); ++sample) {
        const std::span<const CardCrossing> met = at(sample);
        if (std::any_of(met.begin(), met.end(),
                        [&](const CardCrossing& one) { return one.shows(picture); }))
            out += double{share_of_sample()};
    }
    return out;
}

std::vector<CardView> card_views(const CardPicture& picture, std::span<const CardPlane> planes,
                                 const ray::MeshScene& scene, const SkyDirections& directions,
                                 uint64_t seed, const Job& job) {
    const std::vector<glm::dvec3> towards = directions.all();
    const CardBall ball(planes);
    std::vector<CardView> out(towards.size());
    parallel_for(out.size(), [&](size_t i) {
        job.check();
        out[i] = taken(picture, planes, ball, scene, towards[i], measure::scramble(seed + i));
    });
    return out;
}

}  // namespace lodestone::cards
