// SPDX-License-Identifier: MIT
// Refusals: one line each, that say what; the next call works.
#include "cpu/scenes/engine_fixture.h"
#include "support/host_meters.h"

#include <gmock/gmock.h>

#include <functional>
#include <limits>

namespace voxtact::test {
namespace {

using testing::HasSubstr;
using testing::Not;

class CpuBadInput : public testing::Test {
  protected:
    /// The error of a spoilt batch, after which a good one must still give its answer.
    Error refused(const std::function<void(cpu::Batch&, cpu::BatchItem&)>& spoil) {
        const cpu::BatchItem good{&mesh_, &volume_, &function_, std::span(&pose_, 1)};
        cpu::BatchItem bad = good;
        cpu::Batch batch{std::span(&bad, 1), flatView(0, 1, 16, 16), 0.5};
        spoil(batch, bad);
        const Result<BatchAnswer> answer = detector_.detect(batch);
        EXPECT_FALSE(answer.ok());
        EXPECT_EQ(take(detector_.detect({std::span(&good, 1), flatView(0, 1, 16, 16), 0.5})).pairs[0].count, 256U);
        Error error = answer.ok() ? Error{} : answer.error();
        EXPECT_THAT(error.text, Not(HasSubstr("\n")));
        return error;
    }

    Mat4 pose_ = identity();
    cpu::Volume volume_ = take(cpu::Volume::create(makeBytes(unitGrid(4), [](auto...) { return 255.0; }).view()));
    cpu::TransferFunction function_ = take(cpu::TransferFunction::create({byteRamp(), {0, 255}}));
    cpu::Mesh mesh_ = take(cpu::Mesh::create(makeFlat(0, 1, 0, 1, 0.5).view()));
    cpu::Detector detector_ = take(cpu::Detector::create({.threads = 2}));
};

TEST_F(CpuBadInput, Viewports) {
    EXPECT_THAT(refused([](auto& batch, auto&) { batch.view.width = 0; }).text, HasSubstr("0x16"));
    const Error error = refused([](auto& batch, auto&) { batch.view.height = cpu::kMaxViewport + 1; });
    EXPECT_EQ(error.code, ErrorCode::LimitExceeded);
    EXPECT_THAT(error.text, HasSubstr("16x16385"));
    EXPECT_THAT(error.text, HasSubstr("limit is " + std::to_string(cpu::kMaxViewport)));
}

TEST_F(CpuBadInput, MoreThreadsThanAnybodyHas) {
    constexpr std::uint32_t kTooMany = cpu::kMaxThreads + 1;
    const auto expectRefused = [](const auto& made) {
        ASSERT_FALSE(made.ok());
        EXPECT_EQ(made.error().code, ErrorCode::LimitExceeded);
        EXPECT_THAT(made.error().text, HasSubstr("4097 threads are asked for, the most is 4096"));
    };
    expectRefused(cpu::Detector::create({.threads = kTooMany}));
    expectRefused(cpu::ClearanceMeter::create({.threads = kTooMany}));
    expectRefused(cpu::AreaMeter::create({.threads = kTooMany}));
    expectRefused(cpu::MotionChecker::create({.threads = kTooMany}));
    expectRefused(cpu::Planner::create({.threads = kTooMany}));
}

TEST_F(CpuBadInput, ATableOfMoreEntriesThanFloatsTellApart) {
    const Result<cpu::TransferFunction> made =
        cpu::TransferFunction::create({byteRamp(), {0, 255}, std::numeric_limits<std::uint32_t>::max()});
    ASSERT_FALSE(made.ok());
    EXPECT_EQ(made.error().code, ErrorCode::LimitExceeded);
    EXPECT_THAT(made.error().text, HasSubstr("4294967295 entries, the most is 16777216"));
}

TEST_F(CpuBadInput, CamerasAndPoses) {
    const double nan = std::numeric_limits<double>::quiet_NaN();
    EXPECT_THAT(refused([&](auto& batch, auto&) { batch.view.clip_from_world[5] = nan; }).text,
                HasSubstr("not finite"));
    EXPECT_THAT(refused([](auto& batch, auto&) { batch.view.clip_from_world[5] = 0; }).text, HasSubstr("singular"));
    Mat4 poses[2] = {identity(), identity()};
    poses[1][13] = std::numeric_limits<double>::infinity();
    EXPECT_THAT(refused([&](auto&, auto& bad) { bad.world_from_object = poses; }).text,
                HasSubstr("batch item 0, pose 1: row 2, column 4"));
    poses[1] = identity();
    poses[1][3] = 0.5;
    EXPECT_THAT(refused([&](auto&, auto& bad) { bad.world_from_object = poses; }).text,
                HasSubstr("it must be 0 0 0 1"));
}

TEST_F(CpuBadInput, ThresholdsAndNullObjects) {
    EXPECT_THAT(refused([](auto& batch, auto&) { batch.threshold = 1.5; }).text, HasSubstr("1.5"));
    EXPECT_THAT(refused([](auto& batch, auto&) { batch.threshold = -0.1; }).text,
                HasSubstr("is not a number from 0 to 1"));
    EXPECT_THAT(refused([](auto& batch, auto&) { batch.threshold = std::numeric_limits<double>::quiet_NaN(); }).text,
                HasSubstr("is not a number from 0 to 1"));
    EXPECT_THAT(refused([](auto&, auto& bad) { bad.mesh = nullptr; }).text, HasSubstr("batch item 0"));
    EXPECT_THAT(refused([](auto&, auto& bad) { bad.volume = nullptr; }).text, HasSubstr("null"));
    EXPECT_THAT(refused([](auto&, auto& bad) { bad.transferFunction = nullptr; }).text, HasSubstr("null"));
}

TEST_F(CpuBadInput, DomainsInWhichFloatsHoldNoValues) {
    const ControlPoint points[] = {{0, 0}, {1e300, 1}};
    const cpu::TransferFunction wide = take(cpu::TransferFunction::create({points, {0, 1e300}}));
    EXPECT_THAT(refused([&](auto&, auto& bad) { bad.transferFunction = &wide; }).text,
                HasSubstr("batch item 0: single precision cannot hold"));
}

TEST_F(CpuBadInput, HostDataIsChecked) {
    MeshData mesh = makeFlat(0, 1, 0, 1, 0.5);
    mesh.indices[4] = 9;
    EXPECT_THAT(cpu::Mesh::create(mesh.view()).error().text, HasSubstr("triangle 1"));
    EXPECT_FALSE(cpu::Mesh::create({}).ok());
    const VolumeData volume = makeVolume<float>(unitGrid(4), ScalarType::Float32, [](auto x, auto y, auto z) {
        return x == 1 && y == 2 && z == 3 ? std::numeric_limits<double>::quiet_NaN() : 0.0;
    });
    EXPECT_THAT(cpu::Volume::create(volume.view()).error().text, HasSubstr("voxel (1, 2, 3) is NaN"));
    EXPECT_FALSE(cpu::Volume::create({}).ok());
    VolumeData longVolume;
    longVolume.grid.size = {(1U << 23U) + 1, 1, 1};
    longVolume.voxels.resize((1U << 23U) + 1);
    const Result<cpu::Volume> refusedVolume = cpu::Volume::create(longVolume.view());
    ASSERT_FALSE(refusedVolume.ok());
    EXPECT_EQ(refusedVolume.error().code, ErrorCode::LimitExceeded);
    EXPECT_THAT(refusedVolume.error().text, HasSubstr("8388609 voxels along x"));
    EXPECT_THAT(cpu::TransferFunction::create({}).error().text, HasSubstr("no control points"));
}

} // namespace
} // namespace voxtact::test
