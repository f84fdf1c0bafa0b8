// SPDX-License-Identifier: GPL-3.0-or-later
// Guards packed glTF: what EXT_meshopt_compression packs comes back, with fallback buffers or
// without, and no packed file can crash us or take more memory than it may.
#include "base/error.h"
#include "base/files.h"
#include "format/gltf/gltf_meshopt.h"
#include "format/model_file.h"
#include "scenes/damaged_files.h"
#include "scenes/gltf_text.h"
#include "scenes/small_meshes.h"
#include "scratch.h"

#include <tiny_gltf.h>

#include <cstring>
#include <gtest/gtest.h>
#include <meshoptimizer.h>

namespace lodestone::format {
namespace {

using namespace gltf_text;

constexpr const char* kFallback =
    R"({"byteLength":99,"extensions":{"EXT_meshopt_compression":{"fallback":true}}})";

/// A glTF file whose buffer 0 holds packed bytes and whose views claim buffer 1.
class PackedFile {
public:
    std::string fallback = kFallback;  // buffer 1
    std::string required = R"("extensionsRequired":["EXT_meshopt_compression"],)";

    void attributes(const void* data, size_t count, size_t stride, const char* filter = "NONE") {
        std::string packed(meshopt_encodeVertexBufferBound(count, stride), '\0');
        packed.resize(
            meshopt_encodeVertexBuffer(bytes_of(packed), packed.size(), data, count, stride));
        view(packed, count, stride, "ATTRIBUTES", filter, text(R"("byteStride":)", stride, ","));
    }
    void triangles(const std::vector<uint32_t>& indices, size_t stride, size_t vertices) {
        std::string packed(meshopt_encodeIndexBufferBound(indices.size(), vertices), '\0');
        packed.resize(meshopt_encodeIndexBuffer(bytes_of(packed), packed.size(), indices.data(),
                                                indices.size()));
        view(packed, indices.size(), stride, "TRIANGLES", "NONE", "");
    }
    void sequence(const std::vector<uint32_t>& indices, size_t stride, size_t vertices) {
        std::string packed(meshopt_encodeIndexSequenceBound(indices.size(), vertices), '\0');
        packed.resize(meshopt_encodeIndexSequence(bytes_of(packed), packed.size(), indices.data(),
                                                  indices.size()));
        view(packed, indices.size(), stride, "INDICES", "NONE", "");
    }
    void view(const std::string& packed, size_t count, size_t stride, const char* mode,
              const char* filter, const std::string& own) {
        views_ += text(views_.empty() ? "" : ",", R"({"buffer":1,)", own, R"("byteLength":)",
                       count * stride, R"(,"extensions":{"EXT_meshopt_compression":{"buffer":0,)",
                       R"("byteOffset":)", bytes_.size(), R"(,"byteLength":)", packed.size(),
                       R"(,"byteStride":)", stride, R"(,"mode":")", mode, R"(","filter":")", filter,
                       R"(","count":)", count, "}}}");
        bytes_ += packed;
        bytes_.resize((bytes_.size() + 3) / 4 * 4);
    }
    void accessor(int view, int type, size_t count, const char* shape, bool normalized = false) {
        accessors_ += text(accessors_.empty() ? "" : ",", R"({"bufferView":)", view,
                           R"(,"componentType":)", type, R"(,"count":)", count, R"(,"type":")",
                           shape, "\"", normalized ? R"(,"normalized":true)" : "", "}");
    }
    /// As text; `uri` names a file with packed(), or is empty: they are in the text.
    std::string gltf(const std::string& rest, const std::string& uri = "") const {
        const std::string place =
            uri.empty() ? "data:application/octet-stream;base64," + base64(bytes_) : uri;
        return json(text(R"("uri":")", place, "\","), rest);
    }
    std::string glb(const std::string& rest) const {
        std::string words = json("", rest);
        words.resize((words.size() + 3) / 4 * 4, ' ');
        const auto word = [](size_t value) {
            return raw<uint32_t>({static_cast<uint32_t>(value)});
        };
        return "glTF" + word(2) + word(28 + words.size() + bytes_.size()) + word(words.size()) +
               "JSON" + words + word(bytes_.size()) + std::string("BIN\0", 4) + bytes_;
    }
    const std::string& packed() const { return bytes_; }

