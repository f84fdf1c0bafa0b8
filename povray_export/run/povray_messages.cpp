// SPDX-License-Identifier: GPL-3.0-or-later
#include "povray_export/run/povray_messages.h"

#include <algorithm>
#include <charconv>
#include <cmath>

namespace lodestone::povray {
namespace {

/// The bytes of a line that are kept.
/// Taste: POV-Ray's lines are shorter; a larger value lets garbage take more memory.
constexpr size_t kLongestLine = 4096;
/// The bytes of text that are kept, the last ones.
/// Taste: a larger value shows more warnings of a broken scene.
constexpr size_t kLongestText = 8192;
// The columns after which a line goes on in the next one: POV-Ray wraps at 80, before a word, whose
// space then begins the next line, or inside a long one.
// Law: POV-Ray's console width.
constexpr size_t kConsoleWidth = 79;
/// A word that is longer may be wrapped inside.
/// Taste: a larger value joins more lines that begin with a space.
constexpr size_t kLongestWord = 30;

bool contains(const std::string& text, std::string_view part) {
    return text.find(part) != std::string::npos;
}

/// The number that follows `label`, or `otherwise`.
template <typename Number>
Number number_after(const std::string& text, std::string_view label, Number otherwise) {
    const size_t at = text.find(label);
    if (at == std::string::npos)
        return otherwise;
    const char* begin = text.data() + at + label.size();
    const char* end = text.data() + text.size();
    while (begin < end && *begin == ' ')
        ++begin;
    Number value{};
    return std::from_chars(begin, end, value).ec == std::errc() ? value : otherwise;
}

/// Whether a line is about trouble, by POV-Ray's own words; other lines are a banner and
/// statistics.
bool trouble(const std::string& text) {
    // Nobody has to have a configuration file, and a shifted lens is what we asked for.
    if (contains(text, "configuration file") || contains(text, "not perpendicular"))
        return false;
    return contains(text, "Warning:") || contains(text, "rror:") || contains(text, "rror in") ||
           contains(text, "annot ") || contains(text, "ailed") || contains(text, "bad_alloc");
}

bool spaced(const std::string& text) {
    return text.size() > 1 && text[0] == ' ' && text[1] != ' ';
}

}  // namespace

PovrayMessages::LineWrap PovrayMessages::wrap_of(const std::string& text) {
    if (text.size() >= kConsoleWidth)
        return LineWrap::Word;
    return text.size() + kLongestWord >= kConsoleWidth ? LineWrap::Space : LineWrap::No;
}

void PovrayMessages::read(std::string_view piece) {
    for (const char c : piece) {
        if (c != '\r' && c != '\n') {
            if (line_.size() < kLongestLine)
                line_ += c;
            continue;
        }
        line(line_);
        line_.clear();
    }
}

void PovrayMessages::finish() {
    line(line_);
    line_.clear();
    line("");
}

void PovrayMessages::line(const std::string& text) {
    if (!text.empty())
        last_ = text;
    if (!message_.empty()) {
        const bool continues = !text.empty() && (wrapped_ == LineWrap::Word ||
                                                 (wrapped_ == LineWrap::Space && spaced(text)));
        if (continues && message_.size() < kLongestLine) {
            message_ += text;
            wrapped_ = wrap_of(text);
            return;
        }
        keep(message_);
        message_.clear();
    }
    if (text.starts_with("Rendered ")) {
        pixels_done = number_after(text, "Rendered ", pixels_done);
        pixels = number_after(text, " of ", pixels);
    } else if (text.starts_with("Parsing ")) {
        parsed_tokens = 1000 * number_after(text, "Parsing ", parsed_tokens / 1000);
    } else if (contains(text, "CPU-seconds total")) {
        const size_t with = text.find("with ");
        const double seconds =
            with == std::string::npos ? 0 : number_after(text.substr(with), "with ", 0.0);
        if (std::isfinite(seconds) && time_ == TimedPhase::Parse)
            parse_cpu_s += seconds;
        else if (std::isfinite(seconds) && time_ == TimedPhase::Trace)
            trace_cpu_s += seconds;
        time_ = TimedPhase::None;
    } else if (contains(text, "Parse Time:") || contains(text, "Bounding Time:")) {
        time_ = TimedPhase::Parse;
    } else if (contains(text, "Trace Time:")) {
        time_ = TimedPhase::Trace;
    } else if (text == "POV-Ray finished") {
        finished = true;
    } else if (trouble(text)) {
        message_ = text;
        wrapped_ = wrap_of(text);
    }
}

void PovrayMessages::keep(const std::string& message) {
    text_ += message;
    text_ += '\n';
    if (text_.size() > kLongestText)
        text_.erase(0, text_.find('\n', text_.size() - kLongestText) + 1);
    const bool certain = contains(message, "Error:") && !contains(message, "Possible");
    if (certain && error_.empty())
        error_ = message;
    else if (!contains(message, "Warning:") && !contains(message, "Render failed"))
        suspect_ = message;
}

std::string PovrayMessages::reason() const {
    if (!error_.empty())
        return error_;
    if (!suspect_.empty())
        return suspect_;
    return last_.empty() ? "it said nothing" : "it gave no reason; its last line: " + last_;
}

}  // namespace lodestone::povray
