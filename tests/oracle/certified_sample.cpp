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
/// Of an opacity.
constexpr double kOpacityRoundings = 8;

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

/// At a point, and between two of one opacity, nothing rounds, so that a plateau at the threshold is opaque.
ValueRange Opacity::between(std::size_t i, double lo, double hi) const {
    const ControlPoint& a = points_[i];
    const ControlPoint& b = points_[i + 1];
    const auto [least, greatest] = std::minmax(a.opacity, b.opacity);
    ValueRange out{1, 0};
    for (const double value : {std::max(lo, a.value), std::min(hi, b.value)}) {
        const bool atPoint = value == a.value || value == b.value;
        const double opacity =
            value == b.value ? b.opacity : mix(a.opacity, b.opacity, (value - a.value) / (b.value - a.value));
        const double rounding = atPoint ? 0 : kOpacityRoundings * kRounding;
        out.lo = std::min(out.lo, std::max(opacity - rounding, least));
        out.hi = std::max(out.hi, std::min(opacity + rounding, greatest));
    }
    return out;
}

bool Opacity::mayBeOpaque(const ValueRange& values) const {
    if (values.lo < points_.front().value && points_.front().opacity >= threshold_) {
        return true;
    }
    if (values.hi > points_.back().value && points_.back().opacity >= threshold_) {
        return true;
    }
    for (std::size_t i = 0; i < points_.size(); ++i) {
        const ControlPoint& a = points_[i];
        if (a.value >= values.lo && a.value <= values.hi && a.opacity >= threshold_) {
            return true;
        }
        const bool isOn = i + 1 < points_.size() && a.value < values.hi && points_[i + 1].value > values.lo;
        if (isOn && between(i, values.lo, values.hi).hi >= threshold_) {
            return true;
        }
    }
    return false;
}

bool Opacity::allOpaque(const ValueRange& values) const {
    if (values.lo < points_.front().value && points_.front().opacity < threshold_) {
        return false;
    }
    if (values.hi > points_.back().value && points_.back().opacity < threshold_) {
        return false;
    }
    const bool single = values.lo == values.hi;
    bool atPoint = false;
    for (const ControlPoint& point : points_) {
        const bool isHere = point.value >= values.lo && point.value <= values.hi;
        if (isHere && single && point.opacity >= threshold_) {
            return true;
        }
        atPoint = atPoint || isHere;
    }
    if (single && atPoint) {
        return false;
    }
    for (std::size_t i = 0; i + 1 < points_.size(); ++i) {
        const bool isOn =
            points_[i].value < points_[i + 1].value && points_[i].value < values.hi && points_[i + 1].value > values.lo;
        if (isOn && between(i, values.lo, values.hi).lo < threshold_) {
            return false;
        }
    }
    return true;
}

std::optional<double> Opacity::opaqueBetween(double lo, double hi) const {
    for (const ControlPoint& point : points_) {
        if (point.value >= lo && point.value <= hi && point.opacity >= threshold_) {
            return point.value;
        }
    }
    for (const double value : {lo, hi}) {
        if (allOpaque({value, value})) {
            return value;
        }
    }
    return {};
}

} // namespace voxtact::oracle::certified
