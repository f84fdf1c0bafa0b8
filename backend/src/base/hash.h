// SPDX-License-Identifier: GPL-3.0-or-later
// Content hash: names of files in stores and keys of caches. It is not cryptographic.
// Every word of eight bytes is taken in by wyhash's folded 64 x 64 bit product (Wang Yi 2019, his
// first two constants) beside degski's 64-bit mixer (two xor-shift-multiply rounds with
// 0xd6e8feb86659fd93), four words at a time side by side in long inputs. The whole is our own and
// stays, although libraries (xxHash) exist: the hashes are the names of files in every store that
// was written.
#pragma once

#include <cstdint>
#include <cstring>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>

namespace lodestone {

/// The hash of some content.
using Hash = uint64_t;

/// Accumulates bytes, eight at a time; equal input sequences give equal values on every run and
/// machine of one byte order. Lengths of arrays are mixed in, so (ab)(c) differs from (a)(bc).
class Hasher {
public:
    Hasher& bytes(const void* data, size_t size) {
        word(size);
        const auto* at = static_cast<const unsigned char*>(data);
        if (size >= kBlock)
            blocks(at, size);
        for (; size >= 8; size -= 8, at += 8) {
            uint64_t next;
            std::memcpy(&next, at, 8);
            word(next);
        }
        if (size > 0) {
            uint64_t last = 0;
            std::memcpy(&last, at, size);
            word(last);
        }
        return *this;
    }

    template <typename T>
    requires std::is_trivially_copyable_v<T> Hasher& array(std::span<const T> values) {
        return bytes(values.data(), values.size_bytes());
    }

    template <typename T>
    requires std::is_arithmetic_v<T> || std::is_enum_v<T> Hasher& value(T value) {
        uint64_t bits = 0;
        std::memcpy(&bits, &value, sizeof value);
        word(bits);
        return *this;
    }

    Hasher& text(std::string_view text) { return bytes(text.data(), text.size()); }

    Hash result() const { return mix(state_ ^ count_); }

private:
    static uint64_t mix(uint64_t x) {
        x ^= x >> 32;
        x *= 0xd6e8feb86659fd93u;
        x ^= x >> 32;
        x *= 0xd6e8feb86659fd93u;
        return x ^ (x >> 32);
    }
    static uint64_t stepped(uint64_t state, uint64_t next) {
        const unsigned __int128 product =
            static_cast<unsigned __int128>(state ^ 0xa0761d6478bd642fu) *
            (next ^ 0xe7037ed1a0b428dbu);
        return mix(state + next) ^ static_cast<uint64_t>(product) ^
               static_cast<uint64_t>(product >> 64);
    }
    void word(uint64_t next) {
        state_ = stepped(state_, next);
        ++count_;
    }
    /// Takes in four words at a time, side by side: one word after the other would wait for each
    /// product.
    void blocks(const unsigned char*& at, size_t& size) {
        uint64_t lanes[4] = {state_, state_ + 1, state_ + 2, state_ + 3};
        for (; size >= kBlock; size -= kBlock, at += kBlock) {
            uint64_t next[4];
            std::memcpy(next, at, kBlock);
            for (int lane = 0; lane < 4; ++lane)
                lanes[lane] = stepped(lanes[lane], next[lane]);
        }
        for (const uint64_t lane : lanes)
            word(lane);
    }
    /// The bytes that are taken in side by side.
    /// Law: four words of eight bytes; another value changes the hashes of long inputs.
    static constexpr size_t kBlock = 32;

    uint64_t state_ = 0x9e3779b97f4a7c15u;
    uint64_t count_ = 0;
};

/// The hash as 16 lower-case hexadecimal digits.
inline std::string hex16(Hash hash) {
    constexpr char kDigits[] = "0123456789abcdef";
    std::string out(16, '0');
    for (int i = 15; i >= 0; --i, hash >>= 4)
        out[static_cast<size_t>(i)] = kDigits[hash & 15];
    return out;
}

}  // namespace lodestone
