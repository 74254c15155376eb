// SPDX-License-Identifier: MIT
// Every call that can fail, of every scenario, failing once, on a driver that only pretends.
#include "scenarios.h"
#include "sweep.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cctype>

namespace voxtact::test {
namespace {

class DrySweep : public testing::TestWithParam<Scenario> {};

TEST_P(DrySweep, EveryCallFailsOnce) {
    const Scenario& scenario = GetParam();
    expectNoFailures(sweep(
        scenario.name, [&](const std::optional<Fault>& fault) { return playDry(scenario, fault); }, 1));
}

/// Where objects share blocks of memory, which are not coherent either.
TEST_P(DrySweep, EveryCallFailsOnceWithSharedBlocks) {
    constexpr VkDeviceSize kHeap = VkDeviceSize{1} << 20U;
    constexpr VkResult kResults[] = {VK_ERROR_OUT_OF_DEVICE_MEMORY};
    const Scenario& scenario = GetParam();
    expectNoFailures(sweep(
        scenario.name, [&](const std::optional<Fault>& fault) { return playDry(scenario, fault, kHeap); }, 1,
        kResults));
}

std::vector<Scenario> allScenarios() {
    std::vector<Scenario> all;
    for (const auto make : {sceneScenarios, detectScenarios, editScenarios, renderScenarios}) {
        const std::vector<Scenario> some = make();
        all.insert(all.end(), some.begin(), some.end());
    }
    return all;
}

INSTANTIATE_TEST_SUITE_P(All, DrySweep, testing::ValuesIn(allScenarios()),
                         [](const testing::TestParamInfo<Scenario>& scenario) {
                             std::string name = scenario.param.name;
                             std::ranges::replace_if(
                                 name, [](char c) { return std::isalnum(c) == 0; }, '_');
                             return name;
                         });

} // namespace
} // namespace voxtact::test
