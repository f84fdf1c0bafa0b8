// SPDX-License-Identifier: GPL-3.0-or-later
#include "povray_export/lamp/sky_writer.h"

#include "base/files.h"
#include "base/maths.h"
#include "light/environment/environment_lights.h"
#include "povray_export/scene/povray_number.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace lodestone::povray {
namespace {

// The share of the brightest light of the sky that a light has at least: fainter ones cast rays at
// every point for light that no display shows, and come from rounding.
// Taste: half of a step of 8 bits; a larger value loses faint parts of the sky.
constexpr double kFaintest = 2e-3;

const char* keyword_of(PictureFormat format) {
    switch (format) {
        case PictureFormat::Png:
            return "png";
        case PictureFormat::Jpeg:
            return "jpeg";
        case PictureFormat::Exr:
            break;
    }
    return "exr";
}

/// The text pigment{...} of a ball around the origin, or of a sky sphere.
std::string pigment_of(const World& world, const std::string& file) {
    const Picture& picture = *world.environment;
    std::string out = "pigment{image_map{";
    out += keyword_of(picture.format);
    out += " \"" + file + '"';
    if (picture.format != PictureFormat::Exr)
        out += picture.space == ColorSpace::Linear ? " gamma 1" : " gamma srgb";
    out += " map_type 1 interpolate 2}}\n    matrix<";
    // POV-Ray's map starts at +X and turns to +Z, Y being up; Blender's starts at -X and turns to
    // +Y. So the map's axes are -X, Z, Y of the picture's frame.
    const glm::dmat3 to_world = glm::inverse(world.environment_turn);
    for (const glm::dvec3& axis : {-to_world[0], to_world[2], to_world[1]}) {
        for (int i = 0; i < 3; ++i) {
            append_number(out, axis[i]);
            out += ',';
        }
    }
    return out + "0,0,0>\n    ";
}

double largest_of(const glm::dvec3& color) {
    return std::max({color.x, color.y, color.z});
}

}  // namespace

WrittenSky write_sky(const World& world, const SkySampling& sampling,
                     const std::filesystem::path& folder, Problems& problems) {
    WrittenSky sky;
    if (finite(world.color))
        sky.ambient = glm::max(world.color, glm::dvec3(0.0));
    if (!world.environment)
        return sky;
    const Picture& picture = *world.environment;
    // Lights whose mean is taken where none is to be written.
    // Taste: a larger value knows the mean light better, for time once a picture.
    constexpr size_t kFewest = 12;
    light::EnvironmentLights found;
    try {
        const size_t count = sampling.lights > 0 ? sampling.lights : kFewest;
        found = sampling.found_by_rays ? light::environment_peaks(world, count)
                                       : light::environment_lights(world, count);
    } catch (const Error& error) {
        problems.push_back({picture.name, Severity::Error, "environment_unreadable", error.what()});
        return sky;
    }
    sky.ambient = found.ambient;
    sky.uneven = found.uneven;
    double largest = largest_of(sky.ambient);
    for (const light::EnvironmentLight& each : found.lights)
        largest = std::max(largest, largest_of(each.irradiance));
    for (const light::EnvironmentLight& each : found.lights) {
        if (sampling.lights == 0 || largest_of(each.irradiance) < kFaintest * largest) {
            sky.ambient += each.irradiance / (4 * std::numbers::pi);  // in the mean of all normals
            continue;
        }
        Light& sun = sky.lights.emplace_back();
        sun.direction = each.direction;
        sun.color = each.irradiance;
        sun.angle = each.angle;
        sun.shadow = sampling.shadows;
    }
    sky.file = "i/" + hex16(picture.hash) + '.' + suffix_of(picture.format);
    sky.bytes = picture.bytes.size();
    sky.texels = static_cast<uint64_t>(picture.width) * static_cast<uint64_t>(picture.height);
    const std::filesystem::path path = folder / sky.file;
    std::error_code error;
    if (std::filesystem::file_size(path, error) != picture.bytes.size() || error) {
        std::filesystem::create_directories(path.parent_path(), error);
        write_file(path, picture.bytes);
        sky.written = true;
    }
    sky.pigment = pigment_of(world, sky.file);
    sky.strength = world.environment_strength;
    return sky;
}

std::string sky_sphere(const WrittenSky& sky) {
    std::string out = "sky_sphere{" + sky.pigment + "emission rgb ";
    append_vector(out, sky.strength, 6);
    return out + "}\n\n";
}

std::string sky_ball(const WrittenSky& sky, const glm::dvec3& eye) {
    // The radius of the ball around the eye.
    // Law: POV-Ray sees as far as 1e7.
    constexpr double kFar = 5e6;
    std::string out = "sphere{0,1 hollow no_shadow no_radiosity texture{" + sky.pigment +
                      "finish{ambient 0 diffuse 0 emission rgb ";
    append_vector(out, sky.strength, 6);
    out += "}} scale ";
    append_number(out, kFar);
    out += " translate ";
    append_vector(out, eye, 15);
    return out + "}\n\n";
}

}  // namespace lodestone::povray
