// SPDX-License-Identifier: GPL-3.0-or-later
#include "povray_export/mesh/detail_bands.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <span>

namespace lodestone::povray {
namespace {

/// The most triangles of a part that is not halved.
/// Taste: a larger value asks less often, and draws more as finely as its finest triangle.
constexpr size_t kFewTogether = 8;

/// The tree of a mesh's triangles, with the size that each node has.
class BandTree {
public:
    BandTree(const Mesh& mesh, const DetailBands::PixelOfPart& pixel, std::vector<BandNode>& nodes)
        : mesh_(mesh), pixel_(pixel), nodes_(nodes), order_(mesh.triangles.size()) {
        std::iota(order_.begin(), order_.end(), 0u);
        boxes_.resize(order_.size());
        for (size_t i = 0; i < order_.size(); ++i) {
            for (int corner = 0; corner < 3; ++corner)
                boxes_[i].add(glm::dvec3(mesh_.positions[mesh_.triangles[i][corner]]));
        }
    }

    /// Adds the node of the triangles from `begin` to `end` of the order, and those of its parts.
    double add(size_t begin, size_t end) {
        Box3 box;
        Box3 middles;
        for (size_t i = begin; i < end; ++i) {
            box.add(boxes_[order_[i]]);
            middles.add(boxes_[order_[i]].center());
        }
        const size_t at = nodes_.size();
        nodes_.push_back({glm::vec3(box.low), glm::vec3(box.high)});
        sizes_.push_back(0);
        if (end - begin <= kFewTogether) {
            sizes_[at] = pixel_({box.center(), 0.5 * glm::length(box.size()), box},
                                std::span(order_).subspan(begin, end - begin));
        } else {
            const glm::dvec3 size = middles.size();
            const int axis = size.x >= size.y && size.x >= size.z ? 0 : (size.y >= size.z ? 1 : 2);
            const size_t half = begin + (end - begin) / 2;
            const auto place = [&](size_t i) { return order_.begin() + static_cast<ptrdiff_t>(i); };
            std::nth_element(place(begin), place(half), place(end), [&](uint32_t a, uint32_t b) {
                return boxes_[a].center()[axis] < boxes_[b].center()[axis];
            });
            const double first = add(begin, half);
            sizes_[at] = std::min(first, add(half, end));
        }
        nodes_[at].next = static_cast<uint32_t>(nodes_.size());
        return sizes_[at];
    }

    /// By node.
    const std::vector<double>& sizes() const { return sizes_; }

private:
    const Mesh& mesh_;
    const DetailBands::PixelOfPart& pixel_;
    std::vector<BandNode>& nodes_;
    std::vector<uint32_t> order_;
    std::vector<Box3> boxes_;  // by triangle
    std::vector<double> sizes_;
};

}  // namespace

DetailBands::DetailBands(const Mesh& mesh, const PixelOfPart& pixel)
    : finest_(std::numeric_limits<double>::infinity()) {
    if (mesh.triangles.empty())
        return;
    BandTree tree(mesh, pixel, nodes_);
    finest_ = tree.add(0, mesh.triangles.size());
    for (size_t i = 0; i < nodes_.size(); ++i) {
        const double octaves = std::floor(std::log2(tree.sizes()[i] / finest_));
        nodes_[i].octaves = static_cast<uint32_t>(limited(octaves, 0, kMost));
    }
    const bool even = std::all_of(nodes_.begin(), nodes_.end(),
                                  [](const BandNode& node) { return node.octaves == 0; });
    if (even)
        nodes_.clear();
    hash_ = Hasher().array(std::span<const BandNode>(nodes_)).result();
}

int DetailBands::octaves(const Box3& box) const {
    const glm::vec3 low(box.low);
    const glm::vec3 high(box.high);
    uint32_t least = kMost + 1;
    for (size_t i = 0; i < nodes_.size();) {
        const BandNode& node = nodes_[i];
        const bool apart =
            glm::any(glm::lessThan(node.high, low)) || glm::any(glm::greaterThan(node.low, high));
        if (apart || node.octaves >= least) {
            i = node.next;
            continue;
        }
        if (node.next == i + 1)
            least = node.octaves;
        ++i;
    }
    return least > kMost ? 0 : static_cast<int>(least);
}

}  // namespace lodestone::povray
