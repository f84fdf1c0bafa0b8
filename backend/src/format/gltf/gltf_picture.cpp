// SPDX-License-Identifier: GPL-3.0-or-later
#include "format/gltf/gltf_picture.h"

#include "base/error.h"
#include "base/files.h"
#include "base/text.h"
#include "format/gltf/gltf_accessor.h"
#include "format/gltf/gltf_file.h"
#include "format/sibling_file.h"
#include "image/texture_sampler.h"

#include <tiny_gltf.h>

namespace lodestone::format {

GltfPictureReader::GltfPictureReader(const tinygltf::Model& model,
                                     const std::filesystem::path& folder, const std::string& name,
                                     size_t bytes)
    : model_(model),
      folder_(folder),
      name_(name),
      bytes_left_((uint64_t{1} << 24u) + 4 * uint64_t{bytes}) {}

PicturePtr GltfPictureReader::image(int index, ColorSpace space) {
    if (index < 0 || static_cast<size_t>(index) >= model_.images.size())
        fail(Status::BadFile, "picture ", index, " of ", model_.images.size());
    const Key key{index, space};
    if (const auto found = known_.find(key); found != known_.end())
        return found->second;
    if (const auto found = broken_.find(key); found != broken_.end())
        throw Error(Status::BadFile, found->second);
    try {
        return known_[key] = read(index, space);
    } catch (const Error& e) {
        broken_[key] = e.what();
        throw;
    }
}

PicturePtr GltfPictureReader::read(int index, ColorSpace space) {
    const tinygltf::Image& from = model_.images[static_cast<size_t>(index)];
    std::string label = from.name.empty() ? from.uri : from.name;
    if (label.empty() || label.starts_with("data:"))
        label = text("picture ", index, " of ", name_);
    if (from.bufferView >= 0)
        return view(from.bufferView, space, label);
    if (from.image.empty())
        return file(from.uri, space, label);
    spend(from.image.size(), label);
    return made({from.image.begin(), from.image.end()}, space, label);
}

PicturePtr GltfPictureReader::view(int view, ColorSpace space, const std::string& label) {
    const Key key{-1 - view, space};
    if (const auto found = known_.find(key); found != known_.end())
        return found->second;
    std::string bytes = view_bytes(model_, view);
    spend(bytes.size(), label);
    return known_[key] = made(std::move(bytes), space, label);
}

PicturePtr GltfPictureReader::file(const std::string& uri, ColorSpace space,
                                   const std::string& label) {
    const auto path = folder_.empty() ? std::nullopt : sibling(folder_, percent_decoded(uri));
    if (!path)
        fail(Status::Io, "'", uri.substr(0, 200), "' is not inside the folder of the model");
    PicturePtr& found = files_[{path->string(), space}];
    if (found == nullptr)
        found = made(read_file(*path, image::kMostFileBytes), space, label);
    return found;
}

void GltfPictureReader::spend(size_t bytes, const std::string& label) {
    if (bytes > bytes_left_)
        fail(Status::BadFile, "'", label, "': the file shows the same data too often");
    bytes_left_ -= bytes;
}

PicturePtr GltfPictureReader::made(std::string bytes, ColorSpace space, const std::string& label) {
    PicturePtr picture = image::make_picture(std::move(bytes), space, label);
    return by_hash_.emplace(picture->hash, picture).first->second;
}

void GltfPictureReader::remember_picture(int index, const PicturePtr& picture) {
    known_.insert_or_assign({index, picture->space}, picture);
}

int GltfPictureWriter::image(const Picture& picture) {
    const auto [known, fresh] = images_.try_emplace(picture.hash, 0);
    if (!fresh)
        return known->second;
    tinygltf::Image image;
    image.name = valid_utf8(picture.name);
    const auto next = static_cast<int>(model_.images.size());
    if (embed_) {
        // The same bytes in another color space are the same image.
        image.bufferView = view(picture);
        known->second = image_of_view_.emplace(image.bufferView, next).first->second;
        if (known->second != next)
            return known->second;
        image.mimeType = picture.format == PictureFormat::Jpeg ? "image/jpeg" : "image/png";
    } else {
        known->second = next;
        image.uri = "../i/" + file_name(picture);
    }
    model_.images.push_back(std::move(image));
    return next;
}

int GltfPictureWriter::view(const Picture& picture) {
    const auto [known, fresh] = views_.try_emplace(picture.hash, 0);
    if (fresh) {
        const auto [content, first] =
            view_of_content_.try_emplace(Hasher().text(picture.bytes).result(), 0);
        if (first)
            content->second = add_view(model_, picture.bytes.data(), picture.bytes.size(), 0);
        known->second = content->second;
    }
    return known->second;
}

}  // namespace lodestone::format
