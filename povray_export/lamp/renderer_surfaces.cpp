// SPDX-License-Identifier: GPL-3.0-or-later
#include "povray_export/lamp/renderer_surfaces.h"

#include "base/color.h"
#include "light/light_arrival.h"
#include "povray_export/scene/magnification.h"
#include "povray_export/texture/surface_finish.h"
#include "povray_export/texture/texture_writer.h"

#include <glm/common.hpp>

#include <algorithm>

namespace lodestone::povray {
namespace {

// Taste: the sharpest highlight that points some pixels apart can still see.
constexpr double kSharpest = 200;
// Taste: no surface is so dark that no lamp of its own is worth anything to it.
constexpr double kDarkest = 0.02;

light::SurfaceReflection reflection_of(const Material& material) {
    const SurfaceLook look = look_of(material);
    const Finish finish = finish_of(look);
    light::SurfaceReflection out;
    out.albedo = glm::clamp(material.base_color, 0.0, 1.0);
    const double alpha = std::max(1e-3, look.roughness * look.roughness);
    out.gloss = finish.specular * (1 - look.metallic) + look.metallic * luminance(out.albedo);
    out.exponent = std::clamp(2 / (alpha * alpha) - 2, 1.0, kSharpest);
    out.albedo = glm::max(out.albedo, glm::dvec3(kDarkest));
    out.mirror = finish.mirror > 0 || finish.mirror_grazing > 0 || refraction_of(material) > 0;
    return out;
}

}  // namespace

light::RendererSurfaces renderer_surfaces(const Model& model) {
    light::RendererSurfaces out{{}, kTolerance};
    out.reflections.reserve(model.materials.size());
    for (const Material& material : model.materials)
        out.reflections.push_back(reflection_of(material));
    return out;
}

}  // namespace lodestone::povray