private:
    static unsigned char* bytes_of(std::string& packed) {
        return reinterpret_cast<unsigned char*>(packed.data());
    }
    std::string json(const std::string& place, const std::string& rest) const {
        return text(R"({"asset":{"version":"2.0"},)", required, R"("buffers":[{)", place,
                    R"("byteLength":)", bytes_.size(), "},", fallback, R"(],"bufferViews":[)",
                    views_, R"(],"accessors":[)", accessors_, "],", rest, "}");
    }

    std::string bytes_;
    std::string views_;
    std::string accessors_;
};

/// A height field of `side` x `side` cells: positions of 12 bytes, and triangles.
struct Field {
    explicit Field(int side) : mesh(shapes::terrain(side)) {
        for (const Triangle& triangle : mesh.triangles)
            indices.insert(indices.end(), {triangle.x, triangle.y, triangle.z});
    }
    Mesh mesh;
    std::vector<uint32_t> indices;
};

/// The field with floats and a list of triangles, indices of `stride` bytes.
PackedFile packed_field(const Field& field, size_t stride) {
    PackedFile file;
    const size_t count = field.mesh.positions.size();
    file.attributes(field.mesh.positions.data(), count, 12);
    file.triangles(field.indices, stride, count);
    file.accessor(0, 5126, count, "VEC3");
    file.accessor(1, stride == 2 ? 5123 : 5125, field.indices.size(), "SCALAR");
    return file;
}

Mesh only_mesh(const Model& model) {
    for (const Object& object : model.objects) {
        if (const auto* mesh =
                std::get_if<std::shared_ptr<const Mesh>>(&object.representations[0].payload))
            return **mesh;
    }
    return {};
}

Mesh read_one(const std::string& bytes) {
    Problems problems;
    const Model model = read(bytes, problems);
    for (const Problem& problem : problems)
        ADD_FAILURE() << problem.message;
    return only_mesh(model);
}

/// The codec turns triangles: each begins with its lowest corner.
std::vector<std::array<uint32_t, 3>> turned(const Mesh& mesh) {
    std::vector<std::array<uint32_t, 3>> out;
    for (const Triangle& triangle : mesh.triangles) {
        std::array<uint32_t, 3> corners{triangle.x, triangle.y, triangle.z};
        std::rotate(corners.begin(), std::min_element(corners.begin(), corners.end()),
                    corners.end());
        out.push_back(corners);
    }
    return out;
}

void expect_field(const Mesh& mesh, const Field& field) {
    ASSERT_EQ(mesh.positions.size(), field.mesh.positions.size());
    for (size_t i = 0; i < mesh.positions.size(); ++i) {  // Y up in the file
        const glm::vec3& from = field.mesh.positions[i];
        EXPECT_EQ(mesh.positions[i], glm::vec3(from.x, -from.z, from.y)) << i;
    }
    EXPECT_EQ(turned(mesh), turned(field.mesh));
}

TEST(GltfMeshopt, ModelsWithoutPackedViewsStay) {
    tinygltf::Model model;
    unpack_views(model, "thing");
    model.buffers.resize(1);
    model.bufferViews.resize(1);
    unpack_views(model, "thing");
    EXPECT_EQ(model.buffers.size(), 1u);
}

TEST(GltfMeshopt, OneTriangleComesBackFromEachMode) {
    const std::vector<float> corners{0, 0, 0, 1, 0, 0, 0, 1, 0};
    for (const bool list : {true, false}) {
        for (const size_t stride : {size_t{2}, size_t{4}}) {
            PackedFile file;
            file.attributes(corners.data(), 3, 12);
            if (list)
                file.triangles({0, 1, 2}, stride, 3);
            else
                file.sequence({0, 1, 2}, stride, 3);
            file.accessor(0, 5126, 3, "VEC3");
            file.accessor(1, stride == 2 ? 5123 : 5125, 3, "SCALAR");
            const Mesh mesh = read_one(file.gltf(kOneMesh + kOneNode));
            ASSERT_EQ(mesh.triangles.size(), 1u) << list << stride;
            EXPECT_EQ(mesh.positions[2], glm::vec3(0, 0, 1));
        }
    }
}

