// SPDX-License-Identifier: GPL-3.0-or-later
// PNG text: lines of text in a PNG's bytes, which are read and written without decoding pixels.
#pragma once

#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace lodestone::image {

using TextLines = std::vector<std::pair<std::string, std::string>>;  // pairs of keyword and text

/// The PNG with these tEXt chunks before its pixels; chunks of the same keyword are replaced.
/// Keywords are 1 to 79 characters; characters that are not printable ASCII become '?'. `name` is
/// what errors call the file. Throws Error(InvalidArgument) for a keyword, Error(BadFile) for bytes
/// that are no PNG.
std::string with_png_text(std::string_view png, const TextLines& lines, const std::string& name);

/// The tEXt chunks of a PNG, in their order. Throws Error(BadFile).
TextLines png_text(std::string_view png, const std::string& name);

}  // namespace lodestone::image
