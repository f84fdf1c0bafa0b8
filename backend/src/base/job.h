// SPDX-License-Identifier: GPL-3.0-or-later
// Job: progress and cancellation of a long call, written into memory the caller owns and polls.
#pragma once

#include "base/error.h"

#include <atomic>
#include <cstdint>

namespace lodestone {

/// The stage of a long call; the C interface's lds_stage has the same numbers.
enum class JobStage : int32_t {
    Extract = 1,   // reading the scene from its program
    Measure = 2,   // attributes and errors
    Simplify = 3,  // making representations
    Group = 4,     // making groups
    Store = 5,     // reading or writing a store
    Choose = 6,    // choosing the cut
    Export = 7,    // writing the scene for a renderer
    Parse = 8,     // the renderer reads the scene
    Trace = 9,     // the renderer draws it
};

/// A view of the caller's progress record. Copies share it; a default Job reports to nobody. It may
/// be used from any thread.
class Job {
public:
    Job() = default;
    /// Both pointers may be null; they must outlive every copy of the job.
    Job(const volatile int32_t* cancel, volatile int32_t* stage, volatile double* fraction)
        : cancel_(cancel), stage_(stage), fraction_(fraction) {}

    bool cancelled() const { return cancel_ != nullptr && *cancel_ != 0; }

    /// Throws Error(Cancelled) when the caller asked to stop. Call it at least every 0.1 s.
    void check() const {
        if (cancelled())
            fail(Status::Cancelled, "cancelled");
    }

    /// Moves the bar to `part` (0...1) of this job's range.
    void progress(double part) const {
        if (fraction_ != nullptr)
            *fraction_ = begin_ + (end_ - begin_) * (part < 0 ? 0 : (part > 1 ? 1 : part));
    }

    /// Names the stage of the call.
    void stage(JobStage now) const {
        if (stage_ != nullptr)
            *stage_ = static_cast<int32_t>(now);
    }

    /// The same job as a step sees it that covers `begin`...`end` of the bar.
    Job part(double begin, double end) const {
        Job step = *this;
        step.begin_ = begin_ + (end_ - begin_) * begin;
        step.end_ = begin_ + (end_ - begin_) * end;
        return step;
    }

private:
    const volatile int32_t* cancel_ = nullptr;
    volatile int32_t* stage_ = nullptr;
    volatile double* fraction_ = nullptr;
    double begin_ = 0;
    double end_ = 1;
};

/// The bar of work that several threads do together.
class SharedProgress {
public:
    /// `all`: the whole work, in any unit, above 0.
    SharedProgress(const Job& job, uint64_t all) : job_(job), all_(all) {}
    /// Adds work that is done; from any thread.
    void add(uint64_t work) {
        const uint64_t done = done_ += work;
        job_.progress(static_cast<double>(done) / static_cast<double>(all_));
    }

private:
    const Job& job_;
    uint64_t all_;
    std::atomic<uint64_t> done_{0};
};

}  // namespace lodestone