TEST(GltfMeshopt, FieldsComeBackFromTextAndFromGlb) {
    const Field field(30);
    for (const size_t stride : {size_t{2}, size_t{4}}) {
        const PackedFile file = packed_field(field, stride);
        expect_field(read_one(file.gltf(kOneMesh + kOneNode)), field);
        expect_field(read_one(file.glb(kOneMesh + kOneNode)), field);
    }
}

TEST(GltfMeshopt, SeveralBuffersClaimedTheBinaryChunkOfWebFiles) {
    const Field field(8);
    PackedFile file = packed_field(field, 2);
    // A fallback that is there, that is missing, and whose mark comes before its length.
    const std::string mark = R"("extensions":{"EXT_meshopt_compression":{"fallback":true}})";
    for (const std::string& buffer :
         {R"({"byteLength":99,)" + mark + "}", "{" + mark + R"(,"byteLength":99})",
          R"({"byteLength":99,"uri":"missing.bin",)" + mark + "}",
          R"({"byteLength":3,"uri":"data:application/octet-stream;base64,AAAA",)" + mark + "}"}) {
        file.fallback = buffer;
        expect_field(read_one(file.glb(kOneMesh + kOneNode)), field);
        expect_field(read_one(file.gltf(kOneMesh + kOneNode)), field);
    }
    // The packed bytes in a file beside the text.
    file.fallback = kFallback;
    const std::filesystem::path folder = own_scratch();
    std::filesystem::create_directories(folder);
    write_file(folder / "a.bin", file.packed());
    write_file(folder / "a.gltf", file.gltf(kOneMesh + kOneNode, "a.bin"));
    Problems problems;
    expect_field(only_mesh(read_model(folder / "a.gltf", problems)), field);
    // Those that nothing marks still claim one chunk.
    for (const char* buffer :
         {R"({"byteLength":1})",
          R"({"byteLength":1,"extensions":{"EXT_meshopt_compression":{"fallback":false}}})",
          R"({"byteLength":1,"extras":{"EXT_meshopt_compression":{"fallback":true}}})"}) {
        file.fallback = buffer;
        EXPECT_NE(complaint(file.glb(kOneMesh + kOneNode)).find("several buffers"),
                  std::string::npos)
            << buffer;
    }
}

TEST(GltfMeshopt, FiltersComeBackWithinTheirBits) {
    const Field field(12);
    const size_t count = field.mesh.positions.size();
    std::vector<float> normals;
    PcgRandom random(3);
    for (size_t i = 0; i < count; ++i) {
        const auto number = [&] { return static_cast<float>(random.uniform() * 2 - 1); };
        const glm::vec3 normal = glm::normalize(glm::vec3(number(), number(), number()));
        normals.insert(normals.end(), {normal.x, normal.y, normal.z, 0});
    }
    for (const size_t stride : {size_t{4}, size_t{8}}) {
        PackedFile file;
        std::vector<float> wide(count * 3);
        meshopt_encodeFilterExp(wide.data(), count, 12, 20, &field.mesh.positions[0].x);
        file.attributes(wide.data(), count, 12, "EXPONENTIAL");
        std::string octahedral(count * stride, '\0');
        meshopt_encodeFilterOct(octahedral.data(), count, stride, stride == 4 ? 8 : 14,
                                normals.data());
        file.attributes(octahedral.data(), count, stride, "OCTAHEDRAL");
        file.triangles(field.indices, 2, count);
        file.accessor(0, 5126, count, "VEC3");
        file.accessor(1, stride == 4 ? 5120 : 5122, count, "VEC3", true);
        file.accessor(2, 5123, field.indices.size(), "SCALAR");
        const Mesh mesh = read_one(file.glb(
            R"("meshes":[{"primitives":[{"attributes":{"POSITION":0,"NORMAL":1},"indices":2}]}],)" +
            kOneNode));
        ASSERT_EQ(mesh.positions.size(), count);
        ASSERT_EQ(mesh.normals.size(), count);
        for (size_t i = 0; i < count; ++i) {
            const glm::vec3& from = field.mesh.positions[i];
            const float* const to = &normals[4 * i];
            EXPECT_LT(glm::distance(mesh.positions[i], glm::vec3(from.x, -from.z, from.y)),
                      1e-5f * (1 + glm::length(from)));
            EXPECT_LT(glm::distance(mesh.normals[i], glm::vec3(to[0], -to[2], to[1])),
                      stride == 4 ? 0.02f : 0.0005f);
        }
    }
}

