// SPDX-License-Identifier: GPL-3.0-or-later
#include "format/gltf/gltf_extensions.h"

#include "base/error.h"

#include <tiny_gltf.h>

#include <algorithm>
#include <array>

namespace lodestone::format {
namespace {

constexpr std::string_view kDraco = "KHR_draco_mesh_compression";

struct ExtensionAdvice {
    std::string_view extension;
    std::string_view advice;
};

constexpr std::string_view kWithoutDraco =
    "export it without Draco (in Blender's exporter, turn Compression off), or convert it with "
    "'gltf-transform cp IN OUT'";

/// The way to a file without an extension; the last is for those that have no line.
constexpr std::array<ExtensionAdvice, 6> kAdvice{{
    {kDraco, kWithoutDraco},
    {"KHR_meshopt_compression", "pack it as EXT_meshopt_compression, or not at all"},
    {"KHR_texture_basisu", "write its textures as PNG or JPEG"},
    {"EXT_texture_webp", "write its textures as PNG or JPEG"},
    {"EXT_texture_avif", "write its textures as PNG or JPEG"},
    {"", "export it without"},
}};

bool readable(std::string_view extension) {
    constexpr std::array<std::string_view, 5> kReadable{
        "EXT_meshopt_compression", "KHR_mesh_quantization", "KHR_texture_transform",
        "KHR_lights_punctual", "KHR_xmp"};
    return std::find(kReadable.begin(), kReadable.end(), extension) != kReadable.end() ||
           extension.starts_with("KHR_materials_");
}

std::string_view advice_for(std::string_view extension) {
    const auto* const found =
        std::find_if(kAdvice.begin(), kAdvice.end() - 1,
                     [&](const ExtensionAdvice& advice) { return advice.extension == extension; });
    return found->advice;
}

bool has_view(const tinygltf::Model& model, int accessor) {
    return accessor < 0 || static_cast<size_t>(accessor) >= model.accessors.size() ||
           model.accessors[static_cast<size_t>(accessor)].bufferView >= 0;
}

}  // namespace

void check_extensions(const tinygltf::Model& model, const std::string& name) {
    std::string sentences;
    for (const std::string& extension : model.extensionsRequired) {
        if (readable(extension))
            continue;
        if (sentences.size() > 600)  // a hostile file requires a million
            break;
        if (!sentences.empty())
            sentences += "; and ";
        sentences.append(extension, 0, 80);
        sentences.append(", which is not read: ").append(advice_for(extension));
    }
    if (!sentences.empty())
        fail(Status::BadFile, "'", name, "' requires ", sentences);
}

void check_draco(const tinygltf::Model& model, const tinygltf::Primitive& primitive) {
    if (!primitive.extensions.contains(std::string(kDraco)))
        return;
    bool plain = has_view(model, primitive.indices);
    for (const auto& attribute : primitive.attributes)
        plain = plain && has_view(model, attribute.second);
    if (!plain)
        fail(Status::BadFile, "it is compressed by ", kDraco,
             ", which is not read: ", kWithoutDraco);
}

}  // namespace lodestone::format
