// SPDX-License-Identifier: GPL-3.0-or-later
#include "format/sibling_file.h"

#include <algorithm>
#include <string>

namespace lodestone::format {

std::optional<std::filesystem::path> sibling(const std::filesystem::path& folder,
                                             std::string_view name) {
    std::string plain(name);
    std::replace(plain.begin(), plain.end(), '\\', '/');
    if (plain.empty() || plain.front() == '/' || plain.find('\0') != std::string::npos ||
        plain.size() > 4096)
        return std::nullopt;
    const std::filesystem::path relative(plain);
    for (const std::filesystem::path& part : relative) {
        if (part == "..")
            return std::nullopt;
    }
    std::error_code failed;
    const std::filesystem::path home =
        std::filesystem::canonical(folder.empty() ? "." : folder, failed);
    if (failed)
        return std::nullopt;
    std::filesystem::path found = std::filesystem::canonical(home / relative, failed);
    if (failed || !std::filesystem::is_regular_file(found, failed))
        return std::nullopt;
    const auto apart = std::mismatch(home.begin(), home.end(), found.begin(), found.end());
    if (apart.first != home.end())
        return std::nullopt;
    return found;
}

}  // namespace lodestone::format
