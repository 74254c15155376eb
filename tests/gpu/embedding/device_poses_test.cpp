// SPDX-License-Identifier: MIT
// Poses in device memory: the pairs that the device makes of them are those of the host, bit for bit.
#include "certified/counted_fixture.h"
#include "device/results/results_impl.h"
#include "exact/shared.h"
#include "few_kinds.h"
#include "raw_fixture.h"
#include "support/scenes.h"
#include "voxtact/samples.h"
#include "vulkan/context_impl.h"

#include <gmock/gmock.h>

#include <array>
#include <bit>
#include <cmath>
#include <iostream>
#include <limits>
#include <map>

namespace voxtact::test {
namespace {

using testing::AllOf;
using testing::Contains;
using testing::HasSubstr;

constexpr std::size_t kPoseFloats = 16;

/// How poses lie in a buffer of the caller's.
struct Layout {
    VkDeviceSize offset = 0;
    VkDeviceSize stride = kPoseFloats * sizeof(float);
};

/// Near and far, scaled, sheared, mirrored and flat: all that is affine.
Mat4 anyPose(const Grid& grid, std::mt19937_64& random) {
    Mat4 pose = randomPoses(grid, 1, 1.5, random).front();
    switch (random() % 6) {
    case 0: // far
        for (std::size_t axis = 0; axis < 3; ++axis) {
            pose[12 + axis] *= std::pow(10.0, uniform(random, 0, 12));
        }
        break;
    case 1: // of another size
        for (std::size_t i = 0; i < 12; ++i) {
            pose[i] *= i % 4 == 3 ? 1 : std::pow(10.0, uniform(random, -6, 6));
        }
        break;
    case 2: // sheared, or mirrored
        for (std::size_t column = 0; column < 3; ++column) {
            for (std::size_t row = 0; row < 3; ++row) {
                pose[4 * column + row] = uniform(random, -2, 2);
            }
        }
        break;
    case 3: // flat, and numbers at the ends of what a float is
        for (std::size_t row = 0; row < 3; ++row) {
            pose[4 + row] = 0;
            pose[8 + row] *= random() % 2 == 0 ? 1e-38 : 1e35;
        }
        break;
    default:
        break;
    }
    return floatPose(pose);
}

Grid anyGrid(std::mt19937_64& random) {
    Grid grid;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        grid.size[axis] = usualSide(random, 5, 16);
        grid.spacing[axis] = uniform(random, 0.2, 3);
        grid.origin[axis] = uniform(random, -100, 100);
    }
    if (random() % 2 == 0) {
        const Mat4 turned = randomRotation(random);
        for (std::size_t i = 0; i < 9; ++i) {
            grid.direction[i] = turned[4 * (i % 3) + i / 3];
        }
    }
    return grid;
}

/// mm: no float holds it.
constexpr double kFar = 3000.1;

MeshData movedBy(MeshData mesh, double by) {
    for (double& coordinate : mesh.positions) {
        coordinate += by;
    }
    return mesh;
}

class DevicePosesTest : public CertifiedTest {
  protected:
    /// A mapped buffer with the poses.
    RawVulkan::HostBuffer write(std::span<const Mat4> poses, const Layout& layout = {}) {
        const RawVulkan::HostBuffer out =
            raw().makeBuffer(layout.offset + layout.stride * poses.size(), VK_BUFFER_USAGE_STORAGE_BUFFER_BIT);
        rewrite(out, poses, layout);
        return out;
    }
    static void rewrite(const RawVulkan::HostBuffer& buffer, std::span<const Mat4> poses, const Layout& layout = {}) {
        for (std::size_t i = 0; i < poses.size(); ++i) {
            std::array<float, kPoseFloats> floats{};
            std::ranges::transform(poses[i], floats.begin(),
                                   [](double element) { return static_cast<float>(element); });
            std::memcpy(static_cast<std::byte*>(buffer.mapped) + layout.offset + layout.stride * i, floats.data(),
                        sizeof floats);
        }
    }
    PoseBuffer wrap(const RawVulkan::HostBuffer& buffer, std::size_t count, const Layout& layout = {}) {
        return take(PoseBuffer::wrap(context(), {.buffer = buffer.buffer,
                                                 .offset = layout.offset,
                                                 .stride = layout.stride,
                                                 .count = static_cast<std::uint32_t>(count)}));
    }
    /// Every projection by every method of the device.
    std::vector<AnyDesc> detectors() {
        std::vector<AnyDesc> out;
        for (const Projection projection : projections()) {
            for (const CountingMethod method : countingMethods()) {
                if (method != CountingMethod::Cpu && context().supports(method, projection)) {
                    out.push_back({.method = method, .projection = projection, .devicePoses = true});
                }
            }
        }
        return out;
    }
    std::size_t comparePairs(std::size_t scenes, std::mt19937_64& random);
    std::vector<PairResult> run(const Detector& detector, const Batch& batch, Results& results) {
        const VkCommandBuffer commands = raw().begin();
        take(detector.cmdDetect(commands, batch, results));
        take(results.cmdReadBack(commands));
        raw().submitAndWait(commands);
        const std::span<const PairResult> read = take(results.read());
        return {read.begin(), read.end()};
    }
};

bool operator==(const PairResult& a, const PairResult& b) {
    return std::memcmp(&a, &b, sizeof a) == 0;
}

/// Of as many scenes as that. Returns how many numbers of the pairs were finite.
std::size_t DevicePosesTest::comparePairs(std::size_t scenes, std::mt19937_64& random) {
    constexpr std::size_t kPoses = 100;
    std::size_t finite = 0;
    std::map<Projection, Detector> detectors;
    for (const Projection projection : {Projection::Certified, Projection::TwoView}) {
        detectors.emplace(projection, take(Detector::create(context(), AnyDesc{.method = CountingMethod::Compute,
                                                                               .projection = projection,
                                                                               .devicePoses = true})));
    }
    for (std::size_t scene = 0; scene < scenes; ++scene) {
        const Grid grid = anyGrid(random);
        const Volume volume = take(
            Volume::upload(context(), queue(), makeBytes(grid, [](auto...) { return 0.0; }).view(), {.bricks = true}));
        const TransferFunction function =
            take(TransferFunction::upload(context(), queue(), {byteRamp(), {0, 255}, kDefaultTableSize}));
        // Every other mesh is far from its own origin.
        const MeshData flat = movedBy(makeFlat(0, 1, 0, 1, 0.5), scene % 2 == 1 ? kFar : 0);
        const Mesh mesh = take(Mesh::upload(context(), queue(), flat.view()));
        EXPECT_EQ(mesh.impl().known.origin.offset[0] != 0, scene % 2 == 1);
        std::vector<Mat4> poses(kPoses);
        std::ranges::generate(poses, [&] { return anyPose(grid, random); });
        const RawVulkan::HostBuffer buffer = write(poses);
        const PoseBuffer onDevice = take(PoseBuffer::wrap(context(), {.buffer = buffer.buffer, .count = kPoses}));
        for (const auto& [projection, detector] : detectors) {
            const View view = flatView(-50, 50, 8, 8);
            const std::array items{
                BatchItem{&mesh, &volume, &function, poses},
                BatchItem{.mesh = &mesh, .volume = &volume, .transferFunction = &function, .poses = &onDevice}};
            Results results = take(Results::create(detector, {.maxPairs = 2 * kPoses}));
            const std::vector<PairResult> found = run(detector, {items, view, 0.5}, results);
            const std::size_t ofPair =
                projection == Projection::Certified ? sizeof(shader::CertifiedPair) : 2 * sizeof(shader::PairTransform);
            const std::vector<std::byte> bytes = raw().readBuffer(results.impl().transforms.get(), 2 * kPoses * ofPair);
            for (std::size_t i = 0; i < kPoses && !HasFailure(); ++i) {
                std::vector<float> host(ofPair / sizeof(float));
                std::vector<float> device(host.size());
                std::memcpy(host.data(), bytes.data() + i * ofPair, ofPair);
                std::memcpy(device.data(), bytes.data() + (kPoses + i) * ofPair, ofPair);
                for (std::size_t word = 0; word < host.size(); ++word) {
                    const bool same =
                        std::bit_cast<std::uint32_t>(host[word]) == std::bit_cast<std::uint32_t>(device[word]);
                    EXPECT_TRUE(same || (std::isnan(host[word]) && std::isnan(device[word])))
                        << "scene " << scene << ", pose " << i << ", word " << word << ": " << host[word] << ", "
                        << device[word];
                    finite += std::isfinite(host[word]) ? 1U : 0U;
                }
                EXPECT_EQ(found[kPoses + i].countLow, found[i].countLow);
                EXPECT_EQ(found[kPoses + i].how, found[i].how);
                EXPECT_EQ(found[kPoses + i].pose, i);
                EXPECT_EQ(found[kPoses + i].item, 1U);
                EXPECT_EQ(found[kPoses + i].pair, kPoses + i);
            }
        }
    }
    return finite;
}

TEST_F(DevicePosesTest, PairsAreThoseOfTheHostBitForBit) {
    std::mt19937_64 random(testSeed());
    EXPECT_GT(comparePairs(randomCases(1000, 200), random), 10'000U);
}

TEST_F(DevicePosesTest, ADeviceWithoutDoublesIsRefusedByName) {
    FeatureRequest less(gpu().device.contextDesc().enabledFeatures);
    less.features2.features.shaderFloat64 = VK_FALSE;
    ContextDesc desc = gpu().device.contextDesc();
    desc.enabledFeatures = &less.features2;
    const CheckReport report = check(desc);
    EXPECT_TRUE(report.usable);
    EXPECT_THAT(report.missing, Contains(AllOf(HasSubstr("shaderFloat64"), HasSubstr("no poses on the device"))));
    const Context without = take(Context::create(desc));
    const Result<Detector> detector = Detector::raster(without, {.devicePoses = true});
    ASSERT_FALSE(detector.ok());
    EXPECT_EQ(detector.error().code, ErrorCode::Unsupported);
    EXPECT_THAT(detector.error().text, HasSubstr("lacks shaderFloat64"));
}

TEST_F(DevicePosesTest, AnswersAreThoseOfHostPosesByEveryMethod) {
    std::mt19937_64 random(testSeed());
    const VolumeData head = take(makeBuiltinVolume("head:32"));
    const Volume volume = take(Volume::upload(context(), queue(), head.view(), {.bricks = true}));
    const std::array points{ControlPoint{40, 0}, ControlPoint{80, 1}};
    const TransferFunction function = upload(points, {0, 255});
    const Mesh mesh =
        take(Mesh::upload(context(), queue(), movedBy(take(makeScalpel()), kFar).view(), {.clusters = true}));
    const View view = View{framingCamera(head.grid, 128, 128), 128, 128};
    std::vector<Mat4> poses = randomPoses(head.grid, 70, 1, random);
    for (Mat4& pose : poses) {
        pose = multiply(pose, translation({-kFar, -kFar, -kFar}));
    }
    std::ranges::transform(poses, poses.begin(), floatPose);
    const Layout layout{.offset = 20, .stride = 100};
    const RawVulkan::HostBuffer buffer = write(poses, layout);
    const PoseBuffer onDevice = wrap(buffer, poses.size(), layout);
    const std::span all(poses);
    BatchItem host{&mesh, &volume, &function};
    BatchItem device = host;
    device.poses = &onDevice;
    std::uint64_t hits = 0;
    for (const AnyDesc& desc : detectors()) {
        SCOPED_TRACE(std::string(toString(desc.projection)) + " " + toString(desc.method));
        const Detector detector = take(Detector::create(context(), desc));
        Results results = take(Results::create(detector, {.maxPairs = 200}));
        std::array items{host, device, host, device};
        items[0].world_from_object = all.first(3);
        items[2].world_from_object = all.subspan(5, 2);
        items[3].poseCount = 4;
        const std::vector<PairResult> found = run(detector, {items, view, kDefaultThreshold}, results);
        for (BatchItem& item : items) {
            const std::size_t pairs = item.pairs();
            if (item.poses != nullptr) {
                item.world_from_object = all.first(pairs);
            }
            item.poses = nullptr;
            item.poseCount.reset();
        }
        const std::vector<PairResult> wanted = run(detector, {items, view, kDefaultThreshold}, results);
        ASSERT_EQ(found.size(), 3 + 70 + 2 + 4U);
        ASSERT_EQ(wanted.size(), found.size());
        for (std::size_t i = 0; i < found.size(); ++i) {
            EXPECT_TRUE(found[i] == wanted[i])
                << "pair " << i << ": " << found[i].countLow << ", " << wanted[i].countLow;
            hits += wanted[i].countLow > 0 ? 1U : 0U;
        }
    }
    EXPECT_GT(hits, 50U);
}

/// Of coordinates that no float holds, from the host's poses: made so, and bent so.
TEST_F(DevicePosesTest, AMeshInMapCoordinatesTouchesWhereItIs) {
    Grid grid;
    grid.size = {20, 20, 20};
    const VolumeData half = makeBytes(grid, [](auto x, auto...) { return x >= 10 ? 100.0 : 0.0; });
    const Volume volume = take(Volume::upload(context(), queue(), half.view(), {.bricks = true}));
    const std::array points{ControlPoint{0, 0}, ControlPoint{100, 1}};
    const TransferFunction function = upload(points, {0, 255});
    const std::vector<double> positions{4500008.9, 4649781.2, 1005.2,    4500008.9, 4649784.2,
                                        1005.2,    4500008.9, 4649781.2, 1008.2};
    const std::vector<std::uint32_t> indices{0, 1, 2};
    const Mesh made = take(Mesh::upload(context(), queue(), {positions, indices}, {.clusters = true}));
    const std::vector<double> before{0, 0, 0, 1, 0, 0, 0, 1, 0};
    Mesh bent = take(Mesh::upload(context(), queue(), {before, indices}, {.clusters = true, .editable = true}));
    const VkCommandBuffer commands = raw().begin();
    take(bent.cmdUpdate(commands, positions));
    raw().submitAndWait(commands);
    EXPECT_EQ(made.facts()->bounds.hi[1], 4649784.2);
    EXPECT_EQ(bent.facts()->rounding, made.facts()->rounding);
    // Opaque from x = 9.1 on; before it, and behind, by more than what a sampler rounds.
    const Mat4 pose = translation({-4500000, -4649776, -1000});
    const std::array poses{multiply(translation({0.18, 0, 0}), pose), multiply(translation({0.22, 0, 0}), pose)};
    const std::array items{BatchItem{&made, &volume, &function, poses}, BatchItem{&bent, &volume, &function, poses}};
    const View view = flatView(0, 20, 64, 64);
    for (const AnyDesc& desc : detectors()) {
        if (desc.projection == Projection::View || desc.projection == Projection::TwoView) {
            continue; // cameras, which see it from its edge
        }
        SCOPED_TRACE(std::string(toString(desc.projection)) + " " + toString(desc.method));
        const Detector detector = take(Detector::create(context(), desc));
        Results results = take(Results::create(detector, {.maxPairs = 4}));
        const std::vector<PairResult> found = run(detector, {items, view, 0.1}, results);
        for (std::size_t i = 0; i < found.size(); ++i) {
            EXPECT_EQ(found[i].countLow > 0, i % 2 == 1) << i;
        }
    }
}

/// One recording, submitted for whatever poses are there when it executes.
TEST_F(DevicePosesTest, ARecordingIsOfThePosesOfItsSubmission) {
    const Volume volume = take(Volume::upload(
        context(), queue(), makeBytes(unitGrid(4), [](auto...) { return 255.0; }).view(), {.bricks = true}));
    const TransferFunction function = upload(byteRamp(), {0, 255});
    const Mesh mesh = upload(makeFlat(0, 1, 0, 1, 0.5));
    const std::array<Mat4, 1> away{translation({0, 0, 3})};
    const std::array<Mat4, 1> inside{identity()};
    const RawVulkan::HostBuffer buffer = write(away);
    const PoseBuffer poses = wrap(buffer, 1);
    const BatchItem item{.mesh = &mesh, .volume = &volume, .transferFunction = &function, .poses = &poses};
    for (const AnyDesc& desc : detectors()) {
        SCOPED_TRACE(std::string(toString(desc.projection)) + " " + toString(desc.method));
        const Detector detector = take(Detector::create(context(), desc));
        Results results = take(Results::create(detector, {}));
        const VkCommandBuffer commands = raw().begin();
        take(detector.cmdDetect(commands, {{&item, 1}, flatView(0, 1, 64, 64), 0.5}, results));
        take(results.cmdReadBack(commands));
        bool end = true;
        for (const bool touches : {false, true, false, true}) {
            rewrite(buffer, touches ? std::span<const Mat4>(inside) : std::span<const Mat4>(away));
            raw().submitAndWait(commands, end);
            end = false;
            EXPECT_EQ(take(results.read())[0].countLow > 0, touches);
        }
    }
}

TEST_F(DevicePosesTest, APoseThatCannotBeUsedIsSaidToBeRefused) {
    const Volume volume = take(Volume::upload(
        context(), queue(), makeBytes(unitGrid(4), [](auto...) { return 255.0; }).view(), {.bricks = true}));
    const TransferFunction function = upload(byteRamp(), {0, 255});
    const Mesh mesh = upload(makeFlat(0, 1, 0, 1, 0.5));
    std::vector<Mat4> poses(19, identity());
    for (std::size_t i = 0; i < 16; ++i) {
        poses[i][i] = i % 2 == 0 ? std::numeric_limits<double>::quiet_NaN() : -std::numeric_limits<double>::infinity();
    }
    poses[16][7] = 1e-30;
    poses[17][15] = 1 + 1e-6;
    const RawVulkan::HostBuffer buffer = write(poses);
    const PoseBuffer onDevice = wrap(buffer, poses.size());
    const BatchItem item{.mesh = &mesh, .volume = &volume, .transferFunction = &function, .poses = &onDevice};
    for (const AnyDesc& desc : detectors()) {
        SCOPED_TRACE(std::string(toString(desc.projection)) + " " + toString(desc.method));
        const Detector detector = take(Detector::create(context(), desc));
        Results results = take(Results::create(detector, {.maxPairs = 32}));
        const std::vector<PairResult> found = run(detector, {{&item, 1}, flatView(0, 1, 64, 64), 0.5}, results);
        for (std::size_t i = 0; i < 18; ++i) {
            const PairAnswer answer = unpack(found[i]);
            EXPECT_FALSE(answer.hit) << i;
            EXPECT_EQ(answer.exactness, Exactness::Refused) << i;
            EXPECT_EQ(answer.possible, desc.projection == Projection::Certified) << i;
            EXPECT_EQ(answer.pose, i);
        }
        EXPECT_TRUE(unpack(found[18]).hit);
        EXPECT_NE(unpack(found[18]).exactness, Exactness::Refused);
    }
}

/// More items than the set-up takes at once, each with a grid of its own.
TEST_F(DevicePosesTest, ManyItemsWithGridsOfTheirOwn) {
    std::vector<Volume> volumes;
    for (std::uint32_t i = 0; i < 40; ++i) {
        Grid grid = unitGrid(4);
        grid.origin[0] += 10.0 * i;
        volumes.push_back(take(Volume::upload(context(), queue(), makeBytes(grid, [](auto...) { return 255.0; }).view(),
                                              {.bricks = true})));
    }
    const TransferFunction function = upload(byteRamp(), {0, 255});
    const Mesh mesh = upload(makeFlat(0, 1, 0, 1, 0.5));
    std::vector<Mat4> poses(volumes.size());
    for (std::size_t i = 0; i < poses.size(); ++i) {
        poses[i] = translation({10.0 * static_cast<double>(i), 0, 0});
    }
    const RawVulkan::HostBuffer buffer = write(poses);
    const PoseBuffer onDevice = wrap(buffer, poses.size());
    std::vector<BatchItem> items;
    for (const Volume& volume : volumes) {
        items.push_back({.mesh = &mesh, .volume = &volume, .transferFunction = &function, .poses = &onDevice});
    }
    for (const Projection projection : {Projection::Certified, Projection::DominantAxis}) {
        const Detector detector = take(Detector::create(
            context(), AnyDesc{.method = CountingMethod::Compute, .projection = projection, .devicePoses = true}));
        Results results = take(Results::create(detector, {.maxPairs = 1600}));
        const std::vector<PairResult> found = run(detector, {items, {}, 0.5}, results);
        ASSERT_EQ(found.size(), 1600U);
        for (std::size_t i = 0; i < found.size(); ++i) {
            EXPECT_EQ(found[i].countLow > 0, i / 40 == i % 40) << toString(projection) << ", pair " << i;
        }
    }
}

TEST_F(DevicePosesTest, WhatCannotBeUsedIsRefusedByName) {
    const RawVulkan::HostBuffer buffer = write(std::array<Mat4, 1>{identity()});
    const auto refused = [&](const WrappedPoses& wrapped) {
        const Result<PoseBuffer> made = PoseBuffer::wrap(context(), wrapped);
        return made.ok() ? std::string("made") : made.error().text;
    };
    EXPECT_THAT(refused({.count = 1}), HasSubstr("WrappedPoses::buffer is null"));
    EXPECT_THAT(refused({.buffer = buffer.buffer}), HasSubstr("WrappedPoses::count is 0"));
    EXPECT_THAT(refused({.buffer = buffer.buffer, .stride = 60, .count = 1}), HasSubstr("stride must be at least 64"));
    EXPECT_THAT(refused({.buffer = buffer.buffer, .offset = 2, .count = 1}), HasSubstr("multiples of 4"));
    EXPECT_THAT(refused({.buffer = buffer.buffer, .count = UINT32_MAX}), HasSubstr("maxStorageBufferRange"));
    EXPECT_THAT(refused({.buffer = buffer.buffer, .count = 1, .maxScale = 0}), HasSubstr("maxScale is 0"));
    const PoseBuffer poses = wrap(buffer, 1);
    EXPECT_EQ(poses.count(), 1U);

    const Volume volume = take(Volume::upload(
        context(), queue(), makeBytes(unitGrid(4), [](auto...) { return 255.0; }).view(), {.bricks = true}));
    const TransferFunction function = upload(byteRamp(), {0, 255});
    const Mesh mesh = upload(makeFlat(0, 1, 0, 1, 0.5));
    const std::array<Mat4, 1> host{identity()};
    AnyDesc desc{.method = CountingMethod::Compute, .projection = Projection::Certified};
    BatchItem item{.mesh = &mesh, .volume = &volume, .transferFunction = &function, .poses = &poses};
    BlockingDetector asked = detector(desc);
    const auto said = [&] {
        const Result<BatchAnswer> answer = asked.detect({{&item, 1}, {}, 0.5});
        return answer.ok() ? std::string("answered") : answer.error().text;
    };
    EXPECT_THAT(said(), HasSubstr("made without devicePoses"));
    desc.devicePoses = true;
    asked = detector(desc);
    EXPECT_EQ(said(), "answered");
    item.world_from_object = host;
    EXPECT_THAT(said(), HasSubstr("it can have one of them"));
    item.world_from_object = {};
    item.poseCount = 2;
    EXPECT_THAT(said(), HasSubstr("poseCount is 2, poses has 1"));
    item.poseCount = 0;
    EXPECT_EQ(said(), "answered");
    item.poses = nullptr;
    EXPECT_THAT(said(), HasSubstr("poseCount is of poses, which is null"));
}

} // namespace
} // namespace voxtact::test
