// SPDX-License-Identifier: GPL-3.0-or-later
#include "light/lit_points.h"

#include "base/color.h"
#include "base/maths.h"
#include "base/parallel.h"
#include "choose/criterion.h"
#include "light/clear_materials.h"
#include "light/light_arrival.h"
#include "light/seen/distinct_shapes.h"
#include "light/seen/random_place.h"
#include "measure/visible/convex_bound.h"

#include <glm/common.hpp>
#include <glm/matrix.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

namespace lodestone::light {
namespace {

// The most mirrors and panes in a row that a ray follows.
// Taste: more find points deeper in mirrors, more slowly.
constexpr int kMostBounces = 4;
// The size over the distance of a light below which one ray tells its share.
// Taste: a larger one makes soft shadows hard for the choice of lights.
constexpr double kPoint = 0.04;
// The reach of a point, in distances of points.
// Taste: a larger one lets points speak for farther ones.
constexpr double kBeside = 8;
// Where a ray begins again, in parts of its way.
// Law: positions are known to 1e-7 of it; this is a large margin.
constexpr double kRelative = 1e-4;

// The most distinct triangles.
// Taste: each takes 130 bytes while rays are cast at it.
constexpr uint64_t kMostTriangles = 2'000'000;

// The places of a lamp that tell how much of it a point sees.
// Law: its middle, and four around it.
constexpr int kPlaces = 5;
std::array<glm::dvec3, kPlaces> places_on(const Light& light, const LitPoint& point) {
    const double extent = extent_of(light);
    const glm::dvec3 way = light.position - point.position;
    const double distance = glm::length(way);
    glm::dvec3 u = light.edge_u * 0.4;
    glm::dvec3 v = light.edge_v * 0.4;
    if (light.kind != LightKind::Area) {
        u = perpendicular(distance > 0 ? way / distance : glm::dvec3(0, 0, 1)) * (0.6 * extent);
        v = distance > 0 ? glm::cross(way / distance, u) : glm::dvec3(0.0);
    }
    return {light.position, light.position + u + v, light.position + u - v, light.position - u + v,
            light.position - u - v};
}

/// A clear material that hides light where it hides more than half of it, for films and clouds have
/// no shadow with an edge.
Material halved_alpha(Material material) {
    if (material.alpha_mode == AlphaMode::Blend) {
        material.alpha_mode = AlphaMode::Clip;
        material.alpha_cutoff = 0.5;
    }
    if (material.other)
        material.other = std::make_shared<const Material>(halved_alpha(*material.other));
    return material;
}

}  // namespace

std::vector<size_t> around(const LitGrid& grid, size_t row, size_t column) {
    std::vector<size_t> cells;
    for (size_t r = row > 0 ? row - 1 : 0; r < std::min(grid.rows, row + 2); ++r) {
        for (size_t c = column > 0 ? column - 1 : 0; c < std::min(grid.columns, column + 2); ++c)
            cells.push_back(r * grid.columns + c);
    }
    return cells;
}

double reach_beside(const View& view, const LitGrid& grid, const LitPoint& point) {
    const double cell = view.width / static_cast<double>(grid.columns);
    const double z = glm::length(point.position - view.camera.position);
    return kBeside * cell * choose::pixel_size(view, z);
}

LitScene::SceneShape LitScene::shape_of(const DrawnThing& lit) {
    const Representation& representation = *lit.representation;
    SceneShape shape;
    if (representation.summary.kind == Kind::Mesh)
        shape.mesh = std::get<std::shared_ptr<const Mesh>>(representation.payload);
    else
        shape.mesh = std::make_shared<const Mesh>(tessellated(representation));
    const Mesh& mesh = *shape.mesh;
    std::vector<uint8_t> opaque(mesh.triangles.size(), 1);
    size_t count = 0;
    for (size_t i = 0; i < opaque.size(); ++i) {
        opaque[i] = surface_of(lit, mesh.slot(i)).see_through ? 0 : 1;
        count += opaque[i];
    }
    shape.all = std::make_shared<const ray::MeshScene>(mesh);
    shape.dimming = shape.all;
    if (count == opaque.size()) {
        shape.opaque = shape.all;
        return shape;
    }
    if (count > 0)
        shape.opaque = std::make_shared<const ray::MeshScene>(subset(mesh, opaque));
    std::vector<Material> materials;
    for (const uint32_t index : representation.materials)
        materials.push_back(index < model_.materials.size()
                                ? halved_alpha(clear_material(model_.materials[index]))
                                : Material{});
    shape.dimming = std::make_shared<const ray::MeshScene>(
        mesh, std::make_shared<const ray::MeshSkin>(materials, *texels_));
    return shape;
}

LitScene::LitScene(const Model& model, const RendererSurfaces& renderer,
                   std::span<const DrawnThing> drawn, const Job& job)
    : model_(model), drawn_(drawn), texels_(renderer.texels), tolerance_(renderer.tolerance) {
    for (size_t i = 0; i < model.materials.size(); ++i)
        surfaces_.push_back({renderer.reflections[i], lets_light_through(model.materials[i])});
    surfaces_.emplace_back();
    DistinctShapes distinct = distinct_shapes(drawn);
    shape_of_ = std::move(distinct.of_thing);
    shapes_.resize(distinct.firsts.size());
    parallel_for(shapes_.size(), [&](size_t i) {
        job.check();
        shapes_[i] = shape_of(drawn[distinct.firsts[i]]);
    });
    for (uint32_t i = 0; i < drawn.size(); ++i) {
        const DrawnThing& lit = drawn[i];
        const SceneShape& shape = shapes_[shape_of_[i]];
        const Bound& bound = lit.representation->summary.bound;
        if ((lit.hidden & kCameraRays) == 0 || (lit.hidden & kReflectionRays) == 0)
            seen_.add(shape.all, bound, lit.world, i);
        if ((lit.hidden & kShadowRays) != 0)
            continue;
        dimming_.add(shape.dimming, bound, lit.world, i);
        if (shape.opaque)
            blocking_.add(shape.opaque, bound, lit.world, i);
    }
    seen_.finish();
    blocking_.finish();
    dimming_.finish();
    // Rays have single precision.
    least_ = 1e-6 * glm::length(seen_.box().size());
}

bool LitScene::too_large(std::span<const DrawnThing> drawn) {
    uint64_t count = 0;
    for (const uint32_t first : distinct_shapes(drawn).firsts)
        count += drawn[first].representation->summary.cost.triangles;
    return count > kMostTriangles;
}

LitScene::LitSurface LitScene::surface_of(const DrawnThing& lit, uint16_t slot) const {
    const std::vector<uint32_t>& materials = lit.representation->materials;
    const size_t index = slot < materials.size() ? materials[slot] : surfaces_.size();
    return surfaces_[std::min(index, surfaces_.size() - 1)];
}

std::vector<LitPoint> LitScene::followed(SightRay ray) const {
    std::vector<LitPoint> out;
    bool mirrored = false;
    for (int bounce = 0; bounce <= kMostBounces; ++bounce) {
        const ray::PlacedScenes::PlacedHit hit = seen_.first_hit(ray.origin, ray.direction);
        if (!hit.hit)
            return out;
        const DrawnThing& lit = drawn_[hit.name];
        const Mesh& mesh = *shapes_[shape_of_[hit.name]].mesh;
        const LitSurface surface = surface_of(lit, mesh.slot(hit.triangle));
        const SightNormals normals =
            sight_normals(mesh, lit.world, hit.triangle, hit.u, hit.v, ray.direction);
        if (!normals.any)
            return out;
        ray.z += hit.t;
        const double aside = std::max(least_, kRelative * ray.z);
        const glm::dvec3 point = ray.origin + ray.direction * hit.t;
        const RayMask sees = mirrored ? kReflectionRays : kCameraRays;
        const bool shown = (lit.hidden & sees) == 0;
        if (shown) {
            LitPoint lit_point;
            lit_point.position = point;
            lit_point.aside = normals.flat * aside;
            lit_point.normal = normals.smooth;
            lit_point.to_eye = -ray.direction;
            lit_point.albedo = surface.reflection.albedo;
            lit_point.highlight = surface.reflection.highlight;
            lit_point.region = hit.name;
            out.push_back(lit_point);
        }
        if (shown && surface.reflection.mirror && !surface.see_through) {
            ray.direction = mirror_direction(ray.direction, normals.smooth);
            if (!(glm::dot(ray.direction, normals.flat) > 0))
                return out;
            ray.origin = point + normals.flat * aside;
            mirrored = true;
        } else if (!shown || surface.see_through) {
            ray.origin = point - normals.flat * aside;
        } else {
            return out;
        }
    }
    return out;
}

SightRay LitScene::sent_on(const glm::dvec3& from, const glm::dvec3& normal, PcgRandom& random) {
    SightRay ray;
    ray.origin = from;
    const double out_of = random.uniform();
    ray.direction = measure::cosine_direction(normal, out_of, random.uniform());
    return ray;
}

std::vector<LitPoint> LitScene::surroundings(uint32_t drawn, int rays, PcgRandom& random) const {
    const Mesh& mesh = *shapes_[shape_of_[drawn]].mesh;
    const Affine& world = drawn_[drawn].world;
    const double mirrored = glm::determinant(world.linear) < 0 ? -1 : 1;
    RandomPlace places(mesh, world, random);
    std::vector<double> areas;
    areas.reserve(mesh.triangles.size());
    double area = 0;
    for (uint32_t i = 0; i < mesh.triangles.size(); ++i) {
        const double own = glm::length(places.across(i));
        areas.push_back(area += std::isfinite(own) ? own : 0);
    }
    std::vector<LitPoint> out;
    if (!(area > 0) || !std::isfinite(area))
        return out;
    for (int i = 0; i < rays; ++i) {
        const auto at = std::upper_bound(areas.begin(), areas.end(), random.uniform() * area);
        const auto triangle =
            static_cast<uint32_t>(std::min<ptrdiff_t>(at - areas.begin(), std::ssize(areas) - 1));
        const glm::dvec3 outward = mirrored * places.across(triangle);
        const double twice = glm::length(outward);
        if (!(twice > 0))
            continue;
        const glm::dvec3 normal = outward / twice;
        const glm::dvec3 from =
            places.point_on(triangle) + normal * std::max(least_, kRelative * std::sqrt(twice));
        std::vector<LitPoint> seen = followed(sent_on(from, normal, random));
        if (!seen.empty())
            out.push_back(std::move(seen.back()));
    }
    return out;
}

/// Continues from the last point, as a matt surface hands on light.
void LitScene::bounce(int times, PcgRandom& random, std::vector<LitPoint>& out) const {
    for (int i = 0; i < times && !out.empty(); ++i) {
        const LitPoint& from = out.back();
        std::vector<LitPoint> more =
            followed(sent_on(from.position + from.aside, from.normal, random));
        if (more.empty())
            return;
        out.push_back(std::move(more.back()));
    }
}

LitGrid LitScene::points(const View& view, size_t count, int bounces, const Job& job) const {
    const double aspect = static_cast<double>(view.width) / std::max(1, view.height);
    LitGrid grid;
    grid.rows = static_cast<size_t>(
        std::clamp(std::sqrt(static_cast<double>(count) / aspect), 1.0, view.height * 1.0));
    const auto rows = static_cast<double>(grid.rows);
    grid.columns =
        static_cast<size_t>(std::clamp(static_cast<double>(count) / rows, 1.0, view.width * 1.0));
    const auto columns = static_cast<double>(grid.columns);
    std::vector<std::vector<LitPoint>> found(grid.rows * grid.columns);
    parallel_for(grid.rows, [&](size_t row) {
        job.check();
        PcgRandom random(1, row);
        for (size_t column = 0; column < grid.columns; ++column) {
            const double x = (static_cast<double>(column) + random.uniform()) / columns;
            const double y = (static_cast<double>(row) + random.uniform()) / rows;
            std::vector<LitPoint>& points = found[row * grid.columns + column];
            points = seen(view, x, y);
            bounce(bounces, random, points);
        }
    });
    // Points are neighbors by the first point of each cell of the picture; one that lies far behind
    // is none.
    grid.first.assign(found.size() + 1, 0);
    for (size_t i = 0; i < found.size(); ++i)
        grid.first[i + 1] = grid.first[i] + static_cast<uint32_t>(found[i].size());
    grid.points.reserve(grid.first.back());
    for (size_t row = 0; row < grid.rows; ++row) {
        for (size_t column = 0; column < grid.columns; ++column) {
            const size_t here = row * grid.columns + column;
            for (size_t i = 0; i < found[here].size(); ++i) {
                grid.points.push_back(found[here][i]);
                LitPoint& point = grid.points.back();
                const double most = reach_beside(view, grid, point);
                for (const size_t there : around(grid, row, column)) {
                    if (there == here || i >= found[there].size())
                        continue;
                    if (glm::length(found[there][i].position - point.position) <= most)
                        point.beside.push_back(grid.first[there] + static_cast<uint32_t>(i));
                }
            }
        }
    }
    return grid;
}

bool LitScene::clear(const glm::dvec3& from, const glm::dvec3& to) const {
    const glm::dvec3 way = to - from;
    if (!(glm::dot(way, way) > 0))
        return true;
    return !blocking_.occluded(from + way * kRelative, way, 1 - 2 * kRelative);
}

double LitScene::sky_share(const LitPoint& point, size_t number) const {
    // The rays by which a point finds how much of the sky it sees.
    // Taste: more tell better which lamps the sky outshines, at every point.
    constexpr int kRays = 8;
    PcgRandom random(2, number);
    uint32_t blocker = ray::PlacedScenes::kNothing;
    int free = 0;
    for (int i = 0; i < kRays; ++i) {
        const double u = (i + random.uniform()) / kRays;
        const glm::dvec3 way = measure::cosine_direction(point.normal, u, random.uniform());
        if (!dimming_.occluded(point.position + point.aside, way,
                               std::numeric_limits<double>::infinity(), blocker))
            ++free;
    }
    return free / (kRays + 1.0);  // rather too little: more light here leaves out more lamps
}

void LitScene::add_other_light(const LightDemands& demands, std::span<LitPoint> points,
                               const Job& job) const {
    // The strongest suns that are asked for; light of others is as if it were not there.
    // Taste: more cost a ray at every point, and leave out a little more.
    constexpr size_t kMostSuns = 8;
    std::vector<const Light*> strongest;
    for (const Light& light : demands.suns) {
        if (shines_as_sun(light))
            strongest.push_back(&light);
    }
    std::stable_sort(strongest.begin(), strongest.end(), [](const Light* a, const Light* b) {
        return luminance(energy_of(*a)) > luminance(energy_of(*b));
    });
    strongest.resize(std::min(strongest.size(), kMostSuns));
    parallel_for((points.size() + kPointStrip - 1) / kPointStrip, [&](size_t strip) {
        job.check();
        std::vector<uint32_t> blockers(strongest.size(), ray::PlacedScenes::kNothing);
        const size_t end = std::min(points.size(), (strip + 1) * kPointStrip);
        for (size_t i = strip * kPointStrip; i < end; ++i) {
            LitPoint& point = points[i];
            const double seen = demands.sky_shaded ? sky_share(point, i) : 1;
            point.other_light = point.albedo * glm::max(demands.sky, glm::dvec3(0.0)) * seen;
            for (size_t k = 0; k < strongest.size(); ++k) {
                const glm::dvec3 way = -glm::normalize(strongest[k]->direction);
                const double cosine = glm::dot(way, point.normal);
                if (cosine > 0 &&
                    (!strongest[k]->shadow ||
                     !dimming_.occluded(point.position + point.aside, way,
                                        std::numeric_limits<double>::infinity(), blockers[k])))
                    point.other_light += point.albedo * energy_of(*strongest[k]) * (cosine / kPi);
            }
        }
    });
}

double LitScene::penumbra_from(const Light& sun, const LitPoint& point) const {
    // The rays to the rim of the sun; one more goes to its middle.
    // Taste: more find thinner shadows, at every point.
    constexpr int kRim = 5;
    const glm::dvec3 way = -glm::normalize(sun.direction);
    if (!(glm::dot(way, point.normal) > 0))
        return 0;
    const double radius = std::tan(std::clamp(sun.angle / 2, 0.0, 1.5));
    const glm::dvec3 u = perpendicular(way);
    const glm::dvec3 v = glm::cross(way, u);
    bool free = false;
    double farthest = 0;
    for (int i = 0; i <= kRim; ++i) {
        const double turn = 2 * kPi * i / kRim;
        const glm::dvec3 aside = std::cos(turn) * u + std::sin(turn) * v;
        const glm::dvec3 there = i < kRim ? glm::normalize(way + radius * aside) : way;
        const ray::PlacedScenes::PlacedHit hit =
            dimming_.first_hit(point.position + point.aside, there);
        if (hit.hit)
            farthest = std::max(farthest, hit.t);
        else
            free = true;
    }
    return free ? farthest : 0;
}

bool LitScene::free(const LitPoint& point, const glm::dvec3& place, uint32_t& blocker) const {
    const glm::dvec3 from = point.position + point.aside;
    const glm::dvec3 way = place - from;
    const double distance = glm::length(way);
    // In POV-Ray, too, a thing this near to a light throws no shadow.
    return distance <= tolerance_ ||
           !blocking_.occluded(from, way, 1 - tolerance_ / distance, blocker);
}

double LitScene::reaches(const Light& light, const LitPoint& point, uint32_t& blocker) const {
    if (!light.shadow && light.kind == LightKind::Point)
        return 1;
    if (extent_of(light) <= kPoint * glm::length(light.position - point.position))
        return free(point, light.position, blocker) ? 1 : 0;
    double sum = 0;
    for (const glm::dvec3& place : places_on(light, point))
        sum += free(point, place, blocker) ? 1 : 0;
    return sum / kPlaces;
}

bool LitScene::soft(const Light& light, const LitPoint& point) const {
    uint32_t blocker = ray::PlacedScenes::kNothing;
    const std::array<glm::dvec3, kPlaces> places = places_on(light, point);
    const bool first = free(point, places[0], blocker);
    return std::any_of(places.begin() + 1, places.end(), [&](const glm::dvec3& place) {
        return free(point, place, blocker) != first;
    });
}

}  // namespace lodestone::light
