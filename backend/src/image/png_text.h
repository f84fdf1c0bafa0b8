// SPDX-License-Identifier: GPL-3.0-or-later
// PNG text: lines of text in a PNG's bytes, without decoding its pixels.
#pragma once

#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace lodestone::image {

using TextLines = std::vector<std::pair<std::string, std::string>>;  // keyword, text

/// The PNG with these tEXt chunks before its pixels; those of the same keyword are replaced.
/// Keywords are 1 to 79 characters; what is not printable ASCII becomes '?'. `name` is what errors
/// call the file. Throws Error(InvalidArgument) for a keyword, Error(BadFile) for what is no PNG.
std::string with_png_text(std::string_view png, const TextLines& lines, const std::string& name);

/// Its tEXt chunks, in their order. Throws Error(BadFile).
TextLines png_text(std::string_view png, const std::string& name);

}  // namespace lodestone::image
