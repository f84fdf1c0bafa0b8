// SPDX-License-Identifier: GPL-3.0-or-later
#include "session.h"

#include <chrono>
#include <csignal>
#include <cstdio>
#include <fstream>
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
        throw Failure(status, lds_last_error_text());
}

ModelHandle read_model(const std::string& path) {
    lds_model* model = nullptr;
    check(lds_model_read(path.c_str(), &model));
    return ModelHandle(model);
}

nlohmann::ordered_json problems_of(const lds_model* model) {
    static const char* const kSeverities[] = {"info", "warning", "error"};
    nlohmann::ordered_json problems = nlohmann::ordered_json::array();
    for (size_t i = 0; i < lds_model_problem_count(model); ++i) {
        lds_problem problem{};
        problem.struct_size = sizeof problem;
        check(lds_model_problem(model, i, &problem));
        const char* severity = kSeverities[problem.severity];
        problems.push_back({{"object", problem.object},
                            {"severity", severity},
                            {"code", problem.code},
                            {"message", problem.message}});
        std::fprintf(stderr, "%s: %s: %s\n", severity, problem.object, problem.message);
    }
    return problems;
}

Progress::Progress(const char* what) {
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
                constexpr int kWidth = 40;
                const int full = static_cast<int>(fraction * kWidth);
                std::fprintf(stderr, "\r%s [%.*s%*s] %3.0f %%", what, full,
                             "########################################", kWidth - full, "",
                             100 * fraction);
                std::fflush(stderr);
            }
            std::this_thread::sleep_for(std::chrono::milliseconds(25));
        }
        if (terminal)
            std::fprintf(stderr, "\r\033[K");
    });
}

Progress::~Progress() {
    done_ = true;
    watcher_.join();
    std::signal(SIGINT, SIG_DFL);
}

nlohmann::ordered_json report_of(const char* verb, const std::string& input) {
    return {{"schema", 1}, {"status", "ok"}, {"verb", verb}, {"input", input}};
}

void write_report(const std::string* path, const nlohmann::ordered_json& report) {
    if (path == nullptr)
        return;
    const std::string temporary = *path + ".tmp";
    {
        std::ofstream file(temporary, std::ios::binary | std::ios::trunc);
        file << report.dump(2, ' ', false, nlohmann::json::error_handler_t::replace) << '\n';
        file.flush();
        if (!file) {
            std::remove(temporary.c_str());
            throw Failure(LDS_ERROR_IO, "cannot write '" + *path + "'");
        }
    }
    if (std::rename(temporary.c_str(), path->c_str()) != 0) {
        std::remove(temporary.c_str());
        throw Failure(LDS_ERROR_IO, "cannot write '" + *path + "'");
    }
}

}  // namespace lodestone::tools
