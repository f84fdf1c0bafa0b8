// SPDX-License-Identifier: GPL-3.0-or-later
#include "light/sky_visibility.h"

#include "base/parallel.h"
#include "measure/visible/sobol_points.h"

#include <glm/common.hpp>
#include <glm/matrix.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <map>
#include <unordered_map>

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
// Rounds of splits that follow the shares.
// Law: log2 of kPartsOfLongest; no edge is split more often.
constexpr int kSplitRounds = 4;
// Closed meshes of up to so many triangles stay as they are: POV-Ray lets light through the edges
// of finer walls.
// Law: the meshes that the writer for POV-Ray writes without a tree.
constexpr size_t kFew = 16;
// The share of an edge's length in its triangle's longest from which it is split with it.
// Taste: a smaller value makes more triangles, a larger one thinner ones.
constexpr double kLongEnough = 0.7;
// A triangle that sees less may lie inside of something.
// Taste: a larger value looks more often, for eight rays each.
constexpr double kDark = 0.06;
constexpr int kDarkRays = 8;    // Taste: more tell better whether it does
constexpr int kFewestRays = 8;  // Taste: those of a triangle; more tell better where to split
// Triangles side by side take different parts of the Sobol sequence, so that a corner is told about
// as much as if all of its rays were one triangle's.
// Taste: about the triangles at a corner; more parts are less even where these are few.
constexpr uint32_t kParts = 8;
// Where a ray begins, above its triangle, in parts of the triangle's longest edge and of the mesh.
// Law: rays have single precision (6e-8 of the mesh); this is a large margin.
constexpr double kAboveTriangle = 1e-4;
constexpr double kAboveMesh = 4e-6;   // Law: as kAboveTriangle
constexpr double kAboveScene = 1e-6;  // Law: as kAboveTriangle, of all that hides the sky
// The steps of a unit normal's coordinates within which flat triangles face the same way.
// Taste: a larger value smooths less over folds.
constexpr double kNormalSteps = 32;

glm::dvec3 hemisphere_side(const glm::dvec3& unit) {
    const glm::dvec3 other = std::abs(unit.z) < 0.7 ? glm::dvec3(0, 0, 1) : glm::dvec3(1, 0, 0);
    return glm::normalize(glm::cross(unit, other));
}

/// The answers of the rays of one triangle.
struct TriangleShares {
    std::array<double, 3> seen{};  // by corner, weighted by how near each ray began
    std::array<double, 3> rays{};  // the sum of these weights
    /// The weights of rays that begin inside of something opaque, which are not in the others.
    std::array<double, 3> inside_rays{};
    bool inside = false;  // true: all of it lies inside of something opaque

    double share() const {
        const double sum = rays[0] + rays[1] + rays[2];
        return sum > 0 ? (seen[0] + seen[1] + seen[2]) / sum : 0;
    }
};

/// Casts the rays of one request from triangles of a mesh that lies on its surface.
class SkySampler {
public:
    explicit SkySampler(const SkyRequest& request)
        : request_(request), normal_map_(glm::transpose(glm::inverse(request.world.linear))) {
        Box3 box;
        for (const glm::vec3& position : request.surface.mesh->positions) {
            if (finite(position))
                box.add(glm::dvec3(position));
        }
        size_ = glm::length(box.size());
        to_own_.linear = glm::inverse(request.world.linear);
        above_ = kAboveMesh * size_;
        if (request.around != nullptr) {
            enlarged_ = stretch(request.world);
            above_ =
                request.error +
                std::max(above_,
                         enlarged_ > 0 ? kAboveScene * request.around->size() / enlarged_ : 0.0);
        }
    }

    double size() const { return size_; }
    /// Tells that the backs of a mesh are never seen.
    void note_closed(bool closed) { closed_ = closed; }

