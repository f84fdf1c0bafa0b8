// SPDX-License-Identifier: GPL-3.0-or-later
// Picture findings: what only decoding tells of pictures, and pictures computed from others, found
// once for the life of the process and kept in a folder for the next one.
#pragma once

#include "base/hash.h"

#include <glm/vec4.hpp>

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

namespace lodestone::image {

/// The facts about a picture that only decoding tells.
struct PictureFacts {
    int width = 0;
    int height = 0;
    glm::dvec4 mean{0.0};
};

/// The facts by a picture's hash. May be called from any thread.
std::optional<PictureFacts> known_facts(Hash picture);
void add_facts(Hash picture, const PictureFacts& facts);

/// The PNG of a picture that was computed, by the hash of what it was computed from.
std::optional<std::string> kept_bake(Hash key);
void keep_bake(Hash key, std::string_view png);

/// Finds also what the folder keeps, from now on, and writes there what was found since. A folder
/// that cannot be written to is no problem.
void keep_pictures(const std::filesystem::path& folder);

}  // namespace lodestone::image
