// SPDX-License-Identifier: GPL-3.0-or-later
// Sibling: files that another file names; only those inside its own folder are opened.
#pragma once

#include <filesystem>
#include <optional>
#include <string_view>

namespace lodestone::format {

/// The existing regular file `name` (relative, / or \ between parts) below `folder`. Nothing when
/// it is absolute, has a part "..", leads out of the folder by a link, or is not there.
std::optional<std::filesystem::path> sibling(const std::filesystem::path& folder,
                                             std::string_view name);

}  // namespace lodestone::format
