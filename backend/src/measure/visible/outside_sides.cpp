// SPDX-License-Identifier: GPL-3.0-or-later
#include "measure/visible/outside_sides.h"

#include "base/disjoint_sets.h"

#include <glm/common.hpp>

#include <algorithm>
#include <cmath>

namespace lodestone::measure {
namespace {

/// Points within this share of the mesh's size are in one place: holes that small, as at the tips
/// of turned things, are none.
/// Taste: a larger value closes real gaps; single precision knows coordinates to 6e-8.
constexpr double kOnePlace = 1e-6;

/// The mesh with its points on a grid.
Mesh snapped(const Mesh& mesh) {
    Box3 box;
    for (const Triangle& t : mesh.triangles) {
        for (int corner = 0; corner < 3; ++corner) {
            const glm::dvec3 point(mesh.positions[t[corner]]);
            if (std::isfinite(point.x + point.y + point.z))
                box.add(point);
        }
    }
    Mesh out;
    if (box.empty()) {
        out.positions.resize(mesh.positions.size(), glm::vec3(0));
        return out;
    }
    const double step = kOnePlace * glm::length(box.size());
    const glm::dvec3 center = box.center();
    out.positions.reserve(mesh.positions.size());
    for (const glm::vec3& position : mesh.positions) {
        const glm::dvec3 point(position);
        // Single precision holds integers of this size.
        out.positions.emplace_back(step > 0 ? glm::vec3(glm::round((point - center) / step))
                                            : glm::vec3(0));
    }
    return out;
}

/// One use of an edge by a triangle.
struct EdgeUse {
    uint32_t to;        // the higher of its welded ends; the lower is the list it is in
    uint32_t triangle;  // times two, plus one where the triangle runs from the higher end
};

/// The connected parts of the mesh, and the answers that their edges give.
class ConnectedParts {
public:
    explicit ConnectedParts(const Mesh& mesh)
        : mesh_(mesh), welded_(weld(snapped(mesh))), parent_(mesh.positions.size()) {
        for (size_t i = 0; i < parent_.size(); ++i)
            parent_[i] = static_cast<uint32_t>(i);
        counted_.resize(mesh.triangles.size());
        for (size_t i = 0; i < counted_.size(); ++i)
            counted_[i] = join(i) ? 1 : 0;
        for (uint32_t& i : parent_)
            i = root_of(parent_, i);
        open_.resize(parent_.size(), 0);
        volume_.resize(parent_.size(), 0);
        for (size_t i = 0; i < counted_.size(); ++i)
            add_volume(i);
        list_edges();
    }

    uint32_t part(size_t triangle) const { return parent_[welded_[mesh_.triangles[triangle].x]]; }
    bool open(uint32_t part) const { return open_[part] != 0; }
    bool tangled() const { return tangled_; }
    bool turned(uint32_t part) const { return volume_[part] < 0; }

    uint32_t count() const {
        std::vector<uint8_t> used(parent_.size(), 0);
        for (size_t i = 0; i < counted_.size(); ++i)
            used[part(i)] |= counted_[i];
        return static_cast<uint32_t>(std::count(used.begin(), used.end(), 1));
    }

    size_t first_counted() const {
        return static_cast<size_t>(std::find(counted_.begin(), counted_.end(), 1) -
                                   counted_.begin());
    }

    /// Whether a mesh of one part is convex.
    bool convex() const {
        size_t faces = 0;
        std::vector<uint8_t> used(parent_.size(), 0);
        for (size_t i = 0; i < counted_.size(); ++i) {
            faces += counted_[i];
            for (int corner = 0; counted_[i] != 0 && corner < 3; ++corner)
                used[welded_[mesh_.triangles[i][corner]]] = 1;
        }
        const auto corners = static_cast<size_t>(std::count(used.begin(), used.end(), 1));
        // Euler: a sphere has two corners more than half its faces.
        if (2 * corners != faces + 4)
            return false;
        const double sign = turned(part(first_counted())) ? -1 : 1;
        return for_all_folds(unit_normals(), [&](const glm::dvec3& normal, const glm::dvec3& arm) {
            return sign * glm::dot(normal, arm) <= rounding_;
        });
    }

    bool flat() const {
        const std::vector<glm::dvec3> normals = unit_normals();
        glm::dvec3 first(0.0);
        for (const glm::dvec3& normal : normals) {
            first = first == glm::dvec3(0.0) ? normal : first;
            if (normal != glm::dvec3(0.0) && glm::dot(first, normal) < 0.999)
                return false;
        }
        return !tangled_ &&
               for_all_folds(normals, [&](const glm::dvec3& normal, const glm::dvec3& arm) {
                   return std::abs(glm::dot(normal, arm)) <= rounding_;
               });
    }

private:
    /// Whether the triangle has an inside for edges to belong to; then joins its corners.
    bool join(size_t triangle) {
        const Triangle& t = mesh_.triangles[triangle];
        const uint32_t a = welded_[t.x];
        const uint32_t b = welded_[t.y];
        const uint32_t c = welded_[t.z];
        if (a == b || b == c || c == a ||
            !std::isfinite(glm::dot(at(a) + at(b) + at(c), {1, 1, 1})))
            return false;
        lodestone::join(parent_, a, b);
        lodestone::join(parent_, a, c);
        return true;
    }

