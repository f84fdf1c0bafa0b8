// SPDX-License-Identifier: GPL-3.0-or-later
// Why not tinyobjloader (2.0 rc10, as Debian 12 has it): it refuses a whole file for one broken
// face (39 % of damaged files), takes a broken vertex for 0 0 0 without a word, hands out indices
// of vertices that are not there, knows no continued lines, and takes 1.8 times the CPU time of
// this (docs/EXPERIMENTS.md, "Formats").
#include "format/obj/obj.h"

#include "base/files.h"
#include "format/obj/mtl.h"
#include "format/obj/text_lines.h"
#include "format/sibling_file.h"

#include <algorithm>
#include <array>
#include <limits>
#include <map>
#include <set>

namespace lodestone::format {
namespace {

// Law: indices count from 0 here.
constexpr int32_t kNone = -1;

/// The indices that a corner of a face names, counted from 0; kNone: not given.
struct ObjCorner {
    int32_t position = kNone;
    int32_t uv = kNone;
    int32_t normal = kNone;

    bool operator==(const ObjCorner&) const = default;
};

/// The triangles between two `o` lines.
struct ObjPart {
    std::string name;
    std::vector<ObjCorner> corners;   // three a triangle
    std::vector<uint32_t> materials;  // one a triangle, into the names of usemtl
};

class ObjParser {
public:
    ObjParser(std::string_view bytes, const std::filesystem::path& path, Problems& problems)
        : bytes_(bytes),
          folder_(path.parent_path()),
          name_(path.stem().string()),
          problems_(problems) {
        parts_.push_back({name_, {}, {}});
    }

    Model read() {
        LineReader lines(bytes_);
        std::string_view line;
        while (lines.next(line)) {
            if (!read_line(line)) {
                if (bad_lines_++ == 0)
                    first_bad_line_ = lines.number();
            }
        }
        if (bad_lines_ > 0)
            problems_.push_back({name_, Severity::Warning, "bad_lines",
                                 text(bad_lines_,
                                      " lines make no sense and were skipped; the "
                                      "first is line ",
                                      first_bad_line_)});
        return build();
    }

private:
    bool read_line(std::string_view line) {
        const std::string_view word = next_word(line);
        if (word.empty() || word.front() == '#')
            return true;
        if (word == "v")
            return read_vector(line, positions_, std::numeric_limits<float>::quiet_NaN());
        if (word == "vt")
            return read_vector(line, uvs_, 0.0f);
        if (word == "vn")
            return read_vector(line, normals_, 0.0f);
        if (word == "f")
            return read_face(line);
        if (word == "o") {
            if (!parts_.back().corners.empty())
                parts_.push_back({});
            parts_.back().name = std::string(trimmed(line));
            return true;
        }
        if (word == "usemtl") {
            const std::string name(trimmed(line));
            const auto found = material_of_.emplace(name, material_of_.size()).first;
            material_ = static_cast<uint32_t>(found->second);
            return true;
        }
        if (word == "mtllib") {
            read_library(trimmed(line));
            return true;
        }
        constexpr std::array<std::string_view, 9> kSkipped{"g",  "s",   "vp",     "l",     "p",
                                                           "mg", "lod", "usemap", "maplib"};
        return std::find(kSkipped.begin(), kSkipped.end(), word) != kSkipped.end();
    }

    /// A broken line still counts, or all later indices would be wrong.
    template <typename Vector>
    static bool read_vector(std::string_view line, std::vector<Vector>& out, float instead) {
        Vector value;
        bool good = true;
        for (int i = 0; i < Vector::length(); ++i) {
            // A texture coordinate may have only one number.
            if (good && i == 1 && Vector::length() == 2 && trimmed(line).empty())
                value[i] = 0;
            else
                good = good && next_float(line, value[i]);
        }
        out.push_back(good ? value : Vector(instead));
        return good;
    }

    /// "7" or "-1" -> counted from 0; kNone when it is no index of anything.
    static bool index_of(std::string_view word, size_t count, int32_t& index) {
        int64_t number = 0;
        const char* end = word.data() + word.size();
        const auto parsed = std::from_chars(word.data(), end, number);
        if (parsed.ec != std::errc() || parsed.ptr != end || number == 0)
            return false;
        const int64_t found = number > 0 ? number - 1 : static_cast<int64_t>(count) + number;
        if (found < 0 || found >= std::numeric_limits<int32_t>::max())
            return false;
        index = static_cast<int32_t>(found);
        return true;
    }

    bool read_corner(std::string_view word, ObjCorner& corner) const {
        const size_t first = word.find('/');
        if (!index_of(word.substr(0, first), positions_.size(), corner.position))
            return false;
        if (first == std::string_view::npos)
            return true;
        const std::string_view rest = word.substr(first + 1);
        const size_t second = rest.find('/');
        const std::string_view uv = rest.substr(0, second);
        if (!uv.empty() && !index_of(uv, uvs_.size(), corner.uv))
            return false;
        if (second == std::string_view::npos)
            return true;
        const std::string_view normal = rest.substr(second + 1);
        return normal.empty() || index_of(normal, normals_.size(), corner.normal);
    }

