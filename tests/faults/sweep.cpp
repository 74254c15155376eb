// SPDX-License-Identifier: MIT
#include "sweep.h"
#include "driver/pretend_driver.h"
#include "vulkan/own/vulkan_device.h"

#include <gtest/gtest.h>

#include <iostream>

namespace voxtact::test {

namespace {

DeviceFunctions functionsBelow(const ContextDesc& desc) {
    DeviceFunctions functions;
    functions.load(desc.getInstanceProcAddr, desc.instance, desc.device, false);
    return functions;
}

void add(const std::vector<std::string>& more, std::vector<std::string>& to) {
    to.insert(to.end(), more.begin(), more.end());
}

/// A failure of these changes nothing that anybody asked for.
bool mayBeIgnored(const std::string& function) {
    return function == "vkSetDebugUtilsObjectNameEXT";
}

std::vector<Fault> pointsOf(const Pass& clean, std::span<const VkResult> results) {
    std::vector<Fault> points;
    for (std::uint64_t call = 0; call < clean.calls.size(); ++call) {
        for (const bool late : {false, true}) {
            for (const VkResult result : results) {
                if (const Fault fault{call, result, late}; canFail(clean.calls[call], fault)) {
                    points.push_back(fault);
                }
            }
        }
    }
    return points;
}

void judge(const Pass& pass, const Pass& clean, std::vector<std::string>& out) {
    add(pass.complaints, out);
    if (pass.failed.empty()) {
        out.emplace_back("no call failed");
        return;
    }
    if (pass.error.empty() && !mayBeIgnored(pass.failed)) {
        out.emplace_back("the fault became no error");
    }
    if (!pass.lost && pass.answer != clean.answer) {
        out.push_back("the answer is another:\n" + pass.answer + "instead of\n" + clean.answer);
    }
}

} // namespace

Pass play(const Scenario& scenario, const std::optional<Fault>& fault, const Stage& stage) {
    stage.faults.arm(fault);
    Play play(stage);
    Pass pass;
    try {
        pass.answer = scenario.run(play);
    } catch (const PlayEnds&) {
        pass.answer.clear(); // play has said why
    }
    pass.failed = stage.faults.failed();
    pass.error = play.error();
    pass.calls = stage.faults.calls();
    pass.lost = play.lost();
    pass.complaints = play.complaints();
    Ledger& ledger = stage.faults.ledger();
    add(ledger.takeComplaints(), pass.complaints);
    if (!scenario.keepsObjects) {
        add(ledger.alive(), pass.complaints);
    }
    return pass;
}

Pass playDry(const Scenario& scenario, const std::optional<Fault>& fault, VkDeviceSize heap) {
    PretendDriver driver;
    driver.heap(heap);
    driver.count(scenario.countsVoxels ? PretendDriver::Counting::OpaqueVoxels : PretendDriver::Counting::Hash);
    driver.trace(scenario.traced);
    FaultTable table(PretendDriver::getInstanceProcAddr(), [&] { driver.lose(); });
    const DeviceFunctions below = functionsBelow(driver.contextDesc());
    Stage stage{table, driver.contextDesc(), PretendDriver::queueAccess(), below};
    stage.context.getInstanceProcAddr = FaultTable::getInstanceProcAddr();
    Pass pass = play(scenario, fault, stage);
    add(driver.takeComplaints(), pass.complaints);
    return pass;
}

SweepReport sweep(const std::string& name, const std::function<Pass(const std::optional<Fault>&)>& playWith,
                  std::size_t stride, std::span<const VkResult> results) {
    SweepReport report;
    const Pass clean = playWith(std::nullopt);
    for (const std::string& complaint : clean.complaints) {
        report.failures.push_back(name + ", without a fault: " + complaint);
    }
    const std::vector<Fault> points = pointsOf(clean, results);
    for (std::size_t point = 0; point < points.size(); point += stride) {
        const Fault& fault = points[point];
        const Pass pass = playWith(fault);
        ++report.points;
        std::vector<std::string> wrong;
        judge(pass, clean, wrong);
        for (const std::string& text : wrong) {
            report.failures.push_back(name + ", call " + std::to_string(fault.call) + " " + pass.failed + " with " +
                                      device::vkResultName(fault.result) + (fault.late ? " late: " : ": ") + text);
        }
    }
    return report;
}

void expectNoFailures(const SweepReport& report) {
    constexpr std::size_t kShown = 12;
    std::cout << "  " << report.points << " points\n";
    testing::Test::RecordProperty("points", static_cast<int>(report.points));
    EXPECT_GT(report.points, 0U);
    for (std::size_t i = 0; i < report.failures.size() && i < kShown; ++i) {
        ADD_FAILURE() << report.failures[i];
    }
    EXPECT_EQ(report.failures.size(), 0U);
}

} // namespace voxtact::test
