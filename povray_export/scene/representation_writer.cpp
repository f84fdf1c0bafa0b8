// SPDX-License-Identifier: GPL-3.0-or-later
#include "povray_export/scene/representation_writer.h"

#include "light/clear_materials.h"
#include "povray_export/mesh/clear_layers.h"
#include "povray_export/mesh/mesh_cutting.h"
#include "povray_export/mesh/mesh_writer.h"
#include "povray_export/scene/povray_number.h"

#include <algorithm>
#include <cmath>

namespace lodestone::povray {
namespace {

// The version of the text: raised whenever the text for the same input changes, for files are found
// again by their name alone.
// Law: part of every file's hash.
constexpr uint32_t kWriterVersion = 23;

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
        TexturedSurface surface;
        surface.layered = !options.few_textures;
        surface.light(options.sky ? std::optional(options.sky->even_share()) : std::nullopt,
                      options.around);
        out += '\n' + texture_text(material, surface, pictures);
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

/// Writes what a representation draws, as a declaration: an overload for each kind's payload.
class DeclarationWriter {
public:
    DeclarationWriter(const Model& model, const Representation& representation,
                      const std::string& identifier, const RepresentationOptions& options,
                      PictureWriter& pictures, MaskOutlines& outlines, const Job& job)
        : model_(model),
          representation_(representation),
          identifier_(identifier),
          options_(options),
          pictures_(pictures),
          outlines_(outlines),
          job_(job) {}

    std::string operator()(const Mesh& mesh) const {
        check(mesh);
        if (!options_.textures)
            return mesh_text(mesh, nullptr, identifier_, job_);
        return lit_text(representation_);
    }

    std::string operator()(const Solid& solid) const {
        const glm::dvec3 half = solid.primitive.half_size;
        const bool body = half.x > 0 && half.y > 0 && half.z > 0;
        if (body && options_.textures && options_.sky && options_.sky->shares) {
            Representation lit = representation_;
            lit.payload = std::make_shared<const Mesh>(light::drawn_mesh(representation_));
            lit.summary.kind = Kind::Mesh;
            return lit_text(lit);
        }
        const std::string text = solid_text(model_, representation_, solid, options_, pictures_);
        return text.empty() ? text : declare() + text;
    }

    std::string operator()(const Composite& composite) const {
        std::string out;
        size_t count = 0;
        for (const Solid& solid : composite.solids) {
            const std::string text =
                solid_text(model_, representation_, solid, options_, pictures_);
            count += text.empty() ? 0 : 1;
            out += text;
        }
        if (count == 0)
            return "";
        // A union of one is an error to POV-Ray.
        return count == 1 ? declare() + out : declare() + "union{\n" + out + "}\n";
    }

    std::string operator()(const Assembly&) const {
        fail(Status::Internal, "an assembly is drawn by what it places");
    }

private:
    /// The line of clear layers, where there are many.
    std::string layers_line(const Mesh& shown, const CutMesh& cut) const {
        // The layers that are worth a word.
        // Taste: eight such meshes behind each other may be too many.
        constexpr double kMany = kMostLayers / 8;
        std::vector<uint8_t> clear;  // by slot
        for (size_t slot = 0; slot < representation_.materials.size(); ++slot) {
            const uint32_t material = representation_.materials[slot];
            const bool cut_out = slot < cut.opaque.size() && cut.opaque[slot] != 0;
            clear.push_back(!cut_out && material < model_.materials.size() &&
                                    light::lets_light_through(model_.materials[material])
                                ? 1
                                : 0);
        }
        if (std::find(clear.begin(), clear.end(), uint8_t{1}) == clear.end())
            return "";
        const double layers = clear_layers(shown, [&](size_t i) {
            const uint16_t slot = shown.slot(i);
            return slot < clear.size() && clear[slot] != 0;
        });
        if (!(layers >= kMany))
            return "";
        std::string out = kClearLayers;
        append_count(out, static_cast<uint64_t>(std::min(layers, 1e9)));
        return out + '\n';
    }

