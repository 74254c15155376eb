// SPDX-License-Identifier: MIT
#pragma once

#include <vulkan/vulkan_core.h>

#include <cstdint>
#include <map>
#include <string>
#include <utility>
#include <vector>

namespace voxtact::test {

/// The kind of a handle, for texts and for telling handles of different kinds apart.
template <class Handle> inline constexpr const char* kHandleName = nullptr;
#define VOXTACT_HANDLE(name) template <> inline constexpr const char* kHandleName<Vk##name> = #name;
VOXTACT_HANDLE(Instance)
VOXTACT_HANDLE(Device)
VOXTACT_HANDLE(DebugUtilsMessengerEXT)
VOXTACT_HANDLE(Buffer)
VOXTACT_HANDLE(CommandBuffer)
VOXTACT_HANDLE(CommandPool)
VOXTACT_HANDLE(DescriptorPool)
VOXTACT_HANDLE(DescriptorSet)
VOXTACT_HANDLE(DescriptorSetLayout)
VOXTACT_HANDLE(DeviceMemory)
VOXTACT_HANDLE(Fence)
VOXTACT_HANDLE(Image)
VOXTACT_HANDLE(ImageView)
VOXTACT_HANDLE(Pipeline)
VOXTACT_HANDLE(PipelineLayout)
VOXTACT_HANDLE(QueryPool)
VOXTACT_HANDLE(Sampler)
VOXTACT_HANDLE(ShaderModule)
#undef VOXTACT_HANDLE

template <class Handle> std::uint64_t bitsOf(Handle handle) {
    return reinterpret_cast<std::uint64_t>(handle);
}

/// Keeps books of the handles between a caller and a driver: every one that was made must end, once.
class Ledger {
  public:
    template <class Handle> void made(Handle handle) { alive_[{kHandleName<Handle>, bitsOf(handle)}] = ++made_; }
    /// Whether the driver may be asked to end it. A handle that was never made, or has ended, is complained of.
    template <class Handle> [[nodiscard]] bool ends(Handle handle) { return ends(kHandleName<Handle>, bitsOf(handle)); }

    void complain(const std::string& what) { complaints_.push_back(what); }
    [[nodiscard]] std::vector<std::string> takeComplaints() { return std::exchange(complaints_, {}); }
    /// What has not ended, in the order in which it was made.
    [[nodiscard]] std::vector<std::string> alive() const;

  private:
    [[nodiscard]] bool ends(const char* kind, std::uint64_t bits);

    std::map<std::pair<std::string, std::uint64_t>, std::uint64_t> alive_; ///< and when it was made
    std::uint64_t made_ = 0;
    std::vector<std::string> complaints_;
};

} // namespace voxtact::test
