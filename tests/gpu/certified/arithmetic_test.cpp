// SPDX-License-Identifier: MIT
// The self-test's arithmetic: the device does as the host; and a device that does not is found out, by the name of the
// operation. Such devices are made by other instructions in the one shader that asks.
#include "device/detector/arithmetic_check.h"
#include "gpu_fixture.h"
#include "interception.h"
#include "voxtact_shaders/operations_comp.h"
#include "voxtact_shaders/operations_doubles_comp.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <span>
#include <vector>

namespace voxtact::test {
namespace {

using testing::HasSubstr;

/// Makes one instruction of a shader another one.
struct Mistake {
    const char* name;
    std::uint32_t from;    ///< SpvOp
    std::uint32_t to;      ///< SpvOp with the same operands
    std::uint32_t extOf;   ///< of OpExtInst: only GLSL.std.450's function of that number; else 0
    std::uint32_t extTo;   ///< and what it becomes
    const char* operation; ///< what the self-test must name
};

constexpr Mistake kMistakes[] = {
    {"FAdd", 129, 131, 0, 0, "float addition"},
    {"FMul", 133, 129, 0, 0, "float multiplication"},
    {"ConvertSToF", 111, 112, 0, 0, "int to float"},
    {"FOrdLessThan", 184, 185, 0, 0, "float comparison with NaN and infinity"},
    {"AtomicIAdd", 234, 241, 0, 0, "sums of work groups"},
    {"Floor", 12, 12, 8, 3, "floor"},
};

const Mistake* mistake = nullptr;
std::size_t changed = 0; ///< instructions that became others
PFN_vkCreateShaderModule realCreate = nullptr;

/// Whether it is operations.comp: the last words are, whatever was added before.
bool asksForOperations(const VkShaderModuleCreateInfo& info) {
    constexpr std::size_t kWords = 64;
    const std::size_t words = info.codeSize / sizeof(std::uint32_t);
    const auto is = [&](std::span<const std::uint32_t> module) {
        return words > kWords &&
               std::ranges::equal(module.last(kWords), std::span(info.pCode + words - kWords, kWords));
    };
    return is(spirv::operations_comp) || is(spirv::operations_doubles_comp);
}

VkResult VKAPI_PTR createMistaken(VkDevice device, const VkShaderModuleCreateInfo* info,
                                  const VkAllocationCallbacks* allocator, VkShaderModule* module) {
    if (mistake == nullptr || !asksForOperations(*info)) {
        return realCreate(device, info, allocator, module);
    }
    std::vector<std::uint32_t> code(info->pCode, info->pCode + info->codeSize / sizeof(std::uint32_t));
    for (std::size_t at = 5; at < code.size(); at += std::max(code[at] >> 16U, 1U)) {
        if ((code[at] & 0xffffU) != mistake->from || (mistake->extOf != 0 && code[at + 4] != mistake->extOf)) {
            continue;
        }
        code[at] = (code[at] & 0xffff0000U) | mistake->to;
        if (mistake->extOf != 0) {
            code[at + 4] = mistake->extTo;
        }
        ++changed;
    }
    VkShaderModuleCreateInfo other = *info;
    other.pCode = code.data();
    return realCreate(device, &other, allocator, module);
}

class ArithmeticTest : public GpuTest {
  protected:
    void SetUp() override {
        GpuTest::SetUp();
        if (!IsSkipped() && !context().supports(CountingMethod::Compute)) {
            GTEST_SKIP() << "the device cannot count by compute";
        }
    }
};

TEST_F(ArithmeticTest, TheDeviceDoesAsTheHost) {
    const ArithmeticVerdict verdict = take(checkArithmetic(context(), queue()));
    EXPECT_EQ(verdict.wrong, "");
    EXPECT_GE(verdict.operations, 35U);
}

TEST_F(ArithmeticTest, AWrongOperationIsNamedAndItsMethodNotTrusted) {
    Interception loader(gpu().instance.getInstanceProcAddr());
    ContextDesc desc = gpu().device.contextDesc();
    realCreate = reinterpret_cast<PFN_vkCreateShaderModule>(reinterpret_cast<PFN_vkGetDeviceProcAddr>(
        desc.getInstanceProcAddr(desc.instance, "vkGetDeviceProcAddr"))(desc.device, "vkCreateShaderModule"));
    loader.replace("vkCreateShaderModule", &createMistaken);
    desc.getInstanceProcAddr = Interception::getInstanceProcAddr();
    for (const Mistake& each : kMistakes) {
        mistake = &each;
        changed = 0;
        const Context context = take(Context::create(desc));
        const ArithmeticVerdict verdict = take(checkArithmetic(context, queue()));
        EXPECT_GT(changed, 0U) << each.name << ": the shader has no such instruction";
        EXPECT_THAT(verdict.wrong, HasSubstr(each.operation)) << each.name;
        EXPECT_EQ(verdict.wrong.find('\n'), std::string::npos);
        if (&each == std::begin(kMistakes)) {
            constexpr CountingMethod kCompute[] = {CountingMethod::Compute};
            const std::vector<SelfTestVerdict> verdicts = take(selfTest(context, queue(), kCompute));
            ASSERT_EQ(verdicts.size(), 1U);
            EXPECT_FALSE(verdicts[0].trusted);
            EXPECT_THAT(verdicts[0].text, HasSubstr("not as on the host: " + verdict.wrong));
        }
        mistake = nullptr;
    }
}

} // namespace
} // namespace voxtact::test