    bool read_face(std::string_view line) {
        face_.clear();
        for (std::string_view word = next_word(line); !word.empty(); word = next_word(line)) {
            ObjCorner corner;
            if (!read_corner(word, corner))
                return false;
            face_.push_back(corner);
        }
        if (face_.size() < 3)
            return false;
        ObjPart& part = parts_.back();
        for (size_t i = 2; i < face_.size(); ++i) {
            part.corners.insert(part.corners.end(), {face_[0], face_[i - 1], face_[i]});
            part.materials.push_back(material_);
        }
        return true;
    }

    void read_library(std::string_view names) {
        // Names with spaces are common, and so are several names in a line.
        std::vector<std::string> files{std::string(names)};
        if (!sibling(folder_, names)) {
            files.clear();
            for (std::string_view word = next_word(names); !word.empty(); word = next_word(names))
                files.emplace_back(word);
        }
        // Taste: a larger number lets a hostile file read more files.
        constexpr size_t kMostLibraries = 256;
        // The most bytes of a library.
        // Taste: a larger number lets a hostile file fill more memory.
        constexpr uint64_t kMostBytes = uint64_t{64} << 20u;
        for (const std::string& file : files) {
            if (libraries_.size() >= kMostLibraries || !libraries_.insert(file).second)
                continue;
            const auto path = sibling(folder_, file);
            try {
                if (!path)
                    fail(Status::Io, "it is not inside the folder of the model");
                for (Material& material :
                     read_mtl(read_file(*path, kMostBytes), folder_, name_, problems_))
                    defined_.emplace(material.name, std::move(material));
            } catch (const Error& e) {
                problems_.push_back(
                    {name_, Severity::Warning, "material_library_missing",
                     text("material library '", file, "' is not used: ", e.what())});
            }
        }
    }

    Model build() {
        Model model;
        std::vector<std::string> names(material_of_.size());
        for (const auto& [name, index] : material_of_)
            names[index] = name;
        for (const std::string& name : names) {
            const auto found = defined_.find(name);
            Material material;
            material.name = name;
            if (found != defined_.end())
                material = found->second;
            else if (!name.empty())
                problems_.push_back({name_, Severity::Warning, "material_missing",
                                     text("material '", name, "' is in no library; it is gray")});
            model.materials.push_back(std::move(material));
        }
        auto assembly = std::make_shared<Assembly>();
        size_t dropped = 0;
        for (ObjPart& part : parts_) {
            Representation finest;
            auto mesh = std::make_shared<Mesh>(mesh_of(part, finest.materials, dropped));
            part = ObjPart{std::move(part.name), {}, {}};
            check(*mesh);
            repair(*mesh, part.name, problems_);
            if (mesh->empty())
                continue;
            finest.payload = std::shared_ptr<const Mesh>(std::move(mesh));
            summarize(finest, model);
            Object object;
            object.uid = text("obj:", model.objects.size());
            object.name = part.name;
            object.representations.push_back(std::move(finest));
            assembly->placements.push_back(
                {static_cast<ObjectIndex>(model.objects.size()), Affine{}, object.name});
            model.objects.push_back(std::move(object));
        }
        if (dropped > 0)
            problems_.push_back({name_, Severity::Error, "bad_faces",
                                 text(dropped,
                                      " triangles with vertices that are not in the file "
                                      "were left out")});
        if (model.objects.empty())
            problems_.push_back(
                {name_, Severity::Warning, "no_faces",
                 text("the file has ", positions_.size(), " vertices and no faces")});
        if (model.objects.size() == 1) {
            model.root = 0;
        } else {
            Object group;
            group.uid = "obj:scene";
            group.name = name_;
            group.representations.emplace_back();
            group.representations[0].summary.kind = Kind::Assembly;
            group.representations[0].payload = std::shared_ptr<const Assembly>(assembly);
            model.root = static_cast<ObjectIndex>(model.objects.size());
            model.objects.push_back(std::move(group));
        }
        summarize_assemblies(model, bottom_up(model));
        return model;
    }

