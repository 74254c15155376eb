// SPDX-License-Identifier: MIT
#include "io/dicom/dicom_resample.h"

#include "core/base/infinity.h"
#include "core/base/text.h"
#include "core/base/try.h"
#include "core/geometry/vec3.h"
#include "io/dicom/dicom_stack.h"
#include "io/errors.h"
#include "voxtact/io.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace voxtact::io {

namespace {

/// Pixels: a slice reaches so far beyond its outermost centres, because written positions are rounded.
constexpr double kReach = 0.01;

std::string tenths(double value) {
    return number(std::round(10 * value) / 10);
}

} // namespace

DicomResampler::DicomResampler(const DicomImage& image, const std::vector<DicomSlice>& slices)
    : columns_(image.columns), rows_(image.rows) {
    const DicomSlice& first = slices.front();
    for (const DicomSlice& slice : slices) {
        const Vec3 step = minus(slice.position, first.position);
        places_.push_back({-dot(step, first.across) / first.spacing[0], -dot(step, first.down) / first.spacing[1],
                           slice.height - first.height});
    }
}

Result<DicomResampler> DicomResampler::create(const std::filesystem::path& folder, const DicomImage& image,
                                              const std::vector<DicomSlice>& slices) {
    DicomResampler made(image, slices);
    VOXTACT_TRY(made.setGrid(folder, slices));
    return made;
}

Result<void> DicomResampler::setGrid(const std::filesystem::path& folder, const std::vector<DicomSlice>& slices) {
    constexpr double kMaxSlices = 4; // of the grid for each slice, and voxels
    constexpr double kMaxVoxels = 8;
    std::vector<double> gaps;
    for (std::size_t i = 1; i < places_.size(); ++i) {
        gaps.push_back(places_[i].height - places_[i - 1].height);
    }
    std::sort(gaps.begin(), gaps.end());
    smallestGap_ = gaps.front();
    largestGap_ = gaps.back();
    const double rise = places_.back().height;
    const auto count = static_cast<double>(places_.size());
    // One pair of near slices must not multiply the slices of all.
    const double gap = rise / smallestGap_ < kMaxSlices * count ? smallestGap_ : gaps[(gaps.size() - 1) / 2];
    const double steps = std::max(std::round(rise / gap), 1.0);
    const DicomSlice& first = slices.front();
    grid_.spacing = {first.spacing[0], first.spacing[1], rise / steps};
    const Vec3 normal = cross(first.across, first.down);
    const auto [left, right] = std::ranges::minmax(places_, {}, &Place::across);
    const auto [top, bottom] = std::ranges::minmax(places_, {}, &Place::down);
    const Vec3 lowest{std::floor(-right.across + kReach), std::floor(-bottom.down + kReach), 0};
    const Vec3 size{std::ceil(columns_ - left.across - kReach) - lowest[0],
                    std::ceil(rows_ - top.down - kReach) - lowest[1], steps + 1};
    const double pixels = static_cast<double>(columns_) * rows_ * count;
    if (!(steps < kMaxSlices * count && size[0] * size[1] * size[2] <= kMaxVoxels * pixels)) {
        return cannotRead(folder, "its " + std::to_string(places_.size()) + " slices, " + millimetres(smallestGap_) +
                                      " to " + millimetres(largestGap_) +
                                      " mm apart, lie too far from each other to be resampled: the grid would have " +
                                      number(size[0]) + " x " + number(size[1]) + " x " + number(size[2]) +
                                      " voxels; take away what is not of this image");
    }
    for (std::size_t axis = 0; axis < 3; ++axis) {
        grid_.size[axis] = static_cast<std::uint32_t>(size[axis]);
        grid_.direction[axis] = first.across[axis];
        grid_.direction[3 + axis] = first.down[axis];
        grid_.direction[6 + axis] = normal[axis];
        grid_.origin[axis] = first.position[axis] + lowest[0] * first.spacing[0] * first.across[axis] +
                             lowest[1] * first.spacing[1] * first.down[axis];
    }
    const double shift = std::hypot(places_.back().across * first.spacing[0], places_.back().down * first.spacing[1]);
    shear_ = std::atan2(shift, rise) * 180 / std::numbers::pi;
    for (Place& place : places_) {
        place.across += lowest[0];
        place.down += lowest[1];
    }
    const Result<void> checked = checkGrid(grid_);
    return checked.ok() ? checked : cannotRead(folder, checked.error().text);
}