    /// Adds to six times the volume of each part, about one of its own points: that keeps the
    /// digits far from the origin.
    void add_volume(size_t triangle) {
        if (counted_[triangle] == 0)
            return;
        const Triangle& t = mesh_.triangles[triangle];
        const uint32_t own = part(triangle);
        const glm::dvec3 origin = at(own);
        volume_[own] += glm::dot(at(t.x) - origin, glm::cross(at(t.y) - origin, at(t.z) - origin));
        for (int corner = 0; corner < 3; ++corner) {
            const glm::dvec3 size = glm::abs(at(t[corner]));
            // The rounding of a coordinate in single precision, a few times.
            rounding_ = std::max(rounding_, 0x1p-22 * std::max({size.x, size.y, size.z}));
        }
    }

    /// Lists all uses of edges by their lower end; a part with an edge that is not used twice, in
    /// opposite directions, is open.
    void list_edges() {
        first_.resize(welded_.size() + 2, 0);
        for_all_uses([&](uint32_t low, EdgeUse) { ++first_[low + 2]; });
        for (size_t i = 2; i < first_.size(); ++i)
            first_[i] += first_[i - 1];
        uses_.resize(first_.back());
        for_all_uses([&](uint32_t low, EdgeUse use) { uses_[first_[low + 1]++] = use; });
        for (size_t low = 0; low < welded_.size(); ++low) {
            const auto begin = uses_.begin() + first_[low];
            const auto end = uses_.begin() + first_[low + 1];
            std::sort(begin, end, [](const EdgeUse& a, const EdgeUse& b) {
                return a.to != b.to ? a.to < b.to : a.triangle < b.triangle;
            });
            for (auto use = begin; use != end;) {
                auto next = use + 1;
                while (next != end && next->to == use->to)
                    ++next;
                const bool pair =
                    next - use == 2 && ((use[0].triangle ^ use[1].triangle) & 1u) != 0;
                if (!pair)
                    open_[parent_[low]] = 1;
                tangled_ = tangled_ || (!pair && next - use > 1);
                use = next;
            }
        }
    }

    template <typename Function>
    void for_all_uses(const Function& function) const {
        for (uint32_t i = 0; i < counted_.size(); ++i) {
            for (int corner = 0; counted_[i] != 0 && corner < 3; ++corner) {
                const uint32_t from = welded_[mesh_.triangles[i][corner]];
                const uint32_t to = welded_[mesh_.triangles[i][(corner + 1) % 3]];
                function(std::min(from, to),
                         EdgeUse{std::max(from, to), 2 * i + (from > to ? 1 : 0)});
            }
        }
    }

    /// The unit normals by triangle; 0 where there is none.
    std::vector<glm::dvec3> unit_normals() const {
        std::vector<glm::dvec3> normals(counted_.size(), glm::dvec3(0.0));
        for (size_t i = 0; i < normals.size(); ++i) {
            const glm::dvec3 area = area_vector(mesh_, i);
            const double length = glm::length(area);
            if (counted_[i] != 0 && length > 0)
                normals[i] = area / length;
        }
        return normals;
    }

    /// Whether the test holds at every inner edge, both ways: it takes the normal of one triangle,
    /// and the way from one of its corners to the corner of the other that it does not have.
    template <typename Test>
    bool for_all_folds(const std::vector<glm::dvec3>& normals, const Test& test) const {
        const auto fold = [&](size_t triangle, size_t other, size_t low, size_t high) {
            const Triangle& t = mesh_.triangles[other];
            uint32_t corner = t.x;
            for (const uint32_t next : {t.y, t.z}) {
                if (welded_[corner] == low || welded_[corner] == high)
                    corner = next;
            }
            return test(normals[triangle], at(corner) - at(mesh_.triangles[triangle].x));
        };
        for (size_t low = 0; low < welded_.size(); ++low) {
            for (uint32_t i = first_[low]; i + 1 < first_[low + 1]; ++i) {
                const EdgeUse& a = uses_[i];
                const EdgeUse& b = uses_[i + 1];
                if (a.to == b.to && (!fold(a.triangle / 2, b.triangle / 2, low, a.to) ||
                                     !fold(b.triangle / 2, a.triangle / 2, low, a.to)))
                    return false;
            }
        }
        return true;
    }

    glm::dvec3 at(uint32_t vertex) const { return glm::dvec3(mesh_.positions[vertex]); }

    const Mesh& mesh_;
    std::vector<uint32_t> welded_;
    std::vector<uint32_t> parent_;
    std::vector<uint8_t> counted_;  // by triangle
    std::vector<uint8_t> open_;     // by part
    std::vector<double> volume_;
    std::vector<uint32_t> first_;  // the first of uses_ by lower end
    std::vector<EdgeUse> uses_;
    double rounding_ = 0;
    bool tangled_ = false;  // some edge is used three times, or twice in one direction
};

}  // namespace

OutsideSides sides_of(const Mesh& mesh, const ray::MeshScene& scene) {
    OutsideSides out;
    out.of.resize(mesh.triangles.size(), VisibleSide::Both);
    if (mesh.empty())
        return out;
    const ConnectedParts parts(mesh);
    out.parts = parts.count();
    out.may_coincide = out.parts > 1 || parts.tangled();
    if (scene.see_through())
        return out;
    for (size_t i = 0; i < out.of.size(); ++i) {
        const uint32_t part = parts.part(i);
        if (!parts.open(part))
            out.of[i] = parts.turned(part) ? VisibleSide::Back : VisibleSide::Front;
    }
    if (out.parts == 1)
        out.hides_nothing =
            parts.open(parts.part(parts.first_counted())) ? parts.flat() : parts.convex();
    return out;
}

}  // namespace lodestone::measure
