// SPDX-License-Identifier: MIT
#include "core/base/guard.h"
#include "core/base/refuse.h"
#include "core/base/text.h"
#include "core/base/try.h"
#include "core/volume/label_lookup.h"
#include "core/volume/voxel_visit.h"
#include "voxtact/data.h"

#include <algorithm>
#include <cmath>
#include <unordered_map>

namespace voxtact {

namespace {

constexpr double kLargestLabel = 1 << 24;
constexpr std::size_t kMostLabels = 65536;

Error tooManyLabels(const std::string& count) {
    return {ErrorCode::LimitExceeded, 0,
            "the label map has " + count + " different labels (0 among them), at most " + std::to_string(kMostLabels) +
                " can be told apart"};
}

/// Refuses floats that are no labels.
template <class Scalar> Result<void> checkWhole(const Grid& grid, const Scalar* voxels) {
    const std::uint64_t count = std::is_integral_v<Scalar> ? 0 : voxelCount(grid);
    for (std::uint64_t i = 0; i < count; ++i) {
        const auto value = static_cast<double>(voxels[i]);
        if (value != std::floor(value) || std::abs(value) > kLargestLabel) {
            return refuse("voxel (" + std::to_string(i % grid.size[0]) + ", " +
                          std::to_string(i / grid.size[0] % grid.size[1]) + ", " +
                          std::to_string(i / grid.size[0] / grid.size[1]) + ") of the label map is " + number(value) +
                          ", a label is a whole number from -16777216 to 16777216");
        }
    }
    return {};
}

/// The labels from the smallest to the largest, used or not.
struct Census {
    std::int32_t first = 0;
    std::vector<bool> used;
    std::vector<std::uint16_t> numbers; ///< of the used labels

    explicit Census(const ValueRange& range)
        : first(std::min(static_cast<std::int32_t>(range.lo), 0)),
          used(static_cast<std::size_t>(std::max(static_cast<std::int32_t>(range.hi), 0) - first) + 1, false) {
        used[place(0)] = true;
    }
    [[nodiscard]] std::size_t place(std::int32_t label) const { return static_cast<std::size_t>(label - first); }
};

template <class Scalar> Result<void> fill(const Scalar* voxels, Census& census, LabelData& out) {
    const std::uint64_t count = voxelCount(out.grid);
    for (std::uint64_t i = 0; i < count; ++i) {
        census.used[census.place(static_cast<std::int32_t>(voxels[i]))] = true;
    }
    const auto labels = static_cast<std::size_t>(std::count(census.used.begin(), census.used.end(), true));
    if (labels > kMostLabels) {
        return tooManyLabels(std::to_string(labels));
    }
    census.numbers.resize(census.used.size());
    for (std::size_t place = 0; place < census.used.size(); ++place) {
        if (census.used[place]) {
            census.numbers[place] = static_cast<std::uint16_t>(out.values.size());
            out.values.push_back(census.first + static_cast<std::int32_t>(place));
        }
    }
    out.indices.resize(count);
    for (std::uint64_t i = 0; i < count; ++i) {
        out.indices[i] = census.numbers[census.place(static_cast<std::int32_t>(voxels[i]))];
    }
    return {};
}

} // namespace

Result<LabelData> makeLabels(const VolumeView& volume) {
    return guard([&]() -> Result<LabelData> {
        const Result<ValueRange> range = checkVolume(volume);
        VOXTACT_TRY(range);
        LabelData out;
        out.grid = volume.grid;
        Result<void> made = visitVoxels(volume, [&](const auto* voxels) -> Result<void> {
            VOXTACT_TRY(checkWhole(volume.grid, voxels));
            Census census(*range);
            return fill(voxels, census, out);
        });
        VOXTACT_TRY(made);
        return out;
    });
}

Result<LabelData> makeLabels(const Grid& grid, std::span<const std::int32_t> labels) {
    return guard([&]() -> Result<LabelData> {
        VOXTACT_TRY(checkGrid(grid));
        if (labels.size() != voxelCount(grid)) {
            return refuse("a label map of " + std::to_string(voxelCount(grid)) + " voxels has " +
                          std::to_string(labels.size()) + " labels");
        }
        // Neighbours mostly have one label.
        std::unordered_map<std::int32_t, std::uint16_t> numbers{{0, 0}};
        std::int32_t last = 0;
        for (const std::int32_t label : labels) {
            if (label != last) {
                numbers.emplace(label, std::uint16_t{0});
                last = label;
            }
            if (numbers.size() > kMostLabels) {
                return tooManyLabels("more than " + std::to_string(kMostLabels));
            }
        }
        LabelData out;
        out.grid = grid;
        for (const auto& [label, number] : numbers) {
            out.values.push_back(label);
        }
        std::sort(out.values.begin(), out.values.end());
        for (std::size_t i = 0; i < out.values.size(); ++i) {
            numbers[out.values[i]] = static_cast<std::uint16_t>(i);
        }
        out.indices.reserve(labels.size());
        last = 0;
        std::uint16_t number = numbers[0];
        for (const std::int32_t label : labels) {
            if (label != last) {
                number = numbers[label];
                last = label;
            }
            out.indices.push_back(number);
        }
        return out;
    });
}

std::uint32_t labelAt(const LabelData& labels, const Vec3& world) noexcept {
    return LabelLookup(labels).at(world);
}

} // namespace voxtact
