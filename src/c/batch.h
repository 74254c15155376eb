// SPDX-License-Identifier: MIT
#pragma once

#include "c/convert.h"
#include "c/handles.h"

namespace voxtact::c {

/// A batch of the caller's as the host engine or the device takes it, whose structs begin alike.
template <class Batch, class Item> class BatchOf {
  public:
    template <class CBatch, class CItem> BatchOf(const CBatch* given, const CBatch& noBatch, const CItem& noItem) {
        const CBatch batch = readStruct(given, noBatch, "batch");
        for (const CItem& item : readStructs(batch.items, batch.item_count, noItem, "item")) {
            items_.push_back(toItem(item));
        }
        view_ = toView(batch.view);
        threshold_ = batch.threshold;
        if constexpr (kCanBeCancelled) {
            cancel_ = objectOf(batch.cancel);
        }
        if constexpr (kHasLabels) {
            labels_ = toSpan(batch.labels, batch.label_count, "batch: labels");
        }
    }

    /// Valid as long as this is.
    [[nodiscard]] Batch batch() const noexcept {
        Batch batch;
        batch.items = items_;
        batch.view = view_;
        batch.threshold = threshold_;
        if constexpr (kCanBeCancelled) {
            batch.cancel = cancel_;
        }
        if constexpr (kHasLabels) {
            batch.labels = labels_;
        }
        return batch;
    }

    template <class CItem> [[nodiscard]] static Item toItem(const CItem& item) {
        Item out{
            objectOf(item.mesh), objectOf(item.volume), objectOf(item.transfer_function), {}, objectOf(item.labels)};
        if constexpr (requires { item.poses; }) {
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
        }
        out.world_from_object = toPoses(item.world_from_object, item.pose_count, "item: world_from_object");
        return out;
    }

  private:
    static constexpr bool kCanBeCancelled = requires(Batch batch) { batch.cancel; };
    static constexpr bool kHasLabels = requires(Batch batch) { batch.labels; };

    std::vector<Item> items_;
    View view_;
    double threshold_ = 0;
    const std::atomic<bool>* cancel_ = nullptr;
    std::span<const std::int32_t> labels_;
};

using HostBatchOf = BatchOf<cpu::Batch, cpu::BatchItem>;

} // namespace voxtact::c
