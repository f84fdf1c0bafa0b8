// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/closed_surface.h"

#include <algorithm>
#include <limits>
#include <unordered_map>

namespace lodestone::geometry {
namespace {

// Law: no vertex.
constexpr uint32_t kNone = ~uint32_t{0};

/// The border points of a level by their sources, and the vertices at each.
class PointIndex {
public:
    explicit PointIndex(const SurfaceLevel& level) : first_(level.points.size() + 1, 0) {
        for (uint32_t p = 0; p < level.points.size(); ++p)
            by_source_.emplace(level.points[p].source, p);
        for (const BorderCorner& corner : level.corners)
            ++first_[corner.point + 1];
        for (size_t p = 0; p + 1 < first_.size(); ++p)
            first_[p + 1] += first_[p];
        vertices_.resize(level.corners.size());
        std::vector<uint32_t> next(first_.begin(), first_.end() - 1);
        for (const BorderCorner& corner : level.corners)
            vertices_[next[corner.point]++] = corner.vertex;
    }
    std::span<const uint32_t> vertices_at(uint32_t point) const {
        return {vertices_.data() + first_[point], vertices_.data() + first_[point + 1]};
    }
    std::span<const uint32_t> vertices_of(uint32_t source) const {
        const auto at = by_source_.find(source);
        return at == by_source_.end() ? std::span<const uint32_t>() : vertices_at(at->second);
    }

private:
    std::unordered_map<uint32_t, uint32_t> by_source_;
    std::vector<uint32_t> first_;
    std::vector<uint32_t> vertices_;
};

/// How differently two vertices of meshes are shaded and painted.
double difference(const Mesh& a, uint32_t i, const Mesh& b, uint32_t j) {
    double sum = 0;
    if (!a.normals.empty() && !b.normals.empty())
        sum += 1 - glm::dot(glm::dvec3(a.normals[i]), glm::dvec3(b.normals[j]));
    if (!a.uvs.empty() && !b.uvs.empty())
        sum += glm::length(glm::dvec2(a.uvs[i]) - glm::dvec2(b.uvs[j]));
    if (!a.colors.empty() && !b.colors.empty())
        sum += glm::length(glm::dvec4(a.colors[i]) - glm::dvec4(b.colors[j]));
    return sum;
}

class SurfaceCloser {
public:
    SurfaceCloser(std::span<const SurfaceSource> sources, std::span<const uint8_t> source_of)
        : sources_(sources), source_of_(source_of) {
        const SurfaceLevel& first = sources.front().level;
        for (const SurfaceSource& source : sources) {
            if (source.level.tree->hash != first.tree->hash ||
                source.level.tree->depth != first.tree->depth)
                fail(Status::InvalidArgument, "levels of different surfaces");
            if (source.mesh.normals.empty() != sources.front().mesh.normals.empty() ||
                source.mesh.uvs.empty() != sources.front().mesh.uvs.empty() ||
                source.mesh.colors.empty() != sources.front().mesh.colors.empty())
                fail(Status::InvalidArgument, "levels that are shaded or painted differently");
            index_.emplace_back(source.level);
        }
        for (size_t chunk = 0; chunk < source_of.size(); ++chunk) {
            const uint32_t shift = sources[source_of[chunk]].level.shift;
            const size_t begin = chunk >> shift << shift;
            const auto node = source_of.subspan(begin, size_t{1} << shift);
            const auto differs = [&](uint8_t one) { return one != source_of[chunk]; };
            if (differs(source_of[begin]) ||
                (chunk == begin && std::any_of(node.begin(), node.end(), differs)))
                fail(Status::InvalidArgument, "chunk ", chunk, " is not taken with its node");
        }
    }

    Mesh run() {
        for (size_t i = 0; i < sources_.size(); ++i)
            add(i);
        return std::move(out_);
    }

private:
    /// The source that is the coarsest one around a border point.
    uint8_t coarsest_at(const SurfaceLevel& level, uint32_t point) const {
        const size_t end =
            point + 1 < level.points.size() ? level.points[point + 1].touch : level.touches.size();
        uint8_t coarsest = 0;
        uint32_t step = 0;
        for (size_t i = level.points[point].touch; i < end; ++i) {
            const uint8_t source = source_of_[level.touches[i]];
            if (sources_[source].level.step >= step) {
                step = sources_[source].level.step;
                coarsest = source;
            }
        }
        return coarsest;
    }

