// SPDX-License-Identifier: GPL-3.0-or-later
#include "cards/card_light.h"

#include "base/parallel.h"
#include "cards/card_normals.h"
#include "cards/card_views.h"
#include "measure/pictures/cube_views.h"
#include "measure/pictures/glass_rays.h"
#include "measure/visible/sobol_points.h"
#include "measure/visible/visible_sampler.h"

#include <glm/common.hpp>

#include <algorithm>
#include <cmath>

namespace lodestone::cards {
namespace {

// Rays along a side of a view.
// Taste: more know the light better, in time that grows with the square.
constexpr size_t kLightRow = 40;
// Suns of each view.
// Taste: more know better what each side of a crown shows, in time in proportion.
constexpr size_t kSuns = 8;

/// The suns of a view, of all that fill the half sphere above evenly.
std::vector<glm::dvec3> suns_of(size_t view) {
    std::vector<glm::dvec3> out;
    for (size_t i = 0; i < kSuns; ++i)
        out.push_back(measure::sky_direction(view * kSuns + i));
    return out;
}

/// The light that a view shows under each of its suns: sums by color over all rays, and the rays
/// that meet anything.
struct ShownLight {
    std::vector<glm::dvec3> light = std::vector<glm::dvec3>(kSuns, glm::dvec3(0.0));
    double rays = 0;

    void add(size_t sun, const glm::dvec3& color, double facing) {
        light[sun] +=
            (measure::kSkyShare + (1 - measure::kSkyShare) * std::max(facing, 0.0)) * color;
    }
};

/// A view of the thing and of its cards.
struct LitView {
    ShownLight wanted;
    ShownLight upright;
    ShownLight level;

    /// The mean light of what is covered.
    glm::dvec3 wanted_light(size_t sun) const { return wanted.light[sun] / wanted.rays; }
    glm::dvec3 light_of(const ShownLight& some, size_t sun) const {
        return some.light[sun] / (upright.rays + level.rays);
    }
    bool shows_both() const { return wanted.rays > 0 && upright.rays + level.rays > 0; }
};

/// The cards as rays meet them.
struct LitCards {
    const CardPicture& picture;
    std::span<const CardPlane> planes;
    std::vector<std::array<SideNormals, 2>> normals = {};

    LitCards(const CardPicture& of_all, std::span<const CardPlane> of_cards)
        : picture(of_all), planes(of_cards) {
        for (size_t i = 0; i < planes.size(); ++i) {
            const glm::dvec3 face = planes[i].normal();
            normals.push_back({SideNormals(picture.normals[i][0], face),
                               SideNormals(picture.normals[i][1], -face)});
        }
    }

    bool shade(const glm::dvec3& from, size_t own, const glm::dvec3& sun) const {
        for (size_t card = 0; card < planes.size(); ++card) {
            if (card == own)
                continue;
            const auto met = crossing_of(planes[card], picture.patches[card], picture, from, sun);
            if (met && met->distance > 0 && met->shows(picture))
                return true;
        }
        return false;
    }

