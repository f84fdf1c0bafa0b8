// SPDX-License-Identifier: GPL-3.0-or-later
#include "hierarchy/flat_layers.h"

#include "base/parallel.h"
#include "base/random.h"
#include "geometry/closest_on_triangle.h"
#include "geometry/part_tree.h"
#include "hierarchy/counted_error.h"
#include "measure/visible/convex_bound.h"
#include "measure/visible/surface_inertia.h"

#include <glm/matrix.hpp>

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <span>

namespace lodestone::hierarchy {
namespace {

// How many places of a flat thing are looked at.
// Taste: more find rarer layers, in time in proportion.
constexpr size_t kMostPlaces = 8;
// Taste: a larger number looks at larger models to the end, in memory in proportion.
constexpr size_t kMostOccurrences = size_t{1} << 20;
// The boxes and triangles that are looked at.
// Taste: a larger number looks at larger models to the end, in time in proportion.
constexpr uint64_t kMostWork = 400'000'000;
// The points of a flat thing that are looked at.
// Taste: more tell better how much of it lies on another, in time in proportion.
constexpr int kSamples = 32;
// The largest distance of two layers, over the width of the narrower one.
// Law: 1 / kLayerWidth of counted_error.cpp.
constexpr double kNearLayers = 1.0 / 16;

/// The surface of a leaf.
struct LeafSurface {
    std::shared_ptr<const Mesh> mesh;
    double width = 0;  // across, m
    bool flat = false;
    bool asked = false;                       // flat, and no environment
    std::vector<glm::dvec3> samples;          // of its surface; made when asked for
    std::optional<geometry::PartTree> parts;  // made when asked for
};

struct PlacedLeaf {
    ObjectIndex object;
    Affine world;
    Box3 box;
    double width;
};

LeafSurface shape_of(std::shared_ptr<const Mesh> mesh, ObjectRole role) {
    LeafSurface shape;
    const measure::SurfaceInertia inertia = measure::inertia_of_mesh(*mesh);
    if (inertia.empty())
        return shape;
    const SymmetricEigen variances = measure::principal_variances(inertia);
    shape.width = std::sqrt(12 * std::max(0.0, variances.values[1]));
    shape.flat = is_flat(variances.values[1], variances.values[2]);
    shape.asked = shape.flat && role != ObjectRole::Environment;
    shape.mesh = std::move(mesh);
    return shape;
}

/// Points of a mesh, uniform in area.
std::vector<glm::dvec3> samples_of(const Mesh& mesh) {
    std::vector<double> up_to;
    double all = 0;
    for (size_t i = 0; i < mesh.triangles.size(); ++i) {
        const double area = glm::length(area_vector(mesh, i));
        all += std::isfinite(area) ? area : 0;
        up_to.push_back(all);
    }
    std::vector<glm::dvec3> samples;
    PcgRandom random(1, 5);
    for (int i = 0; i < kSamples; ++i) {
        const double at = (i + random.uniform()) / kSamples * all;
        const auto found = std::upper_bound(up_to.begin(), up_to.end(), at);
        if (found == up_to.end())
            continue;
        const Triangle& t = mesh.triangles[static_cast<size_t>(found - up_to.begin())];
        const double u = random.uniform();
        const double v = random.uniform();
        const glm::dvec2 weights = measure::uniform_in_triangle(u, v);
        const glm::dvec3 a(mesh.positions[t.x]);
        samples.push_back(a + weights.x * (glm::dvec3(mesh.positions[t.y]) - a) +
                          weights.y * (glm::dvec3(mesh.positions[t.z]) - a));
    }
    return samples;
}

bool overlap(const Box3& a, const Box3& b, double gap) {
    for (int i = 0; i < 3; ++i) {
        if (!(a.low[i] <= b.high[i] + gap && b.low[i] <= a.high[i] + gap))
            return false;
    }
    return true;
}

class LayerSearch {
public:
    LayerSearch(const Model& model, const std::vector<ObjectIndex>& order, const MeshSource& source,
                const Job& job)
        : model_(model), job_(job), shapes_(model.objects.size()) {
        std::vector<ObjectIndex> leaves;
        for (const ObjectIndex index : order) {
            const Object& object = model.objects[index];
            if (!object.representations.empty() &&
                object.representations[0].summary.kind == Kind::Mesh)
                leaves.push_back(index);
        }
        parallel_for(leaves.size(), [&](size_t i) {
            job_.check();
            const Object& object = model_.objects[leaves[i]];
            shapes_[leaves[i]] = shape_of(source(object.representations[0]), object.role);
        });
    }

