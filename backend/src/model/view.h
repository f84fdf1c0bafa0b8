// SPDX-License-Identifier: GPL-3.0-or-later
// Views and all that a picture is taken with: camera, lights, world, and the quality asked for.
#pragma once

#include "base/maths.h"
#include "model/lenses.h"
#include "model/picture.h"
#include "model/representation.h"

#include <optional>
#include <string>
#include <vector>

namespace lodestone {

/// Explicit frame vectors, so that no convention of angles, sensors or shifts is needed.
/// Perspective: a pixel at (u, v) in [-1/2, 1/2]^2 looks along direction + u right + v up.
/// Orthographic: it looks along direction from position + u right + v up.
struct Camera {
    std::string name;
    bool orthographic = false;
    glm::dvec3 position{0.0};
    glm::dvec3 direction{0, 0, -1};  // perspective: to the frame's middle at distance 1
    glm::dvec3 right{1, 0, 0};       // whole frame width (perspective: at distance 1)
    glm::dvec3 up{0, 1, 0};          // whole frame height
    double near_clip = 0.1;          // metres
    double focus_distance = 0;       // metres along the view to the sharp plane; 0: all is sharp
    double aperture = 0;             // diameter of the lens's opening, metres
};

enum class LightKind : uint8_t { Sun = 0, Point = 1, Spot = 2, Area = 3 };

/// "sun", "point", "spot", "area"
const char* name_of(LightKind kind);
/// Throws Error(BadFile) for a name that is none of these.
LightKind light_kind_named(const std::string& name);

struct Light {
    std::string name;
    LightKind kind = LightKind::Sun;
    glm::dvec3 color{1.0};  // linear
    double power = 1;       // sun: W/m^2; others: W (Blender's energy units); negative takes away
    glm::dvec3 position{0.0};        // all but suns; an area's center
    glm::dvec3 direction{0, 0, -1};  // all but points: the way the light travels
    bool shadow = true;
    double radius = 0;           // point, spot: metres
    double angle = 0;            // sun: its diameter in the sky, radians
    double spot_size = 0.785;    // spot: the whole cone, radians, at most pi
    double spot_blend = 0;       // spot: 0 (a sharp edge) to 1 (fading from the axis on)
    glm::dvec3 edge_u{1, 0, 0};  // area: its width and height
    glm::dvec3 edge_v{0, 1, 0};
    bool round = false;  // area: the ellipse inside the edges
    double spread =
        0;  // area: light leaves only within this cone, radians; 0: all of the half space
};

struct World {
    glm::dvec3 color{0.05};    // linear radiance, the same from everywhere
    bool transparent = false;  // film: the background has alpha 0
    /// The picture that is seen all around instead of `color`: equirectangular, +Z up.
    PicturePtr environment;
    glm::dmat3 environment_turn{1.0};  // directions in the world -> in the picture
    glm::dvec3 environment_strength{1.0};
};

/// A part of the picture, in its pixels.
struct RenderBorder {
    int left = 0;
    int top = 0;
    int width = 1;
    int height = 1;
};

/// How fine things are that the picture does not show.
enum class OffScreen : uint8_t {
    Full = 0,       // as if it showed them
    Reflected = 1,  // as far as it shows their shadows, and mirrors or refracts them
    Shadows = 2,    // as far as it shows their shadows: images of them may be coarse
};

/// The factors that make things finer or coarser. Every factor counts by itself; all together stay
/// within 1/64 ... 64.
struct QualityModifiers {
    DetailCriterion criterion = DetailCriterion::Resolution;
    std::vector<DetailLens> lenses;
    std::vector<ScreenLens> screen_lenses;
    /// Depth exaggeration: coarser by (z / depth_focus)^(depth - 1); 1: none.
    double depth = 1;
    double depth_focus = 10;  // metres
    /// Coarser where things cross the screen while the shutter is open, by motion of the camera (to
    /// `closing`) or of placements.
    bool when_moving = false;
    std::optional<Camera> closing;
    /// Coarser where little light falls, unless the world behind is bright.
    bool when_dark = false;
    OffScreen off_screen = OffScreen::Full;
    /// Those of kIndirectRays that may meet other representations than the camera's rays do.
    RayMask ray_classes = 0;
};

/// All that a cut is chosen for, besides the model.
struct View {
    Camera camera;
    int width = 640;  // pixels of the final image
    int height = 360;
    double pixel_error = 1;      // T; 0 = originals. Of other criteria: the threshold
    KindMask kinds = kAllKinds;  // what the consumer can draw
    std::optional<RenderBorder> border;
    QualityModifiers modifiers;
};

}  // namespace lodestone
