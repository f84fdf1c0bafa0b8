// SPDX-License-Identifier: GPL-3.0-or-later
#include "segment/store.h"

#include "base/files.h"
#include "base/parallel.h"
#include "format/gltf/glb.h"
#include "segment/earlier_levels.h"
#include "segment/store_json.h"
#include "segment/surface_file.h"

#include <algorithm>
#include <atomic>
#include <map>
#include <mutex>
#include <set>
#include <string>

namespace lodestone::segment {
namespace {

namespace fs = std::filesystem;

// Taste: a larger number reads larger scenes, and lets a hostile file fill more memory.
constexpr uint64_t kMostTilesetBytes = uint64_t{1} << 30u;
// The bytes of the files of earlier levels.
// Taste: two or three states of a large scene; more keep more of them, on the disk.
constexpr uint64_t kMostEarlierBytes = uint64_t{256} << 20u;
// Law: vertices of meshes are counted in 32 bits; the mesh tells how many there are.
constexpr size_t kMostVertices = size_t{1} << 32u;
// The characters of a file's name before its ending.
// Law: a hash of 64 bits in hexadecimal digits.
constexpr size_t kStem = 16;

/// A model and whether all files of its chunks could be used; others may come.
struct ReadModel {
    Model model;
    bool whole = true;
};

/// The model of the file of a kind that this process has read last.
class RecentModel {
public:
    /// The model that the file holds now. Safe from several threads.
    template <typename Read>
    std::shared_ptr<const Model> get(const fs::path& file, const Read& read) {
        const FileState state = file_state(file);  // before it is read: never newer than the model
        const fs::path path = fs::absolute(file);
        {
            const std::lock_guard lock(mutex_);
            if (model_ != nullptr && path_ == path && state_ == state)
                return model_;
        }
        ReadModel found = read(file);
        auto model = std::make_shared<const Model>(std::move(found.model));
        if (!found.whole)
            return model;
        const std::lock_guard lock(mutex_);
        path_ = path;
        state_ = state;
        model_ = model;
        return model;
    }

private:
    std::mutex mutex_;
    fs::path path_;
    FileState state_;
    std::shared_ptr<const Model> model_;
};

/// Reads the chunks of all levels of large surfaces. Without its file a level is drawn whole, and
/// the object's levels are made again by the next build.
ReadModel with_chunks(Model model, const fs::path& folder) {
    bool whole = true;
    std::map<Hash, std::shared_ptr<const SurfaceLevel>> known;
    std::map<Hash, std::shared_ptr<const SurfaceTree>> trees;
    for (Object& object : model.objects) {
        for (Representation& representation : object.representations) {
            if (representation.surface == nullptr)
                continue;
            const auto [at, fresh] = known.try_emplace(representation.surface->hash);
            try {
                if (fresh) {
                    SurfaceLevel level = surface_level_of(
                        read_file(folder / chunk_file_of(*representation.surface)));
                    level.tree = trees.try_emplace(level.tree->hash, level.tree).first->second;
                    if (level.hash == at->first)
                        at->second = std::make_shared<const SurfaceLevel>(std::move(level));
                }
                if (at->second != nullptr)
                    check(*at->second, kMostVertices, representation.summary.cost.triangles);
                representation.surface = at->second;
            } catch (const Error&) {
                representation.surface = nullptr;
            }
            if (representation.surface == nullptr) {
                object.build_hash = 0;
                whole = false;
            }
        }
    }
    return {std::move(model), whole};
}

ReadModel tileset_in(const fs::path& file) {
    return with_chunks(model_of_tileset(read_file(file, kMostTilesetBytes)), file.parent_path());
}

/// The triangles that viewers of tiles draw for a representation.
Mesh drawable(const Representation& representation) {
    return tessellated(representation);
}

/// Whether a file has a name as this store and write_file() give it; other files are the user's.
bool ours(const fs::path& name) {
    static const std::set<std::string> kEndings{".glb", ".chunks", ".bound",
                                                ".png", ".jpg",    ".exr"};
    const std::string stem = name.stem().string();
    const std::string ending = name.extension().string();
    if (ending == ".tmp")
        return stem.starts_with(".lodestone-");
    return kEndings.contains(ending) && stem.size() == kStem &&
           stem.find_first_not_of("0123456789abcdef") == std::string::npos;
}

/// All runs of 16 lower-case hexadecimal digits in a text: the names of its files are among them.
std::set<std::string> stems_in(const std::string& text) {
    std::set<std::string> stems;
    size_t run = 0;
    for (size_t i = 0; i <= text.size(); ++i) {
        const char c = i < text.size() ? text[i] : ' ';
        if ((c >= '0' && c <= '9') || (c >= 'a' && c <= 'f')) {
            ++run;
            continue;
        }
        if (run == kStem)
            stems.insert(text.substr(i - run, run));
        run = 0;
    }
    return stems;
}

/// The files of r/, b/ and i/ that are ours and not wanted; `wanted` are relative names.
std::vector<fs::path> unused_files(const fs::path& folder, const std::set<std::string>& wanted) {
    std::vector<fs::path> out;
    for (const char* part : {"r", "b", "i"}) {
        std::error_code error;
        for (const fs::directory_entry& entry : fs::directory_iterator(folder / part, error)) {
            const std::string name = entry.path().filename().string();
            if (ours(name) && !wanted.contains(std::string(part) + '/' + name))
                out.push_back(entry.path());
        }
    }
    return out;
}

/// A power failure soon after a write leaves a name without content.
bool has_content(const fs::path& path) {
    std::error_code error;
    const uintmax_t size = fs::file_size(path, error);
    return !error && size > 0;
}

/// Each distinct picture of a model's materials and world.
std::map<Hash, PicturePtr> pictures_of(const Model& model) {
    std::map<Hash, PicturePtr> found;
    const auto add = [&](const PicturePtr& picture) {
        PicturePtr& kept = found[picture->hash];
        if (kept == nullptr || kept->bytes.empty())
            kept = picture;
    };
    for (const Material& material : model.materials)
        for_each_texture(material, [&](const Texture& texture) { add(texture.picture); });
    if (model.world.environment)
        add(model.world.environment);
    return found;
}

void use_pictures(Material& material, const std::map<Hash, PicturePtr>& pictures) {
    if (material.other) {
        auto other = std::make_shared<Material>(*material.other);
        use_pictures(*other, pictures);
        material.other = std::move(other);
    }
    for_own_textures(
        material, [&](Texture& texture) { texture.picture = pictures.at(texture.picture->hash); });
}

}  // namespace

Store::Store(const fs::path& folder) : folder_(folder) {
    std::error_code error;  // a folder may be called so too
    if (folder.filename() == "tileset.json" && !fs::is_directory(folder, error))
        folder_ = folder.parent_path();
}

fs::path Store::tileset() const {
    return folder_ / "tileset.json";
}

fs::path Store::earlier() const {
    return folder_ / "earlier.json";
}

bool Store::exists() const {
    std::error_code error;
    return fs::is_regular_file(tileset(), error);
}

Model Store::read() const {
    return tileset_in(tileset()).model;
}

std::shared_ptr<const Model> Store::read_shared() const {
    static RecentModel recent;
    return recent.get(tileset(), tileset_in);
}

std::shared_ptr<const Model> Store::read_earlier() const {
    static RecentModel recent;
    try {
        return recent.get(earlier(), [](const fs::path& file) {
            return with_chunks(model_of_description(read_file(file, kMostTilesetBytes)),
                               file.parent_path());
        });
    } catch (const Error&) {
        return std::make_shared<const Model>();  // there is none, or it is another version's
    }
}

std::shared_ptr<const Mesh> Store::load_mesh(Hash hash) const {
    const fs::path path = folder_ / file_of(hash);
    const std::string bytes = read_file(path);
    try {
        return std::make_shared<Mesh>(format::read_glb_mesh(bytes));
    } catch (const Error& error) {
        fail(error.status, "'", path.string(), "' cannot be used (", error.what(),
             "): delete it and update the levels");
    }
}

bool Store::has_mesh(Hash hash) const {
    return has_content(folder_ / file_of(hash));
}

bool Store::has_stand_ins(const Object& object) const {
    return std::all_of(object.representations.begin(), object.representations.end(),
                       [&](const Representation& one) {
                           return one.summary.kind != Kind::Mesh || one.summary.error == 0 ||
                                  has_mesh(one.summary.hash);
                       });
}

bool Store::has_pictures(const Material& material) const {
    bool out = true;
    for_each_texture(material, [&](const Texture& texture) {
        out = out && has_content(folder_ / file_of(*texture.picture));
    });
    return out;
}

void Store::load(Representation& representation) const {
    if (!representation.resident())
        representation.payload = load_mesh(representation.summary.hash);
}

void Store::load_pictures(Model& model) const {
    std::map<Hash, PicturePtr> resident;
    for (const auto& [hash, picture] : pictures_of(model)) {
        if (!picture->bytes.empty()) {
            resident[hash] = picture;
            continue;
        }
        auto loaded = std::make_shared<Picture>(*picture);
        loaded->bytes = read_file(folder_ / file_of(*picture));
        if (Hasher().text(loaded->bytes).value(loaded->space).result() != hash)
            fail(Status::BadFile, "'", (folder_ / file_of(*picture)).string(),
                 "' is not the picture it was: delete it and update the levels");
        resident[hash] = std::move(loaded);
    }
    for (Material& material : model.materials)
        use_pictures(material, resident);
    if (model.world.environment)
        model.world.environment = resident.at(model.world.environment->hash);
}

std::optional<BoundLevels> Store::load_bound(Hash bind_hash) const {
    const fs::path path = folder_ / bound_file_of(bind_hash);
    std::error_code error;
    if (!fs::is_regular_file(path, error))
        return std::nullopt;
    try {
        return bound_levels_of(read_file(path));
    } catch (const Error&) {
        return std::nullopt;  // torn by another program: it is made again
    }
}

uint64_t Store::save_bound(Hash bind_hash, const BoundLevels& levels) const {
    make_folder(folder_ / "b");
    const std::string bytes = bytes_of(levels);
    write_file(folder_ / bound_file_of(bind_hash), bytes);
    return bytes.size();
}

uint64_t Store::write(const Model& model, const Job& job, StoreUpdate update) const {
    job.stage(JobStage::Store);
    make_folder(folder_ / "r");
    const FileLock lock(folder_ / "lock", job);

    std::map<Hash, const Representation*> missing;
    std::map<Hash, const SurfaceLevel*> parted;
    for (const ObjectIndex index : bottom_up(model)) {
        for (const Representation& representation : model.objects[index].representations) {
            if (representation.summary.kind != Kind::Assembly &&
                !has_content(folder_ / file_of(representation.summary.hash)))
                missing[representation.summary.hash] = &representation;
            const SurfaceLevel* surface = representation.surface.get();
            if (surface != nullptr)
                parted[surface->hash] = surface;
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
    for (const auto& [hash, surface] : parted) {
        const std::string chunks = bytes_of(*surface);
        const fs::path path = folder_ / chunk_file_of(*surface);
        if (file_state(path).bytes == chunks.size() && read_file(path) == chunks)
            continue;  // a damaged one would make all levels anew, each time
        write_file(path, chunks);
        bytes += chunks.size();
    }
    bytes += write_pictures(model, job);
    job.check();

    const std::string previous = exists() ? read_file(tileset(), kMostTilesetBytes) : "";
    const DescriptionText description = description_text(model);
    if (!previous.starts_with(tileset_head(description, update == StoreUpdate::Anything))) {
        const std::string text = tileset_text(model, description);
        if (text.size() > kMostTilesetBytes)
            fail(Status::Io, "'", tileset().string(), "' would have ", text.size(),
                 " bytes; at most ", kMostTilesetBytes, " are read");
        bytes += write_earlier(model);  // first, so that nothing that is there is lost
        write_file(tileset(), text);
        bytes += text.size();
    }
    const std::vector<fs::path> unused = unused_files(folder_, files_of(model));
    std::set<std::string> named;
    if (!unused.empty()) {  // somebody may be reading the previous one
        named = stems_in(previous);
        if (file_state(earlier()).bytes > 0)
            named.merge(stems_in(read_file(earlier(), kMostTilesetBytes)));
    }
    for (const fs::path& path : unused) {
        std::error_code error;
        if (!named.contains(path.stem().string()))
            fs::remove(path, error);
    }
    job.progress(1);
    return bytes;
}

uint64_t Store::write_earlier(const Model& model) const {
    std::shared_ptr<const Model> before = std::make_shared<const Model>();
    if (exists()) {
        try {
            before = read_shared();
        } catch (const Error&) {  // of another version
        }
    }
    const auto bytes_of = [&](const Representation& level) {
        return file_state(folder_ / file_of(level.summary.hash)).bytes;
    };
    const std::string text =
        described(earlier_levels(model, *before, *read_earlier(), kMostEarlierBytes, bytes_of));
    const FileState state = file_state(earlier());
    if (state.bytes == text.size() && read_file(earlier(), kMostTilesetBytes) == text)
        return 0;
    write_file(earlier(), text);
    return text.size();
}

uint64_t Store::write_pictures(const Model& model, const Job& job) const {
    uint64_t bytes = 0;
    for (const auto& [hash, picture] : pictures_of(model)) {
        job.check();
        const fs::path path = folder_ / file_of(*picture);
        // A torn one would stay for ever: its name is that of what it should hold.
        if (picture->bytes.empty() ? has_content(path)
                                   : file_state(path).bytes == picture->bytes.size())
            continue;
        if (picture->bytes.empty())
            fail(Status::Io, "the picture '", picture->name, "' is gone from the store");
        make_folder(folder_ / "i");
        write_file(path, picture->bytes);
        bytes += picture->bytes.size();
    }
    return bytes;
}

}  // namespace lodestone::segment
