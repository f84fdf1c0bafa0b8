// SPDX-License-Identifier: GPL-3.0-or-later
#include "povray_export/occurrence/clear_surfaces.h"

#include "povray_export/mesh/clear_layers.h"
#include "povray_export/occurrence/occurrence_text.h"
#include "povray_export/run/povray_runner.h"
#include "povray_export/scene/povray_number.h"

#include <algorithm>
#include <cmath>
#include <map>

namespace lodestone::povray {

std::string clear_surfaces_text(const Model& model, const choose::Cut& cut,
                                std::span<const ClearOccurrence> occurrences, Problems& problems) {
    std::map<ObjectIndex, double> sums;
    uint32_t deepest = 0;
    double most = 0;
    for (const ClearOccurrence& occurrence : occurrences) {
        const ObjectIndex object = cut.nodes[occurrence.node].object;
        const double sum = sums[object] += occurrence.layers;
        if (sum > most) {
            most = sum;
            deepest = occurrence.node;
        }
        if (!(occurrence.layers > kMostLayers))
            continue;
        const std::string path = choose::path_of(model, cut, occurrence.node);
        problems.push_back({path.empty() ? model.objects.at(object).name : path, Severity::Warning,
                            "clear_layers",
                            text("has about ", std::lround(occurrence.layers),
                                 " half-clear surfaces one behind the other; POV-Ray may not bear "
                                 "more than 250")});
    }
    if (!(most > 0))
        return "";
    std::string out = kClearObject;
    append_count(out, static_cast<uint64_t>(std::min(most, 1e9)));
    append_name(out += ' ', model, cut, deepest);
    return out + '\n';
}

}  // namespace lodestone::povray
