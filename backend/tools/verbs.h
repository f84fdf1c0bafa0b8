// SPDX-License-Identifier: GPL-3.0-or-later
// Verbs: the commands `lodestone VERB`; one function each, returning the exit code.
#pragma once

#include "arguments.h"

#include <string>
#include <vector>

namespace lodestone::tools {

/// One verb, for parsing and for help.
struct CommandVerb {
    const char* name;
    const char* usage;  // the words after the verb
    const char* text;   // one line
    const char* details;
    size_t positional;  // words that it takes
    std::vector<OptionHelp> options;
    int (*run)(const CommandArguments&);
};

/// All verbs, in the order a user meets them.
const std::vector<CommandVerb>& verbs();

int run_measure(const CommandArguments& arguments);
int run_simplify(const CommandArguments& arguments);
int run_build(const CommandArguments& arguments);
int run_info(const CommandArguments& arguments);
int run_cut(const CommandArguments& arguments);
int run_povray(const CommandArguments& arguments);
int run_compare(const CommandArguments& arguments);
int run_version(const CommandArguments& arguments);

}  // namespace lodestone::tools
