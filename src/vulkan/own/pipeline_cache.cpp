// SPDX-License-Identifier: MIT
#include "vulkan/own/pipeline_cache.h"

#include "vulkan/own/created.h"

#include <algorithm>
#include <cstring>
#include <exception>
#include <utility>

namespace voxtact::device {

bool pipelineBlobFits(std::string_view blob, const PhysicalDevice& device) {
    VkPipelineCacheHeaderVersionOne header{};
    if (blob.size() < sizeof header) {
        return false;
    }
    std::memcpy(&header, blob.data(), sizeof header);
    return header.headerSize >= sizeof header && header.headerSize <= blob.size() &&
           header.headerVersion == VK_PIPELINE_CACHE_HEADER_VERSION_ONE && header.vendorID == device.vendor &&
           header.deviceID == device.deviceId &&
           std::memcmp(header.pipelineCacheUUID, device.pipelineCacheUuid.data(), VK_UUID_SIZE) == 0;
}

PipelineCache::PipelineCache(const VulkanDevice& device, PipelineStore store)
    : device_(device), store_(std::move(store)) {
    if (!store_.read || !store_.write) {
        return;
    }
    std::string blob = store_.read().value_or("");
    if (!pipelineBlobFits(blob, device.physical())) {
        blob.clear();
    }
    VkPipelineCacheCreateInfo info{};
    info.sType = VK_STRUCTURE_TYPE_PIPELINE_CACHE_CREATE_INFO;
    info.initialDataSize = blob.size();
    info.pInitialData = blob.data();
    VkResult result =
        createdOrNull(device_.table().vkCreatePipelineCache(device_.handle(), &info, nullptr, &handle_), handle_);
    if (result != VK_SUCCESS && !blob.empty()) {
        blob.clear();
        info.initialDataSize = 0;
        result =
            createdOrNull(device_.table().vkCreatePipelineCache(device_.handle(), &info, nullptr, &handle_), handle_);
    }
    if (result != VK_SUCCESS) {
        handle_ = VK_NULL_HANDLE;
    }
    // A header alone, which is all that lavapipe gives, is not worth a file.
    bytes_ = std::max(blob.size(), sizeof(VkPipelineCacheHeaderVersionOne));
}

PipelineCache::PipelineCache(PipelineCache&& other) noexcept
    : device_(std::move(other.device_)), store_(std::move(other.store_)), bytes_(other.bytes_),
      handle_(std::exchange(other.handle_, VK_NULL_HANDLE)) {}

PipelineCache::~PipelineCache() {
    if (handle_ == VK_NULL_HANDLE) {
        return;
    }
    try {
        save();
    } catch (const std::exception&) {
        // Out of memory, at the very end: the next run makes its pipelines again.
        bytes_ = 0;
    }
    device_.table().vkDestroyPipelineCache(device_.handle(), handle_, nullptr);
}

void PipelineCache::save() const {
    const VolkDeviceTable& vk = device_.table();
    std::size_t size = 0;
    if (vk.vkGetPipelineCacheData(device_.handle(), handle_, &size, nullptr) != VK_SUCCESS || size <= bytes_) {
        return;
    }
    std::string blob(size, '\0');
    if (vk.vkGetPipelineCacheData(device_.handle(), handle_, &size, blob.data()) != VK_SUCCESS) {
        return;
    }
    blob.resize(size);
    if (pipelineBlobFits(blob, device_.physical())) {
        store_.write(blob);
    }
}

} // namespace voxtact::device
