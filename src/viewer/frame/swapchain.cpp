// SPDX-License-Identifier: MIT
#include "viewer/frame/swapchain.h"

#include "core/base/try.h"
#include "vulkan/own/created.h"
#include "vulkan/own/enumerate.h"

#include <algorithm>
#include <limits>
#include <utility>

namespace voxtact::view {

namespace {

template <class Function> Function instanceFunction(const device::VulkanDevice& device, const char* name) {
    const ContextDesc& desc = device.contextDesc();
    return reinterpret_cast<Function>(desc.getInstanceProcAddr(desc.instance, name));
}

/// Returns the requested extent if the window lets its client choose.
VkExtent2D extentFor(const VkSurfaceCapabilitiesKHR& can, VkExtent2D wanted) {
    if (can.currentExtent.width != std::numeric_limits<std::uint32_t>::max()) {
        return can.currentExtent;
    }
    return {std::clamp(wanted.width, can.minImageExtent.width, can.maxImageExtent.width),
            std::clamp(wanted.height, can.minImageExtent.height, can.maxImageExtent.height)};
}

VkCompositeAlphaFlagBitsKHR alphaOf(const VkSurfaceCapabilitiesKHR& can) {
    return (can.supportedCompositeAlpha & VK_COMPOSITE_ALPHA_OPAQUE_BIT_KHR) != 0 ? VK_COMPOSITE_ALPHA_OPAQUE_BIT_KHR
                                                                                  : VK_COMPOSITE_ALPHA_INHERIT_BIT_KHR;
}

} // namespace

Result<Swapchain> Swapchain::create(const device::VulkanDevice& device, VkSurfaceKHR surface) {
    Swapchain out(device, surface);
    VkBool32 supported = VK_FALSE;
    const auto ask =
        instanceFunction<PFN_vkGetPhysicalDeviceSurfaceSupportKHR>(device, "vkGetPhysicalDeviceSurfaceSupportKHR");
    const VkResult result = ask(device.contextDesc().physicalDevice, device.queueAccess().family, surface, &supported);
    if (result != VK_SUCCESS) {
        return device::vulkanError(result, "querying whether the device can present to a window");
    }
    if (supported != VK_TRUE) {
        return Error{ErrorCode::Unsupported, 0,
                     "the device '" + device.physical().name +
                         "' cannot present to a window of this display; choose another with --device"};
    }
    VOXTACT_TRY(out.chooseFormat());
    return out;
}

Swapchain::Swapchain(Swapchain&& other) noexcept
    : device_(other.device_), surface_(std::exchange(other.surface_, VK_NULL_HANDLE)), format_(other.format_),
      swapchain_(std::exchange(other.swapchain_, VK_NULL_HANDLE)), extent_(other.extent_),
      images_(std::move(other.images_)), views_(std::move(other.views_)), drawn_(std::move(other.drawn_)),
      stale_(other.stale_) {
    other.views_.clear();
    other.drawn_.clear();
}

Swapchain::~Swapchain() {
    destroyImages();
    if (swapchain_ != VK_NULL_HANDLE) {
        device_->table().vkDestroySwapchainKHR(device_->handle(), swapchain_, nullptr);
    }
    if (surface_ != VK_NULL_HANDLE) {
        instanceFunction<PFN_vkDestroySurfaceKHR>(*device_, "vkDestroySurfaceKHR")(device_->contextDesc().instance,
                                                                                   surface_, nullptr);
    }
}

void Swapchain::destroyImages() noexcept {
    for (VkImageView view : views_) {
        device_->table().vkDestroyImageView(device_->handle(), view, nullptr);
    }
    for (VkSemaphore semaphore : drawn_) {
        device_->table().vkDestroySemaphore(device_->handle(), semaphore, nullptr);
    }
    views_.clear();
    drawn_.clear();
    images_.clear();
}

/// Panels and pictures have sRGB colours already: no second conversion.
Result<void> Swapchain::chooseFormat() {
    const auto list =
        instanceFunction<PFN_vkGetPhysicalDeviceSurfaceFormatsKHR>(*device_, "vkGetPhysicalDeviceSurfaceFormatsKHR");
    const auto formats = device::enumerate<VkSurfaceFormatKHR>("listing the formats of the window", [&](auto... to) {
        return list(device_->contextDesc().physicalDevice, surface_, to...);
    });
    VOXTACT_TRY(formats);
    for (const VkFormat wanted : {VK_FORMAT_B8G8R8A8_UNORM, VK_FORMAT_R8G8B8A8_UNORM}) {
        const auto found =
            std::ranges::find_if(*formats, [wanted](const VkSurfaceFormatKHR& one) { return one.format == wanted; });
        if (found != formats->end()) {
            format_ = *found;
            return {};
        }
    }
    return Error{ErrorCode::Unsupported, 0,
                 "the window has no format of 8 bits a channel; choose another device with --device"};
}

Result<void> Swapchain::resize(VkExtent2D extent) {
    const auto ask = instanceFunction<PFN_vkGetPhysicalDeviceSurfaceCapabilitiesKHR>(
        *device_, "vkGetPhysicalDeviceSurfaceCapabilitiesKHR");
    VkSurfaceCapabilitiesKHR can{};
    VkResult result = ask(device_->contextDesc().physicalDevice, surface_, &can);
    if (result != VK_SUCCESS) {
        return device::vulkanError(result, "querying the size of the window");
    }
    extent_ = extentFor(can, extent);
    stale_ = true;
    if (extent_.width == 0 || extent_.height == 0) {
        return {};
    }
    destroyImages();
    VkSwapchainCreateInfoKHR info{};
    info.sType = VK_STRUCTURE_TYPE_SWAPCHAIN_CREATE_INFO_KHR;
    info.surface = surface_;
    info.minImageCount = std::max<std::uint32_t>(can.minImageCount, 3);
    if (can.maxImageCount != 0) {
        info.minImageCount = std::min(info.minImageCount, can.maxImageCount);
    }
    info.imageFormat = format_.format;
    info.imageColorSpace = format_.colorSpace;
    info.imageExtent = extent_;
    info.imageArrayLayers = 1;
    info.imageUsage = VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT;
    info.preTransform = can.currentTransform;
    info.compositeAlpha = alphaOf(can);
    info.presentMode = VK_PRESENT_MODE_FIFO_KHR;
    info.clipped = VK_TRUE;
    info.oldSwapchain = swapchain_;
    VkSwapchainKHR made = VK_NULL_HANDLE;
    result =
        device::createdOrNull(device_->table().vkCreateSwapchainKHR(device_->handle(), &info, nullptr, &made), made);
    device_->table().vkDestroySwapchainKHR(device_->handle(), swapchain_, nullptr);
    swapchain_ = made;
    if (result != VK_SUCCESS) {
        return device::vulkanError(result, "making the images of the window");
    }
    VOXTACT_TRY(makeViews());
    stale_ = false;
    return {};
}

Result<void> Swapchain::makeViews() {
    const auto images = device::enumerate<VkImage>("listing the images of the window", [this](auto... to) {
        return device_->table().vkGetSwapchainImagesKHR(device_->handle(), swapchain_, to...);
    });
    VOXTACT_TRY(images);
    images_ = *images;
    for (VkImage image : images_) {
        VkImageViewCreateInfo info{};
        info.sType = VK_STRUCTURE_TYPE_IMAGE_VIEW_CREATE_INFO;
        info.image = image;
        info.viewType = VK_IMAGE_VIEW_TYPE_2D;
        info.format = format_.format;
        info.subresourceRange = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 1, 0, 1};
        VkImageView view = VK_NULL_HANDLE;
        VkResult result =
            device::createdOrNull(device_->table().vkCreateImageView(device_->handle(), &info, nullptr, &view), view);
        views_.push_back(view);
        VkSemaphoreCreateInfo semaphoreInfo{};
        semaphoreInfo.sType = VK_STRUCTURE_TYPE_SEMAPHORE_CREATE_INFO;
        VkSemaphore semaphore = VK_NULL_HANDLE;
        if (result == VK_SUCCESS) {
            result = device::createdOrNull(
                device_->table().vkCreateSemaphore(device_->handle(), &semaphoreInfo, nullptr, &semaphore), semaphore);
        }
        drawn_.push_back(semaphore);
        if (result != VK_SUCCESS) {
            return device::vulkanError(result, "making the images of the window");
        }
    }
    return {};
}

