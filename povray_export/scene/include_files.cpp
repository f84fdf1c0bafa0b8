// SPDX-License-Identifier: GPL-3.0-or-later
#include "povray_export/scene/include_files.h"

#include "base/files.h"
#include "base/parallel.h"
#include "povray_export/texture/surface_finish.h"
#include "povray_export/texture/texture_writer.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <ctime>
#include <fstream>
#include <optional>

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

int exponent_of(double texel) {
    // The largest exponent of a texel's size, in both directions.
    // Taste: beyond it nothing can be told apart.
    constexpr int kMost = 60;
    return texel > 0 && std::isfinite(texel) ? std::clamp(std::ilogb(texel), -kMost, kMost)
                                             : -kMost;
}

}  // namespace

double thread_cpu_s() {
    timespec now{};
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
    return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

size_t IncludeFiles::add(const Representation& representation,
                         const RepresentationOptions& options) {
    const auto [at, fresh] = known_.try_emplace(file_hash(representation, options), files_.size());
    if (fresh) {
        files_.emplace_back().representation = &representation;
        files_.back().options = options;
        files_.back().pictured = smaller_ && options.textures && pictured(files_.back());
    }
    return at->second;
}

void IncludeFiles::note_texel(size_t index, double texel) {
    // Copies that are textured share a file for the nearest of them.
    files_[index].texel = std::min(files_[index].texel, texel);
}

void IncludeFiles::name() {
    for (IncludeFile& include : files_) {
        if (include.pictured)
            include.options.texel = exponent_of(include.texel);
        include.hash = file_hash(*include.representation, include.options);
        include.identifier = identifier_of(include.hash);
    }
}

bool IncludeFiles::pictured(const IncludeFile& include) const {
    if (!include.options.uvs || include.representation->summary.kind != Kind::Mesh)
        return false;
    for (const uint32_t material : include.representation->materials) {
        if (material < model_.materials.size() && textured(model_.materials[material]))
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
        const double start = thread_cpu_s();
        IncludeFile& include = files_[i];
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
                                       include.options, pictures, job);
            if (!text.empty()) {
                pictures.write(pictures_);
                write_file(path, text);
                include.bytes = text.size();
                include.written = include.drawn = true;
            }
            text.resize(std::min(text.size(), kBeginning));
        }
        include.bumps_left_out = text.find(kBumpsLeftOut) != std::string::npos;
        include.cpu_s = thread_cpu_s() - start;
        job.progress(static_cast<double>(++done) / static_cast<double>(files_.size() + 1));
    });
}

std::string IncludeFiles::statements() const {
    std::string out;
    for (const IncludeFile& include : files_) {
        if (include.drawn)
            out.append("#include \"r/").append(hex16(include.hash)).append(".inc\"\n");
    }
    return out;
}

bool IncludeFiles::refracts() const {
    for (const IncludeFile& include : files_) {
        for (const uint32_t material : include.representation->materials) {
            if (material < model_.materials.size() && refraction_of(model_.materials[material]) > 0)
                return true;
        }
    }
    return false;
}

}  // namespace lodestone::povray
