// SPDX-License-Identifier: MIT
#pragma once

#include "host/cancel.h"
#include "host/overlap/sheet.h"
#include "host/search/mesh_place.h"
#include "host/touch/cells/cell_box.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <vector>

namespace voxtact::cpu {

/// The sheets of one cell, or those in front of the image in a row of cells.
struct CrossedCell {
    static constexpr std::int32_t kFront = -1;

    std::int32_t x = 0; ///< padded number, or kFront
    std::uint32_t first = 0;
    std::uint32_t end = 0;   ///< PairSurface::sheet()
    double area = 0;         ///< of the sheets, times their jumps; voxels
    double volume = 0;       ///< of the space from them to the cell's end
    double unknown = 0;      ///< area of those whose jump is unknown
    bool meetsFront = false; ///< a sheet is at the face that the cell begins with, along x, or as good as at it
    bool meetsBack = false;  ///< the same of the face that it ends with
    Jump behind = 0;         ///< the solid's winding behind the cell, where its run ends
};

/// Cells along x that have sheets. A run of them are such that follow each other and have sheets at the faces between:
/// in front of a run the solid's winding is the same all over.
struct CrossedRow {
    std::int32_t y = 0;
    std::int32_t z = 0;
    std::uint32_t first = 0;
    std::uint32_t end = 0; ///< PairSurface::cells()
};

/// The surface of a solid at its pose, cut to the cells of a volume. One thread's; kept from pair to pair for its
/// memory.
class PairSurface {
  public:
    /// The mesh is in place. All must live until the next call. `isMirrored`: the pose turns the triangles over.
    void begin(const SolidSurface& solid, MeshPlace& mesh, const VolumeImpl& volume, const VolumeSpace& space,
               bool isMirrored, CancelFlag cancel);

    [[nodiscard]] const std::vector<CrossedRow>& rows() const noexcept { return rows_; }
    [[nodiscard]] const std::vector<CrossedCell>& cells() const noexcept { return cells_; }
    void sheet(std::uint32_t number, Sheet& out) const noexcept { sheets_.get(records_[number].sheet, out); }
    /// No corner of a sheet is off by more, voxels, but for MeshPlace::error().
    [[nodiscard]] double rounding() const noexcept { return rounding_; }
    /// No place is off by more, voxels.
    [[nodiscard]] double reach() const noexcept { return reach_; }
    /// Maximum change of a volume by MeshPlace::error(), mm^3.
    [[nodiscard]] double displaced() const noexcept { return displaced_; }
    /// Returns true if the surface outside the image is within the error of its faces.
    [[nodiscard]] bool grazes() const noexcept { return grazes_; }

    enum class Place : std::uint8_t { Outside, Inside, Crossed, Unknown };
    /// Position of a cell.
    [[nodiscard]] Place at(const std::array<std::int32_t, 3>& cell) const noexcept;
    /// The bricks around all crossed cells and those between; none where there are no such.
    [[nodiscard]] BrickBox bricks() const noexcept;
    /// Calls `visit(cell)` for cells that are no farther from a sheet's than `reach`; some more than once.
    template <class Visit> void forEachNear(double reach, const Visit& visit) const {
        Sheet sheet;
        for (const CrossedRow& row : rows_) {
            for (std::uint32_t i = row.first; i < row.end; ++i) {
                for (std::uint32_t number = cells_[i].first; number < cells_[i].end; ++number) {
                    this->sheet(number, sheet);
                    visitNear({cells_[i].x, row.y, row.z}, sheet, reach, visit);
                }
            }
        }
    }

    /// Calls `crossed(row, cell, run, base)` for each crossed cell: `run` is the first cell of its run, and `base` the
    /// winding in front of that; and `gap(row, first, last, winding)` for the cells
    /// between, if the winding is not 0.
    template <class Crossed, class Gap> void walk(const Crossed& crossed, const Gap& gap) const {
        for (const CrossedRow& row : rows_) {
            walkRow(row, crossed, gap);
        }
    }

  private:
    struct Record {
        std::uint64_t key = 0;
        std::uint32_t sheet = 0;
        Jump jump = 0;
        bool meetsFront = false;
        bool meetsBack = false;
        double area = 0;
        double volume = 0;
    };

