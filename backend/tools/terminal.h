// SPDX-License-Identifier: GPL-3.0-or-later
// Terminal text: names from files, so that they steer no terminal and stay on their line.
#pragma once

#include <string>
#include <string_view>

namespace lodestone::tools {

/// The text with '?' for each character that controls a terminal, ends a line or turns the
/// direction of reading; at most so many bytes of it, cut between characters.
std::string terminal_text(std::string_view text, size_t most = std::string_view::npos);

/// The text as " (text)", as terminal_text() shows it; nothing for no text.
std::string in_brackets(std::string_view text);

/// The name of a file that is written beside `path` and then renamed to it.
std::string temporary_beside(const std::string& path);

}  // namespace lodestone::tools
