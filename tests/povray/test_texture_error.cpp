// SPDX-License-Identifier: GPL-3.0-or-later
// Guards how far image textures are made smaller: never so that a pixel could tell more than asked.
#include "base/color.h"
#include "povray/povray_scenes.h"
#include "povray_export/texture/picture_writer.h"

#include <optional>
#include <tuple>

using namespace lodestone;
using namespace lodestone::povray;

namespace {

constexpr int kSide = 256;

/// Fine stripes: each texel is seen where it is not made smaller.
PicturePtr stripes() {
    std::vector<glm::vec4> texels(size_t{kSide} * kSide, glm::vec4(1, 1, 1, 1));
    for (size_t i = 0; i < texels.size(); i += 2)
        texels[i] = glm::vec4(0, 0, 0, 1);
    return scenes::picture(kSide, texels);
}

/// A square of one metre with the picture once on it, or `uv` at all of its corners.
Mesh square(std::optional<glm::vec2> uv = {}) {
    Mesh mesh = shapes::quad(1, 1);
    for (const glm::vec3& at : mesh.positions)
        mesh.uvs.push_back(uv.value_or(glm::vec2(at)));
    return mesh;
}

/// Width of the only picture that is written: `metres` are shown on 64 pixels.
int written(const Texture& texture, const Mesh& mesh, double texture_error, double metres) {
    scenes::Builder builder;
    builder.place_at(builder.mesh(mesh, {builder.material(scenes::textured(texture))}),
                     {-0.5, -0.5, 0});
    const Model model = builder.finish();
    ExportOptions options;
    options.folder = own_scratch() / std::to_string(texture_error);
    options.shading.texture_error = texture_error;
    View view = scenes::above();
    view.camera.orthographic = true;
    view.camera.right = {metres, 0, 0};
    view.camera.up = {0, metres, 0};
    Problems problems;
    std::filesystem::remove_all(options.folder);
    const ExportReport first = scenes::write(model, view, options, problems);
    int width = 0;
    for (const auto& entry : std::filesystem::directory_iterator(options.folder / "i"))
        width = image::read(entry.path()).width;
    // Told by the header, of files that are found again, too.
    const auto texels = static_cast<uint64_t>(width) * static_cast<uint64_t>(width);
    EXPECT_EQ(first.texels, texels);
    EXPECT_EQ(scenes::write(model, view, options, problems).texels, texels);
    EXPECT_LT(first.text_bytes, first.bytes);
    return width;
}

Texture texture_of(const PicturePtr& picture) {
    Texture texture;
    texture.picture = picture;
    return texture;
}

}  // namespace

TEST(PovrayTextureError, NothingAskedKeepsWhatSamplesShow) {
    // One metre on 64 pixels: 256 texels are 4 a pixel, where 3 samples show a third of a pixel.
    EXPECT_EQ(written(texture_of(stripes()), square(), 0, 1), kSide);
    EXPECT_LE(written(texture_of(stripes()), square(), 0, 8), kSide / 4);
    EXPECT_GE(written(texture_of(stripes()), square(), 0, 8), 3 * 64 / 8);
}

TEST(PovrayTextureError, FewerSamplesShowLessOfAPicture) {
    Shading shading;
    EXPECT_DOUBLE_EQ(filled_up(shading, Antialiasing::Off, 0).texture_error, 1);
    EXPECT_DOUBLE_EQ(filled_up(shading, Antialiasing::Final, 0).texture_error, 1.0 / 3);
    EXPECT_DOUBLE_EQ(filled_up(shading, Antialiasing::Reference, 0).texture_error, 0.25);
    shading.depth = 2;
    EXPECT_DOUBLE_EQ(filled_up(shading, Antialiasing::Final, 0).texture_error, 0.5);
    shading.texture_error = 4;
    EXPECT_DOUBLE_EQ(filled_up(shading, Antialiasing::Reference, 0).texture_error, 4);
}

