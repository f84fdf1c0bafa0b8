// SPDX-License-Identifier: GPL-3.0-or-later
// Mask outlines: the part of a picture where its alpha says that something is, as triangles. A
// picture is outlined once for all its uses in one export, and in later ones if a file keeps it.
#pragma once

#include "base/findings_file.h"
#include "base/job.h"
#include "geometry/ring_triangulation.h"
#include "image/mask_texels.h"

#include <functional>
#include <memory>
#include <mutex>
#include <unordered_map>

namespace lodestone::povray {

using MaskTexelsPtr = std::shared_ptr<const image::MaskTexels>;

/// The inside of a mask over one repetition of its picture: points are picture coordinates.
struct MaskOutline {
    PlaneTriangles inside;
};
using MaskOutlinePtr = std::shared_ptr<const MaskOutline>;

/// A mask as a surface shows it.
struct ShownMask {
    const Texture& texture;
    std::optional<double> cutoff;  // it is where the number is at least that
    const image::SeenTexels& seen;
    double tolerance = 1;              // texels by which an outline may be off; below 1 counts as 1
    size_t most_corners = ~size_t{0};  // of the outline; more are not worth it
};

/// The outlines of one export. May be used from any thread; no answer depends on the order, nor on
/// what was kept.
class MaskOutlines {
public:
    /// `file`: what keeps them from export to export; "": nothing does.
    explicit MaskOutlines(const std::filesystem::path& file = {});

    /// The alpha of a texture. Throws Error(BadFile).
    MaskTexelsPtr texels(const Texture& texture);
    /// Counts the texels of it that are seen. Throws Error(BadFile).
    image::MaskCount count(const Texture& texture, const image::SeenTexels& seen);

    /// The outline of a mask, of whose alpha the area that is seen keeps the mean: the level is
    /// shifted, and corners are left out without a change of area. Null where it has more corners
    /// than asked for or kMostCorners, or no level has about the right area. Throws Error(BadFile),
    /// Error(Cancelled).
    MaskOutlinePtr outline(const ShownMask& mask, const Job& job);

    /// An outline around all of a texture that is not quite clear, coarse but never inside of it.
    /// Null where it would have more corners or leaves out next to nothing. Throws as outline().
    MaskOutlinePtr hull(const Texture& texture, size_t most_corners, const Job& job);

    /// The most corners of an outline.
    /// Taste: a larger value cuts out finer nets, for triangles as many and time that grows with
    /// their square.
    static constexpr size_t kMostCorners = 8192;

    /// The file's other findings about masks, which belong to who asks for them.
    FindingsFile& findings() { return findings_; }

private:
    template <typename Value>
    struct SharedValues {
        struct SharedValue {
            std::mutex making;
            bool made = false;
            Value value{};
        };
        std::mutex mutex;
        std::unordered_map<Hash, std::shared_ptr<SharedValue>> known;

        const Value& of(Hash key, const std::function<Value()>& make);
    };

    /// Rings with few corners, in texels of a picture of `size`, and their area before.
    struct OutlineRings {
        std::vector<Ring> simple;
        size_t corners = 0;
        double area = 0;
        glm::dvec2 size{1.0};
    };
    using OutlineRingsPtr = std::shared_ptr<const OutlineRings>;

    /// The rings of a mask at a level; null where they are too many.
    OutlineRingsPtr rings(const ShownMask& mask, int halvings, double level, double tolerance,
                          Hash key);
    MaskOutlinePtr outline_at(const ShownMask& mask, int halvings, double level, Hash key,
                              const Job& job);
    MaskOutlinePtr hull_at(const Texture& texture, int halvings, const Job& job);

    /// Gives the value kept of a key for one purpose, else the one that is made and kept now.
    template <typename Value>
    Value kept_or(std::string_view purpose, Hash key, const std::function<Value()>& make);

    FindingsFile findings_;
    bool keeps_ = false;
    SharedValues<MaskTexelsPtr> texels_;
    SharedValues<image::MaskCount> counts_;
    SharedValues<double> levels_;
    SharedValues<OutlineRingsPtr> rings_;
    SharedValues<uint64_t> corners_;  // of rings; kTooMany where they are null
    SharedValues<MaskOutlinePtr> outlines_;
    SharedValues<MaskOutlinePtr> hulls_;
};

}  // namespace lodestone::povray
