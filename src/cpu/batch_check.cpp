// SPDX-License-Identifier: MIT
#include "cpu/batch_check.h"
#include "core/method_table.h"
#include "core/projection.h"
#include "core/text.h"
#include "core/try.h"

#include <limits>

namespace voxtact::cpu {

namespace {

Error refuse(std::string text) {
    return Error{ErrorCode::InvalidArgument, 0, std::move(text)};
}

Result<void> checkView(const View& view) {
    const std::string size = std::to_string(view.width) + "x" + std::to_string(view.height);
    if (view.width == 0 || view.height == 0) {
        return refuse("the viewport is " + size + ", it needs at least one pixel");
    }
    if (view.width > kMaxViewport || view.height > kMaxViewport) {
        const std::string most = std::to_string(kMaxViewport);
        return Error{ErrorCode::LimitExceeded, 0,
                     "the viewport is " + size + ", the host engine's limit (cpu::kMaxViewport) is " + most + "x" +
                         most};
    }
    if (const Result<Mat4> world_from_clip = inverse(view.clip_from_world); !world_from_clip.ok()) {
        return refuse("the camera's clip_from_world cannot be used: " + world_from_clip.error().text);
    }
    return {};
}

/// What the projection `dominant-axis` asks of an item that checkItem() accepts.
Result<void> checkDominant(const BatchItem& item, std::size_t number, std::uint32_t samplesPerVoxel) {
    const Grid& grid = item.volume->grid();
    if (dominantSide(grid, samplesPerVoxel) > kMaxViewport) {
        const std::string most = std::to_string(kMaxViewport);
        return Error{ErrorCode::LimitExceeded, 0,
                     "batch item " + std::to_string(number) + ": " + dominantNeeds(grid, samplesPerVoxel) +
                         ", the host engine's limit (cpu::kMaxViewport) is " + most + "x" + most};
    }
    return {};
}

Result<void> checkItem(const BatchItem& item, std::size_t number) {
    if (item.mesh == nullptr || item.volume == nullptr || item.transferFunction == nullptr) {
        return refuse("batch item " + std::to_string(number) + ": mesh, volume or transferFunction is null");
    }
    for (std::size_t pose = 0; pose < item.world_from_object.size(); ++pose) {
        // The text is made for a bad pose only.
        if (Result<void> checked = checkAffine(item.world_from_object[pose], {}); !checked.ok()) {
            return checkAffine(item.world_from_object[pose],
                               "batch item " + std::to_string(number) + ", pose " + std::to_string(pose));
        }
    }
    return {};
}

} // namespace

Result<std::uint32_t> checkBatch(const DetectorDesc& desc, const Batch& batch) {
    if (!(batch.threshold >= 0 && batch.threshold <= 1)) {
        return refuse("the threshold " + number(batch.threshold) + " is outside [0, 1]");
    }
    if (usesView(desc.projection)) {
        VOXTACT_TRY(checkView(batch.view));
    }
    std::uint64_t pairs = 0;
    for (std::size_t i = 0; i < batch.items.size(); ++i) {
        VOXTACT_TRY(checkItem(batch.items[i], i));
        if (rowOf(desc.projection).voxelGrid) {
            VOXTACT_TRY(checkDominant(batch.items[i], i, desc.samplesPerVoxel));
        }
        pairs += batch.items[i].world_from_object.size();
    }
    if (pairs > std::numeric_limits<std::uint32_t>::max()) {
        return refuse("the batch has " + std::to_string(pairs) + " pairs, more than 32 bits can number");
    }
    return static_cast<std::uint32_t>(pairs);
}

} // namespace voxtact::cpu
