// SPDX-License-Identifier: GPL-3.0-or-later
// Text lines: walking through text files of words and numbers (OBJ, MTL).
#pragma once

#include <charconv>
#include <cmath>
#include <string>
#include <string_view>

namespace lodestone::format {

inline bool blank(char c) {
    return c == ' ' || c == '\t' || c == '\r' || c == '\v' || c == '\f';
}

inline std::string_view trimmed(std::string_view words) {
    while (!words.empty() && blank(words.front()))
        words.remove_prefix(1);
    while (!words.empty() && blank(words.back()))
        words.remove_suffix(1);
    return words;
}

/// Takes the first word off and returns it; empty: there is none.
inline std::string_view next_word(std::string_view& words) {
    words = trimmed(words);
    size_t end = 0;
    while (end < words.size() && !blank(words[end]))
        ++end;
    const std::string_view word = words.substr(0, end);
    words.remove_prefix(end);
    return word;
}

/// Takes a number off; false (and an unspecified value) when the next word is none. Beyond the
/// range of float it is infinite or 0, as rounding would have it.
inline bool next_float(std::string_view& words, float& value) {
    std::string_view word = next_word(words);
    if (!word.empty() && word.front() == '+')
        word.remove_prefix(1);
    const char* end = word.data() + word.size();
    auto parsed = std::from_chars(word.data(), end, value);
    if (parsed.ec == std::errc::result_out_of_range) {
        double wide = 0;
        parsed = std::from_chars(word.data(), end, wide);
        if (parsed.ec == std::errc::result_out_of_range) {
            parsed.ec = std::errc();
            wide = std::nan("");
        }
        value = static_cast<float>(wide);
    }
    return parsed.ec == std::errc() && parsed.ptr == end && !word.empty();
}

/// Lines end with LF, CR or both; one that ends with a backslash goes on in the next.
class LineReader {
public:
    explicit LineReader(std::string_view bytes) : bytes_(bytes) {}

    /// Gives the next line; false at the end. The line is valid until the next call.
    bool next(std::string_view& line) {
        if (at_ >= bytes_.size())
            return false;
        line = piece();
        if (line.empty() || line.back() != '\\')
            return true;
        joined_.assign(line.substr(0, line.size() - 1));
        while (at_ < bytes_.size()) {
            const std::string_view more = piece();
            joined_ += ' ';
            if (more.empty() || more.back() != '\\') {
                joined_ += more;
                break;
            }
            joined_ += more.substr(0, more.size() - 1);
        }
        line = joined_;
        return true;
    }

    /// The number of the line that next() gave last, counted from 1; a joined line has the number
    /// of its last piece.
    size_t number() const { return number_; }

private:
    std::string_view piece() {
        size_t end = at_;
        while (end < bytes_.size() && bytes_[end] != '\n' && bytes_[end] != '\r')
            ++end;
        const std::string_view found = bytes_.substr(at_, end - at_);
        const bool both = end + 1 < bytes_.size() && bytes_[end] == '\r' && bytes_[end + 1] == '\n';
        at_ = end + (both ? 2 : 1);
        ++number_;
        return found;
    }

    std::string_view bytes_;
    std::string joined_;
    size_t at_ = 0;
    size_t number_ = 0;
};

}  // namespace lodestone::format
