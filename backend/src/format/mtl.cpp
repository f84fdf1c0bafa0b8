// SPDX-License-Identifier: GPL-3.0-or-later
#include "format/mtl.h"

#include "format/lines.h"
#include "format/sibling.h"
#include "format/texture.h"

#include <algorithm>
#include <map>
#include <set>

namespace lodestone::format {
namespace {

/// Keeps the old value unless there are as many finite numbers.
void read_values(std::string_view words, double* values, int count) {
    double found[3] = {0, 0, 0};
    for (int i = 0; i < count; ++i) {
        float value = 0;
        if (!next_float(words, value) || !std::isfinite(value))
            return;
        found[i] = static_cast<double>(value);
    }
    std::copy_n(found, count, values);
}

/// The file of "map_Kd [-option value ...] file name": without options it may contain spaces.
std::string_view file_of(std::string_view words) {
    words = trimmed(words);
    if (words.empty() || words.front() != '-')
        return words;
    const size_t last = words.find_last_of(" \t");
    return last == std::string_view::npos ? std::string_view() : words.substr(last + 1);
}

void put_number(std::string& out, double value) {
    char digits[32];
    const auto end = std::to_chars(digits, digits + sizeof digits, static_cast<float>(value));
    out += ' ';
    out.append(digits, end.ptr);
}

}  // namespace

std::vector<Material> read_mtl(std::string_view bytes, const std::filesystem::path& folder,
                               const std::string& name, Problems& problems) {
    std::vector<Material> materials;
    std::map<std::string, glm::dvec3> means;  // every picture is decoded once
    Lines lines(bytes);
    std::string_view line;
    while (lines.next(line)) {
        const std::string_view word = next_word(line);
        if (word == "newmtl") {
            materials.emplace_back();
            materials.back().name = std::string(trimmed(line));
        }
        if (materials.empty())
            continue;
        Material& material = materials.back();
        if (word == "Kd") {
            read_values(line, &material.base_color.x, 3);
        } else if (word == "Ke") {
            read_values(line, &material.emission.x, 3);
        } else if (word == "Pr") {
            read_values(line, &material.roughness, 1);
            material.roughness = std::clamp(material.roughness, 0.0, 1.0);
        } else if (word == "Pm") {
            read_values(line, &material.metallic, 1);
            material.metallic = std::clamp(material.metallic, 0.0, 1.0);
        } else if (word == "map_Kd") {
            const std::string file(file_of(line));
            auto known = means.find(file);
            if (known == means.end()) {
                const auto path = sibling(folder, file);
                try {
                    if (!path)
                        fail(Status::Io, "'", file, "' is not inside the folder of the model");
                    known = means.emplace(file, mean_of(image::read(*path), true)).first;
                    problems.push_back({name, Severity::Info, "texture_averaged",
                                        text("material '", material.name,
                                             "': its texture counts as its mean color")});
                } catch (const Error& e) {
                    problems.push_back({name, Severity::Warning, "texture_missing",
                                        text("material '", material.name, "': ", e.what())});
                    continue;
                }
            }
            material.base_color = known->second;
        }
    }
    return materials;
}

std::vector<std::string> mtl_names(std::span<const Material> materials) {
    std::vector<std::string> names;
    std::set<std::string> taken;
    for (size_t i = 0; i < materials.size(); ++i) {
        std::string name = materials[i].name;
        for (char& c : name) {
            if (static_cast<unsigned char>(c) <= ' ' || c == '\\' || c == '#' || c == 0x7f)
                c = '_';
        }
        if (name.empty())
            name = "material";
        std::string unique = name;
        for (size_t k = 2; !taken.insert(unique).second; ++k)
            unique = text(name, "_", k);
        names.push_back(std::move(unique));
    }
    return names;
}

std::string write_mtl(std::span<const Material> materials) {
    const std::vector<std::string> names = mtl_names(materials);
    std::string out = "# Lodestone\n";
    for (size_t i = 0; i < materials.size(); ++i) {
        const Material& m = materials[i];
        out += "newmtl " + names[i] + "\nKd";
        for (int c = 0; c < 3; ++c)
            put_number(out, m.base_color[c]);
        out += "\nKe";
        for (int c = 0; c < 3; ++c)
            put_number(out, m.emission[c]);
        out += "\nPr";
        put_number(out, m.roughness);
        out += "\nPm";
        put_number(out, m.metallic);
        out += '\n';
    }
    return out;
}

}  // namespace lodestone::format
