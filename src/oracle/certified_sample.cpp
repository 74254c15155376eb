// SPDX-License-Identifier: MIT
#include "oracle/certified_sample.h"
#include "core/base/infinity.h"

#include <algorithm>
#include <cmath>
#include <cstring>

namespace voxtact::oracle::certified {

namespace {

/// Of the largest voxel: an interpolation makes fewer roundings than that, and so does a mean of six.
constexpr double kInterpolationRoundings = 64;
/// Of the look-up coordinate.
constexpr double kEntryRoundings = 8;

template <class Scalar> std::vector<double> widen(const VolumeView& volume) {
    std::vector<double> out(voxelCount(volume.grid));
    for (std::size_t i = 0; i < out.size(); ++i) {
        Scalar scalar;
        std::memcpy(&scalar, volume.voxels.data() + i * sizeof scalar, sizeof scalar);
        out[i] = static_cast<double>(scalar);
    }
    return out;
}

std::vector<double> widenAny(const VolumeView& volume) {
    switch (volume.type) {
    case ScalarType::UInt8:
        return widen<std::uint8_t>(volume);
    case ScalarType::Int16:
        return widen<std::int16_t>(volume);
    case ScalarType::UInt16:
        return widen<std::uint16_t>(volume);
    case ScalarType::Float32:
        break;
    }
    return widen<float>(volume);
}

double mix(double a, double b, double weight) {
    return a + weight * (b - a);
}

/// The interpolant's value with x of one corner of the triangle, y of another and z of a third: at [i][j][k].
using Mixed = std::array<std::array<std::array<double, 3>, 3>, 3>;

Mixed mixedValues(const CellVoxels& v, const Cell& cell, const Corners& triangle) {
    const auto fraction = [&](std::size_t corner, std::size_t axis) {
        return triangle[corner][axis] - static_cast<double>(cell[axis]);
    };
    Mixed out{};
    for (std::size_t i = 0; i < 3; ++i) {
        const double x = fraction(i, 0);
        const double rows[4] = {mix(v[0], v[1], x), mix(v[2], v[3], x), mix(v[4], v[5], x), mix(v[6], v[7], x)};
        for (std::size_t j = 0; j < 3; ++j) {
            const double y = fraction(j, 1);
            const double lower = mix(rows[0], rows[1], y);
            const double upper = mix(rows[2], rows[3], y);
            for (std::size_t k = 0; k < 3; ++k) {
                out[i][j][k] = mix(lower, upper, fraction(k, 2));
            }
        }
    }
    return out;
}

} // namespace

Field::Field(const VolumeView& volume, const ValueRange& range)
    : size_(volume.grid.size), voxels_(widenAny(volume)), range_(range), slope_(3 * (range.hi - range.lo)),
      rounding_(kInterpolationRoundings * kRounding * std::max(std::abs(range.lo), std::abs(range.hi))) {}

CellVoxels Field::voxelsOf(const Cell& cell) const {
    std::size_t at[3][2];
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const std::int64_t last = std::int64_t{size_[axis]} - 1;
        at[axis][0] = static_cast<std::size_t>(std::clamp<std::int64_t>(cell[axis], 0, last));
        at[axis][1] = static_cast<std::size_t>(std::clamp<std::int64_t>(cell[axis] + 1, 0, last));
    }
    CellVoxels out{};
    for (std::size_t corner = 0; corner < 8; ++corner) {
        out[corner] = voxels_[(at[2][corner >> 2] * size_[1] + at[1][corner >> 1 & 1]) * size_[0] + at[0][corner & 1]];
    }
    return out;
}

ValueRange Field::at(const Vec3& place, double error) const {
    Cell cell{};
    Vec3 f{};
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const double inside = std::clamp(place[axis], 0.0, static_cast<double>(size_[axis] - 1));
        cell[axis] = static_cast<std::int64_t>(std::floor(inside));
        f[axis] = inside - std::floor(inside);
    }
    const CellVoxels v = voxelsOf(cell);
    const double value = mix(mix(mix(v[0], v[1], f[0]), mix(v[2], v[3], f[0]), f[1]),
                             mix(mix(v[4], v[5], f[0]), mix(v[6], v[7], f[0]), f[1]), f[2]);
    return widened(value, value, error);
}

