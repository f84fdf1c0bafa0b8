// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/color.h"
#include "format/ply.h"
#include "image/image.h"

#include <array>
#include <bit>
#include <cmath>
#include <optional>

namespace lodestone::format {
namespace {

static_assert(std::endian::native == std::endian::little);

/// The byte that reads back as the same bits, if there is one.
std::optional<uint8_t> byte_of(float value, bool alpha) {
    const float share = alpha ? value : encode_srgb(value);
    if (!(share >= 0 && share <= 1))
        return std::nullopt;
    const auto byte = static_cast<uint8_t>(std::lround(255.0f * share));
    const float back = static_cast<float>(byte / 255.0);
    if ((alpha ? back : decode_srgb(back)) != value)
        return std::nullopt;
    return byte;
}

/// One a vertex, or nothing when bytes would lose a bit.
std::optional<std::vector<std::array<uint8_t, 4>>> bytes_of(const std::vector<glm::vec4>& colors) {
    std::vector<std::array<uint8_t, 4>> out;
    out.reserve(colors.size());
    for (const glm::vec4& color : colors) {
        std::array<uint8_t, 4>& bytes = out.emplace_back();
        for (int c = 0; c < 4; ++c) {
            const auto byte = byte_of(color[c], c == 3);
            if (!byte)
                return std::nullopt;
            bytes[static_cast<size_t>(c)] = *byte;
        }
    }
    return out;
}

template <typename T>
void put(std::string& out, const T& value) {
    out.append(reinterpret_cast<const char*>(&value), sizeof value);
}

}  // namespace

std::string write_ply(const Mesh& mesh) {
    check(mesh);
    std::string out =
        text("ply\nformat binary_little_endian 1.0\ncomment Lodestone\nelement vertex ",
             mesh.positions.size(), "\nproperty float x\nproperty float y\nproperty float z\n");
    if (!mesh.normals.empty())
        out += "property float nx\nproperty float ny\nproperty float nz\n";
    if (!mesh.uvs.empty())
        out += "property float s\nproperty float t\n";
    const auto bytes = bytes_of(mesh.colors);
    if (!mesh.colors.empty()) {
        for (const char* name : {"red", "green", "blue", "alpha"})
            out += text("property ", bytes ? "uchar " : "float ", name, '\n');
    }
    out += text("element face ", mesh.triangles.size(),
                "\nproperty list uchar uint vertex_indices\nend_header\n");
    out.reserve(out.size() + mesh.positions.size() * 48 + mesh.triangles.size() * 13);
    for (size_t i = 0; i < mesh.positions.size(); ++i) {
        put(out, mesh.positions[i]);
        if (!mesh.normals.empty())
            put(out, mesh.normals[i]);
        if (!mesh.uvs.empty())
            put(out, mesh.uvs[i]);
        if (!mesh.colors.empty() && bytes)
            put(out, (*bytes)[i]);
        else if (!mesh.colors.empty())
            put(out, mesh.colors[i]);
    }
    for (const Triangle& triangle : mesh.triangles) {
        out.push_back(3);
        put(out, triangle);
    }
    return out;
}

}  // namespace lodestone::format