TEST(GltfMeshopt, QuaternionsComeBackWithinTheirBits) {
    const std::vector<float> turns{0,     0, 0, 1, 0.5f, -0.5f, 0.5f, 0.5f, 0.6f, 0,
                                   -0.8f, 0, 0, 1, 0,    0,     0.1f, 0.1f, 0.7f, 0.7f};
    const size_t count = turns.size() / 4;
    std::vector<int16_t> filtered(count * 4);
    meshopt_encodeFilterQuat(filtered.data(), count, 8, 12, turns.data());
    tinygltf::Model model;
    model.buffers.resize(2);
    auto& packed = model.buffers[0].data;
    packed.resize(meshopt_encodeVertexBufferBound(count, 8));
    packed.resize(
        meshopt_encodeVertexBuffer(packed.data(), packed.size(), filtered.data(), count, 8));
    using tinygltf::Value;
    tinygltf::BufferView view;
    view.buffer = 1;
    view.byteOffset = 77;
    view.extensions["EXT_meshopt_compression"] =
        Value(Value::Object{{"buffer", Value(0)},
                            {"byteLength", Value(static_cast<int>(packed.size()))},
                            {"byteStride", Value(8)},
                            {"count", Value(static_cast<int>(count))},
                            {"mode", Value(std::string("ATTRIBUTES"))},
                            {"filter", Value(std::string("QUATERNION"))}});
    model.bufferViews.push_back(view);
    unpack_views(model, "thing");
    const tinygltf::BufferView& out = model.bufferViews[0];
    ASSERT_EQ(out.buffer, 2);
    EXPECT_EQ(out.byteOffset, 0u);
    EXPECT_EQ(out.byteStride, 8u);
    ASSERT_EQ(model.buffers[2].data.size(), count * 8);
    for (size_t i = 0; i < count; ++i) {
        double along = 0;  // q and -q are one turn
        for (size_t k = 0; k < 4; ++k) {
            int16_t number = 0;
            std::memcpy(&number, &model.buffers[2].data[8 * i + 2 * k], 2);
            along += double{turns[4 * i + k]} * number / 32767;
        }
        EXPECT_NEAR(std::abs(along), 1, 0.01) << i;
    }
}

TEST(GltfMeshopt, QuantizedPositionsAndTextureTransformsAreRead) {
    const std::vector<uint16_t> corners{0,     0,    0, 0, 16383, 0,    0, 0,
                                        16383, 8191, 0, 0, 0,     8191, 0, 0};
    const std::vector<uint16_t> places{0, 0, 4095, 0, 4095, 4095, 0, 4095};
    PackedFile file;
    file.required = R"("extensionsRequired":["EXT_meshopt_compression","KHR_mesh_quantization",
        "KHR_texture_transform"],)";
    file.attributes(corners.data(), 4, 8);
    file.attributes(places.data(), 4, 4);
    file.triangles({0, 1, 2, 0, 2, 3}, 2, 4);
    file.accessor(0, 5123, 4, "VEC3");
    file.accessor(1, 5123, 4, "VEC2", true);
    file.accessor(2, 5123, 6, "SCALAR");
    const std::string rest =
        R"("meshes":[{"primitives":[{"attributes":{"POSITION":0,"TEXCOORD_0":1},"indices":2,
        "material":0}]}],"materials":[{"pbrMetallicRoughness":{"baseColorTexture":{"index":0,
        "extensions":{"KHR_texture_transform":{"scale":[16.0,16.0]}}}}}],
        "textures":[{"source":0}],"images":[{"uri":"data:image/png;base64,)" +
        base64("no picture") + R"("}],"nodes":[{"mesh":0,"scale":[0.5,0.5,0.5]}],
        "scenes":[{"nodes":[0]}])";
    Problems problems;
    const Model model = read(file.glb(rest), problems);
    const Mesh mesh = only_mesh(model);
    ASSERT_EQ(mesh.positions.size(), 4u);
    EXPECT_EQ(mesh.positions[2], glm::vec3(16383, 0, 8191));
    EXPECT_NEAR(double{mesh.uvs[2].x}, 4095.0 / 65535, 1e-6);
    for (const Problem& problem : problems)  // the picture is none
        EXPECT_EQ(problem.code.find("texture"), 0u) << problem.message;
}

