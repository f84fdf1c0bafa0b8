// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/parallel.h"

#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <atomic>
#include <exception>

namespace lodestone {
namespace {

thread_local int thread_limit = 0;

}  // namespace

void parallel_for(size_t count, const std::function<void(size_t)>& body) {
    if (thread_limit == 1 || count < 2) {
        for (size_t i = 0; i < count; ++i)
            body(i);
        return;
    }
    const int limit = thread_limit;
    // No exception goes through TBB 2021.8: where it cancels loops in loops it may crash, for it
    // follows contexts that are gone.
    std::atomic<bool> stopped{false};
    std::exception_ptr thrown;  // by the one that stopped first
    const auto loop = [&] {
        tbb::parallel_for(
            tbb::blocked_range<size_t>(0, count, 1),
            [&](const tbb::blocked_range<size_t>& range) {
                const ThreadLimit same(limit);  // loops started inside are limited alike
                try {
                    for (size_t i = range.begin(); i < range.end() && !stopped; ++i)
                        body(i);
                } catch (...) {
                    if (!stopped.exchange(true))
                        thrown = std::current_exception();
                }
            },
            tbb::simple_partitioner());
    };
    if (limit > 0 && tbb::this_task_arena::max_concurrency() != limit)
        tbb::task_arena(limit).execute(loop);
    else
        loop();
    if (thrown)
        std::rethrow_exception(thrown);
}

int hardware_threads() {
    return thread_limit > 0 ? thread_limit : tbb::this_task_arena::max_concurrency();
}

ThreadLimit::ThreadLimit(int threads) : previous_(thread_limit) {
    thread_limit = threads;
}

ThreadLimit::~ThreadLimit() {
    thread_limit = previous_;
}

}  // namespace lodestone
