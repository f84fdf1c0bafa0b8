// SPDX-License-Identifier: GPL-3.0-or-later
#include "povray_export/mesh/mesh_writer.h"

#include "base/error.h"
#include "povray_export/scene/povray_number.h"

#include <glm/common.hpp>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>

namespace lodestone::povray {
namespace {

/// The rounding of positions, over the mesh's size.
/// Taste: floats hold 6e-8 of it; a larger value writes shorter files and moves corners visibly.
constexpr double kPositionPrecision = 1e-6;
/// The rounding of unit normals.
/// Taste: a larger value writes shorter files, until sharp highlights show steps.
constexpr double kNormalPrecision = 5e-5;
/// The rounding of texture coordinates.
/// Taste: a fiftieth of a texel of 4096; a larger value writes shorter files.
constexpr double kUvPrecision = 5e-6;
// Meshes up to so many triangles are written without a tree over them: POV-Ray is as fast, and
// meets all of them instead of the nearest alone. A nearest hit it forgets where it is within
// 0.0001 of where a shadow ray begins: light came through walls and ceilings along their edges.
// Fitted: 1,500 bodies in POV-Ray take as long at 16 triangles (0.28 CPU s), at 32 they take 0.38
// instead of 0.33.
constexpr size_t kFew = 16;
// So are meshes of up to this many triangles whose boxes are large, as in steep cones: a ray
// through the mesh's box meets most boxes anyhow.
// Fitted: steep cones of 24 to 96 triangles take 0.73 of the time without a tree.
constexpr size_t kMostInLargeBoxes = 96;
// The mean share of a triangle's box in the mesh's, as areas, from which a box is large.
// Fitted: at 0.15 (balls of 24 triangles) both take as long, at 0.23 (cones) the tree takes longer.
constexpr double kLargeBox = 0.2;
// The size, at most, of meshes whose corners have textures of their own, in the units that they are
// written in. POV-Ray weighs such textures by quotients of determinants (areas, as an axis sees
// them) and takes the first that is over 1e-5 in these units. A wall that stands upright has none
// from above, but floats leave one of some 1e-7 times the size and the triangle's length: over
// 1e-5, that noise is taken, and the wall is patchy.
// Law: 4 x 4 x 2e-7 is below 1e-5. Triangles shorter than 0.003, a thousandth of the mesh, have the
// mean of their corners' textures.
constexpr double kWeighedSize = 4;

using Point = std::array<int64_t, 3>;

/// A pool of equal values, stored once: the number of every vertex's value, and one vertex for
/// every value.
struct ValuePool {
    std::vector<uint32_t> of_vertex;
    std::vector<uint32_t> vertices;
    size_t size() const { return vertices.size(); }
};

/// Numbers the vertices of `order` by equality, in order of first use.
template <typename Key>
ValuePool share(const std::vector<uint32_t>& order, size_t vertex_count, const Key& key_of) {
    constexpr uint32_t kFree = ~uint32_t{0};
    ValuePool pool;
    pool.of_vertex.assign(vertex_count, kFree);
    std::vector<uint32_t> table(std::bit_ceil(order.size() * 2 + 2), kFree);
    for (const uint32_t vertex : order) {
        const auto key = key_of(vertex);
        uint64_t hash = 0;
        for (const auto part : key)
            hash = (std::rotl(hash, 23) ^ static_cast<uint64_t>(part)) * 0x9e3779b97f4a7c15u;
        size_t at = (hash ^ (hash >> 32)) & (table.size() - 1);
        while (table[at] != kFree && key_of(pool.vertices[table[at]]) != key)
            at = (at + 1) & (table.size() - 1);
        if (table[at] == kFree) {
            table[at] = static_cast<uint32_t>(pool.size());
            pool.vertices.push_back(vertex);
        }
        pool.of_vertex[vertex] = table[at];
    }
    return pool;
}

/// Whether twice the area on the lattice is zero: exact, in integers.
template <typename Integer>
bool flat_on_lattice(const Point& a, const Point& b, const Point& c) {
    const auto u = [&](int i) { return static_cast<Integer>(b[i] - a[i]); };
    const auto v = [&](int i) { return static_cast<Integer>(c[i] - a[i]); };
    return u(1) * v(2) == u(2) * v(1) && u(2) * v(0) == u(0) * v(2) && u(0) * v(1) == u(1) * v(0);
}

/// The triangles that are written.
enum class WrittenTriangles { All, Glass, Rest };

class MeshText {
public:
    MeshText(const Mesh& mesh, const MeshTextures* textures, WrittenTriangles written,
             const Job& job)
        : mesh_(mesh), textures_(textures), written_(written), job_(job) {
        round_positions();
        keep_triangles();
        if (!kept_.empty())
            share_values();
    }

