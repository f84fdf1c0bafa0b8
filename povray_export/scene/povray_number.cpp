// SPDX-License-Identifier: GPL-3.0-or-later
#include "povray_export/scene/povray_number.h"

#include "base/error.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstring>

namespace lodestone::povray {
namespace {

/// The pairs of digits "00" "01" ... "99".
/// Law: two digits a step.
constexpr std::array<char, 200> kPairs = [] {
    std::array<char, 200> pairs{};
    for (size_t i = 0; i < 100; ++i) {
        pairs[2 * i] = static_cast<char>('0' + i / 10);
        pairs[2 * i + 1] = static_cast<char>('0' + i % 10);
    }
    return pairs;
}();

/// The powers 10^0 ... 10^22.
/// Law: all that a double holds exactly.
constexpr std::array<double, 23> kPowers = [] {
    std::array<double, 23> powers{};
    double power = 1;
    for (double& next : powers) {
        next = power;
        power *= 10;
    }
    return powers;
}();

/// Writes `left` with leading zeros to that many digits, without zeros at the end; it is not 0.
char* write_decimals(char* at, uint64_t left, int digits) {
    char* end = at + digits;
    char* to = end;
    for (; to - at >= 2; left /= 100)
        std::memcpy(to -= 2, kPairs.data() + 2 * (left % 100), 2);
    if (to > at)
        *at = static_cast<char>('0' + left);
    while (end[-1] == '0')
        --end;
    return end;
}

/// Writes `value`, > 0, with that many significant digits like to_chars(); null where that takes
/// more than one multiplication (tiny and huge numbers) or where the last digit depends on the
/// rounding here.
char* write_short(char* at, double value, int digits) {
    if (!(value >= 1e-4 && value < 1e15) || digits < 1 || digits > 15)
        return nullptr;
    int exponent = 0;  // exponent of the first digit
    if (value >= 1) {
        while (value >= kPowers[static_cast<size_t>(exponent) + 1])
            ++exponent;
    } else {
        do
            --exponent;
        while (value * kPowers[static_cast<size_t>(-exponent)] < 1);
    }
    const int decimals = digits - 1 - exponent;
    if (decimals < 0)
        return nullptr;
    const double steps = value * kPowers[static_cast<size_t>(decimals)];
    const double whole = std::floor(steps);
    if (std::abs(steps - whole - 0.5) <= steps * 0x1p-51)
        return nullptr;
    auto left = static_cast<uint64_t>(whole) + (steps - whole > 0.5 ? 1u : 0u);
    if (static_cast<double>(left) >= kPowers[static_cast<size_t>(digits)])
        return nullptr;  // rounded up to one digit more
    const auto unit = static_cast<uint64_t>(kPowers[static_cast<size_t>(decimals)]);
    at = write_count(at, left / unit);
    left %= unit;
    if (left == 0)
        return at;
    *at++ = '.';
    return write_decimals(at, left, decimals);
}

/// The most characters of a number.
/// Law: to_chars() writes at most a sign, 17 digits, a point and an exponent of five characters.
constexpr size_t kMostCharacters = 40;

char* write_number(char* at, double value, int digits) {
    if (!std::isfinite(value))
        fail(Status::Internal, "a number for POV-Ray is not finite");
    if (value == 0) {
        *at = '0';
        return at + 1;
    }
    *at = '-';
    char* const end = write_short(value < 0 ? at + 1 : at, std::abs(value), digits);
    if (end != nullptr)
        return end;
    return std::to_chars(at, at + kMostCharacters, value, std::chars_format::general, digits).ptr;
}

}  // namespace

char* write_count(char* at, uint64_t value) {
    char digits[20];
    char* const end = digits + sizeof digits;
    char* first = end;
    for (; value >= 100; value /= 100)
        std::memcpy(first -= 2, kPairs.data() + 2 * (value % 100), 2);
    if (value >= 10)
        std::memcpy(first -= 2, kPairs.data() + 2 * value, 2);
    else
        *--first = static_cast<char>('0' + value);
    const auto count = static_cast<size_t>(end - first);
    std::memcpy(at, first, count);
    return at + count;
}

void append_number(std::string& out, double value, int digits) {
    char buffer[kMostCharacters];
    out.append(buffer, write_number(buffer, value, digits));
}

void append_count(std::string& out, uint64_t value) {
    char buffer[20];
    out.append(buffer, write_count(buffer, value));
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
    char buffer[12 * (kMostCharacters + 1)];
    char* at = buffer;
    for (int column = 0; column < 4; ++column) {
        const glm::dvec3& image = column < 3 ? transform.linear[column] : transform.offset;
        for (int i = 0; i < 3; ++i) {
            at = write_number(at, image[i], kSignificantDigits);
            *at++ = ',';
        }
    }
    at[-1] = '>';
    out += "matrix<";
    out.append(buffer, at);
}

DecimalLattice::DecimalLattice(double precision, double largest) {
    // Rounding to the nearest step errs by half a step at most.
    const double wanted = precision > 0 ? std::ceil(-std::log10(2 * precision)) : 300;
    const double possible = largest > 0 ? 14 - std::floor(std::log10(largest)) : 0;
    decimals_ = static_cast<int>(std::clamp(std::min(wanted, possible), -300.0, 300.0));
    steps_ = std::pow(10.0, decimals_);
    whole_ = 0;
    if (decimals_ >= 0 && decimals_ <= 15) {
        whole_ = 1;
        for (int i = 0; i < decimals_; ++i)
            whole_ *= 10;
    }
}

int64_t DecimalLattice::round(double value) const {
    const double steps = value * steps_;
    if (!(std::abs(steps) < 9e18))
        fail(Status::Internal, "a coordinate for POV-Ray is not finite");
    return static_cast<int64_t>(steps + (steps < 0 ? -0.5 : 0.5));
}

char* DecimalLattice::write(char* at, int64_t value) const {
    if (value < 0)
        *at++ = '-';
    auto left = static_cast<uint64_t>(value);
    if (value < 0)
        left = -left;
    if (whole_ == 0) {
        at = write_count(at, left);
        if (left == 0)
            return at;
        *at++ = 'e';
        return std::to_chars(at, at + 8, -decimals_).ptr;
    }
    const uint64_t whole = left / whole_;
    left -= whole * whole_;
    if (whole > 0 || left == 0)
        at = write_count(at, whole);
    if (left == 0)
        return at;
    *at++ = '.';
    return write_decimals(at, left, decimals_);
}

}  // namespace lodestone::povray
