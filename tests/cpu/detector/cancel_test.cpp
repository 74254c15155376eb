// SPDX-License-Identifier: MIT
// A call of the host engine that another thread ends: soon, and without a trace in the answers that follow.
#include "cpu/scenes/engine_fixture.h"
#include "cpu/scenes/oracle_scenes.h"
#include "host/cancel.h"
#include "support/host_meters.h"
#include "support/scenes.h"

#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <cmath>
#include <ctime>
#include <functional>
#include <thread>

namespace voxtact::test {
namespace {

/// Of all threads together: what else a machine is busy with does not count.
double processorSeconds() {
    return static_cast<double>(std::clock()) / CLOCKS_PER_SEC;
}

/// Of two threads: a second each.
constexpr double kSoon = 2;

constexpr std::uint32_t kSide = 96;

/// Voxels of 1 mm, the first at the origin.
Grid grid() {
    Grid grid;
    grid.size = {kSide, kSide, kSide};
    return grid;
}

/// Half of its voxels are opaque, one here and one there: nothing can be skipped.
VolumeData speckles() {
    return makeBytes(grid(), [](auto x, auto y, auto z) {
        return (static_cast<std::uint32_t>(x) * 7 + static_cast<std::uint32_t>(y) * 5 +
                static_cast<std::uint32_t>(z) * 3) %
                           4 <
                       2
                   ? 255.0
                   : 0.0;
    });
}

/// So many triangles right across the speckles, each turned a little more.
MeshData fan(std::uint32_t triangles) {
    MeshData mesh;
    const double middle = 0.5 * kSide;
    for (std::uint32_t i = 0; i < triangles; ++i) {
        const double angle = 3.0 * i / triangles;
        const double c = middle * std::cos(angle);
        const double s = middle * std::sin(angle);
        addTriangle(mesh, {middle - c, middle - s, 0}, {middle + c, middle + s, 0}, {middle, middle, kSide - 1.0});
    }
    return mesh;
}

/// One pose that takes every engine long, on two threads.
class Cancel : public testing::Test {
  protected:
    Cancel()
        : volume_(take(cpu::Volume::create(speckles().view()))),
          function_(take(cpu::TransferFunction::create({byteRamp(), {0, 255}, 256}))),
          mesh_(take(cpu::Mesh::create(fan(20000).view()))), labels_(take(makeLabels(speckles().view()))) {}

    [[nodiscard]] cpu::Batch batch(const std::atomic<bool>* cancel) const {
        return {std::span(&item_, 1), {framingCamera(volume_.grid(), 8192, 8192), 8192, 8192}, 0.5, cancel};
    }

    /// The call ends soon after somebody asks for it, and at once where that was before.
    template <class Ask> void expectCancelled(const Ask& ask) const {
        std::atomic<bool> cancel{false};
        double asked = 0;
        std::thread other([&] {
            std::this_thread::sleep_for(std::chrono::milliseconds(50));
            asked = processorSeconds();
            cancel = true;
        });
        const auto answer = ask(batch(&cancel));
        const double ended = processorSeconds();
        other.join();
        ASSERT_FALSE(answer.ok()) << "it was done before anybody asked for its end: the test says nothing";
        EXPECT_EQ(answer.error().code, ErrorCode::Cancelled);
        EXPECT_LT(ended - asked, kSoon);

        const double start = processorSeconds();
        EXPECT_FALSE(ask(batch(&cancel)).ok());
        EXPECT_LT(processorSeconds() - start, kSoon);
    }
    void expectDetectorCancelled(const cpu::DetectorDesc& desc) const {
        cpu::Detector detector = take(cpu::Detector::create(desc));
        expectCancelled([&](const cpu::Batch& asked) { return detector.detect(asked); });
    }