    bool empty() const { return kept_.empty(); }

    void append_to(std::string& out) {
        out.reserve(out.size() + 200 + positions_.size() * (smooth_ ? 48 : 24) + kept_.size() * 28);
        out += "mesh2{\n";
        append_list(out, "vertex_vectors", positions_.size(), [&](char* at, size_t i) {
            return write_point(at, lattice_, points_[positions_.vertices[i]]);
        });
        if (smooth_)
            append_list(out, "normal_vectors", normals_.size(), [&](char* at, size_t i) {
                return write_point(at, normal_lattice_, normal_points_[normals_.vertices[i]]);
            });
        if (has_uvs_)
            append_list(out, "uv_vectors", uvs_.size(), [&](char* at, size_t i) {
                return write_point(at, uv_lattice_, uv_points_[uvs_.vertices[i]]);
            });
        const bool list = textures_ != nullptr && textures_->texts().size() > 1;
        if (list) {
            out += "texture_list{";
            append_count(out, textures_->texts().size());
            for (const std::string& texture : textures_->texts())
                out += ",\n" + texture;
            out += "}\n";
        }
        append_list(out, "face_indices", kept_.size(), [&](char* at, size_t i) {
            at = write_face(at, positions_, kept_[i]);
            return list ? write_textures(at, kept_[i]) : at;
        });
        if (smooth_ && explicit_normals_)
            append_list(out, "normal_indices", kept_.size(),
                        [&](char* at, size_t i) { return write_face(at, normals_, kept_[i]); });
        if (has_uvs_ && explicit_uvs_)
            append_list(out, "uv_indices", kept_.size(),
                        [&](char* at, size_t i) { return write_face(at, uvs_, kept_[i]); });
        const bool refracts = textures_ != nullptr && textures_->refraction() > 0 &&
                              written_ != WrittenTriangles::Rest;
        if (refracts)
            out += "inside_vector <0,0,1>\n";
        if (textures_ != nullptr && !list)
            out += textures_->texts().front() + "\n";
        if (refracts) {
            out += "interior{ior ";
            append_number(out, textures_->refraction(), 6);
            out += "}\n";
        }
        if (kept_.size() <= kFew || (kept_.size() <= kMostInLargeBoxes && has_large_boxes()))
            out += "hierarchy off\n";
        if (unit_ != 1 || middle_ != glm::dvec3(0)) {
            out += "scale ";
            append_number(out, unit_);
            out += " translate ";
            append_vector(out, middle_);
            out += '\n';
        }
        out += "}\n";
    }

private:
    /// Chooses the units that the mesh is written in; see kWeighedSize.
    void choose_units(const Box3& box) {
        // Bumps are as steep as they are written: a scale would flatten them.
        if (textures_ == nullptr || !textures_->differ_in_triangles() || textures_->bumped())
            return;
        const glm::dvec3 size = box.size();
        const double largest = std::max({size.x, size.y, size.z});
        if (!(largest > 0))
            return;
        unit_ = std::exp2(std::ceil(std::log2(largest / kWeighedSize)));
        middle_ = glm::dvec3(glm::vec3(box.low + size / 2.0));
    }

