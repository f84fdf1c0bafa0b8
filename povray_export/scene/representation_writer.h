// SPDX-License-Identifier: GPL-3.0-or-later
// Representation writer: one representation as the text of one include file.
#pragma once

#include "base/job.h"
#include "model/model.h"
#include "povray_export/texture/picture_writer.h"

#include <optional>
#include <string>

namespace lodestone::povray {

struct RepresentationOptions {
    bool textures = true;  // false: the occurrence brings its texture
    bool uvs = true;       // texture coordinates, where a texture uses them
    std::optional<int> texel =
        {};  // what a picture's may cover at most: 2^texel metres, in its own frame
};

/// A line at the beginning of the text of a mesh with bumps or normals that are not shown, because
/// they lie on more planes than textures are written for.
inline constexpr const char* kBumpsLeftOut = "// bumps left out\n";

/// Hash of the file's content: of what is drawn, the options and the version of this writer.
Hash file_hash(const Representation& representation, const RepresentationOptions& options);

/// "LDS_R_" + 16 hexadecimal digits.
std::string identifier_of(Hash file);

/// `#declare <identifier> = mesh2{...}`, `box{...}` or `sphere{...}`; "" when nothing of it can be
/// seen (no triangle with an area, a primitive without volume). Before it the declarations of what
/// `pictures` (a new one) is given. Throws Error(Internal) for a non-finite coordinate or a picture
/// that is not resident, Error(InvalidArgument) for a bad index.
/// cost: 0.1-0.2 us a triangle. Thread-safe on a const model.
std::string representation_text(const Model& model, const Representation& representation,
                                const std::string& identifier, const RepresentationOptions& options,
                                PictureWriter& pictures, const Job& job);

}  // namespace lodestone::povray