    /// 1 for every leaf that lies in layers.
    std::vector<Hash> run() {
        std::vector<Hash> out(shapes_.size(), 0);
        if (std::none_of(shapes_.begin(), shapes_.end(),
                         [](const LeafSurface& shape) { return shape.asked; }))
            return out;
        collect();
        bool known = places_.size() < kMostOccurrences;
        if (known)
            sort();
        std::vector<size_t> looked(shapes_.size(), 0);
        for (size_t i = 0; known && i < places_.size(); ++i) {
            const ObjectIndex object = places_[i].object;
            if (!shapes_[object].asked || out[object] != 0 || looked[object] == kMostPlaces)
                continue;
            ++looked[object];
            look_around(i, out);
            known = work_ < kMostWork;
        }
        for (size_t i = 0; !known && i < shapes_.size(); ++i)
            out[i] = shapes_[i].asked ? 1 : 0;
        return out;
    }

private:
    void collect() {
        std::vector<std::pair<ObjectIndex, Affine>> stack{{model_.root, Affine{}}};
        while (!stack.empty() && places_.size() < kMostOccurrences) {
            const auto [index, world] = stack.back();
            stack.pop_back();
            const Object& object = model_.objects[index];
            if (object.group()) {
                const auto& placements = object.representations[0].assembly().placements;
                for (size_t i = placements.size(); i-- > 0;)
                    stack.emplace_back(placements[i].object, world * placements[i].transform);
                continue;
            }
            const double width = shapes_[index].width * stretch(world);
            if (width > 0 && std::isfinite(width))
                places_.push_back({index, world, transformed(object.bound(), world).box, width});
        }
    }

    /// Sorts the places by their lower end along x; those that are long along it come first, in a
    /// list of their own.
    void sort() {
        // The length from which on a place is long, over that of the whole.
        // Taste: a larger value compares more places with each other, a smaller one more with all.
        constexpr double kLong = 1.0 / 64;
        Box3 all;
        for (const PlacedLeaf& place : places_) {
            all.add(place.box.low);
            all.add(place.box.high);
        }
        longest_ = kLong * all.size().x;
        const auto is_long = [&](const PlacedLeaf& place) {
            return place.box.high.x - place.box.low.x > longest_;
        };
        const auto middle = std::stable_partition(places_.begin(), places_.end(), is_long);
        first_short_ = static_cast<size_t>(middle - places_.begin());
        std::stable_sort(middle, places_.end(), [](const PlacedLeaf& a, const PlacedLeaf& b) {
            return a.box.low.x < b.box.low.x;
        });
    }

    void look_around(size_t number, std::vector<Hash>& out) {
        job_.check();
        const PlacedLeaf& place = places_[number];
        const double gap = kNearLayers * place.width;
        const auto visit = [&](size_t i) {
            ++work_;
            const PlacedLeaf& other = places_[i];
            if (i == number || !overlap(place.box, other.box, gap) || !in_layers(place, other))
                return false;
            out[place.object] = 1;
            if (shapes_[other.object].asked)
                out[other.object] = 1;
            return true;
        };
        for (size_t i = 0; i < first_short_ && work_ < kMostWork; ++i) {
            if (visit(i))
                return;
        }
        const auto from =
            std::lower_bound(places_.begin() + static_cast<std::ptrdiff_t>(first_short_),
                             places_.end(), place.box.low.x - gap - longest_,
                             [](const PlacedLeaf& other, double x) { return other.box.low.x < x; });
        for (auto i = static_cast<size_t>(from - places_.begin());
             i < places_.size() && places_[i].box.low.x <= place.box.high.x + gap &&
             work_ < kMostWork;
             ++i) {
            if (visit(i))
                return;
        }
    }

