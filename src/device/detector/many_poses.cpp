// SPDX-License-Identifier: MIT
#include "device/detector/many_poses.h"
#include "core/method/method_table.h"
#include "vulkan/context_impl.h"

namespace voxtact {

std::optional<DetectorDesc> forManyPoses(const ContextImpl& context, const DetectorDesc& desc, std::uint64_t poses) {
    // A method that draws waits for its draws, and a processor that is the device as well has nothing to win.
    if (desc.devicePoses || poses < kFewestHostPoses || rowOf(desc.method).coverage == Coverage::Rasteriser ||
        !context.floatControls.doubles() || context.onHost) {
        return std::nullopt;
    }
    DetectorDesc out = desc;
    out.devicePoses = true;
    return out;
}

} // namespace voxtact
