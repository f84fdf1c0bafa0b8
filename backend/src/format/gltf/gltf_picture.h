// SPDX-License-Identifier: GPL-3.0-or-later
// Pictures of glTF files: in buffer views, in data: URIs, in files beside the model.
#pragma once

#include "base/hash.h"
#include "model/picture.h"

#include <filesystem>
#include <map>
#include <string>
#include <utility>

namespace tinygltf {
class Model;
}

namespace lodestone::format {

/// Reads each picture once for each color space, and only those asked for.
class GltfPictureReader {
public:
    /// Files are read from below `folder` only (empty: none). `name` and `bytes` are the model
    /// file's; pictures in it may have 4 times that and 16 MiB in all. All arguments must outlive
    /// this.
    GltfPictureReader(const tinygltf::Model& model, const std::filesystem::path& folder,
                      const std::string& name, size_t bytes);

    /// The picture of an image of the file. Throws Error(BadFile or Io) with a sentence that names
    /// the picture; a broken one is read only once.
    PicturePtr image(int index, ColorSpace space);
    /// The picture in a buffer view that no image of the file names.
    PicturePtr view(int view, ColorSpace space, const std::string& label);
    /// Remembers that image `index` is this picture.
    void remember_picture(int index, const PicturePtr& picture);

private:
    using Key = std::pair<int, ColorSpace>;  // views count down from -1

    PicturePtr read(int index, ColorSpace space);
    PicturePtr made(std::string bytes, ColorSpace space, const std::string& label);
    PicturePtr file(const std::string& uri, ColorSpace space, const std::string& label);
    void spend(size_t bytes, const std::string& label);

    const tinygltf::Model& model_;
    const std::filesystem::path& folder_;
    const std::string& name_;
    uint64_t bytes_left_;
    std::map<Key, PicturePtr> known_;
    std::map<Key, std::string> broken_;
    std::map<std::pair<std::string, ColorSpace>, PicturePtr> files_;  // by path
    std::map<Hash, PicturePtr> by_hash_;
};

/// Adds each picture once.
class GltfPictureWriter {
public:
    /// `embed`: pictures go into buffer views; else images name the store's files
    /// ("../i/<16 hex>.png").
    GltfPictureWriter(tinygltf::Model& model, bool embed) : model_(model), embed_(embed) {}

    /// The index of the image. The picture must be resident when it is embedded.
    int image(const Picture& picture);
    /// The buffer view of a picture that glTF has no word for.
    int view(const Picture& picture);

private:
    tinygltf::Model& model_;
    bool embed_;
    std::map<Hash, int> images_;  // by the hash of the picture
    std::map<Hash, int> views_;   // by the hash of the picture
    std::map<Hash, int> view_of_content_;
    std::map<int, int> image_of_view_;
};

}  // namespace lodestone::format
