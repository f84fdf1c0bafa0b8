// SPDX-License-Identifier: GPL-3.0-or-later
#include "cards/card_picture.h"

#include "base/color.h"
#include "base/parallel.h"
#include "image/texture_sampler.h"
#include "measure/pictures/glass_rays.h"
#include "measure/visible/sobol_points.h"

#include <glm/common.hpp>
#include <glm/matrix.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

namespace lodestone::cards {
namespace {

// Rays along a side of a texel, from each side of the card.
// Taste: more know coverage and color better, in time that grows with the square.
constexpr int kRays = 2;
// Clear texels around each card.
// Law: linear interpolation reads one texel beyond the border.
constexpr int kGutter = 1;
// The longest side of a picture.
// Law: image::TexelCache's, by which levels are measured: what it shrinks is measured as half there.
constexpr int kMostTexels = 256;
// The most planes of a picture.
// Law: the clear texels around so many are half of kMostTexels.
constexpr int kMostPlanes = 64;

/// The rays of one texel: where it begins and how large it is in its plane (-1...1).
struct TexelRays {
    const CardPlane& plane;
    double far = 0;  // metres to their origins, before all of the mesh
    glm::dvec2 low{0.0};
    glm::dvec2 step{0.0};
    uint64_t number = 0;

    /// Adds the normals that are seen from both sides to `normals`.
    glm::vec4 shown(const Mesh& mesh, const ray::MeshScene& scene, const ray::MeshSkin& skin,
                    std::array<SeenNormals, 2>& normals) const {
        glm::dvec3 color(0.0);
        int hits = 0;
        for (int ray = 0; ray < 2 * kRays * kRays; ++ray) {
            const std::array<double, 2> u = measure::jitter(number, static_cast<uint64_t>(ray));
            const int cell = ray / 2;
            const int line = cell / kRays;
            const glm::dvec2 at =
                low + step * glm::dvec2(cell % kRays + u[0], line + u[1]) / double{kRays};
            const glm::dvec3 towards = ray % 2 == 0 ? plane.normal() : -plane.normal();
            const ray::RayHit hit = scene.first_hit(plane.at(at.x, at.y) + far * towards, -towards);
            if (!hit.hit)
                continue;
            normals[ray % 2].add(at, measure::normal_at(mesh, hit, towards));
            color += skin.at(mesh, hit.triangle, hit.u, hit.v).color;
            ++hits;
        }
        if (hits == 0)
            return glm::vec4(0.0F);
        return {glm::vec3(color / static_cast<double>(hits)),
                static_cast<float>(hits) / static_cast<float>(2 * kRays * kRays)};
    }
};

/// The mean color of the texels around one that are known; none where none is.
std::optional<glm::vec3> color_around(const CardPicture& picture, const std::vector<uint8_t>& known,
                                      int column, int row) {
    glm::vec3 sum(0.0F);
    int count = 0;
    for (int y = std::max(0, row - 1); y <= std::min(picture.height - 1, row + 1); ++y) {
        for (int x = std::max(0, column - 1); x <= std::min(picture.width - 1, column + 1); ++x) {
            if (known[picture.index(x, y)] == 0)
                continue;
            sum += glm::vec3(picture.texels[picture.index(x, y)]);
            ++count;
        }
    }
    return count > 0 ? std::optional(sum / static_cast<float>(count)) : std::nullopt;
}

/// The mean color of all that is covered.
glm::vec3 mean_color(const CardPicture& picture) {
    glm::dvec4 sum(0.0);
    for (const glm::vec4& texel : picture.texels)
        sum += double{texel.w} * glm::dvec4(glm::dvec3(texel), 1);
    return sum.w > 0 ? glm::vec3(glm::dvec3(sum) / sum.w) : glm::vec3(0.0F);
}

}  // namespace

void SeenNormals::add(const glm::dvec2& at, const glm::dvec3& normal) {
    const glm::dvec3 basis(1, at.x, at.y);
    squares_ += glm::outerProduct(basis, basis);
    sums_ += glm::outerProduct(normal, basis);
}

void SeenNormals::add(const SeenNormals& other) {
    squares_ += other.squares_;
    sums_ += other.sums_;
}

glm::dvec3 SeenNormals::at(const glm::dvec2& place) const {
    // Keeps the squares invertible where few points were seen, or in one line.
    // Taste: so many points at the corners of the card.
    constexpr double kSure = 1;
    return sums_ * (glm::inverse(squares_ + glm::dmat3(kSure)) * glm::dvec3(1, place.x, place.y));
}

CardPicture picture_of_cards(std::span<const CardPlane> planes, int texels) {
    double longest = 0;
    double wide = 0;
    for (const CardPlane& plane : planes) {
        longest = std::max({longest, plane.half_size.x, plane.half_size.y});
        wide += plane.half_size.x;
    }
    CardPicture out;
    if (!(longest > 0) || planes.size() > kMostPlanes)
        return out;
    const double gutters = 2.0 * kGutter * static_cast<double>(planes.size());
    const double scale = std::min({texels / longest, (kMostTexels - gutters) / wide,
                                   (kMostTexels - 2.0 * kGutter) / longest});
    const auto count = [&](double half_size) {
        return std::max(1, static_cast<int>(scale * half_size));
    };
    for (const CardPlane& plane : planes) {
        const CardPatch patch{out.width + kGutter, kGutter, count(plane.half_size.x),
                              count(plane.half_size.y)};
        out.patches.push_back(patch);
        out.width += patch.width + 2 * kGutter;
        out.height = std::max(out.height, patch.height + 2 * kGutter);
    }
    out.texels.assign(static_cast<size_t>(out.width) * static_cast<size_t>(out.height),
                      glm::vec4(0.0F));
    return out;
}

void cast_picture(CardPicture& picture, std::span<const CardPlane> planes, const Mesh& mesh,
                  const ray::MeshScene& scene, const ray::MeshSkin& skin, uint64_t seed,
                  const Job& job) {
    const double far = 2 * bound_of(mesh.positions).radius;
    for (size_t card = 0; card < planes.size(); ++card) {
        const CardPatch& patch = picture.patches[card];
        const glm::dvec2 step(2.0 / patch.width, 2.0 / patch.height);
        std::vector<std::array<SeenNormals, 2>> normals(static_cast<size_t>(patch.height));
        parallel_for(normals.size(), [&](size_t line) {
            job.check();
            const ray::FlushDenormals burst;
            const auto row = static_cast<int>(line);
            for (int column = 0; column < patch.width; ++column) {
                const size_t at = picture.index(patch.left + column, patch.top + row);
                const TexelRays rays{planes[card],
                                     far,
                                     {-1 + column * step.x, 1 - (row + 1) * step.y},
                                     step,
                                     measure::scramble(seed + at)};
                picture.texels[at] = rays.shown(mesh, scene, skin, normals[line]);
            }
        });
        picture.normals.emplace_back();
        for (const std::array<SeenNormals, 2>& line : normals) {
            for (size_t side = 0; side < line.size(); ++side)
                picture.normals.back()[side].add(line[side]);
        }
    }
}

void fill_clear(CardPicture& picture) {
    // So many texels around what is covered have the color of their neighbors, all others the mean.
    // Taste: a larger number keeps colors apart when a picture is shrunk more.
    constexpr int kRounds = 8;
    const glm::vec4 mean(mean_color(picture), 0.0F);
    std::vector<uint8_t> known(picture.texels.size(), 0);
    for (size_t i = 0; i < known.size(); ++i) {
        known[i] = picture.texels[i].w > 0 ? 1 : 0;
        if (known[i] == 0)
            picture.texels[i] = mean;
    }
    for (int round = 0; round < kRounds; ++round) {
        const std::vector<uint8_t> before = known;
        for (int row = 0; row < picture.height; ++row) {
            for (int column = 0; column < picture.width; ++column) {
                const size_t at = picture.index(column, row);
                if (before[at] != 0)
                    continue;
                const std::optional<glm::vec3> color = color_around(picture, before, column, row);
                if (!color)
                    continue;
                picture.texels[at] = glm::vec4(*color, 0.0F);
                known[at] = 1;
            }
        }
    }
}

Texture texture_of(const CardPicture& picture) {
    float brightest = 0;
    for (const glm::vec4& texel : picture.texels)
        brightest = std::max({brightest, texel.x, texel.y, texel.z});
    brightest = brightest > 0 ? std::min(brightest, 1.0F) : 1.0F;
    image::Image image;
    image.width = picture.width;
    image.height = picture.height;
    image.pixels.reserve(4 * picture.texels.size());
    for (const glm::vec4& texel : picture.texels) {
        for (int i = 0; i < 3; ++i)
            image.pixels.push_back(encode_srgb(std::clamp(texel[i] / brightest, 0.0F, 1.0F)));
        image.pixels.push_back(texel.w);
    }
    Texture out;
    out.picture = image::make_picture(image::packed(image), image::PngEffort::Small,
                                      ColorSpace::Srgb, "cards");
    out.extension = TextureExtension::Extend;
    out.scale = glm::dvec3(brightest);
    return out;
}

}  // namespace lodestone::cards
