// SPDX-License-Identifier: GPL-3.0-or-later
#include "simplify/surface_levels.h"

#include "simplify/collapse/collapse_pass.h"
#include "simplify/fit/level_attributes.h"
#include "simplify/fit/surface_fit.h"

#include <algorithm>
#include <cmath>

namespace lodestone::simplify {
namespace {

/// All vertices that lie on borders of chunks at first, by rising first number, and what becomes of
/// them.
class BorderLives {
public:
    BorderLives(const CollapseMesh& mesh, const Adjacency& adjacency) {
        std::vector<std::pair<uint32_t, uint32_t>> order;  // first number, vertex
        for (uint32_t v = 0; v < mesh.points.size(); ++v) {
            if (mesh.on_border(adjacency.around(v)))
                order.emplace_back(mesh.ids[v], v);
        }
        std::sort(order.begin(), order.end());
        for (const auto& [id, vertex] : order) {
            std::vector<uint16_t> around;
            for (const uint32_t t : adjacency.around(vertex))
                around.push_back(mesh.chunks[t]);
            std::sort(around.begin(), around.end());
            around.erase(std::unique(around.begin(), around.end()), around.end());
            lives_.push_back({id, BorderPoint::kLasts, kNone, std::move(around)});
        }
    }

    /// Notes who has gone since the last step.
    void pass(const CollapseMesh& mesh, uint32_t step) {
        for (BorderLife& life : lives_) {
            if (life.dies != BorderPoint::kLasts || mesh.merged[life.id] == life.id)
                continue;
            life.dies = step;
            life.heir = mesh.merged[life.id];
            while (mesh.merged[life.heir] != life.heir)
                life.heir = mesh.merged[life.heir];
        }
    }

    /// Fills the points of a level, whose sources are given, rising; their touches and heirs.
    void describe(std::span<const uint32_t> sources, SurfaceLevel& level) const {
        const auto place_of = [&](uint32_t source) {
            const auto at = std::lower_bound(sources.begin(), sources.end(), source);
            return at != sources.end() && *at == source
                       ? static_cast<uint32_t>(at - sources.begin())
                       : kNone;
        };
        for (const uint32_t source : sources) {
            const BorderLife& life = life_of(source);
            BorderPoint point{source, life.dies, 0, static_cast<uint32_t>(level.touches.size())};
            const uint32_t heir = life.dies == BorderPoint::kLasts ? kNone : place_of(life.heir);
            // An heir inside of a chunk: no border runs there any more.
            if (heir == kNone)
                point.dies = BorderPoint::kLasts;
            else
                point.heir = heir;
            level.points.push_back(point);
            level.touches.insert(level.touches.end(), life.chunks.begin(), life.chunks.end());
        }
    }

    bool has(uint32_t source) const {
        const auto at = find(source);
        return at != lives_.end() && at->id == source;
    }

private:
    struct BorderLife {
        uint32_t id;    // its first number
        uint32_t dies;  // as BorderPoint
        uint32_t heir;  // a first number
        std::vector<uint16_t> chunks;
    };
    std::vector<BorderLife>::const_iterator find(uint32_t source) const {
        return std::lower_bound(lives_.begin(), lives_.end(), source,
                                [](const BorderLife& life, uint32_t id) { return life.id < id; });
    }
    const BorderLife& life_of(uint32_t source) const { return *find(source); }

    std::vector<BorderLife> lives_;
};

/// Numbers the points of a level, given the source of each vertex (kNone: inside of a chunk), and
/// lists its corners; returns the points' sources.
std::vector<uint32_t> list_corners(std::span<const uint32_t> source_of, SurfaceLevel& level) {
    std::vector<uint32_t> sources;
    for (const uint32_t source : source_of) {
        if (source != kNone)
            sources.push_back(source);
    }
    std::sort(sources.begin(), sources.end());
    sources.erase(std::unique(sources.begin(), sources.end()), sources.end());
    for (uint32_t vertex = 0; vertex < source_of.size(); ++vertex) {
        if (source_of[vertex] == kNone)
            continue;
        const auto at = std::lower_bound(sources.begin(), sources.end(), source_of[vertex]);
        level.corners.push_back({vertex, static_cast<uint32_t>(at - sources.begin())});
    }
    return sources;
}

/// Sorts the triangles by their nodes, and counts them.
void sort_triangles(std::span<const uint16_t> nodes, Mesh& mesh, SurfaceLevel& level) {
    level.before.assign(level.nodes() + size_t{1}, 0);
    if (nodes.empty()) {  // it is whole
        level.before.back() = static_cast<uint32_t>(mesh.triangles.size());
        return;
    }
    for (const uint16_t node : nodes)
        ++level.before[node + size_t{1}];
    for (size_t i = 0; i + 1 < level.before.size(); ++i)
        level.before[i + 1] += level.before[i];
    std::vector<uint32_t> next(level.before.begin(), level.before.end() - 1);
    Mesh sorted;
    sorted.triangles.resize(mesh.triangles.size());
    sorted.slots.resize(mesh.slots.size());
    for (size_t t = 0; t < nodes.size(); ++t) {
        const uint32_t to = next[nodes[t]]++;
        sorted.triangles[to] = mesh.triangles[t];
        if (!mesh.slots.empty())
            sorted.slots[to] = mesh.slots[t];
    }
    mesh.triangles = std::move(sorted.triangles);
    mesh.slots = std::move(sorted.slots);
}

/// A level before it is known what becomes of its border.
struct UnfinishedLevel {
    std::shared_ptr<SurfaceLevel> level;
    std::vector<uint32_t> sources;
};

class SurfaceSimplifier {
public:
    SurfaceSimplifier(const Mesh& mesh, std::shared_ptr<const SurfaceTree> tree,
                      std::span<const uint16_t> chunks, const SimplifyOptions& options,
                      const Job& job)
        : mesh_(mesh),
          tree_(std::move(tree)),
          job_(job),
          working_(open_collapse_mesh(mesh, job, {}, &adjacency_, chunks)),
          lives_(working_, adjacency_),
          reducer_(working_, kept(options)) {
        level_.shift = 0;
        auto original = std::make_shared<SurfaceLevel>();
        original->tree = tree_;
        original->before.assign(tree_->chunks() + size_t{1}, 0);
        for (const uint16_t chunk : chunks)
            ++original->before[chunk + size_t{1}];
        for (size_t i = 0; i + 1 < original->before.size(); ++i)
            original->before[i + 1] += original->before[i];
        std::vector<uint32_t> source_of(mesh.positions.size(), kNone);
        for (uint32_t v = 0; v < source_of.size(); ++v) {
            if (lives_.has(working_.merged[v]))
                source_of[v] = working_.merged[v];
        }
        unfinished_.push_back({original, list_corners(source_of, *original)});
    }