    /// The triangle in both frames; none for one without area.
    struct PlacedTriangle {
        std::array<glm::dvec3, 3> at;
        glm::dvec3 face;     // unit, own frame
        glm::dvec3 up;       // unit, world
        double longest = 0;  // edge, own frame
        double area = 0;     // world, twice
    };
    std::optional<PlacedTriangle> placed(const Mesh& mesh, size_t triangle) const {
        const Triangle& t = mesh.triangles[triangle];
        PlacedTriangle out;
        for (int i = 0; i < 3; ++i)
            out.at[static_cast<size_t>(i)] = glm::dvec3(mesh.positions[t[i]]);
        const glm::dvec3 face = area_vector(mesh, triangle);
        const glm::dvec3 up = normal_map_ * face;
        const double length = glm::length(face);
        const double up_length = glm::length(up);
        if (!(length > 0) || !std::isfinite(length) || !(up_length > 0) ||
            !std::isfinite(up_length))
            return {};
        out.face = face / length;
        out.up = up / up_length;
        for (size_t i = 0; i < 3; ++i)
            out.longest = std::max(out.longest, glm::length(out.at[(i + 1) % 3] - out.at[i]));
        const glm::dmat3& m = request_.world.linear;
        out.area =
            glm::length(glm::cross(m * (out.at[1] - out.at[0]), m * (out.at[2] - out.at[0])));
        return out;
    }

    /// Whether the sky is hidden, on a ray from a point of the mesh (own frame, world direction).
    bool hidden(const glm::dvec3& own, const glm::dvec3& direction, uint32_t& blocker) const {
        return request_.around != nullptr
                   ? request_.around->hides(request_.world(own), direction, blocker)
                   : hidden_alone(own, direction);
    }
    bool hidden_alone(const glm::dvec3& own, const glm::dvec3& direction) const {
        return request_.surface.scene->occluded(own, to_own_.linear * direction);
    }

    TriangleShares shares(const Mesh& mesh, size_t triangle, int rays) const {
        TriangleShares out;
        const std::optional<PlacedTriangle> placed = this->placed(mesh, triangle);
        if (!placed)
            return out;
        const bool both = !request_.surface.opaque_slot(mesh.slot(triangle));
        const uint32_t first =
            static_cast<uint32_t>(triangle % kParts) * static_cast<uint32_t>(rays);
        const double reach = placed->longest * enlarged_;
        uint32_t blocker = ray::PlacedScenes::kNothing;
        // Rays are cast in pairs: from one point to both sides of the normal, or from both sides of
        // the triangle. Where one of the first kind begins inside of something, so does the other.
        for (int i = 0; i < rays; i += 2) {
            const uint32_t number = first + static_cast<uint32_t>(i / 2);
            const SkyRay pair[] = {ray(mesh, triangle, *placed, number, false),
                                   both ? ray(mesh, triangle, *placed, number, true)
                                        : ray(mesh, triangle, *placed, number, false, true)};
            double seen = 0;
            bool inside = false;
            for (const SkyRay& one : pair) {
                const bool free = one.open && !hidden(one.from, one.direction, blocker);
                seen += free ? 1 : 0;
                inside = inside || (one.open && !free && !both && meets_near_back(one, reach));
            }
            for (size_t corner = 0; corner < 3; ++corner) {
                const double weight = pair[0].weights[corner];
                (inside ? out.inside_rays : out.rays)[corner] += 2 * weight;
                if (!inside)
                    out.seen[corner] += seen * weight;
            }
        }
        const bool dark = !both && out.share() < kDark;
        out.inside = dark && lies_inside(mesh, triangle, *placed);
        if (dark && !out.inside && !closed_)
            add_back(mesh, triangle, *placed, rays, out);
        return out;
    }

