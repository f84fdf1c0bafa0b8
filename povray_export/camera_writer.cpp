// SPDX-License-Identifier: GPL-3.0-or-later
#include "povray_export/camera_writer.h"

#include "base/error.h"
#include "povray_export/number.h"

#include <cmath>
#include <utility>

namespace lodestone::povray {
namespace {

bool finite(const glm::dvec3& value) {
    return std::isfinite(value.x) && std::isfinite(value.y) && std::isfinite(value.z);
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

void append_camera(std::string& out, const Camera& camera) {
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
    out += "}\n\n";
}

}  // namespace lodestone::povray
