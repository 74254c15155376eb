// SPDX-License-Identifier: MIT
#pragma once

#include "app/options/cache_folder.h"
#include "voxtact/detector.h"

#include <optional>
#include <string>
#include <vector>

namespace voxtact::app {

/// How fast each method was, on disk: one file for a device, driver, version and what was measured.
class SpeedCache {
  public:
    /// `measured` is part of the file's name. Folder and device must outlive it.
    SpeedCache(const CacheFolder& folder, const device::PhysicalDevice& device, const std::string& measured);

    /// Nothing where there is no file, or one that was written on another machine or cannot be understood.
    [[nodiscard]] std::optional<std::vector<MethodSpeed>> read() const;
    void write(const std::vector<MethodSpeed>& speeds) const;

  private:
    const CacheFolder& folder_;
    const device::PhysicalDevice& device_;
    std::string name_;
};

} // namespace voxtact::app