Result<bool> Swapchain::acquire(VkSemaphore acquired, std::uint32_t& image) {
    const VkResult result = device_->table().vkAcquireNextImageKHR(
        device_->handle(), swapchain_, std::numeric_limits<std::uint64_t>::max(), acquired, VK_NULL_HANDLE, &image);
    if (result == VK_ERROR_OUT_OF_DATE_KHR) {
        stale_ = true;
        return false;
    }
    if (result != VK_SUCCESS && result != VK_SUBOPTIMAL_KHR) {
        return device::vulkanError(result, "acquiring an image of the window");
    }
    stale_ = result == VK_SUBOPTIMAL_KHR;
    return true;
}

Result<void> Swapchain::present(VkQueue queue, std::uint32_t image) {
    VkPresentInfoKHR info{};
    info.sType = VK_STRUCTURE_TYPE_PRESENT_INFO_KHR;
    info.waitSemaphoreCount = 1;
    info.pWaitSemaphores = &drawn_[image];
    info.swapchainCount = 1;
    info.pSwapchains = &swapchain_;
    info.pImageIndices = &image;
    const VkResult result = device_->table().vkQueuePresentKHR(queue, &info);
    if (result == VK_ERROR_OUT_OF_DATE_KHR || result == VK_SUBOPTIMAL_KHR) {
        stale_ = true;
        return {};
    }
    return result == VK_SUCCESS ? Result<void>() : device::vulkanError(result, "showing an image in the window");
}

} // namespace voxtact::view
