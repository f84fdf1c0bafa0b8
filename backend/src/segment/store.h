// SPDX-License-Identifier: GPL-3.0-or-later
// Store: a model on disk, a 3D Tiles 1.1 tileset folder (docs/architecture.md, Store).
//   tileset.json      the tiles for strangers, and in asset.extras.lodestone all we know, exactly
//   r/<16 hex>.glb    one representation each, named by content hash
//   r/<16 hex>.chunks the chunks of a level of a large surface, named by their own hash
//   earlier.json      what is known of the levels of what it held before, within a bound
//   i/<16 hex>.png    one picture each (or .jpg, .exr), likewise
//   b/<16 hex>.bound  the levels of something that deforms, by which those of each frame are made
//   lock              held by the one writer
#pragma once

#include "base/job.h"
#include "model/model.h"
#include "segment/bound_level_file.h"

#include <filesystem>
#include <memory>
#include <optional>

namespace lodestone::segment {

/// The change from which on a tileset.json is replaced.
enum class StoreUpdate : uint8_t {
    Anything,  // anything that it says
    Objects,   // anything but cameras, lights and the world, which every frame has of its own
};

class Store {
public:
    /// The folder, or the tileset.json in it. Nothing is touched until a call asks for it.
    explicit Store(const std::filesystem::path& folder);

    const std::filesystem::path& folder() const { return folder_; }
    /// True when a tileset.json is there.
    bool exists() const;

    /// The stored model: summaries, assemblies and primitives resident, meshes not.
    /// Throws Error(Io or BadFile); every index, number and name is checked first.
    Model read() const;

    /// The same, but parsed once for each state of the file by a process: the frames of an
    /// animation share one. Safe from several threads.
    std::shared_ptr<const Model> read_shared() const;

    /// The objects with stand-ins that the store held before, newest first, without what groups
    /// place; empty when there are none, or none that can be read. Parsed as read_shared() does.
    std::shared_ptr<const Model> read_earlier() const;

    /// The mesh of a representation by its summary's hash. Throws Error(Io or BadFile).
    /// Safe from several threads.
    std::shared_ptr<const Mesh> load_mesh(Hash hash) const;

    /// Whether load_mesh() has a file to read.
    bool has_mesh(Hash hash) const;

    /// Whether it has one for every mesh of an object but the finest, which the caller has.
    bool has_stand_ins(const Object& object) const;

    /// Whether load_pictures() has a file of each picture that a material shows.
    bool has_pictures(const Material& material) const;

    /// Makes the mesh of a representation resident.
    void load(Representation& representation) const;

    /// Makes the pictures of all materials and the world resident. Throws Error(Io or BadFile).
    void load_pictures(Model& model) const;

    /// The levels that objects of a bind hash follow with; nothing when there is no file of them
    /// or it cannot be used.
    std::optional<BoundLevels> load_bound(Hash bind_hash) const;

    /// They stay for as long as tileset.json, or the one before it, has an object of that hash.
    /// Returns the bytes written. Throws Error(Io).
    uint64_t save_bound(Hash bind_hash, const BoundLevels& levels) const;

    /// Writes what is missing, then replaces tileset.json if what it says has changed, then removes
    /// files that neither the new nor the previous tileset.json names, nor earlier.json: of the
    /// stand-ins that go, the newest stay. A killed write leaves the old store. Representations and
    /// pictures that are not resident must be in the store already. Returns the bytes written.
    /// Throws Error(Io), also when another writer is at work.
    uint64_t write(const Model& model, const Job& job,
                   StoreUpdate update = StoreUpdate::Anything) const;

private:
    std::filesystem::path tileset() const;
    std::filesystem::path earlier() const;
    /// Keeps what the previous tileset.json has and the model has not.
    uint64_t write_earlier(const Model& model) const;
    uint64_t write_pictures(const Model& model, const Job& job) const;

    std::filesystem::path folder_;
};

}  // namespace lodestone::segment
