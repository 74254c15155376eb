// SPDX-License-Identifier: MIT
#include "cpu/motion/bending.h"

#include "core/geometry/shape_between.h"

#include <algorithm>
#include <cmath>

namespace voxtact::cpu {

namespace {

/// Of a coordinate: half a unit in the last place of a float, and what comes before it in double; or, of the smallest,
/// an absolute one. Of three coordinates together less than twice as much.
constexpr double kRelative = 0x1.01p-24;
constexpr double kAbsolute = 0x1p-149;

} // namespace

Bending::Bending(const MeshImpl& mesh, std::span<const float> from, std::span<const float> to)
    : from_(from), to_(to), shape_(mesh) {
    double largest = 0;
    Box& bounds = shape_.facts.bounds;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        bounds.lo[axis] = bounds.hi[axis] = static_cast<double>(from[axis]);
    }
    for (const std::span<const float> shape : {from, to}) {
        for (std::size_t at = 0; at < shape.size(); ++at) {
            const double coordinate = static_cast<double>(shape[at]);
            bounds.lo[at % 3] = std::min(bounds.lo[at % 3], coordinate);
            bounds.hi[at % 3] = std::max(bounds.hi[at % 3], coordinate);
            largest = std::max(largest, std::abs(coordinate));
        }
    }
    findReach();
    // One that does not bend has the same floats at all parameters.
    rounding_ = reach_.most > 0 ? 2 * (kRelative * largest + kAbsolute) : 0;
}

void Bending::findReach() {
    reach_.vertices.reserve(shape_.vertices.size());
    for (const std::uint32_t vertex : shape_.vertices) {
        double squares = 0;
        for (std::size_t at = std::size_t{3} * vertex; at < std::size_t{3} * vertex + 3; ++at) {
            const double way = static_cast<double>(to_[at]) - static_cast<double>(from_[at]);
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
        shape_.bend(positions_, MeshFacts(shape_.facts));
        parameter_ = parameter;
    }
    return shape_;
}

} // namespace voxtact::cpu
