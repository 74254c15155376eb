// SPDX-License-Identifier: MIT
#include "core/base/guard.h"
#include "core/base/try.h"
#include "core/volume/edit_rows.h"
#include "core/volume/voxel_value.h"
#include "host/scene/scene_impl.h"

namespace voxtact::cpu {

Result<void> Volume::set(const VoxelRegion& region, double value) {
    return guard([&]() -> Result<void> {
        const Result<VoxelBox> bounds = voxelBounds(region, impl_->grid);
        VOXTACT_TRY(bounds);
        const Result<VoxelBytes> voxel = voxelOf(impl_->type, value);
        VOXTACT_TRY(voxel);
        const std::vector<VoxelRow> rows = voxelRows(region, impl_->grid);
        for (const VoxelRow& row : rows) {
            impl_->image.replace(row, impl_->type, voxel->data(), 0);
        }
        if (!rows.empty()) {
            impl_->edited(*bounds);
        }
        return {};
    });
}

Result<void> Volume::write(const VoxelBox& box, std::span<const std::byte> voxels) {
    return guard([&]() -> Result<void> {
        VOXTACT_TRY(voxelBounds(box, impl_->grid));
        VOXTACT_TRY(checkVoxels(impl_->type, box, voxels));
        const std::size_t step = bytesPerVoxel(impl_->type);
        const std::vector<VoxelRow> rows = voxelRows(box, impl_->grid);
        const std::byte* from = voxels.data();
        for (const VoxelRow& row : rows) {
            impl_->image.replace(row, impl_->type, from, step);
            from += step * box.size[0];
        }
        if (!rows.empty()) {
            impl_->edited(box);
        }
        return {};
    });
}

Result<void> Volume::read(const VoxelBox& box, std::span<std::byte> voxels) const {
    return guard([&]() -> Result<void> {
        VOXTACT_TRY(voxelBounds(box, impl_->grid));
        VOXTACT_TRY(checkVoxelBytes(impl_->type, box, voxels.size()));
        std::byte* to = voxels.data();
        for (const VoxelRow& row : voxelRows(box, impl_->grid)) {
            impl_->image.copy(row, impl_->type, to);
            to += bytesPerVoxel(impl_->type) * box.size[0];
        }
        return {};
    });
}

} // namespace voxtact::cpu
