// SPDX-License-Identifier: MIT
// cmdPrepare() and retire(): one protocol for created and wrapped resources.
#include "raw_fixture.h"
#include "support/scenes.h"
#include "voxtact/detector.h"

#include <gmock/gmock.h>

namespace voxtact::test {
namespace {

using testing::HasSubstr;

class PrepareTest : public RawGpuTest {
  protected:
    PrepareTest() {
        bytes_ = makeBytes(unitGrid(7), [](auto...) { return 255.0; });
    }

    Volume wrappedVolume() {
        WrappedVolume wrapped;
        wrapped.grid = bytes_.grid;
        wrapped.bricks = true;
        wrapped.format = VK_FORMAT_R8_UNORM;
        wrapped.slope = 255;
        wrapped.view = raw().makeImage(VK_IMAGE_TYPE_3D, wrapped.format, {7, 7, 7}, bytes_.voxels, wrapped.layout);
        return take(Volume::wrap(context(), wrapped));
    }
    Mesh wrappedMesh() {
        constexpr float kCorners[] = {0.1F, 0.1F, 0.5F, 0.9F, 0.1F, 0.5F, 0.9F, 0.9F, 0.5F};
        WrappedMesh wrapped;
        wrapped.vertices = raw()
                               .makeBuffer(std::span<const float>(kCorners),
                                           VK_BUFFER_USAGE_VERTEX_BUFFER_BIT | VK_BUFFER_USAGE_STORAGE_BUFFER_BIT)
                               .buffer;
        wrapped.vertexCount = 3;
        wrapped.triangleCount = 1;
        wrapped.storage = true;
        wrapped.clusters = true;
        return take(Mesh::wrap(context(), wrapped));
    }

    VolumeData bytes_;
};

TEST_F(PrepareTest, OneCallMakesEveryResourceReady) {
    Volume created = take(Volume::create(context(), bytes_.view(), {.bricks = true}));
    Volume image = wrappedVolume();
    TransferFunction function = take(TransferFunction::create(context(), {kAllOpaque, kBytes, 64}));
    Mesh flat = take(Mesh::create(context(), makeFlat(0.1, 0.9, 0.1, 0.9, 0.5).view(), {.clusters = true}));
    Mesh triangle = wrappedMesh();
    const Resource resources[] = {&created, &image, &function, &flat, &triangle};
    const Detector detector = take(Detector::certified(context()));
    Results results = take(Results::create(detector, {.maxPairs = 2}));
    const Mat4 pose = identity();
    const BatchItem items[] = {{&flat, &image, &function, std::span(&pose, 1)},
                               {&triangle, &created, &function, std::span(&pose, 1)}};
    const VkCommandBuffer unprepared = raw().begin();
    EXPECT_EQ(detector.cmdDetect(unprepared, {items, {}, 0.5}, results).error().code, ErrorCode::NotReady);
    raw().submitAndWait(unprepared);

    const VkCommandBuffer commands = raw().begin();
    take(cmdPrepare(commands, resources));
    take(detector.cmdDetect(commands, {items, {}, 0.5}, results));
    take(results.cmdReadBack(commands));
    raw().submitAndWait(commands);
    retire(resources);
    for (const PairResult& pair : take(results.read())) {
        EXPECT_TRUE(unpack(pair).hit);
    }
    // Nothing is left to record, and uploads of their own are refused.
    take(cmdPrepare(VK_NULL_HANDLE, resources));
    EXPECT_FALSE(flat.cmdUpload(VK_NULL_HANDLE).ok());
}

TEST_F(PrepareTest, SkipsWhatWasRecordedAndRefusesNull) {
    Mesh flat = take(Mesh::create(context(), makeFlat(0, 1, 0, 1, 0.5).view(), {.editable = true}));
    const Resource resources[] = {&flat, static_cast<LabelMap*>(nullptr)};
    const VkCommandBuffer commands = raw().begin();
    EXPECT_THAT(cmdPrepare(commands, resources).error().text, HasSubstr("resource 1 is null"));
    // An edit stays: the upload is not recorded again.
    constexpr double kBent[] = {0, 0, 0.25, 1, 0, 0.25, 1, 1, 0.25, 0, 1, 0.25};
    take(flat.cmdUpdate(commands, kBent));
    take(cmdPrepare(commands, std::span(resources, 1)));
    raw().submitAndWait(commands);
    retire(resources);
    EXPECT_EQ(flat.facts()->bounds.lo[2], 0.25);
}

} // namespace
} // namespace voxtact::test
