// SPDX-License-Identifier: MIT
// What an embedder's own messenger hears of voxtact: nothing, not even what a driver says about shaders.
#include "gpu_fixture.h"
#include "voxtact/render.h"

#include <gmock/gmock.h>

#include <string>
#include <vector>

namespace voxtact::test {
namespace {

VKAPI_ATTR VkBool32 VKAPI_CALL onMessage(VkDebugUtilsMessageSeverityFlagBitsEXT, VkDebugUtilsMessageTypeFlagsEXT,
                                         const VkDebugUtilsMessengerCallbackDataEXT* data, void* user) {
    static_cast<std::vector<std::string>*>(user)->emplace_back(data->pMessage != nullptr ? data->pMessage : "");
    return VK_FALSE;
}

class MessagesTest : public GpuTest {};

TEST_F(MessagesTest, MakingPipelinesSaysNothing) {
    const PFN_vkGetInstanceProcAddr get = gpu().instance.getInstanceProcAddr();
    const VkInstance instance = gpu().instance.handle();
    const auto make =
        reinterpret_cast<PFN_vkCreateDebugUtilsMessengerEXT>(get(instance, "vkCreateDebugUtilsMessengerEXT"));
    const auto destroy =
        reinterpret_cast<PFN_vkDestroyDebugUtilsMessengerEXT>(get(instance, "vkDestroyDebugUtilsMessengerEXT"));
    std::vector<std::string> messages;
    VkDebugUtilsMessengerCreateInfoEXT info{};
    info.sType = VK_STRUCTURE_TYPE_DEBUG_UTILS_MESSENGER_CREATE_INFO_EXT;
    info.messageSeverity =
        VK_DEBUG_UTILS_MESSAGE_SEVERITY_WARNING_BIT_EXT | VK_DEBUG_UTILS_MESSAGE_SEVERITY_ERROR_BIT_EXT;
    info.messageType = VK_DEBUG_UTILS_MESSAGE_TYPE_GENERAL_BIT_EXT | VK_DEBUG_UTILS_MESSAGE_TYPE_VALIDATION_BIT_EXT |
                       VK_DEBUG_UTILS_MESSAGE_TYPE_PERFORMANCE_BIT_EXT;
    info.pfnUserCallback = onMessage;
    info.pUserData = &messages;
    VkDebugUtilsMessengerEXT messenger = VK_NULL_HANDLE;
    ASSERT_EQ(make(instance, &info, nullptr, &messenger), VK_SUCCESS);
    {
        const Context context = take(Context::create(gpu().device.contextDesc()));
        for (const Projection projection : projections()) {
            const CountingMethod method =
                projection == Projection::Certified ? CountingMethod::Compute : context.defaultMethod();
            if (context.supports(method, projection)) {
                take(Detector::create(context, AnyDesc{.method = method, .projection = projection}));
            }
        }
        take(Renderer::create(context));
    }
    destroy(instance, messenger, nullptr);
    EXPECT_THAT(messages, testing::IsEmpty());
}

} // namespace
} // namespace voxtact::test