    /// The parts that are shown of a mesh whose triangles are parts of these.
    static ShownTrianglesPtr shown_parts(const ShownTrianglesPtr& shown,
                                         std::span<const uint32_t> sources) {
        if (!shown)
            return nullptr;
        ShownTriangles out;
        out.shown.reserve(sources.size());
        for (const uint32_t source : sources)
            out.shown.push_back(shown->shown.at(source));
        return std::make_shared<const ShownTriangles>(std::move(out));
    }

    /// The text of a mesh, whose triangles are split where the sky's light on them varies.
    std::string lit_text(const Representation& representation) const {
        const Mesh& mesh = representation.mesh();
        if (!options_.sky || !options_.sky->shares || light::whole(mesh, *options_.sky->shares))
            return textured_text(representation, options_);
        auto split = light::split_for_sky(mesh, *options_.sky->shares);
        if (!split)
            fail(Status::Internal, "the sky's light on a mesh is that on another mesh");
        Representation lit = representation;
        lit.payload = std::make_shared<const Mesh>(std::move(split->mesh));
        RepresentationOptions options = options_;
        options.shown = shown_parts(options_.shown, split->sources);
        return textured_text(lit, options);
    }

    std::string textured_text(const Representation& representation,
                              const RepresentationOptions& options) const {
        const Mesh& mesh = representation.mesh();
        const CutMesh cut = cut_masks(model_, representation, options, outlines_, job_);
        const MeshTextures textures(model_, representation, cut, options, pictures_, job_);
        std::string left_out = textures.bumps_left_out() ? kBumpsLeftOut : "";
        left_out += layers_line(cut.any ? cut.mesh : mesh, cut);
        return mesh_text(cut.any ? cut.mesh : mesh, &textures, identifier_, job_,
                         pictures_.file_comments() + left_out + pictures_.declarations());
    }

    std::string declare() const {
        return pictures_.declarations() + "#declare " + identifier_ + " = ";
    }

    const Model& model_;
    const Representation& representation_;
    const std::string& identifier_;
    const RepresentationOptions& options_;
    PictureWriter& pictures_;
    MaskOutlines& outlines_;
    const Job& job_;
};

}  // namespace

double outline_error(int outline) {
    return std::exp2(outline / 2.0);
}

int outline_step(double metres) {
    // Law: twice the exponents of a texel.
    constexpr double kMost = 120;
    return metres > 0 ? static_cast<int>(limited(std::floor(2 * std::log2(metres)), -kMost, kMost))
                      : static_cast<int>(-kMost);
}

Hash file_hash(const Representation& representation, const RepresentationOptions& options) {
    Hasher hasher;
    hasher.value(kWriterVersion)
        .value(representation.summary.hash)
        .value(options.textures)
        .value(options.uvs);
    if (options.texel)
        hasher.value(*options.texel);
    if (options.outline)
        hasher.text("outline").value(*options.outline);
    if (options.outline && options.bands)
        hasher.text("bands").value(options.bands->hash());
    if (options.most_cut)
        hasher.text("most cut").value(*options.most_cut);
    if (options.shown)
        hasher.text("shown").value(options.shown->hash);
    if (options.sky)
        hasher.text("sky").value(options.sky->hash);
    if (const glm::dvec3& around = options.around.radiance; around != glm::dvec3(0.0))
        hasher.text("around").value(around.x).value(around.y).value(around.z).value(
            options.around.part);
    if (options.few_textures)
        hasher.text("few textures");
    if (options.only_shadows)
        hasher.text("only shadows");
    if (!options.coarse_crowds)
        hasher.text("fine crowds");
    return hasher.result();
}

std::string identifier_of(Hash file) {
    std::string name = "LDS_R_";
    name += hex16(file);
    return name;
}

std::string representation_text(const Model& model, const Representation& representation,
                                const std::string& identifier, const RepresentationOptions& options,
                                PictureWriter& pictures, MaskOutlines& outlines, const Job& job) {
    return visit(representation, DeclarationWriter(model, representation, identifier, options,
                                                   pictures, outlines, job));
}

}  // namespace lodestone::povray
