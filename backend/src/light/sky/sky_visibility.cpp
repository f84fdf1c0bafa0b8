// SPDX-License-Identifier: GPL-3.0-or-later
#include "light/sky/sky_visibility.h"

#include "base/parallel.h"
#include "light/sky/corner_shares.h"

#include <glm/common.hpp>
#include <glm/matrix.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

namespace lodestone::light {
namespace {

// The parts of a mesh's diagonal that its opaque edges are at most long, where triangles are left.
// Taste: a larger value finds smaller things on a large ground, for more triangles everywhere.
constexpr double kPartsOfMesh = 12;
// The parts of that length below which nothing is split.
// Taste: a larger value draws sharper edges of what lies in the shade, with more triangles.
constexpr double kPartsOfLongest = 16;
// The difference between triangles side by side at which they are split.
// Taste: a smaller value splits smooth shade, too.
constexpr double kStep = 0.1;
// The share of the triangles to be added that long edges get, before anything is known.
// Taste: a larger value finds smaller things on a large ground, and follows their shade less.
constexpr double kLongShare = 0.25;
// Closed meshes of up to so many triangles stay as they are, unless they are the floor of all:
// POV-Ray lets light through the edges of finer walls.
// Law: the writer for POV-Ray writes all meshes of so few triangles without a tree.
constexpr size_t kFew = 16;
// The share of an edge's length in its triangle's longest from which it is split with it.
// Taste: a smaller value makes more triangles, a larger one thinner ones.
constexpr double kLongEnough = 0.7;
// The rays of a triangle, at least, and the part of a corner's that they are where these are few.
// Taste: more tell better where to split.
constexpr int kFewestRays = 8;
constexpr int kFewestPart = 8;  // Taste: as kFewestRays, the other way round
// The rays of a corner whose triangle covers a pixel of a picture: the noise of larger ones is seen
// over all of their pixels, and four times as large ones have twice as many.
// Taste: a larger value has less noise, for as many rays more.
constexpr double kRaysOfPixel = 32;
constexpr double kFewestCornerRays = 8;  // Taste: as kRaysOfPixel, where triangles are small
// The triangles that are not seen and have rays of their own, for the mean of all, about.
// Taste: a larger value tells the mean better; nobody sees these.
constexpr size_t kUnseenTriangles = 64;
// The rays of each of them.
// Taste: the fewest, for rays are cast in pairs.
constexpr int kUnseenRays = 2;

/// The shares of a mesh's triangles while it is being split.
class SkyBake {
public:
    SkyBake(const SkyRequest& request, const Job& job)
        : request_(request),
          job_(job),
          sampler_(request),
          split_(*request.surface.mesh),
          most_(split_.mesh().triangles.size() + request.splits),
          sources_(split_.mesh().triangles.size()) {
        std::iota(sources_.begin(), sources_.end(), 0u);
        find_thorough();
    }