    cpu::Volume volume_;
    cpu::TransferFunction function_;
    cpu::Mesh mesh_;
    LabelData labels_;
    std::vector<Mat4> poses_{identity(), translation({30, 20, 10})};
    cpu::BatchItem item_{&mesh_, &volume_, &function_, std::span(poses_).first(1), &labels_};
};

TEST_F(Cancel, ACertifiedCount) {
    expectDetectorCancelled({.threads = 2, .projection = Projection::Certified});
}

TEST_F(Cancel, CertifiedContacts) {
    expectDetectorCancelled({.threads = 1, .projection = Projection::Certified, .outputs = {.contacts = true}});
}

TEST_F(Cancel, AView) {
    expectDetectorCancelled({.threads = 1});
}

TEST_F(Cancel, AViewWithOutputs) {
    expectDetectorCancelled({.threads = 2, .outputs = {.triangles = true}});
}

TEST_F(Cancel, AnArea) {
    cpu::AreaMeter meter =
        take(cpu::AreaMeter::create({.threads = 1, .tolerance = 1e-9, .maxSteps = std::uint64_t{1} << 40U}));
    expectCancelled([&](const cpu::Batch& asked) { return meter.measure(asked); });
    const std::vector<std::int32_t> labels{0, 255};
    expectCancelled([&](const cpu::Batch& asked) { return meter.measureLabels(asked, labels); });
}

TEST(Cancellation, WhatWasSeenStaysSeen) {
    std::atomic<bool> flag{false};
    const cpu::Cancellation cancel(&flag);
    EXPECT_FALSE(cancel.seen());
    flag = true;
    EXPECT_TRUE(cancel.seen());
    flag = false;
    EXPECT_TRUE(cancel.seen());
    EXPECT_FALSE(cpu::Cancellation(&flag).seen());
    EXPECT_FALSE(cpu::Cancellation(nullptr).seen());
}

TEST_F(Cancel, AFlagThatIsTakenBackEndsTheCallAllTheSame) {
    // Now and then set for a moment: threads leave out the rest, and at the end it is most likely not set.
    for (const Projection projection : {Projection::Certified, Projection::View}) {
        cpu::Detector detector = take(cpu::Detector::create({.threads = 2, .projection = projection}));
        for (int time = 0; time < 4; ++time) {
            std::atomic<bool> cancel{false};
            std::atomic<bool> ended{false};
            std::thread other([&] {
                while (!ended) {
                    std::this_thread::sleep_for(std::chrono::milliseconds(10));
                    cancel = true;
                    std::this_thread::sleep_for(std::chrono::milliseconds(1));
                    cancel = false;
                }
            });
            const Result<BatchAnswer> answer = detector.detect(batch(&cancel));
            ended = true;
            other.join();
            ASSERT_FALSE(answer.ok()) << toString(projection);
            EXPECT_EQ(answer.error().code, ErrorCode::Cancelled);
        }
    }
}

TEST_F(Cancel, DominantAxis) {
    expectDetectorCancelled({.threads = 1, .projection = Projection::DominantAxis, .samplesPerVoxel = 16});
}

/// Of a mesh that touches nothing, and is nowhere far from what is opaque: the plate lies in the middle of a gap that
/// is as wide everywhere.
class CancelSearch : public Cancel {
  protected:
    CancelSearch()
        : gap_(take(cpu::Volume::create(
              makeBytes(grid(), [](auto, auto, auto z) { return z < 40 || z > 56 ? 255.0 : 0.0; }).view()))),
          gapLabels_(take(makeLabels(makeBytes(grid(), [](auto...) { return 1.0; }).view()))),
          plate_(take(cpu::Mesh::create(plate(600).view()))) {
        item_ = {&plate_, &gap_, &function_, std::span(poses_).first(1), &gapLabels_};
    }

    /// `side`² squares at z = 48, wavy by a hair, so that all of it is about as near.
    static MeshData plate(std::uint32_t side) {
        MeshData mesh;
        const double step = (kSide - 1.0) / side;
        const auto corner = [&](std::uint32_t x, std::uint32_t y) {
            return Vec3{x * step, y * step, 48 + 1e-4 * std::sin(0.7 * x) * std::sin(0.9 * y)};
        };
        for (std::uint32_t y = 0; y < side; ++y) {
            for (std::uint32_t x = 0; x < side; ++x) {
                addTriangle(mesh, corner(x, y), corner(x + 1, y), corner(x + 1, y + 1));
                addTriangle(mesh, corner(x, y), corner(x + 1, y + 1), corner(x, y + 1));
            }
        }
        return mesh;
    }

