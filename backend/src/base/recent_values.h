// SPDX-License-Identifier: GPL-3.0-or-later
// RecentValues: shared values by hash, each made once while all fit into a number of bytes.
#pragma once

#include "base/hash.h"

#include <cstddef>
#include <list>
#include <memory>
#include <mutex>
#include <unordered_map>

namespace lodestone {

/// A cache of values that never change once made; those that were used longest ago go first, but the
/// last one stays however large it is. Values in use elsewhere stay alive there. May be used from
/// any thread: a value that two threads want at once is made by one of them.
template <typename T>
class RecentValues {
public:
    explicit RecentValues(size_t most_bytes) : most_bytes_(most_bytes) {}

    /// The value of a key; where there is none, what `make()` returns (a shared_ptr, not null) is
    /// kept, as `bytes_of(value)` bytes. What `make()` throws is thrown, and no value is kept.
    template <typename Make, typename BytesOf>
    std::shared_ptr<const T> of(Hash key, const Make& make, const BytesOf& bytes_of) {
        std::shared_ptr<RecentValue> entry;
        {
            const std::lock_guard lock(mutex_);
            std::shared_ptr<RecentValue>& known = entries_[key];
            if (known && known->value) {
                by_use_.splice(by_use_.begin(), by_use_, known->place);
                return known->value;
            }
            if (!known)
                known = std::make_shared<RecentValue>();
            entry = known;
        }
        const std::lock_guard making(entry->making);
        {
            const std::lock_guard lock(mutex_);
            if (entry->value)
                return entry->value;
        }
        std::shared_ptr<const T> made = make();
        const size_t bytes = bytes_of(*made);
        std::list<std::shared_ptr<RecentValue>> forgotten;  // freed without the lock
        const std::lock_guard lock(mutex_);
        by_use_.push_front(key);
        entry->place = by_use_.begin();
        entry->bytes = bytes;
        entry->value = made;
        bytes_ += bytes;
        while (bytes_ > most_bytes_ && by_use_.size() > 1) {
            const auto last = entries_.find(by_use_.back());
            bytes_ -= last->second->bytes;
            forgotten.push_back(std::move(last->second));
            entries_.erase(last);
            by_use_.pop_back();
        }
        return made;
    }

    /// The bytes that are kept now.
    size_t bytes() const {
        const std::lock_guard lock(mutex_);
        return bytes_;
    }

private:
    struct RecentValue {
        std::mutex making;
        std::shared_ptr<const T> value;
        size_t bytes = 0;
        std::list<Hash>::iterator place;
    };

    size_t most_bytes_;
    mutable std::mutex mutex_;
    std::unordered_map<Hash, std::shared_ptr<RecentValue>> entries_;
    std::list<Hash> by_use_;  // entries that are made, the last used first
    size_t bytes_ = 0;
};

}  // namespace lodestone
