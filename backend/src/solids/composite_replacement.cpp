// SPDX-License-Identifier: GPL-3.0-or-later
#include "solids/composite_replacement.h"

#include "measure/visible/visible_attributes.h"
#include "measure/visible/visible_sampler.h"
#include "solids/keep_on_floor.h"
#include "solids/match_solids.h"
#include "solids/sample_clusters.h"
#include "solids/stand_in_material.h"

#include <glm/common.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <numbers>
#include <optional>
#include <span>

namespace lodestone::solids {
namespace {

// The solids of levels.
// Taste: each level has about half of the error of the one before, and twice the solids.
constexpr std::array<size_t, 6> kCounts{4, 8, 16, 32, 64, 128};
// The rounds in which shells get their opacity.
// Taste: more come nearer to the wanted area, more slowly.
constexpr int kClearRounds = 4;
// The rays of each round.
// Taste: more know the area better, more slowly.
constexpr uint64_t kClearRays = 8192;
// The subdivisions of ellipsoids as triangles for rays.
// Taste: more are rounder and four times the triangles each.
constexpr int kSubdivisions = 2;

ClusterSample sample_at(const Mesh& mesh, const ray::SkinPtr& skin,
                        const measure::VisiblePoint& at) {
    ClusterSample out;
    out.point = at.point;
    out.triangle = at.triangle;
    const glm::dvec3 normal = area_vector(mesh, at.triangle);
    const double length = glm::length(normal);
    out.normal = length > 0 ? normal / length : glm::dvec3(0, 0, 1);
    out.slot = mesh.slot(at.triangle);
    out.finish = mean_finish(skin ? skin->material(out.slot) : Material{});
    if (skin)
        out.shown = skin->at(mesh, at.triangle, at.u, at.v);
    return out;
}

/// The samples of the surface that can be seen.
ClusterSamples seen(const Mesh& mesh, const ray::MeshScene& scene, const ray::SkinPtr& skin,
                    const CompositeOptions& options) {
    ClusterSamples out;
    const measure::VisibleSampler sampler(mesh, scene, options.seed);
    if (sampler.empty())
        return out;
    uint32_t hits = 0;
    std::array<measure::VisiblePoint, 2> points;
    for (uint32_t ray = 0; ray < options.samples; ++ray) {
        const int count = sampler.cast(ray, points);
        hits += count > 0 ? 1 : 0;
        for (int i = 0; i < count; ++i)
            out.points.push_back(sample_at(mesh, skin, points[static_cast<size_t>(i)]));
    }
    if (!out.points.empty())
        out.area = sampler.reference_area() * hits / options.samples /
                   static_cast<double>(out.points.size());
    return out;
}

/// The samples of the whole surface, hidden or not, without transparent parts.
ClusterSamples all_of(const Mesh& mesh, const ray::MeshScene& scene, const ray::SkinPtr& skin,
                      const CompositeOptions& options) {
    ClusterSamples out;
    const measure::VisibleSampler sampler(mesh, scene, options.seed);
    if (sampler.empty())
        return out;
    const measure::SobolPoints numbers(measure::scramble(options.seed) + 3);
    for (uint32_t i = 0; i < options.samples; ++i) {
        const measure::VisiblePoint at = sampler.on_surface(numbers.point(i));
        if (scene.shows(at.triangle, at.u, at.v))
            out.points.push_back(sample_at(mesh, skin, at));
    }
    out.area = sampler.possible_area() / options.samples;
    return out;
}

/// The solid of a cluster. A cluster is a patch of surface, so what its whole is part of makes it
/// neither sparse nor two heaps: if it is refused as one kind of solid it gets the other, or the
/// ball of its area.
Solid solid_of(const Attributes& attributes, bool boxes = false) {
    Solid out;
    const bool preferred = boxes || boxlike(attributes);
    for (const bool box : {preferred, !preferred}) {
        const auto found = box ? fit_box(attributes, Bound{}) : fit_ellipsoid(attributes, Bound{});
        if (!found)
            continue;
        out.box = box;
        out.primitive = *found;
        return out;
    }
    const double square = attributes.visible_area / (4 * std::numbers::pi);
    out.primitive = {attributes.centroid, attributes.axes, glm::dvec3(std::sqrt(square))};
    return out;
}

/// The attributes of the visible surface, by rays; clear solids count as much as they cover.
Attributes measured(const ClusteredComposite& level, const CompositeOptions& options,
                    const Job& job) {
    const Mesh mesh = as_large_triangles(level.composite);
    std::vector<Material> materials;
    bool clear = false;
    for (const double opacity : level.opacities) {
        clear = clear || opacity < 1;
        materials.push_back(clear_material(Material{}, opacity));
    }
    image::TexelCache texels;
    const ray::SkinPtr skin =
        clear ? std::make_shared<const ray::MeshSkin>(materials, texels) : nullptr;
    measure::VisibleOptions visible;
    visible.rays = kClearRays;
    visible.seed = options.seed;
    return measure::measure_visible(mesh, ray::MeshScene(mesh, skin), skin, visible, {}, job)
        .attributes;
}

double lowest(const Mesh& mesh) {
    return bound_of(mesh.positions).box.low.z;
}

/// Divides edges longer than `longest`, up to 65,536 triangles, so that a triangle across several
/// clusters (a trunk of two triangles) belongs to each in part. `source`: for each triangle, the
/// one it was part of.
Mesh divided(const Mesh& mesh, double longest, std::vector<uint32_t>& source) {
    // The most triangles.
    // Taste: more divide larger meshes, at more time and memory.
    constexpr size_t kMost = size_t{1} << 16u;
    Mesh out = mesh;
    if (out.slots.empty())
        out.slots.assign(out.triangles.size(), 0);
    source.resize(out.triangles.size());
    for (uint32_t i = 0; i < source.size(); ++i)
        source[i] = i;
    const auto middle = [&](auto& list, uint32_t a, uint32_t b) {
        if (!list.empty())
            list.push_back(0.5f * (list[a] + list[b]));
    };
    for (size_t i = 0; i < out.triangles.size();) {
        const Triangle t = out.triangles[i];
        int edge = 0;
        double length = 0;
        for (int corner = 0; corner < 3; ++corner) {
            const double now = glm::length(glm::dvec3(out.positions[t[corner]]) -
                                           glm::dvec3(out.positions[t[(corner + 1) % 3]]));
            if (now > length) {
                length = now;
                edge = corner;
            }
        }
        if (!(length > longest) || !std::isfinite(length) || out.triangles.size() >= kMost) {
            ++i;
            continue;
        }
        const uint32_t a = t[edge];
        const uint32_t b = t[(edge + 1) % 3];
        const uint32_t c = t[(edge + 2) % 3];
        const auto between = static_cast<uint32_t>(out.positions.size());
        middle(out.positions, a, b);
        middle(out.normals, a, b);
        middle(out.uvs, a, b);
        middle(out.colors, a, b);
        out.triangles[i] = Triangle(a, between, c);
        out.triangles.emplace_back(between, b, c);
        const uint16_t slot = out.slots[i];
        const uint32_t from = source[i];
        out.slots.push_back(slot);
        source.push_back(from);
    }
    return out;
}

/// The cluster of each triangle of the clusters' mesh: the one with most of its samples, or the
/// nearest one where it has none.
std::vector<uint32_t> clusters_of(const Mesh& mesh, const SampleClusters& clusters) {
    std::vector<std::map<uint32_t, uint32_t>> votes(mesh.triangles.size());
    for (uint32_t i = 0; i < clusters.all().size(); ++i) {
        for (const uint32_t sample : clusters.all()[i].samples)
            ++votes[clusters.samples().points[sample].triangle][i];
    }
    std::vector<uint32_t> out(mesh.triangles.size(), 0);
    for (size_t t = 0; t < out.size(); ++t) {
        uint32_t most = 0;
        for (const auto& [cluster, count] : votes[t]) {
            if (count > most)
                out[t] = cluster;
            most = std::max(most, count);
        }
        if (most > 0)
            continue;
        glm::dvec3 middle(0.0);
        for (int corner = 0; corner < 3; ++corner)
            middle += glm::dvec3(mesh.positions[mesh.triangles[t][corner]]) / 3.0;
        double nearest = std::numeric_limits<double>::infinity();
        for (uint32_t i = 0; i < clusters.all().size(); ++i) {
            const glm::dvec3 arm = middle - clusters.all()[i].attributes.centroid;
            if (glm::dot(arm, arm) < nearest) {
                nearest = glm::dot(arm, arm);
                out[t] = i;
            }
        }
    }
    return out;
}

/// The visible surface of each cluster if the others are taken away.
class IsolatedClusters {
public:
    IsolatedClusters(const Mesh& mesh, const ray::SkinPtr& skin, uint64_t seed)
        : mesh_(mesh), skin_(skin), seed_(seed) {}

