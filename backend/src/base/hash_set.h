// SPDX-License-Identifier: GPL-3.0-or-later
// HashSet: a set of hashes whose greatest size is known before.
// Our own beside std::unordered_set: it takes one allocation and hashes nothing again. With it, and
// visited nodes that are handed out instead of copied, a cut takes four fifths of the time
// (tests/bench/speed/bench_cut.cpp).
#pragma once

#include "base/hash.h"

#include <cstddef>
#include <vector>

namespace lodestone {

/// A set of hashes, which are spread evenly already: the place of a hash is its own low bits.
class HashSet {
public:
    /// `most` is how many hashes are inserted at most.
    explicit HashSet(size_t most) {
        size_t places = 16;
        while (places < 2 * most)
            places *= 2;
        places_.assign(places, 0);
    }

    /// Inserts a hash; true when it was not there.
    bool insert(Hash hash) {
        if (hash == 0) {  // 0 marks an empty place
            const bool fresh = !has_zero_;
            has_zero_ = true;
            return fresh;
        }
        const size_t mask = places_.size() - 1;
        size_t at = static_cast<size_t>(hash) & mask;
        while (places_[at] != 0 && places_[at] != hash)
            at = (at + 1) & mask;
        const bool fresh = places_[at] == 0;
        places_[at] = hash;
        return fresh;
    }

private:
    std::vector<Hash> places_;
    bool has_zero_ = false;
};

}  // namespace lodestone
