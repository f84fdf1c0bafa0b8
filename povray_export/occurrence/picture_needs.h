// SPDX-License-Identifier: GPL-3.0-or-later
// Picture needs: which choices of a cut a picture shows, or the shadows of which, and which of
// their triangles.
#pragma once

#include "base/job.h"
#include "choose/cut.h"
#include "light/seen/seen_parts.h"

#include <optional>
#include <span>
#include <vector>

namespace lodestone::povray {

/// The needs of one picture. Everything is needed until find() was called, and where it cannot be
/// told or would take longer than it saves: of few triangles lit by few lamps, of very many, with
/// blurred depths, where the view asks for what is off screen in full. Full detail needs everything,
/// too, but only what it shows needs light of its own.
class PictureNeeds {
public:
    /// Finds what is needed; `lights`: all that throw shadows; `still`: of a picture alone. Frames of
    /// full detail share all light. Throws Error(Cancelled).
    void find(const Model& model, const light::RendererSurfaces& renderer, const choose::Cut& cut,
              const View& view, std::span<const Light> lights, bool still, const Job& job);

    /// Whether a choice (its position in cut.chosen) can be left out of the picture.
    bool left_out(size_t position) const {
        return !full_detail_ && known(position) && needs(position) == 0;
    }
    /// Whether it is drawn to be seen, and not only for its shadow.
    bool seen(size_t position) const { return full_detail_ || shown(position); }
    /// Whether the picture shows anything of it.
    bool shown(size_t position) const {
        return !known(position) || (needs(position) & light::kSeen) != 0;
    }
    /// The bytes of POV-Ray's memory that are not taken for what is not needed, about.
    uint64_t bytes_left_out() const { return bytes_left_out_; }
    /// The share of the picture where anything is seen; by what bounds cover where that is not known.
    double covered() const { return parts_ ? parts_->covered() : bounds_cover_; }
    /// The needs for each triangle of its mesh, as bits of light::SeenParts; empty: all are needed.
    std::span<const uint8_t> triangles(size_t position) const {
        return full_detail_ ? std::span<const uint8_t>{} : shown_triangles(position);
    }
    /// The same of what the picture shows, of which full detail has no shadows.
    std::span<const uint8_t> shown_triangles(size_t position) const {
        return known(position) ? parts_->triangles(drawn_[position]) : std::span<const uint8_t>{};
    }

private:
    static constexpr uint32_t kUnknown = ~uint32_t{0};

    void count_bytes(std::span<const light::DrawnThing> drawn);
    bool known(size_t position) const { return parts_ && drawn_[position] != kUnknown; }
    uint8_t needs(size_t position) const { return parts_->needs(drawn_[position]); }

    bool full_detail_ = false;
    std::optional<light::SeenParts> parts_;
    std::vector<uint32_t> drawn_;  // by position
    uint64_t bytes_left_out_ = 0;
    double bounds_cover_ = 1;
};

}  // namespace lodestone::povray
