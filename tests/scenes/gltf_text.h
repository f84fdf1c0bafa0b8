// SPDX-License-Identifier: GPL-3.0-or-later
// Small glTF files written out as text, and what reading them says.
#pragma once

#include "format/gltf/glb.h"

#include <cstdint>
#include <string>
#include <vector>

namespace lodestone::format::gltf_text {

inline std::string base64(const std::string& bytes) {
    constexpr char kDigits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::string out;
    for (size_t i = 0; i < bytes.size(); i += 3) {
        uint32_t bits = 0;
        for (size_t k = 0; k < 3; ++k)
            bits = (bits << 8u) |
                   (i + k < bytes.size() ? static_cast<unsigned char>(bytes[i + k]) : 0u);
        for (size_t k = 0; k < 4; ++k)
            out += i + k <= bytes.size() ? kDigits[(bits >> (18 - 6 * k)) & 63u] : '=';
    }
    return out;
}

template <typename T>
std::string raw(const std::vector<T>& values) {
    return {reinterpret_cast<const char*>(values.data()), values.size() * sizeof(T)};
}

/// glTF text with one buffer of 4 positions (a quad in glTF's xy plane) and 6 indices.
inline std::string gltf(const std::string& rest, const std::string& uri = "") {
    const std::string bytes =
        raw<float>({0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0}) + raw<uint16_t>({0, 1, 2, 0, 2, 3});
    return R"({"asset":{"version":"2.0"},"buffers":[{"byteLength":60,"uri":")" +
           (uri.empty() ? "data:application/octet-stream;base64," + base64(bytes) : uri) +
           R"("}],"bufferViews":[{"buffer":0,"byteLength":48},{"buffer":0,"byteOffset":48,"byteLength":12}],)"
           R"("accessors":[{"bufferView":0,"componentType":5126,"count":4,"type":"VEC3"},)"
           R"({"bufferView":1,"componentType":5123,"count":6,"type":"SCALAR"}],)" +
           rest + "}";
}

inline const std::string kOneMesh =
    R"("meshes":[{"name":"quad","primitives":[{"attributes":{"POSITION":0},"indices":1}]}],)";
inline const std::string kOneNode = R"("nodes":[{"mesh":0}],"scenes":[{"nodes":[0]}])";

inline Model read(const std::string& bytes, Problems& problems) {
    return read_glb(bytes, {}, "thing", problems);
}

inline std::string complaint(const std::string& bytes) {
    Problems problems;
    try {
        read(bytes, problems);
    } catch (const Error& e) {
        return e.what();
    }
    return "";
}

inline bool has(const Problems& problems, const std::string& code) {
    for (const Problem& problem : problems) {
        if (problem.code == code)
            return true;
    }
    return false;
}

}  // namespace lodestone::format::gltf_text
