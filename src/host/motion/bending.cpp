// SPDX-License-Identifier: MIT
#include "host/motion/bending.h"

#include "core/geometry/recentre.h"
#include "core/geometry/shape_between.h"

#include <algorithm>
#include <cmath>

namespace voxtact::cpu {

namespace {

/// Relative error of a coordinate: half a unit in the last place of a float, plus earlier roundings in double; for the
/// smallest numbers, an absolute error. Three coordinates together: less than twice as much.
constexpr double kRelative = 0x1.01p-24;
constexpr double kAbsolute = 0x1p-149;
/// In double, after subtracting an offset: coordinates are at most a few times as large.
constexpr double kOfOffset = 0x1p-48;

} // namespace

Bending::Bending(const MeshImpl& mesh, std::span<const double> from, std::span<const double> to)
    : from_(from), to_(to), shape_(mesh) {
    Box& bounds = shape_.facts.bounds;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        bounds.lo[axis] = bounds.hi[axis] = from[axis];
    }
    for (const std::span<const double> shape : {from, to}) {
        for (std::size_t at = 0; at < shape.size(); ++at) {
            bounds.lo[at % 3] = std::min(bounds.lo[at % 3], shape[at]);
            bounds.hi[at % 3] = std::max(bounds.hi[at % 3], shape[at]);
        }
    }
    const bool areFloats = roundPositions(from, {}, floats_) == 0 && roundPositions(to, {}, floats_) == 0;
    shape_.origin.offset = areFloats ? Vec3{} : offsetOf(bounds);
    findReach();
    // A vertex that does not move has the same floats at all parameters.
    rounding_ = reach_.most > 0 ? 2 * roundingOf(bounds) : 0;
}

/// Returns the maximum rounding error of a coordinate.
double Bending::roundingOf(const Box& bounds) const {
    double largest = 0;
    double offset = 0;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const double by = shape_.origin.offset[axis];
        largest = std::max({largest, std::abs(bounds.lo[axis] - by), std::abs(bounds.hi[axis] - by)});
        offset = std::max(offset, std::abs(by));
    }
    return kRelative * largest + kOfOffset * offset + kAbsolute;
}

void Bending::findReach() {
    reach_.vertices.reserve(shape_.vertices.size());
    for (const std::uint32_t vertex : shape_.vertices) {
        double squares = 0;
        for (std::size_t at = std::size_t{3} * vertex; at < std::size_t{3} * vertex + 3; ++at) {
            const double way = to_[at] - from_[at];
            squares += way * way;
        }
        reach_.vertices.push_back(std::sqrt(squares) * (1 + 0x1p-40));
        reach_.most = std::max(reach_.most, reach_.vertices.back());
    }
    reach_.boxes.resize(shape_.tree.levels());
    for (std::uint32_t level = 0; level < shape_.tree.levels(); ++level) {
        reach_.boxes[level].resize(shape_.tree.boxes(level).size());
    }
    // All clusters but the last are full, so that the runs of a cluster follow those of the one before.
    for (std::size_t cluster = 0; cluster < shape_.clusters.size(); ++cluster) {
        const ClusterPlace& place = shape_.clusters[cluster];
        for (std::uint32_t i = 0; i < place.triangleCount; ++i) {
            const std::size_t at = std::size_t{place.firstTriangle} + i;
            if (shape_.numbers[at] == kNoTriangle) {
                break; // of the padding
            }
            double& run = reach_.boxes[0][cluster * ClusterTree::kRunsOfCluster + i / kRunTriangles];
            for (const std::uint8_t corner : {shape_.corner0[at], shape_.corner1[at], shape_.corner2[at]}) {
                run = std::max(run, reach_.vertices[std::size_t{place.firstVertex} + corner]);
            }
        }
    }
    for (std::uint32_t level = 1; level < shape_.tree.levels(); ++level) {
        const std::vector<double>& below = reach_.boxes[level - 1];
        for (std::size_t node = 0; node < below.size(); ++node) {
            double& above = reach_.boxes[level][node / ClusterTree::kFanOut];
            above = std::max(above, below[node]);
        }
    }
}

const MeshImpl& Bending::at(double parameter) {
    if (parameter != parameter_) {
        fillShapeBetween(from_, to_, parameter, positions_);
        const Vec3 offset = shape_.origin.offset;
        const double rounding = roundPositions(positions_, offset, floats_);
        shape_.bend(floats_, MeshFacts(shape_.facts), {offset, rounding});
        parameter_ = parameter;
    }
    return shape_;
}

} // namespace voxtact::cpu
