// SPDX-License-Identifier: MIT
#pragma once

#include "gpu_fixture.h"
#include "voxtact/render.h"

#include <optional>

namespace voxtact::test {

/// Every test that makes pictures.
class PictureTest : public GpuTest {
  protected:
    void SetUp() override {
        GpuTest::SetUp();
        if (!IsSkipped() && !HasFatalFailure()) {
            blocking_.emplace(take(BlockingRenderer::create(context(), queue())));
        }
    }
    void TearDown() override {
        blocking_.reset();
        GpuTest::TearDown();
    }

    [[nodiscard]] BlockingRenderer& blocking() { return *blocking_; }
    [[nodiscard]] const Renderer& renderer() const { return blocking_->renderer(); }

  private:
    std::optional<BlockingRenderer> blocking_;
};

} // namespace voxtact::test
