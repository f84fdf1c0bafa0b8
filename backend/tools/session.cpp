// SPDX-License-Identifier: GPL-3.0-or-later
#include "session.h"

#include <chrono>
#include <csignal>
#include <cstdio>
#include <unistd.h>

namespace lodestone::tools {
namespace {

volatile std::sig_atomic_t interrupted = 0;

void on_interrupt(int) {
    interrupted = 1;
}

}  // namespace

void check(lds_status status) {
    if (status != LDS_OK)
        throw CallFailure(status, lds_last_error_text());
}

ModelHandle read_model(const std::string& path) {
    lds_model* model = nullptr;
    check(lds_model_read(path.c_str(), &model));
    return ModelHandle(model);
}

ProgressBar::ProgressBar(const char* what) {
    job_.struct_size = sizeof job_;
    interrupted = 0;
    std::signal(SIGINT, on_interrupt);
    const bool terminal = isatty(STDERR_FILENO) != 0;
    watcher_ = std::thread([this, terminal, what] {
        const volatile double& fraction = job_.fraction;
        volatile int32_t& cancel = job_.cancel;
        for (int tick = 0; !done_; ++tick) {
            if (interrupted != 0)
                cancel = 1;
            if (terminal && tick % 4 == 0) {
                // The characters of the bar.
                // Taste: it fits beside the stage on a terminal of 80 columns.
                constexpr int kBar = 40;
                const int full = static_cast<int>(fraction * kBar);
                std::fprintf(stderr, "\r%s [%.*s%*s] %3.0f %%", what, full,
                             "########################################", kBar - full, "",
                             100 * fraction);
                std::fflush(stderr);
            }
            std::this_thread::sleep_for(std::chrono::milliseconds(25));
        }
        if (terminal)
            std::fprintf(stderr, "\r\033[K");
    });
}

ProgressBar::~ProgressBar() {
    done_ = true;
    watcher_.join();
    std::signal(SIGINT, SIG_DFL);
}

}  // namespace lodestone::tools
