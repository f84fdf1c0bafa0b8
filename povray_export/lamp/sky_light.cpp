// SPDX-License-Identifier: GPL-3.0-or-later
#include "povray_export/lamp/sky_light.h"

#include "base/color.h"
#include "base/maths.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <cmath>

namespace lodestone::povray {

namespace {

// The steps of a factor.
// Taste: fine enough to keep means, coarse enough that rounding does not make other files.
constexpr double kFactorSteps = 256;

}  // namespace

double stepped_factor(double factor) {
    return std::round(limited(factor, 0, 1) * kFactorSteps) / kFactorSteps;
}

glm::dvec3 stepped_slope(const glm::dvec3& slope, double size) {
    const double step = std::exp2(std::floor(-std::log2(kFactorSteps * size)));
    const glm::dvec3 out = glm::round(slope / step) * step;
    return finite(out) ? out : glm::dvec3(0.0);
}

SkyLightPtr sky_light(Hash shares_hash, std::shared_ptr<const light::SkyShares> shares,
                      const PlacementShade& around, const Box3& box, const glm::dvec3& color) {
    auto out = std::make_shared<SkyLight>();
    out->color = color;
    out->factor = stepped_factor(around.middle);
    out->slope = stepped_slope(around.slope, glm::length(box.size()));
    if (out->slope != glm::dvec3(0.0))
        out->middle = box.center();
    out->hash = Hasher()
                    .value(shares_hash)
                    .value(out->factor)
                    .value(out->slope.x)
                    .value(out->slope.y)
                    .value(out->slope.z)
                    .text(shares->bytes())
                    .result();
    out->shares = std::move(shares);
    return out;
}

SkyLightPtr even_sky_light(double factor) {
    auto light = std::make_shared<SkyLight>();
    light->factor = stepped_factor(factor);
    light->hash = Hasher().value(light->factor).result();
    return light;
}

double share_of_grade(uint8_t grade) {
    const double root = static_cast<double>(grade) / (kSkyGrades - 1);
    return root * root;
}

uint8_t grade_of_share(double share) {
    return static_cast<uint8_t>(std::lround((kSkyGrades - 1) * std::sqrt(limited(share, 0, 1))));
}

glm::dvec3 factors_of_tint(const SkyTint& tint, const glm::dvec3& color) {
    const double whole = luminance(color);
    const double green = luminance(glm::dvec3(0, color.y, 0));
    glm::dvec3 factors(std::exp2(tint.x), 0, std::exp2(tint.y));
    if (green > 0)  // the rest of the luminance
        factors.y = std::max(0.0, (whole - luminance(color * factors)) / green);
    const double tinted = luminance(color * factors);
    return tinted > 0 ? factors * (whole / tinted) : glm::dvec3(1.0);
}

SkyTint SkyLight::tint(size_t triangle, int corner) const {
    if (!shares || shares->tints.empty())
        return SkyTint(0.0);
    const size_t at = 2 * (3 * triangle + static_cast<size_t>(corner));
    return {light::octaves_of_tint(shares->tints.at(at)),
            light::octaves_of_tint(shares->tints.at(at + 1))};
}

double SkyLight::share(size_t triangle, int corner, const glm::vec3& at) const {
    if (!shares)
        return factor;
    const uint8_t byte = shares->corners.at(3 * triangle + static_cast<size_t>(corner));
    const double here = limited(factor + glm::dot(slope, glm::dvec3(at) - middle), 0, 1);
    return here * light::share_of_byte(byte);
}

}  // namespace lodestone::povray
