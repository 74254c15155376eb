// SPDX-License-Identifier: MIT
#pragma once

#include "core/base/shared_impl.h"
#include "vulkan/device_functions.h"
#include "vulkan/kept_pipelines.h"
#include "vulkan/memory/memory.h"
#include "vulkan/requirements.h"

#include <array>
#include <atomic>
#include <memory>
#include <mutex>

namespace voxtact {

/// The descriptor sets of every pass: each object of the scene owns its own set, so that recording allocates nothing.
enum class SetIndex : std::uint32_t { Volume = 0, TransferFunction = 1, Pairs = 2, Mesh = 3 };

/// What the pipeline layouts with outputs need of the limits: bound sets, and storage buffers that a stage sees in
/// them.
inline constexpr std::uint32_t kOutputSets = 5;
inline constexpr std::uint32_t kOutputStorageBuffers = 7;

struct ContextImpl : SharedImpl<ContextImpl> {
    DeviceFunctions vk;
    VkInstance instance = VK_NULL_HANDLE;
    VkPhysicalDevice physicalDevice = VK_NULL_HANDLE;
    VkDevice device = VK_NULL_HANDLE;
    VkPipelineCache pipelineCache = VK_NULL_HANDLE;
    const VkAllocationCallbacks* allocator = nullptr;
    MemoryCallbacks memoryCallbacks{}; ///< null: the pool's own blocks
    LogCallback logCallback = nullptr;
    void* logUser = nullptr;

    EnabledFeatures features;
    bool conservativeRasterization = false; ///< the extension is enabled
    VkPhysicalDeviceLimits limits{};
    VkDeviceSize maxAllocation = 0;
    FloatControls floatControls; ///< asked for by every shader module
    bool onHost = false;         ///< the device is the host's processor
    /// llvmpipe (seen in Mesa 22.3) counts too much when the memory of its scene runs out while the end of a query is
    /// being put into the tiles: some tiles then end the query twice. A scene that is flushed after each query does
    /// not fill up.
    bool flushAfterQuery = false;
    /// llvmpipe (seen in Mesa 22.3 and 25.0) leaves all loops of an invocation that has had 65,535 rounds of them.
    bool endsLongLoops = false;
    VkPhysicalDeviceMemoryProperties memory{};
    MemoryPool pool; ///< ends after what this has buffers of
    std::vector<MethodSupport> methods;

    std::vector<std::uint32_t> queueFamilies{}; ///< ContextDesc::queueFamilies
    std::uint64_t fragmentsAtOnce = 0;          ///< ContextDesc::fragmentsAtOnce, or what stands for 0
    VkSampler sampler = VK_NULL_HANDLE;        ///< linear, clamped to the edge; of volumes and transfer functions alike
    VkSampler nearestSampler = VK_NULL_HANDLE; ///< for formats that cannot be filtered: shaders fetch their texels
    std::array<VkDescriptorSetLayout, 4> setLayouts{}; ///< by SetIndex
    VkPipelineLayout rasterLayout = VK_NULL_HANDLE;    ///< sets 0 to 2, and RasterConstants for the fragment stage
    VkPipelineLayout dominantLayout = VK_NULL_HANDLE; ///< all sets, RasterConstants, and DominantConstants for vertices
    VkPipelineLayout computeLayout = VK_NULL_HANDLE;  ///< all sets; null where the device's limits do not allow for it

    std::mutex onDemandMutex;                   ///< of those below, which are made for the first object that needs them
    Owned<VkDescriptorSetLayout> poseSetLayout; ///< poseSetLayout()
    Owned<VkDescriptorSetLayout> setupSetLayout; ///< VOXTACT_SET_SETUP
    Owned<VkPipelineLayout> setupLayout;
    Owned<VkPipelineLayout> editLayout;
    Owned<VkDescriptorSetLayout> refitSetLayout;
    Owned<VkPipelineLayout> refitLayout;
    Buffer nothing; ///< emptyBuffer()
    /// The same with outputs in addition to the counts: VOXTACT_SET_PAIRS has two more bindings, and there is a set
    /// more.
    VkDescriptorSetLayout outputSetLayout = VK_NULL_HANDLE;
    VkDescriptorSetLayout labelSetLayout = VK_NULL_HANDLE;
    VkPipelineLayout rasterOutputLayout = VK_NULL_HANDLE; ///< null where the device's limits do not allow for it
    VkPipelineLayout computeOutputLayout = VK_NULL_HANDLE;

    KeptPipelines pipelines; ///< computePipeline()

    std::atomic<bool> lost{false};
    std::atomic<bool> givenUp{false}; ///< then it is lost too

    ContextImpl() = default;
    ContextImpl(const ContextImpl&) = delete;
    ContextImpl& operator=(const ContextImpl&) = delete;
    ~ContextImpl();

    /// An Error for a VkResult that is not a success, with `what` it was that failed. Remembers a lost device.
    [[nodiscard]] Error failure(VkResult result, const char* what) noexcept;
    /// For a submission that cannot be waited for: the device counts as lost, and as the submission may still be
    /// using whatever there is, nothing of this context is destroyed any more.
    void giveUp(VkResult result) noexcept;
    /// Success, or the sticky error of a lost device.
    [[nodiscard]] Result<void> alive() const;
    /// The same, and the refusal of a null command buffer, before anything is recorded.
    [[nodiscard]] Result<void> recordable(VkCommandBuffer commandBuffer) const;
    void log(const std::string& text) const noexcept;
    /// The family's timestamps have this many valid bits; 0: it has none.
    /// Of images of a format, by whether it can be filtered linearly.
    [[nodiscard]] VkSampler samplerOf(bool filtered) const noexcept { return filtered ? sampler : nearestSampler; }
    /// Lets the families of ContextDesc::queueFamilies share what is made, where there are several.
    template <class CreateInfo> void share(CreateInfo& info) const noexcept {
        if (queueFamilies.size() > 1) {
            info.sharingMode = VK_SHARING_MODE_CONCURRENT;
            info.queueFamilyIndexCount = static_cast<std::uint32_t>(queueFamilies.size());
            info.pQueueFamilyIndices = queueFamilies.data();
        }
    }
    [[nodiscard]] std::uint32_t timestampBits(std::uint32_t family) const;
    /// Refuses a queue family that the device does not have, or that has none of `anyOf`. `what` begins the text.
    [[nodiscard]] Result<void> checkFamily(std::uint32_t family, VkQueueFlags anyOf, const char* what) const;

  private:
    [[nodiscard]] std::vector<VkQueueFamilyProperties> families() const;
};

} // namespace voxtact
