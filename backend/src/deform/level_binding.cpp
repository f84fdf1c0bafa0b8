// SPDX-License-Identifier: GPL-3.0-or-later
#include "deform/level_binding.h"

#include "base/maths.h"
#include "measure/deviation/surface_samples.h"

#include <algorithm>
#include <cmath>

namespace lodestone::deform {
namespace {

constexpr uint32_t kNowhere = ~uint32_t{0};
// The error samples on the source's vertices.
// Taste: more know the error better and take more time in every frame.
constexpr uint32_t kSourceSamples = 2048;
// The error samples on the level's vertices.
// Taste: more know the error better and take more time in every frame.
constexpr uint32_t kLevelVertices = 1024;
// The error samples on the level's area.
// Taste: more know the error better and take more time in every frame.
constexpr uint32_t kLevelPoints = 1024;
// Taste: any seed; another one picks other samples.
constexpr uint64_t kSeed = 1;
// The most steps of a walk, which ends sooner unless the surface is very fine.
// Taste: more find places on finer surfaces, more slowly.
constexpr int kSteps = 256;

SurfaceAnchor anchor_at(const PoseSurface& surface, const geometry::NearestWalk& nearest,
                        const glm::dvec3& place) {
    SurfaceAnchor anchor;
    anchor.corners = nearest.corners();
    anchor.u = static_cast<float>(nearest.u());
    anchor.v = static_cast<float>(nearest.v());
    const AnchorFrame footing = anchor_frame_of(surface, anchor);
    if (footing.size > 0) {
        const glm::vec3 offset(glm::transpose(footing.axes) * (place - footing.point) /
                               footing.size);
        if (finite(glm::dvec3(offset)))
            anchor.offset = offset;
    }
    return anchor;
}

/// The normals along the axes of their anchors; zero for flat faces.
std::vector<glm::vec3> bound_normals(const BoundLevel& level, const PoseSurface& surface) {
    const VertexFacing facing = vertex_facing_of(level.mesh);
    std::vector<glm::vec3> normals(level.mesh.normals.size(), glm::vec3(0.0f));
    for (size_t i = 0; i < normals.size(); ++i) {
        if (facing.flat[i] != 0)
            continue;
        const AnchorFrame footing = anchor_frame_of(surface, level.anchors[level.places[i]]);
        normals[i] = glm::vec3(glm::transpose(footing.axes) * glm::dvec3(level.mesh.normals[i]));
    }
    return normals;
}

Mesh mesh_of(const PosedSurface& pose) {
    Mesh mesh;
    mesh.positions = pose.points;
    mesh.triangles = pose.triangles;
    return mesh;
}

/// The first entries of weld() for a pose's points followed by a mesh's vertices.
std::vector<uint32_t> weld_both(const PosedSurface& pose, const Mesh& mesh) {
    Mesh both = mesh_of(pose);
    both.positions.insert(both.positions.end(), mesh.positions.begin(), mesh.positions.end());
    return weld(both);
}

void measure_source(PoseErrorSample& witness, const PosedSurface& pose) {
    const glm::dvec3 a(pose.points[witness.source.x]);
    const glm::dvec3 b(pose.points[witness.source.y]);
    const glm::dvec3 c(pose.points[witness.source.z]);
    witness.facet = static_cast<float>(0.5 * glm::length(glm::cross(b - a, c - a)));
    witness.longest =
        static_cast<float>(std::max({glm::length(b - a), glm::length(c - b), glm::length(a - c)}));
}

}  // namespace

std::vector<uint32_t> points_of(const Mesh& mesh, const PosedSurface& pose) {
    const auto count = static_cast<uint32_t>(pose.points.size());
    const std::vector<uint32_t> welded = weld_both(pose, mesh);
    std::vector<uint32_t> points;
    points.reserve(mesh.positions.size());
    for (size_t i = count; i < welded.size(); ++i)
        points.push_back(std::min(welded[i], count));
    return points;
}

/// The data that are known of one level while it is bound.
struct LevelBinder::BindingTrace {
    std::vector<std::vector<uint32_t>> points;  // by place: the points that ended up there
    std::vector<uint32_t> place_of;             // by (welded) point; kNowhere: it vanished
    geometry::VertexRings rings;                // those of the level, by place
};

LevelBinder::LevelBinder(const Mesh& finest, const PoseSurface& surface)
    : surface_(surface),
      points_(points_of(finest, surface.pose())),
      scene_(mesh_of(surface.pose())) {
    const PosedSurface& pose = surface.pose();
    welded_ = weld(mesh_of(pose));
    rings_ = geometry::VertexRings(pose.triangles, pose.points.size(),
                                   [&](uint32_t point) { return welded_[point]; });
}

std::optional<BoundLevel> LevelBinder::bind(simplify::TracedLevel&& level) const {
    const PosedSurface& pose = surface_.pose();
    const auto points = static_cast<uint32_t>(pose.points.size());
    BoundLevel out;
    out.mesh = std::move(level.mesh);
    out.places.resize(out.mesh.positions.size());
    // A vertex that was split off since (for its own texture coordinates) is where another one was.
    const std::vector<uint32_t> same = weld(out.mesh);
    std::vector<uint32_t> number_of;  // the number of a place, by its number in the trace
    uint32_t places = 0;
    for (uint32_t vertex = 0; vertex < out.places.size(); ++vertex) {
        const uint32_t known = vertex < level.places.size() ? vertex : same[vertex];
        if (known >= level.places.size())
            return std::nullopt;
        const uint32_t traced = level.places[known];
        if (traced >= number_of.size())
            number_of.resize(traced + 1, kNowhere);
        if (number_of[traced] == kNowhere)
            number_of[traced] = places++;
        out.places[vertex] = number_of[traced];
    }
    BindingTrace trace{std::vector<std::vector<uint32_t>>(places),
                       std::vector<uint32_t>(points, kNowhere),
                       geometry::VertexRings(out.mesh.triangles, places,
                                             [&](uint32_t vertex) { return out.places[vertex]; })};
    for (const auto& [traced, vertex] : level.origins) {
        if (traced >= number_of.size() || number_of[traced] == kNowhere)
            continue;
        const uint32_t point = points_.at(vertex);
        if (point >= points)
            return std::nullopt;
        trace.points[number_of[traced]].push_back(point);
        trace.place_of[point] = number_of[traced];
    }
    std::vector<uint8_t> done(places, 0);
    out.anchors.resize(places);
    for (uint32_t vertex = 0; vertex < out.places.size(); ++vertex) {
        const uint32_t place = out.places[vertex];
        if (done[place] != 0)
            continue;
        done[place] = 1;
        const glm::dvec3 here(out.mesh.positions[vertex]);
        geometry::NearestWalk nearest(pose.points, pose.triangles, here);
        for (const uint32_t point : trace.points[place]) {
            for (const uint32_t triangle : rings_.around(point))
                nearest.visit(triangle);
        }
        if (!nearest.found())
            return std::nullopt;
        out.anchors[place] = anchor_at(surface_, nearest, here);
    }
    if (!out.mesh.normals.empty())
        out.normals = bound_normals(out, surface_);
    add_source_samples(trace, out);
    add_level_samples(trace, out);
    return out;
}

void LevelBinder::add_source_samples(const BindingTrace& trace, BoundLevel& level) const {
    const PosedSurface& pose = surface_.pose();
    std::optional<ray::MeshScene> whole;  // the whole level, for parts that vanished
    for (const measure::WeightedVertex& from :
         measure::weighted_vertices(mesh_of(pose), kSourceSamples, kSeed)) {
        const glm::dvec3 here(pose.points[from.vertex]);
        if (!finite(here))
            continue;
        geometry::NearestWalk nearest(level.mesh.positions, level.mesh.triangles, here);
        const uint32_t place = trace.place_of[welded_[from.vertex]];
        if (place != kNowhere) {
            // The search begins at the triangles at its place, which are of its own sheet.
            for (const uint32_t near : trace.rings.some_around(place))
                nearest.visit(near);
            nearest.walk(
                trace.rings, [&](uint32_t vertex) { return level.places[vertex]; }, kSteps);
        } else {
            if (!whole)
                whole.emplace(level.mesh);
            const ray::ClosestPoint closest = whole->closest_point(here);
            if (closest.triangle != ray::kNoTriangle)
                nearest.visit(closest.triangle);
        }
        if (!nearest.found())
            continue;
        PoseErrorSample witness;
        const uint32_t triangle = rings_.around(welded_[from.vertex]).front();
        const Triangle& t = pose.triangles[triangle];
        const int at = welded_[t.x] == welded_[from.vertex]   ? 0
                       : welded_[t.y] == welded_[from.vertex] ? 1
                                                              : 2;
        // The first of them is its own corner.
        witness.source = {t[at], t[(at + 1) % 3], t[(at + 2) % 3]};
        witness.level = nearest.triangle();
        witness.level_u = static_cast<float>(nearest.u());
        witness.level_v = static_cast<float>(nearest.v());
        witness.area = static_cast<float>(from.weight);
        measure_source(witness, pose);
        level.error_samples.of_source.push_back(witness);
    }
}

void LevelBinder::add_level_samples(const BindingTrace& trace, BoundLevel& level) const {
    const PosedSurface& pose = surface_.pose();
    std::vector<PoseErrorSample>& out = level.error_samples.of_level;
    const Mesh& mesh = level.mesh;
    for (const measure::WeightedVertex& from :
         measure::weighted_vertices(mesh, kLevelVertices, kSeed)) {
        const SurfaceAnchor& anchor = level.anchors[level.places[from.vertex]];
        PoseErrorSample witness;
        witness.source = anchor.corners;
        witness.source_u = anchor.u;
        witness.source_v = anchor.v;
        witness.level = trace.rings.around(level.places[from.vertex]).front();
        const Triangle& t = mesh.triangles[witness.level];
        const uint32_t place = level.places[from.vertex];
        witness.level_u = level.places[t.x] != place && level.places[t.y] == place ? 1 : 0;
        witness.level_v = level.places[t.x] != place && level.places[t.y] != place ? 1 : 0;
        witness.area = static_cast<float>(from.weight);
        measure_source(witness, pose);
        out.push_back(witness);
    }
    // The points are at even steps along the list of triangles, spread over them by the R2
    // sequence.
    const double total = surface_area(mesh);
    if (!(total > 0))
        return;
    double before = 0;
    size_t triangle = 0;
    double area = 0.5 * glm::length(area_vector(mesh, 0));
    for (uint32_t i = 0; i < kLevelPoints; ++i) {
        const double wanted = (i + 0.5) / kLevelPoints * total;
        while (before + area < wanted && triangle + 1 < mesh.triangles.size()) {
            before += area;
            area = 0.5 * glm::length(area_vector(mesh, ++triangle));
        }
        double whole = 0;
        double u = std::modf(0.5 + i * 0.7548776662466927, &whole);
        double v = std::modf(0.5 + i * 0.5698402909980532, &whole);
        if (u + v > 1) {
            u = 1 - u;
            v = 1 - v;
        }
        const Triangle& t = mesh.triangles[triangle];
        const glm::dvec3 here = (1 - u - v) * glm::dvec3(mesh.positions[t.x]) +
                                u * glm::dvec3(mesh.positions[t.y]) +
                                v * glm::dvec3(mesh.positions[t.z]);
        geometry::NearestWalk nearest(pose.points, pose.triangles, here);
        const ray::ClosestPoint closest = scene_.closest_point(here);
        const auto own = [&](uint32_t point) {
            const uint32_t place = trace.place_of[welded_[point]];
            for (int corner = 0; corner < 3 && place != kNowhere; ++corner) {
                for (const uint32_t near : trace.rings.some_around(level.places[t[corner]])) {
                    const Triangle& s = mesh.triangles[near];
                    if (level.places[s.x] == place || level.places[s.y] == place ||
                        level.places[s.z] == place)
                        return true;
                }
            }
            return false;
        };
        if (closest.triangle != ray::kNoTriangle && own(pose.triangles[closest.triangle].x)) {
            nearest.visit(closest.triangle);
        } else {  // another sheet is nearer: begin where its corners are tied to
            const auto welded = [&](uint32_t point) { return welded_[point]; };
            for (int corner = 0; corner < 3; ++corner)
                nearest.start(rings_, welded, level.anchors[level.places[t[corner]]].corners);
            nearest.walk(rings_, welded, kSteps);
        }
        if (!nearest.found())
            continue;
        PoseErrorSample witness;
        witness.source = nearest.corners();
        witness.source_u = static_cast<float>(nearest.u());
        witness.source_v = static_cast<float>(nearest.v());
        witness.level = static_cast<uint32_t>(triangle);
        witness.level_u = static_cast<float>(u);
        witness.level_v = static_cast<float>(v);
        witness.area = static_cast<float>(total / kLevelPoints);
        measure_source(witness, pose);
        out.push_back(witness);
    }
}

}  // namespace lodestone::deform
