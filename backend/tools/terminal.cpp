// SPDX-License-Identifier: GPL-3.0-or-later
#include "terminal.h"

#include <filesystem>
#include <unistd.h>

namespace lodestone::tools {
namespace {

/// The bytes of the character that begins here if it must not be shown, else 0.
size_t steering(std::string_view text) {
    const auto byte = [&](size_t i) {
        return i < text.size() ? static_cast<unsigned char>(text[i]) : 0u;
    };
    if (byte(0) < 0x20 || byte(0) == 0x7f)
        return 1;
    if (byte(0) == 0xc2 && byte(1) >= 0x80 && byte(1) < 0xa0)  // the other control characters
        return 2;
    if (byte(0) != 0xe2)
        return 0;
    const bool lines = byte(1) == 0x80 && byte(2) >= 0xa8 && byte(2) <= 0xae;  // U+2028...202E
    const bool isolates = byte(1) == 0x81 && byte(2) >= 0xa6 && byte(2) <= 0xa9;
    return lines || isolates ? 3 : 0;
}

bool continues(char c) {
    return (static_cast<unsigned char>(c) & 0xc0u) == 0x80;
}

}  // namespace

std::string terminal_text(std::string_view text, size_t most) {
    std::string out;
    while (!text.empty()) {
        size_t size = steering(text);
        if (size > 0) {
            out += '?';
        } else {
            size = 1;
            while (size < text.size() && continues(text[size]))
                ++size;
            if (out.size() + size > most)
                break;
            out += text.substr(0, size);
        }
        text.remove_prefix(size);
        if (out.size() >= most)
            break;
    }
    return out;
}

std::string in_brackets(std::string_view text) {
    return text.empty() ? std::string() : " (" + terminal_text(text) + ")";
}

std::string temporary_beside(const std::string& path) {
    std::filesystem::path out(path);  // the name is short whatever the path's own name is
    out.replace_filename(".lodestone-" + std::to_string(getpid()) + ".tmp");
    return out.string();
}

}  // namespace lodestone::tools
