// SPDX-License-Identifier: GPL-3.0-or-later
#include "view/viewer_batches.h"

#include "base/color.h"
#include "image/image.h"
#include "view/shown_mesh.h"

#include <glm/matrix.hpp>

#include <algorithm>
#include <cmath>
#include <map>
#include <tuple>

namespace lodestone::view {
namespace {

// The triangles and the choices up to which everything below a group is one batch: a batch costs
// about as much to draw as some thousands of triangles, and is made anew when anything in it
// changes.
// Taste: a larger number draws fewer batches and makes more anew when the eye moves.
constexpr uint64_t kFewTriangles = 32'768;
// Taste: a larger number draws fewer batches and makes more anew when the eye moves.
constexpr uint64_t kFewChoices = 256;
// The children of a larger group are divided into batches by their position, in runs of this many,
// so that a change moves no others.
// Taste: longer runs are fewer batches and change more often.
constexpr uint32_t kSiblings = 64;

// The number that stands for 1 in normals.
// Law: the largest 16-bit integer with a sign, as OpenGL normalizes them.
constexpr double kUnit = 32767;

const Representation& shown(const Model& model, const choose::CutNode& node) {
    return model.objects.at(node.object).representations.at(node.lod);
}

/// The sums of everything below each node.
struct ChoicesBelow {
    uint64_t triangles = 0;
    uint64_t choices = 0;

    bool few() const { return triangles <= kFewTriangles && choices <= kFewChoices; }
};

std::vector<ChoicesBelow> count_below(const Model& model, const choose::Cut& cut) {
    std::vector<ChoicesBelow> below(cut.nodes.size());
    for (size_t i = cut.nodes.size(); i-- > 0;) {  // children follow their parents
        const choose::CutNode& node = cut.nodes[i];
        if (!node.opened && (node.hidden & kCameraRays) == 0)
            below[i] = {shown_triangles(shown(model, node).summary), 1};
        if (node.parent != choose::kNoParent) {
            below[node.parent].triangles += below[i].triangles;
            below[node.parent].choices += below[i].choices;
        }
    }
    return below;
}

void hash_piece(Hasher& hasher, const Model& model, const choose::CutNode& node,
                const Affine& world, const BatchPiece& piece,
                const std::vector<glm::dvec3>& colors) {
    double rows[12];
    world.to_rows(rows);
    hasher.value(shown(model, node).summary.hash).bytes(rows, sizeof rows);
    hasher.value(piece.first).value(piece.count);
    if (!colors.empty())
        hasher.bytes(&colors[piece.choice], sizeof(glm::dvec3));
}

std::array<uint8_t, 4> displayed(const glm::dvec3& linear, double alpha) {
    const auto byte = [](double value) {
        return static_cast<uint8_t>(std::lround(std::clamp(value, 0.0, 1.0) * 255));
    };
    const auto encoded = [&](double value) {
        return byte(encode_srgb(static_cast<float>(std::clamp(value, 0.0, 1.0))));
    };
    return {encoded(linear.x), encoded(linear.y), encoded(linear.z), byte(alpha)};
}

/// The properties of a material that a viewport shows.
struct ViewportPaint {
    glm::dvec3 color{0.8};  // linear
    double alpha = 1;
    bool emits = false;
    bool vertex_colors = false;
};

ViewportPaint paint_of(const Material& material, int depth = 0) {
    // The share of light that passes through glass, as it is shown.
    // Taste: a larger one makes glass harder to see.
    constexpr double kSeenThroughGlass = 0.75;
    // The most materials that are mixed one inside the other.
    // Taste: more follow deeper mixes, which are rare; the limit bounds the time.
    constexpr int kMostMixed = 8;
    ViewportPaint paint;
    paint.color = material.base_color;
    paint.vertex_colors = material.vertex_colors;
    if (material.alpha_mode != AlphaMode::Opaque)
        paint.alpha = material.alpha;
    paint.alpha *= 1 - kSeenThroughGlass * std::clamp(material.transmission, 0.0, 1.0);
    const double brightest =
        std::max({material.emission.x, material.emission.y, material.emission.z});
    if (brightest > 0.1) {
        paint.emits = true;
        paint.vertex_colors = false;
        paint.color = material.emission / std::max(1.0, brightest);
    }
    if (material.other && depth < kMostMixed) {
        const ViewportPaint other = paint_of(*material.other, depth + 1);
        const double mix = std::clamp(material.mix, 0.0, 1.0);
        paint.color = glm::mix(paint.color, other.color, mix);
        paint.alpha = glm::mix(paint.alpha, other.alpha, mix);
        paint.emits = mix > 0.5 ? other.emits : paint.emits;
        paint.vertex_colors = mix > 0.5 ? other.vertex_colors : paint.vertex_colors;
    }
    return paint;
}

/// The paints of a representation's slots, at least one.
std::vector<ViewportPaint> paints_of(const Model& model, const Representation& representation) {
    std::vector<ViewportPaint> paints;
    for (const uint32_t material : representation.materials)
        paints.push_back(paint_of(model.materials.at(material)));
    if (paints.empty())
        paints.emplace_back();
    return paints;
}

/// Adds pieces to a BatchMesh.
class BatchPainter {
public:
    explicit BatchPainter(BatchMesh& out) : out_(out) {}