/// With barycentric weights a, the interpolant, affine along each axis, is the sum over i, j, k of a_i a_j a_k times
/// the mixed value [i][j][k]. The weights are the same for the six orders of i, j and k, so that each six can be
/// replaced by their mean, and all the weights add up to 1: the value lies between the least and the greatest mean.
ValueRange Field::over(const CellVoxels& voxels, const Cell& cell, const Corners& triangle, double error) const {
    const Mixed m = mixedValues(voxels, cell, triangle);
    double lo = kInfinity;
    double hi = -lo;
    for (std::size_t i = 0; i < 3; ++i) {
        for (std::size_t j = i; j < 3; ++j) {
            for (std::size_t k = j; k < 3; ++k) {
                const double mean = (m[i][j][k] + m[i][k][j] + m[j][i][k] + m[j][k][i] + m[k][i][j] + m[k][j][i]) / 6;
                lo = std::min(lo, mean);
                hi = std::max(hi, mean);
            }
        }
    }
    return widened(lo, hi, error);
}

/// An interpolant never leaves the range of the voxels.
ValueRange Field::widened(double lo, double hi, double error) const {
    return {std::clamp(lo - doubt(error), range_.lo, range_.hi), std::clamp(hi + doubt(error), range_.lo, range_.hi)};
}

Opacity::Opacity(std::vector<float> entries, const ValueRange& domain, double threshold)
    : entries_(std::move(entries)), domain_(domain), threshold_(threshold) {}

double Opacity::entryOf(double value) const {
    return (value - domain_.lo) / (domain_.hi - domain_.lo) * static_cast<double>(entries_.size()) - 0.5;
}

double Opacity::valueOf(double entry) const {
    return domain_.lo + (entry + 0.5) / static_cast<double>(entries_.size()) * (domain_.hi - domain_.lo);
}

double Opacity::clamped(double entry) const {
    return std::clamp(entry, 0.0, static_cast<double>(entries_.size() - 1));
}

/// At an entry and between two that are the same nothing rounds, so that a plateau at the threshold is opaque.
ValueRange Opacity::opacityAt(double entry) const {
    const auto i = static_cast<std::size_t>(entry);
    const auto a = static_cast<double>(entries_[i]);
    const auto b = static_cast<double>(entries_[std::min(i + 1, entries_.size() - 1)]);
    if (entry == std::floor(entry)) {
        return {a, a};
    }
    const double opacity = mix(a, b, entry - static_cast<double>(i));
    const double rounding = 4 * kRounding * std::max(a, b);
    return {std::max(opacity - rounding, std::min(a, b)), std::min(opacity + rounding, std::max(a, b))};
}

bool Opacity::entryIsOpaque(double entry) const {
    return static_cast<double>(entries_[static_cast<std::size_t>(entry)]) >= threshold_;
}

namespace {

double entryMargin(double entry) {
    return kEntryRoundings * kRounding * (std::abs(entry) + 1);
}

} // namespace

bool Opacity::mayBeOpaque(const ValueRange& values) const {
    const double first = entryOf(values.lo);
    const double last = entryOf(values.hi);
    const double lo = clamped(first - entryMargin(first));
    const double hi = clamped(last + entryMargin(last));
    if (opacityAt(lo).hi >= threshold_ || opacityAt(hi).hi >= threshold_) {
        return true;
    }
    for (double entry = std::ceil(lo); entry <= hi; ++entry) {
        if (entryIsOpaque(entry)) {
            return true;
        }
    }
    return false;
}

bool Opacity::allOpaque(const ValueRange& values) const {
    const double first = entryOf(values.lo);
    const double last = entryOf(values.hi);
    const double lo = clamped(first - entryMargin(first));
    const double hi = clamped(last + entryMargin(last));
    if (opacityAt(lo).lo < threshold_ || opacityAt(hi).lo < threshold_) {
        return false;
    }
    for (double entry = std::ceil(lo); entry <= hi; ++entry) {
        if (!entryIsOpaque(entry)) {
            return false;
        }
    }
    return true;
}

std::optional<double> Opacity::opaqueBetween(double lo, double hi) const {
    const double first = entryOf(lo) + entryMargin(entryOf(lo));
    const double last = entryOf(hi) - entryMargin(entryOf(hi));
    if (!(first <= last)) {
        return {};
    }
    for (double entry = std::ceil(clamped(first)); entry <= clamped(last); ++entry) {
        if (entryIsOpaque(entry)) {
            return std::clamp(valueOf(entry), lo, hi);
        }
    }
    for (const double entry : {first, last}) {
        if (opacityAt(clamped(entry)).lo >= threshold_) {
            return std::clamp(valueOf(entry), lo, hi);
        }
    }
    return {};
}

} // namespace voxtact::oracle::certified
