// SPDX-License-Identifier: MIT
#include "core/base/guard.h"
#include "core/base/infinity.h"
#include "core/base/try.h"
#include "core/transfer/table_extremes.h"
#include "core/transfer/threshold.h"
#include "voxtact/data.h"

#include <algorithm>
#include <cmath>

namespace voxtact {

namespace {

/// The values that the points make opaque, from the least.
std::vector<ValueRange> opaqueBands(std::span<const ControlPoint> points, double threshold) {
    // As samples are compared with it.
    const auto isOpaque = [least = static_cast<float>(threshold)](const ControlPoint& point) {
        return static_cast<float>(point.opacity) >= least;
    };
    std::vector<ValueRange> bands;
    bool opaque = isOpaque(points.front());
    double from = -kInfinity;
    for (std::size_t i = 1; i < points.size(); ++i) {
        const ControlPoint& a = points[i - 1];
        const ControlPoint& b = points[i];
        if (isOpaque(b) == opaque) {
            continue;
        }
        const double share = (threshold - a.opacity) / (b.opacity - a.opacity);
        const double at = std::clamp(a.value + (b.value - a.value) * share, a.value, b.value);
        if (opaque) {
            bands.push_back({from, at});
        }
        opaque = !opaque;
        from = at;
    }
    if (opaque) {
        bands.push_back({from, kInfinity});
    }
    return bands;
}

/// A table over its domain, as values look it up.
class LookUp {
  public:
    LookUp(std::span<const float> table, const ValueRange& domain) : table_(table), extremes_(table), domain_(domain) {}

    /// The largest opacity of the values of a range.
    [[nodiscard]] float most(const ValueRange& values) const {
        const double first = entry(values.lo);
        const double last = entry(values.hi);
        const float ends = std::max(at(first), at(last));
        const double inner = std::ceil(first);
        return inner > std::floor(last) ? ends : std::max(ends, greatest(inner, std::floor(last)));
    }
    /// Of the entries in a range and of those next to it: where none is opaque, no value of it is.
    [[nodiscard]] float mostAbout(const ValueRange& values) const {
        return greatest(std::floor(entry(values.lo)), std::ceil(entry(values.hi)));
    }

  private:
    [[nodiscard]] double entry(double value) const {
        const auto size = static_cast<double>(table_.size());
        return std::clamp((value - domain_.lo) / (domain_.hi - domain_.lo) * size - 0.5, 0.0, size - 1);
    }
    [[nodiscard]] float greatest(double first, double last) const {
        return extremes_.greatest(static_cast<std::uint32_t>(first), static_cast<std::uint32_t>(last));
    }
    [[nodiscard]] float at(double entry) const {
        const auto below = static_cast<std::size_t>(entry);
        const std::size_t above = std::min(below + 1, table_.size() - 1);
        const double weight = entry - static_cast<double>(below);
        return static_cast<float>((1 - weight) * double{table_[below]} + weight * double{table_[above]});
    }

    std::span<const float> table_;
    TableExtremes extremes_;
    ValueRange domain_;
};

/// Whether the data have values in a band, which is more of the domain than one of its ends: these have no entry.
bool isMet(const ValueRange& band, const ValueRange& domain, const ValueRange& data) {
    return band.lo < domain.hi && band.hi > domain.lo && band.lo <= data.hi && band.hi >= data.lo;
}

} // namespace

Result<OpacityFacts> checkOpacity(const TransferFunctionDesc& desc, const ValueRange& data, double threshold) {
    return guard([&]() -> Result<OpacityFacts> {
        const Result<std::vector<float>> table = sampleTable(desc);
        VOXTACT_TRY(table);
        VOXTACT_TRY(checkThreshold(threshold));
        if (!(data.lo <= data.hi)) {
            return refuse("the data's values are from " + number(data.lo) + " to " + number(data.hi));
        }
        const auto least = static_cast<float>(threshold);
        const LookUp lookUp(*table, desc.domain);
        const std::vector<ValueRange> bands = opaqueBands(desc.points, threshold);
        OpacityFacts facts;
        facts.reaches = !bands.empty();
        facts.any = lookUp.most(data) >= least;
        facts.spacing = (desc.domain.hi - desc.domain.lo) / static_cast<double>(desc.tableSize);
        for (const ValueRange& band : bands) {
            if (isMet(band, desc.domain, data) && lookUp.mostAbout(band) < least) {
                facts.lost.push_back({std::max(band.lo, desc.domain.lo), std::min(band.hi, desc.domain.hi)});
            }
        }
        return facts;
    });
}

} // namespace voxtact
