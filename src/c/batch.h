// SPDX-License-Identifier: MIT
#pragma once

#include "c/convert.h"
#include "c/handles.h"

namespace voxtact::c {

/// A batch of the caller's as the host engine or the device takes it, which have structs of the same shape.
template <class Batch, class Item> class BatchOf {
  public:
    template <class CBatch, class CItem> BatchOf(const CBatch* given, const CBatch& noBatch, const CItem& noItem) {
        const CBatch batch = readStruct(given, noBatch, "batch");
        for (const CItem& item : readStructs(batch.items, batch.item_count, noItem, "item")) {
            items_.push_back(toItem(item));
        }
        view_ = toView(batch.view);
        threshold_ = batch.threshold;
    }

    /// Valid as long as this is.
    [[nodiscard]] Batch batch() const noexcept { return {items_, view_, threshold_}; }

    template <class CItem> [[nodiscard]] static Item toItem(const CItem& item) {
        return {objectOf(item.mesh), objectOf(item.volume), objectOf(item.transfer_function),
                toPoses(item.world_from_object, item.pose_count, "item: world_from_object"), objectOf(item.labels)};
    }

  private:
    std::vector<Item> items_;
    View view_;
    double threshold_ = 0;
};

using HostBatchOf = BatchOf<cpu::Batch, cpu::BatchItem>;

} // namespace voxtact::c
