// SPDX-License-Identifier: GPL-3.0-or-later
#include "format/model_file.h"

#include "base/files.h"
#include "base/hash.h"
#include "format/gltf/glb.h"
#include "format/obj/mtl.h"
#include "format/obj/obj.h"
#include "format/ply.h"

#include <algorithm>
#include <array>
#include <limits>
#include <map>
#include <string>
#include <string_view>
#include <vector>

namespace lodestone::format {
namespace {

std::string extension_of(const std::filesystem::path& path) {
    std::string extension = path.extension().string();
    for (char& c : extension)
        c = c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
    return extension;
}

/// The model of a file that holds one mesh. `uid`: that of its object, which stores keep.
Model model_of(Mesh mesh, const std::string& name, const char* uid) {
    Model model;
    Material& material = model.materials.emplace_back();
    if (!mesh.colors.empty()) {
        material.vertex_colors = true;
        material.base_color = glm::dvec3(1.0);
    }
    Object object;
    object.uid = uid;
    object.name = name;
    object.representations.emplace_back();
    Representation& finest = object.representations[0];
    finest.materials = {0};
    finest.payload = std::make_shared<const Mesh>(std::move(mesh));
    summarize(finest, model);
    model.objects.push_back(std::move(object));
    model.root = 0;
    summarize_assemblies(model, bottom_up(model));
    return model;
}

/// The file of the materials beside an OBJ file, by a name that a line of that can say.
std::filesystem::path library_of(const std::filesystem::path& path) {
    std::filesystem::path library = path;
    library.replace_extension(".mtl");
    const std::string name = library.filename().string();
    const bool odd = name.front() == ' ' || std::any_of(name.begin(), name.end(), [](char c) {
                         return static_cast<unsigned char>(c) < ' ' || c == '\\' || c == '#';
                     });
    if (odd)
        library.replace_filename("materials-" + hex16(Hasher().text(name).result()) + ".mtl");
    return library;
}

}  // namespace

Mesh flattened(const Model& model, std::vector<uint32_t>& materials) {
    constexpr uint32_t kNone = ~uint32_t{0};
    Mesh whole;
    std::map<uint32_t, uint16_t> slot_of;
    const auto add = [&](const Occurrence& occurrence) {
        const Representation& finest = model.objects[occurrence.object].representations[0];
        Mesh part = tessellated(finest, 3);
        std::vector<uint16_t> slots(part.triangles.size());
        for (size_t i = 0; i < slots.size(); ++i) {
            const uint16_t slot = part.slot(i);
            uint32_t material = finest.materials.empty() ? kNone : finest.materials[0];
            if (slot < finest.materials.size())
                material = finest.materials[slot];
            const auto found = slot_of.emplace(material, materials.size());
            if (found.second) {
                if (materials.size() >= std::numeric_limits<uint16_t>::max())
                    fail(Status::InvalidArgument, "the model uses more than 65534 materials");
                materials.push_back(material);
            }
            slots[i] = found.first->second;
        }
        part.slots = std::move(slots);
        append(whole, part, occurrence.world);
    };
    for_each_occurrence(model, add, OccurrenceUnit::Parts);
    return whole;
}

namespace {

/// A model as one mesh, and the materials of its slots.
struct FlatModel {
    Mesh mesh;
    std::vector<Material> materials;
};

FlatModel flat(const Model& model) {
    FlatModel out;
    std::vector<uint32_t> slots;
    out.mesh = flattened(model, slots);
    out.materials.reserve(slots.size());
    for (const uint32_t index : slots)
        out.materials.push_back(index < model.materials.size() ? model.materials[index]
                                                               : Material{});
    return out;
}

void write_ply_file(const std::filesystem::path& path, const Model& whole) {
    FlatModel model = flat(whole);
    if (std::none_of(model.materials.begin(), model.materials.end(),
                     [](const Material& material) { return material.vertex_colors; }))
        model.mesh.colors.clear();  // nobody sees them
    write_file(path, write_ply(model.mesh));
}

void write_obj_files(const std::filesystem::path& path, const Model& whole) {
    const FlatModel model = flat(whole);
    const std::filesystem::path library = library_of(path);
    const MaterialLibrary written = write_mtl(model.materials);
    for (const auto& [name, picture] : written.pictures)
        write_file(path.parent_path() / name, picture->bytes);
    write_file(library, written.text);
    write_file(path, write_obj(model.mesh, model.materials, path.stem().string(),
                               library.filename().string()));
}

void write_glb_file(const std::filesystem::path& path, const Model& model) {
    write_file(path, write_glb(model));
}

Model read_obj_files(const std::filesystem::path& path, Problems& problems) {
    return read_obj(read_file(path), path, problems);
}

Model read_ply_file(const std::filesystem::path& path, Problems& problems) {
    const std::string name = path.stem().string();
    return model_of(read_ply(read_file(path), name, problems), name, "ply:0");
}

Model read_gltf_files(const std::filesystem::path& path, Problems& problems) {
    const std::filesystem::path folder = path.has_parent_path() ? path.parent_path() : ".";
    return read_glb(read_file(path), folder, path.stem().string(), problems);
}

/// A format by the ending of its files. One that is only read has no `write`.
struct ModelFormat {
    std::string_view ending;
    Model (*read)(const std::filesystem::path& path, Problems& problems);
    void (*write)(const std::filesystem::path& path, const Model& model);
};
constexpr std::array<ModelFormat, 4> kFormats{{
    {".obj", read_obj_files, write_obj_files},
    {".ply", read_ply_file, write_ply_file},
    {".glb", read_gltf_files, write_glb_file},
    {".gltf", read_gltf_files, nullptr},
}};
static_assert(std::all_of(kFormats.begin(), kFormats.end(),
                          [](const ModelFormat& format) { return format.read != nullptr; }));

/// ".obj, .ply and .glb"
std::string endings(bool written) {
    std::vector<std::string_view> all;
    for (const ModelFormat& format : kFormats) {
        if (!written || format.write != nullptr)
            all.push_back(format.ending);
    }
    std::string out;
    for (size_t i = 0; i < all.size(); ++i) {
        out += i == 0 ? "" : i + 1 < all.size() ? ", " : " and ";
        out += all[i];
    }
    return out;
}

/// Throws Error: BadFile, for a file with errors in it of which no triangle is left. One that has
/// none is a model of nothing.
void refuse_unreadable(const std::filesystem::path& path, const Model& model,
                       const Problems& problems) {
    const auto first = std::find_if(problems.begin(), problems.end(), [](const Problem& problem) {
        return problem.severity == Severity::Error;
    });
    if (first != problems.end() && totals(model).triangles_unique == 0)
        fail(Status::BadFile, "nothing of '", path.string(), "' can be read: ", first->message);
}

}  // namespace

Model read_model(const std::filesystem::path& path, Problems& problems) {
    const std::string extension = extension_of(path);
    for (const ModelFormat& format : kFormats) {
        if (format.ending != extension)
            continue;
        Model model = format.read(path, problems);
        refuse_unreadable(path, model, problems);
        return model;
    }
    fail(Status::BadFile, "'", path.string(), "' is not read: only ", endings(false), " are");
}

void write_model(const std::filesystem::path& path, const Model& model) {
    const std::string extension = extension_of(path);
    for (const ModelFormat& format : kFormats) {
        if (format.ending == extension && format.write != nullptr)
            return format.write(path, model);
    }
    fail(Status::InvalidArgument, "'", path.string(), "' is not written: only ", endings(true),
         " are");
}

}  // namespace lodestone::format
