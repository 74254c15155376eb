// SPDX-License-Identifier: MIT
#pragma once

#include "app/options/cache_folder.h"
#include "voxtact/detector.h"

#include <optional>
#include <vector>

namespace voxtact::app {

/// How fast each method was, on disk: one file a device, driver, version and filter.
class SpeedCache {
  public:
    /// Both must outlive it.
    SpeedCache(const CacheFolder& folder, const device::PhysicalDevice& device, std::optional<Filter> filter);

    /// Nothing where there is no file, or one that was written on another machine or cannot be understood.
    [[nodiscard]] std::optional<std::vector<MethodSpeed>> read() const;
    void write(const std::vector<MethodSpeed>& speeds) const;

  private:
    const CacheFolder& folder_;
    const device::PhysicalDevice& device_;
    std::string name_;
};

} // namespace voxtact::app
