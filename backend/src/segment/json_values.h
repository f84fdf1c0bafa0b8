// SPDX-License-Identifier: GPL-3.0-or-later
// JSON values: numbers, vectors and hashes, read from a store that nobody trusts and written so that
// reading gives the same bits. Each reader throws Error(BadFile) or Json::exception.
#pragma once

#include "base/error.h"
#include "base/hash.h"
#include "base/maths.h"

#include <nlohmann/json.hpp>

#include <cmath>
#include <string>
#include <utility>
#include <vector>

namespace lodestone::segment {

using Json = nlohmann::json;

// ---- Reading ----

inline double number(const Json& json, const char* key) {
    const double value = json.at(key).get<double>();
    if (!std::isfinite(value))
        fail(Status::BadFile, "'", key, "' is not a finite number");
    return value;
}

template <typename Integer>
Integer integer(const Json& json, const char* key) {
    const Json& value = json.at(key);
    const auto in_range = [](auto found) { return std::in_range<Integer>(found); };
    if (!value.is_number_integer() ||
        !(value.is_number_unsigned() ? in_range(value.get<uint64_t>())
                                     : in_range(value.get<int64_t>())))
        fail(Status::BadFile, "'", key, "' is not a whole number in its range");
    return value.get<Integer>();
}

inline std::vector<double> numbers(const Json& json, const char* key, size_t count) {
    auto values = json.at(key).get<std::vector<double>>();
    if (values.size() != count)
        fail(Status::BadFile, "'", key, "' has ", values.size(), " numbers; ", count, " expected");
    for (const double value : values) {
        if (!std::isfinite(value))
            fail(Status::BadFile, "'", key, "' holds a number that is not finite");
    }
    return values;
}

inline glm::dvec3 vector(const Json& json, const char* key) {
    const std::vector<double> v = numbers(json, key, 3);
    return {v[0], v[1], v[2]};
}

inline glm::dmat3 matrix(const Json& json, const char* key) {
    const std::vector<double> v = numbers(json, key, 9);
    return {v[0], v[3], v[6], v[1], v[4], v[7], v[2], v[5], v[8]};
}

inline Hash hash(const Json& json, const char* key) {
    const auto word = json.at(key).get<std::string>();
    if (word.size() != 16 || word.find_first_not_of("0123456789abcdef") != std::string::npos)
        fail(Status::BadFile, "'", key, "' is not 16 hexadecimal digits");
    return std::stoull(word, nullptr, 16);
}

inline double number_or(const Json& json, const char* key, double usual) {
    return json.contains(key) ? number(json, key) : usual;
}

template <typename Enum>
Enum choice(const Json& json, const char* key, Enum last) {
    const int value = integer<int>(json, key);
    if (value < 0 || value > static_cast<int>(last))
        fail(Status::BadFile, "'", key, "' is ", value);
    return static_cast<Enum>(value);
}

// ---- Writing ----

inline Json out(const glm::dvec3& v) {
    return Json::array({v.x, v.y, v.z});
}

inline Json out(const glm::dmat3& m) {
    Json rows = Json::array();
    for (int row = 0; row < 3; ++row) {
        for (int column = 0; column < 3; ++column)
            rows.push_back(m[column][row]);
    }
    return rows;
}

inline Json out(const Affine& transform) {
    double rows[12];
    transform.to_rows(rows);
    return Json(std::vector<double>(rows, rows + 12));
}

}  // namespace lodestone::segment
