// SPDX-License-Identifier: GPL-3.0-or-later
// PovrayMessages: the text that POV-Ray prints while it runs, taken apart.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

namespace lodestone::povray {

/// A reader of POV-Ray's text, piece by piece. Its memory is bounded whatever POV-Ray prints.
class PovrayMessages {
public:
    void read(std::string_view piece);
    /// Ends the last line.
    void finish();

    uint64_t parsed_tokens = 0;  // so far
    uint64_t pixels_done = 0;
    uint64_t pixels = 0;     // 0 until it traces
    double parse_cpu_s = 0;  // parsing and bounding, from its statistics
    double trace_cpu_s = 0;
    bool finished = false;  // POV-Ray said so

    /// The warnings and errors, a line each, the last 8 KB.
    const std::string& text() const { return text_; }
    /// The sentence that says why POV-Ray failed, with file and line where it knows them; its last
    /// line where no sentence does.
    std::string reason() const;

private:
    enum class LineWrap {
        No,
        Space,
        Word
    };  // does the next line go on, if it begins with a space?
    static LineWrap wrap_of(const std::string& text);
    void line(const std::string& text);
    void keep(const std::string& message);

    std::string line_;     // the line that is read
    std::string message_;  // the message that goes on
    LineWrap wrapped_ = LineWrap::No;
    std::string text_;
    std::string error_;    // the first one that is certain
    std::string suspect_;  // the last other message
    std::string last_;     // the last line that was not empty
    enum class TimedPhase { None, Parse, Trace } time_ = TimedPhase::None;
};

}  // namespace lodestone::povray
