// SPDX-License-Identifier: GPL-3.0-or-later
#include "simplify/cluster/cell_numbers.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <utility>

namespace lodestone::simplify {
namespace {

// The number of vertices from which on codes of 64 bits are used.
// Taste: a smaller number gives more meshes a finer grid, at twice the memory for sorting.
constexpr size_t kManyPoints = size_t{1} << 20u;
// The bits that one pass sorts by.
// Taste: more bits take fewer passes and larger tables, which leave the cache.
constexpr int kDigit = 10;

template <typename Code>
// The bits for each axis.
// Law: three axes fit into the code, and are a multiple of kDigit.
constexpr int kAxisBits = sizeof(Code) == 4 ? 10 : 20;

using FourBits = uint32_t __attribute__((vector_size(16)));

FourBits spread(FourBits v) {  // puts two zeros behind each of ten bits
    v = (v | v << 16u) & 0x030000ffu;
    v = (v | v << 8u) & 0x0300f00fu;
    v = (v | v << 4u) & 0x030c30c3u;
    return (v | v << 2u) & 0x09249249u;
}

/// The code of a point along the curve, with this many bits for each axis.
template <typename Code>
Code code_of(const Four& point, int bits) {
    using Whole = int __attribute__((vector_size(16)));
    const Four at = point * static_cast<float>((1 << bits) - 1);
    const auto whole = (FourBits) __builtin_convertvector(at, Whole);
    const FourBits low = spread(whole & 1023u);
    const uint32_t code = low[0] | low[1] << 1u | low[2] << 2u;
    if constexpr (sizeof(Code) == 4) {
        return code;
    } else {
        const FourBits high = spread(whole >> 10u);
        return Code{code} | Code{high[0] | high[1] << 1u | high[2] << 2u} << 30u;
    }
}

template <typename Code>
struct CellKey {
    Code code;
    uint32_t vertex;
};

/// The vertices along the curve; those with one code keep their order.
template <typename Code>
ScratchVector<CellKey<Code>> sorted(std::span<const glm::vec3> positions, const CellFrame& frame) {
    // Law: the digits of a code with three axes.
    constexpr size_t kDigits = 3 * kAxisBits<Code> / kDigit;
    // Law: the values of a digit.
    constexpr size_t kValues = size_t{1} << static_cast<unsigned>(kDigit);
    ScratchVector<CellKey<Code>> keys(positions.size());
    std::array<std::array<uint32_t, kValues>, kDigits> starts{};
    for (size_t i = 0; i < positions.size(); ++i) {
        const Code code = code_of<Code>(frame(positions[i]), kAxisBits<Code>);
        keys[i] = {code, static_cast<uint32_t>(i)};
        for (size_t digit = 0; digit < kDigits; ++digit)
            ++starts[digit][code >> (digit * kDigit) & (kValues - 1)];
    }
    ScratchVector<CellKey<Code>> other(positions.size());
    for (size_t digit = 0; digit < kDigits; ++digit) {
        uint32_t sum = 0;
        for (uint32_t& start : starts[digit])
            start = std::exchange(sum, sum + start);
        for (const CellKey<Code>& key : keys)
            other[starts[digit][key.code >> (digit * kDigit) & (kValues - 1)]++] = key;
        keys.swap(other);
    }
    return keys;
}

/// How many of the lowest bits of the codes can be dropped while `least` cells are left. `each`
/// calls back with all codes in their order.
template <typename Each>
int spare_bits(const Each& each, int bits, size_t least) {
    std::array<size_t, 65> splits{};
    each([&](auto code, auto before) {
        ++splits[static_cast<size_t>(std::bit_width(code ^ before))];
    });
    size_t cells = 1;
    for (; bits > 0; --bits) {
        cells += splits[static_cast<size_t>(bits)];
        if (cells >= least)
            return bits - 1;
    }
    return cells >= least ? 0 : -1;
}

/// Numbers the cells in the order of the curve, by sorting all vertices along it.
template <typename Code>
void number_sorted(GridCells& cells, std::span<const glm::vec3> positions, const CellFrame& frame,
                   size_t least) {
    const ScratchVector<CellKey<Code>> keys = sorted<Code>(positions, frame);
    const auto each = [&](const auto& visit) {
        for (size_t i = 1; i < keys.size(); ++i)
            visit(keys[i].code, keys[i - 1].code);
    };
    const int spare = std::max(0, spare_bits(each, 3 * kAxisBits<Code>, least));
    cells.step = std::ldexp(1.0f, (spare + 2) / 3 - kAxisBits<Code>);
    cells.split.reserve(std::min(keys.size(), 2 * least));
    for (size_t i = 0; i < keys.size(); ++i) {
        const int differs =
            i == 0 ? 0 : static_cast<int>(std::bit_width(keys[i].code ^ keys[i - 1].code));
        if (differs > spare)
            cells.split.push_back(static_cast<uint8_t>(differs));
        cells.cell[keys[i].vertex] = static_cast<uint32_t>(cells.split.size());
    }
    cells.split.push_back(64);
}

/// The set of the codes that occur, which counts those below each.
class CodeSet {
public:
    explicit CodeSet(size_t size) : words_(size / 32 + 1, 0) {}
    void add(uint32_t code) { words_[code >> 5u] |= 1u << (code & 31u); }
    void count() {
        below_.resize(words_.size());
        uint32_t sum = 0;
        for (size_t i = 0; i < words_.size(); ++i) {
            below_[i] = sum;
            sum += ones(words_[i]);
        }
    }
    uint32_t below(uint32_t code) const {
        return below_[code >> 5u] + ones(words_[code >> 5u] & ((1u << (code & 31u)) - 1));
    }
    /// Calls back with all codes but the first, each with the code before it.
    template <typename Visit>
    void each_pair(const Visit& visit) const {
        uint32_t before = ~uint32_t{0};
        for (uint32_t i = 0; i < words_.size(); ++i) {
            for (uint32_t word = words_[i]; word != 0; word &= word - 1) {
                const uint32_t code = i << 5u | static_cast<uint32_t>(std::countr_zero(word));
                if (before != ~uint32_t{0})
                    visit(code, before);
                before = code;
            }
        }
    }

private:
    // Counts bits; not all processors have an instruction for it.
    static uint32_t ones(uint32_t word) {
        word -= word >> 1u & 0x55555555u;
        word = (word & 0x33333333u) + (word >> 2u & 0x33333333u);
        return ((word + (word >> 4u)) & 0x0f0f0f0fu) * 0x01010101u >> 24u;
    }
    ScratchVector<uint32_t> words_;
    ScratchVector<uint32_t> below_;
};

/// The same without sorting, for few cells. False: the cells are too many, or too near to each
/// other.
bool number_few(GridCells& cells, std::span<const glm::vec3> positions, const CellFrame& frame,
                size_t least) {
    // Surfaces pass through at least the square of the steps a side.
    const int bits = static_cast<int>(std::bit_width(least) + 2) / 2;
    if (bits > kAxisBits<uint32_t> || size_t{1} << (3 * bits) > 64 * positions.size())
        return false;
    CodeSet fine(size_t{1} << (3 * bits));
    for (size_t i = 0; i < positions.size(); ++i) {
        cells.cell[i] = code_of<uint32_t>(frame(positions[i]), bits);
        fine.add(cells.cell[i]);
    }
    const auto each = [&](const auto& visit) { fine.each_pair(visit); };
    const int spare = spare_bits(each, 3 * bits, least);
    if (spare < 0)
        return false;
    CodeSet coarse(size_t{1} << (3 * bits - spare));
    coarse.add(cells.cell[0] >> spare);
    fine.each_pair([&](uint32_t code, uint32_t before) {
        coarse.add(code >> spare);
        coarse.add(before >> spare);
    });
    coarse.count();
    coarse.each_pair([&](uint32_t code, uint32_t before) {
        cells.split.push_back(static_cast<uint8_t>(std::bit_width(code ^ before) + spare));
    });
    cells.split.push_back(64);
    for (uint32_t& cell : cells.cell)
        cell = coarse.below(cell >> spare);
    cells.step = std::ldexp(1.0f, (spare + 2) / 3 - bits);
    return true;
}

}  // namespace

void number_cells(GridCells& cells, std::span<const glm::vec3> positions, const CellFrame& frame,
                  size_t least) {
    cells.cell.resize(positions.size());
    if (positions.size() > kManyPoints)
        number_sorted<uint64_t>(cells, positions, frame, least);
    else if (!number_few(cells, positions, frame, least))
        number_sorted<uint32_t>(cells, positions, frame, least);
}

}  // namespace lodestone::simplify
