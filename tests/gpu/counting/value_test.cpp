// SPDX-License-Identifier: MIT
// The transfer function is in the image's own units, whatever the voxels are stored as.
#include "gpu_fixture.h"
#include "support/scenes.h"

namespace voxtact::test {
namespace {

class ValueTest : public GpuTest {
  protected:
    /// Survivors of a full viewport in a volume whose values rise along x from `lo` to `hi`, for a transfer function
    /// that rises from 0 to 1 around `edge`.
    template <class Scalar>
    std::uint64_t rising(ScalarType type, double lo, double hi, double edge, ValueRange domain) {
        constexpr std::uint32_t kVoxels = 64;
        const VolumeData volume = makeVolume<Scalar>(unitGrid(kVoxels, 4, 4), type, [&](std::uint32_t x, auto...) {
            return lo + (hi - lo) * x / (kVoxels - 1);
        });
        const double step = (domain.hi - domain.lo) / 512;
        const ControlPoint points[] = {{edge - step, 0}, {edge + step, 1}};
        const TransferFunction function = take(TransferFunction::upload(context(), queue(), {points, domain, 1024}));
        const Mesh plane = upload(makeFlat(0, 1, 0, 1, 0.5));
        return survivors(plane, upload(volume), function, flatView(0, 1, 64, 64));
    }
};

TEST_F(ValueTest, EveryVoxelTypeGivesTheSameSlab) {
    // Voxel centres are pixel centres: 64 values along x, of which those from 3/4 on are opaque.
    EXPECT_EQ(rising<std::uint8_t>(ScalarType::UInt8, 0, 252, 190, {0, 255}), 16U * 64U);
    EXPECT_EQ(rising<std::uint16_t>(ScalarType::UInt16, 0, 63000, 47500, {0, 65535}), 16U * 64U);
    EXPECT_EQ(rising<std::int16_t>(ScalarType::Int16, -32760, 30240, 14740, {-32768, 32767}), 16U * 64U);
    EXPECT_EQ(rising<float>(ScalarType::Float32, -1, 1, 0.508, {-1, 1}), 16U * 64U);
}

TEST_F(ValueTest, TwelveBitCtWithNegativeValues) {
    // -1024 .. 3071 HU in steps of 65: bone from 300 HU is voxel 21 on (-1024 + 21*65 = 341).
    EXPECT_EQ(rising<std::int16_t>(ScalarType::Int16, -1024, 3071, 300, {-1024, 3071}), (64U - 21U) * 64U);
    // Air: everything from -1000 HU, and nothing from 3200.
    EXPECT_EQ(rising<std::int16_t>(ScalarType::Int16, -1024, 3071, -1000, {-1024, 3071}), 63U * 64U);
    EXPECT_EQ(rising<std::int16_t>(ScalarType::Int16, -1024, 3071, 3200, {-1024, 3071}), 0U);
}

TEST_F(ValueTest, DomainNarrowerThanTheData) {
    // Values outside the domain look up the first and the last entry.
    EXPECT_EQ(rising<std::int16_t>(ScalarType::Int16, -1024, 3071, 300, {250, 350}), (64U - 21U) * 64U);
}

TEST_F(ValueTest, TheExtremesOfInt16AreDistinct) {
    // SNORM would make -32768 and -32767 the same.
    const VolumeData volume = makeVolume<std::int16_t>(
        unitGrid(4, 4, 4), ScalarType::Int16, [](std::uint32_t x, auto...) { return x < 2 ? -32768.0 : -32767.0; });
    constexpr ControlPoint kPoints[] = {{-32768, 0}, {-32767, 1}};
    const TransferFunction function = upload(kPoints, {-32768, -32767});
    const Mesh plane = upload(makeFlat(0, 1, 0, 1, 0.5));
    const std::uint64_t count = survivors(plane, upload(volume), function, flatView(0, 1, 64, 64), 0.5);
    EXPECT_NEAR(static_cast<double>(count), 32.0 * 64.0, 64.0);
}

TEST_F(ValueTest, TableEntriesAreAtTheMiddleOfTheirIntervals) {
    // Two entries over 0..4: 0 at scalar 1 and 1 at scalar 3, so that 2 looks up one half.
    const VolumeData volume = makeVolume<float>(unitGrid(4, 4, 4), ScalarType::Float32, [](auto...) { return 2.0; });
    constexpr ControlPoint kPoints[] = {{2, 0}, {2, 1}};
    const TransferFunction function = take(TransferFunction::upload(context(), queue(), {kPoints, {0, 4}, 2}));
    const Mesh plane = upload(makeFlat(0, 1, 0, 1, 0.5));
    const Volume uploaded = upload(volume);
    EXPECT_EQ(survivors(plane, uploaded, function, flatView(0, 1, 16, 16), 0.49), 256U);
    EXPECT_EQ(survivors(plane, uploaded, function, flatView(0, 1, 16, 16), 0.51), 0U);
}

} // namespace
} // namespace voxtact::test