    bool has_large_boxes() const {
        const auto area = [](const glm::dvec3& size) {
            return size.x * size.y + size.y * size.z + size.z * size.x;
        };
        Box3 all;
        double sum = 0;
        for (const uint32_t triangle : kept_) {
            Box3 box;
            for (int corner = 0; corner < 3; ++corner) {
                const Point& at = points_[mesh_.triangles[triangle][corner]];
                box.add({static_cast<double>(at[0]), static_cast<double>(at[1]),
                         static_cast<double>(at[2])});
            }
            sum += area(box.size());
            all.add(box.low);
            all.add(box.high);
        }
        return sum >= kLargeBox * static_cast<double>(kept_.size()) * area(all.size());
    }

    void round_positions() {
        Box3 box;
        for (size_t i = 0; i < mesh_.triangles.size(); ++i) {
            check_job_sometimes(i);
            for (int corner = 0; corner < 3; ++corner) {
                const glm::dvec3 at(mesh_.positions[mesh_.triangles[i][corner]]);
                if (!std::isfinite(at.x + at.y + at.z))
                    fail(Status::Internal, "triangle ", i, " of a mesh for POV-Ray uses vertex ",
                         mesh_.triangles[i][corner], ", which is not finite");
                box.add(at);
            }
        }
        if (box.empty())
            return;
        choose_units(box);
        const glm::dvec3 far_out = glm::max(glm::abs(box.low), glm::abs(box.high));
        const glm::dvec3 low = in_units(box.low);
        const glm::dvec3 high = in_units(box.high);
        const glm::dvec3 size = high - low;
        const glm::dvec3 far = glm::max(glm::abs(low), glm::abs(high));
        lattice_ = DecimalLattice(kPositionPrecision * std::max({size.x, size.y, size.z}),
                                  std::max({far.x, far.y, far.z}));
        narrow_ = true;  // no product of two differences leaves 64 bits
        for (int i = 0; i < 3; ++i)
            narrow_ = narrow_ && lattice_.round(high[i]) - lattice_.round(low[i]) < 1 << 30;
        points_.resize(mesh_.positions.size());
        for (size_t i = 0; i < points_.size(); ++i) {
            check_job_sometimes(i);
            const glm::dvec3 at(mesh_.positions[i]);
            // A point that no triangle uses may be anything, and is never written.
            if (glm::all(glm::lessThanEqual(glm::abs(at), far_out))) {
                const glm::dvec3 point = in_units(at);
                points_[i] = {lattice_.round(point.x), lattice_.round(point.y),
                              lattice_.round(point.z)};
            }
        }
    }

    /// A position in the units that are written.
    glm::dvec3 in_units(const glm::dvec3& position) const { return (position - middle_) / unit_; }

    void keep_triangles() {
        std::vector<uint8_t> used(mesh_.positions.size(), 0);
        const bool normals =
            !mesh_.normals.empty() && (textures_ == nullptr || textures_->uses_normals());
        for (size_t i = 0; i < mesh_.triangles.size(); ++i) {
            check_job_sometimes(i);
            const Triangle& t = mesh_.triangles[i];
            if (written_ != WrittenTriangles::All && textures_ != nullptr &&
                textures_->is_glass(i) != (written_ == WrittenTriangles::Glass))
                continue;
            if (narrow_ ? flat_on_lattice<int64_t>(points_[t.x], points_[t.y], points_[t.z])
                        : flat_on_lattice<__int128>(points_[t.x], points_[t.y], points_[t.z]))
                continue;
            kept_.push_back(static_cast<uint32_t>(i));
            for (int corner = 0; corner < 3; ++corner) {
                if (used[t[corner]] == 0)
                    order_.push_back(t[corner]);
                used[t[corner]] = 1;
            }
            if (normals && !smooth_)
                smooth_ = !face_normals(i);
        }
    }

    /// Whether all three corners have the face's own normal, which POV-Ray finds itself.
    bool face_normals(size_t triangle) const {
        const glm::dvec3 face = area_vector(mesh_, triangle);
        for (int corner = 0; corner < 3; ++corner) {
            const glm::dvec3 normal(mesh_.normals[mesh_.triangles[triangle][corner]]);
            if (!(std::abs(glm::dot(face, normal)) >=
                  (1 - 1e-7) * glm::length(face) * glm::length(normal)))
                return false;
        }
        return true;
    }