    /// One ray: from where, whereto, and how near to the corners it begins.
    struct SkyRay {
        glm::dvec3 from;       // own frame
        glm::dvec3 direction;  // unit, world
        std::array<double, 3> weights;
        bool open = false;  // false: it points into the surface
    };
    SkyRay ray(const Mesh& mesh, size_t triangle, const PlacedTriangle& placed, uint32_t number,
               bool back, bool opposite = false) const {
        const std::array<double, 4> point = points_.point(number);
        const double root = std::sqrt(point[0]);
        SkyRay out;
        out.weights = {1 - root, root * (1 - point[1]), root * point[1]};
        glm::dvec3 at(0.0);
        glm::dvec3 smooth(0.0);
        const Triangle& t = mesh.triangles[triangle];
        for (size_t i = 0; i < 3; ++i) {
            at += out.weights[i] * placed.at[i];
            if (!mesh.normals.empty())
                smooth += out.weights[i] * glm::dvec3(mesh.normals[t[static_cast<int>(i)]]);
        }
        glm::dvec3 normal = normal_map_ * smooth;
        const double length = glm::length(normal);
        normal = length > 0 && std::isfinite(length) && glm::dot(normal, placed.up) > 0
                     ? normal / length
                     : placed.up;
        const double side = back ? -1 : 1;
        normal *= side;
        const glm::dvec3 u = hemisphere_side(normal);
        const glm::dvec3 v = glm::cross(normal, u);
        const double turn = 2 * kPi * (opposite ? point[2] + 0.5 : point[2]);
        out.direction = std::sqrt(point[3]) * (std::cos(turn) * u + std::sin(turn) * v) +
                        std::sqrt(1 - point[3]) * normal;
        out.from = at + side * (above_ + kAboveTriangle * placed.longest) * placed.face;
        out.open = side * glm::dot(out.direction, placed.up) > 0;
        return out;
    }

    /// Whether a triangle lies inside of something opaque: many of its rays meet backs.
    bool lies_inside(const Mesh& mesh, size_t triangle, const PlacedTriangle& placed) const {
        int backs = 0;
        for (int i = 0; i < kDarkRays; ++i) {
            const SkyRay ray = this->ray(mesh, triangle, placed, static_cast<uint32_t>(i), false);
            backs += meets_near_back(ray, size_ * enlarged_) ? 1 : 0;
        }
        return 2 * backs >= kDarkRays;
    }

private:
    /// Makes the share of a dark triangle the mean of its sides: it may be the wall of a cave, or
    /// face the wrong way, and be seen from its back. Only the sky above counts there, for under a
    /// ground nobody looks.
    void add_back(const Mesh& mesh, size_t triangle, const PlacedTriangle& placed, int rays,
                  TriangleShares& out) const {
        std::array<double, 3> seen{};
        std::array<double, 3> weights{};
        uint32_t blocker = ray::PlacedScenes::kNothing;
        for (int i = 0; i < rays; ++i) {
            const SkyRay ray = this->ray(mesh, triangle, placed, static_cast<uint32_t>(i), true);
            const bool free =
                ray.open && ray.direction.z > 0 && !hidden(ray.from, ray.direction, blocker);
            for (size_t corner = 0; corner < 3; ++corner) {
                weights[corner] += ray.weights[corner];
                seen[corner] += free ? ray.weights[corner] : 0;
            }
        }
        for (size_t corner = 0; corner < 3; ++corner) {
            const double back = weights[corner] > 0 ? seen[corner] / weights[corner] : 0;
            out.seen[corner] = (out.seen[corner] + back * out.rays[corner]) / 2;
        }
    }

    /// Whether a ray ends at the back of something opaque within `reach` (world): the back of a
    /// roof is farther than that of what a thing stands in.
    bool meets_near_back(const SkyRay& ray, double reach) const {
        const SkyScene::SkyBlock block =
            request_.around != nullptr
                ? request_.around->first_block(request_.world(ray.from), ray.direction)
                : first_block(request_.surface, ray.from, to_own_.linear * ray.direction);
        return block.back && block.t <= reach;
    }

    const SkyRequest& request_;
    glm::dmat3 normal_map_;
    Affine to_own_;
    double size_ = 0;
    double above_ = 0;     // where rays begin, own frame
    double enlarged_ = 1;  // by the placement
    bool closed_ = true;
    measure::SobolPoints points_{7};
};

/// The shares of a mesh's triangles while it is being split.
class SkyBake {
public:
    SkyBake(const SkyRequest& request, const Job& job)
        : request_(request),
          job_(job),
          sampler_(request),
          split_(*request.surface.mesh),
          most_(split_.mesh().triangles.size() + request.splits) {}

