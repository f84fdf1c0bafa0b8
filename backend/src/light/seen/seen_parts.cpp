// SPDX-License-Identifier: GPL-3.0-or-later
#include "light/seen/seen_parts.h"

#include "base/parallel.h"
#include "base/random.h"
#include "choose/criterion.h"
#include "choose/view_pyramid.h"
#include "geometry/part_tree.h"
#include "light/seen/least_size.h"
#include "light/seen/random_place.h"
#include "light/seen/shadow_reaches.h"
#include "light/seen/sight_scene.h"

#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <optional>

namespace lodestone::light {
namespace {

// The rays through a pixel, and through all pixels together.
// Taste: more find smaller things behind gaps, for 3 to 10 us each with their shadows; with half as
// many the sky shows between trees where more trees are.
constexpr double kRaysOfPixel = 0.5;
constexpr double kMostRays = 1 << 20;  // Taste: as kRaysOfPixel
constexpr size_t kShadedRays = 2;      // Taste: as kRaysOfPixel; every other one looks for shadows
// The width of a part, in distances between rays: a part of which a quarter is seen is met.
// Taste: a larger value leaves out less, a smaller one misses more.
constexpr double kPartWidth = 6;
// The rays toward a part that no ray through the picture met, and from it along lights; fewer, but
// one, where all parts together would have more than the most.
// Taste: more find parts of which less is seen.
constexpr int kAims = 4;
constexpr int kShadowAims = 2;         // Taste: as kAims
constexpr size_t kMostAims = 1 << 21;  // Taste: some seconds
constexpr int kMostTries = 4;          // Taste: places of a part for each ray toward it
// The rays' distances squared that cover a part of which an eighth is seen, and which is missed in
// one of e cases.
// Law: one ray is expected to meet it.
constexpr double kOftenMissed = 8;
constexpr int kMostMirrors = 4;  // Taste: more in a row find things deeper in mirrors
// The tests of places and of things against lights, beyond which everything throws shadows.
// Taste: a second or so.
constexpr double kMostPlaceTests = 1e8;
constexpr double kMostThingTests = 1e7;  // Taste: as kMostPlaceTests
// The least part of its shadow's size that a thing near a lamp counts as.
// Taste: a smaller value takes meshes with a lamp in them apart further.
constexpr double kNearLamp = 0.125;

class SeenSearch {
public:
    SeenSearch(const Model& model, const RendererSurfaces& renderer,
               std::span<const DrawnThing> drawn, const View& view, std::span<const Light> lights,
               const Job& job)
        : drawn_(drawn),
          view_(view),
          job_(job),
          scene_(model, renderer, drawn, job),
          pyramid_(view),
          to_frame_(
              glm::inverse(glm::dmat3(view.camera.right, view.camera.up, view.camera.direction))),
          shadow_pixels_(drawn.size()) {
        first_.push_back(0);
        for (uint32_t i = 0; i < drawn.size(); ++i)
            first_.push_back(first_.back() + scene_.mesh(i).triangles.size());
        needs_.resize(first_.back(), 0);
        spacing_ = std::sqrt(static_cast<double>(view.width) * view.height / SeenParts::rays(view));
        lights_ = shadow_lights(lights);
        const auto count = static_cast<double>(lights_.size());
        all_shade_ = count * SeenParts::rays(view) > kMostPlaceTests ||
                     count * static_cast<double>(drawn.size()) > kMostThingTests;
        if (all_shade_)
            lights_.clear();
        reaches_.emplace(model, drawn, view, lights_, job);
    }

    /// False: not everything that is needed can be told.
    bool run() {
        look();
        if (bends_)
            return false;
        make_trees();
        spread(kSeen);
        aim();
        if (bends_)
            return false;
        spread(kShades);
        aim_shadows();
        shade_all();
        return true;
    }

    std::vector<size_t> first() { return std::move(first_); }
    std::vector<uint8_t> needs() { return std::move(needs_); }
    double covered() const { return static_cast<double>(met_) / SeenParts::rays(view_); }

private:
    /// The needs of a triangle, which any thread may add to.
    std::atomic_ref<uint8_t> needs_of(uint32_t drawn, uint32_t triangle) {
        return std::atomic_ref<uint8_t>(needs_[first_[drawn] + triangle]);
    }
    void note(uint32_t drawn, uint32_t triangle, uint8_t need) {
        needs_of(drawn, triangle).fetch_or(need, std::memory_order_relaxed);
    }

