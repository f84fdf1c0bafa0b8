// SPDX-License-Identifier: GPL-3.0-or-later
#include "report.h"

#include "session.h"
#include "terminal.h"

#include <nlohmann/json.hpp>

#include <cstdio>
#include <fstream>

namespace lodestone::tools {
namespace {

using Json = nlohmann::ordered_json;

Json json_of(const ReportValue& value);

template <typename T>
Json json_of(const T& held) {
    return held;
}

Json json_of(const List& values) {
    Json out = Json::array();
    for (const ReportValue& value : values)
        out.push_back(json_of(value));
    return out;
}

Json json_of(const Fields& fields) {
    Json out = Json::object();
    for (const auto& [name, value] : fields)
        out[name] = json_of(value);
    return out;
}

Json json_of(const ReportValue& value) {
    return std::visit([](const auto& held) { return json_of(held); }, value.held());
}

/// The words of the kinds that can be drawn, with how many occurrences are drawn by each.
std::vector<std::pair<std::string, uint64_t>> kinds_of(const lds_cut_summary& summary) {
    std::vector<std::pair<std::string, uint64_t>> found;
    for (int32_t kind = 0; kind < LDS_KIND_COUNT; ++kind) {
        const std::string word = lds_kind_name(kind);
        if (!word.empty() && kind != LDS_KIND_ASSEMBLY)
            found.emplace_back(word, summary.occurrences_of_kind[kind]);
    }
    return found;
}

}  // namespace

Fields report_of(const char* verb, const std::string& input) {
    return {{"schema", 1u}, {"status", "ok"}, {"verb", verb}, {"input", input}};
}

Fields fields_of(const lds_cut_summary& summary) {
    Fields kinds;
    for (const auto& [word, occurrences] : kinds_of(summary))
        kinds.push_back({word, occurrences});
    return {{"kinds", kinds},
            {"occurrences", summary.occurrences},
            {"originals", summary.originals},
            {"triangles", summary.triangles},
            {"bytes", summary.bytes},
            {"largest_error_px", summary.largest_error_px},
            {"largest_error_name", summary.largest_error_name}};
}

std::string kinds_line(const lds_cut_summary& summary) {
    std::string line;
    for (const auto& [word, occurrences] : kinds_of(summary)) {
        const bool hisses = word.ends_with("sh") || word.ends_with("x");
        line += (line.empty() ? "" : ", ") + std::to_string(occurrences) + " " + word;
        line += hisses ? "es" : "s";
    }
    return line;
}

List problems_of(const lds_model* model) {
    static const char* const kSeverities[] = {"info", "warning", "error"};
    List problems;
    for (size_t i = 0; i < lds_model_problem_count(model); ++i) {
        lds_problem problem{};
        problem.struct_size = sizeof problem;
        check(lds_model_problem(model, i, &problem));
        const char* severity = kSeverities[problem.severity];
        problems.emplace_back(Fields{{"object", problem.object},
                                     {"severity", severity},
                                     {"code", problem.code},
                                     {"message", problem.message}});
        std::fprintf(stderr, "%s: %s: %s\n", severity, terminal_text(problem.object).c_str(),
                     terminal_text(problem.message).c_str());
    }
    return problems;
}

void write_report(const std::string* path, const Fields& report) {
    if (path == nullptr)
        return;
    const std::string temporary = temporary_beside(*path);
    {
        std::ofstream file(temporary, std::ios::binary | std::ios::trunc);
        file << json_of(report).dump(2, ' ', false, Json::error_handler_t::replace) << '\n';
        file.flush();
        if (!file) {
            std::remove(temporary.c_str());
            throw CallFailure(LDS_ERROR_IO, "cannot write '" + *path + "'");
        }
    }
    if (std::rename(temporary.c_str(), path->c_str()) != 0) {
        std::remove(temporary.c_str());
        throw CallFailure(LDS_ERROR_IO, "cannot write '" + *path + "'");
    }
}

}  // namespace lodestone::tools
