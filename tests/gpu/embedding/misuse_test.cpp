// SPDX-License-Identifier: MIT
// What an embedder gets wrong: each refused by name, before anything is recorded.
#include "device/outputs/output_store.h"
#include "raw_fixture.h"
#include "support/host_meters.h"
#include "support/scenes.h"
#include "voxtact/cpu.h"
#include "voxtact/render.h"

#include <gmock/gmock.h>

#include <optional>

namespace voxtact::test {
namespace {

using testing::HasSubstr;

class MisuseTest : public RawGpuTest {
  protected:
    void SetUp() override {
        RawGpuTest::SetUp();
        if (IsSkipped() || HasFatalFailure()) {
            return;
        }
        volume_.emplace(upload(bytes()));
        function_.emplace(upload(byteRamp(), {0, 255}));
        mesh_.emplace(upload(makeFlat(0, 1, 0, 1, 0.5)));
    }
    void TearDown() override {
        mesh_.reset();
        function_.reset();
        volume_.reset();
        RawGpuTest::TearDown();
    }

    [[nodiscard]] static VolumeData bytes() {
        return makeBytes(unitGrid(4), [](auto...) { return 255.0; });
    }
    [[nodiscard]] BatchItem item() const { return {&*mesh_, &*volume_, &*function_, std::span(&pose_, 1)}; }
    [[nodiscard]] static Batch batchOf(const BatchItem& item) {
        return {std::span(&item, 1), flatView(0, 1, 16, 16), 0.5};
    }
    /// The error of recording one item.
    [[nodiscard]] Error refused(const AnyDesc& desc, const BatchItem& bad) {
        const Detector one = take(Detector::create(context(), desc));
        Results results = take(Results::create(one, {.room = {.triangles = 64, .labels = 4}}));
        const Result<void> recorded = one.cmdDetect(raw().begin(), batchOf(bad), results);
        EXPECT_FALSE(recorded.ok());
        return recorded.ok() ? Error{} : recorded.error();
    }

