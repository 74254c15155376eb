// SPDX-License-Identifier: MIT
#include "detect/batch.h"
#include "core/text.h"
#include "gpu/scene_impl.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace voxtact {

namespace {

Error refuse(std::string text) {
    return Error{ErrorCode::InvalidArgument, 0, std::move(text)};
}

Result<void> checkView(const ContextImpl& context, const View& view) {
    const std::string size = std::to_string(view.width) + "x" + std::to_string(view.height);
    if (view.width == 0 || view.height == 0) {
        return refuse("the viewport is " + size + ", it needs at least one pixel");
    }
    const VkPhysicalDeviceLimits& limits = context.limits;
    const std::uint32_t mostX = std::min(limits.maxViewportDimensions[0], limits.maxFramebufferWidth);
    const std::uint32_t mostY = std::min(limits.maxViewportDimensions[1], limits.maxFramebufferHeight);
    if (view.width > mostX || view.height > mostY) {
        return Error{ErrorCode::LimitExceeded, 0,
                     "the viewport is " + size +
                         ", the device's limit (maxViewportDimensions, maxFramebufferWidth "
                         "and Height) is " +
                         std::to_string(mostX) + "x" + std::to_string(mostY)};
    }
    if (const Result<Mat4> world_from_clip = inverse(view.clip_from_world); !world_from_clip.ok()) {
        return refuse("the camera's clip_from_world cannot be used: " + world_from_clip.error().text);
    }
    return {};
}

Result<void> checkItem(const ContextImpl& context, const BatchItem& item, const std::string& which) {
    if (item.mesh == nullptr || item.volume == nullptr || item.transferFunction == nullptr) {
        return refuse(which + ": mesh, volume or transferFunction is null");
    }
    if (&item.mesh->impl().context != &context || &item.volume->impl().context != &context ||
        &item.transferFunction->impl().context != &context) {
        return refuse(which + ": mesh, volume or transferFunction belongs to another Context");
    }
    for (std::size_t pose = 0; pose < item.world_from_object.size(); ++pose) {
        // The text is made for a bad pose only: this is the hot loop of recording.
        if (Result<void> checked = checkAffine(item.world_from_object[pose], {}); !checked.ok()) {
            return checkAffine(item.world_from_object[pose], which + ", pose " + std::to_string(pose));
        }
    }
    return {};
}

} // namespace

Result<std::uint32_t> checkBatch(const ContextImpl& context, const Batch& batch) {
    if (!(batch.threshold >= 0 && batch.threshold <= 1)) {
        return refuse("the threshold " + number(batch.threshold) + " is outside [0, 1]");
    }
    if (Result<void> view = checkView(context, batch.view); !view.ok()) {
        return view.error();
    }
    std::uint64_t pairs = 0;
    for (std::size_t i = 0; i < batch.items.size(); ++i) {
        if (Result<void> item = checkItem(context, batch.items[i], "batch item " + std::to_string(i)); !item.ok()) {
            return item.error();
        }
        pairs += batch.items[i].world_from_object.size();
    }
    if (pairs > std::numeric_limits<std::uint32_t>::max()) {
        return refuse("the batch has " + std::to_string(pairs) + " pairs, more than 32 bits can number");
    }
    return static_cast<std::uint32_t>(pairs);
}

shader::ItemConstants itemConstants(const BatchItem& item, Filter filter, double threshold) noexcept {
    const VolumeImpl& volume = item.volume->impl();
    const bool ofInteger = filter == Filter::Exact && volume.storedUnit > 0;
    const double slope = ofInteger ? volume.valueSlope / volume.storedUnit : volume.valueSlope;
    shader::ItemConstants constants =
        itemConstants(slope, volume.valueIntercept, item.transferFunction->impl().domain, threshold);
    constants.storedUnit = static_cast<float>(volume.storedUnit);
    return constants;
}

bool needsCarry(const Batch& batch, const BatchItem& item) noexcept {
    const double most = static_cast<double>(batch.view.width) * batch.view.height * item.mesh->triangles();
    return most >= 4294967296.0;
}

} // namespace voxtact
