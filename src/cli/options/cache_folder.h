// SPDX-License-Identifier: MIT
#pragma once

#include "vulkan/own/vulkan_device.h"

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

namespace voxtact::app {

/// Folder of data kept between runs. All contents can be recreated, so failures are not errors: unreadable data count
/// as missing, unwritable data are dropped.
class CacheFolder {
  public:
    /// Creates a disabled cache.
    CacheFolder() = default;
    /// `wanted` is a folder, "off", or empty: $XDG_CACHE_HOME/voxtact, else ~/.cache/voxtact, else off.
    explicit CacheFolder(const std::string& wanted);

    [[nodiscard]] bool on() const noexcept { return !path_.empty(); }
    /// Returns the contents that write() wrote; empty if the file is damaged or foreign.
    [[nodiscard]] std::optional<std::string> read(const std::string& name) const;
    /// Creates the folder if missing, and replaces the file atomically. Returns false on failure.
    bool write(const std::string& name, std::string_view content) const;

  private:
    std::filesystem::path path_;
};

/// Returns the part of a file name that identifies a device, its driver and this program.
[[nodiscard]] std::string cacheKey(const device::PhysicalDevice& device);

} // namespace voxtact::app
