// SPDX-License-Identifier: GPL-3.0-or-later
// LookScenes: a mesh made ready for closest points, as a whole and look by look.
#pragma once

#include "ray/mesh_scene.h"

#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <span>
#include <vector>

namespace lodestone::measure {

/// The scenes of one mesh: one of all its triangles, and one of each look, which is made on demand.
class LookScenes {
public:
    /// `looks` is empty (all triangles look alike) or has one number a triangle; the skin may be
    /// null; `uses` says what the scene of the whole is asked for. `opaque` is a scene of the same
    /// triangles without a skin, if there is one. The mesh must outlive all calls of nearest().
    /// Throws as ray::MeshScene does.
    LookScenes(const Mesh& mesh, std::span<const uint16_t> looks, const ray::SkinPtr& skin,
               ray::SceneUse uses, std::shared_ptr<const ray::MeshScene> opaque = nullptr);

    /// The scene of all triangles.
    const ray::MeshScene& whole() const { return *whole_; }
    /// The look of a triangle of the whole.
    uint16_t look_of(uint32_t triangle) const {
        return looks_.empty() ? uint16_t{0} : looks_[triangle];
    }
    /// Whether the mesh shows more than one look.
    bool has_several_looks() const { return by_look_.size() > 1; }
    /// Whether some triangle shows the look.
    bool has(uint16_t look) const { return looks_.empty() ? look == 0 : by_look_.count(look) != 0; }
    /// The nearest point of a look; the distance is infinite when there is none within `radius`
    /// metres. May be called from any thread.
    ray::ClosestPoint nearest(uint16_t look, const glm::dvec3& point,
                              double radius = std::numeric_limits<double>::infinity()) const;

private:
    /// The scene of one look. It is made when it is first asked for: most never are.
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
