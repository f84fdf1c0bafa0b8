// SPDX-License-Identifier: GPL-3.0-or-later
// Verbs: what `lodestone VERB` does; one function each, returning the exit code.
#pragma once

#include "arguments.h"

#include <string>
#include <vector>

namespace lodestone::tools {

struct Verb {
    const char* name;
    const char* usage;  // after the verb
    const char* text;   // one line
    const char* details;
    size_t positional;  // how many it takes
    std::vector<OptionHelp> options;
    int (*run)(const Arguments&);
};

/// In the order a user meets them.
const std::vector<Verb>& verbs();

int run_measure(const Arguments& arguments);
int run_simplify(const Arguments& arguments);
int run_build(const Arguments& arguments);
int run_info(const Arguments& arguments);
int run_cut(const Arguments& arguments);
int run_povray(const Arguments& arguments);
int run_compare(const Arguments& arguments);
int run_version(const Arguments& arguments);

}  // namespace lodestone::tools
