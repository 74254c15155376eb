// SPDX-License-Identifier: MIT
#include "oracle/oracle_sample.h"
#include "core/base/infinity.h"

#include <algorithm>
#include <cmath>
#include <cstring>

namespace voxtact::oracle {

namespace {

/// The roundings of a chain of interpolations in single precision, and of what leads from one look-up to the next.
constexpr double kChainRoundings = 8;

using Cell = std::array<std::int64_t, 3>;

template <class Scalar> double load(const VolumeView& volume, std::size_t voxel) {
    Scalar scalar;
    std::memcpy(&scalar, volume.voxels.data() + voxel * sizeof scalar, sizeof scalar);
    return static_cast<double>(scalar);
}

/// Outside the image: the nearest voxel.
double voxelAt(const VolumeView& volume, const Cell& index) {
    std::size_t at = 0;
    for (std::size_t axis = 3; axis-- > 0;) {
        const std::int64_t last = std::int64_t{volume.grid.size[axis]} - 1;
        at = at * volume.grid.size[axis] + static_cast<std::size_t>(std::clamp<std::int64_t>(index[axis], 0, last));
    }
    switch (volume.type) {
    case ScalarType::UInt8:
        return load<std::uint8_t>(volume, at);
    case ScalarType::Int16:
        return load<std::int16_t>(volume, at);
    case ScalarType::UInt16:
        return load<std::uint16_t>(volume, at);
    case ScalarType::Float32:
        break;
    }
    return load<float>(volume, at);
}

/// The eight voxels of a cell, the one with the lowest numbers first, x fastest.
std::array<double, 8> voxelsOf(const VolumeView& volume, const Cell& cell) {
    std::array<double, 8> out{};
    for (std::size_t corner = 0; corner < 8; ++corner) {
        out[corner] = voxelAt(volume, {cell[0] + ((corner & 1) != 0 ? 1 : 0), cell[1] + ((corner & 2) != 0 ? 1 : 0),
                                       cell[2] + ((corner & 4) != 0 ? 1 : 0)});
    }
    return out;
}

double interpolate(const std::array<double, 8>& voxels, const Vec3& fraction) {
    double out = 0;
    for (std::size_t corner = 0; corner < 8; ++corner) {
        double weight = 1;
        for (std::size_t axis = 0; axis < 3; ++axis) {
            weight *= (corner >> axis & 1) != 0 ? fraction[axis] : 1 - fraction[axis];
        }
        out += weight * voxels[corner];
    }
    return out;
}

/// Voxel numbers: voxel i's centre is at i.
double indexOf(const Grid& grid, std::size_t axis, double coordinate) {
    return std::clamp(coordinate, 0.0, 1.0) * grid.size[axis] - 0.5;
}

struct Values {
    double lo = kInfinity;
    double hi = -kInfinity;
    double magnitude = 0; ///< of the voxels behind them
};

void takeCell(const VolumeView& volume, const Cell& cell, const Vec3& lo, const Vec3& hi, Values& values) {
    const std::array<double, 8> voxels = voxelsOf(volume, cell);
    for (const double voxel : voxels) {
        values.magnitude = std::max(values.magnitude, std::abs(voxel));
    }
    for (std::size_t corner = 0; corner < 8; ++corner) {
        Vec3 fraction{};
        for (std::size_t axis = 0; axis < 3; ++axis) {
            const auto first = static_cast<double>(cell[axis]);
            fraction[axis] = std::clamp(((corner >> axis & 1) != 0 ? hi[axis] : lo[axis]) - first, 0.0, 1.0);
        }
        const double value = interpolate(voxels, fraction);
        values.lo = std::min(values.lo, value);
        values.hi = std::max(values.hi, value);
    }
}

Values valuesIn(const VolumeView& volume, const TextureBox& box, double weight) {
    Vec3 lo{};
    Vec3 hi{};
    Cell first{};
    Cell last{};
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const double margin = weight + kChainRoundings * kFloatRounding * volume.grid.size[axis];
        lo[axis] = indexOf(volume.grid, axis, box.lo[axis]) - margin;
        hi[axis] = indexOf(volume.grid, axis, box.hi[axis]) + margin;
        // Beyond the outermost centres nothing changes.
        const double most = volume.grid.size[axis];
        first[axis] = static_cast<std::int64_t>(std::clamp(std::floor(lo[axis]), -1.0, most));
        last[axis] = static_cast<std::int64_t>(std::clamp(std::floor(hi[axis]), -1.0, most));
    }
    Values values;
    Cell cell{};
    for (cell[2] = first[2]; cell[2] <= last[2]; ++cell[2]) {
        for (cell[1] = first[1]; cell[1] <= last[1]; ++cell[1]) {
            for (cell[0] = first[0]; cell[0] <= last[0]; ++cell[0]) {
                takeCell(volume, cell, lo, hi, values);
            }
        }
    }
    return values;
}

double entryAt(const Table& table, double value) {
    const double scalar = (value - table.domain.lo) / (table.domain.hi - table.domain.lo);
    return scalar * static_cast<double>(table.entries.size()) - 0.5;
}

/// At a place counted in entries.
double opacityAt(const Table& table, double entry) {
    const auto last = static_cast<double>(table.entries.size() - 1);
    const double at = std::clamp(entry, 0.0, last);
    const double below = std::min(std::floor(at), last - 1);
    const auto i = static_cast<std::size_t>(below);
    const auto a = static_cast<double>(table.entries[i]);
    const auto b = static_cast<double>(table.entries[i + 1]);
    return a + (at - below) * (b - a);
}

/// Voxels that are stored with an offset on the device are large numbers there, whatever they mean.
double storedOffset(ScalarType type) {
    return type == ScalarType::Int16 ? 65536 : 0;
}

} // namespace

double sampleVolume(const VolumeView& volume, const Vec3& coordinate) {
    Cell cell{};
    Vec3 fraction{};
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const double index = indexOf(volume.grid, axis, coordinate[axis]);
        cell[axis] = static_cast<std::int64_t>(std::floor(index));
        fraction[axis] = index - std::floor(index);
    }
    return interpolate(voxelsOf(volume, cell), fraction);
}

double lookUp(const Table& table, double value) {
    return opacityAt(table, entryAt(table, value));
}

ValueRange opacityRange(const VolumeView& volume, const Table& table, const TextureBox& box,
                        const SampleTolerance& tolerance) {
    const Values values = valuesIn(volume, box, tolerance.weight);
    const double rounding =
        kChainRoundings * kFloatRounding * (values.magnitude + storedOffset(volume.type) + std::abs(table.domain.lo));
    const auto entries = static_cast<double>(table.entries.size());
    const double margin = tolerance.weight + kChainRoundings * kFloatRounding * entries;
    const double lo = std::clamp(entryAt(table, values.lo - tolerance.value - rounding) - margin, 0.0, entries - 1);
    const double hi = std::clamp(entryAt(table, values.hi + tolerance.value + rounding) + margin, 0.0, entries - 1);
    ValueRange range;
    range.lo = std::min(opacityAt(table, lo), opacityAt(table, hi));
    range.hi = std::max(opacityAt(table, lo), opacityAt(table, hi));
    for (double entry = std::ceil(lo); entry <= hi; ++entry) {
        range.lo = std::min(range.lo, opacityAt(table, entry));
        range.hi = std::max(range.hi, opacityAt(table, entry));
    }
    range.lo -= kChainRoundings * kFloatRounding * range.lo;
    range.hi += kChainRoundings * kFloatRounding * range.hi;
    return range;
}

} // namespace voxtact::oracle
