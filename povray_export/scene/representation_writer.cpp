// SPDX-License-Identifier: GPL-3.0-or-later
#include "povray_export/scene/representation_writer.h"

#include "povray_export/mesh/mesh_writer.h"
#include "povray_export/scene/povray_number.h"

namespace lodestone::povray {
namespace {

// The version of the text: raised whenever the text for the same input changes, for files are found
// again by their name alone.
// Law: part of every file's hash.
constexpr uint32_t kWriterVersion = 3;

/// The text of one solid; nothing for one without size.
std::string solid_text(const Model& model, const Representation& representation, const Solid& solid,
                       const RepresentationOptions& options, PictureWriter& pictures) {
    const Primitive& primitive = solid.primitive;
    if (!(primitive.half_size.x > 0 && primitive.half_size.y > 0 && primitive.half_size.z > 0))
        return "";
    std::string out = solid.box ? "box{<-1,-1,-1>,<1,1,1>" : "sphere{<0,0,0>,1";
    if (options.textures) {
        Material material;
        if (solid.slot < representation.materials.size()) {
            const uint32_t index = representation.materials[solid.slot];
            if (index >= model.materials.size())
                fail(Status::InvalidArgument, "a representation uses material ", index, " of ",
                     model.materials.size());
            material = model.materials[index];
        }
        out += '\n' + texture_text(material, TexturedSurface{}, pictures);
        const double refraction = refraction_of(material);
        if (refraction > 0) {
            out += " interior{ior ";
            append_number(out, refraction, 6);
            out += '}';
        }
    }
    out += '\n';
    append_matrix(out, frame_of(primitive));
    out += "}\n";
    return out;
}

std::string solids_text(const Model& model, const Representation& representation,
                        const std::string& identifier, const RepresentationOptions& options,
                        PictureWriter& pictures) {
    const std::string declare = "#declare " + identifier + " = ";
    if (representation.summary.kind != Kind::Composite) {
        const Solid solid{representation.summary.kind == Kind::Box, representation.primitive(), 0};
        const std::string text = solid_text(model, representation, solid, options, pictures);
        return text.empty() ? text : declare + text;
    }
    std::string out;
    size_t count = 0;
    for (const Solid& solid : representation.composite().solids) {
        const std::string text = solid_text(model, representation, solid, options, pictures);
        count += text.empty() ? 0 : 1;
        out += text;
    }
    if (count == 0)
        return "";
    // A union of one is an error to POV-Ray.
    return count == 1 ? declare + out : declare + "union{\n" + out + "}\n";
}

}  // namespace

Hash file_hash(const Representation& representation, const RepresentationOptions& options) {
    Hasher hasher;
    hasher.value(kWriterVersion)
        .value(representation.summary.hash)
        .value(options.textures)
        .value(options.uvs);
    if (options.texel)
        hasher.value(*options.texel);
    return hasher.result();
}

std::string identifier_of(Hash file) {
    std::string name = "LDS_R_";
    name += hex16(file);
    return name;
}

std::string representation_text(const Model& model, const Representation& representation,
                                const std::string& identifier, const RepresentationOptions& options,
                                PictureWriter& pictures, const Job& job) {
    if (representation.summary.kind != Kind::Mesh)
        return solids_text(model, representation, identifier, options, pictures);
    const Mesh& mesh = representation.mesh();
    check(mesh);
    if (!options.textures)
        return mesh_text(mesh, nullptr, identifier, job);
    const MeshTextures textures(model, representation, options, pictures, job);
    const char* left_out = textures.bumps_left_out() ? kBumpsLeftOut : "";
    return mesh_text(mesh, &textures, identifier, job, pictures.declarations() + left_out);
}

}  // namespace lodestone::povray