    /// Also gives the slots their materials; counts triangles whose positions are not there.
    Mesh mesh_of(ObjPart& part, std::vector<uint32_t>& materials, size_t& dropped) {
        keep_valid(part, dropped);
        Mesh mesh;
        std::map<uint32_t, uint16_t> slots;
        for (const uint32_t material : part.materials) {
            const auto added = slots.emplace(material, static_cast<uint16_t>(slots.size()));
            if (added.second) {
                if (slots.size() > std::numeric_limits<uint16_t>::max())
                    fail(Status::BadFile, "object '", part.name,
                         "' uses more than 65535 materials");
                materials.push_back(material);
            }
            mesh.slots.push_back(added.first->second);
        }
        if (slots.size() < 2)
            mesh.slots.clear();
        bool uvs = false;
        bool normals = false;
        bool plain = parts_.size() == 1;  // every corner has one index: keep the file's vertices
        for (const ObjCorner& corner : part.corners) {
            uvs = uvs || corner.uv != kNone;
            normals = normals || corner.normal != kNone;
        }
        for (const ObjCorner& corner : part.corners)
            plain = plain && corner.uv == (uvs ? corner.position : kNone) &&
                    corner.normal == (normals ? corner.position : kNone);
        mesh.triangles.resize(part.corners.size() / 3);
        if (plain) {
            mesh.positions = positions_;
            if (uvs)
                mesh.uvs = uvs_;
            if (normals)
                mesh.normals = normals_;
            mesh.uvs.resize(uvs ? positions_.size() : 0, glm::vec2(0));
            mesh.normals.resize(normals ? positions_.size() : 0, glm::vec3(0));
            for (size_t i = 0; i < part.corners.size(); ++i)
                mesh.triangles[i / 3][static_cast<int>(i % 3)] =
                    static_cast<uint32_t>(part.corners[i].position);
            return mesh;
        }
        join(part, uvs, normals, mesh);
        return mesh;
    }

    /// Leaves out triangles without positions and forgets indices of uvs and normals out of range.
    void keep_valid(ObjPart& part, size_t& dropped) const {
        size_t kept = 0;
        for (size_t i = 0; i < part.materials.size(); ++i) {
            bool valid = true;
            for (size_t k = 3 * i; k < 3 * i + 3; ++k) {
                ObjCorner corner = part.corners[k];
                valid = valid && static_cast<size_t>(corner.position) < positions_.size();
                if (corner.uv != kNone && static_cast<size_t>(corner.uv) >= uvs_.size())
                    corner.uv = kNone;
                if (corner.normal != kNone && static_cast<size_t>(corner.normal) >= normals_.size())
                    corner.normal = kNone;
                part.corners[3 * kept + (k - 3 * i)] = corner;
            }
            part.materials[kept] = part.materials[i];
            kept += valid ? 1 : 0;
        }
        dropped += part.materials.size() - kept;
        part.corners.resize(3 * kept);
        part.materials.resize(kept);
    }

    /// One vertex for each different corner, numbered in the order of the faces.
    void join(const ObjPart& part, bool uvs, bool normals, Mesh& mesh) const {
        size_t size = 16;
        while (size < part.corners.size() * 2)
            size *= 2;
        constexpr uint32_t kFree = ~uint32_t{0};
        std::vector<uint32_t> table(size, kFree);
        std::vector<ObjCorner> corners;
        for (size_t i = 0; i < part.corners.size(); ++i) {
            const ObjCorner& corner = part.corners[i];
            uint64_t key = static_cast<uint32_t>(corner.position) * 0x9e3779b97f4a7c15u;
            key = (key ^ (key >> 29u) ^ static_cast<uint32_t>(corner.uv)) * 0xbf58476d1ce4e5b9u;
            key = (key ^ (key >> 32u) ^ static_cast<uint32_t>(corner.normal)) * 0x94d049bb133111ebu;
            key ^= key >> 31u;
            size_t slot = key & (size - 1);
            while (table[slot] != kFree && !(corners[table[slot]] == corner))
                slot = (slot + 1) & (size - 1);
            if (table[slot] == kFree) {
                table[slot] = static_cast<uint32_t>(corners.size());
                corners.push_back(corner);
            }
            mesh.triangles[i / 3][static_cast<int>(i % 3)] = table[slot];
        }
        for (const ObjCorner& corner : corners) {
            mesh.positions.push_back(positions_[static_cast<size_t>(corner.position)]);
            if (uvs)
                mesh.uvs.push_back(corner.uv == kNone ? glm::vec2(0)
                                                      : uvs_[static_cast<size_t>(corner.uv)]);
            if (normals)  // repair() gives the face's to a vertex without one
                mesh.normals.push_back(corner.normal == kNone
                                           ? glm::vec3(0)
                                           : normals_[static_cast<size_t>(corner.normal)]);
        }
    }

    std::string_view bytes_;
    std::filesystem::path folder_;
    std::string name_;
    Problems& problems_;
    std::vector<glm::vec3> positions_;
    std::vector<glm::vec2> uvs_;
    std::vector<glm::vec3> normals_;
    std::vector<ObjPart> parts_;
    std::vector<ObjCorner> face_;
    std::map<std::string, size_t> material_of_{{"", 0}};  // before the first usemtl
    uint32_t material_ = 0;
    std::map<std::string, Material> defined_;
    std::set<std::string> libraries_;
    size_t bad_lines_ = 0;
    size_t first_bad_line_ = 0;
};

}  // namespace

Model read_obj(std::string_view bytes, const std::filesystem::path& path, Problems& problems) {
    return ObjParser(bytes, path, problems).read();
}

}  // namespace lodestone::format
