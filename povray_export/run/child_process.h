// SPDX-License-Identifier: GPL-3.0-or-later
// Child process: starts a program that cannot outlive this one.
#pragma once

#include <filesystem>
#include <string>
#include <sys/types.h>
#include <vector>

namespace lodestone::povray {

/// A program and what it is started with.
struct SpawnOptions {
    std::string program = {};                   // a path
    std::vector<std::string> arguments = {};    // the first one is the program's own name
    std::vector<std::string> environment = {};  // NAME=value, all of the environment
    std::filesystem::path folder = {};          // the folder where it starts
    int output = -1;                            // file of its standard output and error
};

/// Starts a process and returns its id. The process leads a process group of its own, reads
/// nothing, has no other open file of ours and no blocked or ignored signal, whatever the host
/// program did to its own. The system kills it (SIGKILL) when the calling thread ends, so that
/// thread must wait for it. The start costs the same however much memory the host uses. Throws
/// Error(PovrayMissing) when the program cannot be started.
pid_t spawn(const SpawnOptions& options);

}  // namespace lodestone::povray