    const Attributes& of(const SampleCluster& cluster, uint32_t index,
                         const std::vector<uint32_t>& cluster_of, const Job& job) {
        const auto [known, fresh] = known_.try_emplace(cluster.number);
        if (!fresh)
            return known->second;
        std::vector<uint8_t> keep(cluster_of.size(), 0);
        for (size_t t = 0; t < keep.size(); ++t)
            keep[t] = cluster_of[t] == index ? 1 : 0;
        const Mesh part = subset(mesh_, keep);
        measure::VisibleOptions options;
        options.rays = 2048;
        options.seed = seed_;
        if (!part.empty())
            known->second =
                measure::measure_visible(part, ray::MeshScene(part, skin_), skin_, options, {}, job)
                    .attributes;
        return known->second;
    }

private:
    const Mesh& mesh_;
    const ray::SkinPtr& skin_;
    uint64_t seed_;
    std::map<uint32_t, Attributes> known_;
};

/// A clear solid while its size is still searched for.
struct ShelledSolid {
    Solid solid;
    double density = 0;  // that of the unscaled shell; 0: a solid
};

/// `airy`: made of many parts, so that even a dense cluster is no solid.
ShelledSolid shelled(const Attributes& attributes, bool airy) {
    // The share of its shell that a cluster covers from which on it is a solid.
    // Taste: a smaller share gives more solids, which hide what is behind them.
    constexpr double kSolid = 0.9;
    ShelledSolid out;
    const bool box = boxlike(attributes);
    const auto shell = box ? shell_box(attributes) : shell_ellipsoid(attributes);
    if (!shell || (!airy && shell->opacity >= kSolid)) {
        out.solid = solid_of(attributes);
        return out;
    }
    out.solid.box = box;
    out.solid.primitive = shell->primitive;
    out.density = shell->opacity;
    return out;
}

/// Whether no single part makes up much of the cluster.
bool made_of_many(const SampleCluster& cluster, const ClusterSamples& samples,
                  std::span<const uint32_t> parts) {
    // The fewest equal parts that are many.
    // Taste: fewer take bodies with some details for foliage.
    constexpr size_t kFewest = 8;
    if (parts.empty())
        return false;
    std::map<uint32_t, size_t> counts;
    size_t most = 0;
    for (const uint32_t sample : cluster.samples)
        most = std::max(most, ++counts[parts[samples.points[sample].triangle]]);
    return most * kFewest <= cluster.samples.size();
}

}  // namespace

Mesh as_large_triangles(const Composite& composite) {
    // Flat triangles have less area than the surface they lie on.
    // Law: the ratio of the areas of the ball and of its triangles.
    static const double kSwell = [] {
        const Mesh ball = tessellate_ellipsoid({}, kSubdivisions);
        double area = 0;
        for (size_t i = 0; i < ball.triangles.size(); ++i)
            area += 0.5 * glm::length(area_vector(ball, i));
        return std::sqrt(4 * std::numbers::pi / area);
    }();
    Composite swollen = composite;
    for (Solid& solid : swollen.solids)
        solid.primitive.half_size *= solid.box ? 1 : kSwell;
    return tessellate(swollen, kSubdivisions);
}

std::vector<ClusteredComposite> composites(const Mesh& mesh, const ray::SkinPtr& skin,
                                           const Attributes& wanted,
                                           const CompositeOptions& options, const Job& job) {
    std::vector<ClusteredComposite> out;
    const ray::MeshScene scene(mesh, skin);
    ClusterSamples samples = seen(mesh, scene, skin, options);
    if (samples.points.size() < SampleClusters::kFewestSamples || !(samples.area > 0) ||
        wanted.empty())
        return out;
    SampleClusters clusters(std::move(samples));
    Attributes whole = wanted;
    std::optional<VisibleSolids> sure;
    if (options.shape && options.settled > 0) {
        sure.emplace(options.settled, options.seed);
        measure::VisibleOptions visible;
        visible.rays = options.settled;
        visible.settled = kSettledComposite;
        visible.seed = options.seed;
        const Attributes again =
            measure::measure_visible(mesh, scene, skin, visible, {}, job).attributes;
        if (!again.empty())
            whole = again;
    }
    const VisibleSolids visible(options.rays, options.seed);
    for (const size_t count : kCounts) {
        if (count > options.most)
            break;
        clusters.split_to(count, job);
        const size_t parts = clusters.all().size();
        if (parts < 2 || (!out.empty() && out.back().clusters.size() == parts))
            break;
        if (count < options.least)
            continue;
        ClusteredComposite level;
        for (const SampleCluster& cluster : clusters.all()) {
            level.composite.solids.push_back(solid_of(cluster.attributes, options.boxes));
            level.composite.solids.back().slot = static_cast<uint16_t>(level.clusters.size());
            level.attributes.push_back(cluster.attributes);
            level.clusters.push_back(cluster.number);
            level.opacities.push_back(1);
        }
        match_composite(level.composite, whole, lowest(mesh), visible, options.shape,
                        options.rounds, job);
        if (sure)
            settle_composite(level.composite, whole, lowest(mesh), *sure, job);
        out.push_back(std::move(level));
    }
    return out;
}

std::vector<ClusteredComposite> clear_composites(const Mesh& whole, const ray::SkinPtr& skin,
                                                 std::span<const uint32_t> parts,
                                                 const Attributes& wanted,
                                                 const CompositeOptions& options, const Job& job) {
    // The growth of a shell. A shell through the middle of a cluster's surface leaves gaps between
    // clusters; one around it is sqrt(5 / 3) times as large (a ball's outside and its variances).
    // Taste: smaller shells leave gaps between clusters, larger ones blur the outline.
    constexpr double kAround = 1.2;
    // The power by which the depth of shells follows the missing area, because the area that all
    // shells cover grows slowly with what each covers.
    // Taste: a larger power comes nearer in fewer rounds and may swing.
    constexpr double kDepth = 2.5;
    // The largest change of the shells' depth.
    // Taste: a larger one makes clusters that hide each other denser.
    constexpr double kMostDepth = 6;
    // The largest opacity of a shell.
    // Taste: a larger one is no longer clear.
    constexpr double kMostOpaque = 0.98;
    // The longest edge, over the radius of the mesh.
    // Taste: a shorter one divides parts between more clusters, at more time.
    constexpr double kLongest = 1.0 / 8;
    std::vector<ClusteredComposite> out;
    std::vector<uint32_t> source;
    const Mesh mesh = divided(whole, kLongest * bound_of(whole.positions).radius, source);
    std::vector<uint32_t> part_of;
    for (const uint32_t triangle : source) {
        if (!parts.empty())
            part_of.push_back(parts[triangle]);
    }
    const ray::MeshScene scene(mesh, skin);
    ClusterSamples samples = all_of(mesh, scene, skin, options);
    if (samples.points.size() < SampleClusters::kFewestSamples || !(samples.area > 0) ||
        wanted.empty())
        return out;
    SampleClusters clusters(std::move(samples));
    IsolatedClusters alone(mesh, skin, options.seed);
    const double floor = lowest(mesh);
    for (const size_t count : kCounts) {
        if (count > options.most)
            break;
        clusters.split_to(count, job);
        const size_t solids = clusters.all().size();
        if (solids < 2 || (!out.empty() && out.back().clusters.size() == solids))
            break;
        const std::vector<uint32_t> cluster_of = clusters_of(mesh, clusters);
        ClusteredComposite level;
        std::vector<ShelledSolid> shells;
        bool clear = false;
        for (uint32_t i = 0; i < solids; ++i) {
            const SampleCluster& cluster = clusters.all()[i];
            const Attributes& attributes = alone.of(cluster, i, cluster_of, job);
            if (attributes.empty())
                continue;
            shells.push_back(
                shelled(attributes, made_of_many(cluster, clusters.samples(), part_of)));
            shells.back().solid.slot = static_cast<uint16_t>(level.clusters.size());
            clear = clear || shells.back().density > 0;
            level.attributes.push_back(attributes);
            level.clusters.push_back(cluster.number);
        }
        if (!clear)
            return out;
        double depth = 1;  // that of all shells, over that of the clusters alone
        for (int round = 0; round < kClearRounds; ++round) {
            level.composite.solids.clear();
            level.opacities.clear();
            for (const ShelledSolid& shell : shells) {
                Solid solid = shell.solid;
                double opacity = 1;
                if (shell.density > 0) {
                    solid.primitive.half_size *= kAround;
                    opacity = std::min(kMostOpaque, shell.density / (kAround * kAround));
                    opacity = 1 - std::pow(1 - opacity, depth);
                }
                solid.primitive = kept_above(solid.primitive, solid.box, floor);
                level.composite.solids.push_back(solid);
                level.opacities.push_back(opacity);
            }
            if (round + 1 == kClearRounds)
                break;
            const double now = measured(level, options, job).visible_area;
            if (!(now > 0))
                break;
            depth = std::clamp(depth * std::pow(wanted.visible_area / now, kDepth), 1 / kMostDepth,
                               kMostDepth);
        }
        out.push_back(std::move(level));
    }
    return out;
}

}  // namespace lodestone::solids
