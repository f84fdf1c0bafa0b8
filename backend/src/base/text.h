// SPDX-License-Identifier: GPL-3.0-or-later
// Text from outside: names may be any bytes, files and screens want UTF-8.
// Our own: the standard library has no check of UTF-8, and a library (ICU, simdutf) would be one
// more to install for forty lines that take next to no time.
#pragma once

#include <string>
#include <string_view>

namespace lodestone {

/// The text with every byte that is not part of valid UTF-8 replaced by '?'.
std::string valid_utf8(std::string_view bytes);

}  // namespace lodestone
