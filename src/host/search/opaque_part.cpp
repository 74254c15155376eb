// SPDX-License-Identifier: MIT
#include "host/search/opaque_part.h"
#include "host/scene/stored_voxels.h"
#include "host/search/cells/piece_rows.h"

#include <algorithm>
#include <cmath>

namespace voxtact::cpu {

namespace {

template <class Visit> void forEachNode(const NodePlace& count, const Visit& visit) {
    for (std::int32_t z = 0; z < count[2]; ++z) {
        for (std::int32_t y = 0; y < count[1]; ++y) {
            for (std::int32_t x = 0; x < count[0]; ++x) {
                visit(NodePlace{x, y, z});
            }
        }
    }
}

std::vector<std::uint8_t> wantedBricks(const CertifiedOccupancy& occupancy, std::size_t bricks) {
    std::vector<std::uint8_t> wanted(bricks);
    for (std::size_t brick = 0; brick < bricks; ++brick) {
        wanted[brick] = occupancy.mayBeOpaque(brick) ? 1 : 0;
    }
    return wanted;
}

/// Calls `visit(corner, stored)` for a cell's corners.
template <class Visit> void forCorners(const StoredImage& image, const NodePlace& padded, const Visit& visit) {
    image.visit([&](const auto* voxels) {
        const auto* first = voxels + padded[0] + padded[1] * image.stride[1] + padded[2] * image.stride[2];
        for (std::size_t i = 0; i < 8; ++i) {
            const std::int64_t offset =
                ((i & 1U) != 0 ? 1 : 0) + ((i & 2U) != 0 ? image.stride[1] : 0) + ((i & 4U) != 0 ? image.stride[2] : 0);
            visit(i, static_cast<double>(storedValue(first[offset])));
        }
    });
}

} // namespace

BrickPyramid::BrickPyramid(const std::array<std::int32_t, 3>& count, std::vector<std::uint8_t> wanted) {
    levels_.push_back({count, std::move(wanted)});
    while (levels_.back().wanted.size() > 1) {
        const Level& below = levels_.back();
        Level level;
        for (std::size_t axis = 0; axis < 3; ++axis) {
            level.count[axis] = (below.count[axis] + 1) / 2;
        }
        level.wanted.resize(numberOf(level.count, {0, 0, level.count[2]}));
        forEachNode(below.count, [&](const NodePlace& node) {
            level.wanted[numberOf(level.count, {node[0] / 2, node[1] / 2, node[2] / 2})] |=
                below.wanted[numberOf(below.count, node)];
        });
        levels_.push_back(std::move(level));
    }
}

OpaquePart::OpaquePart(const VolumeImpl& volume, const TransferFunctionImpl& function, double threshold,
                       double resolution)
    : occupancy(volume, function, threshold, resolution), space(volume.grid),
      intervals(function.points, threshold, {1, volume.storedIntercept}),
      pyramid(volume.bricks.count, wantedBricks(occupancy, volume.bricks.lo.size())),
      storedRange{static_cast<double>(*std::ranges::min_element(volume.bricks.lo)),
                  static_cast<double>(*std::ranges::max_element(volume.bricks.hi))} {}

PartCell OpaquePart::cell(const VolumeImpl& volume, const NodePlace& padded) const {
    PartCell out;
    std::array<double, 8> corners{};
    forCorners(volume.image, padded, [&](std::size_t i, double stored) { corners[i] = stored; });
    const auto [lo, hi] = std::ranges::minmax(corners);
    out.error = valueError(lo, hi);
    out.terms = trilinearOf(corners);
    setDomain(volume, padded, out);
    return out;
}

ValueRange OpaquePart::cornerRange(const VolumeImpl& volume, const NodePlace& padded) const {
    std::array<double, 8> corners{};
    forCorners(volume.image, padded, [&](std::size_t i, double stored) { corners[i] = stored; });
    const auto [lo, hi] = std::ranges::minmax(corners);
    return {lo, hi};
}

void OpaquePart::addCell(const VolumeImpl& volume, const NodePlace& padded, PieceRows& rows) const {
    const std::size_t at = rows.count++;
    forCorners(volume.image, padded, [&](std::size_t i, double stored) { rows.terms[i][at] = stored; });
    PartCell cell;
    setDomain(volume, padded, cell);
    for (int axis = 0; axis < 3; ++axis) {
        const auto i = static_cast<std::size_t>(axis);
        rows.cell[i][at] = cell.middle[axis];
        rows.middle[i][at] = cell.domain[axis];
        rows.half[i][at] = cell.half[axis];
    }
}

} // namespace voxtact::cpu
