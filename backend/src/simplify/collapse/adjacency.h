// SPDX-License-Identifier: GPL-3.0-or-later
// Adjacency: the live triangles around every vertex, in one flat array.
#pragma once

#include "simplify/collapse/collapse_mesh.h"

#include <algorithm>
#include <span>

namespace lodestone::simplify {

struct Adjacency {
    std::vector<uint32_t> first;      // one number for each vertex, plus the end
    std::vector<uint32_t> triangles;  // ascending within a vertex, until a caller orders them

    std::span<const uint32_t> around(uint32_t vertex) const {
        return {triangles.data() + first[vertex], triangles.data() + first[vertex + 1]};
    }
    std::span<uint32_t> around(uint32_t vertex) {
        return {triangles.data() + first[vertex], triangles.data() + first[vertex + 1]};
    }
    size_t valence(uint32_t vertex) const { return first[vertex + 1] - first[vertex]; }

    /// The triangles around a vertex some way on, for a loop over all vertices that asks for memory
    /// early.
    std::span<const uint32_t> ahead(uint32_t vertex) const {
        // Taste: more displace what is still needed, fewer come too late.
        constexpr size_t kAhead = 48;
        // Taste: more ask in vain, as most vertices have six triangles.
        constexpr size_t kMost = 8;
        const size_t from = std::min<size_t>(first[vertex] + kAhead, triangles.size());
        const size_t to = std::min<size_t>(first[vertex + 1] + kAhead, triangles.size());
        return {triangles.data() + from, std::min(to - from, kMost)};
    }

    /// Fills the arrays; the memory of the previous call is used again.
    void build(const CollapseMesh& mesh);
};

/// A set of small integers that is emptied in O(1); each member has a number.
class StampedSet {
public:
    void resize(size_t count) {
        stamps_.assign(count, 0);
        numbers_.resize(count);
        now_ = 1;
    }
    /// Adds room for members, which are not in the set.
    void grow(size_t count) {
        stamps_.resize(count, 0);
        numbers_.resize(count);
    }
    size_t size() const { return stamps_.size(); }
    void clear() { ++now_; }
    bool has(uint32_t i) const { return stamps_[i] == now_; }
    void set(uint32_t i, uint32_t number = 0) {
        stamps_[i] = now_;
        numbers_[i] = number;
    }
    uint32_t number(uint32_t i) const { return numbers_[i]; }

private:
    std::vector<uint32_t> stamps_;
    std::vector<uint32_t> numbers_;
    uint32_t now_ = 0;
};

}  // namespace lodestone::simplify
