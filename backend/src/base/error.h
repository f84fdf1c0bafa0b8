// SPDX-License-Identifier: GPL-3.0-or-later
// Errors: a caller's mistake or an impossible state throws Error; a fault in the user's data comes
// back as a value plus Problems.
#pragma once

#include <locale>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

namespace lodestone {

/// The causes a caller can act on; the C interface's lds_status has the same numbers.
enum class Status {
    Ok = 0,
    InvalidArgument = 1,
    OutOfMemory = 2,
    Internal = 3,
    Cancelled = 4,
    StaleId = 5,
    Io = 10,
    BadFile = 11,
    RaysUnavailable = 20,
    PovrayMissing = 30,
    PovrayFailed = 31,
};

/// An exception with its cause; what() is a sentence for the user.
class Error : public std::runtime_error {
public:
    Error(Status cause, const std::string& sentence)
        : std::runtime_error(sentence), status(cause) {}
    Status status;
};

/// Joins its arguments as a stream would: text("vertex ", 7, " of ", 3).
template <typename... Parts>
std::string text(const Parts&... parts) {
    std::ostringstream out;
    out.imbue(std::locale::classic());  // the host's locale may write 1.920 for 1920
    (out << ... << parts);
    return out.str();
}

/// Throws Error with the joined sentence.
template <typename... Parts>
[[noreturn]] void fail(Status status, const Parts&... parts) {
    throw Error(status, text(parts...));
}

/// How much a problem matters to the user.
enum class Severity { Info = 0, Warning = 1, Error = 2 };

/// A fault in the user's data that is worth a line in the report; it never stops a scene.
struct Problem {
    std::string object;  // the user's name for the object
    Severity severity = Severity::Warning;
    std::string code;     // snake_case, stable, e.g. "non_finite_vertices"
    std::string message;  // a sentence that says what was done about it
};

using Problems = std::vector<Problem>;

}  // namespace lodestone