    void add(const Mesh& mesh, const BatchPiece& piece, const Affine& world,
             const std::vector<ViewportPaint>& paints) {
        const size_t last =
            std::min<size_t>(mesh.triangles.size(), static_cast<size_t>(piece.first + piece.count));
        added_.assign(mesh.positions.size(), {kNone, 0});
        const glm::dmat3 turn = normal_matrix(world.linear);
        for (size_t t = static_cast<size_t>(piece.first); t < last; ++t) {
            const uint16_t slot = mesh.slot(t);
            const ViewportPaint& paint = paints[std::min<size_t>(slot, paints.size() - 1)];
            Triangle triangle;
            for (int corner = 0; corner < 3; ++corner) {
                const uint32_t vertex = mesh.triangles[t][corner];
                AddedVertex& known = added_.at(vertex);
                if (known.index == kNone || known.slot != slot)
                    known = {add_vertex(mesh, vertex, world, turn, paint), slot};
                triangle[corner] = known.index;
            }
            out_.triangles.push_back(triangle);
        }
    }

private:
    static constexpr uint32_t kNone = ~uint32_t{0};
    struct AddedVertex {
        uint32_t index = kNone;
        uint16_t slot = 0;
    };

    /// The matrix that turns normals as the transform turns surfaces, whatever its scale; for a
    /// transform that flattens, the best there is.
    static glm::dmat3 normal_matrix(const glm::dmat3& linear) {
        return {glm::cross(linear[1], linear[2]), glm::cross(linear[2], linear[0]),
                glm::cross(linear[0], linear[1])};
    }

    uint32_t add_vertex(const Mesh& mesh, uint32_t vertex, const Affine& world,
                        const glm::dmat3& turn, const ViewportPaint& paint) {
        out_.positions.emplace_back(world(glm::dvec3(mesh.positions[vertex])));
        std::array<int16_t, 4> normal{0, 0, 0, static_cast<int16_t>(paint.emits ? kUnit : 0)};
        if (!mesh.normals.empty()) {
            const glm::dvec3 turned = turn * glm::dvec3(mesh.normals[vertex]);
            const double length = glm::length(turned);
            for (int axis = 0; length > 0 && std::isfinite(length) && axis < 3; ++axis)
                normal[static_cast<size_t>(axis)] =
                    static_cast<int16_t>(std::lround(turned[axis] / length * kUnit));
        }
        out_.normals.push_back(normal);
        glm::dvec3 color = paint.color;
        double alpha = paint.alpha;
        if (paint.vertex_colors && !mesh.colors.empty()) {
            color *= glm::dvec3(mesh.colors[vertex]);
            alpha *= static_cast<double>(mesh.colors[vertex].w);
        }
        out_.colors.push_back(displayed(color, alpha));
        return static_cast<uint32_t>(out_.positions.size() - 1);
    }

    BatchMesh& out_;
    std::vector<AddedVertex> added_;  // by vertex of the mesh
};

/// Puts pieces into batches.
class BatchSorter {
public:
    BatchSorter(const Model& model, const choose::Cut& cut, const std::vector<glm::dvec3>& colors)
        : model_(model), cut_(cut), colors_(colors), below_(count_below(model, cut)) {}