TEST(GltfMeshopt, BrokenPackedViewsAreNamed) {
    const Field field(9);
    const std::string whole = packed_field(field, 2).gltf(kOneMesh + kOneNode);
    const std::vector<std::pair<std::string, std::string>> changes{
        {R"("mode":"ATTRIBUTES")", R"("mode":"POINTS")"},
        {R"("mode":"ATTRIBUTES")", R"("mode":7)"},
        {R"("mode":"ATTRIBUTES")", R"("mode":"TRIANGLES")"},
        {R"("mode":"TRIANGLES")", R"("mode":"ATTRIBUTES")"},
        {R"("mode":"TRIANGLES")", R"("mode":"INDICES")"},
        {R"("filter":"NONE")", R"("filter":"COLOR")"},
        {R"("filter":"NONE")", R"("filter":"OCTAHEDRAL")"},
        {R"("filter":"NONE")", R"("filter":"QUATERNION")"},
        {R"("count":100)", R"("count":0)"},
        {R"("count":100)", R"("count":-1)"},
        {R"("count":100)", R"("count":1.5)"},
        {R"("count":100)", R"("count":"many")"},
        {R"("count":100)", R"("count":2000000000)"},
        {R"("count":100)", R"("count":4611686018427387904)"},
        {R"("count":486)", R"("count":485)"},
        {R"("count":486)", R"("count":489)"},
        {R"("byteStride":12,"mode")", R"("byteStride":0,"mode")"},
        {R"("byteStride":12,"mode")", R"("byteStride":16,"mode")"},
        {R"("byteStride":12,"mode")", R"("byteStride":13,"mode")"},
        {R"("byteStride":12,"mode")", R"("byteStride":260,"mode")"},
        {R"("byteStride":2,"mode")", R"("byteStride":3,"mode")"},
        {R"({"buffer":0,"byteOffset":0)", R"({"buffer":1,"byteOffset":0)"},
        {R"({"buffer":0,"byteOffset":0)", R"({"buffer":9,"byteOffset":0)"},
        {R"({"buffer":0,"byteOffset":0)", R"({"buffer":-1,"byteOffset":0)"},
        {R"({"buffer":0,"byteOffset":0)", R"({"byteOffset":0)"},
        {R"({"buffer":0,"byteOffset":0)", R"({"buffer":0,"byteOffset":4)"},
        {R"({"buffer":0,"byteOffset":0)", R"({"buffer":0,"byteOffset":99999)"},
        {R"({"buffer":0,"byteOffset":0)", R"({"buffer":0,"byteOffset":-4)"},
    };
    for (const auto& [from, to] : changes) {
        std::string changed = whole;
        const size_t at = changed.find(from);
        ASSERT_NE(at, std::string::npos) << from;
        changed.replace(at, from.size(), to);
        const std::string said = complaint(changed);
        EXPECT_NE(said.find("'thing'"), std::string::npos) << to << ": " << said;
        EXPECT_NE(said.find("buffer view "), std::string::npos) << to << ": " << said;
    }
}

TEST(GltfMeshopt, IndicesBeyondTheVerticesAreLeftOutWithAProblem) {
    const std::vector<float> corners{0, 0, 0, 1, 0, 0, 0, 1, 0};
    PackedFile file;
    file.attributes(corners.data(), 3, 12);
    file.triangles({0, 1, 70000}, 4, 70001);
    file.accessor(0, 5126, 3, "VEC3");
    file.accessor(1, 5125, 3, "SCALAR");
    Problems problems;
    EXPECT_EQ(totals(read(file.gltf(kOneMesh + kOneNode), problems)).triangles_placed, 0u);
}

TEST(GltfMeshopt, PackedBytesShownTooOftenAreRefused) {
    // A million equal vertices are 64 times smaller: 200 views of them would be 2.4 GB.
    const std::vector<float> equal(size_t{3} * 1000000, 1);
    PackedFile file;
    file.attributes(equal.data(), equal.size() / 3, 12);
    file.accessor(0, 5126, 3, "VEC3");
    std::string text =
        file.gltf(R"("meshes":[{"primitives":[{"attributes":{"POSITION":0}}]}],)" + kOneNode);
    EXPECT_EQ(complaint(text), "");
    const size_t begin = text.find(R"("bufferViews":[)") + 15;
    const size_t end = text.find(R"(],"accessors")", begin);
    const std::string view = text.substr(begin, end - begin);
    for (int i = 0; i < 200; ++i)
        text.insert(begin, view + ",");
    EXPECT_NE(complaint(text).find("too often"), std::string::npos);
}

