// SPDX-License-Identifier: GPL-3.0-or-later
#include "povray_export/run/child_process.h"

#include "base/error.h"

#include <array>
#include <cerrno>
#include <csignal>
#include <cstring>
#include <fcntl.h>
#include <memory>
#include <sched.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

namespace lodestone::povray {
namespace {

struct alignas(16) ChildStack {
    std::array<char, 65536> bytes;
};

/// The data of the child: all of it is made by the parent, since the child may not allocate.
struct SpawnPlan {
    const char* program = nullptr;
    char* const* arguments = nullptr;
    char* const* environment = nullptr;
    const char* folder = nullptr;
    int output = -1;
    pid_t parent = 0;
    int error = 0;  // set by the child that shares our memory
};

std::vector<char*> pointers(const std::vector<std::string>& strings) {
    std::vector<char*> out;
    out.reserve(strings.size() + 1);
    for (const std::string& string : strings)
        out.push_back(const_cast<char*>(string.c_str()));
    out.push_back(nullptr);
    return out;
}

/// Closes every file but the standard three.
void close_others() {
    if (close_range(3, ~0U, 0) == 0)
        return;
    const long most = sysconf(_SC_OPEN_MAX);  // a kernel before 5.9
    for (int file = 3; file < most; ++file)
        close(file);
}

/// Prepares the standard files as the program is to find them; returns 0, else errno.
int prepare_files(int output) {
    const int nothing = open("/dev/null", O_RDONLY);
    // Copies are above 2: the host may have closed its standard files, so that either may be 0...2.
    const int input = nothing < 0 ? -1 : fcntl(nothing, F_DUPFD, 3);
    const int high = fcntl(output, F_DUPFD, 3);
    if (input < 0 || high < 0 || dup2(input, 0) < 0 || dup2(high, 1) < 0 || dup2(high, 2) < 0)
        return errno;
    close_others();
    return 0;
}

/// Returns errno only when the program could not be started.
int start(const SpawnPlan& plan) {
    if (prctl(PR_SET_PDEATHSIG, SIGKILL) != 0)
        return errno;
    if (getppid() != plan.parent)  // the parent died before we asked to be told
        return ESRCH;
    if (setpgid(0, 0) != 0 || chdir(plan.folder) != 0)
        return errno;
    const int number = prepare_files(plan.output);
    if (number != 0)
        return number;
    struct sigaction ordinary {};
    ordinary.sa_handler = SIG_DFL;
    for (int signal = 1; signal < NSIG; ++signal)
        // Refused for some signals, which nobody can change.
        sigaction(signal, &ordinary, nullptr);
    sigset_t none;
    sigemptyset(&none);
    sigprocmask(SIG_SETMASK, &none, nullptr);
    execve(plan.program, plan.arguments, plan.environment);
    return errno;
}

/// Runs in the child, on a stack of its own but in the parent's memory, while the parent's thread
/// stands still: system calls only.
int run_child(void* argument) {
    SpawnPlan& plan = *static_cast<SpawnPlan*>(argument);
    plan.error = start(plan);
    _exit(127);
}

}  // namespace

pid_t spawn(const SpawnOptions& options) {
    const std::vector<char*> arguments = pointers(options.arguments);
    const std::vector<char*> environment = pointers(options.environment);
    SpawnPlan plan{options.program.c_str(), arguments.data(), environment.data(),
                   options.folder.c_str(),  options.output,   getpid()};
    const auto stack = std::make_unique<ChildStack>();

    // The child is made like posix_spawn does it, which cannot ask for the death signal: sharing
    // memory until exec costs nothing and fails less often than fork() in a process of many
    // gigabytes. No handler of the host may run in the child.
    sigset_t all;
    sigset_t before;
    sigfillset(&all);
    pthread_sigmask(SIG_BLOCK, &all, &before);
    char* top = stack->bytes.data() + stack->bytes.size();  // it grows downwards
    const pid_t process = clone(run_child, top, CLONE_VM | CLONE_VFORK | SIGCHLD, &plan);
    const int number = process < 0 ? errno : plan.error;
    pthread_sigmask(SIG_SETMASK, &before, nullptr);
    if (number != 0) {
        while (process > 0 && waitpid(process, nullptr, 0) < 0 && errno == EINTR) {
        }
        char buffer[256];
        fail(Status::PovrayMissing, "cannot start POV-Ray ('", options.program,
             "'): ", strerror_r(number, buffer, sizeof buffer));
    }
    return process;
}

}  // namespace lodestone::povray
