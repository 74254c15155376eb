// SPDX-License-Identifier: MIT
#pragma once

#include "ledger.h"

#include <functional>
#include <optional>
#include <string>
#include <unordered_map>

namespace voxtact::test {

/// One call is to fail: the number, from 0 on, among all calls of functions that return a VkResult, and with what.
struct Fault {
    std::uint64_t call = 0;
    VkResult result = VK_ERROR_OUT_OF_HOST_MEMORY;
    bool late = false; ///< the driver does what it is asked to, and then the call fails
};

/// Whether a function may fail with a result, and late.
[[nodiscard]] bool canFail(const std::string& function, const Fault& fault);

/// A loader between voxtact and the one beneath. It counts the calls that can fail, makes one of them fail, leaves
/// garbage where the specification says that a failed call leaves nothing of use, and keeps a Ledger. One at a time in
/// a process, because Vulkan's loader functions carry no user pointer.
class FaultTable {
  public:
    /// `afterLoss` is called when the fault was a lost device, before the call returns: the driver beneath then has
    /// nothing in flight any more.
    FaultTable(PFN_vkGetInstanceProcAddr beneath, std::function<void()> afterLoss);
    FaultTable(const FaultTable&) = delete;
    FaultTable& operator=(const FaultTable&) = delete;
    ~FaultTable();

    /// What a Context is given.
    [[nodiscard]] static PFN_vkGetInstanceProcAddr getInstanceProcAddr();

    /// Counts from 0 again, with a fault to come or without one.
    void arm(const std::optional<Fault>& fault);
    /// The names of the functions that were called since, in order.
    [[nodiscard]] const std::vector<const char*>& calls() const noexcept { return calls_; }
    /// While it is paused nothing is counted, and nothing fails.
    void pause(bool paused) noexcept { paused_ = paused; }
    /// The function that was made to fail since arm(); empty: none.
    [[nodiscard]] const std::string& failed() const noexcept { return failed_; }
    [[nodiscard]] const std::optional<Fault>& fault() const noexcept { return fault_; }
    [[nodiscard]] Ledger& ledger() noexcept { return ledger_; }

    /// For the functions that stand in. Counts a call; whether it is to fail, and with what.
    [[nodiscard]] std::optional<VkResult> enter(const char* function);
    /// Whether the driver is asked although the call fails.
    [[nodiscard]] bool reachesDriver() const noexcept { return fault_ && fault_->late; }

  private:
    static PFN_vkVoidFunction VKAPI_PTR fromInstance(VkInstance instance, const char* name);
    static PFN_vkVoidFunction VKAPI_PTR fromDevice(VkDevice device, const char* name);
    /// The function that stands in for `real`, or `real` itself.
    PFN_vkVoidFunction standIn(const char* name, PFN_vkVoidFunction real);

    PFN_vkGetInstanceProcAddr beneath_;
    PFN_vkGetDeviceProcAddr deviceBeneath_ = nullptr;
    std::function<void()> afterLoss_;
    std::optional<Fault> fault_;
    std::vector<const char*> calls_;
    bool paused_ = false;
    std::string failed_;
    Ledger ledger_;
};

} // namespace voxtact::test
