// SPDX-License-Identifier: MIT
#include "host/search/cells/volume_boxes.h"
#include "host/search/cells/cell_culling.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <algorithm>
#include <bit>
#include <cmath>

namespace voxtact::cpu {

namespace {

using glm::dot;
using glm::dvec3;

/// Returns the minimum dot product of `along` with a point of a box.
double leastInBox(const dvec3& along, const dvec3& lo, const dvec3& hi) {
    return 0.5 * (dot(along, lo + hi) - dot(glm::abs(along), hi - lo));
}

} // namespace

void VolumeBoxes::begin(const VolumeImpl& volume, const OpaquePart& part, const SearchedPart& searched,
                        const DistanceError& error) noexcept {
    volume_ = &volume;
    part_ = &part;
    searched_ = &searched;
    error_ = error;
}

/// Sets the box of cells in the domain, both ends inclusive.
void VolumeBoxes::set(const NodePlace& first, const NodePlace& last, OpaqueBox& box) const {
    for (int axis = 0; axis < 3; ++axis) {
        const auto at = static_cast<std::size_t>(axis);
        const double reach = part_->space.reach[axis];
        const double centre = part_->space.centre[axis];
        box.lo[axis] = std::max(first[at] - 1 - centre, -reach);
        box.hi[axis] = std::min(last[at] - centre, reach);
    }
}

bool VolumeBoxes::narrow(const CellCube& cube, OpaqueBox& box) const {
    NodePlace first{};
    NodePlace last{};
    NodePlace brick{};
    CellBox inside;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        first[axis] = cube.node[axis] << cube.shift;
        brick[axis] = first[axis] >> kBrickShift;
        last[axis] = std::min(first[axis] + (1 << cube.shift) - 1, volume_->image.size[axis]);
        inside.lo[axis] = first[axis] & (kBrickSide - 1);
        inside.hi[axis] = last[axis] - (brick[axis] << kBrickShift);
    }
    const BrickCells& known = part_->cells(*volume_, brick);
    for (std::size_t axis = 0; axis < 3; ++axis) {
        inside.lo[axis] = std::max(inside.lo[axis], known.around.lo[axis]);
        inside.hi[axis] = std::min(inside.hi[axis], known.around.hi[axis]);
        first[axis] = inside.lo[axis] + (brick[axis] << kBrickShift);
        last[axis] = inside.hi[axis] + (brick[axis] << kBrickShift);
    }
    if (inside.empty() || (cube.shift < kBrickShift && !known.any(inside))) {
        return false;
    }
    set(first, last, box);
    box.known = &known;
    box.cells = inside;
    for (int axis = 0; axis < 3; ++axis) {
        const auto at = static_cast<std::size_t>(axis);
        box.corner[axis] = (brick[at] << kBrickShift) - 1 - part_->space.centre[axis];
    }
    return true;
}

bool VolumeBoxes::whole(const CellCube& cube, OpaqueBox& box) const {
    if (cube.shift >= kBrickShift && !searched_->pyramid().has(cube.shift - kBrickShift, cube.node)) {
        return false;
    }
    NodePlace first{};
    NodePlace last{};
    for (std::size_t axis = 0; axis < 3; ++axis) {
        first[axis] = cube.node[axis] << cube.shift;
        last[axis] = first[axis] + (1 << cube.shift) - 1;
        if (first[axis] > volume_->image.size[axis]) {
            return false;
        }
    }
    set(first, last, box);
    return true;
}

double VolumeBoxes::least(const OpaqueBox& box, const dvec3& normal) const {
    const dvec3 along = normal * part_->space.local_from_voxel;
    const double byBox = leastInBox(along, box.lo, box.hi);
    if (box.known == nullptr || box.cells.single()) {
        return byBox;
    }
    const dvec3 lowest = glm::min(along, dvec3(0));
    return std::max(byBox,
                    dot(along, box.corner) + lowest.x + lowest.y + lowest.z + leastCell(*box.known, box.cells, along));
}

double VolumeBoxes::apart(const OpaqueBox& box, const Direction& along, double reach) const {
    return along.length() > 0 ? error_.below((least(box, along.normal()) - reach) / along.length()) : 0;
}

double VolumeBoxes::wholeApart(const OpaqueBox& box, const Direction& along, double reach) const {
    const double least = leastInBox(along.normal() * part_->space.local_from_voxel, box.lo, box.hi);
    return along.length() > 0 ? error_.below((least - reach) / along.length()) : 0;
}

} // namespace voxtact::cpu
