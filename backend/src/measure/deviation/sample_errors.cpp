// SPDX-License-Identifier: GPL-3.0-or-later
#include "measure/deviation/sample_errors.h"

#include <algorithm>
#include <cmath>

namespace lodestone::measure {
namespace {

/// The share of all samples whose places the error covers.
/// Taste: a larger value counts single spikes, a smaller one loses thin parts.
constexpr double kQuantile = 0.999;
// The share of one look's samples whose moves the error covers.
// Taste: a larger value counts single texels of a look that moved.
constexpr double kLookQuantile = 0.99;
/// Looks of a smaller share of the area are details, for which their places alone answer.
/// Taste: a larger value loses narrow roads and signs, a smaller one keeps levels fine for specks.
constexpr double kLeastLookShare = 0.002;

/// A value for each look; looks are few and numbered from 0.
template <typename Value>
class ByLook {
public:
    Value& operator[](uint16_t look) {
        if (look >= values_.size())
            values_.resize(look + size_t{1});
        return values_[look];
    }
    auto begin() const { return values_.begin(); }
    auto end() const { return values_.end(); }

private:
    std::vector<Value> values_;
};

}  // namespace

double weight_of(const std::vector<SurfaceSample>& samples, const std::vector<size_t>& indices) {
    double sum = 0;
    for (const size_t i : indices)
        sum += samples[i].weight;
    return sum;
}

double quantile(const std::vector<SurfaceSample>& samples, const std::vector<double>& distances,
                std::vector<size_t> order, double most) {
    // The samples that are sorted first: mostly the farthest few decide, and the others are not
    // sorted.
    // Taste: a larger value sorts more than is mostly needed, a smaller one starts again more
    // often.
    constexpr size_t kFirst = 32;
    const auto farther = [&](size_t a, size_t b) {
        return distances[a] != distances[b] ? distances[a] > distances[b] : a < b;
    };
    const auto at = [&](size_t i) { return order.begin() + static_cast<std::ptrdiff_t>(i); };
    double above = 0;
    double out = 0;
    size_t end = 0;
    for (size_t begin = 0; begin < order.size(); begin = end) {
        end = std::min(order.size(), std::max(kFirst, 4 * begin));
        if (end < order.size())
            std::nth_element(at(begin), at(end), order.end(), farther);
        std::sort(at(begin), at(end), farther);
        for (size_t i = begin; i < end; ++i) {
            out = distances[order[i]];
            above += samples[order[i]].weight;
            if (above > most)
                return out;
        }
    }
    return out;
}

SurfaceDeviation deviation_of(const std::vector<SurfaceSample>& samples,
                              const std::vector<double>& places, const std::vector<double>& moves,
                              double enough) {
    SurfaceDeviation out;
    double all = 0;
    std::vector<size_t> far;
    ByLook<uint8_t> any_moved;
    for (size_t i = 0; i < samples.size(); ++i) {
        all += samples[i].weight;
        if (places[i] > enough)
            far.push_back(i);
        out.max = std::max({out.max, places[i], moves[i]});
        if (moves[i] > 0)
            any_moved[samples[i].look] = 1;
    }
    const double most = (1 - kQuantile) * all;
    out.error =
        weight_of(samples, far) > most ? quantile(samples, places, std::move(far), most) : enough;
    ByLook<std::vector<size_t>> moved;
    for (size_t i = 0; i < samples.size(); ++i) {
        if (samples[i].look != kAnyLook && any_moved[samples[i].look] != 0)
            moved[samples[i].look].push_back(i);
    }
    for (const std::vector<size_t>& indices : moved) {
        const double weight = weight_of(samples, indices);
        if (!indices.empty() && weight >= kLeastLookShare * all)
            out.moved = std::max(out.moved,
                                 quantile(samples, moves, indices, (1 - kLookQuantile) * weight));
    }
    out.error = std::max(out.error, out.moved);
    return out;
}

bool is_above(const std::vector<SurfaceSample>& samples, const std::vector<double>& places,
              double least) {
    double above = 0;
    double all = 0;
    for (size_t i = 0; i < samples.size(); ++i) {
        all += samples[i].weight;
        above += places[i] > least ? samples[i].weight : 0;
    }
    return above > (1 - kQuantile) * all;
}

bool surely_above(double useless, const std::vector<SurfaceSample>& samples,
                  const std::vector<size_t>& some, const std::vector<double>& places,
                  const std::vector<double>& moves) {
    // The shares of samples that must lie above, many times as much as the quantiles allow.
    // Taste: 20 times 1 - kQuantile; a larger value gives up later, a smaller one may give up too
    // soon.
    constexpr double kPlaces = 0.02;
    // Taste: 6 times 1 - kLookQuantile, for the same trade.
    constexpr double kMoves = 0.06;
    // The fewest samples that must lie above.
    // Taste: a larger value gives up later.
    constexpr size_t kFewest = 6;
    // Law: a look that counts by kLeastLookShare without doubt, told by a part of the samples.
    constexpr double kLeastShare = 5 * kLeastLookShare;
    struct ShareAbove {
        double all = 0;
        double above = 0;
        size_t count = 0;
        void add(double weight, bool is_above) {
            all += weight;
            above += is_above ? weight : 0;
            count += is_above ? 1 : 0;
        }
    };
    if (!std::isfinite(useless))
        return false;
    ShareAbove place;
    ByLook<ShareAbove> looks;
    for (const size_t i : some) {
        place.add(samples[i].weight, places[i] > useless);
        if (samples[i].look != kAnyLook)
            looks[samples[i].look].add(samples[i].weight, moves[i] > useless);
    }
    if (place.count >= kFewest && place.above > kPlaces * place.all)
        return true;
    return std::any_of(looks.begin(), looks.end(), [&](const ShareAbove& moved) {
        return moved.count >= kFewest && moved.above > kMoves * moved.all &&
               moved.all > kLeastShare * place.all;
    });
}

std::vector<uint8_t> look_samples(const std::vector<SurfaceSample>& samples, size_t wanted) {
    ByLook<size_t> counts;
    for (const SurfaceSample& sample : samples) {
        if (sample.look != kAnyLook)
            ++counts[sample.look];
    }
    ByLook<size_t> ranks;
    std::vector<uint8_t> out(samples.size(), 0);
    for (size_t i = 0; i < samples.size(); ++i) {
        if (samples[i].look == kAnyLook)
            continue;
        const size_t stride =
            std::clamp<size_t>(counts[samples[i].look] / wanted, 1, kLookSampleStep);
        const size_t rank = ranks[samples[i].look]++;
        out[i] = i % kLookSampleStep == 0 || rank == 0 ||
                         (stride < kLookSampleStep && rank % stride == 0)
                     ? 1
                     : 0;
    }
    return out;
}

void spread_moves(const std::vector<SurfaceSample>& samples, const std::vector<uint8_t>& asked,
                  std::vector<double>& moves) {
    ByLook<double> last;
    for (size_t i = 0; i < samples.size(); ++i) {
        if (samples[i].look == kAnyLook)
            continue;
        if (asked[i] != 0)
            last[samples[i].look] = moves[i];
        else
            moves[i] = last[samples[i].look];
    }
}

}  // namespace lodestone::measure