    SkyShares run() {
        const bool is_closed = closed(split_.mesh());
        sampler_.note_closed(is_closed);
        const bool may_split =
            request_.splits > 0 && (split_.mesh().triangles.size() > kFew || !is_closed);
        const double longest = sampler_.size() / kPartsOfMesh;
        if (may_split)
            split_long(longest);
        shares_.resize(split_.mesh().triangles.size());
        std::vector<uint32_t> all(shares_.size());
        for (uint32_t i = 0; i < all.size(); ++i)
            all[i] = i;
        sample(all);
        for (int round = 0; may_split && round < kSplitRounds; ++round) {
            if (!split_steps(longest / kPartsOfLongest))
                break;
        }
        return finished();
    }

private:
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
            split_.split(edges);
            splits_.push_back(std::move(edges));
        }
    }

    /// The rays of a triangle: about as many as its corner with the fewest triangles needs.
    int rays_of(size_t triangle) const {
        const Triangle& t = split_.mesh().triangles[triangle];
        uint32_t fewest = ~uint32_t{0};
        for (int corner = 0; corner < 3; ++corner)
            fewest = std::min(fewest, around_[split_.welded()[t[corner]]]);
        const int wanted = request_.rays / static_cast<int>(std::max(fewest, 1u));
        return std::clamp(wanted, std::min(kFewestRays, request_.rays), request_.rays);
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
            for (size_t i = block * kBlock; i < end; ++i)
                shares_[triangles[i]] = sampler_.shares(mesh, triangles[i], rays_of(triangles[i]));
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
            if (!opaque(i))
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
            // Beyond a fold the share may be another one without need for splits.
            if (!(glm::dot(area_vector(mesh, a), area_vector(mesh, b)) > 0))
                continue;
            const double step = std::abs(shares_[a].share() - shares_[b].share());
            if (step < kStep)
                continue;
            for (const uint32_t triangle : {a, b})
                steps[triangle] = std::max(steps[triangle], step);
        }
        std::vector<std::pair<double, uint32_t>> wanted;
        for (uint32_t i = 0; i < steps.size(); ++i) {
            const double longest = steps[i] > 0 ? longest_edge(i) : 0;
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
        const std::vector<uint32_t> parents = split_.split(edges);
        splits_.push_back(std::move(edges));
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
        return true;
    }

    /// Corners share a number where they are at one place and face the same way.
    struct CornerKey {
        uint32_t vertex;
        std::array<int, 3> normal;
        bool opaque;
        bool operator==(const CornerKey&) const = default;
    };
    struct CornerKeyHash {
        size_t operator()(const CornerKey& key) const {
            uint64_t out = key.vertex * uint64_t{2} + (key.opaque ? 1 : 0);
            for (const int part : key.normal)
                out = measure::scramble(out + static_cast<uint64_t>(part + 64));
            return static_cast<size_t>(out);
        }
    };
    CornerKey key_of(size_t triangle, int corner) const {
        const Mesh& mesh = split_.mesh();
        const uint32_t vertex = mesh.triangles[triangle][corner];
        glm::dvec3 normal =
            mesh.normals.empty() ? area_vector(mesh, triangle) : glm::dvec3(mesh.normals[vertex]);
        const double length = glm::length(normal);
        CornerKey key{split_.welded()[vertex], {}, opaque(triangle)};
        if (length > 0 && std::isfinite(length)) {
            for (int i = 0; i < 3; ++i)
                key.normal[static_cast<size_t>(i)] =
                    static_cast<int>(std::lround(kNormalSteps * normal[i] / length));
        }
        return key;
    }

    SkyShares finished() {
        const Mesh& mesh = split_.mesh();
        SkyShares out;
        out.splits = std::move(splits_);
        std::unordered_map<CornerKey, uint32_t, CornerKeyHash> known;
        known.reserve(mesh.triangles.size());
        std::vector<uint32_t> groups(3 * mesh.triangles.size());
        struct GroupShares {
            double seen = 0;
            double rays = 0;
            double all_seen = 0;  // those inside of something too
            double all_rays = 0;
        };
        std::vector<GroupShares> sums;
        double seen = 0;
        double area = 0;
        double all_seen = 0;  // those inside of something too
        double all_area = 0;
        for (size_t i = 0; i < mesh.triangles.size(); ++i) {
            const TriangleShares& shares = shares_[i];
            const std::optional<SkySampler::PlacedTriangle> placed = sampler_.placed(mesh, i);
            const double own = placed ? placed->area : 0;
            const double rays = shares.rays[0] + shares.rays[1] + shares.rays[2];
            const double inside_rays =
                shares.inside_rays[0] + shares.inside_rays[1] + shares.inside_rays[2];
            if (rays + inside_rays > 0) {
                all_seen += own * shares.share() * rays / (rays + inside_rays);
                all_area += own;
            }
            if (rays > 0 && !shares.inside) {
                seen += own * shares.share();
                area += own;
            }
            for (int corner = 0; corner < 3; ++corner) {
                const size_t at = static_cast<size_t>(corner);
                const auto [found, fresh] =
                    known.try_emplace(key_of(i, corner), static_cast<uint32_t>(sums.size()));
                if (fresh)
                    sums.emplace_back();
                groups[3 * i + at] = found->second;
                if (!(rays + inside_rays > 0))
                    continue;
                GroupShares& group = sums[found->second];
                const double weight = own / (rays + inside_rays);
                group.all_seen += weight * shares.seen[at];
                group.all_rays += weight * (shares.rays[at] + shares.inside_rays[at]);
                if (!shares.inside) {
                    group.seen += weight * shares.seen[at];
                    group.rays += weight * shares.rays[at];
                }
            }
        }
        out.mean = area > 0 ? seen / area : (all_area > 0 ? all_seen / all_area : 1);
        out.corners.reserve(groups.size());
        for (const uint32_t index : groups) {
            const GroupShares& group = sums[index];
            const double share = group.rays > 0       ? group.seen / group.rays
                                 : group.all_rays > 0 ? group.all_seen / group.all_rays
                                                      : out.mean;
            out.corners.push_back(share_byte(share));
        }
        return out;
    }

    const SkyRequest& request_;
    const Job& job_;
    SkySampler sampler_;
    geometry::EdgeSplitMesh split_;
    size_t most_;
    std::vector<TriangleShares> shares_;
    std::vector<uint32_t> around_;  // triangles at each welded vertex
    std::vector<std::vector<geometry::WeldedEdge>> splits_;
};

