// SPDX-License-Identifier: MIT
// What an AreaMeter's answers depend on, measures by label, and refuses.
#include "cpu/area/area_held.h"

#include "core/base/infinity.h"
#include "cpu/scenes/random_scene.h"
#include "support/host_meters.h"
#include "voxtact/samples.h"

#include <gmock/gmock.h>

#include <limits>

namespace voxtact::test {
namespace {

using testing::HasSubstr;

/// Opaque between two values, with steps of almost nothing.
std::vector<ControlPoint> between(double lo, double hi) {
    return {{lo, 0}, {lo, 1}, {hi, 1}, {hi, 0}};
}

/// Neither threads nor what else is in the batch changes an answer.
TEST(Area, DoesNotDependOnItsCompany) {
    std::mt19937_64 random(testSeed());
    const RandomScene scene = makeRandomScene(random, 40);
    const Held held(scene.mesh, scene.volume, scene.points, scene.domain, scene.tableSize);
    const double tolerance = 1e-3 * surfaceOf(scene.mesh) + 1e-9;
    const std::vector<PairArea> alone =
        areas(held, scene.poses, {.threads = 1, .tolerance = tolerance}, scene.threshold);
    const std::vector<PairArea> together =
        areas(held, scene.poses, {.threads = 3, .tolerance = tolerance}, scene.threshold);
    ASSERT_EQ(alone.size(), scene.poses.size());
    for (std::size_t i = 0; i < alone.size(); ++i) {
        const PairArea one = area(held, {.threads = 1, .tolerance = tolerance}, scene.threshold, scene.poses[i]);
        EXPECT_EQ(alone[i].pose, i);
        for (const PairArea& other : {together[i], one}) {
            EXPECT_EQ(alone[i].bounds.lower, other.bounds.lower) << i;
            EXPECT_EQ(alone[i].bounds.upper, other.bounds.upper) << i;
            EXPECT_EQ(alone[i].end, other.end) << i;
        }
    }
}

TEST(Area, SeesEditsAndNewTransferFunctions) {
    Held held(makeFlat(2, 12, 3, 9, 8), valueRamp(), between(1000, 1001), kEntries);
    cpu::AreaMeter meter = take(cpu::AreaMeter::create({.threads = 1, .tolerance = 1e-6}));
    const Mat4 pose = identity();
    const auto measured = [&] {
        const cpu::BatchItem item{&held.mesh, &held.volume, &held.function, std::span(&pose, 1)};
        return take(meter.measure({std::span(&item, 1), {}, 0.5})).pairs.at(0);
    };
    EXPECT_EQ(measured().bounds.upper, 0);
    held.function = take(cpu::TransferFunction::create({byteRamp(), {0, 255}}));
    EXPECT_EQ(measured().bounds.upper, 0);
    ASSERT_TRUE(held.volume.set(VoxelBox{{0, 0, 0}, {32, 32, 32}}, 255).ok());
    expectArea(60, measured());
}

std::vector<LabelArea> labelAreas(const Held& held, const LabelData* labels, std::span<const std::int32_t> asked,
                                  const cpu::AreaDesc& desc = {.threads = 1, .tolerance = 1e-6}) {
    cpu::AreaMeter meter = take(cpu::AreaMeter::create(desc));
    const Mat4 pose = identity();
    const cpu::BatchItem item{&held.mesh, &held.volume, &held.function, std::span(&pose, 1), labels};
    return take(meter.measureLabels({std::span(&item, 1), {}, 0.5}, asked)).labels;
}

TEST(Area, OfLabelsIsCutBetweenVoxels) {
    Grid grid;
    grid.size = {32, 32, 32};
    const LabelData labels =
        take(makeLabels(makeBytes(grid, [](auto x, auto y, auto) { return x < 15 ? 7 : (y < 8 ? 9 : 0); }).view()));
    // Opaque from x = 12.5 on; labels 7 to x = 14.5, 9 to y = 7.5.
    const Held held(makeFlat(2, 22, 3, 17, 8.75), valueRamp(), std::vector<ControlPoint>{{90, 0}, {110, 1}}, kEntries);
    const std::vector<std::int32_t> asked{9, 7, 3, 0, 9};
    const std::vector<LabelArea> found = labelAreas(held, &labels, asked);
    ASSERT_EQ(found.size(), asked.size());
    const std::vector<double> wanted{7.5 * 4.5, 2.0 * 14, 0, 7.5 * 9.5, 7.5 * 4.5};
    for (std::size_t i = 0; i < asked.size(); ++i) {
        EXPECT_EQ(found[i].label, asked[i]);
        EXPECT_LE(found[i].bounds.lower, wanted[i] + 1e-9) << i;
        EXPECT_GE(found[i].bounds.upper, wanted[i] - 1e-9) << i;
        EXPECT_LE(found[i].bounds.upper - found[i].bounds.lower, 1e-6) << i;
        EXPECT_EQ(found[i].end, StopReason::Closed) << i;
    }
}

/// Also where that of another is known at once.
TEST(Area, OfEachLabelIsMeasuredToTheTolerance) {
    Grid grid;
    grid.size = {32, 32, 32};
    const VolumeData ball = makeBytes(grid, [](auto x, auto y, auto z) {
        return std::max(0.0, 250 - 12 * std::hypot(x - 15.5, y - 15.5, z - 15.5));
    });
    const LabelData labels =
        take(makeLabels(makeBytes(grid, [](auto x, auto, auto) { return x < 3 ? 1 : (x < 16 ? 2 : 3); }).view()));
    const Held held(makeFlat(0, 31, 0, 31, 14.3), ball, byteRamp(), {0, 255});
    const std::vector<LabelArea> found =
        labelAreas(held, &labels, std::vector<std::int32_t>{1, 2, 3}, {.threads = 1, .tolerance = 1e-3});
    EXPECT_EQ(found[0].bounds.upper, 0);
    for (std::size_t i = 0; i < 3; ++i) {
        EXPECT_EQ(found[i].end, StopReason::Closed);
        EXPECT_LE(found[i].bounds.upper - found[i].bounds.lower, 1e-3);
    }
    EXPECT_GT(found[1].bounds.lower, 100);
    EXPECT_NEAR(found[1].bounds.lower, found[2].bounds.lower, 2e-3) << "the halves of a disc";
}

/// A plate in the face between two labels is in either, as far as can be told, and in no other.
TEST(Area, OfAPlateBetweenLabelsMayBeInEither) {
    Grid grid;
    grid.size = {20, 20, 20};
    const LabelData labels =
        take(makeLabels(makeBytes(grid, [](auto, auto, auto z) { return z < 8 ? 1 : (z == 8 ? 2 : 3); }).view()));
    std::mt19937_64 random(testSeed());
    const VolumeData image = makeBytes(grid, [&](auto...) { return uniform(random, 150, 255); });
    const Held held(makeFlat(3, 13, 4, 14, 7.5), image, byteRamp(), {0, 255});
    const std::vector<LabelArea> found = labelAreas(held, &labels, std::vector<std::int32_t>{1, 2, 3});
    for (std::size_t i = 0; i < 2; ++i) {
        EXPECT_EQ(found[i].bounds.lower, 0);
        EXPECT_NEAR(found[i].bounds.upper, 100, 1e-6);
        EXPECT_EQ(found[i].end, StopReason::Rounding);
    }
    EXPECT_EQ(found[2].bounds.upper, 0);
}

/// What is found of one label is the same to the last bit, whichever others are asked for, and in which order.
TEST(Area, OfALabelDoesNotDependOnTheOthers) {
    std::mt19937_64 random(testSeed());
    Grid grid;
    grid.size = {20, 20, 20};
    const VolumeData image = makeBytes(grid, [&](auto...) { return uniform(random, 0, 255); });
    const LabelData labels =
        take(makeLabels(makeBytes(grid, [](auto x, auto y, auto z) { return (x / 3 + y / 2 + z / 4) % 4; }).view()));
    MeshData mesh = take(makeEllipsoid(300));
    for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
        mesh.positions[i] = 9.3F + 0.1F * mesh.positions[i];
    }
    const Held held(mesh, image, byteRamp(), {0, 255});
    const cpu::AreaDesc desc{.threads = 1, .tolerance = 1e-3, .maxSteps = 300};
    const std::vector<LabelArea> all = labelAreas(held, &labels, std::vector<std::int32_t>{0, 1, 2, 3}, desc);
    std::size_t budget = 0;
    for (const std::vector<std::int32_t>& asked :
         {std::vector<std::int32_t>{3}, {2, 1}, {3, 0, 3}, {1, 77, 2}, {3, 2, 1, 0}}) {
        const std::vector<LabelArea> some = labelAreas(held, &labels, asked, desc);
        for (const LabelArea& one : some) {
            if (one.label != 77) {
                const LabelArea& same = all[static_cast<std::size_t>(one.label)];
                EXPECT_EQ(one.bounds.lower, same.bounds.lower);
                EXPECT_EQ(one.bounds.upper, same.bounds.upper);
                EXPECT_EQ(one.end, same.end);
                budget += one.end == StopReason::Budget ? 1 : 0;
            }
        }
    }
    EXPECT_GT(budget, 0U) << "the steps are shared by nobody";
}

TEST(Area, RefusesWhatItCannotUse) {
    const auto refused = [](const cpu::AreaDesc& desc) {
        const Result<cpu::AreaMeter> meter = cpu::AreaMeter::create(desc);
        return meter.ok() ? std::string() : meter.error().text;
    };
    EXPECT_THAT(refused({.tolerance = 0}), HasSubstr("the tolerance 0 mm^2 is not a number from 1e-09 mm^2 on"));
    EXPECT_THAT(refused({.tolerance = std::numeric_limits<double>::quiet_NaN()}), HasSubstr("mm^2"));
    EXPECT_THAT(refused({.tolerance = kInfinity}), HasSubstr("mm^2"));
    EXPECT_THAT(refused({.maxSteps = 0}), HasSubstr("at most 0 steps"));
    EXPECT_THAT(refused({.resolution = 2}), HasSubstr("resolution"));
    EXPECT_THAT(refused({.threads = 5000}), HasSubstr("5000 threads"));

    const Held held(makeFlat(2, 12, 3, 9, 8), valueRamp(), byteRamp(), {0, 255});
    cpu::AreaMeter meter = take(cpu::AreaMeter::create({.threads = 1}));
    const Mat4 pose = identity();
    cpu::BatchItem item{&held.mesh, &held.volume, &held.function, std::span(&pose, 1)};
    const cpu::Batch batch{std::span(&item, 1), {}, 0.5};
    const std::vector<std::int32_t> one{1};
    EXPECT_THAT(meter.measureLabels(batch, one).error().text, HasSubstr("batch item 0"));
    Grid other;
    other.size = {31, 32, 32};
    const LabelData labels = take(makeLabels(makeBytes(other, [](auto...) { return 1; }).view()));
    item.labels = &labels;
    EXPECT_EQ(meter.measureLabels(batch, one).error().code, ErrorCode::Unsupported);
    const LabelData fitting = take(makeLabels(valueRamp().view()));
    item.labels = &fitting;
    EXPECT_TRUE(meter.measureLabels(batch, one).ok());
    const std::vector<std::int32_t> many(kMaxMeasuredLabels + 1, 1);
    EXPECT_EQ(meter.measureLabels(batch, many).error().code, ErrorCode::LimitExceeded);
    EXPECT_TRUE(take(meter.measureLabels(batch, {})).labels.empty());
    item.mesh = nullptr;
    EXPECT_FALSE(meter.measure(batch).ok());
}

TEST(Area, NamesItsEnds) {
    EXPECT_STREQ(toString(StopReason::Closed), "closed");
    EXPECT_STREQ(toString(StopReason::Rounding), "rounding");
    EXPECT_STREQ(toString(StopReason::Budget), "budget");
}

} // namespace
} // namespace voxtact::test
