// SPDX-License-Identifier: MIT
// The device that the C interface opens itself.
#include "c_fixture.h"

#include <gmock/gmock.h>

#include <sys/wait.h>
#include <unistd.h>

namespace voxtact::test {
namespace {

using testing::HasSubstr;

/// The base asks for a device, or skips.
class CDevice : public CGpuTest {
  protected:
    [[nodiscard]] static Owned<vxt_device> open(const std::string& wanted) {
        return made(vxt_device_destroy, vxt_device_open, wanted.c_str());
    }
    [[nodiscard]] static vxt_device_facts factsOf(std::uint32_t index) {
        vxt_device_facts facts = sized<vxt_device_facts>();
        need(vxt_device_describe(index, &facts));
        return facts;
    }
    [[nodiscard]] static std::string refused(const char* wanted) {
        auto* device = reinterpret_cast<vxt_device*>(1);
        EXPECT_EQ(vxt_device_open(wanted, &device), VXT_ERROR_INVALID_ARGUMENT) << wanted;
        EXPECT_EQ(device, nullptr);
        return vxt_last_error(nullptr);
    }
    [[nodiscard]] static std::uint32_t count() {
        std::uint32_t number = 0;
        need(vxt_device_count(&number));
        return number;
    }
};

TEST_F(CDevice, IsDescribed) {
    ASSERT_GE(count(), 1U);
    for (std::uint32_t index = 0; index < count(); ++index) {
        const vxt_device_facts facts = factsOf(index);
        EXPECT_EQ(facts.index, index);
        EXPECT_STRNE(facts.name, "");
        EXPECT_STRNE(facts.driver, "");
        EXPECT_GE(facts.api_version, VK_API_VERSION_1_0);
        EXPECT_THAT(facts.type,
                    testing::AnyOf(testing::StrEq("discrete"), testing::StrEq("integrated"), testing::StrEq("virtual"),
                                   testing::StrEq("cpu"), testing::StrEq("other")));
    }
    vxt_device_facts facts = sized<vxt_device_facts>();
    EXPECT_EQ(vxt_device_describe(count(), &facts), VXT_ERROR_INVALID_ARGUMENT);
    EXPECT_THAT(vxt_last_error(nullptr), HasSubstr("there is no device " + std::to_string(count())));
    facts.struct_size = 0;
    EXPECT_EQ(vxt_device_describe(0, &facts), VXT_ERROR_INVALID_ARGUMENT);
    EXPECT_EQ(vxt_device_describe(0, nullptr), VXT_ERROR_INVALID_ARGUMENT);
}

TEST_F(CDevice, IsOpenedByNumberAndByPartOfItsName) {
    const vxt_device_facts first = factsOf(0);
    for (const std::string& wanted : {std::string("0"), count() == 1 ? std::string(first.name).substr(1) : "0"}) {
        const Owned<vxt_device> device = open(wanted);
        vxt_device_facts facts = sized<vxt_device_facts>();
        need(vxt_device_get_facts(device.get(), &facts));
        EXPECT_STREQ(facts.name, first.name);
        EXPECT_EQ(facts.index, 0U);
    }
    EXPECT_THAT(refused("no such device"), HasSubstr("device 'no such device' is not part of the name of a device"));
    EXPECT_THAT(refused("no such device"), HasSubstr(std::string("0 ") + first.name));
    EXPECT_THAT(refused("99"), HasSubstr("device '99' is not the number of a device"));
    EXPECT_THAT(refused("99999999999999999999999"), HasSubstr("device '9999"));
    EXPECT_EQ(refused(nullptr), "wanted is null");
}

TEST_F(CDevice, UploadsEditsAndCounts) {
    const Owned<vxt_device> device = open("");
    const vxt_context* const context = vxt_device_context(device.get());
    ASSERT_NE(context, nullptr);
    vxt_queue queue = sized<vxt_queue>();
    need(vxt_device_queue(device.get(), &queue));
    EXPECT_NE(queue.queue, VK_NULL_HANDLE);
    vxt_raster_desc desc = sized<vxt_raster_desc>();
    desc.method = vxt_context_default_method(context);
    const RandomScene scene = halfOpaque();
    // What was made with the device ends before it.
    const CScene sides(context, queue, scene, twoLabels());
    const COneItem of(sides, scene);
    const auto detector =
        made(vxt_blocking_detector_destroy, vxt_blocking_detector_create_raster, context, &desc, &queue, 0);
    EXPECT_EQ(ask(*detector, of).pairs.at(0).count, 128U);
    const vxt_voxel_box right{{3, 0, 0}, {3, 6, 6}};
    VkCommandBuffer commands = VK_NULL_HANDLE;
    need(vxt_device_begin(device.get(), &commands));
    // A refused recording is given up: the next one begins again.
    EXPECT_EQ(vxt_volume_cmd_set_box(sides.volume.get(), commands, &right, 1000), VXT_ERROR_INVALID_ARGUMENT);
    for (const auto& [value, expected] : {std::pair{255.0, 256U}, std::pair{0.0, 128U}}) {
        need(vxt_device_begin(device.get(), &commands));
        need(vxt_volume_cmd_set_box(sides.volume.get(), commands, &right, value));
        need(vxt_device_submit(device.get()));
        EXPECT_EQ(ask(*detector, of).pairs.at(0).count, expected);
    }
    EXPECT_EQ(vxt_device_begin(device.get(), nullptr), VXT_ERROR_INVALID_ARGUMENT);
    EXPECT_EQ(vxt_device_queue(device.get(), nullptr), VXT_ERROR_INVALID_ARGUMENT);
}

TEST_F(CDevice, IsRefusedInAChildProcess) {
    Owned<vxt_device> device = open("");
    const pid_t child = fork();
    ASSERT_GE(child, 0);
    if (child == 0) {
        vxt_queue queue = sized<vxt_queue>();
        VkCommandBuffer commands = VK_NULL_HANDLE;
        const bool isRefused = vxt_device_context(device.get()) == nullptr &&
                               vxt_device_queue(device.get(), &queue) == VXT_ERROR_UNSUPPORTED &&
                               vxt_device_begin(device.get(), &commands) == VXT_ERROR_UNSUPPORTED &&
                               vxt_device_submit(device.get()) == VXT_ERROR_UNSUPPORTED &&
                               std::string(vxt_last_error(nullptr)).find("forked") != std::string::npos;
        device.reset();
        _exit(isRefused ? 0 : 1);
    }
    int status = -1;
    ASSERT_EQ(waitpid(child, &status, 0), child);
    EXPECT_TRUE(WIFEXITED(status));
    EXPECT_EQ(WEXITSTATUS(status), 0);
}

} // namespace
} // namespace voxtact::test
