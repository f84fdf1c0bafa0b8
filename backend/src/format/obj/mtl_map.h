// SPDX-License-Identifier: GPL-3.0-or-later
// MTL words: keywords <-> fields of Material, "-option value ... file" <-> Texture.
#pragma once

#include "model/material.h"

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <string_view>

namespace lodestone::format {

/// The depth of bumps that MTL's -bm of 1 means, in metres; the format gives it no unit.
/// Taste: the largest dents of plaster or bark; a larger value makes all bumps deeper.
inline constexpr double kBumpMetres = 0.01;

/// A number 0...1 of a material and its keyword.
struct MtlShare {
    std::string_view word;
    double Material::*member;
    double Material::*needs;  // it is written where this is above 0; null: always
};
inline constexpr MtlShare kMtlShares[] = {
    {"Pr", &Material::roughness, nullptr},
    {"Pm", &Material::metallic, nullptr},
    {"Pc", &Material::clearcoat, &Material::clearcoat},
    {"Pcr", &Material::clearcoat_roughness, &Material::clearcoat},
};

/// A map line after its keyword.
struct MapLine {
    std::string file;
    Texture texture;       // without a picture
    bool channel = false;  // -imfchan was there
    double bump = 1;       // -bm
};

/// Numbers that are none, and options we do not know, are skipped.
MapLine map_line(std::string_view words);

/// " -s 2 2 1 -clamp on": of a texture's layout; nothing for one that is turned or clipped.
std::optional<std::string> map_options(const Texture& texture);

/// Pictures by their names in the file; each is read once for a color space.
class MapPictures {
public:
    /// Files are read from below `folder` only.
    explicit MapPictures(const std::filesystem::path& folder) : folder_(folder) {}

    /// Throws Error(BadFile or Io) with a sentence that names it.
    PicturePtr find(const std::string& file, ColorSpace space);

private:
    const std::filesystem::path& folder_;
    std::map<std::pair<std::string, ColorSpace>, PicturePtr> known_;  // by path
    std::map<std::string, std::string> broken_;                       // by path
};

/// " -123.5", so that it reads back as the nearest float.
void put_number(std::string& out, double value);

}  // namespace lodestone::format