/// Appends a number as its bytes.
template <typename Number>
void append_bytes(std::string& out, Number number) {
    char bytes[sizeof number];
    std::memcpy(bytes, &number, sizeof number);
    out.append(bytes, sizeof number);
}

/// Takes numbers from the beginning of some bytes.
class ByteReader {
public:
    explicit ByteReader(std::string_view bytes) : rest_(bytes) {}
    template <typename Number>
    bool take(Number& number) {
        if (rest_.size() < sizeof number)
            return false;
        std::memcpy(&number, rest_.data(), sizeof number);
        rest_.remove_prefix(sizeof number);
        return true;
    }
    std::string_view rest() const { return rest_; }

private:
    std::string_view rest_;
};

}  // namespace

uint8_t share_byte(double share) {
    return static_cast<uint8_t>(std::lround(kShareSteps * std::sqrt(limited(share, 0, 1))));
}

double share_of_byte(uint8_t byte) {
    const double root = static_cast<double>(byte) / kShareSteps;
    return root * root;
}

std::string SkyShares::bytes() const {
    std::string out;
    append_bytes(out, mean);
    append_bytes(out, static_cast<uint32_t>(splits.size()));
    for (const std::vector<geometry::WeldedEdge>& edges : splits) {
        append_bytes(out, static_cast<uint32_t>(edges.size()));
        for (const geometry::WeldedEdge edge : edges)
            append_bytes(out, edge);
    }
    out.append(reinterpret_cast<const char*>(corners.data()), corners.size());
    return out;
}

