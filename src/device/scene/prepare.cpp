// SPDX-License-Identifier: MIT
#include "core/base/refuse.h"
#include "core/base/try.h"
#include "device/scene/bricks.h"
#include "device/scene/scene_impl.h"

#include <string>

namespace voxtact {
namespace {

/// Whether a created object waits for its upload, or a wrapped mesh for its clusters.
template <class Impl> bool waits(const Impl& impl) {
    return impl.staging.buffer && !impl.uploaded;
}

Result<void> prepare(VkCommandBuffer commandBuffer, Volume& volume) {
    const VolumeImpl& impl = volume.impl();
    if (!waits(impl) && impl.bricks.buffer && !impl.bricksFilled) {
        return volume.cmdUpdateBricks(commandBuffer, wholeBox(impl.grid));
    }
    return waits(impl) ? volume.cmdUpload(commandBuffer) : Result<void>{};
}

template <class Other> Result<void> prepare(VkCommandBuffer commandBuffer, Other& resource) {
    return waits(resource.impl()) ? resource.cmdUpload(commandBuffer) : Result<void>{};
}

bool isNull(const Resource& resource) {
    return std::visit([](const auto* object) { return object == nullptr; }, resource);
}

/// Unlike std::visit(), throws nothing.
template <class Object> void release(const Resource& resource) noexcept {
    if (Object* const* const object = std::get_if<Object*>(&resource); object != nullptr && *object != nullptr) {
        (*object)->releaseStaging();
    }
}

} // namespace

Result<void> cmdPrepare(VkCommandBuffer commandBuffer, std::span<const Resource> resources) {
    for (std::size_t i = 0; i < resources.size(); ++i) {
        if (isNull(resources[i])) {
            return refuse("resource " + std::to_string(i) + " is null");
        }
        VOXTACT_TRY(std::visit([&](auto* object) { return prepare(commandBuffer, *object); }, resources[i]));
    }
    return {};
}

void retire(std::span<const Resource> resources) noexcept {
    for (const Resource& resource : resources) {
        release<Volume>(resource);
        release<TransferFunction>(resource);
        release<Mesh>(resource);
        release<LabelMap>(resource);
    }
}

} // namespace voxtact
