// SPDX-License-Identifier: GPL-3.0-or-later
#include "measure/pictures/picture_agreement.h"

#include "base/parallel.h"
#include "measure/pictures/picture_misses.h"
#include "measure/visible/sobol_points.h"
#include "measure/visible/visible_sampler.h"

#include <glm/common.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <optional>

namespace lodestone::measure {
namespace {

// The sides of pixels in samples that are tried, where they divide the side of the picture.
// Law: the divisors of kFineSide (180), of which all other sides are some, above 1.
constexpr std::array<int, 17> kPixelSides{2,  3,  4,  5,  6,  9,  10, 12, 15,
                                          18, 20, 30, 36, 45, 60, 90, 180};
// A stand-in that differs as a whole is never more than this farther off than it is large.
// Taste: a larger value uses it only farther away.
constexpr double kMostMisses = 2;
// Pictures show this much around the finest's bound, for larger stand-ins.
// Taste: a larger value wastes more samples around the object.
constexpr double kMargin = 1.1;

/// The appearance of a slot where nothing is looked up, and whether something is looked up.
struct SlotAppearance {
    ray::SurfaceAppearance mean;
    bool varies = false;

    SlotAppearance(const Mesh& mesh, const ray::MeshSkin* skin, size_t slot) {
        if (skin == nullptr)
            return;
        const auto number = static_cast<uint16_t>(slot);
        mean = skin->mean(number);
        varies = skin->varies(mesh, number);
    }
};

glm::dvec4 light_of(const ray::SurfaceAppearance& shown, double light) {
    return {light * shown.color + shown.emission, 1};
}

}  // namespace

AgreementReference::AgreementReference(const Mesh& finest, const ray::SkinPtr& skin, uint64_t seed,
                                       int side, const Job& job)
    : AgreementReference(finest, nullptr, skin, seed, side, job, PictureViews::AllAround) {}

AgreementReference::AgreementReference(const Mesh& finest, const ray::MeshScene& scene,
                                       const ray::SkinPtr& skin, uint64_t seed, int side,
                                       const Job& job, PictureViews views)
    : AgreementReference(finest, &scene, skin, seed, side, job, views) {}

AgreementReference::AgreementReference(const Mesh& finest, const ray::MeshScene* scene,
                                       const ray::SkinPtr& skin, uint64_t seed, int side,
                                       const Job& job, PictureViews views)
    : side_(side), views_(views) {
    Box3 box;
    for (const Triangle& t : finest.triangles) {
        for (int corner = 0; corner < 3; ++corner) {
            const glm::dvec3 point(finest.positions[t[corner]]);
            if (std::isfinite(point.x + point.y + point.z))
                box.add(point);
        }
    }
    if (!box.empty()) {
        center_ = box.center();
        radius_ = kMargin * 0.5 * glm::length(box.size());
    }
    const auto row = static_cast<size_t>(side_);
    places_.resize(kViews * row * row);
    for (size_t number = 0; number < places_.size(); ++number) {
        const std::array<double, 2> u = jitter(seed, number);
        const auto column = static_cast<double>(number % row);
        const auto line = static_cast<double>(number / row % row);
        places_[number] = {2 * (column + u[0]) / side_ - 1, 2 * (line + u[1]) / side_ - 1};
    }
    const TracedPictures traced = trace(finest, scene, skin, job);
    finest_ = shown(traced, skin.get());
    finest_points_ = points_of(traced);
    finest_total_ = total(traced, skin.get());
}

AgreementReference::Pictures AgreementReference::shown(const TracedPictures& traced,
                                                       const ray::MeshSkin* skin) const {
    Pictures out(traced.samples_.size(), glm::vec4(0.0f));
    const Mesh& mesh = *traced.mesh_;
    std::vector<SlotAppearance> slots;
    for (size_t slot = 0; slot < traced.by_slot_.size(); ++slot)
        slots.emplace_back(mesh, skin, slot);
    for (size_t i = 0; i < out.size(); ++i) {
        const TracedPictures::TracedSample& sample = traced.samples_[i];
        if (sample.triangle == ray::kNoTriangle)
            continue;
        const SlotAppearance& slot = slots[mesh.slot(sample.triangle)];
        out[i] = glm::vec4(
            light_of(slot.varies ? skin->at(mesh, sample.triangle, sample.u, sample.v) : slot.mean,
                     sample.light));
    }
    return out;
}

glm::dvec4 AgreementReference::total(const TracedPictures& traced, const ray::MeshSkin* skin) {
    const Mesh& mesh = *traced.mesh_;
    glm::dvec4 out(0.0);
    std::vector<uint8_t> varies;
    for (size_t number = 0; number < traced.by_slot_.size(); ++number) {
        const SlotAppearance slot(mesh, skin, number);
        const TracedPictures::SlotLight& sum = traced.by_slot_[number];
        varies.push_back(slot.varies ? 1 : 0);
        if (!slot.varies)
            out +=
                glm::dvec4(sum.light * slot.mean.color + sum.count * slot.mean.emission, sum.count);
    }
    if (std::find(varies.begin(), varies.end(), 1) == varies.end())
        return out;
    for (const TracedPictures::TracedSample& sample : traced.samples_) {
        if (sample.triangle != ray::kNoTriangle && varies[mesh.slot(sample.triangle)] != 0)
            out += light_of(skin->at(mesh, sample.triangle, sample.u, sample.v), sample.light);
    }
    return out;
}

PictureAgreement AgreementReference::brightness_of(const TracedPictures& stand_in,
                                                   const ray::SkinPtr& skin) const {
    PictureAgreement out;
    const glm::dvec4 theirs = total(stand_in, skin.get());
    out.coverage = finest_total_.w > 0 ? theirs.w / finest_total_.w : 1;
    for (int i = 0; i < 3; ++i)
        out.light[i] = theirs[i] > 0 ? finest_total_[i] / theirs[i] : 1;
    return out;
}

PictureAgreement AgreementReference::of(const Mesh& stand_in, const ray::SkinPtr& skin,
                                        const Job& job) const {
    return of(trace(stand_in, skin, job), skin);
}

PictureAgreement AgreementReference::of(const TracedPictures& stand_in,
                                        const ray::SkinPtr& skin) const {
    PictureAgreement out = brightness_of(stand_in, skin);
    out.error = agreement_size(shown(stand_in, skin.get())).error;
    return out;
}

std::vector<glm::dvec4> AgreementReference::side_colors(const TracedPictures& stand_in,
                                                        std::span<const uint32_t> side_of,
                                                        size_t sides) const {
    // The pixels along a side of a picture in which light is compared.
    // Taste: smaller pixels tell more places apart and know each less well; it divides all sides.
    constexpr int kPixels = 15;
    // Taste: more rounds come nearer to the least difference, and to its noise.
    constexpr int kRounds = 8;
    const auto row = static_cast<size_t>(side_);
    const size_t samples = row / kPixels;
    std::vector<glm::dvec3> wanted(kViews * kPixels * kPixels, glm::dvec3(0.0));
    std::map<std::pair<size_t, uint32_t>, double> lights;
    for (size_t i = 0; i < stand_in.samples_.size(); ++i) {
        const TracedPictures::TracedSample& sample = stand_in.samples_[i];
        const size_t pixel =
            (i / (row * row) * kPixels + i / row % row / samples) * kPixels + i % row / samples;
        wanted[pixel] += glm::dvec3(finest_[i]);
        if (sample.triangle != ray::kNoTriangle)
            lights[{pixel, side_of[sample.triangle]}] += sample.light;
    }
    std::vector<glm::dvec4> out(sides, glm::dvec4(0.0));
    for (const auto& [where, light] : lights)
        out[where.second].w += light;
    for (glm::dvec4& side : out)
        side = side.w > 0 ? glm::dvec4(1, 1, 1, side.w) : glm::dvec4(0.0);
    // Likeliest colors by expectation and maximization (Richardson 1972, Lucy 1974): none gets
    // below 0, and all light together is right in each round.
    for (int round = 0; round < kRounds; ++round) {
        std::vector<glm::dvec3> shown(wanted.size(), glm::dvec3(0.0));
        for (const auto& [where, light] : lights)
            shown[where.first] += light * glm::dvec3(out[where.second]);
        std::vector<glm::dvec3> sums(sides, glm::dvec3(0.0));
        for (const auto& [where, light] : lights)
            sums[where.second] +=
                light * wanted[where.first] / glm::max(shown[where.first], glm::dvec3(1e-9));
        for (size_t side = 0; side < sides; ++side) {
            if (out[side].w > 0)
                out[side] =
                    glm::dvec4(glm::dvec3(out[side]) * sums[side] / out[side].w, out[side].w);
        }
    }
    return out;
}

double AgreementReference::least_error() const {
    const auto* const least = std::find_if(kPixelSides.begin(), kPixelSides.end(),
                                           [&](int pixel) { return side_ % pixel == 0; });
    return *least * 2 * radius_ / side_;
}

double AgreementReference::misses_of(const Pictures& other, const std::vector<PictureRect>& parts,
                                     int pixel) const {
    const PixelMisses in_pixels = pixel_misses(finest_, other, parts, side_, pixel);
    if (views_ != PictureViews::OfCrowns)
        return in_pixels.worst();
    int area = pixel;  // the largest of kPixelSides within
    for (const int side : kPixelSides) {
        if (side_ % side == 0 && side <= kCrownPixels * pixel)
            area = std::max(area, side);
    }
    return std::max(in_pixels.coverage_off(),
                    pixel_misses(finest_, other, parts, side_, area).light_off());
}

AgreementReference::AgreementSize AgreementReference::agreement_size(const Pictures& other) const {
    const double sample = 2 * radius_ / side_;
    const std::vector<PictureRect> parts = picture_rects(finest_, other, kViews, side_);
    // Sizes are tried from the largest pixels down, as long as the pictures agree. Between two
    // sizes the misses follow a power of the size, nearly. Pictures of a pixel each are few: by
    // chance they may differ alone.
    double last_misses = 0;
    int last = 0;
    AgreementSize out{2 * radius_, false};
    for (size_t i = kPixelSides.size(); i-- > 0;) {
        const int pixel = kPixelSides[i];
        if (side_ % pixel != 0)
            continue;
        const double misses = misses_of(other, parts, pixel);
        if (misses > 1) {
            if (last > 0) {
                const double part =
                    last_misses > 0 ? std::log(misses) / std::log(misses / last_misses) : 0.0;
                const double ratio = static_cast<double>(last) / pixel;
                out.error = pixel * sample * std::pow(ratio, std::clamp(part, 0.0, 1.0));
            } else if (pixel == side_) {
                // Seen whole the stand-in looks different: it has to be smaller than a pixel.
                out.error = 2 * radius_ * std::min(misses, kMostMisses);
                continue;
            }
            return out;
        }
        last_misses = misses;
        last = pixel;
        out.error = pixel * sample;
    }
    out.smallest = true;
    return out;
}

std::vector<glm::vec3> AgreementReference::points_of(const TracedPictures& traced) const {
    std::vector<glm::vec3> out(traced.samples_.size(),
                               glm::vec3(std::numeric_limits<float>::quiet_NaN()));
    const Mesh& mesh = *traced.mesh_;
    for (size_t i = 0; i < out.size(); ++i) {
        const TracedPictures::TracedSample& sample = traced.samples_[i];
        if (sample.triangle == ray::kNoTriangle)
            continue;
        const Triangle& t = mesh.triangles[sample.triangle];
        const glm::dvec3 a(mesh.positions[t.x]);
        out[i] = glm::vec3(a + double(sample.u) * (glm::dvec3(mesh.positions[t.y]) - a) +
                           double(sample.v) * (glm::dvec3(mesh.positions[t.z]) - a) - center_);
    }
    return out;
}

double AgreementReference::gap_error(const TracedPictures& stand_in, const ray::SkinPtr& skin,
                                     double off) const {
    // A point of the finest is missed when the stand-in shows nothing within so many times its
    // error.
    // Taste: a larger value finds fewer gaps.
    constexpr double kTimes = 2;
    // Neighboring samples that are searched to each side at most.
    // Taste: a larger value finds nearer points on coarse levels, for time that grows with its
    // square.
    constexpr int kMostAround = 6;
    if (!(radius_ > 0))
        return 0;
    const double spacing = 2 * radius_ / side_;
    const auto reach = static_cast<float>(kTimes * off + 1.5 * spacing);
    const auto around = static_cast<int>(
        std::clamp(std::ceil(kTimes * off / spacing), 1.0, static_cast<double>(kMostAround)));
    const std::vector<glm::vec3> theirs = points_of(stand_in);
    const auto is_near = [&](size_t at, const glm::vec3& point) {
        const glm::vec3 arm = theirs[at] - point;
        return glm::dot(arm, arm) <= reach * reach;  // not where there is nothing
    };
    const auto seen = [&](size_t number) {
        const glm::vec3& point = finest_points_[number];
        if (is_near(number, point))
            return true;
        const auto row = static_cast<size_t>(side_);
        const size_t first = number - number % (row * row);  // the first sample of its picture
        const auto column = static_cast<int>(number % row);
        const auto line = static_cast<int>(number / row % row);
        for (int y = std::max(line - around, 0); y <= std::min(line + around, side_ - 1); ++y) {
            for (int x = std::max(column - around, 0); x <= std::min(column + around, side_ - 1);
                 ++x) {
                if (is_near(first + static_cast<size_t>(y) * row + static_cast<size_t>(x), point))
                    return true;
            }
        }
        return false;
    };
    std::vector<size_t> gaps;
    for (size_t i = 0; i < finest_points_.size(); ++i) {
        if (std::isfinite(finest_points_[i].x) && !seen(i))
            gaps.push_back(i);
    }
    const Pictures all = shown(stand_in, skin.get());
    // A stand-in that covers much less in all has lost things that nothing was near to.
    if (brightness_of(stand_in, skin).coverage < 1 - kMostCoverageOff)
        return agreement_size(all).error;
    if (gaps.empty())
        return 0;
    Pictures other = finest_;
    for (const size_t i : gaps)
        other[i] = all[i];
    const AgreementSize sizes = agreement_size(other);
    return sizes.smallest ? 0 : sizes.error;
}

}  // namespace lodestone::measure