    /// Sends rays through all of the picture, one in each cell of a grid.
    void look() {
        const auto columns = static_cast<size_t>(std::ceil(view_.width / spacing_));
        const auto rows = static_cast<size_t>(std::ceil(view_.height / spacing_));
        parallel_for(rows, [&](size_t row) {
            job_.check();
            if (bends_)
                return;  // nobody asks for what is found
            const ray::FlushDenormals fast;
            PcgRandom random(3, row);
            LightPicker picker(lights_);
            for (size_t column = 0; column < columns; ++column) {
                const double x =
                    (static_cast<double>(column) + random.uniform()) / static_cast<double>(columns);
                const double y =
                    (static_cast<double>(row) + random.uniform()) / static_cast<double>(rows);
                const bool shaded = (row + column) % kShadedRays == 0;
                follow(sight_ray(view_, x, y), shaded, picker, random);
            }
        });
    }

    /// Notes what a ray meets, in mirrors too, and, of a shaded one, what throws shadows there.
    void follow(const SightRay& ray, bool shaded, LightPicker& picker, PcgRandom& random) {
        std::optional<SightWalk> walk = SightWalk{ray.origin, ray.direction};
        for (int mirrors = 0; walk; ++mirrors)
            walk = follow(*walk, mirrors < kMostMirrors, shaded, picker, random);
    }

    /// Notes what a walk meets; returns how it goes on from a mirror, if it does and `may_turn`.
    std::optional<SightWalk> follow(const SightWalk& walk, bool may_turn, bool shaded,
                                    LightPicker& picker, PcgRandom& random) {
        std::vector<SightCrossing> crossings;
        scene_.cross(walk, crossings);
        if (!crossings.empty() && walk.way == 0)  // from the eye
            met_.fetch_add(1, std::memory_order_relaxed);
        for (const SightCrossing& at : crossings) {
            note(at.drawn, at.triangle, kSeen);
            if (at.bends)
                bends_ = true;
            const SightNormals normals = normals_at(at, walk);
            if (normals.any && shaded)
                shade(at, normals, picker, random);
            // Some rays go on through what is half clear, and some are mirrored.
            if (!at.ends && !(at.mirrors && random.uniform() < 0.5))
                continue;
            if (!at.mirrors || !normals.any || !may_turn)
                return {};
            const glm::dvec3 direction = mirror_direction(walk.direction, normals.smooth);
            if (!(glm::dot(direction, normals.flat) > 0))
                return {};
            const glm::dvec3 origin = at.point + scene_.aside(at.way) * normals.flat;
            return SightWalk{origin, direction, kInfinity, kReflectionRays, at.way};
        }
        return {};
    }

    SightNormals normals_at(const SightCrossing& at, const SightWalk& walk) const {
        return sight_normals(scene_.mesh(at.drawn), drawn_[at.drawn].world, at.triangle, at.u, at.v,
                             walk.direction);
    }

    /// Notes what hides lights from a place that is seen.
    void shade(const SightCrossing& place, const SightNormals& normals, LightPicker& picker,
               PcgRandom& random) {
        const double pixel = choose::pixel_size(view_, place.way);
        for (const uint32_t number : picker.pick(place.point, normals.smooth, {}, random)) {
            const WayToLight way = way_to(lights_[number], place.point, random);
            SightWalk walk;
            walk.direction = way.direction;
            const double side = glm::dot(walk.direction, normals.flat) < 0 ? -1 : 1;
            if (side < 0 && !(glm::dot(walk.direction, normals.smooth) > 0))
                continue;
            walk.origin = place.point + side * scene_.aside(place.way) * normals.flat;
            walk.sees = kShadowRays;
            walk.way = place.way;
            walk.far = way.length;
            std::vector<SightCrossing> crossings;
            scene_.cross(walk, crossings);
            for (const SightCrossing& at : crossings) {
                note(at.drawn, at.triangle, kShades);
                // The shadow of a lamp is as much larger as it falls farther from the lamp.
                const double left =
                    std::max(kNearLamp, (way.length - (at.way - place.way)) / way.length);
                shadow_pixels_[at.drawn].note(lights_[number].sun ? pixel : left * pixel);
            }
        }
    }

