// SPDX-License-Identifier: MIT
#pragma once

#include "play.h"

#include <span>
#include <string>
#include <vector>

namespace voxtact::test {

inline constexpr VkResult kFaults[] = {VK_ERROR_OUT_OF_HOST_MEMORY, VK_ERROR_OUT_OF_DEVICE_MEMORY, VK_ERROR_DEVICE_LOST,
                                       VK_ERROR_INITIALIZATION_FAILED};

/// What came of one pass through a scenario.
struct Pass {
    std::string answer;
    std::string failed; ///< the function that was made to fail
    std::string error;
    std::vector<const char*> calls; ///< that could fail
    std::vector<std::string> complaints;
    bool lost = false;
};
/// Plays a scenario on a stage; the complaints are the play's and the ledger's.
[[nodiscard]] Pass play(const Scenario& scenario, const std::optional<Fault>& fault, const Stage& stage);
/// The same on a PretendDriver with a heap of so many bytes, with its complaints.
[[nodiscard]] Pass playDry(const Scenario& scenario, const std::optional<Fault>& fault, VkDeviceSize heap = 0);

struct SweepReport {
    std::uint64_t points = 0; ///< passes with a fault
    std::vector<std::string> failures;
};
/// Plays a scenario without a fault, and then once for each of its calls that can fail and each of `results` that it
/// can give, every `stride`-th of these points.
[[nodiscard]] SweepReport sweep(const std::string& name,
                                const std::function<Pass(const std::optional<Fault>&)>& playWith, std::size_t stride,
                                std::span<const VkResult> results = kFaults);
/// Prints the points, and fails the test with the failures, the first of them in words.
void expectNoFailures(const SweepReport& report);

} // namespace voxtact::test
