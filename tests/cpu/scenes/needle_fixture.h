// SPDX-License-Identifier: MIT
#pragma once

#include "cpu/scenes/engine_fixture.h"
#include "support/scenes.h"
#include "voxtact/samples.h"

namespace voxtact::test {

/// A needle along z before the opaque half x > 8 of a cube of 16 mm, and what becomes of it.
class NeedleFixture : public testing::Test {
  protected:
    static Grid grid() {
        Grid grid;
        grid.size = {16, 16, 16};
        return grid;
    }
    [[nodiscard]] cpu::BatchItem item() const { return {&mesh_, &volume_, &function_, {&pose_, 1}}; }
    /// Its tip, at z = 0, comes so far towards larger x, in a parabola.
    [[nodiscard]] std::vector<double> deflected(double by) const {
        std::vector<double> out = data_.positions;
        for (std::size_t at = 0; at < out.size(); at += 3) {
            const double fromBase = 1 - out[at + 2] / 10;
            out[at] += by * fromBase * fromBase;
        }
        return out;
    }

    MeshData data_ = take(makeBuiltinMesh("needle:0.5:10"));
    VolumeData image_ = makeBytes(grid(), [](auto x, auto...) { return x >= 8 ? 255.0 : 0.0; });
    std::vector<ControlPoint> points_{{0, 0}, {255, 1}};
    cpu::Volume volume_ = take(cpu::Volume::create(image_.view()));
    cpu::TransferFunction function_ = take(cpu::TransferFunction::create({points_, {0, 255}}));
    cpu::Mesh mesh_ = take(cpu::Mesh::create(data_.view()));
    Mat4 pose_ = translation({3, 8, 3});
};

} // namespace voxtact::test
