// SPDX-License-Identifier: GPL-3.0-or-later
// Scene sky: a picture's world as it is written, and the light it gives to what is drawn.
#pragma once

#include "povray_export/lamp/sky_occlusion.h"
#include "povray_export/lamp/sky_writer.h"
#include "povray_export/mesh/pixel_field.h"
#include "povray_export/scene/shading.h"

#include <optional>

namespace lodestone::povray {

/// The sky of one picture. All arguments must outlive it.
class SceneSky {
public:
    /// Writes the world's environment into `folder`. `lit`: anything is lit. See write_sky().
    SceneSky(const Model& model, const Shading& shading, bool lit,
             const std::filesystem::path& folder, Problems& problems);

    const WrittenSky& written() const { return written_; }

    /// Finds the light of the sky on what a cut draws, where rays are to; `options` without the sky
    /// itself. False: they found none, and the sky was written anew, with other lights.
    /// Throws Error(Cancelled).
    bool find_light(const choose::Cut& cut, SkyOcclusionOptions options, const PixelField& pixels,
                    const Job& job);

    /// See SkyOcclusion; null and false where nothing was found.
    SkyLightPtr of(size_t position) const { return light_ ? light_->of(position) : nullptr; }
    SkyLightPtr mean_of_node(uint32_t node) const {
        return light_ ? light_->mean_of_node(node) : nullptr;
    }
    bool baked() const { return light_ && light_->baked(); }

private:
    void write(bool found_by_rays);

    const Model& model_;
    const Shading& shading_;
    std::filesystem::path folder_;
    Problems& problems_;
    bool by_rays_;
    WrittenSky written_;
    std::optional<SkyOcclusion> light_;
};

}  // namespace lodestone::povray
