// SPDX-License-Identifier: MIT
#include "host/overlap/pair_surface.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <utility>

namespace voxtact::cpu {

namespace {

using glm::dvec3;

/// Bits of a record's key for the place in a row, because kMaxSide is 2^23. Higher bits are the row's number.
constexpr unsigned kRowShift = 24;

/// Relative to the largest coordinate: a corner that was cut a hundred times.
constexpr double kCornerError = 0x1p-44;

double widthOf(std::int32_t cell, std::int32_t size) noexcept {
    return cell == 0 || cell == size ? 0.5 : 1.0;
}

/// mm^3: all that a triangle sweeps when its corners move by `by`.
double sweptBy(const WorldTriangle& corners, double by) noexcept {
    const dvec3 a = corners[1] - corners[0];
    const dvec3 b = corners[2] - corners[0];
    const double around = glm::length(a) + glm::length(b) + glm::length(b - a);
    return by * (0.5 * glm::length(glm::cross(a, b)) + by * around + 4 * by * by) * (1 + 0x1p-40);
}

} // namespace

void PairSurface::begin(const SolidSurface& solid, MeshPlace& mesh, const VolumeImpl& volume, const VolumeSpace& space,
                        bool isMirrored, CancelFlag cancel) {
    space_ = &space;
    size_ = volume.image.size;
    sheets_.clear();
    records_.clear();
    displaced_ = 0;
    double largest = 0;
    const dvec3 offset = space.centre + 1.0;
    const MeshImpl& shape = mesh.mesh();
    const auto isNearImage = [most = space.reach + 0.25](const dvec3& lo, const dvec3& hi) { // more than all errors
        return lo.x <= most.x && lo.y <= most.y && lo.z <= most.z && hi.x >= -most.x && hi.y >= -most.y &&
               hi.z >= -most.z;
    };
    const auto turned = [isMirrored](Jump jump) {
        return static_cast<Jump>(jump == kUnknownJump || isMirrored ? jump : -jump);
    };
    const dvec3 off = 4 * mesh.error() / space.spacing;
    reach_ = std::max({off.x, off.y, off.z}) + 0x1p-30;
    grazes_ = false;
    shape.tree.descend(
        0, static_cast<std::uint32_t>(shape.clusters.size()),
        [&](const RunBox& box) {
            dvec3 lo;
            dvec3 hi;
            mesh.voxelBounds(box, lo, hi);
            largest = std::max({largest, std::abs(lo.x), std::abs(hi.x), std::abs(lo.y), std::abs(hi.y), std::abs(lo.z),
                                std::abs(hi.z)});
            return isNearImage(lo, {space.reach.x, hi.y, hi.z}); // or in front of it
        },
        [&](std::uint32_t run) {
            const std::uint32_t cluster = run / ClusterTree::kRunsOfCluster;
            const std::uint32_t first = run % ClusterTree::kRunsOfCluster * kRunTriangles;
            const PlacedCluster& placed = mesh.cluster(cluster);
            for (std::uint32_t i = 0; i < mesh.count(run); ++i) {
                const std::uint32_t place = mesh.first(run) + i;
                const Jump jump = solid.jumps[place];
                if (jump == 0) {
                    continue;
                }
                const PlacedTriangle triangle = placed.triangle(first + i);
                const WorldTriangle& corners = triangle.corners;
                if (isNearImage(triangle.lo, triangle.hi)) {
                    displaced_ += sweptBy(corners, mesh.error());
                }
                if (jump != kInPieces) {
                    addTriangle(corners, turned(jump), UvPolygon::whole());
                    continue;
                }
                for (const SolidPiece& piece : solid.piecesOf(place)) {
                    addTriangle(corners, turned(piece.jump), piece.polygon);
                }
            }
            return !isCancelled(cancel);
        });
    rounding_ = kCornerError * (largest + 2 * std::max({offset.x, offset.y, offset.z}));
    sortIntoRows();
}

void PairSurface::addTriangle(const WorldTriangle& corners, Jump jump, const UvPolygon& polygon) {
    Sheet sheet;
    sheet.count = polygon.count;
    sheet.jump = jump;
    const std::array<dvec3, 3> places{toPadded(corners[0]), toPadded(corners[1]), toPadded(corners[2])};
    for (std::uint32_t i = 0; i < polygon.count; ++i) {
        const Uv& at = polygon.corners[i];
        sheet.corners[i] =
            at.u == 0 && at.v == 0
                ? places[0]
                : (at.u == 1 && at.v == 0 ? places[1]
                                          : (at.u == 0 && at.v == 1 ? places[2]
                                                                    : places[0] + at.u * (places[1] - places[0]) +
                                                                          at.v * (places[2] - places[0])));
    }
    std::array<std::int32_t, 3> cell{};
    cutAlong(sheet, 2, cell);
}

/// Cuts at the faces of cells across an axis and the axes before it; keeps parts before the image along x.
void PairSurface::cutAlong(const Sheet& sheet, int axis, std::array<std::int32_t, 3>& cell) {
    if (axis < 0) {
        add(sheet, cell);
        return;
    }
    double lo = 0;
    double hi = 0;
    sheet.range(axis, lo, hi);
    const auto at = static_cast<std::size_t>(axis);
    const double last = size_[at] + 0.5;
    if (lo > last || (hi < 0.5 && axis > 0)) {
        grazes_ = grazes_ || (lo <= last + reach_ && hi >= 0.5 - reach_);
        return;
    }
    Sheet part;
    Sheet rest;
    Sheet next;
    Sheet* other = &rest;
    Sheet* spare = &next;
    const Sheet* left = &sheet;
    if (lo < 0.5) {
        cut(*left, axis, 0.5, part, rest);
        if (axis == 0 && !part.empty()) {
            cell[0] = CrossedCell::kFront;
            add(part, cell);
        }
        if (rest.empty()) {
            return;
        }
        left = &rest;
    }
    const auto end = static_cast<std::int32_t>(std::min(std::floor(hi), last));
    for (auto number = static_cast<std::int32_t>(std::floor(std::max(lo, 0.5))); number <= end; ++number) {
        const double face = std::min(number + 1.0, last);
        cell[at] = number;
        if (hi <= face) {
            cutAlong(*left, axis - 1, cell);
            return;
        }
        cut(*left, axis, face, part, *spare);
        if (!part.empty()) {
            cutAlong(part, axis - 1, cell);
        }
        if (spare->empty()) {
            return;
        }
        std::swap(spare, other);
        left = other;
    }
}

void PairSurface::add(const Sheet& sheet, const std::array<std::int32_t, 3>& cell) {
    const double end = cell[0] == CrossedCell::kFront ? 0.5 : std::min(cell[0] + 1.0, size_[0] + 0.5);
    const std::uint64_t row = static_cast<std::uint64_t>(cell[2]) * (static_cast<std::uint64_t>(size_[1]) + 1) +
                              static_cast<std::uint64_t>(cell[1]);
    const std::uint64_t key = row << kRowShift | static_cast<std::uint64_t>(cell[0] + 1);
    double lo = 0;
    double hi = 0;
    sheet.range(0, lo, hi);
    records_.push_back({key, static_cast<std::uint32_t>(sheets_.count()), sheet.jump, lo <= cell[0] + reach_,
                        hi >= end - reach_, sheet.area(), sheet.volumeTo(end)});
    sheets_.add(sheet);
}

/// By row first, as there are about as many rows as records in each.
void PairSurface::sortRecords() {
    const auto isBefore = [](const Record& a, const Record& b) {
        return a.key != b.key ? a.key < b.key : a.sheet < b.sheet;
    };
    std::uint64_t first = ~std::uint64_t{0};
    std::uint64_t last = 0;
    for (const Record& record : records_) {
        first = std::min(first, record.key >> kRowShift);
        last = std::max(last, record.key >> kRowShift);
    }
    constexpr std::uint64_t kMaxRows = 16; // for each record
    if (records_.empty() || last - first > kMaxRows * records_.size()) {
        std::ranges::sort(records_, isBefore);
        return;
    }
    starts_.assign(last - first + 2, 0);
    for (const Record& record : records_) {
        ++starts_[(record.key >> kRowShift) - first + 1];
    }
    for (std::size_t row = 1; row < starts_.size(); ++row) {
        starts_[row] += starts_[row - 1];
    }
    sorted_.resize(records_.size());
    for (const Record& record : records_) {
        sorted_[starts_[(record.key >> kRowShift) - first]++] = record;
    }
    std::uint32_t begin = 0;
    for (std::size_t row = 0; row + 1 < starts_.size(); ++row) {
        std::sort(sorted_.begin() + begin, sorted_.begin() + starts_[row], isBefore);
        begin = starts_[row];
    }
    records_.swap(sorted_);
}

void PairSurface::sortIntoRows() {
    sortRecords();
    cells_.clear();
    rows_.clear();
    for (std::uint32_t i = 0; i < records_.size(); ++i) {
        const Record& record = records_[i];
        const bool isNewCell = i == 0 || record.key != records_[i - 1].key;
        const std::uint64_t row = record.key >> kRowShift;
        if (i == 0 || row != records_[i - 1].key >> kRowShift) {
            const auto first = static_cast<std::uint32_t>(cells_.size());
            const auto rows = static_cast<std::uint64_t>(size_[1]) + 1;
            rows_.push_back(
                {static_cast<std::int32_t>(row % rows), static_cast<std::int32_t>(row / rows), first, first});
        }
        if (isNewCell) {
            cells_.push_back({static_cast<std::int32_t>(record.key & ((1U << kRowShift) - 1)) - 1, i, i});
            ++rows_.back().end;
        }
        CrossedCell& cell = cells_.back();
        ++cell.end;
        cell.meetsFront = cell.meetsFront || record.meetsFront;
        cell.meetsBack = cell.meetsBack || record.meetsBack;
        if (record.jump == kUnknownJump) {
            cell.unknown += std::abs(record.area);
        } else {
            cell.area += record.jump * record.area;
            cell.volume += record.jump * record.volume;
        }
    }
    setWindings();
}

void PairSurface::setWindings() {
    for (const CrossedRow& row : rows_) {
        Jump base = 0;
        for (std::uint32_t run = row.first; run < row.end;) {
            const std::uint32_t end = endOfRun(row, run);
            base = behind(row, run, end, base);
            cells_[end - 1].behind = base;
            run = end;
        }
    }
}

PairSurface::Place PairSurface::at(const std::array<std::int32_t, 3>& cell) const noexcept {
    const auto row = std::ranges::lower_bound(rows_, std::array{cell[2], cell[1]}, {}, [](const CrossedRow& one) {
        return std::array{one.z, one.y};
    });
    if (row == rows_.end() || row->z != cell[2] || row->y != cell[1]) {
        return Place::Outside;
    }
    const auto first = cells_.begin() + row->first;
    const auto after = std::upper_bound(first, cells_.begin() + row->end, cell[0],
                                        [](std::int32_t x, const CrossedCell& one) { return x < one.x; });
    if (after == first) {
        return Place::Outside;
    }
    const CrossedCell& last = *(after - 1);
    if (last.x == cell[0]) {
        return Place::Crossed;
    }
    return last.behind == kUnknownJump ? Place::Unknown : (last.behind == 0 ? Place::Outside : Place::Inside);
}

BrickBox PairSurface::bricks() const noexcept {
    CellBox cells{size_, {-1, -1, -1}}; // of padded numbers
    for (const CrossedRow& row : rows_) {
        const std::array<std::int32_t, 3> first{std::max(cells_[row.first].x, 0), row.y, row.z};
        const bool isClosed = cells_[row.end - 1].behind == 0;
        const std::array<std::int32_t, 3> last{isClosed ? cells_[row.end - 1].x : size_[0], row.y, row.z};
        for (std::size_t axis = 0; axis < 3; ++axis) {
            cells.lo[axis] = std::min(cells.lo[axis], first[axis]);
            cells.hi[axis] = std::max(cells.hi[axis], last[axis]);
        }
    }
    BrickBox box;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        box.lo[axis] = cells.lo[axis] >> kBrickShift;
        box.hi[axis] = cells.hi[axis] >> kBrickShift;
    }
    return box;
}

Jump PairSurface::behind(const CrossedRow& row, std::uint32_t first, std::uint32_t end, Jump base) const noexcept {
    if (base == kUnknownJump) {
        return kUnknownJump;
    }
    double area = 0;
    double unknown = 0;
    for (std::uint32_t i = first; i < end; ++i) {
        area += cells_[i].area;
        unknown += cells_[i].unknown;
    }
    const double whole = widthOf(row.y, size_[1]) * widthOf(row.z, size_[2]);
    const double winding = base + area / whole;
    const double nearest = std::round(winding);
    const double sheets = cells_[end - 1].end - cells_[first].first;
    const double error = (unknown + 16 * rounding_ * sheets) / whole + 0x1p-30;
    const bool isSure = error < 0.25 && std::abs(winding - nearest) <= error && nearest >= 0 && nearest <= 1;
    return isSure ? static_cast<Jump>(nearest) : kUnknownJump;
}

} // namespace voxtact::cpu
