// SPDX-License-Identifier: MIT
#include "core/base/infinity.h"
#include "core/base/try.h"
#include "voxtact/data.h"

#include <algorithm>
#include <cmath>

namespace voxtact {

namespace {

/// The values that the points make opaque, from the least.
std::vector<ValueRange> opaqueBands(std::span<const ControlPoint> points, double threshold) {
    std::vector<ValueRange> bands;
    bool opaque = points.front().opacity >= threshold;
    double from = -kInfinity;
    for (std::size_t i = 1; i < points.size(); ++i) {
        const ControlPoint& a = points[i - 1];
        const ControlPoint& b = points[i];
        if ((b.opacity >= threshold) == opaque) {
            continue;
        }
        const double at = a.value + (b.value - a.value) * (threshold - a.opacity) / (b.opacity - a.opacity);
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

/// A table over its domain.
class Table {
  public:
    Table(std::span<const float> entries, const ValueRange& domain) : entries_(entries), domain_(domain) {}

    /// The largest opacity of the values of a range.
    [[nodiscard]] double most(const ValueRange& values) const {
        const double first = entry(values.lo);
        const double last = entry(values.hi);
        double found = std::max(at(first), at(last));
        for (auto i = static_cast<std::size_t>(std::ceil(first)); static_cast<double>(i) <= last; ++i) {
            found = std::max(found, double{entries_[i]});
        }
        return found;
    }
    /// Of the entries in a range and of those next to it: where none is opaque, no value of it is.
    [[nodiscard]] double mostAbout(const ValueRange& values) const {
        const auto first = static_cast<std::ptrdiff_t>(entry(values.lo));
        const auto last = static_cast<std::ptrdiff_t>(std::ceil(entry(values.hi)));
        return *std::max_element(entries_.begin() + first, entries_.begin() + last + 1);
    }

  private:
    [[nodiscard]] double entry(double value) const {
        const auto size = static_cast<double>(entries_.size());
        return std::clamp((value - domain_.lo) / (domain_.hi - domain_.lo) * size - 0.5, 0.0, size - 1);
    }
    [[nodiscard]] double at(double entry) const {
        const auto below = static_cast<std::size_t>(entry);
        const std::size_t above = std::min(below + 1, entries_.size() - 1);
        const double weight = entry - static_cast<double>(below);
        return (1 - weight) * double{entries_[below]} + weight * double{entries_[above]};
    }

    std::span<const float> entries_;
    ValueRange domain_;
};

} // namespace

Result<OpacityFacts> checkOpacity(const TransferFunctionDesc& desc, const ValueRange& data, double threshold) {
    const Result<std::vector<float>> sampled = sampleTable(desc);
    VOXTACT_TRY(sampled);
    const Table table(*sampled, desc.domain);
    const double least = double{static_cast<float>(threshold)}; // as samples are compared with it
    const std::vector<ValueRange> bands = opaqueBands(desc.points, threshold);
    OpacityFacts facts;
    facts.reaches = !bands.empty();
    facts.any = table.most(data) >= least;
    facts.spacing = (desc.domain.hi - desc.domain.lo) / static_cast<double>(desc.tableSize);
    for (const ValueRange& band : bands) {
        const ValueRange within{std::max(band.lo, desc.domain.lo), std::min(band.hi, desc.domain.hi)};
        if (within.lo <= within.hi && within.lo <= data.hi && data.lo <= within.hi && table.mostAbout(within) < least) {
            facts.lost.push_back(within);
        }
    }
    return facts;
}

} // namespace voxtact
