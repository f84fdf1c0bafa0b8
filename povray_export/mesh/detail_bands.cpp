// SPDX-License-Identifier: GPL-3.0-or-later
#include "povray_export/mesh/detail_bands.h"

#include "geometry/part_tree.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>

namespace lodestone::povray {

DetailBands::DetailBands(const Mesh& mesh, const PixelOfPart& pixel)
    : finest_(std::numeric_limits<double>::infinity()) {
    if (mesh.triangles.empty())
        return;
    const geometry::PartTree tree(mesh);
    const std::vector<geometry::MeshPart>& parts = tree.parts();
    std::vector<double> sizes(parts.size());
    for (size_t i = parts.size(); i-- > 0;) {
        const Box3& box = parts[i].box;
        sizes[i] = tree.leaf(i) ? pixel({box.center(), 0.5 * glm::length(box.size()), box},
                                        tree.triangles(parts[i]))
                                : std::min(sizes[i + 1], sizes[parts[i + 1].next]);
    }
    finest_ = sizes[0];
    for (size_t i = 0; i < parts.size(); ++i) {
        const double octaves = std::floor(std::log2(sizes[i] / finest_));
        nodes_.push_back({glm::vec3(parts[i].box.low), glm::vec3(parts[i].box.high), parts[i].next,
                          static_cast<uint32_t>(limited(octaves, 0, kMost))});
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
