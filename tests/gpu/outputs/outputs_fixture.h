// SPDX-License-Identifier: MIT
#pragma once

#include "gpu_fixture.h"
#include "support/scenes.h"

#include <gmock/gmock.h>

namespace voxtact::test {

inline constexpr Outputs kAllOutputs{.triangles = true, .contacts = true, .bounds = true, .labels = true};
inline constexpr std::uint32_t kManyContacts = 1U << 19U;

class OutputsTest : public GpuTest {
  protected:
    [[nodiscard]] BlockingDetector detectorOf(CountingMethod method, const Outputs& outputs,
                                              std::uint32_t mostContacts = kManyContacts) const {
        return take(BlockingDetector::create(
            context(),
            RasterDesc{
                .method = method, .filter = defaultFilter(method), .boundary = Boundary::Range, .outputs = outputs},
            queue(), mostContacts));
    }

    /// An opaque unit cube, a square across it, and a label map of two labels.
    struct Simple {
        Volume volume;
        TransferFunction function;
        Mesh mesh;
        LabelMap labels;
        Mat4 pose = identity();
        [[nodiscard]] BatchItem item() const { return {&mesh, &volume, &function, std::span(&pose, 1), &labels}; }
    };
    [[nodiscard]] Simple simple() const {
        const LabelData labels{unitGrid(2), {0, 1, 0, 1, 0, 1, 0, 1}, {0, 3}};
        return {upload(makeBytes(unitGrid(4), [](auto...) { return 255.0; })), upload(byteRamp(), {0, 255}),
                upload(makeFlat(0, 1, 0, 1, 0.5)), take(LabelMap::upload(context(), queue(), labels))};
    }
    static View sixteen() { return flatView(0, 1, 16, 16); }
};

} // namespace voxtact::test
