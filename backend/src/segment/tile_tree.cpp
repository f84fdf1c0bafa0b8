// SPDX-License-Identifier: GPL-3.0-or-later
#include "segment/tile_tree.h"

#include "segment/store_json.h"

#include <algorithm>
#include <charconv>

namespace lodestone::segment {
namespace {

void put(std::string& text, double value) {
    char buffer[32];
    const auto end = std::to_chars(buffer, buffer + sizeof buffer, value).ptr;
    text.append(buffer, end);
}

void put_box(std::string& text, const Bound& bound) {
    const glm::dvec3 center = bound.box.center();
    const glm::dvec3 half = glm::max(0.5 * bound.box.size(), glm::dvec3(1e-9));
    text += "\"boundingVolume\":{\"box\":[";
    const double numbers[12] = {center.x, center.y, center.z, half.x, 0, 0,
                                0,        half.y,   0,        0,      0, half.z};
    for (int i = 0; i < 12; ++i) {
        if (i > 0)
            text += ',';
        put(text, numbers[i]);
    }
    text += "]}";
}

void put_transform(std::string& text, const Affine& transform) {
    text += "\"transform\":[";
    for (int column = 0; column < 4; ++column) {
        const glm::dvec3& v = column < 3 ? transform.linear[column] : transform.offset;
        for (int row = 0; row < 3; ++row) {
            put(text, v[row]);
            text += ',';
        }
        text += column < 3 ? "0," : "1]";
    }
}

/// The most tiles (some 300 bytes each); of larger models other viewers get the stand-ins of the
/// whole alone.
/// Taste: a larger number writes larger files, which such viewers read as a whole.
constexpr uint64_t kMostTiles = uint64_t{1} << 20u;

/// The chain of tiles of one object, worked out once and shared by all of its placements.
struct TileChain {
    std::vector<double> geometric_errors;  // by LOD number
    Bound bound;                           // of every level and of all below
    uint64_t tiles = 0;  // of every level and of all below, kMostTiles + 1 at most
    // In the text, of one placement, without its transform; none of it: not written yet.
    size_t text_begin = 0;
    size_t text_end = 0;
};

class TileWriter {
public:
    explicit TileWriter(const Model& model) : model_(model), chains_(model.objects.size()) {
        for (const ObjectIndex index : bottom_up(model))
            plan(index);
    }

    std::string write() {
        std::string text = "\"geometricError\":";
        const Bound& bound = chains_[model_.root].bound;
        put(text, std::max(1e-6, 2 * bound.radius + top_error(model_.root)));
        text += ",\"root\":";
        put_object(text, model_.root, nullptr);
        return text;
    }

    bool drawable(ObjectIndex index) const { return !chains_[index].bound.empty(); }

private:
    /// Viewers of tiles have camera rays only.
    bool shown(const Placement& placement) const {
        return drawable(placement.object) && (placement.hidden & kCameraRays) == 0;
    }

    double top_error(ObjectIndex index) const {
        const std::vector<double>& errors = chains_[index].geometric_errors;
        return errors.empty() ? 0 : errors.back();
    }

    void plan(ObjectIndex index) {
        const Object& object = model_.objects[index];
        TileChain& chain = chains_[index];
        double least = 0;
        for (size_t lod = 0; lod < object.representations.size(); ++lod) {
            const Representation& representation = object.representations[lod];
            double error = representation.summary.error;
            if (representation.summary.kind == Kind::Assembly) {
                for (const Placement& placement : representation.assembly().placements) {
                    if (!shown(placement))
                        continue;
                    const double enlarged =
                        top_error(placement.object) * stretch(placement.transform);
                    least = std::max(least, enlarged * (1 + 1e-9));
                    chain.tiles += chains_[placement.object].tiles;
                    chain.tiles = std::min(chain.tiles, kMostTiles + 1);
                    chain.bound = merged(chain.bound, transformed(chains_[placement.object].bound,
                                                                  placement.transform));
                }
                error = 0;
            } else {
                chain.bound = merged(chain.bound, representation.summary.bound);
                chain.tiles = std::min(chain.tiles + 1, kMostTiles + 1);
                if (lod > 0)
                    error = least = std::max(error, least * (1 + 1e-9));
            }
            chain.geometric_errors.push_back(error);
        }
    }

    /// A placed object: its chain is written once and copied from there.
    void put_object(std::string& text, ObjectIndex index, const Placement* placement) {
        text += '{';
        if (placement != nullptr) {
            put_transform(text, placement->transform);
            text += ',';
        }
        TileChain& chain = chains_[index];
        if (chain.text_end > 0) {
            text.append(text, chain.text_begin, chain.text_end - chain.text_begin);
            return;
        }
        chain.text_begin = text.size();
        put_chain(text, index);
        chain.text_end = text.size();
    }

    /// Coarse to fine, behind the first brace, opened once for each level and closed at the end.
    void put_chain(std::string& text, ObjectIndex index) {
        const Object& object = model_.objects[index];
        const TileChain& chain = chains_[index];
        size_t open = 0;
        for (size_t lod = object.representations.size(); lod-- > 0;) {
            const Representation& representation = object.representations[lod];
            if (representation.summary.kind == Kind::Assembly) {
                put_children(text, representation.assembly(), open > 0);
                continue;
            }
            if (open > 0)
                text += ",\"children\":[{";
            put_box(text, chain.bound);
            text += ",\"geometricError\":";
            put(text, chain.geometric_errors[lod]);
            text += ",\"refine\":\"REPLACE\",\"content\":{\"uri\":\"" +
                    file_of(representation.summary.hash) + "\"}";
            ++open;
        }
        if (open == 0) {  // a group that nothing can stand in for: a plain tile around its children
            put_box(text, chain.bound);
            text += ",\"geometricError\":";
            put(text, 2 * chain.bound.radius);
            text += ",\"refine\":\"REPLACE\"";
            if (object.group())
                put_children(text, object.representations[0].assembly(), true);
            text += '}';
            return;
        }
        for (; open > 1; --open)
            text += "}]";
        text += '}';
    }

    void put_children(std::string& text, const Assembly& assembly, bool inside) {
        if (!inside || chains_[model_.root].tiles > kMostTiles)
            return;
        bool first = true;
        for (const Placement& placement : assembly.placements) {
            if (!shown(placement))
                continue;
            text += first ? ",\"children\":[" : ",";
            first = false;
            put_object(text, placement.object, &placement);
        }
        if (!first)
            text += ']';
    }

    const Model& model_;
    std::vector<TileChain> chains_;
};

}  // namespace

std::string tiles_text(const Model& model) {
    if (model.root != kNoObject) {
        TileWriter writer(model);
        if (writer.drawable(model.root))
            return writer.write();
    }
    return "\"geometricError\":0,\"root\":{\"boundingVolume\":{\"sphere\":[0,0,0,1]},"
           "\"geometricError\":0,\"refine\":\"REPLACE\"}";
}

}  // namespace lodestone::segment
