// SPDX-License-Identifier: GPL-3.0-or-later
#include "format/obj/mtl.h"
#include "format/obj/obj.h"

#include <algorithm>
#include <array>
#include <charconv>

namespace lodestone::format {
namespace {

template <int N>
void put_line(std::string& out, const char* word, const glm::vec<N, float>& value) {
    out += word;
    for (int i = 0; i < N; ++i) {
        std::array<char, 32> digits;
        const auto end = std::to_chars(digits.data(), digits.data() + digits.size(), value[i]);
        out += ' ';
        out.append(digits.data(), end.ptr);
    }
    out += '\n';
}

/// A name that ends no line and begins no other.
std::string in_one_line(const std::string& name) {
    std::string out = name;
    std::replace_if(
        out.begin(), out.end(), [](char c) { return static_cast<unsigned char>(c) < ' '; }, '_');
    if (!out.empty() && out.back() == '\\')
        out.back() = '_';
    return out;
}

}  // namespace

std::string write_obj(const Mesh& mesh, std::span<const Material> materials,
                      const std::string& name, const std::string& library) {
    check(mesh);
    std::string out = "# Lodestone\n";
    if (!library.empty())
        out += "mtllib " + in_one_line(library) + '\n';
    out += "o " + in_one_line(name) + '\n';
    for (const glm::vec3& position : mesh.positions)
        put_line<3>(out, "v", position);
    for (const glm::vec2& uv : mesh.uvs)
        put_line<2>(out, "vt", uv);
    for (const glm::vec3& normal : mesh.normals)
        put_line<3>(out, "vn", normal);
    const std::vector<std::string> names = mtl_names(materials);
    size_t material = names.size();
    for (size_t i = 0; i < mesh.triangles.size(); ++i) {
        if (mesh.slot(i) < names.size() && mesh.slot(i) != material) {
            material = mesh.slot(i);
            out += "usemtl " + names[material] + '\n';
        }
        out += 'f';
        for (int corner = 0; corner < 3; ++corner) {
            const std::string index = std::to_string(mesh.triangles[i][corner] + 1);
            out += ' ' + index;
            if (!mesh.uvs.empty() || !mesh.normals.empty())
                out += '/' + (mesh.uvs.empty() ? std::string() : index);
            if (!mesh.normals.empty())
                out += '/' + index;
        }
        out += '\n';
    }
    return out;
}

}  // namespace lodestone::format