    void make_trees() {
        trees_.resize(scene_.shapes());
        parallel_for(trees_.size(), [&](size_t shape) {
            job_.check();
            trees_[shape].emplace(scene_.mesh_of_shape(shape));
        });
    }

    /// Visits the parts of a thing that are no wider than `width(bound)` metres, or not halved.
    template <typename Width, typename Visit>
    void visit_parts(uint32_t drawn, const Width& width, const Visit& visit) const {
        const geometry::PartTree& tree = *trees_[scene_.shape(drawn)];
        for (size_t i = 0; i < tree.parts().size();) {
            const geometry::MeshPart& part = tree.parts()[i];
            const Bound own{part.box.center(), 0.5 * glm::length(part.box.size()), part.box};
            const Bound bound = transformed(own, drawn_[drawn].world);
            if (!tree.leaf(i) && 2 * bound.radius > width(bound)) {
                ++i;
                continue;
            }
            visit(tree.triangles(part), bound);
            i = part.next;
        }
    }
    double seen_width(const Bound& bound) const {
        return kPartWidth * spacing_ *
               choose::pixel_size(view_, distance(bound, view_.camera.position));
    }

    bool any(uint32_t drawn, std::span<const uint32_t> triangles, uint8_t need) {
        return std::any_of(triangles.begin(), triangles.end(), [&](uint32_t triangle) {
            return (needs_of(drawn, triangle).load(std::memory_order_relaxed) & need) != 0;
        });
    }
    void note_all(uint32_t drawn, std::span<const uint32_t> triangles, uint8_t need) {
        for (const uint32_t triangle : triangles)
            note(drawn, triangle, need);
    }

    /// Lets a part of which anything was met be needed as a whole.
    void spread(uint8_t need) {
        parallel_for(drawn_.size(), [&](size_t i) {
            const auto drawn = static_cast<uint32_t>(i);
            const double shadow = kPartWidth * spacing_ * shadow_pixels_[i].value();
            visit_parts(
                drawn,
                [&](const Bound& bound) { return need == kSeen ? seen_width(bound) : shadow; },
                [&](std::span<const uint32_t> triangles, const Bound&) {
                    if (any(drawn, triangles, need))
                        note_all(drawn, triangles, need);
                });
        });
    }

    /// The ray from the eye to a point, and the way; none to what is not in the picture.
    std::optional<SightWalk> walk_to(const glm::dvec3& point) const {
        const Camera& camera = view_.camera;
        const glm::dvec3 away = point - camera.position;
        const glm::dvec3 frame = to_frame_ * away;
        if (!(frame.z > 0))
            return {};
        const double scale = camera.orthographic ? 1 : frame.z;
        if (std::abs(frame.x) > 0.5 * scale || std::abs(frame.y) > 0.5 * scale)
            return {};
        SightWalk walk;
        const glm::dvec3 way = camera.orthographic ? frame.z * camera.direction : away;
        walk.origin = point - way;
        walk.far = glm::length(way);
        if (!(walk.far > 0))
            return {};
        walk.direction = way / walk.far;
        return walk;
    }

    /// The rays for each of the parts that need a look, `wanted` of them or fewer.
    template <typename NeedsLook>
    int aims_of(int wanted, const NeedsLook& needs_look) {
        std::atomic<size_t> parts{0};
        parallel_for(drawn_.size(), [&](size_t i) {
            const auto drawn = static_cast<uint32_t>(i);
            size_t count = 0;
            visit_parts(
                drawn, [&](const Bound& bound) { return seen_width(bound); },
                [&](std::span<const uint32_t> triangles, const Bound& bound) {
                    count += needs_look(drawn, triangles, bound) ? 1 : 0;
                });
            parts += count;
        });
        return static_cast<int>(std::clamp<size_t>(kMostAims / std::max<size_t>(parts, 1), 1,
                                                   static_cast<size_t>(wanted)));
    }

