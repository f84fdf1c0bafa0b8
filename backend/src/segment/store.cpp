// SPDX-License-Identifier: GPL-3.0-or-later
#include "segment/store.h"

#include "base/files.h"
#include "base/parallel.h"
#include "format/glb.h"
#include "segment/json.h"

#include <atomic>
#include <map>

namespace lodestone::segment {
namespace {

namespace fs = std::filesystem;

constexpr uint64_t kMostTilesetBytes = uint64_t{1} << 30u;

/// What a stranger sees of a representation.
Mesh drawable(const Representation& representation) {
    switch (representation.summary.kind) {
        case Kind::Box:
            return tessellate_box(representation.primitive());
        case Kind::Ellipsoid:
            return tessellate_ellipsoid(representation.primitive());
        default:
            return representation.mesh();
    }
}

void make_folder(const fs::path& folder) {
    std::error_code error;
    fs::create_directories(folder, error);
    if (error)
        fail(Status::Io, "cannot make the folder '", folder.string(), "': ", error.message());
}

void remove_unused(const fs::path& folder, const std::set<Hash>& wanted) {
    std::set<std::string> names;
    for (const Hash hash : wanted)
        names.insert(fs::path(file_of(hash)).filename().string());
    std::error_code error;
    for (const fs::directory_entry& entry : fs::directory_iterator(folder / "r", error)) {
        const std::string name = entry.path().filename().string();
        if ((entry.path().extension() == ".glb" || entry.path().extension() == ".tmp") &&
            names.count(name) == 0)
            fs::remove(entry.path(), error);
    }
}

}  // namespace

Store::Store(const fs::path& folder)
    : folder_(folder.filename() == "tileset.json" ? folder.parent_path() : folder) {}

bool Store::exists() const {
    std::error_code error;
    return fs::is_regular_file(folder_ / "tileset.json", error);
}

Model Store::read() const {
    return model_of_tileset(read_file(folder_ / "tileset.json", kMostTilesetBytes));
}

std::shared_ptr<const Mesh> Store::load_mesh(Hash hash) const {
    const fs::path path = folder_ / file_of(hash);
    auto mesh = std::make_shared<Mesh>(format::read_glb_mesh(read_file(path)));
    return mesh;
}

void Store::load(Representation& representation) const {
    if (!representation.resident())
        representation.payload = load_mesh(representation.summary.hash);
}

uint64_t Store::write(const Model& model, const Job& job) const {
    job.stage(Stage::Store);
    make_folder(folder_ / "r");
    const FileLock lock(folder_ / "lock");

    std::map<Hash, const Representation*> missing;
    std::error_code error;
    for (const ObjectIndex index : bottom_up(model)) {
        for (const Representation& representation : model.objects[index].representations) {
            if (representation.summary.kind != Kind::Assembly &&
                !fs::exists(folder_ / file_of(representation.summary.hash), error))
                missing[representation.summary.hash] = &representation;
        }
    }
    std::vector<const Representation*> jobs;
    jobs.reserve(missing.size());
    for (const auto& [hash, representation] : missing)
        jobs.push_back(representation);
    std::atomic<uint64_t> bytes{0};
    std::atomic<size_t> done{0};
    parallel_for(jobs.size(), [&](size_t i) {
        job.check();
        const Representation& representation = *jobs[i];
        std::vector<Material> materials;
        for (const uint32_t material : representation.materials)
            materials.push_back(model.materials.at(material));
        const std::string glb = format::write_glb_mesh(drawable(representation), materials,
                                                       hex16(representation.summary.hash));
        write_file(folder_ / file_of(representation.summary.hash), glb);
        bytes += glb.size();
        job.progress(0.95 * static_cast<double>(++done) / static_cast<double>(jobs.size()));
    });
    job.check();

    std::set<Hash> wanted;
    const fs::path tileset = folder_ / "tileset.json";
    if (exists())
        wanted = files_of_tileset(read_file(tileset, kMostTilesetBytes));
    const std::string text = tileset_text(model);
    write_file(tileset, text);
    wanted.merge(files_of_tileset(text));
    remove_unused(folder_, wanted);
    job.progress(1);
    return bytes + text.size();
}

}  // namespace lodestone::segment
