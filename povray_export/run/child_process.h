// SPDX-License-Identifier: GPL-3.0-or-later
// Spawn: starts a program that cannot outlive this one.
#pragma once

#include <filesystem>
#include <string>
#include <sys/types.h>
#include <vector>

namespace lodestone::povray {

struct SpawnOptions {
    std::string program = {};                   // a path
    std::vector<std::string> arguments = {};    // the first is its own name
    std::vector<std::string> environment = {};  // NAME=value, the whole of it
    std::filesystem::path folder = {};          // where it starts
    int output = -1;                            // its standard output and error
};

/// The id of the new process, which leads a process group of its own, reads nothing, has no other
/// open file of ours and no blocked or ignored signal, whatever the host program did to its own.
/// The system kills it (SIGKILL) when the calling thread ends, so that thread must wait for it.
/// Costs the same however much memory the host uses. Throws Error(PovrayMissing) when it cannot be
/// started.
pid_t spawn(const SpawnOptions& options);

}  // namespace lodestone::povray