TEST(PovrayTextureError, ATexelCoversNoMorePixelsThanAsked) {
    const Texture texture = texture_of(stripes());
    // One metre on 64 pixels: 256 texels are 4 a pixel.
    for (const auto& [error, most, least] :
         {std::tuple{0.25, 256, 256}, {1.0, 128, 64}, {4.0, 32, 16}, {8.0, 16, 8}}) {
        const int found = written(texture, square(), error, 1);
        EXPECT_LE(found, most) << error;
        EXPECT_GE(found, least) << error;
        EXPECT_LE(64.0 / found, error);
    }
    EXPECT_EQ(written(texture, square(), 1, 1e9), 1);
}

TEST(PovrayTextureError, PixelArtAndPalettesStay) {
    Texture texture = texture_of(stripes());
    EXPECT_EQ(written(texture, square(glm::vec2(0.3F, 0.7F)), 8, 1), kSide) << "one texel for all";
    texture.interpolation = TextureInterpolation::Closest;
    EXPECT_EQ(written(texture, square(), 8, 1), kSide);
}

TEST(PovrayTextureError, AMappingThatShowsLessOfThePictureKeepsMoreOfIt) {
    Texture texture = texture_of(stripes());
    const int whole = written(texture, square(), 2, 1);
    texture.to_picture = {0.125, 0, 0, 0, 0.125, 0};
    EXPECT_EQ(written(texture, square(), 2, 1), std::min(kSide, 8 * whole));
}

TEST(PovrayTextureError, AMaskThatIsMadeSmallerIsNoFog) {
    // Leaves of five texels, here and there, through a material that is not cut.
    for (const bool mask : {true, false}) {
        std::vector<glm::vec4> texels;
        double mean = 0;
        for (int i = 0; i < kSide * kSide; ++i) {
            const auto leaf = static_cast<uint32_t>(i % kSide / 5 + 1000 * (i / kSide / 5));
            const float share = static_cast<float>(leaf * 2654435761u >> 16u) / 65535;
            texels.emplace_back(1, 1, 1, mask ? std::round(share) : share);
            mean += static_cast<double>(texels.back().w) / (kSide * kSide);
        }
        Texture texture = texture_of(scenes::picture(kSide, texels));
        texture.channel = TextureChannel::Alpha;
        PictureWriter pictures;
        UvRange range;
        range.texel = 8.0 / kSide;
        pictures.pigment(texture, PigmentContent::Alpha, range);
        const std::filesystem::path folder = own_scratch() / (mask ? "mask" : "blend");
        std::filesystem::remove_all(folder);
        PictureFolder files(folder);
        pictures.write(files);
        for (const auto& entry : std::filesystem::directory_iterator(folder / "i")) {
            const image::Image image = image::read(entry.path());
            EXPECT_EQ(image.width, kSide / 8);
            double sum = 0;
            double between = 0;
            for (size_t i = 0; i < image.pixels.size(); i += 4) {
                sum += static_cast<double>(image.pixels[i]);
                between += image.pixels[i] > 0.1f && image.pixels[i] < 0.9f ? 1 : 0;
            }
            const auto count = static_cast<double>(image.size());
            EXPECT_NEAR(sum / count, mean, 0.01);
            if (mask)
                EXPECT_LT(between / count, 0.4);
            else
                EXPECT_GT(between / count, 0.8);
        }
    }
}

TEST(PovrayTextureError, HalvingKeepsTheMeanLight) {
    const Texture texture = texture_of(stripes());
    EXPECT_EQ(halvings_of(texture, 0), 0);
    EXPECT_EQ(halvings_of(texture, 1.0 / kSide), 0);
    EXPECT_EQ(halvings_of(texture, 4.0 / kSide), 2);
    EXPECT_EQ(halvings_of(texture, 1e9), 8);
    const std::filesystem::path folder = own_scratch() / "mean";
    PictureWriter writer;
    UvRange range;
    range.texel = 1e9;
    EXPECT_NE(writer.pigment(texture, PigmentContent::Color, range), "");
    PictureFolder files(folder);
    writer.write(files);
    for (const auto& entry : std::filesystem::directory_iterator(folder / "i")) {
        const image::Image found = image::read(entry.path());
        EXPECT_EQ(found.width, 1);
        EXPECT_NEAR(decode_srgb(found.pixels[0]), 0.5, 0.01);
    }
}

