// SPDX-License-Identifier: GPL-3.0-or-later
#include "measure/deviation/surface_deviation.h"

#include "base/parallel.h"
#include "geometry/primitive_distance.h"
#include "measure/deviation/sample_errors.h"
#include "measure/deviation/visible_looks.h"
#include "measure/visible/seen_from_outside.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <map>
#include <mutex>
#include <set>
#include <tuple>

namespace lodestone::measure {
namespace {

using Sample = SurfaceSample;

// The vertices of a stand-in that are asked at least, if it has them: on levels as fine as scans a
// few vertices decide the quantile.
// Fitted: deviations over ten seeds on bunny and skull at 50, 25, 10 %: a spread of 0.3 to 1.4 %,
// with 2,048 vertices 2.6 to 4.5 %; larger values only take time.
constexpr uint32_t kLevelVertices = 16384;
// The samples of each look, if it has them, that are asked what became of the look.
// Taste: a larger value knows the quantile of moves better, for searches by look.
constexpr size_t kAsked = 512;
/// The same number for solids of a mean color, whose moves change little from one sample to the
/// next and take long.
/// Taste: a larger value trades time for the same.
constexpr size_t kAskedOfMixed = 256;
// One point of so many is asked for a rough answer.
// Law: is_rough_sample() takes every second one.
constexpr uint32_t kFew = 2;

/// The number of points that a stand-in is asked at. A stand-in of few triangles is not asked at
/// more points than some of each, or than a quarter of `all`: surfaces that it hides, or has lost,
/// are told by the points of the finest.
uint32_t samples_for(const Mesh& stand_in, uint32_t most, uint32_t all) {
    // Points of each triangle.
    // Taste: a larger value asks coarse levels at more points; half of all points made errors of
    // boxes 0.6 times too small.
    constexpr uint64_t kOfTriangle = 8;
    const uint64_t enough = std::max<uint64_t>(all / 4, kOfTriangle * stand_in.triangles.size());
    return static_cast<uint32_t>(std::min<uint64_t>(most, enough));
}

/// A mesh about the surface of a solid, for points of it: an ellipsoid has 162 vertices.
Mesh tessellated(const lodestone::Solid& solid) {
    // Subdivisions of an icosahedron.
    // Taste: a larger value asks four times as many points.
    constexpr int kSubdivisions = 2;
    return solid.box ? tessellate_box(solid.primitive)
                     : tessellate_ellipsoid(solid.primitive, kSubdivisions);
}

/// Moves the samples from the center out onto the ellipsoid.
void move_onto(const Primitive& ellipsoid, std::vector<Sample>& samples) {
    for (Sample& sample : samples) {
        const glm::dvec3 arm = sample.point - ellipsoid.center;
        const double length = glm::length((arm * ellipsoid.axes) / ellipsoid.half_size);
        if (length > 0 && std::isfinite(length))
            sample.point = ellipsoid.center + arm / length;
    }
}

}  // namespace

/// The surface that the samples of one mesh are compared with.
struct DeviationReference::Against {
    const LookScenes& other;
    const VisibleLooks& seen;  // what can be seen of the finest
    const LookScenes& finest;
    const LookPalette* palette;
    double none;                    // the answer where there is nothing to find
    const Mesh& mesh;               // the other mesh
    const ray::MeshSkin* skin;      // the skin of the other mesh
    const lodestone::Solid* exact;  // the solid that the mesh is about; null: none

