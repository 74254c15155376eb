// SPDX-License-Identifier: MIT
#include "host/search/label_part.h"

#include "core/base/try.h"
#include "core/volume/label_grid.h"

#include <algorithm>
#include <limits>

namespace voxtact::cpu {

/// Cells at the image's faces have one layer of octants in the domain.
SearchedPart::Octants SearchedPart::octantsOf(const PiecePlace& place) const noexcept {
    Octants out;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        if (place.cell[axis] == 0) {
            out.first[axis] = out.last[axis] = 1;
        } else if (static_cast<std::uint32_t>(place.cell[axis]) == labels_->grid.size[axis]) {
            out.first[axis] = out.last[axis] = 0;
        } else if (place.depth == 0) {
            out.first[axis] = 0;
            out.last[axis] = 1;
        } else {
            out.first[axis] = out.last[axis] = (place.piece[axis] >> (place.depth - 1U)) & 1U;
        }
    }
    return out;
}

bool SearchedPart::has(const NodePlace& padded, const std::array<std::uint32_t, 3>& octant) const noexcept {
    std::array<std::size_t, 3> voxel{};
    for (std::size_t axis = 0; axis < 3; ++axis) {
        voxel[axis] = static_cast<std::size_t>(padded[axis] - 1) + octant[axis];
    }
    const auto& size = labels_->grid.size;
    return with_[labels_->indices[(voxel[2] * size[1] + voxel[1]) * size[0] + voxel[0]]] != 0;
}

std::array<unsigned, 2> SearchedPart::count(const NodePlace& padded, const Octants& octants) const noexcept {
    std::array<unsigned, 2> out{};
    std::array<std::uint32_t, 3> at{};
    for (at[2] = octants.first[2]; at[2] <= octants.last[2]; ++at[2]) {
        for (at[1] = octants.first[1]; at[1] <= octants.last[1]; ++at[1]) {
            for (at[0] = octants.first[0]; at[0] <= octants.last[0]; ++at[0]) {
                out[0] += has(padded, at) ? 1 : 0;
                ++out[1];
            }
        }
    }
    return out;
}

bool SearchedPart::meets(const PiecePlace& place) const noexcept {
    return labels_ == nullptr || count(place.cell, octantsOf(place))[0] > 0;
}

std::optional<CellRegion> SearchedPart::region(const PartCell& cell, const PiecePlace& place) const noexcept {
    const CellRegion whole{cell.domain - cell.half, cell.domain + cell.half};
    if (labels_ == nullptr) {
        return whole;
    }
    const auto [all, of] = count(place.cell, octantsOf({place.cell}));
    if (all == of) {
        return whole;
    }
    if (place.depth == 0) {
        return {};
    }
    const Octants octant = octantsOf(place);
    if (!has(place.cell, octant.first)) {
        return {};
    }
    CellRegion out = whole;
    for (int axis = 0; axis < 3; ++axis) {
        (octant.first[static_cast<std::size_t>(axis)] == 0 ? out.hi : out.lo)[axis] = 0;
    }
    return out;
}

namespace {

constexpr std::uint32_t kNone = std::numeric_limits<std::uint32_t>::max();

/// `placeOf`: by LabelData::values, the set that the label is in, or kNone.
std::vector<LabelSet> setsOf(const OpaquePart& part, const VolumeImpl& volume, const LabelData& labels,
                             const std::vector<std::uint32_t>& placeOf, std::size_t sets) {
    const std::size_t bricks = volume.bricks.lo.size();
    std::vector<std::vector<std::uint8_t>> wanted(sets, std::vector<std::uint8_t>(bricks));
    const auto& size = labels.grid.size;
    std::size_t voxel = 0;
    for (std::uint32_t z = 0; z < size[2]; ++z) {
        for (std::uint32_t y = 0; y < size[1]; ++y) {
            for (std::uint32_t x = 0; x < size[0]; ++x, ++voxel) {
                const std::uint32_t place = placeOf[labels.indices[voxel]];
                if (place == kNone) {
                    continue;
                }
                // The voxel is a corner of the padded cells i and i+1 along each axis.
                const NodePlace first{static_cast<std::int32_t>(x), static_cast<std::int32_t>(y),
                                      static_cast<std::int32_t>(z)};
                for (unsigned i = 0; i < 8; ++i) {
                    const NodePlace brick{(first[0] + static_cast<std::int32_t>(i & 1U)) >> kBrickShift,
                                          (first[1] + static_cast<std::int32_t>(i >> 1U & 1U)) >> kBrickShift,
                                          (first[2] + static_cast<std::int32_t>(i >> 2U & 1U)) >> kBrickShift};
                    const std::size_t number = part.occupancy.brickNumber(brick);
                    wanted[place][number] = part.occupancy.mayBeOpaque(number) ? 1 : 0;
                }
            }
        }
    }
    std::vector<LabelSet> out(sets);
    for (std::size_t i = 0; i < sets; ++i) {
        out[i].pyramid = BrickPyramid(volume.bricks.count, std::move(wanted[i]));
        out[i].with.resize(placeOf.size());
    }
    for (std::size_t i = 0; i < placeOf.size(); ++i) {
        if (placeOf[i] != kNone) {
            out[placeOf[i]].with[i] = 1;
        }
    }
    return out;
}

} // namespace

std::vector<LabelSet> singleLabels(const OpaquePart& part, const VolumeImpl& volume, const LabelData& labels,
                                   std::span<const std::uint32_t> indices) {
    std::vector<std::uint32_t> placeOf(labels.values.size(), kNone);
    for (std::size_t i = 0; i < indices.size(); ++i) {
        placeOf[indices[i]] = static_cast<std::uint32_t>(i);
    }
    return setsOf(part, volume, labels, placeOf, indices.size());
}

LabelSet allLabels(const OpaquePart& part, const VolumeImpl& volume, const LabelData& labels,
                   std::span<const std::uint32_t> indices) {
    std::vector<std::uint32_t> placeOf(labels.values.size(), kNone);
    for (const std::uint32_t index : indices) {
        placeOf[index] = 0;
    }
    return std::move(setsOf(part, volume, labels, placeOf, 1).front());
}

Result<void> checkLabelsOnGrid(const LabelData& labels, const Grid& grid, const std::string& which) {
    if (labels.indices.size() != voxelCount(labels.grid)) {
        return Error{ErrorCode::Unsupported, 0,
                     which + ": the label map has " + std::to_string(labels.indices.size()) +
                         " voxels, its grid another number"};
    }
    return checkLabelGrid(labels.grid, grid, which);
}

Result<void> checkMeasuredLabels(const Batch& batch, std::span<const std::int32_t> labels) {
    VOXTACT_TRY(voxtact::checkMeasuredLabels(labels));
    for (std::size_t i = 0; i < batch.items.size(); ++i) {
        const BatchItem& item = batch.items[i];
        const std::string which = "batch item " + std::to_string(i);
        if (item.labels == nullptr) {
            return noLabelsToMeasure(which);
        }
        VOXTACT_TRY(checkLabelsOnGrid(*item.labels, item.volume->grid(), which));
    }
    return {};
}

} // namespace voxtact::cpu
