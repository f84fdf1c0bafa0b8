// SPDX-License-Identifier: GPL-3.0-or-later
#include "measure/deviation/look_scenes.h"

namespace lodestone::measure {

LookScenes::LookScenes(const Mesh& mesh, std::span<const uint16_t> looks, const ray::SkinPtr& skin,
                       ray::SceneUse uses, std::shared_ptr<const ray::MeshScene> opaque)
    : mesh_(&mesh),
      skin_(skin),
      whole_(opaque && !(skin && skin->see_through(mesh))
                 ? std::move(opaque)
                 : std::make_shared<const ray::MeshScene>(mesh, skin, uses)),
      looks_(looks.begin(), looks.end()) {
    if (!looks_.empty() && looks_.size() != mesh.triangles.size())
        fail(Status::InvalidArgument, looks_.size(), " looks for ", mesh.triangles.size(),
             " triangles");
    for (size_t i = 0; i < looks_.size(); ++i) {
        if (i == 0 || looks_[i] != looks_[i - 1])
            by_look_.try_emplace(looks_[i], nullptr);
    }
    for (auto& [look, scene] : by_look_)
        scene = std::make_unique<OfLook>();
}

ray::ClosestPoint LookScenes::nearest(uint16_t look, const glm::dvec3& point, double radius) const {
    if (!has(look))
        return {};
    if (!has_several_looks())
        return whole_->closest_point(point, radius);
    OfLook& own = *by_look_.at(look);
    std::call_once(own.once, [&] {
        std::vector<uint8_t> keep(looks_.size(), 0);
        for (size_t i = 0; i < keep.size(); ++i)
            keep[i] = looks_[i] == look ? 1 : 0;
        own.scene.emplace(subset(*mesh_, keep), skin_, ray::SceneUse::ClosestPoints);
    });
    return own.scene->closest_point(point, radius);
}

}  // namespace lodestone::measure