    bool in_layers(const PlacedLeaf& a, const PlacedLeaf& b) {
        const PlacedLeaf& narrow = a.width <= b.width ? a : b;
        const PlacedLeaf& wide = a.width <= b.width ? b : a;
        const double volume = glm::determinant(wide.world.linear);
        if (!(std::abs(volume) > 0) || !std::isfinite(1 / volume))
            return false;
        const glm::dmat3 back = glm::inverse(wide.world.linear);
        const double gap = kNearLayers * narrow.width / stretch(wide.world);
        const Box3& box = model_.objects[wide.object].bound().box;
        LeafSurface& shape = shapes_[narrow.object];
        if (shape.samples.empty())
            shape.samples = samples_of(*shape.mesh);
        const size_t wanted = (shape.samples.size() + 1) / 2;
        size_t near = 0;
        for (size_t i = 0; i < shape.samples.size(); ++i) {
            if (near >= wanted || near + (shape.samples.size() - i) < wanted)
                break;
            const glm::dvec3 point = back * (narrow.world(shape.samples[i]) - wide.world.offset);
            const Box3 at{point, point};
            if (overlap(at, box, gap) && is_near(shapes_[wide.object], point, gap))
                ++near;
        }
        return wanted > 0 && near >= wanted;
    }

    /// Whether a surface comes nearer to a point than that.
    bool is_near(LeafSurface& surface, const glm::dvec3& point, double gap) {
        if (!surface.parts)
            surface.parts.emplace(*surface.mesh);
        const std::vector<geometry::MeshPart>& parts = surface.parts->parts();
        for (size_t i = 0; i < parts.size();) {
            ++work_;
            const bool apart = !overlap({point, point}, parts[i].box, gap);
            if (!apart && surface.parts->leaf(i) &&
                is_near(*surface.mesh, surface.parts->triangles(parts[i]), point, gap))
                return true;
            i = apart ? parts[i].next : i + 1;
        }
        return false;
    }

    bool is_near(const Mesh& mesh, std::span<const uint32_t> triangles, const glm::dvec3& point,
                 double gap) {
        for (const uint32_t triangle : triangles) {
            ++work_;
            const Triangle& t = mesh.triangles[triangle];
            const glm::dvec3 a(mesh.positions[t.x]);
            const glm::dvec3 b(mesh.positions[t.y]);
            const glm::dvec3 c(mesh.positions[t.z]);
            const Box3 box{glm::min(a, glm::min(b, c)), glm::max(a, glm::max(b, c))};
            if (!overlap({point, point}, box, gap))
                continue;
            const glm::dvec3 arm = geometry::closest_on_triangle(point, a, b, c).point - point;
            if (glm::dot(arm, arm) <= gap * gap)
                return true;
        }
        return false;
    }

    const Model& model_;
    const Job& job_;
    std::vector<LeafSurface> shapes_;  // by object
    std::vector<PlacedLeaf> places_;
    size_t first_short_ = 0;
    double longest_ = 0;  // of the short ones, along x
    uint64_t work_ = 0;
};

}  // namespace

std::vector<Hash> layers_of(const Model& model, const std::vector<ObjectIndex>& order,
                            const MeshSource& source, const Job& job) {
    std::vector<Hash> out = LayerSearch(model, order, source, job).run();
    for (const ObjectIndex index : order) {
        const Object& object = model.objects[index];
        if (!object.group())
            continue;
        Hasher hasher;
        bool any = false;
        for (const Placement& placement : object.representations[0].assembly().placements) {
            hasher.value(out[placement.object]);
            any = any || out[placement.object] != 0;
        }
        out[index] = any ? hasher.result() : 0;
    }
    return out;
}

}  // namespace lodestone::hierarchy
