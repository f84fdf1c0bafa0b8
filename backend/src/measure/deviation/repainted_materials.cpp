// SPDX-License-Identifier: GPL-3.0-or-later
// Repainted materials: levels whose triangles show the material of what lay on them.
#include "base/parallel.h"
#include "measure/deviation/sample_errors.h"
#include "measure/deviation/surface_deviation.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <span>

namespace lodestone::measure {
namespace {

/// The fewest votes that repaint a triangle.
/// Taste: a larger value leaves small triangles the material they have.
constexpr uint32_t kLeastVotes = 3;
// The fewest votes that give a triangle texture coordinates.
// Law: coordinates that are linear on a plane have six unknowns, and need more points (two
// equations each) than make them.
constexpr size_t kLeastTextured = 8;
/// The share of the voters that must see their color again with the new texture coordinates.
/// Taste: a larger value repaints fewer textured triangles.
constexpr double kLeastRight = 0.9;

/// Texture coordinates as an affine function of the place on a plane.
struct UvMap {
    glm::dvec3 origin{0.0};
    glm::dvec3 x{0.0};  // unit, in the plane
    glm::dvec3 y{0.0};
    std::array<glm::dvec3, 2> rows{};  // (u, v) = rows * (along x, along y, 1)

    glm::dvec3 place(const glm::dvec3& point) const {
        return {glm::dot(point - origin, x), glm::dot(point - origin, y), 1};
    }
    glm::dvec2 at(const glm::dvec3& point) const {
        const glm::dvec3 here = place(point);
        return {glm::dot(rows[0], here), glm::dot(rows[1], here)};
    }
};

using Voters = std::vector<const SurfaceSample*>;

/// A vote that the level's triangle nearest to a point shows the point's slot.
struct SlotVote {
    uint32_t triangle;
    uint16_t slot;
    const SurfaceSample* voter;
};

/// Finds the map of a triangle's plane that suits the voters best; none where they lie in a line.
std::optional<UvMap> fit(const Mesh& level, uint32_t triangle, const Voters& voters) {
    const Triangle& t = level.triangles[triangle];
    UvMap map;
    const glm::dvec3 normal = area_vector(level, triangle);
    const glm::dvec3 side = glm::dvec3(level.positions[t.y]) - glm::dvec3(level.positions[t.x]);
    if (!(glm::length(normal) > 0))
        return std::nullopt;
    map.x = glm::normalize(side);
    map.y = glm::normalize(glm::cross(normal, side));
    for (const SurfaceSample* voter : voters)
        map.origin += voter->point / static_cast<double>(voters.size());
    glm::dmat3 square(0.0);
    std::array<glm::dvec3, 2> right{};
    for (const SurfaceSample* voter : voters) {
        const glm::dvec3 place = map.place(voter->point);
        square += glm::outerProduct(place, place);
        right[0] += voter->uv.x * place;
        right[1] += voter->uv.y * place;
    }
    // Coordinates in the plane about the voters' middle: the last row and column are 0 but for the
    // count.
    const double spread = square[0][0] + square[1][1];
    const double determinant = square[0][0] * square[1][1] - square[0][1] * square[0][1];
    if (!(determinant > 1e-4 * spread * spread))
        return std::nullopt;
    const glm::dmat3 inverse = glm::inverse(square);
    map.rows = {inverse * right[0], inverse * right[1]};
    return map;
}

/// Gives a triangle corners of its own with other texture coordinates.
void set_uvs(Mesh& level, uint32_t triangle, const UvMap& map) {
    for (int corner = 0; corner < 3; ++corner) {
        uint32_t& vertex = level.triangles[triangle][corner];
        const uint32_t from = vertex;
        vertex = static_cast<uint32_t>(level.positions.size());
        level.positions.push_back(glm::vec3(level.positions[from]));
        level.uvs.emplace_back(map.at(glm::dvec3(level.positions[from])));
        if (!level.normals.empty())
            level.normals.push_back(glm::vec3(level.normals[from]));
        if (!level.colors.empty())
            level.colors.push_back(glm::vec4(level.colors[from]));
    }
}

/// Whether the triangle, painted with `slot` and the map, shows what the voters show.
bool shows_the_same(const Mesh& level, uint32_t triangle, uint16_t slot, const UvMap& map,
                    const ray::MeshSkin& skin, const Voters& voters) {
    // The probe is one triangle that is all map: its corners' coordinates are looked up where each
    // voter is.
    Mesh probe;
    probe.positions.resize(3);
    probe.triangles = {{0, 1, 2}};
    probe.slots = {slot};
    if (!level.colors.empty()) {
        for (int corner = 0; corner < 3; ++corner)
            probe.colors.push_back(level.colors[level.triangles[triangle][corner]]);
    }
    size_t right = 0;
    for (const SurfaceSample* voter : voters) {
        probe.uvs.assign(3, glm::vec2(map.at(voter->point)));
        const glm::dvec3 color = LookPalette::color_of(skin.at(probe, 0, 1.0 / 3, 1.0 / 3));
        right += LookPalette::alike(color, voter->color) ? 1 : 0;
    }
    return static_cast<double>(right) >= kLeastRight * static_cast<double>(voters.size());
}

/// Whether a level has the one slot that all points show, so that there is nothing to vote on.
bool shows_one_slot(const Mesh& level, const std::vector<SurfaceSample>& points) {
    const uint16_t slot = level.slots.front();
    return std::all_of(points.begin(), points.end(),
                       [&](const SurfaceSample& point) {
                           return point.look == kAnyLook || point.slot == slot;
                       }) &&
           std::all_of(level.slots.begin(), level.slots.end(),
                       [&](uint16_t other) { return other == slot; });
}

/// The step between points that vote: some dozens a triangle are enough.
size_t step_for(size_t triangles, size_t points) {
    // Votes of a triangle, in the mean.
    // Taste: a larger value is surer of each triangle's material, for a search each.
    constexpr size_t kVotes = 24;
    // The largest step; points of one place lie in a row.
    // Taste: a larger value is faster and may pass over small triangles.
    constexpr size_t kMostStep = 8;
    return std::clamp<size_t>(points / (kVotes * std::max<size_t>(triangles, 1)), 1, kMostStep);
}

}  // namespace

DeviationReference::RepaintResult DeviationReference::repaint(Mesh& level,
                                                              const ray::MeshSkin* skin,
                                                              const Job& job, bool rough,
                                                              double useless) const {
    const std::vector<SurfaceSample>& points = seen_.points;
    RepaintResult out;
    if (level.slots.empty() || shows_one_slot(level, points))
        return out;
    std::vector<ray::ClosestPoint>& nearest = out.nearest;
    nearest.resize(points.size());
    out.scene =
        std::make_shared<const ray::MeshScene>(level, nullptr, ray::SceneUse::ClosestPoints);
    const auto search = [&](const auto& wanted) {
        parallel_for((points.size() + kBlock - 1) / kBlock, [&](size_t block) {
            job.check();
            uint32_t last = ray::kNoTriangle;
            const size_t end = std::min(points.size(), (block + 1) * kBlock);
            for (size_t i = block * kBlock; i < end; ++i) {
                if (!wanted(i))
                    continue;
                nearest[i] = out.scene->closest_point(
                    points[i].point, std::numeric_limits<double>::infinity(), last);
                last = nearest[i].triangle;
            }
        });
    };
    if (std::isfinite(useless) && !(skin != nullptr && skin->see_through(level))) {
        std::vector<size_t> some;
        std::vector<uint8_t> asked(points.size(), 0);
        size_t count = 0;
        for (size_t i = 0; i < points.size(); ++i) {
            if ((rough && !is_rough_sample(i)) || count++ % kLookSampleStep != 0)
                continue;
            some.push_back(i);
            asked[i] = 1;
        }
        search([&](size_t i) { return asked[i] != 0; });
        std::vector<double> places(points.size(), 0);
        for (const size_t i : some)
            places[i] = nearest[i].distance;
        const std::vector<double> moves(points.size(), 0);
        out.surely_useless = surely_above(useless, points, some, places, moves);
        if (out.surely_useless)
            return out;
    }
    const size_t step = step_for(level.triangles.size(), points.size());
    const auto votes_at = [&](size_t i) { return points[i].look != kAnyLook && i % step == 0; };
    search([&](size_t i) { return votes_at(i) && !std::isfinite(nearest[i].distance); });
    std::vector<SlotVote> votes;
    votes.reserve(nearest.size());
    for (size_t i = 0; i < nearest.size(); ++i) {
        if (votes_at(i) && nearest[i].triangle != ray::kNoTriangle)
            votes.push_back({nearest[i].triangle, points[i].slot, &points[i]});
    }
    std::stable_sort(votes.begin(), votes.end(), [](const SlotVote& a, const SlotVote& b) {
        return a.triangle != b.triangle ? a.triangle < b.triangle : a.slot < b.slot;
    });
    for (auto first = votes.begin(); first != votes.end();) {
        const uint32_t triangle = first->triangle;
        std::span<const SlotVote> most;
        size_t own = 0;
        while (first != votes.end() && first->triangle == triangle) {
            const auto end = std::find_if(first, votes.end(), [&](const SlotVote& other) {
                return other.triangle != triangle || other.slot != first->slot;
            });
            const std::span<const SlotVote> alike(first, end);
            if (alike.size() > most.size())
                most = alike;
            if (first->slot == level.slots[triangle])
                own = alike.size();
            first = end;
        }
        if (most.size() < kLeastVotes || most.size() <= own)
            continue;
        const uint16_t slot = most.front().slot;
        if (skin != nullptr && skin->textured(level, slot)) {
            // The triangle's own coordinates belong to another texture.
            if (most.size() < kLeastTextured)
                continue;
            Voters voters;
            for (const SlotVote& vote : most)
                voters.push_back(vote.voter);
            const std::optional<UvMap> map = fit(level, triangle, voters);
            if (!map || !shows_the_same(level, triangle, slot, *map, *skin, voters))
                continue;
            set_uvs(level, triangle, *map);
        }
        level.slots[triangle] = slot;
    }
    return out;
}

}  // namespace lodestone::measure