std::optional<SkyShares> SkyShares::of_bytes(std::string_view bytes, size_t triangles) {
    ByteReader reader(bytes);
    SkyShares out;
    uint32_t rounds = 0;
    if (!reader.take(out.mean) || !(out.mean >= 0 && out.mean <= 1) || !reader.take(rounds) ||
        rounds > 2 * kSplitRounds)
        return {};
    for (uint32_t round = 0; round < rounds; ++round) {
        uint32_t count = 0;
        if (!reader.take(count) || count > reader.rest().size() / sizeof(geometry::WeldedEdge))
            return {};
        std::vector<geometry::WeldedEdge>& edges = out.splits.emplace_back(count);
        for (geometry::WeldedEdge& edge : edges)
            reader.take(edge);
        if (!std::is_sorted(edges.begin(), edges.end()))
            return {};
    }
    const std::string_view rest = reader.rest();
    if (rest.size() % 3 != 0 || rest.size() / 3 < triangles ||
        (rounds == 0 && rest.size() / 3 != triangles))
        return {};
    out.corners.resize(rest.size());
    std::memcpy(out.corners.data(), rest.data(), rest.size());
    return out;
}

std::optional<Mesh> split_for_sky(const Mesh& mesh, const SkyShares& shares) {
    const size_t most = shares.corners.size() / 3;
    if (mesh.triangles.size() > most)
        return {};
    geometry::EdgeSplitMesh split(mesh);
    for (const std::vector<geometry::WeldedEdge>& edges : shares.splits) {
        if (split.triangles_after(edges) > most)
            return {};
        split.split(edges);
    }
    if (split.mesh().triangles.size() != most)
        return {};
    return split.take();
}

SkyShares sky_shares(const SkyRequest& request, const Job& job) {
    return SkyBake(request, job).run();
}

SkyMeans mean_sky_shares(const SkyRequest& request, int rays) {
    const SkySampler sampler(request);
    const Mesh& mesh = *request.surface.mesh;
    std::vector<double> areas(mesh.triangles.size());
    double sum = 0;
    for (size_t i = 0; i < areas.size(); ++i) {
        const std::optional<SkySampler::PlacedTriangle> placed = sampler.placed(mesh, i);
        areas[i] = sum += placed ? placed->area : 0;
    }
    SkyMeans out;
    if (!(sum > 0) || rays < 1)
        return out;
    const ray::FlushDenormals fast;
    // The sums of all rays, and of those that begin inside of something opaque.
    struct MeanSums {
        double placed = 0;
        double alone = 0;
        double rays = 0;
    };
    MeanSums all;
    MeanSums inside;
    uint32_t blocker = ray::PlacedScenes::kNothing;
    for (int i = 0; i < rays; ++i) {
        const double place = sum * (i + 0.5) / rays;
        const size_t triangle = static_cast<size_t>(
            std::lower_bound(areas.begin(), areas.end(), place) - areas.begin());
        if (triangle >= areas.size())
            continue;
        const std::optional<SkySampler::PlacedTriangle> placed = sampler.placed(mesh, triangle);
        if (!placed)
            continue;
        const bool both = !request.surface.opaque_slot(mesh.slot(triangle));
        const SkySampler::SkyRay ray =
            sampler.ray(mesh, triangle, *placed, static_cast<uint32_t>(i), both && i % 2 == 1);
        const double alone = ray.open && !sampler.hidden_alone(ray.from, ray.direction) ? 1 : 0;
        const double seen = alone > 0 && !sampler.hidden(ray.from, ray.direction, blocker) ? 1 : 0;
        all.placed += seen;
        all.alone += alone;
        all.rays += 1;
        if (seen == 0 && !both && sampler.lies_inside(mesh, triangle, *placed)) {
            inside.alone += alone;
            inside.rays += 1;
        }
    }
    if (inside.rays < all.rays) {
        all.alone -= inside.alone;
        all.rays -= inside.rays;
    }
    if (all.rays > 0) {
        out.alone = all.alone / all.rays;
        out.placed = all.placed / all.rays;
    }
    return out;
}

}  // namespace lodestone::light
