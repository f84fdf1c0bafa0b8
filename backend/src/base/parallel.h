// SPDX-License-Identifier: GPL-3.0-or-later
// Parallel loops: loops over threads and their number; no other file pair sees TBB.
#pragma once

#include <cstddef>
#include <functional>

namespace lodestone {

/// Runs body(i) for every i in [0, count) on up to the limited number of threads, in no order.
/// Results must not depend on the order (write to slot i, reduce serially). The first exception
/// is rethrown after the others have stopped.
void parallel_for(size_t count, const std::function<void(size_t)>& body);

/// The small items that a thread takes at a time: a loop over blocks of them costs little by
/// itself.
/// Taste: a larger value leaves threads idle at the end of short loops, a smaller one calls TBB
/// more often.
inline constexpr size_t kBlock = 256;

/// The number of threads that a parallel loop started here would use.
int hardware_threads();

/// A limit on threads: as long as it lives, parallel loops started on this thread use at most
/// `threads` threads (0 = all).
class ThreadLimit {
public:
    explicit ThreadLimit(int threads);
    ~ThreadLimit();
    ThreadLimit(const ThreadLimit&) = delete;
    ThreadLimit& operator=(const ThreadLimit&) = delete;

private:
    int previous_;
};

}  // namespace lodestone
