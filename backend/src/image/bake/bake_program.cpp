// SPDX-License-Identifier: GPL-3.0-or-later
#include "image/bake/bake_program.h"

#include "base/color.h"
#include "base/error.h"

#include <glm/common.hpp>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>

namespace lodestone::image {
namespace {

using Color = glm::dvec4;

int argument_count(BakeOp op) {
    switch (op) {
        case BakeOp::Constant:
        case BakeOp::Texel:
            return 0;
        case BakeOp::Combine:
        case BakeOp::Mix:
            return 3;
        case BakeOp::Add:
        case BakeOp::Subtract:
        case BakeOp::Multiply:
        case BakeOp::Divide:
        case BakeOp::Power:
        case BakeOp::Minimum:
        case BakeOp::Maximum:
        case BakeOp::Greater:
        case BakeOp::Modulo:
            return 2;
        default:
            return 1;
    }
}

template <typename Function>
Color each(const Color& a, const Function& function) {
    return {function(a.x), function(a.y), function(a.z), function(a.w)};
}

template <typename Function>
Color each(const Color& a, const Color& b, const Function& function) {
    return {function(a.x, b.x), function(a.y, b.y), function(a.z, b.z), function(a.w, b.w)};
}

/// The value of a function that is 0 at 0, which is kept: the numbers of a picture are few, and come
/// again and again.
template <float (*kFunction)(float)>
double kept(double x) {
    struct KeptValue {
        float from = 0;
        float to = 0;
    };
    // Taste: more numbers push each other out less often, until they no longer fit a core's cache.
    constexpr unsigned kBits = 10;
    thread_local std::array<KeptValue, size_t{1} << kBits> values{};
    const auto from = static_cast<float>(x);
    const auto bits = std::bit_cast<uint32_t>(from);
    // Law: multiplied by the golden ratio, neighbors lie far apart (Knuth, volume 3, 6.4).
    KeptValue& value = values[(bits * 0x9e3779b9u) >> (32u - kBits)];
    if (std::bit_cast<uint32_t>(value.from) != bits)
        value = {from, kFunction(from)};
    return static_cast<double>(value.to);
}

Color looked_up(const std::vector<glm::vec4>& table, double at) {
    const double place =
        (at >= 0 ? std::min(at, 1.0) : 0.0) * static_cast<double>(table.size() - 1);
    const auto low = std::min(static_cast<size_t>(place), table.size() - 1);
    const size_t high = std::min(low + 1, table.size() - 1);
    return glm::mix(Color(table[low]), Color(table[high]), place - static_cast<double>(low));
}

Color to_hsv(const Color& c) {
    const double most = std::max({c.x, c.y, c.z});
    const double range = most - std::min({c.x, c.y, c.z});
    if (!(range > 0))
        return {0, 0, most, c.w};
    double hue = 0;
    if (most == c.x)
        hue = (c.y - c.z) / range;
    else if (most == c.y)
        hue = 2 + (c.z - c.x) / range;
    else
        hue = 4 + (c.x - c.y) / range;
    hue /= 6;
    return {hue < 0 ? hue + 1 : hue, most != 0 ? range / most : 0, most, c.w};
}

Color from_hsv(const Color& c) {
    const double hue = 6 * (c.x - std::floor(c.x));
    const auto channel = [&](double shift) {
        const double at = std::fmod(hue + shift, 6.0);
        return c.z * (1 - c.y * std::clamp(std::min(at, 4 - at), 0.0, 1.0));
    };
    return {channel(5), channel(3), channel(1), c.w};
}

}  // namespace

void check_bake(const std::vector<BakeStep>& steps, size_t texture_count, int width, int height) {
    if (steps.empty() || steps.size() > kMostBakeSteps)
        fail(Status::InvalidArgument, "a bake of ", steps.size(), " steps; 1 to ", kMostBakeSteps,
             " are possible");
    for (size_t i = 0; i < steps.size(); ++i) {
        const BakeStep& step = steps[i];
        if (step.op > BakeOp::FromSrgb)
            fail(Status::InvalidArgument, "step ", i, " of a bake is unknown");
        for (int a = 0; a < argument_count(step.op); ++a) {
            if (step.args[static_cast<size_t>(a)] >= i)
                fail(Status::InvalidArgument, "step ", i, " of a bake uses step ",
                     step.args[static_cast<size_t>(a)]);
        }
        if (step.op == BakeOp::Texel && step.args[0] >= texture_count)
            fail(Status::InvalidArgument, "step ", i, " of a bake uses texture ", step.args[0],
                 " of ", texture_count);
        if ((step.op == BakeOp::Ramp || step.op == BakeOp::Curves) && step.table.empty())
            fail(Status::InvalidArgument, "step ", i, " of a bake has no table");
        if (step.op == BakeOp::Channel && !(step.value.x >= 0 && step.value.x <= 3))
            fail(Status::InvalidArgument, "step ", i, " of a bake takes channel ", step.value.x);
    }
    if (width < 1 || height < 1 || width > kMostBakeSide || height > kMostBakeSide)
        fail(Status::InvalidArgument, "a bake of ", width, " x ", height, " texels");
}

double finite_or_zero(double value) {
    return std::isfinite(value) ? value : 0.0;
}

Color result_of(const BakeStep& step, const std::vector<Color>& done) {
    // The function check_bake() passed the arguments that count.
    const auto at = [&](size_t argument) -> const Color& {
        return done[std::min<size_t>(step.args[argument], done.size() - 1)];
    };
    const Color& a = at(0);
    const Color& b = at(1);
    const Color& c = at(2);
    switch (step.op) {
        case BakeOp::Constant:
        case BakeOp::Texel:
            return step.value;
        case BakeOp::Channel:
            return Color(a[static_cast<int>(step.value.x)]);
        case BakeOp::Luma:
            return Color(luminance(glm::dvec3(a)));
        case BakeOp::Combine:
            return {a.x, b.y, c.z, 1};
        case BakeOp::Add:
            return a + b;
        case BakeOp::Subtract:
            return a - b;
        case BakeOp::Multiply:
            return a * b;
        case BakeOp::Divide:
            return each(a, b, [](double x, double y) { return y != 0 ? x / y : 0; });
        case BakeOp::Power:
            return each(a, b, [](double x, double y) { return finite_or_zero(std::pow(x, y)); });
        case BakeOp::Minimum:
            return glm::min(a, b);
        case BakeOp::Maximum:
            return glm::max(a, b);
        case BakeOp::Mix:
            return a + c * (b - a);
        case BakeOp::Greater:
            return each(a, b, [](double x, double y) { return x > y ? 1.0 : 0.0; });
        case BakeOp::Absolute:
            return glm::abs(a);
        case BakeOp::Floor:
            return glm::floor(a);
        case BakeOp::Modulo:
            return each(a, b, [](double x, double y) { return y != 0 ? std::fmod(x, y) : 0; });
        case BakeOp::Ramp:
            return looked_up(step.table, a.x);
        case BakeOp::Curves:
            return {looked_up(step.table, a.x).x, looked_up(step.table, a.y).y,
                    looked_up(step.table, a.z).z, a.w};
        case BakeOp::ToHsv:
            return to_hsv(a);
        case BakeOp::FromHsv:
            return from_hsv(a);
        case BakeOp::ToSrgb:
            return each(a, [](double x) { return kept<encode_srgb<float>>(std::max(x, 0.0)); });
        case BakeOp::FromSrgb:
            return each(a, kept<decode_srgb<float>>);
    }
    return Color(0.0);
}

}  // namespace lodestone::image
