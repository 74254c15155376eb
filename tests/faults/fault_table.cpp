// SPDX-License-Identifier: MIT
#include "fault_table.h"
#include "vulkan/device_functions.h"

#include <algorithm>
#include <cstring>

// What the program's own instance and device call in addition to what the library does (src/device).
#define VOXTACT_OWNER_FUNCTIONS(X)                                                                                     \
    X(CreateInstance)                                                                                                  \
    X(DestroyInstance)                                                                                                 \
    X(EnumerateInstanceLayerProperties)                                                                                \
    X(EnumerateInstanceExtensionProperties)                                                                            \
    X(EnumeratePhysicalDevices)                                                                                        \
    X(EnumerateDeviceExtensionProperties)                                                                              \
    X(CreateDevice)                                                                                                    \
    X(DestroyDevice)                                                                                                   \
    X(CreateDebugUtilsMessengerEXT)                                                                                    \
    X(DestroyDebugUtilsMessengerEXT)

namespace voxtact::test {

namespace {

FaultTable* current = nullptr;

constexpr int kGarbage = 0xEB;

// NOLINTNEXTLINE(bugprone-sizeof-expression): handles are pointers.
template <class Out> void spoil(Out* out, std::size_t bytes = sizeof(Out)) {
    std::memset(static_cast<void*>(out), kGarbage, bytes);
}

/// What the calls of one kind leave behind, told apart by their signatures. `fail` is what a failed call does to its
/// outputs, `succeed` what is booked of one that did not fail. Most calls leave nothing.
struct Outputs {
    template <class... Arguments> static void fail(Arguments...) {}
    template <class... Arguments> static void succeed(Ledger&, Arguments...) {}

