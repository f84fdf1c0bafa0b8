// SPDX-License-Identifier: GPL-3.0-or-later
#include "hierarchy/evaluators/visible_share.h"

#include <algorithm>

namespace lodestone::hierarchy {
namespace {

std::vector<double> area_by_tag(const measure::VisibleAttributes& visible, size_t tags) {
    uint64_t all = 0;
    for (const uint64_t hits : visible.hits_by_tag)
        all += hits;
    std::vector<double> out(tags, 0);
    for (size_t tag = 0; all > 0 && tag < std::min(tags, visible.hits_by_tag.size()); ++tag)
        out[tag] = visible.attributes.visible_area * static_cast<double>(visible.hits_by_tag[tag]) /
                   static_cast<double>(all);
    return out;
}

}  // namespace

std::vector<double> visible_by_tag(const Mesh& seen, std::span<const uint32_t> by_triangle,
                                   size_t tags, const MeasuredFinest& finest, const Job& job) {
    if (!finest.is_whole(seen))
        return visible_by_tag_of_level(seen, by_triangle, tags, finest, job);
    return area_by_tag(measure::measure_visible(seen, finest.sampler(), finest.skin,
                                                finest.visible_options(finest.rays), by_triangle,
                                                finest.cast, job),
                       tags);
}

std::vector<double> visible_by_tag_of_level(const Mesh& level,
                                            std::span<const uint32_t> by_triangle, size_t tags,
                                            const MeasuredFinest& finest, const Job& job) {
    return area_by_tag(
        measure::measure_visible(level, ray::MeshScene(level, finest.skin), finest.skin,
                                 finest.visible_options(finest.rays), by_triangle, job),
        tags);
}

}  // namespace lodestone::hierarchy