    template <class Crossed, class Gap>
    void walkRow(const CrossedRow& row, const Crossed& crossed, const Gap& gap) const {
        Jump base = 0;
        for (std::uint32_t run = row.first; run < row.end;) {
            const std::uint32_t end = endOfRun(row, run);
            for (std::uint32_t cell = run; cell < end; ++cell) {
                if (cells_[cell].x != CrossedCell::kFront) {
                    crossed(row, cell, run, base);
                }
            }
            base = cells_[end - 1].behind;
            const std::int32_t next = end < row.end ? cells_[end].x : size_[0] + 1;
            if (base != 0 && cells_[end - 1].x + 1 < next) {
                gap(row, cells_[end - 1].x + 1, next - 1, base);
            }
            run = end;
        }
    }

    template <class Visit>
    void visitNear(const std::array<std::int32_t, 3>& cell, const Sheet& sheet, double reach,
                   const Visit& visit) const {
        std::array<std::int32_t, 3> first{};
        std::array<std::int32_t, 3> last{};
        for (std::size_t axis = 0; axis < 3; ++axis) {
            double lo = 0;
            double hi = 0;
            sheet.range(static_cast<int>(axis), lo, hi);
            if (cell[axis] == CrossedCell::kFront) {
                last[axis] = hi + reach < 0.5 ? -1 : 0;
                continue;
            }
            first[axis] = std::max(cell[axis] - (lo - reach < cell[axis] ? 1 : 0), 0);
            last[axis] = std::min(cell[axis] + (hi + reach > cell[axis] + 1 ? 1 : 0), size_[axis]);
        }
        for (std::int32_t z = first[2]; z <= last[2]; ++z) {
            for (std::int32_t y = first[1]; y <= last[1]; ++y) {
                for (std::int32_t x = first[0]; x <= last[0]; ++x) {
                    const std::array<std::int32_t, 3> near{x, y, z};
                    if (near != cell && meets(sheet, near, reach)) {
                        visit(near);
                    }
                }
            }
        }
    }
    /// Returns true if a sheet reaches into a cell enlarged by `reach` on all sides.
    [[nodiscard]] static bool meets(const Sheet& sheet, const std::array<std::int32_t, 3>& cell,
                                    double reach) noexcept {
        Sheet left = sheet;
        Sheet part;
        Sheet rest;
        for (int axis = 0; axis < 3; ++axis) {
            const double at = cell[static_cast<std::size_t>(axis)];
            cut(left, axis, at - reach, rest, part);
            if (part.empty()) {
                return false;
            }
            cut(part, axis, at + 1 + reach, left, rest);
            if (left.empty()) {
                return false;
            }
        }
        return true;
    }
    [[nodiscard]] std::uint32_t endOfRun(const CrossedRow& row, std::uint32_t run) const noexcept {
        std::uint32_t end = run + 1;
        while (end < row.end && cells_[end].x == cells_[end - 1].x + 1 &&
               (cells_[end - 1].meetsBack || cells_[end].meetsFront)) {
            ++end;
        }
        return end;
    }
    void setWindings();
    [[nodiscard]] Jump behind(const CrossedRow& row, std::uint32_t first, std::uint32_t end, Jump base) const noexcept;
    void addTriangle(const WorldTriangle& corners, Jump jump, const UvPolygon& polygon);
    [[nodiscard]] glm::dvec3 toPadded(const glm::dvec3& local) const noexcept {
        return space_->toVoxel(local) + space_->centre + 1.0;
    }
    void cutAlong(const Sheet& sheet, int axis, std::array<std::int32_t, 3>& cell);
    void add(const Sheet& sheet, const std::array<std::int32_t, 3>& cell);
    void sortRecords();
    void sortIntoRows();

    const VolumeSpace* space_ = nullptr;
    std::array<std::int32_t, 3> size_{};
    double rounding_ = 0;
    double displaced_ = 0;
    double reach_ = 0; ///< voxels: no place is off by more
    bool grazes_ = false;
    SheetList sheets_;
    std::vector<Record> records_;
    std::vector<Record> sorted_;
    std::vector<std::uint32_t> starts_; ///< of rows
    std::vector<CrossedCell> cells_;
    std::vector<CrossedRow> rows_;
};

} // namespace voxtact::cpu