    // vkCreateBuffer and all the like, vkAllocateMemory
    template <class Parent, class Info, class Handle>
    static void fail(Parent, const Info*, const VkAllocationCallbacks*, Handle* out) {
        spoil(out);
    }
    template <class Parent, class Info, class Handle>
    static void succeed(Ledger& ledger, Parent, const Info*, const VkAllocationCallbacks*, Handle* out) {
        ledger.made(*out);
    }
    // vkCreateInstance
    static void fail(const VkInstanceCreateInfo*, const VkAllocationCallbacks*, VkInstance* out) { spoil(out); }
    static void succeed(Ledger& ledger, const VkInstanceCreateInfo*, const VkAllocationCallbacks*, VkInstance* out) {
        ledger.made(*out);
    }
    // Pipelines, sets and command buffers that were not made are null: the specification says so.
    template <class Info>
    static void fail(VkDevice, VkPipelineCache, std::uint32_t count, const Info*, const VkAllocationCallbacks*,
                     VkPipeline* out) {
        std::fill_n(out, count, VkPipeline{});
    }
    template <class Info>
    static void succeed(Ledger& ledger, VkDevice, VkPipelineCache, std::uint32_t count, const Info*,
                        const VkAllocationCallbacks*, VkPipeline* out) {
        for (std::uint32_t i = 0; i < count; ++i) {
            ledger.made(out[i]);
        }
    }
    static void fail(VkDevice, const VkDescriptorSetAllocateInfo* info, VkDescriptorSet* out) {
        std::fill_n(out, info->descriptorSetCount, VkDescriptorSet{});
    }
    static void fail(VkDevice, const VkCommandBufferAllocateInfo* info, VkCommandBuffer* out) {
        std::fill_n(out, info->commandBufferCount, VkCommandBuffer{});
    }
    // vkMapMemory
    static void fail(VkDevice, VkDeviceMemory, VkDeviceSize, VkDeviceSize, VkMemoryMapFlags, void** out) { spoil(out); }
    // vkGetQueryPoolResults
    static void fail(VkDevice, VkQueryPool, std::uint32_t, std::uint32_t, std::size_t bytes, void* out, VkDeviceSize,
                     VkQueryResultFlags) {
        spoil(static_cast<std::byte*>(out), bytes);
    }
    // vkGetPhysicalDeviceImageFormatProperties
    static void fail(VkPhysicalDevice, VkFormat, VkImageType, VkImageTiling, VkImageUsageFlags, VkImageCreateFlags,
                     VkImageFormatProperties* out) {
        spoil(out);
    }
    // Lists of properties and devices
    template <class Element> static void fail(std::uint32_t* count, Element*) { spoil(count); }
    template <class Element> static void fail(const char*, std::uint32_t* count, Element*) { spoil(count); }
    template <class Element> static void fail(VkPhysicalDevice, const char*, std::uint32_t* count, Element*) {
        spoil(count);
    }
    static void fail(VkInstance, std::uint32_t* count, VkPhysicalDevice*) { spoil(count); }
};

/// Whether a function that returns nothing may go on to the driver: not where it would end what is not there.
struct Endings {
    template <class... Arguments> static bool allow(Ledger&, Arguments...) { return true; }
    template <class Parent, class Handle>
    static bool allow(Ledger& ledger, Parent, Handle handle, const VkAllocationCallbacks*) {
        return ledger.ends(handle);
    }
    template <class Handle> static bool allow(Ledger& ledger, Handle handle, const VkAllocationCallbacks*) {
        return ledger.ends(handle);
    }
};

enum class Call : std::uint32_t {
#define VOXTACT_CALL(name) name,
    VOXTACT_INSTANCE_FUNCTIONS(VOXTACT_CALL) VOXTACT_DEVICE_FUNCTIONS(VOXTACT_CALL)
        VOXTACT_DEBUG_FUNCTIONS(VOXTACT_CALL) VOXTACT_OWNER_FUNCTIONS(VOXTACT_CALL)
#undef VOXTACT_CALL
};

constexpr const char* kNames[] = {
#define VOXTACT_NAME(name) "vk" #name,
    VOXTACT_INSTANCE_FUNCTIONS(VOXTACT_NAME) VOXTACT_DEVICE_FUNCTIONS(VOXTACT_NAME)
        VOXTACT_DEBUG_FUNCTIONS(VOXTACT_NAME) VOXTACT_OWNER_FUNCTIONS(VOXTACT_NAME)
#undef VOXTACT_NAME
};

/// The function that stands in for one of Vulkan's.
template <Call call, class Function> struct Hook;
template <Call call, class Return, class... Arguments> struct Hook<call, Return(VKAPI_PTR*)(Arguments...)> {
    static inline Return(VKAPI_PTR* real)(Arguments...) = nullptr;

    static Return VKAPI_PTR enter(Arguments... arguments) {
        if constexpr (std::is_same_v<Return, VkResult>) {
            if (const std::optional<VkResult> fault = current->enter(kNames[static_cast<std::size_t>(call)])) {
                if (current->reachesDriver()) {
                    real(arguments...);
                } else {
                    Outputs::fail(arguments...);
                }
                return *fault;
            }
            const VkResult result = real(arguments...);
            if (result == VK_SUCCESS) {
                Outputs::succeed(current->ledger(), arguments...);
            }
            return result;
        } else if constexpr (std::is_void_v<Return>) {
            if (Endings::allow(current->ledger(), arguments...)) {
                real(arguments...);
            }
        } else {
            return real(arguments...);
        }
    }
    static PFN_vkVoidFunction over(PFN_vkVoidFunction beneath) {
        real = reinterpret_cast<Return(VKAPI_PTR*)(Arguments...)>(beneath);
        return reinterpret_cast<PFN_vkVoidFunction>(&enter);
    }
};

using Over = PFN_vkVoidFunction (*)(PFN_vkVoidFunction);
const std::unordered_map<std::string, Over>& hooks() {
    static const std::unordered_map<std::string, Over> all{
#define VOXTACT_HOOK(name) {"vk" #name, &Hook<Call::name, PFN_vk##name>::over},
        VOXTACT_INSTANCE_FUNCTIONS(VOXTACT_HOOK) VOXTACT_DEVICE_FUNCTIONS(VOXTACT_HOOK)
            VOXTACT_DEBUG_FUNCTIONS(VOXTACT_HOOK) VOXTACT_OWNER_FUNCTIONS(VOXTACT_HOOK)
#undef VOXTACT_HOOK
    };
    return all;
}

} // namespace

bool canFail(const std::string& function, const Fault& fault) {
    const bool lost = fault.result == VK_ERROR_DEVICE_LOST;
    const bool memory = fault.result == VK_ERROR_OUT_OF_HOST_MEMORY || fault.result == VK_ERROR_OUT_OF_DEVICE_MEMORY;
    if (fault.late) {
        // Vulkan promises that nothing was submitted for want of memory.
        return !lost && ((function == "vkQueueSubmit2" && !memory) || function == "vkWaitForFences" ||
                         function == "vkResetFences");
    }
    // Giving a name cannot lose a device.
    return !lost || function != "vkSetDebugUtilsObjectNameEXT";
}

FaultTable::FaultTable(PFN_vkGetInstanceProcAddr beneath, std::function<void()> afterLoss)
    : beneath_(beneath), afterLoss_(std::move(afterLoss)) {
    current = this;
}

FaultTable::~FaultTable() {
    current = nullptr;
}

PFN_vkGetInstanceProcAddr FaultTable::getInstanceProcAddr() {
    return &FaultTable::fromInstance;
}

void FaultTable::arm(const std::optional<Fault>& fault) {
    fault_ = fault;
    calls_.clear();
    failed_.clear();
}

std::optional<VkResult> FaultTable::enter(const char* function) {
    if (paused_) {
        return std::nullopt;
    }
    const std::uint64_t number = calls_.size();
    calls_.push_back(function);
    // Where there is no room for a block of memory, less is asked for at once: there is no room for that either.
    const bool again = failed_ == function && failed_ == "vkAllocateMemory" && number == fault_->call + 1;
    if (!fault_ || (fault_->call != number && !again)) {
        return std::nullopt;
    }
    failed_ = function;
    if (fault_->result == VK_ERROR_DEVICE_LOST && afterLoss_) {
        afterLoss_();
    }
    return fault_->result;
}

PFN_vkVoidFunction FaultTable::standIn(const char* name, PFN_vkVoidFunction real) {
    if (real == nullptr) {
        return nullptr;
    }
    const auto found = hooks().find(name);
    return found == hooks().end() ? real : found->second(real);
}

PFN_vkVoidFunction VKAPI_PTR FaultTable::fromInstance(VkInstance instance, const char* name) {
    const PFN_vkVoidFunction real = current->beneath_(instance, name);
    if (std::strcmp(name, "vkGetDeviceProcAddr") == 0) {
        current->deviceBeneath_ = reinterpret_cast<PFN_vkGetDeviceProcAddr>(real);
        return reinterpret_cast<PFN_vkVoidFunction>(&FaultTable::fromDevice);
    }
    return current->standIn(name, real);
}

PFN_vkVoidFunction VKAPI_PTR FaultTable::fromDevice(VkDevice device, const char* name) {
    return current->standIn(name, current->deviceBeneath_(device, name));
}

} // namespace voxtact::test
