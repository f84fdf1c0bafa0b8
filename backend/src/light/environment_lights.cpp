// SPDX-License-Identifier: GPL-3.0-or-later
#include "light/environment_lights.h"

#include "base/color.h"
#include "base/maths.h"
#include "image/texture_sampler.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace lodestone::light {
namespace {

// The width in texels to which pictures are reduced.
// Taste: more texels keep smaller suns apart and take longer; 128 are 2.8 degrees each.
constexpr int kWidth = 128;
// Law: an equirectangular picture is half as high as wide.
constexpr int kHeight = 64;
// The sides of the blocks of texels whose darkest one is the uniform sky.
// Taste: larger blocks find less of the light in the uniform sky.
constexpr int kSquare = 8;
// The directions of surfaces for which the strengths are fitted.
// Taste: more fit them more evenly and take longer.
constexpr int kNormals = 512;
// The largest radiance that counts.
// Taste: a larger one is a mistake of the picture's maker.
constexpr double kMost = 1e9;
// The rounds of spreading the suns.
// Taste: more spread them more evenly; they hardly move in the last ones.
constexpr int kRounds = 30;
// The sweeps of the fit.
// Taste: more change nothing; the fit stands still long before.
constexpr int kSweeps = 200;
// How much the fit is drawn to the strengths it starts from.
// Taste: a larger number keeps them nearer; without it, suns side by side differ by chance.
constexpr double kKeep = 1e-3;

struct SkyTexel {
    glm::dvec3 direction{0.0};  // the direction in which it is seen, in the world
    glm::dvec3 radiance{0.0};
    double solid_angle = 0;

    glm::dvec3 power() const { return radiance * solid_angle; }
};

class EnvironmentSky {
public:
    EnvironmentSky(const World& world, const image::TexelRows& picture)
        : width_(kWidth), height_(kHeight) {
        width_ = std::min(kWidth, picture.width());
        height_ = std::min(kHeight, picture.height());
        const bool turned = std::abs(glm::determinant(world.environment_turn)) > 1e-12;
        const glm::dmat3 to_world = turned ? glm::inverse(world.environment_turn) : glm::dmat3(1.0);
        texels_.resize(static_cast<size_t>(width_) * static_cast<size_t>(height_));
        for (int y = 0; y < height_; ++y) {
            const double low = kPi * y / height_;  // the angle from the zenith
            const double high = kPi * (y + 1) / height_;
            const std::vector<glm::dvec3> means = means_of(picture, y);
            for (int x = 0; x < width_; ++x) {
                SkyTexel& texel = at(x, y);
                const glm::dvec3 own =
                    equirectangular_direction((x + 0.5) / width_, 1 - (y + 0.5) / height_);
                texel.direction = glm::normalize(to_world * own);
                texel.solid_angle = (std::cos(low) - std::cos(high)) * 2 * kPi / width_;
                texel.radiance = means[static_cast<size_t>(x)] * world.environment_strength;
            }
        }
    }

    int width() const { return width_; }
    int height() const { return height_; }
    SkyTexel& at(int x, int y) {
        return texels_[static_cast<size_t>(y) * static_cast<size_t>(width_) +
                       static_cast<size_t>(x)];
    }
    const std::vector<SkyTexel>& texels() const { return texels_; }

    /// The power of a texel without the uniform sky; negative for a darker texel.
    glm::dvec3 above(const SkyTexel& texel) const {
        return (texel.radiance - uniform_) * texel.solid_angle;
    }

    /// Finds the radiance that every block of texels has.
    glm::dvec3 take_uniform() {
        glm::dvec3 least(kMost);
        for (int top = 0; top < height_; top += kSquare) {
            for (int left = 0; left < width_; left += kSquare) {
                glm::dvec3 sum(0.0);
                double weight = 0;
                for (int y = top; y < std::min(top + kSquare, height_); ++y) {
                    for (int x = left; x < std::min(left + kSquare, width_); ++x) {
                        sum += at(x, y).power();
                        weight += at(x, y).solid_angle;
                    }
                }
                least = glm::min(least, sum / weight);
            }
        }
        return uniform_ = least;
    }

private:
    /// The means of the picture's pixels that the texels of a row cover.
    std::vector<glm::dvec3> means_of(const image::TexelRows& picture, int y) const {
        const auto begin = [](int at, int count, int size) {
            return static_cast<int>(static_cast<int64_t>(at) * size / count);
        };
        std::vector<glm::dvec3> sums(static_cast<size_t>(width_), glm::dvec3(0.0));
        std::vector<double> counts(sums.size(), 0.0);
        std::vector<float> pixels(4 * static_cast<size_t>(picture.width()));
        for (int row = begin(y, height_, picture.height());
             row < begin(y + 1, height_, picture.height()); ++row) {
            picture.read(row, pixels.data());
            for (int x = 0; x < width_; ++x) {
                glm::dvec3& sum = sums[static_cast<size_t>(x)];
                for (int column = begin(x, width_, picture.width());
                     column < begin(x + 1, width_, picture.width()); ++column) {
                    const float* pixel = pixels.data() + 4 * static_cast<size_t>(column);
                    for (int c = 0; c < 3; ++c) {
                        const auto value = static_cast<double>(pixel[c]);
                        sum[c] += value > 0 ? std::min(value, kMost) : 0.0;  // false for a nan
                    }
                    ++counts[static_cast<size_t>(x)];
                }
            }
        }
        for (size_t x = 0; x < sums.size(); ++x)
            sums[x] /= std::max(counts[x], 1.0);
        return sums;
    }