    /// The rays toward a part that no ray met, at most `most`: parts that are large in the picture
    /// are met where any of them is seen.
    int aims_at(uint32_t drawn, std::span<const uint32_t> triangles, const Bound& bound,
                int most) const {
        if (pyramid_.outside(bound))
            return most;  // no ray through the picture comes near
        const Mesh& mesh = scene_.mesh(drawn);
        const glm::dmat3& linear = drawn_[drawn].world.linear;
        double area = 0;
        for (const uint32_t triangle : triangles) {
            const Triangle& t = mesh.triangles[triangle];
            const glm::dvec3 a(mesh.positions[t.x]);
            const glm::dvec3 u = linear * (glm::dvec3(mesh.positions[t.y]) - a);
            const glm::dvec3 v = linear * (glm::dvec3(mesh.positions[t.z]) - a);
            area += glm::length(glm::cross(u, v)) / 2;
        }
        const double cell =
            spacing_ * choose::pixel_size(view_, distance(bound, view_.camera.position));
        // Law: a surface that is turned anyhow shows half of itself.
        const double missed = std::exp(-area / (2 * cell * cell) / kOftenMissed);
        return missed >= 0 ? std::max(1, static_cast<int>(std::ceil(most * missed))) : most;
    }

    /// Looks at the parts that no ray through the picture met.
    void aim() {
        const auto needs_look = [&](uint32_t drawn, std::span<const uint32_t> triangles,
                                    const Bound& bound) {
            return !pyramid_.outside(bound) && !any(drawn, triangles, kSeen);
        };
        const int aims = aims_of(kAims, needs_look);
        parallel_for(drawn_.size(), [&](size_t i) {
            const auto drawn = static_cast<uint32_t>(i);
            if ((drawn_[i].hidden & kCameraRays) != 0 || !drawn_[i].world.finite())
                return;
            job_.check();
            const ray::FlushDenormals fast;
            PcgRandom random(4, i);
            RandomPlace place(scene_.mesh(drawn), drawn_[i].world, random);
            LightPicker picker(lights_);
            visit_parts(
                drawn, [&](const Bound& bound) { return seen_width(bound); },
                [&](std::span<const uint32_t> triangles, const Bound& bound) {
                    job_.check();
                    if (!needs_look(drawn, triangles, bound))
                        return;
                    const int tries = aims_at(drawn, triangles, bound, aims);
                    const glm::dvec3 back = view_.camera.orthographic
                                                ? -view_.camera.direction
                                                : view_.camera.position - bound.center;
                    // Places out of the picture cost no ray.
                    for (int k = 0, rays = 0; rays < tries && k < kMostTries * tries; ++k) {
                        const uint32_t triangle = place.one_of(triangles, back);
                        const auto walk = walk_to(place.point_on(triangle));
                        if (!walk)
                            continue;
                        ++rays;
                        if (sees(drawn, triangle, *walk, picker, random)) {
                            note_all(drawn, triangles, kSeen);
                            return;
                        }
                    }
                });
        });
    }

    /// Whether the eye sees a triangle where a walk ends on it; its shadows are noted then.
    bool sees(uint32_t drawn, uint32_t triangle, SightWalk walk, LightPicker& picker,
              PcgRandom& random) {
        walk.far += scene_.aside(walk.far);
        std::vector<SightCrossing> crossings;
        scene_.cross(walk, crossings);
        const auto place = std::find_if(
            crossings.begin(), crossings.end(),
            [&](const SightCrossing& at) { return at.drawn == drawn && at.triangle == triangle; });
        if (place == crossings.end())
            return false;
        if (place->bends)
            bends_ = true;
        const SightNormals normals = normals_at(*place, walk);
        if (normals.any)
            shade(*place, normals, picker, random);
        return true;
    }

