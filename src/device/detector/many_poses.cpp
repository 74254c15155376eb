// SPDX-License-Identifier: MIT
#include "device/detector/many_poses.h"
#include "core/method/method_table.h"
#include "device/detector/detector_impl.h"

namespace voxtact {

std::optional<DetectorDesc> forManyPoses(const DetectorImpl& detector, std::uint64_t poses) {
    const ContextImpl& context = detector.context;
    // A method that draws waits for its draws, and a processor that is the device as well has nothing to win.
    if (detector.desc.devicePoses || poses < kFewestHostPoses ||
        rowOf(detector.desc.method).coverage == Coverage::Rasteriser || !context.floatControls.doubles() ||
        context.onHost) {
        return std::nullopt;
    }
    DetectorDesc out = detector.given;
    std::visit([](auto& desc) { desc.devicePoses = true; }, out);
    return out;
}

} // namespace voxtact
