// SPDX-License-Identifier: MIT
#pragma once

#include "host/scene/stored_voxels.h"
#include "host/touch/cells/brick_rows.h"
#include "host/touch/certified_pair.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <optional>

namespace voxtact::cpu {

/// The cells of a job's volume that may have an opaque point. `Kept`: how its voxels are kept.
template <class Kept> class VolumeCells {
    using Place = std::array<std::int32_t, 3>;

  public:
    /// Both must outlive it.
    VolumeCells(const CertifiedJob& job, const Kept* voxels)
        : volume_(job.volume), occupancy_(job.occupancy), voxels_(voxels), item_(job.occupancy.item()) {}

    /// A number within a brick as one of the volume's cells.
    [[nodiscard]] static std::int32_t cellOf(const Place& brick, std::int32_t number, std::size_t axis) {
        return (brick[axis] << kBrickShift) - 1 + number;
    }

    /// Expects one that may have an opaque point.
    [[nodiscard]] const BrickCells& ofBrick(const Place& brick) const { return occupancy_.cells(volume_, brick); }
    [[nodiscard]] const BrickCells& ofCell(const Place& cell) const { return ofBrick(CellBox{cell, cell}.bricks().lo); }

    /// Calls `visit(brick)` for those bricks that may have an opaque point, as long as `goesOn()`.
    template <class GoesOn, class Visit>
    void forBricks(const BrickBox& bricks, const GoesOn& goesOn, const Visit& visit) const {
        for (std::int32_t z = bricks.lo[2]; z <= bricks.hi[2]; ++z) {
            for (std::int32_t y = bricks.lo[1]; y <= bricks.hi[1]; ++y) {
                forRow({bricks.lo[0], bricks.hi[0]}, y, z, goesOn, visit);
            }
        }
    }
    /// Like forBricks(), for the bricks that a large triangle may pass through, in the same order.
    template <class GoesOn, class Visit>
    void forBricks(const BrickRows& bricks, const BrickBox& box, const GoesOn& goesOn, const Visit& visit) const {
        for (std::int32_t z = box.lo[2]; z <= box.hi[2]; ++z) {
            const BrickRows::Piece layer = bricks.layer(z);
            const BrickRows::Span rows = bricks.rows(layer);
            for (std::int32_t y = rows.first; y <= rows.last && goesOn(); ++y) {
                forRow(bricks.row(layer, y), y, z, goesOn, visit);
            }
        }
    }
    /// Calls `visit(x, y, z, known)` for those cells of a box, as long as `goesOn()` says so from brick to brick.
    template <class GoesOn, class Visit>
    void forCells(const CellBox& cells, const GoesOn& goesOn, const Visit& visit) const {
        forBricks(cells.bricks(), goesOn, [&](const Place& brick) {
            const BrickCells& known = ofBrick(brick);
            const CellBox within = cells.within(brick);
            for (std::int32_t z = within.lo[2]; z <= within.hi[2]; ++z) {
                for (std::int32_t y = within.lo[1]; y <= within.hi[1]; ++y) {
                    for (unsigned row = known.row(within, y, z); row != 0; row &= row - 1) {
                        visit(cellOf(brick, std::countr_zero(row), 0), cellOf(brick, y, 1), cellOf(brick, z, 2), known);
                    }
                }
            }
        });
    }

    [[nodiscard]] shader::CertifiedCorners corners(std::int32_t x, std::int32_t y, std::int32_t z,
                                                   const BrickCells& known) const {
        const auto& stride = volume_.image.stride;
        const Kept* at = voxels_ + (x + 1) + (y + 1) * stride[1] + (z + 1) * stride[2];
        const auto stored = [&](std::int64_t offset) { return storedValue(at[offset]); };
        return {stored(0),
                stored(1),
                stored(stride[1]),
                stored(stride[1] + 1),
                stored(stride[2]),
                stored(stride[2] + 1),
                stored(stride[2] + stride[1]),
                stored(stride[2] + stride[1] + 1),
                known.wideLo,
                known.wideHi};
    }
    /// Like corners(), with the range of the voxels around this cell alone: one voxel of a brick may be far from all
    /// others.
    [[nodiscard]] shader::CertifiedCorners cornersAround(std::int32_t x, std::int32_t y, std::int32_t z,
                                                         const BrickCells& known) const;
    [[nodiscard]] shader::CertifiedCell cell(std::int32_t x, std::int32_t y, std::int32_t z, const BrickCells& known,
                                             float delta) const {
        return shader::certifiedCell(item_, corners(x, y, z, known), x, y, z, delta);
    }

    /// The cell that a vertex is in, if that may have an opaque point.
    [[nodiscard]] std::optional<Place> cellWith(const shader::VoxelPoint& vertex) const;
    /// Returns true if a vertex alone proves a touch; `delta` is at least that of a triangle with this vertex.
    [[nodiscard]] bool vertexProves(const shader::VoxelPoint& vertex, float delta, shader::CertifiedProof* proof) const;

  private:
    template <class GoesOn, class Visit>
    void forRow(const BrickRows::Span& row, std::int32_t y, std::int32_t z, const GoesOn& goesOn,
                const Visit& visit) const {
        for (std::int32_t x = row.first; x <= row.last && goesOn(); ++x) {
            if (occupancy_.mayBeOpaque(occupancy_.brickNumber({x, y, z}))) {
                visit(Place{x, y, z});
            }
        }
    }

    const VolumeImpl& volume_;
    const CertifiedOccupancy& occupancy_;
    const Kept* voxels_;
    shader::CertifiedItem item_;
};

template <class Kept>
shader::CertifiedCorners VolumeCells<Kept>::cornersAround(std::int32_t x, std::int32_t y, std::int32_t z,
                                                          const BrickCells& known) const {
    const shader::CertifiedCorners inBrick = corners(x, y, z, known);
    shader::CertifiedCorners around = inBrick;
    around.wideLo = inBrick.wideHi;
    around.wideHi = inBrick.wideLo;
    // The border that the kept image has is one voxel wide.
    const auto place = [](std::int32_t of, std::int32_t size) { return std::clamp(of + 1, 0, size + 1); };
    for (std::int32_t i = 0; i < 64; ++i) {
        const Kept* at = voxels_ + place(x - 1 + (i & 3), item_.sizeX) +
                         place(y - 1 + (i >> 2 & 3), item_.sizeY) * volume_.image.stride[1] +
                         place(z - 1 + (i >> 4), item_.sizeZ) * volume_.image.stride[2];
        around.wideLo = shader::certifiedMin(around.wideLo, storedValue(*at));
        around.wideHi = shader::certifiedMax(around.wideHi, storedValue(*at));
    }
    return around.wideLo <= around.wideHi ? around : inBrick; // if all are NaN
}

template <class Kept> auto VolumeCells<Kept>::cellWith(const shader::VoxelPoint& vertex) const -> std::optional<Place> {
    const std::array<int, 3> size{item_.sizeX, item_.sizeY, item_.sizeZ};
    Place cell{};
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const float at = voxelAlong(vertex, static_cast<int>(axis));
        if (!(at >= -0.5F && at <= static_cast<float>(size[axis]) - 0.5F)) {
            return std::nullopt;
        }
        cell[axis] = std::min(at < 0 ? -1 : static_cast<std::int32_t>(at), size[axis] - 1);
    }
    const Place brick = CellBox{cell, cell}.bricks().lo;
    if (!occupancy_.mayBeOpaque(occupancy_.brickNumber(brick)) || !ofBrick(brick).has(cell)) {
        return std::nullopt;
    }
    return cell;
}

template <class Kept>
bool VolumeCells<Kept>::vertexProves(const shader::VoxelPoint& vertex, float delta,
                                     shader::CertifiedProof* proof) const {
    const std::optional<Place> place = cellWith(vertex);
    if (!place) {
        return false;
    }
    const BrickCells& known = ofCell(*place);
    const auto [x, y, z] = *place;
    shader::CertifiedWitness witness;
    if (!shader::certifiedVertexProves(occupancy_.opaque(), cell(x, y, z, known, delta), vertex, x, y, z, witness)) {
        return false;
    }
    if (proof != nullptr) {
        *proof = shader::certifiedProof(occupancy_.opaque(), item_, corners(x, y, z, known), witness, x, y, z);
    }
    return true;
}

} // namespace voxtact::cpu