    /// Adds what a ray shows, each side with the light of its own normals. `along`: unit.
    void add(LitView& view, const glm::dvec3& origin, const glm::dvec3& along,
             const std::vector<glm::dvec3>& suns) const {
        std::optional<CardCrossing> nearest;
        size_t card = 0;
        for (size_t i = 0; i < planes.size(); ++i) {
            const auto met = crossing_of(planes[i], picture.patches[i], picture, origin, along);
            if (met && met->shows(picture) && (!nearest || met->distance < nearest->distance)) {
                nearest = met;
                card = i;
            }
        }
        if (!nearest)
            return;
        const glm::dvec3 color(nearest->texel(picture));
        const CardPlane& plane = planes[card];
        const size_t side = glm::dot(plane.normal(), along) < 0 ? 0 : 1;
        const glm::dvec3 face = side == 0 ? plane.normal() : -plane.normal();
        const glm::dvec3 point = origin + nearest->distance * along;
        const glm::dvec3 arm = point - plane.middle;
        glm::dvec3 normal = normals[card][side].at({glm::dot(arm, plane.right) / plane.half_size.x,
                                                    glm::dot(arm, plane.up) / plane.half_size.y});
        if (glm::dot(normal, along) > 0)
            normal = -normal;
        ShownLight& shown = plane.upright() ? view.upright : view.level;
        ++shown.rays;
        for (size_t sun = 0; sun < suns.size(); ++sun) {
            // The other side of the card shades what only the normal turns to the sun.
            const double facing = glm::dot(normal, suns[sun]);
            const bool lit =
                facing > 0 && glm::dot(face, suns[sun]) > 0 && !shade(point, card, suns[sun]);
            shown.add(sun, color, lit ? facing : 0);
        }
    }
};

/// Factors of one channel by least squares, near one factor for both where views do not tell them
/// apart. Differences count as they are seen: those of roots (a display's curve, nearly), which are
/// those of light over the root of light.
glm::dvec2 factors_of(const std::vector<LitView>& views, int channel) {
    // Views that are darker than that share of the mean count as if they were as bright.
    // Taste: a smaller value lets what is black rule.
    constexpr double kDark = 0.1;
    // How much one factor for both counts beside what views tell.
    // Taste: a larger value leaves differences where few views show one kind.
    constexpr double kTogether = 1e-3;
    // The most that colors change.
    // Taste: a larger value lets few texels stand for all light.
    constexpr double kMost = 4;
    double mean = 0;
    double count = 0;
    for (const LitView& view : views) {
        for (size_t sun = 0; sun < kSuns && view.shows_both(); ++sun, ++count)
            mean += view.wanted_light(sun)[channel];
    }
    if (!(mean > 0))
        return glm::dvec2(1.0);
    mean /= count;
    glm::dmat2 squares(0.0);
    glm::dvec2 products(0.0);
    double all = 0;
    double one = 0;
    for (const LitView& view : views) {
        for (size_t sun = 0; sun < kSuns && view.shows_both(); ++sun) {
            const double wanted = view.wanted_light(sun)[channel];
            const glm::dvec2 shown(view.light_of(view.upright, sun)[channel],
                                   view.light_of(view.level, sun)[channel]);
            const double weight = 1 / std::max(wanted, kDark * mean);
            squares += weight * glm::outerProduct(shown, shown);
            products += weight * wanted * shown;
            all += weight * (shown.x + shown.y) * (shown.x + shown.y);
            one += weight * (shown.x + shown.y) * wanted;
        }
    }
    if (!(all > 0))
        return glm::dvec2(1.0);
    const double sure = kTogether * all;
    const glm::dvec2 out =
        glm::inverse(squares + glm::dmat2(sure)) * (products + glm::dvec2(sure * one / all));
    return glm::clamp(out, glm::dvec2(1 / kMost), glm::dvec2(kMost));
}

}  // namespace

void match_light(CardPicture& picture, std::span<const CardPlane> planes, const Mesh& mesh,
                 const ray::MeshScene& scene, const ray::MeshSkin& skin, uint64_t seed,
                 const Job& job) {
    const std::vector<glm::dvec3> directions = SkyDirections{}.all();
    const CardBall ball(planes);
    const LitCards cards(picture, planes);
    const double lift = measure::ray_lift(ball.radius);
    std::vector<LitView> views(directions.size());
    parallel_for(views.size(), [&](size_t number) {
        job.check();
        const ray::FlushDenormals burst;
        ray::RecentBlockers blockers;
        const glm::dvec3& towards = directions[number];
        const glm::dmat3 frame = measure::picture_frame(towards);
        const std::vector<glm::dvec3> suns = suns_of(number);
        LitView& view = views[number];
        for (size_t ray = 0; ray < kLightRow * kLightRow; ++ray) {
            const auto u = measure::jitter(measure::scramble(seed + number), ray);
            const size_t line = ray / kLightRow;
            const size_t column = ray % kLightRow;
            const double x = 2 * (static_cast<double>(column) + u[0]) / double{kLightRow} - 1;
            const double y = 2 * (static_cast<double>(line) + u[1]) / double{kLightRow} - 1;
            const glm::dvec3 origin = ball.center + ball.radius * (frame * glm::dvec3(x, y, 2));
            cards.add(view, origin, -towards, suns);
            const ray::RayHit hit = scene.first_hit(origin, -towards);
            const glm::dvec3 area = hit.hit ? area_vector(mesh, hit.triangle) : glm::dvec3(0.0);
            if (!(glm::length(area) > 0))
                continue;
            ++view.wanted.rays;
            const glm::dvec3 color = skin.at(mesh, hit.triangle, hit.u, hit.v).color;
            const glm::dvec3 normal = measure::normal_at(mesh, hit, towards);
            const glm::dvec3 face = glm::normalize(glm::dot(area, towards) < 0 ? -area : area);
            for (size_t sun = 0; sun < suns.size(); ++sun) {
                const double facing = glm::dot(normal, suns[sun]);
                const bool lit =
                    facing > 0 && !scene.occluded(hit.point + lift * face, suns[sun], blockers);
                view.wanted.add(sun, color, lit ? facing : 0);
            }
        }
    });
    for (int channel = 0; channel < 3; ++channel) {
        const glm::dvec2 factors = factors_of(views, channel);
        for (size_t card = 0; card < planes.size(); ++card) {
            const auto factor = static_cast<float>(planes[card].upright() ? factors.x : factors.y);
            const CardPatch& patch = picture.patches[card];
            for (int row = patch.top; row < patch.top + patch.height; ++row) {
                for (int column = patch.left; column < patch.left + patch.width; ++column)
                    picture.texels[picture.index(column, row)][channel] *= factor;
            }
        }
    }
}

}  // namespace lodestone::cards
