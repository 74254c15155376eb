// SPDX-License-Identifier: MIT
#include "host/batch_check.h"

#include "core/base/try.h"
#include "core/batch/batch_check.h"
#include "core/geometry/pair_transform.h"
#include "host/scene/scene_impl.h"

namespace voxtact::cpu {

namespace {

struct HostSide {
    [[nodiscard]] Result<void> checkExtent(const WideExtent& extent, const std::string& what) const {
        if (extent[0] <= kMaxViewport && extent[1] <= kMaxViewport) {
            return {};
        }
        const std::string most = std::to_string(kMaxViewport);
        return Error{ErrorCode::LimitExceeded, 0, what + ", the host engine's limit is " + most + "x" + most};
    }
    [[nodiscard]] Result<void> checkItem(const BatchItem& /*item*/, const std::string& /*which*/) const { return {}; }
    [[nodiscard]] bool holdsValues(const BatchItem& item) const {
        const ValueRange& domain = item.transferFunction->impl().domain;
        return areSingle(itemConstants(1, item.volume->impl().storedIntercept, domain, 0));
    }
};

} // namespace

Result<std::uint32_t> checkBatch(const Count& desc, const Batch& batch) {
    return voxtact::checkBatch(desc.projection, desc.samplesPerVoxel, batch, HostSide{});
}

Result<void> checkCertifiedBatch(const Batch& batch) {
    Count desc;
    desc.projection = Projection::Certified;
    VOXTACT_TRY(checkBatch(desc, batch));
    return {};
}

Result<void> checkCertifiedItem(const BatchItem& item, double threshold) {
    VOXTACT_TRY(checkFact(factOf("scene", "opacity_threshold"), threshold));
    return checkBatchItem(rowOf(Projection::Certified), Count{}.samplesPerVoxel, item, "the item", HostSide{});
}

Result<void> checkThreads(std::uint32_t threads) {
    if (threads > kMaxThreads) {
        return Error{ErrorCode::LimitExceeded, 0,
                     std::to_string(threads) + " threads are asked for, the most is " + std::to_string(kMaxThreads)};
    }
    return {};
}

} // namespace voxtact::cpu
