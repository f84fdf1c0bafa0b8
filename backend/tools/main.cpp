// SPDX-License-Identifier: GPL-3.0-or-later
// The `lodestone` command. Exit codes: 0 done, 1 failed, 2 usage, 4 input unreadable, 130
// cancelled.
#include "session.h"
#include "terminal.h"
#include "verbs.h"

#include <cstdio>

using namespace lodestone::tools;

namespace {

void print_help(std::FILE* out) {
    std::fprintf(out,
                 "Lodestone %s: simpler versions of models, and just the detail a picture needs\n\n"
                 "usage: lodestone VERB ... [--options]\n\n",
                 lds_version());
    for (const CommandVerb& verb : verbs())
        std::fprintf(out, "  %-9s %-9s %s\n", verb.name, verb.usage, verb.text);
    std::fprintf(out,
                 "\n`lodestone VERB --help` explains one. Examples:\n"
                 "  lodestone simplify statue.ply small.glb --ratio 0.1\n"
                 "  lodestone build city.glb city_store\n"
                 "  lodestone cut city_store --eye 100,-80,40 --pixel-error 2\n");
}

void print_help(std::FILE* out, const CommandVerb& verb) {
    std::fprintf(out, "usage: lodestone %s %s [--options]\n\n%s\n", verb.name, verb.usage,
                 verb.text);
    if (verb.details[0] != '\0')
        std::fprintf(out, "%s\n", verb.details);
    std::fprintf(out, "\n");
    for (const OptionHelp& option : verb.options) {
        const std::string left =
            std::string("--") + option.name + (option.value[0] != '\0' ? " " : "") + option.value;
        std::fprintf(out, "  %-22s %s\n", left.c_str(), option.text);
    }
}

int exit_code_of(lds_status status) {
    switch (status) {
        case LDS_ERROR_CANCELLED:
            return 130;
        case LDS_ERROR_IO:
        case LDS_ERROR_BAD_FILE:
            return 4;
        default:
            return 1;
    }
}

int run(const std::vector<std::string>& words) {
    if (words.empty()) {
        print_help(stderr);
        return 2;
    }
    if (words[0] == "--help" || words[0] == "-h" || words[0] == "help") {
        print_help(stdout);
        return 0;
    }
    for (const CommandVerb& verb : verbs()) {
        if (words[0] != verb.name && !(words[0] == "--version" && verb.run == run_version))
            continue;
        const std::vector<std::string> rest(words.begin() + 1, words.end());
        for (const std::string& word : rest) {
            if (word == "--")
                break;
            if (word == "--help" || word == "-h") {
                print_help(stdout, verb);
                return 0;
            }
        }
        const CommandArguments arguments(rest, verb.options);
        if (arguments.positional().size() != verb.positional)
            throw UsageError(std::string("expected: lodestone ") + verb.name + " " + verb.usage);
        return verb.run(arguments);
    }
    throw UsageError("'" + words[0] + "' is no verb of lodestone; see lodestone --help");
}

/// The exit code after all is told: printed text may lie in a buffer until now, and the disk be
/// full.
int told(int code) {
    if (std::fflush(stdout) == 0 && std::ferror(stdout) == 0)
        return code;
    std::fprintf(stderr, "lodestone: cannot write to the standard output\n");
    return code == 0 ? 1 : code;
}

}  // namespace

int main(int argc, char** argv) {
    try {
        return told(run(std::vector<std::string>(argv + 1, argv + argc)));
    } catch (const UsageError& error) {
        std::fprintf(stderr, "lodestone: %s\n", terminal_text(error.what()).c_str());
        return 2;
    } catch (const CallFailure& failure) {
        std::fprintf(stderr, "lodestone: %s\n", terminal_text(failure.what()).c_str());
        return exit_code_of(failure.status);
    } catch (const std::exception& error) {
        std::fprintf(stderr, "lodestone: %s\n", terminal_text(error.what()).c_str());
        return 1;
    }
}
