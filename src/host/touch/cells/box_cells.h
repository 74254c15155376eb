// SPDX-License-Identifier: MIT
#pragma once

#include "exact/certified.h"
#include "host/scene/cluster_tree.h"
#include "host/touch/cells/cell_box.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

namespace voxtact::cpu {

/// The cells that the triangles in boxes of object space may cross: those of certifiedBoxBounds() and some more, with
/// the common work of a mesh's boxes done once.
class BoxCells {
  public:
    /// `pair` must outlive it.
    BoxCells(const shader::CertifiedItem& item, const shader::CertifiedPair& pair, const ClusterTree& tree) noexcept;

    /// False: no box can be tested.
    [[nodiscard]] bool usable() const noexcept { return usable_; }
    /// Voxels: no triangle of the mesh has a larger one.
    [[nodiscard]] float delta() const noexcept { return delta_; }
    /// Returns the cells of one of the tree's boxes. Expects usable().
    [[nodiscard]] CellBox cells(const RunBox& box) const noexcept {
        float from[3];
        float radius[3];
        for (std::size_t axis = 0; axis < 3; ++axis) {
            const float centre = box.lo[axis] * 0.5F + box.hi[axis] * 0.5F;
            radius[axis] = std::max(box.hi[axis] - centre, centre - box.lo[axis]);
            from[axis] = centre - pair_.reference[axis];
        }
        CellBox out;
        for (std::size_t axis = 0; axis < 3; ++axis) {
            const auto& row = pair_.voxel_from_reference[axis];
            const float middle = shader::exactDot(row, from[0], from[1], from[2]);
            const float extent =
                std::abs(row[0]) * radius[0] + std::abs(row[1]) * radius[1] + std::abs(row[2]) * radius[2];
            setCells(middle - extent - delta_, middle + extent + delta_, axis, out);
        }
        return out;
    }

  private:
    /// Same as certifiedCells().
    void setCells(float from, float to, std::size_t axis, CellBox& out) const noexcept {
        const float last = last_[axis];
        if (to < -0.5F || from > last + 0.5F) {
            out.lo[axis] = 0;
            out.hi[axis] = -1;
            return;
        }
        out.lo[axis] = from >= 0 ? static_cast<std::int32_t>(std::min(from, last)) : -1;
        out.hi[axis] = to >= 0 ? static_cast<std::int32_t>(std::min(to, last)) : -1;
    }

    const shader::CertifiedPair& pair_;
    std::array<float, 3> last_; ///< cell of each axis
    float delta_ = 0;
    bool usable_ = false;
};

} // namespace voxtact::cpu
