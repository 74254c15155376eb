// SPDX-License-Identifier: MIT
#include "vulkan/float_controls.h"

#include "voxtact_shaders/bricks_comp.h"
#include "voxtact_shaders/certified_finish_comp.h"
#include "voxtact_shaders/compute_comp.h"
#include "voxtact_shaders/dominant_vert.h"
#include "voxtact_shaders/pair_setup_comp.h"
#include "voxtact_shaders/view_frag.h"

#include <gmock/gmock.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <random>
#include <string>

namespace voxtact::test {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;
using Words = std::vector<std::uint32_t>;

constexpr FloatControls kAll{true, true, true};

std::vector<std::span<const std::uint32_t>> modules() {
    return {spirv::bricks_comp, spirv::certified_finish_comp, spirv::compute_comp, spirv::dominant_vert,
            spirv::view_frag};
}

/// The operands of all instructions of a kind.
std::vector<Words> operandsOf(std::span<const std::uint32_t> spirv, std::uint32_t opcode) {
    std::vector<Words> out;
    for (std::size_t at = 5; at < spirv.size(); at += spirv[at] >> 16U) {
        if ((spirv[at] & 0xffffU) == opcode) {
            out.emplace_back(spirv.begin() + static_cast<std::ptrdiff_t>(at) + 1,
                             spirv.begin() + static_cast<std::ptrdiff_t>(at + (spirv[at] >> 16U)));
        }
    }
    return out;
}

TEST(FloatControlsTest, NothingIsAskedForThatIsNotPromised) {
    for (const std::span<const std::uint32_t> module : modules()) {
        EXPECT_EQ(withFloatControls(module, {}), Words(module.begin(), module.end()));
    }
    EXPECT_THAT(withFloatControls({}, kAll), IsEmpty());
}

/// Of both widths, where a module has both; denormals it does not mention then.
TEST(FloatControlsTest, DoublesAskForTheSame) {
    const std::span<const std::uint32_t> module = spirv::pair_setup_comp;
    const Words out = withFloatControls(module, kAll);
    std::vector<Words> modes = operandsOf(out, 16);
    const std::uint32_t main = operandsOf(module, 15).at(0).at(1);
    ASSERT_EQ(modes.size(), operandsOf(module, 16).size() + 4);
    EXPECT_THAT(std::span(modes).first(4), ElementsAre(Words{main, 4461, 32}, Words{main, 4461, 64},
                                                       Words{main, 4462, 32}, Words{main, 4462, 64}));
}

TEST(FloatControlsTest, EveryEntryPointAsksForWhatIs) {
    for (const std::span<const std::uint32_t> module : modules()) {
        const Words out = withFloatControls(module, kAll);
        EXPECT_EQ(out.size(), module.size() + 3 * 2 + 3 * 4);
        const std::vector<Words> before = operandsOf(module, 16);
        std::vector<Words> modes = operandsOf(out, 16);
        ASSERT_EQ(modes.size(), before.size() + 3);
        const std::uint32_t main = operandsOf(module, 15).at(0).at(1);
        EXPECT_THAT(std::span(modes).first(3),
                    ElementsAre(Words{main, 4459, 32}, Words{main, 4461, 32}, Words{main, 4462, 32}));
        modes.erase(modes.begin(), modes.begin() + 3);
        EXPECT_EQ(modes, before);
    }
    const Words one = withFloatControls(spirv::certified_finish_comp, {.roundsToNearest = true});
    EXPECT_EQ(one.size(), std::size(spirv::certified_finish_comp) + 2 + 4);
    EXPECT_THAT(operandsOf(one, 17).at(0), ElementsAre(4467));
}

/// Two entry points, the second with an execution mode of its own.
TEST(FloatControlsTest, ModesComeBehindTheLastEntryPoint) {
    const Words header{0x07230203, 0x00010500, 0, 9, 0};
    const Words before{0x20011, 1, 0x3000e, 0, 1, 0x4000f, 5, 7, 0, 0x4000f, 5, 8, 0};
    const Words behind{0x60010, 8, 17, 1, 1, 1, 0x20013, 2};
    Words module = header;
    module.insert(module.end(), before.begin(), before.end());
    module.insert(module.end(), behind.begin(), behind.end());
    Words wanted = header;
    wanted.insert(wanted.end(), {0x20011, 4466});
    wanted.insert(wanted.end(), before.begin(), before.end());
    wanted.insert(wanted.end(), {0x40010, 7, 4461, 32, 0x40010, 8, 4461, 32});
    wanted.insert(wanted.end(), behind.begin(), behind.end());
    EXPECT_EQ(withFloatControls(module, {.keepsSpecials = true}), wanted);
}

/// Also what the device at hand does not promise.
TEST(FloatControlsTest, TheModulesAreValid) {
    const std::filesystem::path path = std::filesystem::temp_directory_path() /
                                       ("voxtact_float_controls_" + std::to_string(std::random_device{}()) + ".spv");
    for (const std::span<const std::uint32_t> module : modules()) {
        const Words out = withFloatControls(module, kAll);
        std::ofstream(path, std::ios::binary)
            .write(reinterpret_cast<const char*>(out.data()),
                   static_cast<std::streamsize>(out.size() * sizeof(std::uint32_t)));
        const std::string command =
            std::string("\"") + VOXTACT_SPIRV_VAL + "\" --target-env vulkan1.2 \"" + path.string() + "\"";
        EXPECT_EQ(std::system(command.c_str()), 0) << command;
    }
    std::filesystem::remove(path);
}

} // namespace
} // namespace voxtact::test
