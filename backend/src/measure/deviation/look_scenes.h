// SPDX-License-Identifier: GPL-3.0-or-later
// Look scenes: a mesh made ready for closest points, as a whole and by look.
#pragma once

#include "ray/mesh_scene.h"

#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <span>
#include <vector>

namespace lodestone::measure {

class LookScenes {
public:
    /// `looks` is empty (all alike) or one a triangle; the skin may be null; `uses` is what the
    /// whole is asked for. `opaque`: a scene of the same triangles, in no skin, if there is one.
    /// The mesh must last as long as nearest() is called. Throws as ray::MeshScene does.
    LookScenes(const Mesh& mesh, std::span<const uint16_t> looks, const ray::SkinPtr& skin,
               ray::SceneUse uses, std::shared_ptr<const ray::MeshScene> opaque = nullptr);

    const ray::MeshScene& whole() const { return *whole_; }
    /// Of a triangle of the whole.
    uint16_t look_of(uint32_t triangle) const {
        return looks_.empty() ? uint16_t{0} : looks_[triangle];
    }
    bool has_several_looks() const { return by_look_.size() > 1; }
    bool has(uint16_t look) const { return looks_.empty() ? look == 0 : by_look_.count(look) != 0; }
    /// The nearest point of a look; at infinity when there is none within `radius`. From any
    /// thread.
    ray::ClosestPoint nearest(uint16_t look, const glm::dvec3& point,
                              double radius = std::numeric_limits<double>::infinity()) const;

private:
    /// Made when it is first asked for: most never are.
    struct OfLook {
        std::once_flag once;
        std::optional<ray::MeshScene> scene;
    };

    const Mesh* mesh_;
    ray::SkinPtr skin_;
    std::shared_ptr<const ray::MeshScene> whole_;
    std::vector<uint16_t> looks_;
    std::map<uint16_t, std::unique_ptr<OfLook>> by_look_;
};

}  // namespace lodestone::measure
