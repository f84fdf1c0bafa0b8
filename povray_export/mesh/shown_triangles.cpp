// SPDX-License-Identifier: GPL-3.0-or-later
#include "povray_export/mesh/shown_triangles.h"

#include <algorithm>
#include <utility>

namespace lodestone::povray {
namespace {

// Meshes of fewer triangles are written whole.
// Taste: a larger value lets more pictures use the same files, which are a little longer.
constexpr size_t kFewTriangles = 128;
// The share of a mesh from which on it is written whole.
// Taste: as kFewTriangles.
constexpr double kMostOfMesh = 0.75;

}  // namespace

void NeededTriangles::add(std::span<const uint8_t> needed) {
    if (all_ || needed.size() < kFewTriangles ||
        (!needed_.empty() && needed_.size() != needed.size())) {
        all_ = true;
        needed_ = {};
        return;
    }
    needed_.resize(needed.size(), 0);
    for (size_t i = 0; i < needed.size(); ++i)
        needed_[i] = needed_[i] != 0 || needed[i] != 0 ? 1 : 0;
}

void NeededTriangles::add(const NeededTriangles& other) {
    if (other.all_ || !other.needed_.empty())
        add(other.needed_);
}

ShownTrianglesPtr NeededTriangles::shown() const {
    const auto count = std::count(needed_.begin(), needed_.end(), uint8_t{1});
    if (all_ || needed_.empty() ||
        static_cast<double>(count) > kMostOfMesh * static_cast<double>(needed_.size()))
        return nullptr;
    ShownTriangles out{needed_, 0};
    out.hash = Hasher().array(std::span<const uint8_t>(out.shown)).result();
    return std::make_shared<const ShownTriangles>(std::move(out));
}

}  // namespace lodestone::povray