    /// The vertices that those of a source become in the result: of another source, too.
    struct VertexPlace {
        uint32_t vertex = 0;  // of the source: its place and, if nothing else is known, its look
        uint8_t look = 0;     // the source of the look,
        uint32_t shown = 0;   // and the vertex there
    };
    VertexPlace place_of(uint8_t source, const BorderCorner& corner) const {
        const SurfaceLevel& level = sources_[source].level;
        uint32_t point = corner.point;
        uint8_t coarsest = coarsest_at(level, point);
        while (level.points[point].dies <= sources_[coarsest].level.step) {
            point = level.points[point].heir;
            coarsest = coarsest_at(level, point);
        }
        VertexPlace place{corner.vertex, source, corner.vertex};
        const Mesh& own = sources_[source].mesh;
        const std::span<const uint32_t> here = index_[source].vertices_at(point);
        if (here.empty())
            return place;
        if (point != corner.point)
            place.vertex = place.shown = here.front();
        std::span<const uint32_t> there = index_[coarsest].vertices_of(level.points[point].source);
        if (there.empty()) {
            there = here;
            coarsest = source;
        }
        const Mesh& other = sources_[coarsest].mesh;
        double least = std::numeric_limits<double>::infinity();
        for (const uint32_t vertex : there) {
            const double differs = difference(own, corner.vertex, other, vertex);
            if (differs < least) {
                least = differs;
                place.look = coarsest;
                place.shown = vertex;
            }
        }
        return place;
    }

    uint32_t append(const VertexPlace& place, uint8_t source) {
        const Mesh& own = sources_[source].mesh;
        const Mesh& look = sources_[place.look].mesh;
        out_.positions.push_back(own.positions[place.vertex]);
        const auto copy = [&](auto& to, const auto& values) {
            if (!values.empty())
                to.push_back(values[place.shown]);
        };
        copy(out_.normals, look.normals);
        copy(out_.uvs, look.uvs);
        copy(out_.colors, look.colors);
        return static_cast<uint32_t>(out_.positions.size() - 1);
    }

    void add(size_t index) {
        const auto source = static_cast<uint8_t>(index);
        const Mesh& mesh = sources_[index].mesh;
        const SurfaceLevel& level = sources_[index].level;
        const std::vector<uint16_t>& moved = sources_[index].slots;
        std::vector<uint32_t> made(mesh.positions.size(), kNone);
        const auto vertex_of = [&](uint32_t vertex) {
            if (made[vertex] != kNone)
                return made[vertex];
            const auto at = std::lower_bound(
                level.corners.begin(), level.corners.end(), vertex,
                [](const BorderCorner& corner, uint32_t of) { return corner.vertex < of; });
            VertexPlace place{vertex, source, vertex};
            if (at != level.corners.end() && at->vertex == vertex)
                place = place_of(source, *at);
            return made[vertex] = append(place, source);
        };
        const auto take = [&](uint32_t t) {
            const Triangle& from = mesh.triangles[t];
            const Triangle to(vertex_of(from.x), vertex_of(from.y), vertex_of(from.z));
            const auto& at = out_.positions;
            if (at[to.x] == at[to.y] || at[to.y] == at[to.z] || at[to.z] == at[to.x])
                return;
            out_.triangles.push_back(to);
            uint16_t slot = mesh.slot(t);
            if (!moved.empty())
                slot = moved[slot < moved.size() ? slot : size_t{0}];
            if (slot != 0 && out_.slots.empty())
                out_.slots.resize(out_.triangles.size() - 1, 0);
            if (!out_.slots.empty() || slot != 0)
                out_.slots.push_back(slot);
        };
        if (level.step == 0) {
            for (uint32_t t = 0; t < mesh.triangles.size(); ++t) {
                if (source_of_[level.tree->chunk_of(mesh, t)] == source)
                    take(t);
            }
            return;
        }
        for (uint32_t node = 0; node < level.nodes(); ++node) {
            if (source_of_[size_t{node} << level.shift] != source)
                continue;
            for (uint32_t t = level.before[node]; t < level.before[node + 1]; ++t)
                take(t);
        }
    }

    std::span<const SurfaceSource> sources_;
    std::span<const uint8_t> source_of_;
    std::vector<PointIndex> index_;
    Mesh out_;
};

}  // namespace

Mesh closed_surface(std::span<const SurfaceSource> sources, std::span<const uint8_t> source_of) {
    if (sources.empty() || sources.size() > std::numeric_limits<uint8_t>::max())
        fail(Status::InvalidArgument, "a surface of ", sources.size(), " levels");
    if (source_of.size() != sources.front().level.tree->chunks())
        fail(Status::InvalidArgument, source_of.size(), " chunks of ",
             sources.front().level.tree->chunks());
    for (const uint8_t source : source_of) {
        if (source >= sources.size())
            fail(Status::InvalidArgument, "level ", int{source}, " of ", sources.size());
    }
    return SurfaceCloser(sources, source_of).run();
}

}  // namespace lodestone::geometry