    /// False: nothing more can be collapsed.
    bool run(size_t target, SimplifiedSurface& out) {
        if (working_.live == 0)
            return false;
        const double coarser =
            static_cast<double>(mesh_.triangles.size()) / static_cast<double>(target);
        part(std::min(tree_->depth, static_cast<uint32_t>(std::log2(coarser))));
        const size_t before = working_.live;
        bool reached = reduce(target);
        if (!reached && level_.shift < tree_->depth) {
            part(tree_->depth);
            reached = reduce(target);
        }
        ++level_.step;
        if (!reached && working_.live == before)
            return false;
        fit_surface(working_, mesh_, adjacency_, kFastFit, job_);
        const std::vector<glm::vec3> normals = fit_attributes(working_, mesh_, adjacency_, job_);
        auto level = std::make_shared<SurfaceLevel>(level_);
        std::vector<uint32_t> places;
        out.levels.push_back(extract(working_, &places, normals));
        for (uint32_t& place : places)
            place = working_.on_border(adjacency_.around(place)) ? working_.ids[place] : kNone;
        unfinished_.push_back({level, list_corners(places, *level)});
        sort_triangles(working_.chunks, out.levels.back(), *level);
        lives_.pass(working_, level_.step);
        return reached;
    }

    void finish(SimplifiedSurface& out) {
        for (const UnfinishedLevel& one : unfinished_) {
            lives_.describe(one.sources, *one.level);
            one.level->hash = hash_of(*one.level);
        }
        out.original = unfinished_.front().level;
        for (size_t i = 1; i < unfinished_.size(); ++i)
            out.chunks.push_back(unfinished_[i].level);
    }

private:
    static SimplifyOptions kept(SimplifyOptions options) {
        options.keep_topology = true;
        return options;
    }
    void part(uint32_t shift) {
        if (level_.tree == nullptr)
            level_.tree = tree_;
        if (shift <= level_.shift)
            return;
        for (uint16_t& chunk : working_.chunks)
            chunk = static_cast<uint16_t>(chunk >> (shift - level_.shift));
        level_.shift = shift;
        if (shift < tree_->depth)
            return;
        working_.chunks.clear();
        reducer_.free_topology();
    }
    bool reduce(size_t target) {
        return reducer_.reduce(
            target, job_, [] {}, adjacency_);
    }

    const Mesh& mesh_;
    std::shared_ptr<const SurfaceTree> tree_;
    const Job& job_;
    Adjacency adjacency_;
    CollapseMesh working_;
    BorderLives lives_;
    CollapseReducer reducer_;
    SurfaceLevel level_;  // its step and its nodes so far
    std::vector<UnfinishedLevel> unfinished_;
};

}  // namespace

SimplifiedSurface simplify_surface(const Mesh& mesh, std::shared_ptr<const SurfaceTree> tree,
                                   std::span<const uint16_t> chunks,
                                   std::span<const size_t> targets, const SimplifyOptions& options,
                                   const Job& job) {
    check(mesh);
    if (tree == nullptr || chunks.size() != mesh.triangles.size())
        fail(Status::InvalidArgument, "chunks of another mesh");
    SimplifiedSurface out;
    SurfaceSimplifier simplifier(mesh, std::move(tree), chunks, options, job);
    for (size_t i = 0; i < targets.size(); ++i) {
        if (targets[i] == 0 || targets[i] >= (i > 0 ? targets[i - 1] : mesh.triangles.size()))
            fail(Status::InvalidArgument, "target ", i, " is ", targets[i],
                 "; targets must be above 0 and fall");
        const bool reached = simplifier.run(targets[i], out);
        job.progress(static_cast<double>(i + 1) / static_cast<double>(targets.size()));
        if (!reached)
            break;
    }
    simplifier.finish(out);
    return out;
}

}  // namespace lodestone::simplify