    int width_;
    int height_;
    glm::dvec3 uniform_{0.0};
    std::vector<SkyTexel> texels_;
};

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

/// How wrong one sun for all of the region is: the power it sends, times its size squared.
double badness(const EnvironmentSky& sky, const SkyRegion& region) {
    const glm::dvec2 size = extent(sky, region);
    return region.divisible() ? region.brightness * glm::dot(size, size) : -1;
}

double brightness(EnvironmentSky& sky, const SkyRegion& region) {
    double sum = 0;
    for (int y = region.top; y < region.bottom; ++y) {
        for (int x = region.left; x < region.right; ++x)
            sum += std::max(0.0, luminance(sky.above(sky.at(x, y))));
    }
    return sum;
}

/// Cuts across the longer side, with half of the light on each side.
std::pair<SkyRegion, SkyRegion> cut(EnvironmentSky& sky, const SkyRegion& region) {
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

EnvironmentLight light_of(EnvironmentSky& sky, const SkyRegion& region) {
    EnvironmentLight light;
    glm::dvec3 middle(0.0);
    for (int y = region.top; y < region.bottom; ++y) {
        for (int x = region.left; x < region.right; ++x) {
            const SkyTexel& texel = sky.at(x, y);
            middle += texel.direction * std::max(0.0, luminance(sky.above(sky.at(x, y))));
            light.irradiance += sky.above(texel);
        }
    }
    light.irradiance = glm::max(light.irradiance, glm::dvec3(0.0));
    const double length = glm::length(middle);
    light.direction = length > 0 ? -middle / length : -sky.at(region.left, region.top).direction;
    return light;
}

/// Lloyd's iteration: every texel goes to its nearest sun, and every sun to the middle of its
/// texels' light. The remaining error of suns for regions, light times distance squared, falls with
/// each round; the straight cuts of the regions are no longer visible.
void spread(EnvironmentSky& sky, std::vector<EnvironmentLight>& lights) {
    std::vector<size_t> nearest(sky.texels().size(), 0);
    std::vector<glm::dvec3> middles(lights.size());
    for (int round = 0; round < kRounds; ++round) {
        std::fill(middles.begin(), middles.end(), glm::dvec3(0.0));
        for (size_t t = 0; t < nearest.size(); ++t) {
            const SkyTexel& texel = sky.texels()[t];
            double closest = -2;
            for (size_t i = 0; i < lights.size(); ++i) {
                const double cosine = -glm::dot(lights[i].direction, texel.direction);
                if (cosine > closest) {
                    closest = cosine;
                    nearest[t] = i;
                }
            }
            middles[nearest[t]] += texel.direction * std::max(0.0, luminance(sky.above(texel)));
        }
        for (size_t i = 0; i < lights.size(); ++i) {
            if (glm::length(middles[i]) > 0)
                lights[i].direction = -glm::normalize(middles[i]);
        }
    }
    for (EnvironmentLight& light : lights)
        light.irradiance = glm::dvec3(0.0);
    for (size_t t = 0; t < nearest.size(); ++t)
        lights[nearest[t]].irradiance += sky.above(sky.texels()[t]);
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

}  // namespace

glm::dvec3 equirectangular_direction(double u, double v) {
    const double turn = kPi * (1 - 2 * u);
    const double height = kPi * (v - 0.5);
    return {std::cos(height) * std::cos(turn), std::cos(height) * std::sin(turn), std::sin(height)};
}

EnvironmentLights environment_lights(const World& world, size_t count) {
    EnvironmentLights out;
    if (!world.environment)
        return out;
    const image::PackedPtr picture = image::packed(*world.environment);
    EnvironmentSky sky(world, image::TexelRows(*picture, world.environment->space));
    out.ambient = sky.take_uniform();
    std::vector<SkyRegion> regions{{0, 0, sky.width(), sky.height()}};
    regions[0].brightness = brightness(sky, regions[0]);
    while (regions.size() < count) {
        const auto worst = std::max_element(regions.begin(), regions.end(),
                                            [&](const SkyRegion& a, const SkyRegion& b) {
                                                return badness(sky, a) < badness(sky, b);
                                            });
        if (!(badness(sky, *worst) > 0))
            break;
        const auto [first, second] = cut(sky, *worst);
        *worst = first;
        regions.push_back(second);
    }
    for (const SkyRegion& region : regions) {
        if (region.brightness > 0 && out.lights.size() < count)
            out.lights.push_back(light_of(sky, region));
    }
    if (!out.lights.empty())
        spread(sky, out.lights);
    fit(sky, out);
    std::erase_if(out.lights, [](const EnvironmentLight& light) {
        return light.irradiance == glm::dvec3(0.0);
    });
    return out;
}

}  // namespace lodestone::light