    /// The point of the other surface that ray::MeshScene::closest_point() finds, exact for a
    /// solid.
    ray::ClosestPoint closest_point(const glm::dvec3& point, uint32_t perhaps,
                                    double enough) const {
        if (exact == nullptr)
            return other.whole().closest_point(point, std::numeric_limits<double>::infinity(),
                                               perhaps, enough);
        ray::ClosestPoint out;
        out.distance = exact->box ? distance_to_box(exact->primitive, point)
                                  : distance_to_ellipsoid(exact->primitive, point);
        out.triangle = 0;  // all are alike
        return out;
    }
    /// The color that the other shows at a point of its own; `varies`: it shows others elsewhere on
    /// the triangle.
    glm::dvec3 color_at(const ray::ClosestPoint& at, bool& varies) const {
        varies = skin != nullptr && skin->varies(mesh, mesh.slot(at.triangle));
        return varies ? LookPalette::color_of(skin->at(mesh, at.triangle, at.u, at.v))
                      : palette->color(other.look_of(at.triangle));
    }
    /// Whether the other shows the same everywhere.
    bool shows_one_thing() const {
        if (palette == nullptr)
            return true;
        if (other.has_several_looks())
            return false;
        if (skin == nullptr)
            return true;
        const std::set<uint16_t> slots(mesh.slots.begin(), mesh.slots.end());
        return !skin->varies(mesh, 0) &&
               std::none_of(slots.begin(), slots.end(),
                            [&](uint16_t slot) { return skin->varies(mesh, slot); });
    }
    /// Whether the other shows a look that the finest has nowhere.
    bool is_mixed() const {
        return palette != nullptr && other.whole().triangles() > 0 && !finest.has(other.look_of(0));
    }
    /// The distance by which a look was moved at a sample where the other mesh shows the look
    /// `theirs`.
    double moved_by(const std::vector<Sample>& samples, size_t number, uint16_t theirs,
                    const glm::dvec3& color) const {
        const Sample& sample = samples[number];
        const bool mixed = !finest.has(theirs);
        double least = none;
        // A lamp that is gone is missed from as far as anything is seen, though what is there
        // instead is near.
        const bool glows = seen.glows(sample.look);
        if (!mixed && !glows)
            least = seen.nearest(sample, theirs, least);
        least = std::min(least, other.nearest(sample.look, sample.point, least).distance);
        if (glows && !(glm::length(palette->emission(theirs)) > 0))
            return least;
        if (!mixed)
            return least;
        // The same color mixes in the same place, whatever shows it: solids share their color.
        if (least < none || !seen.holds(samples))
            return seen.mixing_radius(sample, color, least);
        return std::min(least, seen.mixing_radius_at(number, color));
    }
    /// The distance by which the same texture slid along the surface at a sample where the other
    /// shows another color.
    double slid_by(const Sample& sample, const ray::ClosestPoint& at,
                   const glm::dvec3& color) const {
        double least = none;
        if (sample.metres_per_uv > 0 && !mesh.uvs.empty()) {
            const glm::dvec2 there = ray::uv_at(mesh, at.triangle, at.u, at.v);
            least = std::min(least, glm::length(there - sample.uv) * sample.metres_per_uv);
        }
        return seen.mixing_radius(sample, color, seen.nearest_of_color(sample, color, least));
    }
    /// The distance by which a sample's look was moved on the other mesh, whose nearest point is
    /// `at`.
    double move_of(const std::vector<Sample>& samples, size_t number,
                   const ray::ClosestPoint& at) const {
        const Sample& sample = samples[number];
        const uint16_t theirs = other.look_of(at.triangle);
        if (palette == nullptr)
            return 0;
        if (theirs == sample.look && !sample.varies)
            return 0;
        bool varies = false;
        const glm::dvec3 color = color_at(at, varies);
        const bool lamp = theirs != sample.look && seen.glows(sample.look);
        if ((varies || sample.varies) && !lamp && LookPalette::alike(color, sample.color))
            return 0;
        return theirs == sample.look ? slid_by(sample, at, color)
                                     : moved_by(samples, number, theirs, color);
    }
};

/// Measures from the samples to the nearest points of the other mesh. A sample that is not near the
/// quantile is searched no further than until it is known to be below, and looks are asked for at
/// some samples for all. Numbers up to `least` may be too large, but not above it: the other way
/// they are no less.
SurfaceDeviation DeviationReference::measure(const std::vector<Sample>& samples,
                                             const Against& against,
                                             std::span<const ray::ClosestPoint> nearest,
                                             double least, double useless, const Job& job) {
    // Fewer samples are all measured to the end.
    // Taste: a larger value measures more small meshes exactly, a smaller one sorts out by too few.
    constexpr size_t kFewSamples = 512;
    // The quantile of every eighth sample that is surely below kQuantile of all.
    // Taste: a larger value searches fewer points to the end, and more often starts again.
    constexpr double kBelow = 0.97;
    std::vector<double> places(samples.size(), 0);
    std::vector<double> moves(samples.size(), 0);
    // Points that are hidden in part were not asked for as such.
    const bool known_before =
        nearest.size() == samples.size() && !against.other.whole().see_through();
    const bool one_thing = against.shows_one_thing();
    const std::vector<uint8_t> asked =
        look_samples(samples, one_thing && against.is_mixed() ? kAskedOfMixed : kAsked);
    // `before`: what was near enough the last time, and has to be found out better.
    const auto visit = [&](size_t step, double enough, double before) {
        const bool again = before < std::numeric_limits<double>::infinity();
        const size_t count = (samples.size() + step - 1) / step;
        parallel_for((count + kBlock - 1) / kBlock, [&](size_t block) {
            job.check();
            uint32_t last = ray::kNoTriangle;
            size_t known = samples.size();  // a sample whose place was found before
            for (size_t k = block * kBlock; k < std::min(count, (block + 1) * kBlock); ++k) {
                const size_t i = k * step;
                const Sample& sample = samples[i];
                bool looks = asked[i] != 0;
                if ((step == 1 && i % kLookSampleStep == 0) ||
                    (again && ((looks && !one_thing) || places[i] > before)))
                    continue;
                looks = looks && !again;
                const bool given = known_before && std::isfinite(nearest[i].distance);
                if (!given && !looks && known < samples.size()) {
                    // A sample beside one that is near is near.
                    const double most =
                        places[known] + glm::length(sample.point - samples[known].point);
                    if (most <= enough) {
                        places[i] = most;
                        continue;
                    }
                }
                // Neighbors in the list are mostly neighbors in space. Where only the distance
                // counts, any point that is near enough will do.
                const ray::ClosestPoint closest =
                    given ? nearest[i]
                          : against.closest_point(sample.point, last,
                                                  looks && !one_thing ? 0 : enough);
                // A scene of triangles that have no finite corners has nothing in reach at all.
                const bool found = std::isfinite(closest.distance);
                places[i] = found ? closest.distance : against.none;
                last = closest.triangle;
                known = i;
                if (looks && found)
                    moves[i] = against.move_of(samples, i, closest);
            }
        });
    };
    constexpr double kNever = std::numeric_limits<double>::infinity();
    visit(kLookSampleStep, least, kNever);
    std::vector<size_t> some;
    for (size_t i = 0; i < samples.size(); i += kLookSampleStep)
        some.push_back(i);
    if (surely_above(useless, samples, some, places, moves))
        return {std::numeric_limits<double>::infinity(), std::numeric_limits<double>::infinity()};
    const bool many = samples.size() >= kFewSamples;
    double enough = least;
    if (many) {
        const double most = (1 - kBelow) * weight_of(samples, some);
        enough = std::max(enough, quantile(samples, places, std::move(some), most));
    }
    visit(1, enough, kNever);
    for (const double less : {0.8, 0.5, 0.0}) {
        if (!(enough > least) || is_above(samples, places, enough))
            break;
        const double before = enough;
        enough = std::max(less * enough, least);
        visit(1, enough, before);
    }
    spread_moves(samples, asked, moves);
    return deviation_of(samples, places, moves, enough);
}

DeviationReference::DeviationReference(const Mesh& finest, const DeviationOptions& options,
                                       const SurfaceLooks& surface, const Job& job)
    : options_(options),
      scenes_(finest, surface.looks, surface.skin, ray::SceneUse::Everything),
      sampler_(finest, scenes_.whole(), options.seed),
      palette_(surface.palette),
      diameter_(2 * radius_of(finest)) {
    std::vector<Sample>& points = seen_.points;
    if (!sampler_.empty()) {
        cast_ = add_visible_points(finest, sampler_, surface, options.samples, job, points);
        const std::vector<WeightedVertex> vertices =
            weighted_vertices(finest, options.most_vertices, options.seed);
        if (surface.skin && surface.skin->transmits()) {
            add_vertex_samples(finest, scenes_.whole(), vertices, points);
        } else {
            if (options.rays_of_triangle > 0)
                seen_triangles_ = seen_from_outside(finest, scenes_.whole(), sampler_.sides(),
                                                    options.rays_of_triangle, options.seed, job);
            add_visible_vertices(finest, scenes_.whole(), sampler_.sides(), seen_triangles_,
                                 vertices, ray_lift(diameter_ / 2), options.seed, job, points);
        }
    }
    seen_.looks = std::make_unique<const VisibleLooks>(points, palette_);
}

DeviationReference::~DeviationReference() = default;

const DeviationReference::SeenSamples& DeviationReference::few() const {
    std::call_once(once_, [&] {
        for (size_t i = 0; i < seen_.points.size(); ++i) {
            if (is_rough_sample(i))
                few_.points.push_back(seen_.points[i]);
        }
        few_.looks = std::make_unique<const VisibleLooks>(few_.points, palette_);
    });
    return few_;
}

SurfaceDeviation DeviationReference::of(const Mesh& stand_in, const SurfaceLooks& surface,
                                        const RepaintResult& known, double useless,
                                        const Job& job) const {
    return compare(seen_,
                   {stand_in, surface, samples_for(stand_in, options_.samples, options_.samples),
                    std::max(options_.most_vertices, kLevelVertices)},
                   known, useless, job);
}

SurfaceDeviation DeviationReference::of(const lodestone::Solid& stand_in, uint16_t look,
                                        double useless, const Job& job) const {
    const Mesh mesh = tessellated(stand_in);
    const std::vector<uint16_t> looks(mesh.triangles.size(), look);
    return compare(
        seen_, {mesh, {looks, palette_, nullptr}, options_.samples / 4, kLevelVertices, &stand_in},
        {}, useless, job);
}

SurfaceDeviation DeviationReference::roughly(const Mesh& stand_in, const SurfaceLooks& surface,
                                             const RepaintResult& known, double useless,
                                             const Job& job) const {
    RepaintResult half{known.scene, {}, known.surely_useless};
    for (size_t i = 0; i < known.nearest.size(); ++i) {
        if (is_rough_sample(i))
            half.nearest.push_back(known.nearest[i]);
    }
    return compare(
        few(),
        {stand_in, surface, samples_for(stand_in, options_.samples / kFew, options_.samples),
         std::max(options_.most_vertices, kLevelVertices) / kFew},
        half, useless, job);
}

SurfaceDeviation DeviationReference::compare(const SeenSamples& seen, const StandIn& stand_in,
                                             const RepaintResult& known, double useless,
                                             const Job& job) const {
    const Mesh& mesh = stand_in.mesh;
    const ray::SkinPtr& skin = stand_in.surface.skin;
    const LookScenes scenes(mesh, stand_in.surface.looks, skin, ray::SceneUse::ClosestPoints,
                            known.scene);
    const double none = std::max(diameter_, 2 * radius_of(mesh));
    if (scenes.whole().triangles() == 0 || scenes_.whole().triangles() == 0)
        return {none, none};
    const Against to_stand_in{scenes, *seen.looks, scenes_,    palette_,
                              none,   mesh,        skin.get(), stand_in.exact};
    const SurfaceDeviation there =
        measure(seen.points, to_stand_in, known.nearest, 0, useless, job);
    if (there.error > useless)
        return there;
    std::vector<Sample> samples;
    const bool box = stand_in.exact != nullptr && stand_in.exact->box;
    if (box)
        add_box_samples(stand_in.exact->primitive, samples);
    else
        add_area_samples(mesh, scenes.whole(), stand_in.samples, options_.seed, samples);
    add_vertex_samples(mesh, scenes.whole(),
                       weighted_vertices(mesh, stand_in.vertices, options_.seed), samples);
    if (stand_in.exact != nullptr && !box)
        move_onto(stand_in.exact->primitive, samples);
    // The looks of the stand-in at its places have been asked by the visible points already.
    const Against to_finest{scenes_, *seen.looks, scenes_,    palette_,
                            none,    mesh,        skin.get(), nullptr};
    const SurfaceDeviation back = measure(samples, to_finest, {}, there.error, useless, job);
    return {std::max(there.error, back.error), std::max(there.max, back.max), there.moved};
}

}  // namespace lodestone::measure
