// SPDX-License-Identifier: MIT
#include "cli/info/volume_info.h"

#include "core/base/try.h"
#include "core/transfer/opaque_intervals.h"
#include "core/volume/voxel_visit.h"
#include "voxtact/data.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace voxtact::app {

namespace {

constexpr std::size_t kBins = 16;

/// Returns the world axis of each index axis, each once: assigns the largest component first.
std::array<std::size_t, 3> worldAxes(const Grid& grid) {
    std::array<std::size_t, 3> along{};
    std::array<bool, 3> indexDone{};
    std::array<bool, 3> worldDone{};
    for (int round = 0; round < 3; ++round) {
        double max = -1;
        std::size_t index = 0;
        std::size_t world = 0;
        for (std::size_t i = 0; i < 3; ++i) {
            for (std::size_t w = 0; w < 3; ++w) {
                const double size = std::abs(grid.direction[3 * i + w]);
                if (!indexDone[i] && !worldDone[w] && size > max) {
                    max = size;
                    index = i;
                    world = w;
                }
            }
        }
        along[index] = world;
        indexDone[index] = true;
        worldDone[world] = true;
    }
    return along;
}

double obliqueness(const Grid& grid) {
    const std::array<std::size_t, 3> along = worldAxes(grid);
    double max = 0;
    for (std::size_t i = 0; i < 3; ++i) {
        const double cosine = std::min(std::abs(grid.direction[3 * i + along[i]]), 1.0);
        max = std::max(max, std::acos(cosine) * 180 / std::numbers::pi);
    }
    // Degrees: smaller angles come from the rounding of float headers.
    constexpr double kNothing = 0.05;
    return max < kNothing ? 0 : max;
}

/// Divides the range into bins; bins of integers begin at integers.
class Bins {
  public:
    Bins(ValueRange values, bool whole)
        : lo_(values.lo), width_((values.hi - values.lo + (whole ? 1 : 0)) / static_cast<double>(kBins)),
          whole_(whole) {
        if (whole) {
            width_ = std::max(std::ceil(width_), 1.0);
        }
        const double all = whole ? std::floor((values.hi - values.lo) / width_) + 1 : static_cast<double>(kBins);
        bins_.resize(values.lo < values.hi ? static_cast<std::size_t>(all) : 1);
        for (std::size_t i = 0; i < bins_.size(); ++i) {
            bins_[i].lo = lo_ + static_cast<double>(i) * width_;
            bins_[i].hi = i + 1 == bins_.size() ? values.hi : bins_[i].lo + width_ - (whole_ ? 1 : 0);
        }
    }

    void add(double value) {
        const auto bin = static_cast<std::size_t>(width_ > 0 ? (value - lo_) / width_ : 0);
        ++bins_[std::min(bin, bins_.size() - 1)].voxels;
    }
    [[nodiscard]] std::vector<HistogramBin> take() { return std::move(bins_); }

  private:
    double lo_;
    double width_;
    bool whole_;
    std::vector<HistogramBin> bins_;
};

} // namespace

std::string orientationLetters(const Grid& grid) {
    constexpr std::array<const char*, 3> kSides{"RL", "AP", "IS"}; // towards smaller and larger world x, y, z
    const std::array<std::size_t, 3> along = worldAxes(grid);
    std::string letters;
    for (std::size_t i = 0; i < 3; ++i) {
        letters += kSides[along[i]][grid.direction[3 * i + along[i]] > 0 ? 1 : 0];
    }
    return letters;
}

VolumeInfo volumeInfo(const VolumeView& volume, const ValueRange& values, std::span<const ControlPoint> opacity,
                      double threshold, bool isResampled) {
    const OpaqueIntervals intervals(opacity, threshold);
    VolumeInfo info;
    info.grid = volume.grid;
    info.type = volume.type;
    info.towards = orientationLetters(volume.grid);
    info.oblique = obliqueness(volume.grid);
    info.world = transformBox(worldFromTexture(volume.grid), {{0, 0, 0}, {1, 1, 1}});
    info.values = values;
    info.isResampled = isResampled;
    const auto voxels = static_cast<std::size_t>(voxelCount(volume.grid));
    Bins bins(values, volume.type != ScalarType::Float32);
    std::uint64_t opaque = 0;
    double sum = 0;
    visitVoxels(volume, [&](const auto* voxel) {
        for (std::size_t i = 0; i < voxels; ++i) {
            const auto value = static_cast<double>(voxel[i]);
            sum += value;
            bins.add(value);
            opaque += intervals.contain(value, value) ? 1 : 0;
        }
    });
    info.mean = sum / static_cast<double>(voxels);
    info.histogram = bins.take();
    info.opaque = static_cast<double>(opaque) / static_cast<double>(voxels);
    return info;
}

} // namespace voxtact::app
