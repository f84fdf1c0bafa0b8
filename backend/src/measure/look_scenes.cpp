// SPDX-License-Identifier: GPL-3.0-or-later
#include "measure/look_scenes.h"

namespace lodestone::measure {

LookScenes::LookScenes(const Mesh& mesh, std::span<const uint16_t> looks, const ray::SkinPtr& skin,
                       ray::Uses uses)
    : whole_(mesh, skin, uses), looks_(looks.begin(), looks.end()) {
    if (!looks_.empty() && looks_.size() != mesh.triangles.size())
        fail(Status::InvalidArgument, looks_.size(), " looks for ", mesh.triangles.size(),
             " triangles");
    std::map<uint16_t, std::vector<uint8_t>> keep;
    for (size_t i = 0; i < looks_.size(); ++i)
        keep.try_emplace(looks_[i], looks_.size(), uint8_t{0}).first->second[i] = 1;
    for (const auto& [look, triangles] : keep) {
        if (keep.size() > 1)
            by_look_.emplace(look,
                             ray::Scene(subset(mesh, triangles), skin, ray::Uses::ClosestPoints));
        else
            by_look_.emplace(
                look, ray::Scene(Mesh{}, nullptr, ray::Uses::ClosestPoints));  // the whole serves
    }
}

ray::Closest LookScenes::nearest(uint16_t look, const glm::dvec3& point, double radius) const {
    if (!has(look))
        return {};
    return (several() ? by_look_.at(look) : whole_).closest_point(point, radius);
}

}  // namespace lodestone::measure