/// The only picture that a writer writes.
image::Image only_picture(const PictureWriter& writer, const std::string& name) {
    const std::filesystem::path folder = own_scratch() / name;
    std::filesystem::remove_all(folder);
    PictureFolder files(folder);
    writer.write(files);
    const std::filesystem::directory_iterator first(folder / "i");
    EXPECT_EQ(std::distance(std::filesystem::directory_iterator(folder / "i"), {}), 1);
    return image::read(first->path());
}

TEST(PovrayTextureError, CoarselyCutLeavesShowedTheBlackBesideThem) {
    // A leaf on the left, a red dot on the right, and black that is clear, or next to it.
    std::vector<glm::vec4> texels(size_t{kSide} * kSide, glm::vec4(0, 0, 0, 0.01));
    for (int y = 0; y < kSide; ++y) {
        for (int x = 0; x < 20; ++x)
            texels[static_cast<size_t>(y) * kSide + static_cast<size_t>(x)] =
                glm::vec4(0.2, 0.6, 0.2, 1);
    }
    texels[size_t{100} * kSide + 200] = glm::vec4(1, 0, 0, 1);
    const Texture texture = texture_of(scenes::picture(kSide, texels));
    const auto green_at = [&](PigmentContent content, int x, int y) {
        PictureWriter writer;
        writer.pigment(texture, content, {});
        const image::Image found = only_picture(writer, "leaf");
        EXPECT_EQ(found.width, kSide);
        return decode_srgb(
            found.pixels[4 * (static_cast<size_t>(y) * kSide + static_cast<size_t>(x)) + 1]);
    };
    EXPECT_NEAR(green_at(PigmentContent::Leaf, 10, 50), 0.6, 0.01);
    EXPECT_NEAR(green_at(PigmentContent::Leaf, 25, 50), 0.6, 0.08);
    EXPECT_GT(green_at(PigmentContent::Leaf, 60, 200), 0.4);
    EXPECT_LT(green_at(PigmentContent::Leaf, 203, 101), 0.1);
    EXPECT_EQ(green_at(PigmentContent::Leaf, 200, 100), 0);
    // Where alpha is something else its colors stay.
    EXPECT_NEAR(green_at(PigmentContent::Color, 25, 50), 0, 0.01);
}

TEST(PovrayTextureError, LeavesMadeSmallerHadFringesOfWhatIsClear) {
    // One texel in three is a green leaf; what is clear around it is black, or white.
    for (const float clear : {0.0f, 1.0f}) {
        std::vector<glm::vec4> texels(size_t{kSide} * kSide, glm::vec4(clear, clear, clear, 0));
        for (size_t i = 0; i < texels.size(); i += 3)
            texels[i] = glm::vec4(0.2, 0.6, 0.2, 1);
        const Texture texture = texture_of(scenes::picture(kSide, texels));
        PictureWriter writer;
        UvRange range;
        range.texel = 4.0 / kSide;
        writer.pigment(texture, PigmentContent::Leaf, range);
        const image::Image found = only_picture(writer, "smaller");
        EXPECT_EQ(found.width, kSide / 4);
        for (size_t i = 0; i < found.pixels.size(); i += 4) {
            EXPECT_NEAR(decode_srgb(found.pixels[i]), 0.2, 0.01);
            EXPECT_NEAR(decode_srgb(found.pixels[i + 1]), 0.6, 0.01);
            EXPECT_EQ(found.pixels[i + 3], 1.0f);
        }
    }
}
