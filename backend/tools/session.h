// SPDX-License-Identifier: GPL-3.0-or-later
// Session: one run of the command: its job with a progress bar, Ctrl-C, errors.
#pragma once

#include "lodestone/lodestone.h"

#include <memory>
#include <stdexcept>
#include <string>
#include <thread>

namespace lodestone::tools {

/// A failed call of the library: its status and sentence.
struct CallFailure : std::runtime_error {
    CallFailure(lds_status cause, const std::string& sentence)
        : std::runtime_error(sentence), status(cause) {}
    lds_status status;
};

/// Throws CallFailure with the library's sentence unless the call went well.
void check(lds_status status);

struct DestroyModel {
    void operator()(lds_model* model) const { lds_model_destroy(model); }
};
struct DestroyCut {
    void operator()(lds_cut* cut) const { lds_cut_destroy(cut); }
};
using ModelHandle = std::unique_ptr<lds_model, DestroyModel>;
using CutHandle = std::unique_ptr<lds_cut, DestroyCut>;

/// The options as they are when nothing is asked for. Throws CallFailure.
template <typename Options>
Options usual(lds_status (*fill)(Options*)) {
    Options options{};
    options.struct_size = sizeof options;
    check(fill(&options));
    return options;
}

/// Reads a model or store. Throws CallFailure.
ModelHandle read_model(const std::string& path);

/// A progress bar: it is drawn on stderr while it lives (only on a terminal), and passes Ctrl-C to
/// the job.
class ProgressBar {
public:
    explicit ProgressBar(const char* what);
    ~ProgressBar();
    ProgressBar(const ProgressBar&) = delete;
    ProgressBar& operator=(const ProgressBar&) = delete;
    lds_job* job() { return &job_; }

private:
    lds_job job_{};
    volatile bool done_ = false;
    std::thread watcher_;
};

}  // namespace lodestone::tools
