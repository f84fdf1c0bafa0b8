// SPDX-License-Identifier: GPL-3.0-or-later
#include "light/environment/environment_lights.h"

#include "base/color.h"
#include "base/maths.h"
#include "light/environment/environment_sky.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace lodestone::light {
namespace {

// The directions of surfaces for which the strengths are fitted.
// Taste: more fit them more evenly and take longer.
constexpr int kNormals = 512;
// The rounds of spreading the suns.
// Taste: more spread them more evenly; they hardly move in the last ones.
constexpr int kRounds = 30;
// The sweeps of the fit.
// Taste: more change nothing; the fit stands still long before.
constexpr int kSweeps = 200;
// How much the fit is drawn to the strengths it starts from.
// Taste: a larger number keeps them nearer; without it, suns side by side differ by chance.
constexpr double kKeep = 1e-3;
// The size of a peak, in radians, that is one sun however bright it is.
// Taste: four texels across; a smaller value makes several suns of one.
constexpr double kSunSize = 0.2;
// The suns of peaks that are wider, or apart, at least.
// Taste: fewer join lamps that are far apart.
constexpr size_t kFewestApart = 4;

struct SkyRegion {
    int left, top, right, bottom;  // texels; right and bottom are outside
    double brightness = 0;

    bool divisible() const { return right - left > 1 || bottom - top > 1; }
};

/// The width and height as seen from the middle, in radians.
glm::dvec2 extent(const EnvironmentSky& sky, const SkyRegion& region) {
    const double middle = kPi * (0.5 * (region.top + region.bottom) / sky.height() - 0.5);
    return {2 * kPi * (region.right - region.left) / sky.width() * std::cos(middle),
            kPi * (region.bottom - region.top) / sky.height()};
}

/// How wide the light of a region is, in radians: as a disk that spreads as far, wherever the
/// picture's edges are. 0 of what is no wider than a texel.
double width_of_light(const EnvironmentSky& sky, const SkyRegion& region) {
    glm::dvec3 middle(0.0);
    double power = 0;
    const auto visit = [&](const auto& add) {
        for (int y = region.top; y < region.bottom; ++y) {
            for (int x = region.left; x < region.right; ++x) {
                const double own = luminance(sky.at(x, y).above());
                if (own > 0)
                    add(sky.at(x, y).direction, own);
            }
        }
    };
    visit([&](const glm::dvec3& direction, double own) {
        middle += own * direction;
        power += own;
    });
    if (!(glm::length(middle) > 0))
        return power > 0 ? 2 * kPi : 0;
    middle = glm::normalize(middle);
    double spread = 0;  // times the angle squared
    visit([&](const glm::dvec3& direction, double own) {
        const double angle = std::acos(limited(glm::dot(middle, direction), -1, 1));
        spread += own * angle * angle;
    });
    // Law: a disk's mean squared distance from its middle is half of its radius squared.
    return std::max(0.0, 2 * std::sqrt(2 * spread / power) - kPi / sky.height());
}

/// How wrong one sun for all of the region is: the power it sends, times its size squared.
double badness(const EnvironmentSky& sky, const SkyRegion& region, double least_size) {
    const glm::dvec2 size = extent(sky, region);
    if (!region.divisible() || (least_size > 0 && width_of_light(sky, region) < least_size))
        return -1;
    return region.brightness * glm::dot(size, size);
}

/// The part of a region that has light above the base, or the region without any.
SkyRegion shrunk(const EnvironmentSky& sky, const SkyRegion& region) {
    SkyRegion out{region.right, region.bottom, region.left, region.top, region.brightness};
    for (int y = region.top; y < region.bottom; ++y) {
        for (int x = region.left; x < region.right; ++x) {
            if (!(luminance(sky.at(x, y).above()) > 0))
                continue;
            out.left = std::min(out.left, x);
            out.right = std::max(out.right, x + 1);
            out.top = std::min(out.top, y);
            out.bottom = std::max(out.bottom, y + 1);
        }
    }
    return out.left < out.right ? out : region;
}

double brightness(const EnvironmentSky& sky, const SkyRegion& region) {
    double sum = 0;
    for (int y = region.top; y < region.bottom; ++y) {
        for (int x = region.left; x < region.right; ++x)
            sum += std::max(0.0, luminance(sky.at(x, y).above()));
    }
    return sum;
}

/// Cuts across the longer side, with half of the light on each side.
std::pair<SkyRegion, SkyRegion> cut(const EnvironmentSky& sky, const SkyRegion& region) {
    const glm::dvec2 size = extent(sky, region);
    const bool columns =
        region.bottom - region.top < 2 || (size.x > size.y && region.right - region.left > 1);
    std::pair<SkyRegion, SkyRegion> halves{region, region};
    int& first_end = columns ? halves.first.right : halves.first.bottom;
    int& second_start = columns ? halves.second.left : halves.second.top;
    const int start = columns ? region.left : region.top;
    const int end = columns ? region.right : region.bottom;
    double sum = 0;
    int at = start + 1;
    for (; at < end; ++at) {
        SkyRegion line = region;
        (columns ? line.left : line.top) = at - 1;
        (columns ? line.right : line.bottom) = at;
        const double more = brightness(sky, line);
        if (at > start + 1 && sum + more / 2 > region.brightness / 2) {
            --at;
            break;
        }
        sum += more;
    }
    first_end = second_start = std::clamp(at, start + 1, end - 1);
    halves.first.brightness = brightness(sky, halves.first);
    halves.second.brightness = brightness(sky, halves.second);
    return halves;
}

EnvironmentLight light_of(const EnvironmentSky& sky, const SkyRegion& region) {
    EnvironmentLight light;
    glm::dvec3 middle(0.0);
    for (int y = region.top; y < region.bottom; ++y) {
        for (int x = region.left; x < region.right; ++x) {
            const SkyTexel& texel = sky.at(x, y);
            middle += texel.direction * std::max(0.0, luminance(sky.at(x, y).above()));
            light.irradiance += texel.above();
        }
    }
    light.irradiance = glm::max(light.irradiance, glm::dvec3(0.0));
    const double length = glm::length(middle);
    light.direction = length > 0 ? -middle / length : -sky.at(region.left, region.top).direction;
    return light;
}

size_t nearest_light(const std::vector<EnvironmentLight>& lights, const glm::dvec3& direction) {
    size_t nearest = 0;
    double closest = -2;
    for (size_t i = 0; i < lights.size(); ++i) {
        const double cosine = -glm::dot(lights[i].direction, direction);
        if (cosine > closest) {
            closest = cosine;
            nearest = i;
        }
    }
    return nearest;
}

/// Lloyd's iteration: every texel goes to its nearest sun, and every sun to the middle of its
/// texels' light. The remaining error of suns for regions, light times distance squared, falls with
/// each round; the straight cuts of the regions are no longer visible.
void spread(const EnvironmentSky& sky, std::vector<EnvironmentLight>& lights) {
    std::vector<size_t> nearest(sky.texels().size(), 0);
    std::vector<glm::dvec3> middles(lights.size());
    for (int round = 0; round < kRounds; ++round) {
        std::fill(middles.begin(), middles.end(), glm::dvec3(0.0));
        for (size_t t = 0; t < nearest.size(); ++t) {
            const SkyTexel& texel = sky.texels()[t];
            nearest[t] = nearest_light(lights, texel.direction);
            middles[nearest[t]] += texel.direction * std::max(0.0, luminance(texel.above()));
        }
        for (size_t i = 0; i < lights.size(); ++i) {
            if (glm::length(middles[i]) > 0)
                lights[i].direction = -glm::normalize(middles[i]);
        }
    }
    for (EnvironmentLight& light : lights)
        light.irradiance = glm::dvec3(0.0);
    for (size_t t = 0; t < nearest.size(); ++t)
        lights[nearest[t]].irradiance += sky.texels()[t].above();
    for (EnvironmentLight& light : lights)
        light.irradiance = glm::max(light.irradiance, glm::dvec3(0.0));
}

/// Directions that are evenly spread over the sphere (a golden spiral).
std::vector<glm::dvec3> normals() {
    std::vector<glm::dvec3> out;
    for (int i = 0; i < kNormals; ++i) {
        const double z = 1 - (2 * i + 1.0) / kNormals;
        const double angle = i * kPi * (3 - std::sqrt(5.0));
        const double r = std::sqrt(1 - z * z);
        out.emplace_back(r * std::cos(angle), r * std::sin(angle), z);
    }
    return out;
}

/// Non-negative least squares, one strength at a time: the light that each normal receives from the
/// suns and the uniform sky (the last unknown), compared with the light from the picture.
void fit(const EnvironmentSky& sky, EnvironmentLights& lights) {
    const size_t count = lights.lights.size() + 1;
    std::vector<double> gram(count * count, 0.0);
    std::vector<glm::dvec3> wanted(count, glm::dvec3(0.0));
    std::vector<double> received(count, kPi);
    for (const glm::dvec3& normal : normals()) {
        glm::dvec3 target(0.0);
        for (const SkyTexel& texel : sky.texels())
            target += texel.power() * std::max(0.0, glm::dot(normal, texel.direction));
        for (size_t i = 0; i + 1 < count; ++i)
            received[i] = std::max(0.0, -glm::dot(normal, lights.lights[i].direction));
        for (size_t i = 0; i < count; ++i) {
            wanted[i] += received[i] * target;
            for (size_t k = 0; k < count; ++k)
                gram[i * count + k] += received[i] * received[k];
        }
    }
    const EnvironmentLights start = lights;
    const auto strength = [count](auto& of, size_t i) -> auto& {
        return i + 1 < count ? of.lights[i].irradiance : of.ambient;
    };
    for (int sweep = 0; sweep < kSweeps; ++sweep) {
        for (size_t i = 0; i < count; ++i) {
            const double keep = kKeep * gram[i * count + i];
            glm::dvec3 rest = wanted[i] + keep * strength(start, i);
            for (size_t k = 0; k < count; ++k) {
                if (k != i)
                    rest -= gram[i * count + k] * strength(lights, k);
            }
            strength(lights, i) = glm::max(glm::dvec3(0.0), rest / (gram[i * count + i] + keep));
        }
    }
}

/// The lights of at most `count` regions of about equal badness, of which those that are smaller
/// (radians) are not divided.
std::vector<EnvironmentLight> lights_of(const EnvironmentSky& sky, size_t count,
                                        double least_size) {
    std::vector<EnvironmentLight> out;
    std::vector<SkyRegion> regions{shrunk(sky, {0, 0, sky.width(), sky.height()})};
    regions[0].brightness = brightness(sky, regions[0]);
    while (regions.size() < count) {
        const auto worst = std::max_element(
            regions.begin(), regions.end(), [&](const SkyRegion& a, const SkyRegion& b) {
                return badness(sky, a, least_size) < badness(sky, b, least_size);
            });
        if (!(badness(sky, *worst, least_size) > 0))
            break;
        const auto [first, second] = cut(sky, *worst);
        *worst = shrunk(sky, first);
        regions.push_back(shrunk(sky, second));
    }
    for (const SkyRegion& region : regions) {
        if (region.brightness > 0 && out.size() < count)
            out.push_back(light_of(sky, region));
    }
    if (!out.empty())
        spread(sky, out);
    return out;
}

/// Joins lights that stand for parts of one sun, through which a cut went.
void join_near(std::vector<EnvironmentLight>& lights) {
    for (size_t i = 0; i < lights.size(); ++i) {
        for (size_t k = i + 1; k < lights.size();) {
            if (glm::dot(lights[i].direction, lights[k].direction) < std::cos(kSunSize / 2)) {
                ++k;
                continue;
            }
            lights[i].direction =
                glm::normalize(luminance(lights[i].irradiance) * lights[i].direction +
                               luminance(lights[k].irradiance) * lights[k].direction);
            lights[i].irradiance += lights[k].irradiance;
            lights.erase(lights.begin() + static_cast<std::ptrdiff_t>(k));
        }
    }
}

void drop_dark(std::vector<EnvironmentLight>& lights) {
    std::erase_if(
        lights, [](const EnvironmentLight& light) { return light.irradiance == glm::dvec3(0.0); });
}

}  // namespace

