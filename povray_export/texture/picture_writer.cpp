// SPDX-License-Identifier: GPL-3.0-or-later
#include "povray_export/texture/picture_writer.h"

#include "base/error.h"
#include "base/files.h"
#include "image/picture_size.h"
#include "povray_export/scene/povray_number.h"
#include "povray_export/texture/pigment_picture.h"

#include <glm/common.hpp>

#include <algorithm>
#include <array>
#include <cmath>

namespace lodestone::povray {
namespace {

// The version of baked pictures: raised whenever what is baked changes, for files are found again
// by their name alone.
// Law: part of every file's hash.
constexpr uint32_t kBakeVersion = 3;

constexpr std::string_view kNameComment = "// i/";

bool plain(const Texture& texture) {
    return texture.scale == glm::dvec3(1.0) && texture.offset == glm::dvec3(0.0);
}

/// The color type in a PNG's header; -1 for a PNG that POV-Ray is not trusted with (interlaced), or
/// that has a transparent color.
int png_color_type(const std::string& bytes) {
    // Law: the bytes of a PNG's signature (8) and its IHDR chunk (25).
    constexpr size_t kHeader = 33;
    if (bytes.size() < kHeader || bytes[28] != 0)
        return -1;
    for (size_t at = 8; at + 12 <= bytes.size();) {
        size_t length = 0;
        for (size_t i = 0; i < 4; ++i)
            length = length << 8u | static_cast<unsigned char>(bytes[at + i]);
        if (bytes.compare(at + 4, 4, "tRNS") == 0)
            return -1;
        if (bytes.compare(at + 4, 4, "IDAT") == 0 || length > bytes.size() - at - 12)
            break;
        at += length + 12;
    }
    return static_cast<unsigned char>(bytes[25]);
}

/// Whether POV-Ray may read the picture's own file: it shows the texture's very values.
bool usable_as_is(const Texture& texture, PigmentContent content) {
    const Picture& picture = *texture.picture;
    if (content == PigmentContent::Height || !plain(texture) ||
        picture.format == PictureFormat::Exr)
        return false;
    const bool png = picture.format == PictureFormat::Png;
    const int type = png ? png_color_type(picture.bytes) : -1;
    if (!is_number(content))  // alpha would make holes
        return texture.channel == TextureChannel::Color &&
               (!png || type == 0 || type == 2 || type == 3);
    // POV-Ray weighs colors its own way: only a gray picture is the number everybody means.
    return texture.channel != TextureChannel::Alpha && type == 0;
}

/// Whether anything outside the picture is looked at.
bool leaves(const Texture& texture, const UvRange& range) {
    // Coordinates may lie outside by this share of the picture.
    // Taste: rounding of texture coordinates is below; a larger value shows the wrong border.
    constexpr double kEdge = 1e-4;
    for (int corner = 0; corner < 4; ++corner) {
        const glm::dvec2 at = to_picture(texture, {(corner & 1) != 0 ? range.high.x : range.low.x,
                                                   (corner & 2) != 0 ? range.high.y : range.low.y});
        for (int i = 0; i < 2; ++i) {
            if (!(at[i] >= -kEdge && at[i] <= 1 + kEdge))
                return true;
        }
    }
    return false;
}

/// Extends a picture below 0 and above 1 of an axis by the border's texels: strips so wide that the
/// center of one texel covers them.
std::string extended(const std::string& inside, char axis, int texels) {
    const bool x = axis == 'x';
    const auto strip = [&](double center) {
        std::string out = inside + (x ? " translate<" : " translate<0,");
        append_number(out, -center);
        out += x ? ",0,0> scale<1e9,1,1>" : ",0> scale<1,1e9,1>";
        return out;
    };
    const std::string at(1, axis);
    return "function{select(" + at + ",0,.5,select(" + at + "-1,.5,1))} pigment_map{[.2 " +
           strip(0.5 / texels) + "][.2 " + inside + "][.8 " + inside + "][.8 " +
           strip(1 - 0.5 / texels) + "]}";
}

/// Makes a picture black outside 0...1 of both axes.
std::string clipped(const std::string& inside) {
    return "function{select(x,0,1)*select(1-x,0,1)*select(y,0,1)*select(1-y,0,1)} "
           "pigment_map{[.5 rgb 0][.5 " +
           inside + "]}";
}

/// The transform of a pattern (picture to mesh: POV-Ray looks up through its inverse).
std::string mapping(const Texture& texture) {
    std::array<double, 6> m = texture.to_picture;
    if (m == std::array<double, 6>{1, 0, 0, 0, 1, 0})
        return "";
    for (double& value : m)  // beyond, nothing can be told apart; POV-Ray corrects columns < 1e-10
        value = std::isfinite(value) ? std::clamp(value, -1e6, 1e6) : 0;
    const auto determinant = [&m] { return m[0] * m[4] - m[1] * m[3]; };
    // The part of the picture that a line or a point of it becomes.
    // Taste: POV-Ray must invert it; a larger value shows neighboring texels.
    constexpr double kThin = 1e-6;
    if (std::abs(determinant()) < kThin * kThin) {
        m[0] += kThin;
        m[4] += kThin;
    }
    if (std::abs(determinant()) < kThin * kThin) {
        m[1] += 2 * kThin;
        m[3] -= 2 * kThin;
    }
    const double d = determinant();
    const double a = m[4] / d;
    const double b = -m[1] / d;
    const double c = -m[3] / d;
    const double e = m[0] / d;
    const double values[] = {
        a, c, 0, b, e, 0, 0, 0, 1, -(a * m[2] + b * m[5]), -(c * m[2] + e * m[5]), 0};
    std::string out = " matrix<";
    for (size_t i = 0; i < std::size(values); ++i) {
        append_number(out, values[i]);
        out += i + 1 < std::size(values) ? "," : ">";
    }
    return out;
}

}  // namespace

int halvings_of(const Texture& texture, double texel) {
    if (!(texel > 0) || texture.interpolation != TextureInterpolation::Linear)
        return 0;
    const std::array<double, 6>& m = texture.to_picture;
    const double most = std::min(texel * std::hypot(m[0], m[1]) * texture.picture->width,
                                 texel * std::hypot(m[3], m[4]) * texture.picture->height);
    const int side = std::min(texture.picture->width, texture.picture->height);
    int halvings = 0;
    while ((side >> (halvings + 1)) > 0 && std::ldexp(1.0, halvings + 1) <= most)
        ++halvings;
    return halvings;
}

std::string PictureWriter::file_of(const Texture& texture, PigmentContent content, int halvings) {
    if (content == PigmentContent::Alpha && halvings == 0)
        content = PigmentContent::Number;
    const Picture& picture = *texture.picture;
    if (picture.bytes.empty())
        fail(Status::Internal, "the picture '", picture.name, "' is not resident");
    PictureFile file{texture, content, halvings == 0 && usable_as_is(texture, content), halvings};
    Hasher hasher;
    hasher.value(picture.hash);
    if (!file.as_is) {
        hasher.value(kBakeVersion)
            .value(content == PigmentContent::Filter ? PigmentContent::Color : content)
            .value(texture.channel);
        if (halvings > 0)
            hasher.value(halvings);
        for (int i = 0; i < 3; ++i)
            hasher.value(texture.scale[i]).value(texture.offset[i]);
    }
    file.hash = hasher.result();
    std::string name =
        "i/" + hex16(file.hash) + '.' + (file.as_is ? suffix_of(picture.format) : "png");
    files_.try_emplace(name, std::move(file));
    return name;
}

std::string PictureWriter::file_reference(const Texture& texture, PigmentContent content,
                                          int halvings) {
    const std::string name = file_of(texture, content, halvings);
    const PictureFile& file = files_.at(name);
    const bool jpeg = file.as_is && texture.picture->format == PictureFormat::Jpeg;
    const bool encoded =
        file.as_is ? texture.picture->space == ColorSpace::Srgb : !is_number(content);
    return (jpeg ? "jpeg \"" : "png \"") + name + (encoded ? "\" gamma srgb" : "\" gamma 1.0");
}

std::string PictureWriter::pigment(const Texture& texture, PigmentContent content,
                                   const UvRange& range) {
    const int halvings = content == PigmentContent::Height ? 0 : halvings_of(texture, range.texel);
    const std::string reference = file_reference(texture, content, halvings);
    const bool repeats = texture.extension == TextureExtension::Repeat;
    // `once` keeps the interpolation at a border from reaching over to the opposite one.
    const std::string image =
        "image_map{" + reference +
        (texture.interpolation == TextureInterpolation::Linear ? " interpolate 2" : "") +
        (content == PigmentContent::Filter ? " filter all 1" : "") + (repeats ? "}" : " once}");
    const std::string identifier = "LDS_I_" + hex16(Hasher().text(image).result());
    declared_[identifier] = "pigment{" + image + '}';
    std::string out = identifier;
    if (!repeats && leaves(texture, range)) {
        switch (texture.extension) {
            case TextureExtension::Extend:
                out = extended(extended(out, 'x', halved(texture.picture->width, halvings)), 'y',
                               halved(texture.picture->height, halvings));
                break;
            case TextureExtension::Clip:
                out = clipped(out);
                break;
            case TextureExtension::Mirror:
                out += " warp{repeat x flip x} warp{repeat y flip y}";
                break;
            case TextureExtension::Repeat:
                break;
        }
    }
    return out + mapping(texture);
}

std::string PictureWriter::declared_pigment(const std::string& pigment) {
    const std::string identifier = "LDS_G_" + hex16(Hasher().text(pigment).result());
    declared_[identifier] = pigment;  // before all layers, which begin with LDS_T_
    return "pigment{" + identifier + '}';
}

std::string PictureWriter::layered(const std::string& layers) {
    const std::string identifier = "LDS_T_" + hex16(Hasher().text(layers).result());
    declared_[identifier] = layers;  // behind all images, which begin with LDS_I_
    return "texture{" + identifier + '}';
}

std::string PictureWriter::file_comments() const {
    std::string out;
    for (const auto& [name, file] : files_)
        out += "// " + name + '\n';
    return out;
}

std::string PictureWriter::declarations() const {
    std::string out;
    for (const auto& [identifier, value] : declared_)
        out.append("#ifndef(")
            .append(identifier)
            .append(") #declare ")
            .append(identifier)
            .append(" = ")
            .append(value)
            .append(" #end\n");
    return out;
}

void PictureWriter::write(PictureFolder& folder) const {
    for (const auto& [name, file] : files_)
        folder.add(name, [&file = file, &folder] {
            return file.as_is ? file.texture.picture->bytes : folder.baked(file.hash, [&file] {
                return pigment_picture(file.texture, file.content, file.halvings);
            });
        });
}

void PictureFolder::add(const std::string& name, const std::function<std::string()>& bytes) {
    std::error_code error;
    {
        const std::lock_guard lock(mutex_);
        const auto [at, fresh] = names_.try_emplace(name, false);
        if (!fresh || std::filesystem::exists(folder_ / name, error))
            return;
        at->second = true;
    }
    make_folder(folder_ / "i");
    write_file(folder_ / name, bytes());
}

std::string PictureFolder::baked(Hash key, const std::function<std::string()>& bytes) {
    std::optional<std::string> kept = baked_.find(key);
    if (kept)
        return std::move(*kept);
    std::string made = bytes();
    baked_.add(key, made);
    return made;
}

bool PictureFolder::found(const std::vector<std::string>& names) {
    const std::lock_guard lock(mutex_);
    for (const std::string& name : names) {
        std::error_code error;
        if (names_.contains(name))
            continue;
        if (!std::filesystem::exists(folder_ / name, error))
            return false;
        names_.try_emplace(name, false);
    }
    return true;
}

PictureFolder::PictureTotals PictureFolder::totals() const {
    PictureTotals totals;
    for (const auto& [name, written] : names_) {
        std::error_code error;
        const uintmax_t bytes = std::filesystem::file_size(folder_ / name, error);
        ++totals.files;
        totals.bytes += error ? 0 : bytes;
        const std::optional<image::PictureSize> size = image::picture_size(folder_ / name);
        totals.texels += size ? size->texels() : 0;
        totals.written += written ? 1u : 0u;
    }
    return totals;
}

std::vector<std::string> pictures_named(std::string_view text) {
    std::vector<std::string> names;
    while (text.starts_with(kNameComment)) {
        const size_t end = text.find('\n');
        if (end == std::string_view::npos)
            break;
        const std::string_view name = text.substr(3, end - 3);
        if (safe_relative_name(name))
            names.emplace_back(name);
        text.remove_prefix(end + 1);
    }
    return names;
}

}  // namespace lodestone::povray
