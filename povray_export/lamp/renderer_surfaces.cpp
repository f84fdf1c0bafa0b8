// SPDX-License-Identifier: GPL-3.0-or-later
#include "povray_export/lamp/renderer_surfaces.h"

#include "base/color.h"
#include "light/light_arrival.h"
#include "povray_export/scene/magnification.h"
#include "povray_export/texture/lamp_gloss.h"
#include "povray_export/texture/surface_finish.h"
#include "povray_export/texture/texture_writer.h"

#include <glm/common.hpp>

#include <algorithm>
#include <optional>

namespace lodestone::povray {
namespace {

// Taste: the sharpest highlight that points some pixels apart can still see.
constexpr double kSharpest = 200;
// Taste: no surface is so dark that no lamp of its own is worth anything to it.
constexpr double kDarkest = 0.02;

light::SurfaceHighlight highlight_of(const Material& material, const Finish& finish) {
    light::SurfaceHighlight out;
    if (!material.base_color_texture) {
        if (const std::optional<LampGloss> gloss = lamp_gloss(look_of(material)))
            out = {gloss->highlight, 1 / gloss->roughness, gloss->fading};
    }
    if (!(out.albedo > 0)) {
        const double tint = 1 - luminance(glm::clamp(material.base_color, 0.0, 1.0));
        out = {finish.specular * (1 - finish.metallic * tint), 1 / finish.roughness, 0};
    }
    out.exponent = std::clamp(out.exponent, 1.0, kSharpest);
    return out;
}

light::SurfaceReflection reflection_of(const Material& material) {
    const Finish finish = finish_of(look_of(material));
    light::SurfaceReflection out;
    out.albedo = glm::clamp(material.base_color, kDarkest, 1.0);
    out.highlight = highlight_of(material, finish);
    out.may_mirror = may_mirror(material, true);
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
