// SPDX-License-Identifier: GPL-3.0-or-later
#include "povray_export/number.h"

#include "base/error.h"

#include <algorithm>
#include <charconv>
#include <cmath>

namespace lodestone::povray {

void append_number(std::string& out, double value, int digits) {
    if (!std::isfinite(value))
        fail(Status::Internal, "a number for POV-Ray is not finite");
    if (value == 0) {
        out += '0';
        return;
    }
    char buffer[40];
    const auto end =
        std::to_chars(buffer, buffer + sizeof buffer, value, std::chars_format::general, digits);
    out.append(buffer, end.ptr);
}

void append_count(std::string& out, uint64_t value) {
    char buffer[24];
    out.append(buffer, std::to_chars(buffer, buffer + sizeof buffer, value).ptr);
}

void append_vector(std::string& out, const glm::dvec3& value, int digits) {
    out += '<';
    append_number(out, value.x, digits);
    out += ',';
    append_number(out, value.y, digits);
    out += ',';
    append_number(out, value.z, digits);
    out += '>';
}

void append_matrix(std::string& out, const Affine& transform) {
    out += "matrix<";
    for (int column = 0; column < 4; ++column) {
        const glm::dvec3& image = column < 3 ? transform.linear[column] : transform.offset;
        for (int i = 0; i < 3; ++i) {
            append_number(out, image[i]);
            out += column == 3 && i == 2 ? ">" : ",";
        }
    }
}

Lattice::Lattice(double precision, double largest) {
    // Rounding to the nearest step errs by half a step at most.
    const double wanted = precision > 0 ? std::ceil(-std::log10(2 * precision)) : 300;
    const double possible = largest > 0 ? 14 - std::floor(std::log10(largest)) : 0;
    decimals_ = static_cast<int>(std::clamp(std::min(wanted, possible), -300.0, 300.0));
    steps_ = std::pow(10.0, decimals_);
}

int64_t Lattice::round(double value) const {
    const double steps = value * steps_;
    if (!(std::abs(steps) < 9e18))
        fail(Status::Internal, "a coordinate for POV-Ray is not finite");
    return static_cast<int64_t>(steps + (steps < 0 ? -0.5 : 0.5));
}

void Lattice::append(std::string& out, int64_t value) const {
    if (value == 0) {
        out += '0';
        return;
    }
    char digits[24];
    char* end = std::to_chars(digits, digits + sizeof digits, value < 0 ? -value : value).ptr;
    if (value < 0)
        out += '-';
    if (decimals_ < 0 || decimals_ > 15) {
        out.append(digits, end);
        out += 'e';
        end = std::to_chars(digits, digits + sizeof digits, -decimals_).ptr;
        out.append(digits, end);
        return;
    }
    const auto count = static_cast<int>(end - digits);
    const int whole = count - decimals_;
    if (whole > 0)
        out.append(digits, static_cast<size_t>(whole));
    char* fraction = digits + std::max(whole, 0);
    while (end > fraction && end[-1] == '0')
        --end;
    if (end == fraction)
        return;
    out += '.';
    if (whole < 0)
        out.append(static_cast<size_t>(-whole), '0');
    out.append(fraction, static_cast<size_t>(end - fraction));
}

}  // namespace lodestone::povray
