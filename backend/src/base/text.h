// SPDX-License-Identifier: GPL-3.0-or-later
// Text from outside: names may be any bytes, files and screens want UTF-8.
#pragma once

#include <string>
#include <string_view>

namespace lodestone {

/// The text with every byte that is not part of valid UTF-8 replaced by '?'.
std::string valid_utf8(std::string_view bytes);

}  // namespace lodestone