    void share_values() {
        const size_t count = mesh_.positions.size();
        const auto& points = points_;
        if (smooth_) {
            normal_points_.resize(count);
            for (size_t i = 0; i < order_.size(); ++i) {
                check_job_sometimes(i);
                normal_points_[order_[i]] = rounded_normal(order_[i]);
            }
        }
        has_uvs_ = textures_ != nullptr && textures_->uses_uvs();
        if (has_uvs_) {
            double far = 1;
            for (const uint32_t vertex : order_) {
                const glm::vec2& uv = mesh_.uvs[vertex];
                far = std::max({far, std::abs(double{uv.x}), std::abs(double{uv.y})});
            }
            uv_lattice_ = DecimalLattice(kUvPrecision, far);
            uv_points_.resize(count);
            for (const uint32_t vertex : order_)
                uv_points_[vertex] = {uv_lattice_.round(mesh_.uvs[vertex].x),
                                      uv_lattice_.round(mesh_.uvs[vertex].y)};
        }
        ValuePool position = share(order_, count, [&](uint32_t v) { return points[v]; });
        job_.check();
        // A mesh without seams (every position once, at least as many triangles as vertices) has
        // one list: indices of their own cost more numbers than any sharing of normals or uvs could
        // save.
        const bool seamless = position.size() == order_.size() && kept_.size() >= order_.size();
        if (seamless || (!smooth_ && !has_uvs_)) {
            positions_ = std::move(position);
            if (smooth_)
                normals_ = positions_;
            if (has_uvs_)
                uvs_ = positions_;
            return;
        }
        const auto joined = [&](const ValuePool& a, const ValuePool& b) {
            job_.check();
            return share(order_, count, [&](uint32_t v) {
                return std::array<uint32_t, 2>{a.of_vertex[v], b.of_vertex[v]};
            });
        };
        ValuePool normal;
        ValuePool uv;
        if (smooth_)
            normal = share(order_, count, [&](uint32_t v) { return normal_points_[v]; });
        if (has_uvs_)
            uv = share(order_, count, [&](uint32_t v) { return uv_points_[v]; });
        // There is one index for position and normal, or one for all three, or one for each.
        const ValuePool both = smooth_ ? joined(position, normal) : position;
        const ValuePool all = has_uvs_ ? joined(both, uv) : both;
        const size_t indices = 3 * kept_.size();
        const size_t vertex = smooth_ ? 6 : 3;
        const size_t one = all.size() * (vertex + (has_uvs_ ? 2 : 0));
        const size_t two = has_uvs_ ? both.size() * vertex + uv.size() * 2 + indices : ~size_t{0};
        const size_t each = smooth_ ? position.size() * 3 + normal.size() * 3 + indices +
                                          (has_uvs_ ? uv.size() * 2 + indices : 0)
                                    : ~size_t{0};
        explicit_normals_ = each < one && each < two;
        explicit_uvs_ = has_uvs_ && (explicit_normals_ || two < one);
        if (explicit_normals_) {
            positions_ = std::move(position);
            normals_ = std::move(normal);
        } else {
            positions_ = explicit_uvs_ ? both : all;
            normals_ = positions_;
        }
        uvs_ = explicit_uvs_ ? std::move(uv) : positions_;
    }

    Point rounded_normal(uint32_t vertex) const {
        const glm::dvec3 normal(mesh_.normals[vertex]);
        const double length = glm::length(normal);
        // POV-Ray refuses a zero normal with a warning for each.
        const glm::dvec3 unit =
            length > 0 && std::isfinite(length) ? normal / length : glm::dvec3(0, 0, 1);
        return {normal_lattice_.round(unit.x), normal_lattice_.round(unit.y),
                normal_lattice_.round(unit.z)};
    }