    SkyShares run() {
        const bool is_closed = closed(split_.mesh());
        sampler_.note_closed(request_.original != nullptr ? closed(*request_.original->mesh)
                                                          : is_closed);
        const bool may_split =
            request_.splits > 0 &&
            (request_.floor || split_.mesh().triangles.size() > kFew || !is_closed);
        const double longest = sampler_.size() / kPartsOfMesh;
        const SkyShares* known = request_.known;
        const size_t long_rounds = known != nullptr ? known->long_rounds : 0;
        for (size_t round = 0; round < long_rounds; ++round)
            split(known->splits.at(round));
        if (known == nullptr && may_split)
            split_long(longest);
        long_rounds_ = splits_.size();
        shares_.resize(split_.mesh().triangles.size());
        std::vector<uint32_t> all(shares_.size());
        for (uint32_t i = 0; i < all.size(); ++i)
            all[i] = i;
        sample(all);
        for (size_t round = long_rounds; known != nullptr && round < known->splits.size(); ++round)
            split_and_sample(known->splits[round]);
        for (int round = 0; may_split && round < kSplitRounds; ++round) {
            if (!split_steps(longest / kPartsOfLongest))
                break;
        }
        return finished();
    }

private:
    /// Finds the triangles that have all rays: what is seen, and what shares a corner with that.
    /// Of the others it chooses some that stand for all.
    void find_thorough() {
        if (request_.seen.empty())
            return;
        const Mesh& mesh = split_.mesh();
        std::vector<uint8_t> corners(mesh.positions.size(), 0);
        for (size_t i = 0; i < mesh.triangles.size(); ++i) {
            for (int corner = 0; corner < 3; ++corner) {
                uint8_t& size = corners[split_.welded()[mesh.triangles[i][corner]]];
                size = std::max(size, request_.seen[i]);
            }
        }
        for (size_t i = 0; i < mesh.triangles.size(); ++i) {
            const Triangle& t = mesh.triangles[i];
            const auto near = [&](int corner) { return corners[split_.welded()[t[corner]]]; };
            thorough_.push_back(request_.seen[i] != 0 ? request_.seen[i]
                                                      : std::max({near(0), near(1), near(2)}));
        }
        choose_unseen();
    }
    /// Chooses triangles that are not seen evenly by their areas.
    void choose_unseen() {
        unseen_.assign(thorough_.size(), 0);
        double all = 0;
        for (size_t i = 0; i < thorough_.size(); ++i)
            all += thorough_[i] == 0 ? request_.surface.area_of(i) : 0;
        double passed = 0;
        size_t chosen = 0;
        for (size_t i = 0; i < thorough_.size(); ++i) {
            const double own = request_.surface.area_of(i);
            if (thorough_[i] != 0 || !(own > 0))
                continue;
            passed += own;
            const size_t before = chosen;
            while ((static_cast<double>(chosen) + 0.5) * all < passed * kUnseenTriangles)
                ++chosen;
            const double stands_for = static_cast<double>(chosen - before) / kUnseenTriangles * all;
            unseen_[i] = stands_for / own;
        }
    }
    /// Whether a triangle of the split mesh has all rays.
    bool thorough(size_t triangle) const {
        return thorough_.empty() || thorough_[sources_[triangle]] != 0;
    }
    /// The areas as large as its own that a triangle of the split mesh stands for.
    double area_factor(size_t triangle) const {
        return thorough(triangle) ? 1 : unseen_[sources_[triangle]];
    }
    /// Whether what is seen of a triangle of the split mesh is its back.
    bool behind(size_t triangle) const {
        return !request_.behind.empty() && request_.behind[sources_[triangle]] != 0 &&
               opaque(triangle);
    }
    /// Whether a triangle may be split by its share: it is seen, and was not when others were.
    bool may_split(size_t triangle) const {
        const uint32_t source = sources_[triangle];
        const bool seen = request_.seen.empty() || request_.seen[source] != 0;
        const SkyShares* known = request_.known;
        return seen && (known == nullptr || (!known->seen.empty() && known->seen[source] == 0));
    }

    /// Splits edges; returns for each triangle the one that it is a part of.
    std::vector<uint32_t> split(std::vector<geometry::WeldedEdge> edges) {
        std::vector<uint32_t> parents = split_.split(edges);
        std::vector<uint32_t> sources;
        sources.reserve(parents.size());
        for (const uint32_t parent : parents)
            sources.push_back(sources_[parent]);
        sources_ = std::move(sources);
        splits_.push_back(std::move(edges));
        return parents;
    }

    double length(size_t triangle, int corner) const {
        const Mesh& mesh = split_.mesh();
        const Triangle& t = mesh.triangles[triangle];
        return glm::length(glm::dvec3(mesh.positions[t[corner]]) -
                           glm::dvec3(mesh.positions[t[(corner + 1) % 3]]));
    }
    double longest_edge(size_t triangle) const {
        return std::max({length(triangle, 0), length(triangle, 1), length(triangle, 2)});
    }
    bool opaque(size_t triangle) const {
        return request_.surface.opaque_slot(split_.mesh().slot(triangle));
    }

