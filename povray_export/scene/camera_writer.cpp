// SPDX-License-Identifier: GPL-3.0-or-later
#include "povray_export/scene/camera_writer.h"

#include "base/maths.h"
#include "povray_export/scene/povray_number.h"

#include <cmath>
#include <utility>

namespace lodestone::povray {
namespace {

/// Appends the blur of a lens. POV-Ray's lens has a quarter of its aperture as radius (measured),
/// and is in focus where rays are as long as the one to focal_point: a plane across the view, in
/// units of `direction`.
void append_blur(std::string& out, const Camera& camera, Antialiasing antialiasing) {
    const glm::dvec3 ahead = glm::normalize(glm::cross(camera.up, camera.right));
    const double depth = std::abs(glm::dot(ahead, camera.direction));
    const glm::dvec3 focus = camera.position + camera.direction * (camera.focus_distance / depth);
    const double aperture = 2 * camera.aperture;
    if (!finite(focus) || !std::isfinite(aperture))
        return;
    out += "    focal_point ";
    append_vector(out, focus, 15);
    out += " aperture ";
    append_number(out, aperture);
    // The first number of samples is always cast: fewer would lose a tenth of a small bright spot.
    switch (antialiasing) {
        case Antialiasing::Off:
            out += " blur_samples 19 confidence .9 variance 1/1000\n";
            break;
        case Antialiasing::Final:
            out += " blur_samples 37,100 confidence .9 variance 1/10000\n";
            break;
        case Antialiasing::Reference:
            out += " blur_samples 100,400 confidence .95 variance 1/100000\n";
            break;
    }
}

}  // namespace

void check_view(const View& view) {
    const Camera& camera = view.camera;
    if (view.width <= 0 || view.height <= 0)
        fail(Status::InvalidArgument, "a picture of ", view.width, " x ", view.height, " pixels");
    if (!finite(camera.position) || !finite(camera.direction) || !finite(camera.right) ||
        !finite(camera.up))
        fail(Status::InvalidArgument, "the camera '", camera.name, "' is not finite");
    const double volume = std::abs(glm::dot(glm::cross(camera.right, camera.up), camera.direction));
    if (!(volume > 0))
        fail(Status::InvalidArgument, "the camera '", camera.name, "' sees no volume");
}

bool has_depth_blur(const Camera& camera) {
    return !camera.orthographic && camera.focus_distance > 0 && camera.aperture > 0;
}

void append_camera(std::string& out, const Camera& camera, Antialiasing antialiasing,
                   Problems& problems) {
    out += camera.orthographic ? "camera{orthographic\n" : "camera{perspective\n";
    const std::pair<const char*, const glm::dvec3&> vectors[] = {{"location", camera.position},
                                                                 {"direction", camera.direction},
                                                                 {"right", camera.right},
                                                                 {"up", camera.up}};
    for (const auto& [name, value] : vectors) {
        out += "    ";
        out += name;
        out += ' ';
        append_vector(out, value, 15);
        out += '\n';
    }
    if (has_depth_blur(camera))
        append_blur(out, camera, antialiasing);
    else if (camera.focus_distance > 0 && camera.aperture > 0)
        problems.push_back({camera.name, Severity::Warning, "depth_of_field",
                            "is sharp at every depth: POV-Ray blurs perspective cameras only"});
    out += "}\n\n";
}

}  // namespace lodestone::povray