    std::vector<ViewerBatch> run() {
        for (size_t i = 0; i < cut_.chosen.size(); ++i) {
            const uint32_t index = cut_.chosen[i];
            const choose::CutNode& node = cut_.nodes[index];
            if ((node.hidden & kCameraRays) != 0)
                continue;
            const uint64_t all = shown_triangles(shown(model_, node).summary);
            OpenBatch& open = open_[bucket(index)];
            for (uint64_t first = 0; first < all;) {
                const uint64_t room = kMostInBatch - open.batch.triangles;
                if (room < std::min(all - first, kMostInBatch) && !open.batch.pieces.empty())
                    close(open);
                const BatchPiece piece{static_cast<uint32_t>(i), first,
                                       std::min(all - first, kMostInBatch)};
                hash_piece(open.hasher, model_, node, cut_.world(node), piece, colors_);
                open.batch.pieces.push_back(piece);
                open.batch.triangles += piece.count;
                first += piece.count;
            }
        }
        for (auto& [key, open] : open_) {
            if (!open.batch.pieces.empty())
                close(open);
        }
        return std::move(batches_);
    }

private:
    struct OpenBatch {
        ViewerBatch batch;
        Hasher hasher;
    };
    using Bucket = std::tuple<uint32_t, uint32_t>;  // node, run of siblings

    /// The highest group around a choice that holds little; else the choice's own group, with its
    /// neighbors.
    Bucket bucket(uint32_t index) const {
        const uint32_t parent = cut_.nodes[index].parent;
        if (parent == choose::kNoParent)
            return {index, 0};
        if (!below_[parent].few())
            return {parent, 1 + cut_.nodes[index].placement / kSiblings};
        uint32_t top = parent;
        while (cut_.nodes[top].parent != choose::kNoParent && below_[cut_.nodes[top].parent].few())
            top = cut_.nodes[top].parent;
        const uint32_t above = cut_.nodes[top].parent;
        if (above == choose::kNoParent)
            return {top, 0};
        return {above, 1 + cut_.nodes[top].placement / kSiblings};
    }

    void close(OpenBatch& open) {
        open.batch.key = std::max<Hash>(open.hasher.result(), 1);
        batches_.push_back(std::move(open.batch));
        open = {};
    }

    const Model& model_;
    const choose::Cut& cut_;
    const std::vector<glm::dvec3>& colors_;
    std::vector<ChoicesBelow> below_;
    std::map<Bucket, OpenBatch> open_;
    std::vector<ViewerBatch> batches_;
};

}  // namespace

std::vector<ViewerBatch> batches_of(const Model& model, const choose::Cut& cut,
                                    const std::vector<glm::dvec3>& colors) {
    if (!colors.empty() && colors.size() != cut.chosen.size())
        fail(Status::InvalidArgument, colors.size(), " colors for ", cut.chosen.size(),
             " chosen occurrences");
    return BatchSorter(model, cut, colors).run();
}

BatchMesh mesh_of(const Model& model, const choose::Cut& cut, const ViewerBatch& batch,
                  const std::vector<glm::dvec3>& colors, const Job& job) {
    BatchMesh out;
    out.triangles.reserve(static_cast<size_t>(batch.triangles));
    BatchPainter painter(out);
    for (const BatchPiece& piece : batch.pieces) {
        job.check();
        const choose::CutNode& node = cut.nodes.at(cut.chosen.at(piece.choice));
        const Representation& representation = shown(model, node);
        std::vector<ViewportPaint> paints = paints_of(model, representation);
        if (!colors.empty())
            paints = {ViewportPaint{colors.at(piece.choice), 1, false, false}};
        if (representation.summary.kind == Kind::Mesh) {
            painter.add(representation.mesh(), piece, cut.world(node), paints);
            continue;
        }
        const Mesh mesh = shown_mesh(representation);
        painter.add(mesh, {piece.choice, 0, mesh.triangles.size()}, cut.world(node), paints);
    }
    return out;
}

}  // namespace lodestone::view
