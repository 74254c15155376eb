// SPDX-License-Identifier: MIT
#pragma once

#include "c/convert.h"
#include "c/handles.h"
#include "c/handles_vulkan.h"

namespace voxtact::c {

/// A batch of the caller's as a device takes it.
class DeviceBatch {
  public:
    explicit DeviceBatch(const vxt_batch* given) {
        const vxt_batch batch = readStruct(given, zero<vxt_batch>(), "batch");
        for (const vxt_item& item : readStructs(batch.items, batch.item_count, zero<vxt_item>(), "item")) {
            items_.push_back(toItem(item));
        }
        view_ = toView(batch.view);
        threshold_ = thresholdOf(batch.threshold);
    }

    /// Valid as long as this is.
    [[nodiscard]] Batch batch() const noexcept { return {items_, view_, threshold_}; }

    [[nodiscard]] static BatchItem toItem(const vxt_item& item) {
        BatchItem out{
            objectOf(item.mesh), objectOf(item.volume), objectOf(item.transfer_function), {}, objectOf(item.labels)};
        if (item.poses != nullptr && item.world_from_object != nullptr) {
            refuse(ErrorCode::InvalidArgument, "item: poses and world_from_object; it can have one of them");
        }
        if (item.poses != nullptr) {
            out.poses = objectOf(item.poses);
            if (item.pose_count > out.poses->count()) {
                refuse(ErrorCode::InvalidArgument, "item: pose_count is more than poses has");
            }
            out.poseCount = static_cast<std::uint32_t>(item.pose_count);
            return out;
        }
        out.world_from_object = toPoses(item.world_from_object, item.pose_count, "item: world_from_object");
        return out;
    }

  private:
    std::vector<BatchItem> items_;
    View view_;
    double threshold_ = 0;
};

} // namespace voxtact::c
