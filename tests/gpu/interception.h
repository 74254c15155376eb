// SPDX-License-Identifier: MIT
#pragma once

#include <vulkan/vulkan_core.h>

#include <string>
#include <unordered_map>

namespace voxtact::test {

/// A loader between voxtact and the real one: functions can be replaced by name. One at a time in a process, because
/// Vulkan's loader functions carry no user pointer.
class Interception {
  public:
    explicit Interception(PFN_vkGetInstanceProcAddr real);
    Interception(const Interception&) = delete;
    Interception& operator=(const Interception&) = delete;
    ~Interception();

    /// What the Context is given.
    [[nodiscard]] static PFN_vkGetInstanceProcAddr getInstanceProcAddr();

    /// From now on `name` (with its vk) is looked up as `function`; null means that the loader does not have it.
    template <class Function> void replace(const std::string& name, Function function) {
        replaced_[name] = reinterpret_cast<PFN_vkVoidFunction>(function);
    }
    /// The real device function.
    template <class Function> Function realDevice(VkDevice device, const char* name) const {
        return reinterpret_cast<Function>(realGetDeviceProcAddr_(device, name));
    }

  private:
    static PFN_vkVoidFunction VKAPI_PTR fromInstance(VkInstance instance, const char* name);
    static PFN_vkVoidFunction VKAPI_PTR fromDevice(VkDevice device, const char* name);

    PFN_vkGetInstanceProcAddr real_;
    PFN_vkGetDeviceProcAddr realGetDeviceProcAddr_ = nullptr;
    std::unordered_map<std::string, PFN_vkVoidFunction> replaced_;
};

} // namespace voxtact::test
