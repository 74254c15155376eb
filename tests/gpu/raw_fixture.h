// SPDX-License-Identifier: MIT
#pragma once

#include "gpu_fixture.h"
#include "raw_vulkan.h"

#include <optional>

namespace voxtact::test {

/// Every test that needs an embedder's own Vulkan code beside a device.
class RawGpuTest : public GpuTest {
  protected:
    void SetUp() override {
        GpuTest::SetUp();
        if (!IsSkipped() && !HasFatalFailure()) {
            raw_.emplace(gpu().device);
        }
    }
    void TearDown() override {
        raw_.reset();
        GpuTest::TearDown();
    }

    [[nodiscard]] RawVulkan& raw() { return *raw_; }

  private:
    std::optional<RawVulkan> raw_;
};

} // namespace voxtact::test
