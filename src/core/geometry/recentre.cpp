// SPDX-License-Identifier: MIT
#include "core/geometry/recentre.h"
#include "core/base/infinity.h"
#include "core/geometry/wide_matrix.h"

#include <algorithm>
#include <cmath>

namespace voxtact {

namespace {

/// Returns the distance of a float from value - offset, including the rounding of the difference to double.
double roundingOf(double value, double offset, double difference, float rounded) {
    const double back = difference + offset;
    const double lost = std::abs((value - back) - ((difference - back) + offset));
    return std::abs(difference - static_cast<double>(rounded)) + lost;
}

Box boundsOf(std::span<const double> positions) {
    Box bounds{{kInfinity, kInfinity, kInfinity}, {-kInfinity, -kInfinity, -kInfinity}};
    for (std::size_t i = 0; i < positions.size(); ++i) {
        bounds.lo[i % 3] = std::min(bounds.lo[i % 3], positions[i]);
        bounds.hi[i % 3] = std::max(bounds.hi[i % 3], positions[i]);
    }
    return bounds;
}

} // namespace

Vec3 offsetOf(const Box& bounds) {
    double extent = 0;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        extent = std::max(extent, bounds.hi[axis] - bounds.lo[axis]);
    }
    Vec3 offset{};
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const double centre = bounds.lo[axis] / 2 + bounds.hi[axis] / 2;
        if (std::abs(centre) > extent) {
            // Few bits, so that sums and products with it rarely round.
            const double unit = std::exp2(std::ilogb(std::max(extent / 8, std::abs(centre) * 0x1p-20)));
            offset[axis] = std::round(centre / unit) * unit;
        }
    }
    return offset;
}

double roundPositions(std::span<const double> positions, const Vec3& offset, std::vector<float>& out) {
    out.resize(positions.size());
    double most = 0;
    for (std::size_t i = 0; i < positions.size(); i += 3) {
        Vec3 off{};
        for (std::size_t axis = 0; axis < 3; ++axis) {
            const double difference = positions[i + axis] - offset[axis];
            out[i + axis] = static_cast<float>(difference);
            off[axis] = roundingOf(positions[i + axis], offset[axis], difference, out[i + axis]);
        }
        if (off != Vec3{}) {
            most = std::max(most, std::hypot(off[0], off[1], off[2]));
        }
    }
    return most * (1 + 0x1p-40);
}

Recentred recentred(std::span<const double> positions) {
    Recentred out;
    out.origin.rounding = roundPositions(positions, {}, out.positions);
    if (out.origin.rounding == 0) {
        return out;
    }
    out.origin.offset = offsetOf(boundsOf(positions));
    if (out.origin.offset != Vec3{}) {
        out.origin.rounding = roundPositions(positions, out.origin.offset, out.positions);
    }
    return out;
}

Mat4 worldFromFloats(const Mat4& world_from_object, const MeshOrigin& origin) noexcept {
    return toMat4(shader::pairWorldFromFloats(toWide(world_from_object), toPairOrigin(origin)));
}

} // namespace voxtact