TEST(GltfMeshopt, DamagedPackedFilesNeverCrash) {
    const Field field(9);
    const PackedFile file = packed_field(field, 2);
    const auto read_it = [](const std::string& bytes) {
        Problems problems;
        bottom_up(read_glb(bytes, {}, "damaged", problems));
    };
    const std::string glb = file.glb(kOneMesh + kOneNode);
    hostile::survive(glb, 2000, read_it);
    hostile::survive(file.gltf(kOneMesh + kOneNode), 1000, read_it);
    // The packed bytes alone, so that every change reaches the codec.
    int refused = 0;
    for (uint64_t i = 0; i < 3000; ++i) {
        PcgRandom random(i, 11);
        std::string damaged = glb;
        for (int flips = 0; flips < 1 + static_cast<int>(i % 5); ++flips) {
            const auto from_end =
                static_cast<size_t>(random.uniform() * static_cast<double>(file.packed().size()));
            damaged[damaged.size() - 1 - from_end] = static_cast<char>(random.next());
        }
        refused += complaint(damaged).empty() ? 0 : 1;
    }
    EXPECT_GT(refused, 100);
}

TEST(GltfMeshopt, DracoIsNamedUnlessPlainAccessorsAreThere) {
    const std::string draco =
        R"("extensions":{"KHR_draco_mesh_compression":{"bufferView":0,"attributes":{"POSITION":0}}})";
    const std::string mesh =
        R"("meshes":[{"name":"quad","primitives":[{"attributes":{"POSITION":0},"indices":1,)" +
        draco + "}]}],";
    const std::string used = R"("extensionsUsed":["KHR_draco_mesh_compression"],)";
    const std::string required = R"("extensionsRequired":["KHR_draco_mesh_compression"],)";
    const std::string said = complaint(gltf(required + mesh + kOneNode));
    for (const char* part :
         {"'thing'", "KHR_draco_mesh_compression", "Compression off", "gltf-transform cp"})
        EXPECT_NE(said.find(part), std::string::npos) << said;
    EXPECT_EQ(read_one(gltf(used + mesh + kOneNode)).triangles.size(), 2u);
    // Accessors that have no bytes but those that Draco holds.
    std::string empty = gltf(used + mesh + kOneNode);
    const std::string view = R"({"bufferView":0,"componentType":5126)";
    empty.replace(empty.find(view), view.size(), R"({"componentType":5126)");
    Problems problems;
    EXPECT_EQ(totals(read(empty, problems)).triangles_placed, 0u);
    ASSERT_TRUE(has(problems, "bad_primitive"));
    EXPECT_NE(problems[0].message.find("gltf-transform cp"), std::string::npos)
        << problems[0].message;
}

TEST(GltfMeshopt, EveryUnknownExtensionIsNamed) {
    const std::string said = complaint(
        gltf(R"("extensionsRequired":["KHR_mesh_quantization","KHR_texture_basisu","ACME_odd"],)" +
             kOneMesh + kOneNode));
    EXPECT_NE(said.find("KHR_texture_basisu"), std::string::npos) << said;
    EXPECT_NE(said.find("PNG or JPEG"), std::string::npos) << said;
    EXPECT_NE(said.find("ACME_odd"), std::string::npos) << said;
    EXPECT_EQ(said.find("quantization"), std::string::npos) << said;
    std::string many = R"("extensionsRequired":["A")";
    for (int i = 0; i < 100000; ++i)
        many += R"(,"ACME_odd")";
    EXPECT_LT(complaint(gltf(many + "]," + kOneMesh + kOneNode)).size(), 1000u);
    // The later kind of packing has a codec that we do not have.
    PackedFile file = packed_field(Field(4), 2);
    file.required = R"("extensionsRequired":["KHR_meshopt_compression"],)";
    file.fallback =
        R"({"byteLength":99,"extensions":{"KHR_meshopt_compression":{"fallback":true}}})";
    EXPECT_NE(complaint(file.glb(kOneMesh + kOneNode)).find("EXT_meshopt_compression"),
              std::string::npos);
}

}  // namespace
}  // namespace lodestone::format
