// SPDX-License-Identifier: MIT
#pragma once

#include "vulkan/own/vulkan_device.h"

#include <cstdint>
#include <vector>

namespace voxtact::view {

/// The images of a window, recreated when the window changes its size.
class Swapchain {
  public:
    /// Takes ownership of the window's surface.
    [[nodiscard]] static Result<Swapchain> create(const device::VulkanDevice& device, VkSurfaceKHR surface);
    Swapchain(Swapchain&& other) noexcept;
    Swapchain& operator=(Swapchain&&) = delete;
    ~Swapchain();

    /// Nothing may be in flight. With an extent of 0 (a hidden window) there are no images.
    [[nodiscard]] Result<void> resize(VkExtent2D extent);
    /// True if the images no longer fit the window.
    [[nodiscard]] bool stale() const noexcept { return stale_; }
    [[nodiscard]] VkFormat format() const noexcept { return format_.format; }
    [[nodiscard]] VkExtent2D extent() const noexcept { return extent_; }

    /// Returns the number of an image to draw into once `acquired` is signalled; false if the images are stale.
    [[nodiscard]] Result<bool> acquire(VkSemaphore acquired, std::uint32_t& image);
    /// Shows the image after drawing.
    [[nodiscard]] Result<void> present(VkQueue queue, std::uint32_t image);
    [[nodiscard]] VkImage image(std::uint32_t number) const { return images_[number]; }
    [[nodiscard]] VkImageView view(std::uint32_t number) const { return views_[number]; }
    [[nodiscard]] VkSemaphore drawn(std::uint32_t number) const { return drawn_[number]; }

  private:
    Swapchain(const device::VulkanDevice& device, VkSurfaceKHR surface) : device_(&device), surface_(surface) {}
    [[nodiscard]] Result<void> chooseFormat();
    [[nodiscard]] Result<void> makeViews();
    void destroyImages() noexcept;

    const device::VulkanDevice* device_;
    VkSurfaceKHR surface_;
    VkSurfaceFormatKHR format_{};
    VkSwapchainKHR swapchain_ = VK_NULL_HANDLE;
    VkExtent2D extent_{};
    std::vector<VkImage> images_;
    std::vector<VkImageView> views_;
    std::vector<VkSemaphore> drawn_;
    bool stale_ = true;
};

} // namespace voxtact::view
