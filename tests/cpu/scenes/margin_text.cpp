// SPDX-License-Identifier: MIT
#include "cpu/scenes/margin_text.h"

#include "certified_margin_look.h"
#include "core/method/certified_constants.h"
#include "core/transfer/table_extremes.h"
#include "core/volume/bricks.h"
#include "cpu/scene/scene_impl.h"
#include "cpu/scene/stored_voxels.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace voxtact::test {
namespace {

using VoxelPlace = std::array<std::int32_t, 3>;

/// The stored values of an image, and the ranges around bricks as shaders/bricks.comp has them.
class Stored {
  public:
    explicit Stored(const cpu::VolumeImpl& volume) : volume_(&volume) {}

    [[nodiscard]] std::int32_t size(std::size_t axis) const {
        return static_cast<std::int32_t>(volume_->grid.size[axis]);
    }
    [[nodiscard]] float at(const VoxelPlace& voxel) const {
        std::int64_t offset = 0;
        for (std::size_t axis = 0; axis < 3; ++axis) {
            offset += (std::clamp(voxel[axis], 0, size(axis) - 1) + std::int64_t{1}) *
                      (axis == 0 ? 1 : static_cast<std::int64_t>(volume_->image.stride[axis]));
        }
        return volume_->image.visit([&](const auto* voxels) { return cpu::storedValue(voxels[offset]); });
    }
    /// Of the voxels from `lo` to `hi`, those in the image.
    [[nodiscard]] std::array<float, 2> range(VoxelPlace lo, VoxelPlace hi) const {
        std::array<float, 2> out{std::numeric_limits<float>::infinity(), -std::numeric_limits<float>::infinity()};
        for (std::size_t axis = 0; axis < 3; ++axis) {
            lo[axis] = std::max(lo[axis], 0);
            hi[axis] = std::min(hi[axis], size(axis) - 1);
        }
        for (std::int32_t z = lo[2]; z <= hi[2]; ++z) {
            for (std::int32_t y = lo[1]; y <= hi[1]; ++y) {
                for (std::int32_t x = lo[0]; x <= hi[0]; ++x) {
                    const float stored = at({x, y, z});
                    if (!std::isnan(stored)) {
                        out = {std::min(out[0], stored), std::max(out[1], stored)};
                    }
                }
            }
        }
        return out;
    }
    [[nodiscard]] std::array<float, 2> brickRange(const VoxelPlace& brick, std::int32_t wider) const {
        const VoxelPlace lo{brick[0] * 8 - 1 - wider, brick[1] * 8 - 1 - wider, brick[2] * 8 - 1 - wider};
        return range(lo, {lo[0] + 8 + 2 * wider, lo[1] + 8 + 2 * wider, lo[2] + 8 + 2 * wider});
    }

  private:
    const cpu::VolumeImpl* volume_;
};

struct Decider {
    Stored stored;
    shader::CertifiedItem item{};
    shader::OpacityTable table{};
    shader::MarginSpace by{};
    bool whole = false;
    MarginVerdict out{};

    void take(int verdict) {
        if (verdict == CERTIFIED_CERTAIN || out.verdict == CERTIFIED_NONE) {
            out.verdict = verdict;
        }
    }

    void cell(const shader::CertifiedTriangle& triangle, const VoxelPlace& at, const std::array<float, 2>& wide) {
        ++out.cells;
        const shader::VoxelPoint corner{static_cast<float>(at[0]), static_cast<float>(at[1]),
                                        static_cast<float>(at[2])};
        std::array<float, 8> values{};
        for (int i = 0; i < 8; ++i) {
            values[static_cast<std::size_t>(i)] =
                stored.at({at[0] + (i & 1), at[1] + ((i >> 1) & 1), at[2] + (i >> 2)});
        }
        const shader::CertifiedCorners corners{values[0], values[1], values[2], values[3], values[4],
                                               values[5], values[6], values[7], wide[0],   wide[1]};
        const shader::CertifiedCell known = shader::certifiedCell(item, corners, at[0], at[1], at[2], triangle.delta);
        if (!whole && !shader::marginCellMay(table, known)) {
            return;
        }
        const int look = whole ? CERTIFIED_UNDECIDED
                               : shader::marginCellLook(by, item, triangle, shader::marginCellHas(table, known), at[0],
                                                        at[1], at[2]);
        if (look == CERTIFIED_UNDECIDED) {
            ++out.decided;
        }
        take(look == CERTIFIED_UNDECIDED ? shader::marginDecide(table, by, triangle, known, corner) : look);
    }