    /// Looks where the shadows fall of parts that no ray to a light met.
    void aim_shadows() {
        const int aims = aims_of(
            kShadowAims, [&](uint32_t drawn, std::span<const uint32_t> triangles, const Bound&) {
                return !reaches_->of(drawn).empty() && !any(drawn, triangles, kShades);
            });
        parallel_for(drawn_.size(), [&](size_t i) {
            const auto drawn = static_cast<uint32_t>(i);
            if (reaches_->of(i).empty())
                return;
            job_.check();
            const ray::FlushDenormals fast;
            PcgRandom random(5, i);
            RandomPlace place(scene_.mesh(drawn), drawn_[i].world, random);
            LightPicker picker(lights_);
            visit_parts(
                drawn, [&](const Bound& bound) { return seen_width(bound); },
                [&](std::span<const uint32_t> triangles, const Bound& bound) {
                    job_.check();
                    // Parts that are far away may be wider than those that were looked at above.
                    if (any(drawn, triangles, kShades)) {
                        note_all(drawn, triangles, kShades);
                        return;
                    }
                    const int tries = aims_at(drawn, triangles, bound, aims);
                    for (const uint32_t number :
                         picker.pick(bound.center, glm::dvec3(0.0), reaches_->of(drawn), random)) {
                        const ShadowLight& light = lights_[number];
                        if (!reaches_->seen(number, bound))
                            continue;
                        const glm::dvec3 on = -way_to(light, bound.center, random).direction;
                        for (int aim = 0; aim < tries; ++aim) {
                            const uint32_t triangle = place.one_of(triangles, on);
                            if (shows_shadow(place.point_on(triangle), light, random)) {
                                note_all(drawn, triangles, kShades);
                                return;
                            }
                        }
                    }
                });
        });
    }

    /// Whether the eye sees anything that lies in the shadow of a point.
    bool shows_shadow(const glm::dvec3& point, const ShadowLight& light, PcgRandom& random) {
        SightWalk down;
        down.direction = -way_to(light, point, random).direction;
        const double way = glm::length(point - view_.camera.position);
        down.origin = point + scene_.aside(way) * down.direction;
        std::vector<SightCrossing> crossings;
        std::vector<SightCrossing> before;
        scene_.cross(down, crossings);
        return std::any_of(crossings.begin(), crossings.end(), [&](const SightCrossing& at) {
            const bool seen =
                (needs_of(at.drawn, at.triangle).load(std::memory_order_relaxed) & kSeen) != 0;
            std::optional<SightWalk> walk = seen ? walk_to(at.point) : std::nullopt;
            if (!walk)
                return false;
            walk->far -= 2 * scene_.aside(walk->far);
            scene_.cross(*walk, before);
            return before.empty() || !before.back().ends;
        });
    }

    /// Where there are too many lights to look for, lets each thing be needed as a whole.
    void shade_all() {
        for (uint32_t i = 0; all_shade_ && i < drawn_.size(); ++i) {
            for (size_t k = first_[i]; (drawn_[i].hidden & kShadowRays) == 0 && k < first_[i + 1];)
                needs_[k++] |= kShades;
        }
    }

    std::span<const DrawnThing> drawn_;
    const View& view_;
    const Job& job_;
    SightScene scene_;
    choose::ViewPyramid pyramid_;
    glm::dmat3 to_frame_;
    double spacing_ = 1;  // of rays through the picture, in pixels
    std::vector<ShadowLight> lights_;
    bool all_shade_ = false;  // there are too many lights to look for
    std::optional<ShadowReaches> reaches_;
    std::vector<size_t> first_;
    std::vector<uint8_t> needs_;
    std::vector<LeastSize> shadow_pixels_;  // by drawn thing: of a pixel where its shadow is seen
    std::vector<std::optional<geometry::PartTree>> trees_;  // by shape
    std::atomic<bool> bends_{false};
    std::atomic<size_t> met_{0};  // rays through the picture that met anything
};

}  // namespace

double SeenParts::rays(const View& view) {
    const double pixels = static_cast<double>(view.width) * view.height;
    return std::max(1.0, std::min(kRaysOfPixel * pixels, kMostRays));
}

SeenParts::SeenParts(const Model& model, const RendererSurfaces& renderer,
                     std::span<const DrawnThing> drawn, const View& view,
                     std::span<const Light> lights, const Job& job) {
    SeenSearch search(model, renderer, drawn, view, lights, job);
    known_ = search.run();
    first_ = search.first();
    needs_ = search.needs();
    covered_ = std::min(1.0, search.covered());
    all_.resize(drawn.size(), 0);
    for (size_t i = 0; i < drawn.size(); ++i) {
        for (const uint8_t need : triangles(i))
            all_[i] |= need;
    }
}

}  // namespace lodestone::light