EnvironmentLights environment_lights(const World& world, size_t count) {
    EnvironmentLights out;
    if (!world.environment)
        return out;
    EnvironmentSky sky(world);
    out.ambient = sky.take_uniform();
    out.lights = lights_of(sky, count, 0);
    fit(sky, out);
    drop_dark(out.lights);
    return out;
}

EnvironmentLights environment_peaks(const World& world, size_t count) {
    EnvironmentLights out;
    if (!world.environment)
        return out;
    EnvironmentSky sky(world);
    sky.take_below_peaks();
    double peaks = 0;
    double all = 0;
    for (const SkyTexel& texel : sky.texels()) {
        peaks += luminance(texel.above());
        all += luminance(texel.power());
    }
    out.uneven = std::make_shared<UnevenSky>(sky);
    out.ambient = out.uneven->color();
    if (!(peaks > 0))
        return out;
    // Each light stands for as much as one of all the sky's would; peaks far apart are several.
    const double width = width_of_light(sky, {0, 0, sky.width(), sky.height()});
    const size_t least = width > kSunSize ? std::min(kFewestApart, count) : 0;
    const double wanted = std::ceil(static_cast<double>(count) * peaks / all);
    out.lights = lights_of(sky, std::max(static_cast<size_t>(wanted), least), kSunSize);
    drop_dark(out.lights);
    join_near(out.lights);
    if (out.lights.size() == 1)  // the shadows of several blur one another
        out.lights[0].angle = width;
    return out;
}

}  // namespace lodestone::light
