// SPDX-License-Identifier: GPL-3.0-or-later
// Include files: one file for every distinct representation that a scene shows, and its pictures.
#pragma once

#include "povray_export/mesh/mesh_cutting.h"
#include "povray_export/scene/representation_writer.h"
#include "povray_export/scene/scene_writer.h"
#include "povray_export/texture/texture_writer.h"

#include <filesystem>
#include <limits>
#include <unordered_map>
#include <vector>

namespace lodestone::povray {

/// One include file and what is known of it.
struct IncludeFile {
    const Representation* representation = nullptr;
    Hash hash = 0;
    std::string identifier;
    RepresentationOptions options = {};
    std::optional<size_t> same = {};    // the file that stands for this one
    std::optional<Hash> forecast = {};  // the name of the file of what is cut
    uint64_t cut_triangles = 0;         // about what its masks become
    bool pictured = false;              // true: it shows pictures, as fine as they are seen
    double texel = std::numeric_limits<double>::infinity();  // at its nearest use
    NeededTriangles needed = {};                             // by all its uses
    uint64_t bytes = 0;
    bool written = false;
    bool drawn = false;
    bool bumps_left_out = false;
    double clear_layers = 0;  // one behind the other, where they are many
};

/// The include files of one scene. The model must outlive them.
class IncludeFiles {
public:
    /// `findings`: the folder that keeps what was found of masks and pictures; "": none does.
    IncludeFiles(const Model& model, std::filesystem::path folder,
                 const std::filesystem::path& findings)
        : model_(model),
          folder_(std::move(folder)),
          pictures_(folder_, findings.empty() ? findings : findings / "baked"),
          outlines_(findings.empty() ? findings : findings / "masks.bin") {}

    /// Adds a representation and returns the index of its file; copies share one. Where it shows
    /// masks their outlines may be off by `outline` metres of its own frame, at the nearest copy:
    /// a file for far ones, too, would be more text than it saves. `needed`: a byte for each
    /// triangle of a mesh, 0 where the picture does not need it for this copy; empty: all.
    size_t add(const Representation& representation, const RepresentationOptions& options,
               double outline, std::span<const uint8_t> needed = {});
    /// Whether parts of the file may be as coarse as is seen there: it shows masks or pictures, and
    /// nothing but its look was asked for.
    bool varies(size_t index) const;
    /// Gives a file that one thing uses bands, and the outline and texel at its finest place.
    void set_bands(size_t index, DetailBandsPtr bands, double outline, double texel);
    /// Notes what a texel may cover where a file that is `pictured` is used, in metres of its own
    /// frame.
    void note_texel(size_t index, double texel);
    /// Gives the files their names, once all are added and seen. Files that would only differ in
    /// how masks are cut, while these are not or not differently, become one. What only casts
    /// shadows has the file of a use that is seen, if there is any. Where masks of all
    /// files would become more triangles than are left of a memory budget (in bytes; 0: none) of
    /// which `used` are, those that become most are cut less. Files beside r/*.inc keep what is to
    /// be cut for the next export.
    void name(uint64_t budget, uint64_t used, const Job& job);
    /// Writes r/<16 hex>.inc and the pictures that are not there yet. Throws Error(Io),
    /// Error(Cancelled).
    void write(const Job& job);

    /// The file that stands for this one, which may be itself.
    size_t own(size_t index) const;
    const IncludeFile& at(size_t index) const { return files_[own(index)]; }
    size_t size() const { return files_.size(); }
    /// The text that includes all files, and names those of what is cut.
    std::string statements() const;
    /// Adds what was written, or found again, to a report: these files and their pictures.
    void add_to(ExportReport& report) const;
    /// How rays go on at the surfaces of all files.
    OnwardRays onward() const;

private:
    void join_shadows();
    void merge();
    CutForecast forecast(Hash name, const IncludeFile& include, const Job& job);
    uint64_t triangles() const;
    void limit_cut(uint64_t most);
    /// Whether any material of a representation bends light.
    bool bends_light(const Representation& representation) const;
    /// Whether a mesh with texture coordinates shows a material that `is` so.
    bool shows(const Representation& representation, const RepresentationOptions& options,
               bool (*is)(const Material&)) const;

    const Model& model_;
    std::filesystem::path folder_;
    PictureFolder pictures_;
    MaskOutlines outlines_;
    std::vector<IncludeFile> files_;
    std::unordered_map<Hash, size_t> known_;  // by file_hash() without the texel
};

}  // namespace lodestone::povray
