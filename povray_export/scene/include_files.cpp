// SPDX-License-Identifier: GPL-3.0-or-later
#include "povray_export/scene/include_files.h"

#include "base/error.h"
#include "base/files.h"
#include "base/parallel.h"
#include "povray_export/texture/surface_finish.h"
#include "povray_export/texture/texture_writer.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <optional>
#include <unordered_set>

namespace lodestone::povray {
namespace {

/// The bytes at the beginning of an include file that can name its pictures.
/// Taste: a larger value reads more of every file that is found again.
constexpr size_t kBeginning = size_t{16} << 10u;
std::string beginning_of(const std::filesystem::path& path) {
    std::string text(kBeginning, ' ');
    std::ifstream file(path, std::ios::binary);
    file.read(text.data(), static_cast<std::streamsize>(text.size()));
    text.resize(static_cast<size_t>(std::max<std::streamsize>(file.gcount(), 0)));
    return text;
}

/// The time that a file takes beside its triangles, in triangles.
/// Taste: about what opening and naming a file cost; a larger value wakes threads for fewer files.
constexpr uint64_t kTrianglesOfFile = 1000;
/// Fewer triangles (3 ms) are written by one thread: waking others takes 0.3 ms.
/// Taste: a larger value writes middle scenes on one thread.
constexpr uint64_t kFewTriangles = 50'000;

/// The triangles that masks of all files together may become, where these have `triangles` without.
uint64_t most_cut_triangles(uint64_t budget, uint64_t used, uint64_t triangles) {
    // Law: the bytes of a triangle of a cut-out mask in POV-Ray, as measured.
    constexpr uint64_t kBytes = 245;
    // The part of a budget that they may take beyond it.
    // Taste: a larger value cuts more masks, for memory nobody wanted to give.
    constexpr uint64_t kPart = 8;
    // The triangles that they may become without a budget.
    // Taste: 250 MB; a larger value cuts more masks.
    constexpr uint64_t kFew = uint64_t{1} << 20u;
    // The triangles that they may become for each that is there already.
    // Taste: five times what the scene takes; a larger value cuts more masks.
    constexpr uint64_t kEach = 4;
    if (budget == 0)
        return kFew + kEach * triangles;
    return (budget - std::min(budget, used) + budget / kPart) / kBytes;
}

int exponent_of(double texel) {
    // The largest exponent of a texel's size, in both directions.
    // Taste: beyond it nothing can be told apart.
    constexpr int kMost = 60;
    return texel > 0 && std::isfinite(texel) ? std::clamp(std::ilogb(texel), -kMost, kMost)
                                             : -kMost;
}

}  // namespace

size_t IncludeFiles::add(const Representation& representation, const RepresentationOptions& options,
                         double outline, std::span<const uint8_t> needed) {
    const auto [at, fresh] = known_.try_emplace(file_hash(representation, options), files_.size());
    const int step = outline_step(outline);
    if (fresh) {
        IncludeFile& include = files_.emplace_back();
        include.representation = &representation;
        include.options = options;
        if (options.textures && shows(representation, options, may_be_mask))
            include.options.outline = step;
        include.pictured = options.textures && shows(representation, options, textured);
    }
    IncludeFile& include = files_[at->second];
    std::optional<int>& least = include.options.outline;
    if (least)
        least = std::min(*least, step);
    // Glass is a body, of which rays need all sides. Solids may be written as other triangles than
    // those that were looked at.
    const bool known = options.textures && !bends_light(representation) &&
                       needed.size() == light::drawn_triangles(representation);
    include.needed.add(known ? needed : std::span<const uint8_t>{});
    return at->second;
}

bool IncludeFiles::varies(size_t index) const {
    const IncludeFile& include = files_[index];
    return include.options.outline || (include.pictured && !include.options.only_shadows);
}

void IncludeFiles::set_bands(size_t index, DetailBandsPtr bands, double outline, double texel) {
    IncludeFile& include = files_[index];
    if (include.options.outline) {
        include.options.outline = outline_step(outline);
        include.options.bands = bands->even() ? nullptr : std::move(bands);
    }
    include.texel = texel;
}

void IncludeFiles::note_texel(size_t index, double texel) {
    // Copies that are textured share a file for the nearest of them.
    files_[index].texel = std::min(files_[index].texel, texel);
}

size_t IncludeFiles::own(size_t index) const {
    while (files_[index].same)
        index = *files_[index].same;
    return index;
}

/// The triangles of all files, masks as they are before they are cut.
uint64_t IncludeFiles::triangles() const {
    uint64_t sum = 0;
    for (const IncludeFile& include : files_)
        sum += include.same ? 0 : include.representation->summary.cost.triangles;
    return sum;
}

/// Lets one file stand for all of the same options.
void IncludeFiles::merge() {
    std::unordered_map<Hash, size_t> known;
    for (size_t i = 0; i < files_.size(); ++i) {
        if (files_[i].same)
            continue;
        const auto [at, fresh] =
            known.try_emplace(file_hash(*files_[i].representation, files_[i].options), i);
        if (fresh)
            continue;
        files_[i].same = at->second;
        note_texel(at->second, files_[i].texel);
        files_[at->second].needed.add(files_[i].needed);
    }
}

/// The forecast of how a file is cut, which takes long to find: it is kept, in the scene's folder and
/// with what else is found of masks.
CutForecast IncludeFiles::forecast(Hash name, const IncludeFile& include, const Job& job) {
    const std::filesystem::path path = folder_ / "r" / (hex16(name) + ".cut");
    const Hash key = Hasher().text("forecast").value(name).result();
    CutForecast out;
    std::ifstream written(path);
    if (written >> out.by_outline >> out.triangles)
        return out;
    std::array<uint64_t, 2> numbers{};
    const std::string kept = outlines_.findings().find(key).value_or("");
    if (kept.size() == sizeof numbers) {
        std::memcpy(numbers.data(), kept.data(), sizeof numbers);
        out = {numbers[0] != 0, numbers[1]};
    } else {
        out = cut_forecast(model_, *include.representation, include.options, outlines_, job);
        numbers = {out.by_outline ? 1u : 0u, out.triangles};
        outlines_.findings().add(key,
                                 {reinterpret_cast<const char*>(numbers.data()), sizeof numbers});
    }
    write_file(path, text(out.by_outline ? 1 : 0, ' ', out.triangles, '\n'));
    return out;
}

/// Lets a file whose shadows alone are seen be one that is seen, where the same thing has such a
/// file: another text would save nothing.
void IncludeFiles::join_shadows() {
    std::unordered_map<Hash, size_t> seen;  // the first of those without bands
    const auto key = [&](const IncludeFile& include) {
        RepresentationOptions shape = include.options;
        shape.only_shadows = false;
        shape.outline.reset();
        shape.sky = nullptr;
        return file_hash(*include.representation, shape);
    };
    for (size_t i = 0; i < files_.size(); ++i) {
        if (!files_[i].options.only_shadows && !files_[i].options.bands)
            seen.try_emplace(key(files_[i]), i);
    }
    for (IncludeFile& include : files_) {
        const auto at = include.options.only_shadows ? seen.find(key(include)) : seen.end();
        if (at == seen.end())
            continue;
        include.same = at->second;
        files_[at->second].needed.add(include.needed);
        std::optional<int>& least = files_[at->second].options.outline;
        if (least && include.options.outline)
            least = std::min(*least, *include.options.outline);
    }
}

/// Lets masks of all files together become no more than `most` triangles, or each but one of them.
void IncludeFiles::limit_cut(uint64_t most) {
    // Law: no mask becomes more than 2^18, and a material has one.
    int step = 62;
    const auto sum = [&] {
        uint64_t out = 0;
        for (const IncludeFile& include : files_)
            out += include.same ? 0 : std::min(include.cut_triangles, uint64_t{1} << step);
        return out;
    };
    while (step > 0 && sum() > most)
        --step;
    for (IncludeFile& include : files_) {
        if (include.same || include.cut_triangles <= uint64_t{1} << step)
            continue;
        include.options.most_cut = step;
        include.cut_triangles = uint64_t{1} << step;
    }
}

void IncludeFiles::name(uint64_t budget, uint64_t used, const Job& job) {
    join_shadows();
    parallel_for(files_.size(), [&](size_t i) {
        IncludeFile& include = files_[i];
        if (!include.same && include.options.outline &&
            outlined_by_texel(model_, *include.representation, include.options, outlines_, job))
            include.options.outline = outline_step(0);
    });
    merge();
    for (IncludeFile& include : files_) {
        if (!include.same)
            include.options.shown = include.needed.shown();
    }
    parallel_for(files_.size(), [&](size_t i) {
        IncludeFile& include = files_[i];
        if (include.same || !include.options.outline)
            return;
        include.forecast = file_hash(*include.representation, include.options);
        const CutForecast found = forecast(*include.forecast, include, job);
        include.cut_triangles = found.triangles;
        if (!found.by_outline)
            include.options.outline.reset();
    });
    merge();
    limit_cut(most_cut_triangles(budget, used, triangles()));
    for (IncludeFile& include : files_) {
        if (include.pictured)
            include.options.texel = exponent_of(include.texel);
        include.hash = file_hash(*include.representation, include.options);
        include.identifier = identifier_of(include.hash);
    }
}

bool IncludeFiles::shows(const Representation& representation, const RepresentationOptions& options,
                         bool (*is)(const Material&)) const {
    if (!options.uvs || representation.summary.kind != Kind::Mesh)
        return false;
    for (const uint32_t material : representation.materials) {
        if (material < model_.materials.size() && is(model_.materials[material]))
            return true;
    }
    return false;
}

void IncludeFiles::write(const Job& job) {
    uint64_t triangles = kTrianglesOfFile * files_.size();
    for (const IncludeFile& include : files_)
        triangles += include.representation->summary.cost.triangles;
    std::optional<ThreadLimit> alone;
    if (triangles < kFewTriangles)
        alone.emplace(1);
    std::atomic<size_t> done{0};
    parallel_for(files_.size(), [&](size_t i) {
        job.check();
        IncludeFile& include = files_[i];
        if (include.same)
            return;
        const std::filesystem::path path = folder_ / "r" / (hex16(include.hash) + ".inc");
        std::error_code error;
        const uintmax_t found = std::filesystem::file_size(path, error);
        std::string text = error || found == 0 ? "" : beginning_of(path);
        if (!text.empty() && pictures_.found(pictures_named(text))) {
            include.bytes = found;
            include.drawn = true;
        } else {
            PictureWriter pictures;
            text = representation_text(model_, *include.representation, include.identifier,
                                       include.options, pictures, outlines_, job);
            if (!text.empty()) {
                pictures.write(pictures_);
                write_file(path, text);
                include.bytes = text.size();
                include.written = include.drawn = true;
            }
            text.resize(std::min(text.size(), kBeginning));
        }
        const size_t layers = text.find(kClearLayers);
        if (layers != std::string::npos)
            include.clear_layers =
                std::strtod(text.c_str() + layers + std::strlen(kClearLayers), nullptr);
        include.bumps_left_out = text.find(kBumpsLeftOut) != std::string::npos;
        job.progress(static_cast<double>(++done) / static_cast<double>(files_.size() + 1));
    });
    outlines_.findings().save();
}

std::string IncludeFiles::statements() const {
    std::string out;
    for (const IncludeFile& include : files_) {
        if (include.forecast)
            out.append("// r/").append(hex16(*include.forecast)).append(".cut\n");
        if (include.drawn)
            out.append("#include \"r/").append(hex16(include.hash)).append(".inc\"\n");
    }
    return out;
}

void IncludeFiles::add_to(ExportReport& report) const {
    std::unordered_set<Hash> shown;
    for (const IncludeFile& include : files_) {
        if (include.same)
            continue;
        if (!include.drawn)
            continue;
        report.bytes += include.bytes;
        report.text_bytes += include.bytes;
        ++report.files;
        ++report.representations;
        report.cut_triangles += include.cut_triangles;
        if (include.options.sky && !shown.insert(include.representation->summary.hash).second)
            ++report.sky_copies;
        report.written += include.written ? 1u : 0u;
    }
    const PictureFolder::PictureTotals pictures = pictures_.totals();
    report.bytes += pictures.bytes;
    report.texels += pictures.texels;
    report.files += pictures.files;
    report.written += pictures.written;
}

bool IncludeFiles::bends_light(const Representation& representation) const {
    return std::any_of(representation.materials.begin(), representation.materials.end(),
                       [&](uint32_t material) {
                           return material < model_.materials.size() &&
                                  refraction_of(model_.materials[material]) > 0;
                       });
}

OnwardRays IncludeFiles::onward() const {
    OnwardRays out;
    for (const IncludeFile& include : files_) {
        for (const uint32_t material : include.representation->materials) {
            if (material < model_.materials.size())
                add_onward(model_.materials[material], out);
        }
    }
    return out;
}

}  // namespace lodestone::povray
