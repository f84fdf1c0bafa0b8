// SPDX-License-Identifier: GPL-3.0-or-later
#include "povray_export/mesh/mesh_textures.h"

#include "base/color.h"
#include "base/error.h"
#include "geometry/closest_on_triangle.h"
#include "image/image.h"
#include "light/clear_materials.h"
#include "povray_export/mesh/uv_extent.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <set>
#include <unordered_set>

namespace lodestone::povray {
namespace {

/// The look of a slot that is not found yet.
/// Law: the largest number of 16 bits.
constexpr uint16_t kUnknown = 0xffff;

// Hues of the paint over a picture; a picture is baked for every distinct hue.
// Taste: a larger value shows more hues, for a picture file each.
constexpr size_t kMostHues = 8;

/// A color as RGBA in display encoding, 16 bits each: exact for colors of 8 bits.
using Key = uint64_t;

Key key_of(const glm::vec4& color, bool alpha) {
    Key key = 0;
    for (int i = 0; i < 4; ++i) {
        float value = std::isfinite(color[i]) ? std::clamp(color[i], 0.0f, 1.0f) : 1.0f;
        if (i < 3)
            value = encode_srgb(value);
        else if (!alpha)
            value = 1;
        key = key << 16u | static_cast<Key>(std::lround(value * 65535));
    }
    return key;
}

/// Rounds all channels to multiples of `step` / 65535 (and to white).
Key rounded(Key key, uint64_t step) {
    Key out = 0;
    for (unsigned shift = 0; shift < 64; shift += 16) {
        const uint64_t value = key >> shift & 0xffffu;
        const uint64_t near = (value + step / 2) / step * step;
        out |= std::min<uint64_t>(near + step / 2 > 65535 ? 65535 : near, 65535) << shift;
    }
    return out;
}

/// Another key for each grade of the sky's light, and for each tint. Equal ones of different colors
/// are as likely as a collision of hashes.
Key graded(Key key, uint32_t grade) {
    return key ^ (0x9e3779b97f4a7c15u * (uint64_t{grade} + 1));
}

// The textures of each hue of the sky's light that are left to colors of vertices.
// Taste: a larger value shows more of the colors, and fewer of the hues.
constexpr size_t kFewestColors = 32;
// The largest steps of a tint.
// Law: a signed byte holds them.
constexpr int kMostTint = 127;

/// A number for each tint; 0 for none.
uint32_t number_of_tint(int8_t red, int8_t blue) {
    return static_cast<uint32_t>(static_cast<uint8_t>(red)) << 8u | static_cast<uint8_t>(blue);
}

glm::dvec4 color_of_key(Key key) {
    glm::dvec4 color;
    for (int i = 3; i >= 0; --i, key >>= 16u) {
        const float value = static_cast<float>(key & 0xffffu) / 65535.0f;
        color[i] = i < 3 ? decode_srgb(value) : value;
    }
    return color;
}

/// The color without its brightness.
Key hue_of(Key key) {
    glm::dvec4 color = color_of_key(key);
    const double most = std::max({color.x, color.y, color.z});
    if (most > 0)
        color /= most;
    return rounded(key_of(glm::vec4(color), false), 257);
}

}  // namespace

MeshTextures::MeshTextures(const Model& model, const Representation& representation,
                           const CutMesh& cut, const RepresentationOptions& options,
                           PictureWriter& pictures, const Job& job)
    : mesh_(representation.mesh()),
      cut_(cut),
      shown_(cut.any ? cut.mesh : mesh_),
      job_(job),
      sky_(options.sky),
      around_(options.around),
      uses_normals_(!options.only_shadows) {
    find_slots(model, representation, options);
    if (uses_uvs_)
        find_ranges();
    if (uses_uvs_ && options.texel)
        find_texels(std::ldexp(1.0, *options.texel));
    find_planes();
    bool corners = false;
    for (TexturedSlot& slot : slots_) {
        refraction_ = std::max(refraction_, refraction_of(slot.material));
        slot.surface.light(sky_ ? std::optional(sky_->even_share()) : std::nullopt, around_);
        if (slot.colored || !slot.planes.empty() || (sky_ && sky_->shares))
            corners = true;
        else
            slot.text = add(slot, pictures);
    }
    if (corners) {
        find_tint_step();
        find_corners(pictures);
    }
}

size_t MeshTextures::of(size_t triangle, int corner) const {
    return !corners_.empty() ? corners_[3 * triangle + static_cast<size_t>(corner)]
                             : slots_[slot_at_[shown_.slot(triangle)]].text;
}

bool MeshTextures::bumped() const {
    return std::any_of(slots_.begin(), slots_.end(),
                       [](const TexturedSlot& slot) { return slot.bumped; });
}

bool MeshTextures::is_glass(size_t triangle) const {
    return refraction_of(slots_[slot_at_[shown_.slot(triangle)]].material) > 0;
}

bool MeshTextures::is_clear_beside_glass() const {
    return refraction_ > 0 &&
           std::any_of(slots_.begin(), slots_.end(), [](const TexturedSlot& slot) {
               const Material& material = slot.material;
               return material.alpha_mode == AlphaMode::Blend && !(refraction_of(material) > 0) &&
                      (material.alpha < 1 || material.alpha_texture);
           });
}

void MeshTextures::check_job_sometimes(size_t i) const {
    if ((i & 0xffffu) == 0xffffu)
        job_.check();
}

void MeshTextures::find_slots(const Model& model, const Representation& representation,
                              const RepresentationOptions& options) {
    const bool uvs = options.uvs && !mesh_.uvs.empty();
    for (size_t i = 0; i < mesh_.triangles.size(); ++i) {
        const uint16_t number = mesh_.slot(i);
        if (i > 0 && number == mesh_.slot(i - 1))
            continue;
        if (number >= slot_at_.size())
            slot_at_.resize(size_t{number} + 1, kUnknown);
        if (slot_at_[number] != kUnknown)
            continue;
        slot_at_[number] = static_cast<uint16_t>(slots_.size());
        TexturedSlot slot;  // a slot without a material looks neutral
        if (number < representation.materials.size()) {
            const uint32_t index = representation.materials[number];
            if (index >= model.materials.size())
                fail(Status::InvalidArgument, "a representation uses material ", index, " of ",
                     model.materials.size());
            slot.material = model.materials[index];
        }
        if (slot.material.alpha_mode != AlphaMode::Opaque &&
            slot.material.alpha_texture.channel == TextureChannel::Alpha)
            slot.surface.mask = slot.material.alpha_texture.picture;
        if (number < cut_.opaque.size() && cut_.opaque[number] != 0) {
            slot.material.alpha_mode = AlphaMode::Opaque;
            slot.material.alpha_texture = {};
        }
        if (options.only_shadows && !light::lets_light_through(slot.material))
            slot.material = {};
        for (const Material* m = &slot.material; m != nullptr; m = m->other.get())
            slot.colored = slot.colored || (m->vertex_colors && !mesh_.colors.empty());
        slot.surface.uvs = uvs && textured(slot.material);
        slot.even_sky = options.few_textures || rays_go_on(slot.material, slot.surface.uvs);
        slot.surface.layered = !options.few_textures && !options.only_shadows;
        uses_uvs_ = uses_uvs_ || slot.surface.uvs;
        slot.bumped = slot.surface.uvs && bumpy(slot.material);
        slots_.push_back(std::move(slot));
    }
}

void MeshTextures::find_ranges() {
    for (TexturedSlot& slot : slots_) {
        slot.surface.range.low = glm::dvec2(1e300);
        slot.surface.range.high = glm::dvec2(-1e300);
    }
    for (size_t i = 0; i < mesh_.triangles.size(); ++i) {
        check_job_sometimes(i);
        TexturedSurface& surface = slots_[slot_at_[mesh_.slot(i)]].surface;
        if (!surface.uvs)
            continue;
        for (int corner = 0; corner < 3; ++corner) {
            const glm::dvec2 uv(mesh_.uvs[mesh_.triangles[i][corner]]);
            surface.range.low = glm::min(surface.range.low, uv);
            surface.range.high = glm::max(surface.range.high, uv);
        }
    }
}

void MeshTextures::find_texels(double metres) {
    // The share of a slot's area that must see its texels as finely as asked.
    // Taste: a larger value keeps pictures large for single stretched triangles.
    constexpr double kShown = 0.999;
    // Law: the table of exponents of metres that a texture coordinate covers goes from -64 to 64.
    constexpr int kLeast = -64;
    std::vector<std::array<double, 129>> areas(slots_.size());
    for (size_t i = 0; i < mesh_.triangles.size(); ++i) {
        check_job_sometimes(i);
        const size_t at = slot_at_[mesh_.slot(i)];
        const double covered = metres_of_uv(mesh_, i);
        const double area = glm::length(area_vector(mesh_, i));
        if (!slots_[at].surface.uvs || !(area > 0))
            continue;
        const int exponent = std::isfinite(covered) ? std::ilogb(covered) + 1 : -kLeast;
        areas[at][static_cast<size_t>(std::clamp(exponent, kLeast, -kLeast) - kLeast)] += area;
    }
    for (size_t at = 0; at < slots_.size(); ++at) {
        double sum = 0;
        for (const double area : areas[at])
            sum += area;
        double below = 0;
        int exponent = kLeast - 1;
        for (size_t i = 0; i < areas[at].size() && below < kShown * sum; ++i, ++exponent)
            below += areas[at][i];
        if (sum > 0 && exponent < -kLeast)
            slots_[at].surface.range.texel = std::ldexp(metres, -exponent);
    }
}

size_t MeshTextures::add(const TexturedSlot& slot, PictureWriter& pictures) {
    std::string text = texture_text(slot.material, slot.surface, pictures);
    const auto [at, fresh] = known_.try_emplace(std::move(text), texts_.size());
    if (fresh)
        texts_.push_back(at->first);
    return at->second;
}

void MeshTextures::find_planes() {
    if (!bumped())
        return;
    plane_of_.assign(mesh_.triangles.size(), uint8_t{kMostPlanes});
    for (size_t i = 0; i < mesh_.triangles.size(); ++i) {
        check_job_sometimes(i);
        TexturedSlot& slot = slots_[slot_at_[mesh_.slot(i)]];
        if (!slot.bumped || plane_of(i, slot, plane_of_[i]))
            continue;
        slot.bumped = false;
        slot.planes.clear();
        bumps_left_out_ = true;
    }
    for (size_t i = 0; i < mesh_.triangles.size(); ++i) {
        if (slots_[slot_at_[mesh_.slot(i)]].planes.empty())
            plane_of_[i] = kMostPlanes;
    }
}

/// Finds a triangle's plane; false: a plane too many. Triangles without an area, here or in the
/// picture, have none.
bool MeshTextures::plane_of(size_t triangle, TexturedSlot& slot, uint8_t& plane) const {
    const Triangle& t = mesh_.triangles[triangle];
    const glm::dvec3 at[] = {glm::dvec3(mesh_.positions[t.x]), glm::dvec3(mesh_.positions[t.y]),
                             glm::dvec3(mesh_.positions[t.z])};
    const glm::dvec2 uv[] = {glm::dvec2(mesh_.uvs[t.x]), glm::dvec2(mesh_.uvs[t.y]),
                             glm::dvec2(mesh_.uvs[t.z])};
    const auto fits = [&](const Affine& to_uv) {
        for (int i = 0; i < 3; ++i) {
            const glm::dvec3 there = to_uv(at[i]);
            // The limit is a tenth of the texels of a picture of 1000, and of its plane as wide.
            if (!(std::abs(there.x - uv[i].x) < 1e-4 && std::abs(there.y - uv[i].y) < 1e-4))
                return false;
        }
        const glm::dvec3 normal = glm::cross(at[1] - at[0], at[2] - at[0]);
        const glm::dvec3 up(to_uv.linear[0].z, to_uv.linear[1].z, to_uv.linear[2].z);
        return glm::dot(normal, up) >= 0.9999 * glm::length(normal);
    };
    for (size_t i = slot.planes.size(); i-- > 0;) {  // neighbors tend to share the last one
        if (fits(slot.planes[i])) {
            plane = static_cast<uint8_t>(i);
            return true;
        }
    }
    const glm::dvec3 a = at[1] - at[0];
    const glm::dvec3 b = at[2] - at[0];
    const glm::dvec3 normal = glm::cross(a, b);
    const double square = glm::dot(normal, normal);
    const glm::dvec2 ua = uv[1] - uv[0];
    const glm::dvec2 ub = uv[2] - uv[0];
    // The gradients of u and v in the plane, and the height above it.
    const glm::dvec3 across = glm::cross(b, normal) / square;
    const glm::dvec3 along = glm::cross(normal, a) / square;
    const glm::dvec3 rows[] = {ua.x * across + ub.x * along, ua.y * across + ub.y * along,
                               normal / std::sqrt(square)};
    Affine to_uv;
    to_uv.linear = glm::transpose(glm::dmat3(rows[0], rows[1], rows[2]));
    const double volume = glm::determinant(to_uv.linear);
    if (!to_uv.finite() || !(std::abs(volume) > 1e-9 * glm::length(rows[0]) * glm::length(rows[1])))
        return true;
    const glm::dvec3 origin = to_uv.linear * at[0];
    to_uv.offset = {uv[0].x - origin.x, uv[0].y - origin.y, -origin.z};
    if (slot.planes.size() == kMostPlanes)
        return false;
    plane = static_cast<uint8_t>(slot.planes.size());
    slot.planes.push_back(to_uv);
    return true;
}

MeshTextures::SkyGrade MeshTextures::sky_grade(size_t triangle, int corner) const {
    if (!sky_ || !sky_->shares)
        return {};
    const size_t source = cut_.any ? cut_.sources[triangle] : triangle;
    const Triangle& corners = mesh_.triangles[source];
    std::array<double, 3> shares{};
    std::array<SkyTint, 3> tints{};
    std::array<glm::dvec3, 3> at{};
    for (int i = 0; i < 3; ++i) {
        const glm::vec3& position = mesh_.positions[corners[i]];
        at[static_cast<size_t>(i)] = glm::dvec3(position);
        shares[static_cast<size_t>(i)] = sky_->share(source, i, position);
        tints[static_cast<size_t>(i)] = sky_->tint(source, i);
    }
    const auto grade = [&](const glm::dvec3& weights) {
        SkyGrade out;
        out.share =
            grade_of_share(weights.x * shares[0] + weights.y * shares[1] + weights.z * shares[2]);
        const SkyTint tint = weights.x * tints[0] + weights.y * tints[1] + weights.z * tints[2];
        // Taste: the eye sees fewer hues of what is dark.
        const int dark = out.share < kSkyGrades / 4 ? 4 : out.share < kSkyGrades / 2 ? 2 : 1;
        const int coarser = tint_step_ * dark;
        if (coarser > kMostTint)
            return out;
        const auto step = [coarser](double octaves) {
            const int most = kMostTint / coarser * coarser;
            const auto steps = static_cast<int>(std::lround(light::kTintSteps * octaves / coarser));
            return static_cast<int8_t>(std::clamp(coarser * steps, -most, most));
        };
        out.red = step(tint.x);
        out.blue = step(tint.y);
        return out;
    };
    const bool even = slots_[slot_at_[mesh_.slot(source)]].even_sky;
    const Triangle& shown = shown_.triangles[triangle];
    if (shown == corners) {
        glm::dvec3 one(0.0);
        one[corner] = 1;
        return grade(even ? glm::dvec3(1.0 / 3) : one);
    }
    glm::dvec3 place(shown_.positions[shown[corner]]);
    if (even) {
        const auto position = [&](int i) { return glm::dvec3(shown_.positions[shown[i]]); };
        place = (position(0) + position(1) + position(2)) / 3.0;
    }
    const geometry::OnTriangle on = geometry::closest_on_triangle(place, at[0], at[1], at[2]);
    return grade({1 - on.u - on.v, on.u, on.v});
}

/// Makes tints of the sky's light so coarse that they and its grades are few enough.
void MeshTextures::find_tint_step() {
    if (!sky_ || !sky_->shares || sky_->shares->tints.empty())
        return;
    const bool colored = std::any_of(slots_.begin(), slots_.end(),
                                     [](const TexturedSlot& slot) { return slot.colored; });
    const size_t most = colored ? kMost / kFewestColors : kMost;
    for (std::unordered_set<uint32_t> distinct;; tint_step_ *= 2, distinct.clear()) {
        for (size_t i = 0; i < shown_.triangles.size() && distinct.size() <= most; ++i) {
            check_job_sometimes(i);
            for (int corner = 0; corner < 3; ++corner) {
                const SkyGrade grade = sky_grade(i, corner);
                distinct.insert(number_of_tint(grade.red, grade.blue) << 8u | grade.share);
            }
        }
        if (distinct.size() <= most || tint_step_ > kMostTint)
            return;
        job_.check();
    }
}

/// The number of different colors, with their grades of the sky's light, once colors are rounded;
/// it stops beyond kMost.
size_t MeshTextures::distinct_looks(const std::vector<Key>& keys, uint64_t step) const {
    std::unordered_set<Key> distinct;
    if (!sky_ || !sky_->shares) {
        for (size_t i = 0; i < keys.size() && distinct.size() <= kMost; ++i) {
            check_job_sometimes(i);
            distinct.insert(rounded(keys[i], step));
        }
        return distinct.size();
    }
    for (size_t i = 0; i < shown_.triangles.size() && distinct.size() <= kMost; ++i) {
        check_job_sometimes(i);
        for (int corner = 0; corner < 3; ++corner) {
            const SkyGrade grade = sky_grade(i, corner);
            distinct.insert(graded(rounded(keys[shown_.triangles[i][corner]], step),
                                   number_of_tint(grade.red, grade.blue) << 8u | grade.share));
        }
    }
    return distinct.size();
}

std::vector<Key> MeshTextures::color_keys(glm::dvec3& hue) const {
    std::vector<Key> keys(shown_.colors.size());
    bool alpha = false;
    bool pictured = false;
    for (const TexturedSlot& slot : slots_) {
        for (const Material* m = &slot.material; m != nullptr; m = m->other.get()) {
            alpha = alpha || m->alpha_mode != AlphaMode::Opaque;
            pictured = pictured || (slot.colored && slot.surface.uvs && m->base_color_texture);
        }
    }
    for (size_t i = 0; i < keys.size(); ++i) {
        check_job_sometimes(i);
        keys[i] = key_of(shown_.colors[i], alpha);
    }
    // Colors are first rounded to 8 bits, then coarser until they are few enough.
    for (uint64_t step = 1;; step = step == 1 ? 257 : step + std::max<uint64_t>(257, step / 4)) {
        if (distinct_looks(keys, step) > kMost)
            continue;
        for (Key& key : keys)
            key = rounded(key, step);
        break;
    }
    // Many hues over a picture become their mean: only brightness varies without another picture.
    if (pictured) {
        std::set<Key> hues;
        glm::dvec3 sum(0.0);
        for (const Key key : keys) {
            sum += glm::dvec3(color_of_key(key));
            if (hues.size() <= kMostHues)
                hues.insert(hue_of(key));
        }
        const double most = std::max({sum.x, sum.y, sum.z});
        if (hues.size() > kMostHues && most > 0)
            hue = sum / most;
    }
    return keys;
}

void MeshTextures::find_corners(PictureWriter& pictures) {
    glm::dvec3 hue(-1.0);
    const bool colored = std::any_of(slots_.begin(), slots_.end(),
                                     [](const TexturedSlot& slot) { return slot.colored; });
    const std::vector<Key> keys = colored ? color_keys(hue) : std::vector<Key>();
    const bool lit = sky_ && sky_->shares;
    const size_t planes = kMostPlanes + 1;
    std::vector<std::unordered_map<Key, uint32_t>> texts(slots_.size() * planes *
                                                         (lit ? kSkyGrades : 1));
    const auto text_of = [&](size_t at, size_t plane, Key key, const SkyGrade& grade) {
        const size_t place = (lit ? grade.share * slots_.size() + at : at) * planes + plane;
        const uint32_t tint = number_of_tint(grade.red, grade.blue);
        const auto [found, fresh] = texts[place].try_emplace(tint > 0 ? graded(key, tint) : key, 0);
        if (!fresh)
            return found->second;
        TexturedSlot slot = slots_[at];
        if (lit) {
            slot.surface.light(share_of_grade(grade.share), around_);
            slot.surface.sky_hue =
                factors_of_tint(SkyTint(grade.red, grade.blue) / light::kTintSteps, sky_->color);
        }
        if (plane < slot.planes.size()) {
            slot.surface.flat = true;
            slot.surface.to_uv = slot.planes[plane];
        }
        if (slot.colored) {
            const glm::dvec4 color = color_of_key(key);
            slot.surface.color = color;
            if (hue.x >= 0 && slot.surface.uvs)
                slot.surface.color =
                    glm::dvec4(hue * std::max({color.x, color.y, color.z}), color.w);
        }
        return found->second = static_cast<uint32_t>(add(slot, pictures));
    };
    corners_.resize(3 * shown_.triangles.size());
    for (size_t i = 0; i < shown_.triangles.size(); ++i) {
        check_job_sometimes(i);
        const size_t at = slot_at_[shown_.slot(i)];
        const size_t source = cut_.any ? cut_.sources[i] : i;
        const size_t plane = plane_of_.empty() ? kMostPlanes : plane_of_[source];
        for (int corner = 0; corner < 3; ++corner)
            corners_[3 * i + static_cast<size_t>(corner)] =
                text_of(at, plane, slots_[at].colored ? keys[shown_.triangles[i][corner]] : 0,
                        sky_grade(i, corner));
    }
}

}  // namespace lodestone::povray
