// SPDX-License-Identifier: GPL-3.0-or-later
#include "arguments.h"

#include <algorithm>
#include <charconv>
#include <cmath>

namespace lodestone::tools {
namespace {

/// The number in as few digits as tell it: 8, 0.5, 1e+09.
std::string written(double value) {
    char digits[32];
    const auto end = std::to_chars(digits, digits + sizeof digits, value).ptr;
    return {digits, end};
}

}  // namespace

CommandArguments::CommandArguments(const std::vector<std::string>& words,
                                   const std::vector<OptionHelp>& options) {
    for (size_t i = 0; i < words.size(); ++i) {
        const std::string& word = words[i];
        if (word == "--") {  // the words that follow are names, however they begin
            positional_.insert(positional_.end(),
                               words.begin() + static_cast<std::ptrdiff_t>(i) + 1, words.end());
            break;
        }
        if (word.rfind("--", 0) != 0) {
            positional_.push_back(word);
            continue;
        }
        const size_t equals = word.find('=');
        const std::string name = word.substr(2, equals == std::string::npos ? equals : equals - 2);
        const auto option = std::find_if(options.begin(), options.end(),
                                         [&](const OptionHelp& one) { return name == one.name; });
        if (option == options.end())
            throw UsageError("unknown option --" + name);
        if (option->value[0] == '\0') {
            values_[name] = "";
        } else if (equals != std::string::npos) {
            values_[name] = word.substr(equals + 1);
        } else if (i + 1 < words.size()) {
            values_[name] = words[++i];
        } else {
            std::string sentence = "--" + name;
            sentence.append(" needs a value: --").append(name).append(" ").append(option->value);
            throw UsageError(sentence);
        }
    }
}

std::optional<std::string> CommandArguments::text(const std::string& option) const {
    const auto at = values_.find(option);
    return at == values_.end() ? std::nullopt : std::optional<std::string>(at->second);
}

double CommandArguments::number(const std::string& option, double otherwise, double least,
                                double most) const {
    const auto at = values_.find(option);
    if (at == values_.end())
        return otherwise;
    double value = 0;
    const char* end = at->second.data() + at->second.size();
    const auto parsed = std::from_chars(at->second.data(), end, value);
    if (parsed.ec != std::errc() || parsed.ptr != end || !(value >= least && value <= most))
        throw UsageError("--" + option + " is '" + at->second + "'; a number from " +
                         written(least) + " to " + written(most) + " expected");
    return value;
}

uint64_t CommandArguments::count(const std::string& option, uint64_t otherwise) const {
    const auto at = values_.find(option);
    if (at == values_.end())
        return otherwise;
    uint64_t value = 0;
    const char* end = at->second.data() + at->second.size();
    const auto parsed = std::from_chars(at->second.data(), end, value);
    if (parsed.ec != std::errc() || parsed.ptr != end)
        throw UsageError("--" + option + " is '" + at->second + "'; a whole number expected");
    return value;
}

}  // namespace lodestone::tools