    const Mat4 pose_ = identity();
    std::optional<Volume> volume_;
    std::optional<TransferFunction> function_;
    std::optional<Mesh> mesh_;
};

TEST_F(MisuseTest, NumbersOfNothing) {
    EXPECT_EQ(Detector::raster(context(), {.filter = static_cast<Filter>(99)}).error().text,
              "there is no filter number 99");
    EXPECT_EQ(Detector::raster(context(), {.boundary = static_cast<Boundary>(99)}).error().text,
              "there is no boundary number 99");
    EXPECT_EQ(cpu::Detector::create({.boundary = static_cast<Boundary>(99)}).error().text,
              "there is no boundary number 99");
    VolumeData data = bytes();
    data.type = static_cast<ScalarType>(77);
    EXPECT_EQ(Volume::create(context(), data.view()).error().text, "there is no scalar type number 77");
    EXPECT_EQ(cpu::Volume::create(data.view()).error().text, "there is no scalar type number 77");
}

TEST_F(MisuseTest, WrappedImagesInLayoutsThatNobodyCanSample) {
    WrappedVolume volume;
    volume.view = volume_->view();
    volume.format = volume_->format();
    volume.grid = unitGrid(4);
    WrappedTransferFunction function;
    function.view = volume_->view(); // of no use as a table, and never examined
    for (const VkImageLayout layout :
         {VK_IMAGE_LAYOUT_UNDEFINED, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL}) {
        volume.layout = function.layout = layout;
        const std::string number = "VkImageLayout " + std::to_string(layout);
        EXPECT_THAT(Volume::wrap(context(), volume).error().text, HasSubstr("WrappedVolume::layout (" + number));
        EXPECT_THAT(TransferFunction::wrap(context(), function).error().text,
                    HasSubstr("WrappedTransferFunction::layout (" + number));
    }
    for (const VkImageLayout layout : {VK_IMAGE_LAYOUT_GENERAL, VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL}) {
        volume.layout = layout;
        EXPECT_TRUE(Volume::wrap(context(), volume).ok());
    }
}

TEST_F(MisuseTest, AWrappedGridBeyondTheLimits) {
    WrappedVolume volume;
    volume.view = volume_->view();
    volume.format = volume_->format();
    volume.grid = unitGrid(4);
    volume.grid.size[2] = 1U << 30U;
    const Result<Volume> wrapped = Volume::wrap(context(), volume);
    ASSERT_FALSE(wrapped.ok());
    EXPECT_EQ(wrapped.error().code, ErrorCode::LimitExceeded);
    EXPECT_THAT(wrapped.error().text, HasSubstr("WrappedVolume::grid has 1073741824 voxels along z"));
}

TEST_F(MisuseTest, AQueueFamilyThatIsNotThere) {
    QueueAccess queue = this->queue();
    queue.family = 42;
    const std::string text = "QueueAccess::family is 42, the device has ";
    EXPECT_THAT(BlockingDetector::create(context(), RasterDesc{}, queue).error().text, HasSubstr(text));
    EXPECT_THAT(BlockingRenderer::create(context(), queue).error().text, HasSubstr(text));
    EXPECT_THAT(Volume::upload(context(), queue, bytes().view()).error().text, HasSubstr(text));
    EXPECT_THAT(selfTest(context(), queue).error().text, HasSubstr(text));
    const Detector detector = take(Detector::raster(context(), {}));
    EXPECT_THAT(Results::create(detector, {.timestamps = true, .queueFamily = 42}).error().text,
                HasSubstr("ResultsDesc::queueFamily is 42"));
}

TEST_F(MisuseTest, ARingOfTooManyFrames) {
    const Detector detector = take(Detector::raster(context(), {}));
    EXPECT_THAT(ResultRing::create(detector, 1'000'000'000, {}).error().text, HasSubstr("a ring of 1000000000 frames"));
    EXPECT_FALSE(ResultRing::create(detector, 4097, {}).ok());
    ResultRing ring = take(ResultRing::create(detector, 2, {}));
    const ResultRing taken = std::move(ring);
    EXPECT_THAT(ring.begin(0).error().text, HasSubstr("moved from")); // NOLINT(bugprone-use-after-move)
    EXPECT_THAT(ring.read(0).error().text, HasSubstr("moved from"));
}

TEST_F(MisuseTest, WhatWasNeverUploaded) {
    const Volume volume = take(Volume::create(context(), bytes().view()));
    const TransferFunction function = take(TransferFunction::create(context(), {byteRamp(), {0, 255}}));
    const Mesh mesh = take(Mesh::create(context(), makeFlat(0, 1, 0, 1, 0.5).view()));
    BatchItem bad = item();
    bad.volume = &volume;
    EXPECT_EQ(refused({}, bad).code, ErrorCode::NotReady);
    EXPECT_THAT(refused({}, bad).text, HasSubstr("batch item 0: the volume was never uploaded"));
    bad = item();
    bad.transferFunction = &function;
    EXPECT_THAT(refused({}, bad).text, HasSubstr("batch item 0: the transfer function was never uploaded"));
    bad = item();
    bad.mesh = &mesh;
    EXPECT_THAT(refused({}, bad).text, HasSubstr("batch item 0: the mesh was never uploaded"));
    LabelData labels;
    labels.grid = unitGrid(2);
    labels.indices.assign(8, 0);
    labels.values = {0, 7};
    const LabelMap map = take(LabelMap::create(context(), labels));
    bad = item();
    bad.labels = &map;
    EXPECT_THAT(refused({.method = CountingMethod::Compute, .outputs = {.labels = true}}, bad).text,
                HasSubstr("batch item 0: the label map was never uploaded"));
    Volume edited = take(Volume::create(context(), bytes().view(), {.editable = true}));
    EXPECT_THAT(edited.cmdSet(raw().begin(), VoxelBox{{}, {1, 1, 1}}, 0).error().text, HasSubstr("never uploaded"));
}

TEST_F(MisuseTest, BricksThatWereNeverFilled) {
    if (!context().supports(CountingMethod::Compute, Projection::Certified)) {
        GTEST_SKIP() << "no certified";
    }
    WrappedVolume wrap;
    wrap.view = volume_->view();
    wrap.format = volume_->format();
    wrap.grid = unitGrid(4);
    wrap.bricks = true;
    Volume volume = take(Volume::wrap(context(), wrap));
    const AnyDesc desc{.method = CountingMethod::Compute, .projection = Projection::Certified};
    BatchItem bad = item();
    bad.volume = &volume;
    EXPECT_THAT(refused(desc, bad).text, HasSubstr("bricks of the wrapped volume were never filled"));
    const VkCommandBuffer commands = raw().begin();
    take(volume.cmdUpdateBricks(commands, {{}, {4, 4, 3}}));
    EXPECT_THAT(refused(desc, bad).text, HasSubstr("were never filled")) << "of a part";
    take(volume.cmdUpdateBricks(commands, {{}, {4, 4, 4}}));
    const Detector one = take(Detector::create(context(), desc));
    Results results = take(Results::create(one, {}));
    take(one.cmdDetect(commands, batchOf(bad), results));
    take(results.cmdReadBack(commands));
    raw().submitAndWait(commands);
    EXPECT_GT((*results.read())[0].countLow, 0U);
}

TEST_F(MisuseTest, APictureOfWhatWasNeverUploaded) {
    const Renderer renderer = take(Renderer::create(context()));
    const RenderTransferFunctionDesc desc{.opacity = {byteRamp(), {0, 255}, 16}};
    const RenderTransferFunction there = take(RenderTransferFunction::upload(renderer, queue(), desc));
    const RenderTransferFunction notThere = take(RenderTransferFunction::create(renderer, desc));
    const Volume volume = take(Volume::create(context(), bytes().view()));
    BlockingRenderer blocking = take(BlockingRenderer::create(context(), queue()));
    Scene scene;
    scene.clip_from_world = flatView(0, 1, 16, 16).clip_from_world;
    scene.volume = &volume;
    scene.transferFunction = &there;
    EXPECT_THAT(blocking.render(scene, {16, 16}).error().text, HasSubstr("Scene::volume was never uploaded"));
    scene.volume = &*volume_;
    scene.transferFunction = &notThere;
    EXPECT_THAT(blocking.render(scene, {16, 16}).error().text, HasSubstr("Scene::transferFunction was never uploaded"));
    scene.transferFunction = &there;
    scene.mesh = &*mesh_;
    scene.paint.what = static_cast<Paint>(99);
    EXPECT_THAT(blocking.render(scene, {16, 16}).error().text, HasSubstr("there is no paint number 99"));
    scene.paint.what = Paint::Plain;
    EXPECT_TRUE(blocking.render(scene, {16, 16}).ok());
}

TEST_F(MisuseTest, ANullCommandBuffer) {
    const std::string text = "the command buffer is null";
    Volume volume = take(Volume::create(context(), bytes().view(), {.bricks = true, .editable = true}));
    TransferFunction function = take(TransferFunction::create(context(), {byteRamp(), {0, 255}}));
    Mesh mesh = take(Mesh::create(context(), makeFlat(0, 1, 0, 1, 0.5).view()));
    EXPECT_EQ(volume.cmdUpload(VK_NULL_HANDLE).error().text, text);
    EXPECT_EQ(function.cmdUpload(VK_NULL_HANDLE).error().text, text);
    EXPECT_EQ(function.cmdUpdate(VK_NULL_HANDLE, {byteRamp(), {0, 255}}).error().text, text);
    EXPECT_EQ(mesh.cmdUpload(VK_NULL_HANDLE).error().text, text);
    const VkCommandBuffer commands = raw().begin();
    take(volume.cmdUpload(commands));
    raw().submitAndWait(commands);
    const VoxelBox box{{}, {1, 1, 1}};
    const std::byte voxel{};
    EXPECT_EQ(volume.cmdSet(VK_NULL_HANDLE, box, 0).error().text, text);
    EXPECT_EQ(volume.cmdWrite(VK_NULL_HANDLE, box, {&voxel, 1}).error().text, text);
    EXPECT_EQ(volume.cmdUpdateBricks(VK_NULL_HANDLE, box).error().text, text);
    const Detector one = take(Detector::raster(context(), {}));
    Results results = take(Results::create(one, {}));
    EXPECT_EQ(one.cmdDetect(VK_NULL_HANDLE, batchOf(item()), results).error().text, text);
    EXPECT_EQ(results.cmdReadBack(VK_NULL_HANDLE).error().text, text);
}

TEST_F(MisuseTest, ReadingAFrameEarlyIsNotReady) {
    const Detector one =
        take(Detector::raster(context(), {.outputs = {.triangles = true, .contacts = true, .bounds = true}}));
    Results results = take(Results::create(one, {.maxPairs = 2, .room = {.triangles = 64, .contacts = 1024}}));
    EXPECT_EQ(results.cmdReadBack(raw().begin()).error().code, ErrorCode::NotReady);
    BatchAnswer answer;
    const auto record = [&](std::span<const Mat4> poses) {
        BatchItem some = item();
        some.world_from_object = poses;
        const VkCommandBuffer commands = raw().begin();
        take(one.cmdDetect(commands, batchOf(some), results));
        take(results.cmdReadBack(commands));
        return commands;
    };
    const auto expectNotReady = [&] {
        EXPECT_EQ(results.read().error().code, ErrorCode::NotReady);
        const Result<void> outputs = results.readOutputs(answer);
        ASSERT_FALSE(outputs.ok());
        EXPECT_EQ(outputs.error().code, ErrorCode::NotReady);
        EXPECT_THAT(outputs.error().text, HasSubstr("has not completed"));
    };
    // Of two pairs, and then of one: what is in memory then is of the pairs before.
    const Mat4 poses[] = {translation({0, 0, 3}), identity()};
    const VkCommandBuffer first = record(poses);
    expectNotReady();
    raw().submitAndWait(first);
    take(results.readOutputs(answer));
    EXPECT_EQ(answer.contacts.size(), 256U);
    EXPECT_EQ(answer.contacts.front().pair, 1U);
    const VkCommandBuffer second = record(std::span(poses).last(1));
    expectNotReady();
    raw().submitAndWait(second);
    take(results.readOutputs(answer));
    EXPECT_EQ(answer.contacts.front().pair, 0U);
    EXPECT_EQ((*results.read())[0].countLow, 256U);
}

TEST_F(MisuseTest, OutputsThatTheBatchDoesNotHaveAreRefused) {
    // A list with one contact in host memory, that some of its numbers point out of.
    std::vector<std::uint32_t> words(OUTPUT_HEADER_WORDS + OUTPUT_CONTACT_WORDS);
    words[0] = 1;
    OutputStore store;
    store.room.contacts = 1;
    store.recorded.contacts = true;
    store.items = {{.pairs = 2, .triangles = 3, .labels = std::make_shared<const std::vector<std::int32_t>>(4, 9)}};
    store.readBack.mapped = words.data();
    const auto unpacked = [&](std::uint32_t pair, std::uint32_t triangle, std::uint32_t label) {
        ContactResult contact{};
        contact.pair = pair;
        contact.triangle = triangle;
        contact.label = label;
        std::memcpy(words.data() + OUTPUT_HEADER_WORDS, &contact, sizeof contact);
        BatchAnswer answer;
        return unpackOutputs(store, answer);
    };
    EXPECT_TRUE(unpacked(1, 2, 3).ok());
    EXPECT_THAT(unpacked(2, 0, 0).error().text, HasSubstr("of pair 2"));
    EXPECT_THAT(unpacked(0, 3, 0).error().text, HasSubstr("triangle 3"));
    EXPECT_THAT(unpacked(0, 0, 0xffffffff).error().text, HasSubstr("label number 4294967295"));
}

} // namespace
} // namespace voxtact::test
