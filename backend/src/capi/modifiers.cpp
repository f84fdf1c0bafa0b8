// SPDX-License-Identifier: GPL-3.0-or-later
// Quality modifiers in the C interface: their translation. Values that make no sense are refused
// when choosing.
#include "capi/guard.h"
#include "capi/handles.h"

namespace lodestone::capi {
namespace {

DetailLens lens_of(const lds_lens& given, const lds_model* model) {
    DetailLens lens;
    lens.name = name_of(given.name);
    if (given.shape != LDS_LENS_SHAPE_SPHERE && given.shape != LDS_LENS_SHAPE_BOX)
        fail(Status::InvalidArgument, "lens '", lens.name, "' has shape ", given.shape,
             "; 0 (sphere) or 1 (box) expected");
    if (given.filter < LDS_LENS_FILTER_ALL || given.filter > LDS_LENS_FILTER_SHOW)
        fail(Status::InvalidArgument, "lens '", lens.name, "' has filter ", given.filter,
             "; 0 to 2 expected");
    lens.shape = static_cast<LensShape>(given.shape);
    lens.filter = static_cast<LensFilter>(given.filter);
    lens.transform = Affine::from_rows(given.transform);
    lens.radius = given.radius;
    lens.strength = given.strength;
    lens.falloff = given.falloff;
    if (given.object_count > 0)
        require(given.objects, "lens.objects");
    for (size_t i = 0; i < given.object_count; ++i)
        lens.objects.push_back(model->index_of(given.objects[i]));
    return lens;
}

ScreenLens screen_lens_of(const lds_screen_lens& given, int width, int height) {
    ScreenLens lens;
    lens.name = name_of(given.name);
    const bool shares = given.in_pixels == 0;
    lens.center = {given.center[0] * (shares ? width : 1), given.center[1] * (shares ? height : 1)};
    lens.radius = given.radius * (shares ? width : 1);
    lens.strength = given.strength;
    lens.falloff = given.falloff;
    return lens;
}

}  // namespace

QualityModifiers modifiers_of(const lds_modifiers* modifiers, const lds_model* model, int width,
                              int height) {
    const lds_modifiers given = checked(modifiers, "modifiers");
    QualityModifiers out;
    // A new modifier breaks this line, so that its author takes it from C here.
    auto& [criterion, lenses, screen_lenses, depth, depth_focus, when_moving, closing, when_dark,
           off_screen, ray_classes] = out;
    if (given.criterion < LDS_CRITERION_RESOLUTION || given.criterion > LDS_CRITERION_DISTANCE)
        fail(Status::InvalidArgument, "modifiers.criterion is ", given.criterion,
             "; 0 to 3 expected");
    criterion = static_cast<DetailCriterion>(given.criterion);
    if (given.lens_count > choose::kMostLenses || given.screen_lens_count > choose::kMostLenses)
        fail(Status::InvalidArgument, std::max(given.lens_count, given.screen_lens_count),
             " lenses; at most ", choose::kMostLenses);
    if (given.lens_count > 0)
        require(given.lenses, "modifiers.lenses");
    if (given.screen_lens_count > 0)
        require(given.screen_lenses, "modifiers.screen_lenses");
    for (size_t i = 0; i < given.lens_count; ++i)
        lenses.push_back(lens_of(given.lenses[i], model));
    for (size_t i = 0; i < given.screen_lens_count; ++i)
        screen_lenses.push_back(screen_lens_of(given.screen_lenses[i], width, height));
    depth = given.depth;
    depth_focus = given.depth_focus;
    when_moving = given.when_moving != 0;
    when_dark = given.when_dark != 0;
    if (given.off_screen < LDS_OFF_SCREEN_FULL || given.off_screen > LDS_OFF_SCREEN_SHADOWS)
        fail(Status::InvalidArgument, "modifiers.off_screen is ", given.off_screen,
             "; 0 to 2 expected");
    off_screen = static_cast<OffScreen>(given.off_screen);
    // Law: lds_rays numbers the classes without the camera's bit, which comes first.
    constexpr uint32_t kAllClasses = kIndirectRays >> 1u;
    if ((given.ray_classes & ~kAllClasses) != 0)
        fail(Status::InvalidArgument, "modifiers.ray_classes is ", given.ray_classes, "; 0 to ",
             kAllClasses, " expected");
    ray_classes = static_cast<RayMask>(given.ray_classes << 1u);
    if (given.closing != nullptr)
        closing = camera_of(given.closing);
    return out;
}

}  // namespace lodestone::capi

using namespace lodestone;
using namespace lodestone::capi;

lds_status lds_modifiers_default(lds_modifiers* modifiers) {
    return guard([&] {
        const QualityModifiers defaults;
        lds_modifiers out{};
        out.depth = defaults.depth;
        out.depth_focus = defaults.depth_focus;
        hand_out(modifiers, out, "modifiers");
    });
}
