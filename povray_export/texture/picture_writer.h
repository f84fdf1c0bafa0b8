// SPDX-License-Identifier: GPL-3.0-or-later
// Picture writer: textures as POV-Ray's pigments, and the picture files below i/ that they show.
#pragma once

#include "base/findings_folder.h"
#include "model/texture.h"

#include <filesystem>
#include <functional>
#include <map>
#include <mutex>
#include <string>
#include <string_view>
#include <vector>

namespace lodestone::povray {

/// The part of a texture that a pigment shows.
enum class PigmentContent : uint8_t {
    Color = 0,   // its color; transparency is not in it
    Number = 1,  // its number as gray, clamped to 0...1
    Filter = 2,  // its color as a filter of all that goes through it
    Height = 3,  // the heights of a normal map: height_map()
    Alpha = 4,   // as Number; a mask that is made smaller stays one of the same mean
    Leaf = 5,    // its color, where its alpha shows it; elsewhere that of what is around
};

/// The texture coordinates that a surface uses. A picture outside 0...1 costs POV-Ray time when it
/// is no plain repetition, so it is written only where it can be seen.
struct UvRange {
    glm::dvec2 low{0.0};
    glm::dvec2 high{1.0};
    /// The size that one texel may cover, in texture coordinates: larger pictures are made smaller.
    double texel = 0;
};

/// The folder i/ below a scene's folder; all threads of one export share it.
class PictureFolder {
public:
    /// `baked`: the folder that keeps pictures that are not files as they are; "": none does.
    explicit PictureFolder(std::filesystem::path folder, std::filesystem::path baked = {})
        : folder_(std::move(folder)), baked_(std::move(baked), ".png") {}

    /// Writes the file, unless it is there, or is being written by another thread.
    void add(const std::string& name, const std::function<std::string()>& bytes);
    /// The bytes that are kept for a key, else those that are made and kept now.
    std::string baked(Hash key, const std::function<std::string()>& bytes);
    /// Counts files that an old text names; false when one is missing.
    bool found(const std::vector<std::string>& names);

    struct PictureTotals {
        uint64_t files = 0;
        uint64_t bytes = 0;
        uint64_t texels = 0;
        uint64_t written = 0;
    };
    PictureTotals totals() const;  // call when no thread adds any more

private:
    std::filesystem::path folder_;
    FindingsFolder baked_;
    mutable std::mutex mutex_;
    std::map<std::string, bool> names_;  // true: written now
};

/// A collector of the pictures that the text of one representation shows. It serves one thread.
class PictureWriter {
public:
    /// The inside of pigment{...}: a function of texture coordinates, so it must stand below a
    /// uv_mapping. Throws Error(Internal) for a picture that is not resident.
    std::string pigment(const Texture& texture, PigmentContent content, const UvRange& range);

    /// The text `png "i/..." gamma ...` for a pattern of its own, of a picture halved so often.
    /// Throws Error(Internal) for a picture that is not resident.
    std::string file_reference(const Texture& texture, PigmentContent content, int halvings = 0);

    /// The text pigment{...} of a pigment, which is declared: many textures share it.
    std::string declared_pigment(const std::string& pigment);
    /// The text texture{...} of layers, which are declared: a list of textures takes no others.
    std::string layered(const std::string& layers);

    /// The comments that name all files; "" when there is none.
    std::string file_comments() const;
    /// A guarded declaration of every image, so that POV-Ray loads an image once that several
    /// representations show, and of all layers.
    std::string declarations() const;

    /// Writes the files that are not there yet (a name is its content). Throws Error(Io),
    /// Error(BadFile).
    void write(PictureFolder& folder) const;

private:
    struct PictureFile {
        Texture texture;
        PigmentContent content = PigmentContent::Color;
        bool as_is = false;  // true: the picture's own bytes
        int halvings = 0;
        Hash hash = 0;  // of all that its bytes depend on
    };

    std::string file_of(const Texture& texture, PigmentContent content, int halvings);

    std::map<std::string, PictureFile> files_;     // by name
    std::map<std::string, std::string> declared_;  // by identifier: pigment{...} or texture{...}
};

/// The number of times a picture may be halved before one of its texels covers more than `texel` in
/// texture coordinates; 0 where each texel is to be seen.
int halvings_of(const Texture& texture, double texel);

/// The names of the files that file_comments() listed at the beginning of a text, and no others.
std::vector<std::string> pictures_named(std::string_view text);

}  // namespace lodestone::povray
