// SPDX-License-Identifier: MIT
#include "viewer/model/document/carving.h"

#include "core/base/try.h"
#include "core/volume/edit_rows.h"
#include "core/volume/voxel_value.h"

#include <algorithm>
#include <string>

namespace voxtact::view {

namespace {

/// Calls `use` for each row of a box, with its byte offsets in the grid and in the box, and its bytes.
template <class Use> void eachRow(const Grid& grid, const VoxelBox& box, std::size_t voxelBytes, Use&& use) {
    const std::size_t bytes = box.size[0] * voxelBytes;
    std::size_t inBox = 0;
    for (std::uint32_t z = 0; z < box.size[2]; ++z) {
        for (std::uint32_t y = 0; y < box.size[1]; ++y) {
            const std::size_t row = std::size_t{box.first[2] + z} * grid.size[1] + box.first[1] + y;
            use((row * grid.size[0] + box.first[0]) * voxelBytes, inBox, bytes);
            inBox += bytes;
        }
    }
}

std::uint64_t voxelsOf(const VoxelBox& box) {
    return std::uint64_t{box.size[0]} * box.size[1] * box.size[2];
}

void write(VolumeData& volume, const HoleWrite& what) {
    const std::vector<std::byte>& voxels = what.voxels();
    eachRow(volume.grid, what.hole->box, bytesPerVoxel(volume.type),
            [&](std::size_t inGrid, std::size_t inBox, std::size_t bytes) {
                std::copy_n(voxels.begin() + static_cast<std::ptrdiff_t>(inBox), bytes,
                            volume.voxels.begin() + static_cast<std::ptrdiff_t>(inGrid));
            });
}

} // namespace

Result<Hole> holeOf(const VolumeView& volume, const Ball& ball, double value) {
    const Result<VoxelBytes> voxel = voxelOf(volume.type, value);
    VOXTACT_TRY(voxel);
    const Result<VoxelBox> box = voxelBounds(ball, volume.grid);
    VOXTACT_TRY(box);
    if (voxelsOf(*box) > kMostHoleVoxels) {
        return Error{ErrorCode::LimitExceeded, 0,
                     "the hole covers " + std::to_string(voxelsOf(*box)) + " voxels; " +
                         std::to_string(kMostHoleVoxels) + " is the maximum; use a smaller radius"};
    }
    const std::size_t bytes = bytesPerVoxel(volume.type);
    Hole hole{*box, std::vector<std::byte>(voxelsOf(*box) * bytes), {}};
    eachRow(volume.grid, *box, bytes, [&](std::size_t inGrid, std::size_t inBox, std::size_t length) {
        std::copy_n(volume.voxels.begin() + static_cast<std::ptrdiff_t>(inGrid), length,
                    hole.before.begin() + static_cast<std::ptrdiff_t>(inBox));
    });
    hole.after = hole.before;
    for (const VoxelRow& row : voxelRows(ball, volume.grid)) {
        const std::size_t rowOfBox = std::size_t{row.z - box->first[2]} * box->size[1] + row.y - box->first[1];
        for (std::uint32_t x = row.firstX; x < row.endX; ++x) {
            const std::size_t at = (rowOfBox * box->size[0] + x - box->first[0]) * bytes;
            std::copy_n(voxel->begin(), bytes, hole.after.begin() + static_cast<std::ptrdiff_t>(at));
        }
    }
    return hole;
}

std::span<const HoleWrite> HoleWrites::from(std::uint64_t number) const {
    return std::span(kept_).subspan(number - first_);
}

void HoleWrites::forget(std::uint64_t before) {
    const auto gone = std::min(before, end()) - std::min(before, first_);
    kept_.erase(kept_.begin(), kept_.begin() + static_cast<std::ptrdiff_t>(gone));
    first_ += gone;
}

void Holes::add(Hole hole) {
    holes_.resize(drilled_);
    holes_.push_back(std::make_shared<const Hole>(std::move(hole)));
}

std::vector<HoleWrite> Holes::bring(VolumeData& volume, std::size_t number) {
    std::vector<HoleWrite> done;
    const std::size_t to = std::min(number, holes_.size());
    while (drilled_ != to) {
        const bool filled = drilled_ > to;
        done.push_back({holes_[filled ? drilled_ - 1 : drilled_], filled});
        write(volume, done.back());
        drilled_ = filled ? drilled_ - 1 : drilled_ + 1;
    }
    return done;
}

} // namespace voxtact::view