    /// Splits the edges that are longer than that, until no more triangles may be added.
    void split_long(double longest) {
        // An edge of the mesh's diagonal is as short after log2 of that many parts.
        for (int round = 0; round < kSplitRounds; ++round) {
            job_.check();
            std::vector<geometry::WeldedEdge> edges;
            for (size_t i = 0; i < split_.mesh().triangles.size(); ++i) {
                for (int corner = 0; corner < 3; ++corner) {
                    if (length(i, corner) > longest && opaque(i))
                        edges.push_back(split_.edge(i, corner));
                }
            }
            std::sort(edges.begin(), edges.end());
            edges.erase(std::unique(edges.begin(), edges.end()), edges.end());
            // An edge has two triangles; half of the triangles are left for the steps.
            if (edges.empty() || split_.mesh().triangles.size() + 2 * edges.size() >
                                     (most_ + request_.surface.mesh->triangles.size()) / 2)
                return;
            split(std::move(edges));
        }
    }

    /// The rays of a corner of a triangle: by its size in the picture; or, where that is not known,
    /// as many more as it is larger than the mean, about twice as many in all. Noise of large ones
    /// shows.
    int rays_of_corner(size_t triangle) const {
        const SkySurface& surface = request_.surface;
        const double own = glm::length(area_vector(split_.mesh(), triangle));
        const double most = std::max(request_.rays, request_.most_rays);
        const uint32_t source = sources_[triangle];
        if (!thorough_.empty() && thorough_[source] > kSeenOfAnySize) {
            const double whole = surface.area_of(source);
            const double part = whole > 0 ? limited(own / whole, 0, 1) : 1;
            const double pixels = part * pixels_of_size(thorough_[source]);
            return static_cast<int>(
                limited(kRaysOfPixel * std::sqrt(pixels), kFewestCornerRays, most));
        }
        const double mean = surface.area() / static_cast<double>(surface.areas.size());
        return mean > 0 ? static_cast<int>(limited(request_.rays * own / mean, request_.rays, most))
                        : request_.rays;
    }

    /// The rays of a triangle: about as many as its corner with the fewest triangles needs.
    int rays_of(size_t triangle) const {
        const Triangle& t = split_.mesh().triangles[triangle];
        uint32_t fewest = ~uint32_t{0};
        for (int corner = 0; corner < 3; ++corner)
            fewest = std::min(fewest, around_[split_.welded()[t[corner]]]);
        const int of_corner = rays_of_corner(triangle);
        const int wanted = of_corner / static_cast<int>(std::max(fewest, 1u));
        // Two are the fewest, for rays are cast in pairs.
        const int least = std::clamp(of_corner / kFewestPart, 2, kFewestRays);
        return thorough(triangle) ? std::max(wanted, least) : kUnseenRays;
    }

    void sample(const std::vector<uint32_t>& triangles) {
        const Mesh& mesh = split_.mesh();
        around_.assign(mesh.positions.size(), 0);
        for (const Triangle& t : mesh.triangles) {
            for (int corner = 0; corner < 3; ++corner)
                ++around_[split_.welded()[t[corner]]];
        }
        const size_t blocks = (triangles.size() + kBlock - 1) / kBlock;
        parallel_for(blocks, [&](size_t block) {
            job_.check();
            const ray::FlushDenormals fast;
            const size_t end = std::min(triangles.size(), (block + 1) * kBlock);
            for (size_t i = block * kBlock; i < end; ++i) {
                const uint32_t triangle = triangles[i];
                if (area_factor(triangle) > 0)
                    shares_[triangle] =
                        sampler_.shares(mesh, triangle, rays_of(triangle), behind(triangle));
            }
        });
    }