    void brick(const shader::CertifiedTriangle& triangle, const VoxelPlace& at, const shader::CertifiedBounds& bounds) {
        const std::array<float, 2> inside = stored.brickRange(at, 0);
        if (!shader::certifiedRangeMayBeOpaque(table, item, inside[0], inside[1])) {
            return;
        }
        if (!bounds.usable) {
            take(CERTIFIED_UNDECIDED);
            return;
        }
        const auto middle = [&](std::size_t axis) { return static_cast<float>(at[axis] * 8 - 1) + 4; };
        if (!whole && shader::marginCubeBeyond(by, triangle, {middle(0), middle(1), middle(2)}, 4)) {
            return;
        }
        const VoxelPlace first{bounds.firstX, bounds.firstY, bounds.firstZ};
        const VoxelPlace last{bounds.lastX, bounds.lastY, bounds.lastZ};
        const auto lo = [&](std::size_t axis) { return std::max(first[axis], at[axis] * 8 - 1); };
        const auto hi = [&](std::size_t axis) { return std::min(last[axis], at[axis] * 8 + 6); };
        const std::array<float, 2> wide = stored.brickRange(at, 1);
        for (std::int32_t z = lo(2); z <= hi(2); ++z) {
            for (std::int32_t y = lo(1); y <= hi(1); ++y) {
                for (std::int32_t x = lo(0); x <= hi(0); ++x) {
                    cell(triangle, {x, y, z}, wide);
                }
            }
        }
    }

    void triangle(const std::array<shader::CertifiedVertex, 3>& at) {
        shader::CertifiedBounds bounds = shader::marginBounds(item, by, shader::certifiedReach(at[0], at[1], at[2]));
        if (whole) {
            bounds.firstX = bounds.firstY = bounds.firstZ = -1;
            bounds.lastX = item.sizeX - 1;
            bounds.lastY = item.sizeY - 1;
            bounds.lastZ = item.sizeZ - 1;
        }
        if (bounds.lastX < bounds.firstX || bounds.lastY < bounds.firstY || bounds.lastZ < bounds.firstZ) {
            return; // nothing within reach, be it placed ever so badly
        }
        const shader::CertifiedTriangle placed =
            shader::certifiedTriangle(at[0].point, at[1].point, at[2].point, bounds.delta);
        for (std::int32_t z = (bounds.firstZ + 1) >> 3; z <= (bounds.lastZ + 1) >> 3; ++z) {
            for (std::int32_t y = (bounds.firstY + 1) >> 3; y <= (bounds.lastY + 1) >> 3; ++y) {
                for (std::int32_t x = (bounds.firstX + 1) >> 3; x <= (bounds.lastX + 1) >> 3; ++x) {
                    brick(placed, {x, y, z}, bounds);
                }
            }
        }
    }
};

} // namespace

MarginVerdict marginVerdict(const MeshView& mesh, const cpu::Volume& volume, const cpu::TransferFunction& function,
                            const Mat4& world_from_object, double threshold, double margin, bool whole) {
    const cpu::VolumeImpl& image = volume.impl();
    const cpu::TransferFunctionImpl& opacity = function.impl();
    const TableExtremes extremes(opacity.table);
    Decider decider{.stored = Stored(image)};
    decider.item = withMargin(certifiedItem(image.grid, 1, image.storedIntercept, opacity.domain, opacity.table.size(),
                                            threshold, kDefaultResolution),
                              image.grid, margin);
    decider.table = {decider.item.tableSize, decider.item.tableLevels, decider.item.threshold,
                     extremes.values().data()};
    decider.by = shader::marginOf(decider.item);
    decider.whole = whole;
    const shader::CertifiedPair pair = certifiedPair(image.pairGrid, world_from_object);
    for (std::size_t i = 0; i + 2 < mesh.indices.size(); i += 3) {
        std::array<shader::CertifiedVertex, 3> at{};
        for (std::size_t corner = 0; corner < 3; ++corner) {
            const float* position = &mesh.positions[std::size_t{3} * mesh.indices[i + corner]];
            at[corner] = shader::certifiedVertex(pair, position[0], position[1], position[2]);
        }
        decider.triangle(at);
    }
    return decider.out;
}

} // namespace voxtact::test