DicomResampler::Blend DicomResampler::blendAt(std::uint32_t slice) const {
    const double height = slice * grid_.spacing[2];
    const auto above = std::ranges::upper_bound(places_, height, {}, &Place::height);
    const auto lower =
        std::clamp<std::ptrdiff_t>(above - places_.begin() - 1, 0, static_cast<std::ptrdiff_t>(places_.size()) - 2);
    const Place& from = places_[static_cast<std::size_t>(lower)];
    const Place& to = places_[static_cast<std::size_t>(lower) + 1];
    const double share = (height - from.height) / (to.height - from.height);
    // On a slice, the next one need not be there.
    constexpr double kOn = 1e-6;
    const bool isOn = share < kOn || share > 1 - kOn;
    return {static_cast<std::size_t>(lower), isOn ? std::round(share) : share};
}

/// Adds a slice at the pixels of the grid. Pixels outside of it become NaN; infinite ones stay infinite.
template <class Stored>
void DicomResampler::addSlice(const Stored* pixels, const Place& place, double weight, std::vector<double>& sum) const {
    constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
    struct Along {
        std::size_t first = 0;
        double share = 0;
        bool isInside = false;
    };
    const auto along = [](double at, std::uint32_t count) {
        const double last = count - 1.0;
        const double first = std::clamp(std::floor(at), 0.0, std::max(last - 1, 0.0));
        return Along{static_cast<std::size_t>(first), at - first, at >= -kReach && at <= last + kReach};
    };
    const std::size_t right = columns_ > 1 ? 1 : 0;
    const std::size_t below = rows_ > 1 ? columns_ : 0;
    double* out = sum.data();
    for (std::uint32_t row = 0; row < grid_.size[1]; ++row) {
        const Along y = along(row + place.down, rows_);
        for (std::uint32_t column = 0; column < grid_.size[0]; ++column, ++out) {
            const Along x = along(column + place.across, columns_);
            if (!x.isInside || !y.isInside) {
                *out = kNone;
                continue;
            }
            const Stored* const at = pixels + y.first * columns_ + x.first;
            const double upper = (1 - x.share) * static_cast<double>(at[0]) + x.share * static_cast<double>(at[right]);
            const double lower =
                (1 - x.share) * static_cast<double>(at[below]) + x.share * static_cast<double>(at[below + right]);
            const double value = (1 - y.share) * upper + y.share * lower;
            *out += weight * (std::isnan(value) ? kInfinity : value);
        }
    }
}

/// Returns how many voxels no slice has.
template <class Stored> std::uint64_t DicomResampler::fill(const Stored* stored, double least, float* out) const {
    const std::size_t pixels = std::size_t{columns_} * rows_;
    std::vector<double> sum;
    std::uint64_t empty = 0;
    for (std::uint32_t slice = 0; slice < grid_.size[2]; ++slice) {
        sum.assign(std::size_t{grid_.size[0]} * grid_.size[1], 0);
        const Blend blend = blendAt(slice);
        for (const std::size_t next : {std::size_t{0}, std::size_t{1}}) {
            const double weight = next == 1 ? blend.share : 1 - blend.share;
            if (weight > 0) {
                const std::size_t from = blend.slice + next;
                addSlice(stored + from * pixels, places_[from], weight, sum);
            }
        }
        for (const double value : sum) {
            empty += std::isnan(value) ? 1 : 0;
            *out++ = static_cast<float>(std::isnan(value) ? least : value);
        }
    }
    return empty;
}

StoredImage DicomResampler::resample(StoredType type, const std::vector<std::byte>& voxels,
                                     std::vector<std::string>& notes) const {
    StoredImage image;
    image.grid = grid_;
    image.type = StoredType::Float32;
    image.voxels.resize(static_cast<std::size_t>(voxelCount(grid_)) * sizeof(float));
    withStored(type, [&]<class Stored>(Stored) {
        const auto* const stored = reinterpret_cast<const Stored*>(voxels.data());
        const std::size_t count = std::size_t{columns_} * rows_ * places_.size();
        const auto least = static_cast<double>(*std::min_element(stored, stored + count));
        notes.push_back(note(fill(stored, least, reinterpret_cast<float*>(image.voxels.data())), least));
    });
    return image;
}

std::string DicomResampler::note(std::uint64_t empty, double least) const {
    std::string text(kResampledNote);
    text += " by linear interpolation, as floats: gaps of " + millimetres(smallestGap_);
    text += largestGap_ > smallestGap_ ? " to " + millimetres(largestGap_) : "";
    text += " mm become " + millimetres(grid_.spacing[2]) + " mm, a shear of " + tenths(shear_) + " degrees becomes 0";
    if (empty > 0) {
        const double share = static_cast<double>(empty) / static_cast<double>(voxelCount(grid_));
        text += "; " + tenths(100 * share) + " % of the voxels are outside of the slices and get the least value, " +
                number(least);
    }
    return text;
}

} // namespace voxtact::io
