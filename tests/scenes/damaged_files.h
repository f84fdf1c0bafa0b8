// SPDX-License-Identifier: GPL-3.0-or-later
// Seeded damage to files, shared by the tests of readers.
#pragma once

#include "base/error.h"
#include "base/random.h"

#include <cstdlib>
#include <filesystem>
#include <functional>
#include <gtest/gtest.h>
#include <string>

namespace lodestone::hostile {

/// Flips 1...4 bytes, cuts the end off, repeats a piece, or writes an extreme number over one.
inline std::string mutated(std::string bytes, PcgRandom& random) {
    const auto below = [&](size_t count) {
        return static_cast<size_t>(random.uniform() * static_cast<double>(count));
    };
    if (bytes.empty())
        return bytes;
    switch (below(8)) {
        case 0:
            return bytes.substr(0, below(bytes.size()));
        case 1: {
            const size_t at = below(bytes.size());
            return bytes.insert(at, bytes.substr(below(bytes.size()), below(64)));
        }
        case 2: {
            static const char* const kExtremes[] = {"999999999", "-1", "4294967295", "1e999", "0"};
            const std::string number = kExtremes[below(5)];
            const size_t digit = bytes.find_first_of("0123456789", below(bytes.size()));
            return digit == std::string::npos ? bytes : bytes.replace(digit, 1, number);
        }
        case 3: {
            const size_t at = below(bytes.size());
            return bytes.replace(at, std::min<size_t>(4, bytes.size() - at), 4,
                                 below(2) == 0 ? '\xff' : '\x7f');
        }
        default:
            for (size_t flips = 1 + below(4); flips > 0; --flips)
                bytes[below(bytes.size())] = static_cast<char>(random.next());
            return bytes;
    }
}

/// Feeds `count` damaged copies to `read`: it may succeed or throw Error, nothing else. Returns how
/// many it accepted.
inline int survive(const std::string& bytes, int count,
                   const std::function<void(const std::string&)>& read) {
    int accepted = 0;
    for (int i = 0; i < count; ++i) {
        PcgRandom random(static_cast<uint64_t>(i), 7);
        const std::string damaged = mutated(bytes, random);
        try {
            read(damaged);
            ++accepted;
        } catch (const Error& e) {
            EXPECT_FALSE(std::string(e.what()).empty()) << "mutation " << i;
        } catch (const std::exception& e) {
            ADD_FAILURE() << "mutation " << i << " threw " << e.what();
        }
    }
    return accepted;
}

/// LODESTONE_DATA, or shared/data beside the source folder; empty when `file` is not there.
inline std::filesystem::path data(const std::string& file) {
    const char* folder = std::getenv("LODESTONE_DATA");
    const std::filesystem::path base =
        folder != nullptr ? std::filesystem::path(folder)
                          : std::filesystem::path(__FILE__).parent_path() / "../../../shared/data";
    std::error_code failed;
    return std::filesystem::exists(base / file, failed) ? base / file : std::filesystem::path();
}

}  // namespace lodestone::hostile