    /// Appends a list; `write(at, i)` writes at most kMostOfItem characters and returns the end.
    template <typename Write>
    void append_list(std::string& out, const char* name, size_t count, const Write& write) {
        out += name;
        out += '{';
        append_count(out, count);
        char block[4096];
        char* at = block;
        for (size_t i = 0; i < count; ++i) {
            check_job_sometimes(i);
            if (at > block + sizeof block - kMostOfItem) {
                out.append(block, at);
                at = block;
            }
            *at++ = ',';
            if ((i & 15u) == 0)
                *at++ = '\n';
            at = write(at, i);
        }
        out.append(block, at);
        out += "}\n";
    }
    /// The most characters of one item.
    /// Law: a vector of three numbers of DecimalLattice::kMostCharacters, with room to spare.
    static constexpr size_t kMostOfItem = 256;

    template <size_t kCount>
    static char* write_point(char* at, const DecimalLattice& lattice,
                             const std::array<int64_t, kCount>& point) {
        static_assert(kCount * (DecimalLattice::kMostCharacters + 1) + 2 < kMostOfItem);
        char before = '<';
        for (const int64_t value : point) {
            *at++ = before;
            at = lattice.write(at, value);
            before = ',';
        }
        *at++ = '>';
        return at;
    }

    char* write_face(char* at, const ValuePool& pool, uint32_t triangle) const {
        const Triangle& t = mesh_.triangles[triangle];
        *at++ = '<';
        at = write_count(at, pool.of_vertex[t.x]);
        *at++ = ',';
        at = write_count(at, pool.of_vertex[t.y]);
        *at++ = ',';
        at = write_count(at, pool.of_vertex[t.z]);
        *at++ = '>';
        return at;
    }

    char* write_textures(char* at, uint32_t triangle) const {
        size_t of[] = {textures_->of(triangle, 0), 0, 0};
        int corners = 1;
        if (textures_->differ_in_triangles()) {
            of[1] = textures_->of(triangle, 1);
            of[2] = textures_->of(triangle, 2);
            corners = of[0] == of[1] && of[1] == of[2] ? 1 : 3;
        }
        for (int corner = 0; corner < corners; ++corner) {
            *at++ = ',';
            at = write_count(at, of[corner]);
        }
        return at;
    }

    void check_job_sometimes(size_t i) const {
        if ((i & 0xffffu) == 0xffffu)
            job_.check();
    }

    const Mesh& mesh_;
    const MeshTextures* textures_;
    WrittenTriangles written_;
    const Job& job_;
    double unit_ = 1;  // of what is written
    glm::dvec3 middle_{0};
    DecimalLattice lattice_{1, 1};
    DecimalLattice normal_lattice_{kNormalPrecision, 1};
    DecimalLattice uv_lattice_{kUvPrecision, 1};
    std::vector<Point> points_;
    std::vector<Point> normal_points_;
    std::vector<std::array<int64_t, 2>> uv_points_;
    std::vector<uint32_t> kept_;   // triangles
    std::vector<uint32_t> order_;  // vertices, as they are first used
    bool narrow_ = false;
    bool smooth_ = false;
    bool has_uvs_ = false;
    bool explicit_normals_ = false;
    bool explicit_uvs_ = false;
    ValuePool positions_;
    ValuePool normals_;
    ValuePool uvs_;
};

}  // namespace

std::string mesh_text(const Mesh& mesh, const MeshTextures* textures, const std::string& identifier,
                      const Job& job, std::string_view before) {
    std::string out(before);
    out += "#declare " + identifier + " = ";
    if (textures == nullptr || !textures->is_clear_beside_glass()) {
        MeshText all(mesh, textures, WrittenTriangles::All, job);
        if (all.empty())
            return "";
        all.append_to(out);
        return out;
    }
    MeshText glass(mesh, textures, WrittenTriangles::Glass, job);
    MeshText rest(mesh, textures, WrittenTriangles::Rest, job);
    if (glass.empty() && rest.empty())
        return "";
    const bool both = !glass.empty() && !rest.empty();  // a union of one is an error to POV-Ray
    if (both)
        out += "union{\n";
    for (MeshText* part : {&glass, &rest}) {
        if (!part->empty())
            part->append_to(out);
    }
    if (both)
        out += "}\n";
    return out;
}

}  // namespace lodestone::povray