    cpu::Volume gap_;
    LabelData gapLabels_;
    cpu::Mesh plate_;
};

TEST_F(CancelSearch, AClearance) {
    cpu::ClearanceMeter meter =
        take(cpu::ClearanceMeter::create({.threads = 1, .tolerance = 1e-6, .maxSteps = std::uint64_t{1} << 40U}));
    expectCancelled([&](const cpu::Batch& asked) { return meter.measure(asked); });
    const std::vector<std::int32_t> labels{1};
    expectCancelled([&](const cpu::Batch& asked) { return meter.measureLabels(asked, labels); });
}

TEST_F(CancelSearch, AMotion) {
    // A quarter of a turn in the plane of the plate, a hundredth of a mm beside one side of the gap.
    constexpr double kMiddle = 0.5 * kSide;
    const Mat4 back = translation({-kMiddle, -kMiddle, 0});
    const Mat4 there = translation({kMiddle, kMiddle, 8.49});
    Mat4 turn = identity();
    turn[0] = turn[5] = 0;
    turn[1] = 1;
    turn[4] = -1;
    poses_ = {multiply(there, back), multiply(there, multiply(turn, back))};
    item_.world_from_object = poses_;
    cpu::MotionChecker checker =
        take(cpu::MotionChecker::create({.threads = 1, .resolution = 1e-6, .maxSteps = std::uint64_t{1} << 40U}));
    expectCancelled([&](const cpu::Batch& asked) { return checker.check(asked); });
}

TEST_F(Cancel, ManyPosesToo) {
    // Each of them is soon answered: the call ends between two.
    const std::vector<Mat4> many(400000, translation({500, 0, 0}));
    item_.world_from_object = many;
    cpu::ClearanceMeter meter = take(cpu::ClearanceMeter::create({.threads = 2}));
    expectCancelled([&](const cpu::Batch& asked) { return meter.measure(asked); });
    expectCancelled([&](const cpu::Batch& asked) { return meter.within(asked, 600); });
    cpu::MotionChecker checker = take(cpu::MotionChecker::create({.threads = 2}));
    expectCancelled([&](const cpu::Batch& asked) { return checker.around(asked, {600, 0}); });
}

TEST(CancelBefore, ACallThatWouldHaveNothingToLookAtIsCancelledToo) {
    const std::atomic<bool> cancel{true};
    const cpu::Batch nothing{{}, {identity(), 8, 8}, 0.5, &cancel};
    const auto isCancelled = [](const auto& answer) {
        return !answer.ok() && answer.error().code == ErrorCode::Cancelled;
    };
    cpu::Detector detector = take(cpu::Detector::create({.threads = 1}));
    EXPECT_TRUE(isCancelled(detector.detect(nothing)));
    cpu::ClearanceMeter meter = take(cpu::ClearanceMeter::create({.threads = 1}));
    EXPECT_TRUE(isCancelled(meter.measure(nothing)));
    EXPECT_TRUE(isCancelled(meter.within(nothing, 1)));
    EXPECT_TRUE(isCancelled(meter.measureLabels(nothing, {})));
    cpu::AreaMeter areas = take(cpu::AreaMeter::create({.threads = 1}));
    EXPECT_TRUE(isCancelled(areas.measure(nothing)));
    EXPECT_TRUE(isCancelled(areas.measureLabels(nothing, {})));
    cpu::MotionChecker checker = take(cpu::MotionChecker::create({.threads = 1}));
    EXPECT_TRUE(isCancelled(checker.check(nothing)));
    EXPECT_TRUE(isCancelled(checker.around(nothing, {1, 1})));
}

/// Before it looks at any two poses, of which these are no motion.
TEST(CancelBefore, MotionsAreNotPrepared) {
    const std::atomic<bool> cancel{true};
    const cpu::Volume volume = take(cpu::Volume::create(speckles().view()));
    const std::array points{ControlPoint{0, 0}, ControlPoint{255, 1}};
    const cpu::TransferFunction function = take(cpu::TransferFunction::create({points, {0, 255}}));
    MeshData triangle;
    addTriangle(triangle, {0, 0, 0}, {1, 0, 0}, {0, 1, 0});
    const cpu::Mesh mesh = take(cpu::Mesh::create(triangle.view()));
    Mat4 larger = identity();
    larger[0] = 2;
    const std::array poses{identity(), larger};
    const cpu::BatchItem item{&mesh, &volume, &function, poses};
    cpu::MotionChecker checker = take(cpu::MotionChecker::create({.threads = 1}));
    EXPECT_EQ(checker.check({{&item, 1}, {}, 0.5}).error().code, ErrorCode::InvalidArgument);
    EXPECT_EQ(checker.check({{&item, 1}, {}, 0.5, &cancel}).error().code, ErrorCode::Cancelled);
}

TEST(CancelNot, AFlagThatStaysFalseChangesNothingAndNeitherDoesACancelledCallBefore) {
    const cpu::Volume volume = take(cpu::Volume::create(speckles().view()));
    const cpu::TransferFunction function = take(cpu::TransferFunction::create({byteRamp(), {0, 255}, 256}));
    const cpu::Mesh mesh = take(cpu::Mesh::create(fan(50).view()));
    const Mat4 pose = translation({3, 2, 1});
    const cpu::BatchItem item{&mesh, &volume, &function, std::span(&pose, 1)};
    std::atomic<bool> cancel{false};
    cpu::Batch batch{std::span(&item, 1), {framingCamera(volume.grid(), 256, 256), 256, 256}, 0.5};
    for (const Projection projection : projections()) {
        cpu::Detector detector =
            take(cpu::Detector::create({.threads = 2, .projection = projection, .outputs = {.triangles = true}}));
        const BatchAnswer without = take(detector.detect(batch));
        cancel = true;
        batch.cancel = &cancel;
        EXPECT_FALSE(detector.detect(batch).ok());
        cancel = false;
        const BatchAnswer with = take(detector.detect(batch));
        batch.cancel = nullptr;
        EXPECT_EQ(with.pairs.at(0).count, without.pairs.at(0).count) << toString(projection);
        EXPECT_EQ(with.triangles.size(), without.triangles.size());
        EXPECT_GT(without.pairs.at(0).count, 0U);
    }
}

} // namespace
} // namespace voxtact::test