    /// Splits triangles beside which the share is another one, the largest steps first; false when
    /// there are none.
    bool split_steps(double least) {
        job_.check();
        const Mesh& mesh = split_.mesh();
        std::vector<std::pair<geometry::WeldedEdge, uint32_t>> sides;
        sides.reserve(3 * mesh.triangles.size());
        for (uint32_t i = 0; i < mesh.triangles.size(); ++i) {
            if (!opaque(i) || !thorough(i))
                continue;
            for (int corner = 0; corner < 3; ++corner)
                sides.emplace_back(split_.edge(i, corner), i);
        }
        std::sort(sides.begin(), sides.end());
        std::vector<double> steps(mesh.triangles.size(), 0);
        for (size_t i = 1; i < sides.size(); ++i) {
            if (sides[i].first != sides[i - 1].first)
                continue;
            const uint32_t a = sides[i - 1].second;
            const uint32_t b = sides[i].second;
            // Beyond a fold, or on the other side, the share may be another one without need for splits.
            if (!(glm::dot(area_vector(mesh, a), area_vector(mesh, b)) > 0) ||
                behind(a) != behind(b))
                continue;
            const double step = std::abs(shares_[a].share() - shares_[b].share());
            if (step < kStep)
                continue;
            for (const uint32_t triangle : {a, b})
                steps[triangle] = std::max(steps[triangle], step);
        }
        std::vector<std::pair<double, uint32_t>> wanted;
        for (uint32_t i = 0; i < steps.size(); ++i) {
            const double longest = steps[i] > 0 && may_split(i) ? longest_edge(i) : 0;
            if (longest > least)
                wanted.emplace_back(-steps[i] * longest, i);
        }
        if (wanted.empty() || mesh.triangles.size() >= most_)
            return false;
        std::sort(wanted.begin(), wanted.end());
        // A triangle of three split edges adds three, and one beside each.
        wanted.resize(std::min(wanted.size(), (most_ - mesh.triangles.size()) / 4 + 1));
        std::vector<geometry::WeldedEdge> edges;
        for (const auto& [order, triangle] : wanted) {
            const double longest = longest_edge(triangle);
            for (int corner = 0; corner < 3; ++corner) {
                if (length(triangle, corner) >= kLongEnough * longest)
                    edges.push_back(split_.edge(triangle, corner));
            }
        }
        std::sort(edges.begin(), edges.end());
        edges.erase(std::unique(edges.begin(), edges.end()), edges.end());
        split_and_sample(std::move(edges));
        return true;
    }

    /// Splits edges, and finds the shares of the parts.
    void split_and_sample(std::vector<geometry::WeldedEdge> edges) {
        const std::vector<uint32_t> parents = split(std::move(edges));
        std::vector<uint32_t> fresh;
        std::vector<TriangleShares> shares(parents.size());
        for (uint32_t i = 0; i < parents.size(); ++i) {
            const bool part = (i > 0 && parents[i - 1] == parents[i]) ||
                              (i + 1 < parents.size() && parents[i + 1] == parents[i]);
            if (part)
                fresh.push_back(i);
            else
                shares[i] = shares_[parents[i]];
        }
        shares_ = std::move(shares);
        sample(fresh);
    }

    SkyShares finished() {
        SkyShares out;
        out.splits = std::move(splits_);
        out.long_rounds = static_cast<uint32_t>(long_rounds_);
        out.seen.assign(request_.seen.begin(), request_.seen.end());
        out.behind.assign(request_.behind.begin(), request_.behind.end());
        out.rays = static_cast<uint32_t>(std::max(request_.rays, 0));
        CornerShares corners(split_.mesh(), split_.welded(), request_.surface, request_.uneven);
        for (size_t i = 0; i < shares_.size(); ++i) {
            const std::optional<SkySampler::PlacedTriangle> placed =
                sampler_.placed(split_.mesh(), i);
            corners.add(i, shares_[i], placed ? area_factor(i) * placed->area : 0, behind(i));
        }
        if (request_.round)
            corners.share_rays();
        corners.finish(shares_, out);
        return out;
    }

    const SkyRequest& request_;
    const Job& job_;
    SkySampler sampler_;
    geometry::EdgeSplitMesh split_;
    size_t most_;
    std::vector<uint32_t> sources_;  // by triangle: that of the surface which it is a part of
    /// By triangle of the surface, the size for which it has rays: a byte of SkyShares::seen. Empty:
    /// all have all.
    std::vector<uint8_t> thorough_;
    /// By triangle as `thorough_`, where it is not: the areas as large as its own that it stands
    /// for. 0: another one stands for it.
    std::vector<double> unseen_;
    std::vector<TriangleShares> shares_;
    std::vector<uint32_t> around_;  // triangles at each welded vertex
    std::vector<std::vector<geometry::WeldedEdge>> splits_;
    size_t long_rounds_ = 0;  // of them: those of long edges
};

}  // namespace

SkyShares sky_shares(const SkyRequest& request, const Job& job) {
    return SkyBake(request, job).run();
}

}  // namespace lodestone::light
