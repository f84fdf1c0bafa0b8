// SPDX-License-Identifier: GPL-3.0-or-later
// Least size: the least of some sizes that many threads find.
#pragma once

#include "base/maths.h"

#include <atomic>

namespace lodestone::light {

/// The least of some sizes, from any thread.
class LeastSize {
public:
    void note(double size) {
        double known = least_.load(std::memory_order_relaxed);
        while (size < known &&
               !least_.compare_exchange_weak(known, size, std::memory_order_relaxed)) {
        }
    }
    double value() const { return least_.load(std::memory_order_relaxed); }

private:
    std::atomic<double> least_{kInfinity};
};

}  // namespace lodestone::light
