// SPDX-License-Identifier: MIT
// Refusals that only a device can give. Each says what, and nothing is lost: the next call works.
#include "device/touch/certified_queues.h"
#include "gpu_fixture.h"
#include "interception.h"
#include "raw_vulkan.h"
#include "support/scenes.h"
#include "vulkan/context_impl.h"

#include <gmock/gmock.h>

#include <limits>
#include <optional>

namespace voxtact::test {
namespace {

using testing::AllOf;
using testing::HasSubstr;

class BadInputTest : public GpuTest {
  protected:
    void SetUp() override {
        GpuTest::SetUp();
        if (IsSkipped() || HasFatalFailure()) {
            return;
        }
        volume_.emplace(upload(makeBytes(unitGrid(4), [](auto...) { return 255.0; })));
        function_.emplace(upload(byteRamp(), {0, 255}));
        mesh_.emplace(upload(makeFlat(0, 1, 0, 1, 0.5)));
    }
    void TearDown() override {
        mesh_.reset();
        function_.reset();
        volume_.reset();
        GpuTest::TearDown();
    }

    [[nodiscard]] BatchItem item() const { return {&*mesh_, &*volume_, &*function_, std::span(&pose_, 1)}; }

    /// The error of a batch, after which a good batch must still give its answer.
    Error refused(const std::function<void(Batch&, BatchItem&)>& spoil) {
        BlockingDetector one = detector({});
        BatchItem bad = item();
        Batch batch{std::span(&bad, 1), flatView(0, 1, 16, 16), 0.5};
        spoil(batch, bad);
        const Result<BatchAnswer> answer = one.detect(batch);
        EXPECT_FALSE(answer.ok());
        const BatchItem good = item();
        EXPECT_EQ(take(one.detect({std::span(&good, 1), flatView(0, 1, 16, 16), 0.5})).pairs[0].count, 256U);
        return answer.ok() ? Error{} : answer.error();
    }

    Mat4 pose_ = identity();
    std::optional<Volume> volume_;
    std::optional<TransferFunction> function_;
    std::optional<Mesh> mesh_;
};

TEST_F(BadInputTest, ViewportOfZeroOrBeyondTheLimit) {
    EXPECT_THAT(refused([](Batch& batch, auto&) { batch.view.width = 0; }).text, HasSubstr("0x16"));
    const std::uint32_t most = context().maxViewport().width;
    const Error error = refused([&](Batch& batch, auto&) { batch.view.width = most + 1; });
    EXPECT_EQ(error.code, ErrorCode::LimitExceeded);
    EXPECT_THAT(error.text, HasSubstr(std::to_string(most)));
    EXPECT_THAT(error.text, HasSubstr("maxViewportDimensions"));
}

TEST_F(BadInputTest, CamerasAndPoses) {
    const double nan = std::numeric_limits<double>::quiet_NaN();
    EXPECT_THAT(refused([&](Batch& batch, auto&) { batch.view.clip_from_world[5] = nan; }).text,
                HasSubstr("not finite"));
    EXPECT_THAT(refused([](Batch& batch, auto&) { batch.view.clip_from_world[5] = 0; }).text, HasSubstr("singular"));
    Mat4 poses[2] = {identity(), identity()};
    poses[1][13] = std::numeric_limits<double>::infinity();
    EXPECT_THAT(refused([&](Batch&, BatchItem& bad) { bad.world_from_object = poses; }).text,
                HasSubstr("batch item 0, pose 1: row 2, column 4"));
    poses[1] = identity();
    poses[1][3] = 0.5;
    EXPECT_THAT(refused([&](Batch&, BatchItem& bad) { bad.world_from_object = poses; }).text,
                HasSubstr("it must be 0 0 0 1"));
}

TEST_F(BadInputTest, ThresholdAndNullObjects) {
    EXPECT_THAT(refused([](Batch& batch, auto&) { batch.threshold = 1.5; }).text, HasSubstr("1.5"));
    EXPECT_THAT(refused([](Batch&, BatchItem& bad) { bad.mesh = nullptr; }).text, HasSubstr("null"));
}

TEST_F(BadInputTest, VolumeBeyondTheLimits) {
    // More voxels along z than any device takes, and few of them: the limit is found before memory is.
    VolumeData data;
    data.grid.size = {1, 1, 1U << 20U};
    data.voxels.resize(1U << 20U);
    const Result<Volume> volume = Volume::create(context(), data.view());
    ASSERT_FALSE(volume.ok());
    EXPECT_EQ(volume.error().code, ErrorCode::LimitExceeded);
    EXPECT_THAT(volume.error().text, HasSubstr("1048576 voxels along z"));
    EXPECT_THAT(volume.error().text, HasSubstr("maxImageDimension3D"));
    EXPECT_THAT(volume.error().text, HasSubstr(std::to_string(context().impl().limits.maxImageDimension3D)));
}

TEST_F(BadInputTest, TableBeyondTheLimits) {
    const Result<TransferFunction> function = TransferFunction::create(context(), {byteRamp(), {0, 255}, 1U << 30U});
    ASSERT_FALSE(function.ok());
    EXPECT_EQ(function.error().code, ErrorCode::LimitExceeded);
    EXPECT_THAT(function.error().text, HasSubstr("maxImageDimension1D"));
}

TEST_F(BadInputTest, MorePairsThanABufferHolds) {
    const Detector detector = take(Detector::raster(context(), {}));
    const Result<Results> results = Results::create(detector, {.maxPairs = UINT32_MAX});
    ASSERT_FALSE(results.ok());
    EXPECT_EQ(results.error().code, ErrorCode::LimitExceeded);
    EXPECT_THAT(results.error().text, HasSubstr("maxStorageBufferRange"));
    EXPECT_FALSE(Results::create(detector, {.maxPairs = 0}).ok());
}

TEST_F(BadInputTest, MorePairsThanThereIsRoomForBesideTheQueues) {
    // The pairs themselves fit.
    const VkDeviceSize range = context().impl().limits.maxStorageBufferRange;
    const auto pairs = static_cast<std::uint32_t>((range - kSetupBytes - kOpaqueBytes) / sizeof(shader::PairTransform));
    const VkDeviceSize most = context().impl().maxAllocation;
    const std::string limit = range <= most ? "maxStorageBufferRange is " + std::to_string(range)
                                            : "maxMemoryAllocationSize is " + std::to_string(most);
    const Detector detector = take(Detector::certified(context()));
    const Result<Results> results = Results::create(detector, {.maxPairs = pairs});
    ASSERT_FALSE(results.ok());
    EXPECT_EQ(results.error().code, ErrorCode::LimitExceeded);
    EXPECT_THAT(
        results.error().text,
        AllOf(HasSubstr(std::to_string(pairs) + " pairs with the queues of the projection certified need a buffer "),
              HasSubstr(limit)));
}

TEST_F(BadInputTest, HostDataIsChecked) {
    MeshData mesh = makeFlat(0, 1, 0, 1, 0.5);
    mesh.indices[4] = 9;
    EXPECT_THAT(Mesh::create(context(), mesh.view()).error().text, HasSubstr("triangle 1"));
    VolumeData volume = makeVolume<float>(unitGrid(4), ScalarType::Float32, [](std::uint32_t x, auto y, auto z) {
        return x == 1 && y == 2 && z == 3 ? std::numeric_limits<double>::quiet_NaN() : 0.0;
    });
    EXPECT_THAT(Volume::create(context(), volume.view()).error().text, HasSubstr("voxel (1, 2, 3) is NaN"));
    volume.grid.direction = {1, 0, 0, 1, 0, 0, 0, 0, 1};
    EXPECT_THAT(Volume::create(context(), volume.view()).error().text, HasSubstr("singular"));
}

TEST_F(BadInputTest, WrappedObjectsAreChecked) {
    EXPECT_THAT(Volume::wrap(context(), {}).error().text, HasSubstr("WrappedVolume::view is null"));
    EXPECT_THAT(Mesh::wrap(context(), {}).error().text, HasSubstr("WrappedMesh::vertices is null"));
    EXPECT_THAT(TransferFunction::wrap(context(), {}).error().text, HasSubstr("view is null"));
    WrappedVolume volume;
    volume.view = volume_->view();
    volume.format = VK_FORMAT_R8G8B8A8_UNORM;
    volume.grid = unitGrid(4);
    EXPECT_THAT(Volume::wrap(context(), volume).error().text, HasSubstr("R8_UNORM"));
    volume.format = VK_FORMAT_R8_UNORM;
    constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
    constexpr double kInfinity = std::numeric_limits<double>::infinity();
    for (const ValueRange none : {ValueRange{250, 150}, ValueRange{kInfinity, -kInfinity}, ValueRange{kNaN, kNaN},
                                  ValueRange{0, kNaN}, ValueRange{kNaN, 0}}) {
        volume.boundaryValues = none;
        EXPECT_THAT(Volume::wrap(context(), volume).error().text, HasSubstr("WrappedVolume::boundaryValues"));
    }
    volume.boundaryValues = ValueRange{200, 200};
    EXPECT_TRUE(Volume::wrap(context(), volume).ok());
}

/// A slope that no float holds gave counts of 0, and exact ones.
TEST_F(BadInputTest, ValuesThatFloatsDoNotHold) {
    WrappedVolume wrapped;
    wrapped.view = volume_->view();
    wrapped.format = VK_FORMAT_R8_UNORM;
    wrapped.grid = unitGrid(4);
    for (const double slope : {1e39, 1e300, 1e-300}) {
        wrapped.slope = slope;
        const Volume volume = take(Volume::wrap(context(), wrapped));
        EXPECT_THAT(refused([&](Batch&, BatchItem& bad) { bad.volume = &volume; }).text,
                    HasSubstr("batch item 0: single precision cannot hold"))
            << slope;
    }
}

/// Ends that wrap round to small ones.
TEST_F(BadInputTest, WrappedMeshesThatNoBufferHolds) {
    RawVulkan raw(gpu().device);
    const VkBuffer buffer = raw.makeBuffer(4096, VK_BUFFER_USAGE_VERTEX_BUFFER_BIT | VK_BUFFER_USAGE_INDEX_BUFFER_BIT |
                                                     VK_BUFFER_USAGE_STORAGE_BUFFER_BIT)
                                .buffer;
    const WrappedMesh good{.vertices = buffer, .vertexCount = 3, .indices = buffer, .triangleCount = 1};
    EXPECT_TRUE(Mesh::wrap(context(), good).ok());
    for (const bool storage : {false, true}) {
        WrappedMesh bad = good;
        bad.storage = storage;
        bad.vertexOffset = ~VkDeviceSize{3};
        EXPECT_THAT(Mesh::wrap(context(), bad).error().text, HasSubstr("beyond what a buffer can have"));
        bad.vertexOffset = 0;
        bad.indexOffset = ~VkDeviceSize{3};
        EXPECT_THAT(Mesh::wrap(context(), bad).error().text, HasSubstr("beyond what a buffer can have"));
    }
}

TEST_F(BadInputTest, ReadingTooEarlyIsAnError) {
    const Detector detector = take(Detector::raster(context(), {}));
    Results results = take(Results::create(detector, {.maxPairs = 4}));
    EXPECT_EQ(results.read().error().code, ErrorCode::NotReady);
    EXPECT_EQ(results.gpuMilliseconds().error().code, ErrorCode::NotReady);
    ResultRing ring = take(ResultRing::create(detector, 2, {.maxPairs = 4}));
    EXPECT_EQ(ring.read(0).error().code, ErrorCode::NotReady);
    EXPECT_TRUE(ring.begin(5).ok());
    EXPECT_THAT(ring.read(3).error().text, HasSubstr("taken by frame 5"));
    EXPECT_FALSE(ring.begin(3).ok());
}

/// What is farther apart than a draw may read is refused where it is drawn, and counted by `compute`.
TEST_F(BadInputTest, VerticesTooFarApartToDraw) {
    const std::uint32_t most = context().impl().limits.maxVertexInputBindingStride;
    if (most > 65536) {
        GTEST_SKIP() << "vertices can be as far apart as they like: " << most;
    }
    const MeshData square = makeFlat(0, 1, 0, 1, 0.5);
    for (const std::uint32_t stride : {most / 4 * 4, most / 4 * 4 + 4}) {
        const Mesh mesh = take(Mesh::upload(context(), queue(), square.view(), {.vertexStride = stride}));
        BatchItem far = item();
        far.mesh = &mesh;
        const Batch batch{std::span(&far, 1), flatView(0, 1, 16, 16), 0.5};
        for (const MethodSupport& method : context().methods()) {
            if (!method.available) {
                continue;
            }
            BlockingDetector one = detector({.method = method.method});
            const Result<BatchAnswer> answer = one.detect(batch);
            ASSERT_EQ(answer.ok(), stride <= most || method.method == CountingMethod::Compute)
                << toString(method.method);
            if (!answer.ok()) {
                EXPECT_EQ(answer.error().code, ErrorCode::LimitExceeded);
                EXPECT_THAT(answer.error().text,
                            HasSubstr("vertexStride " + std::to_string(stride) +
                                      " is beyond the device's maxVertexInputBindingStride, " + std::to_string(most)));
            } else {
                EXPECT_TRUE(take(answer).pairs[0].hit) << toString(method.method);
            }
        }
    }
}

TEST_F(BadInputTest, StagingIsReleasedOnce) {
    Volume volume = upload(makeBytes(unitGrid(4), [](auto...) { return 0.0; }));
    EXPECT_EQ(volume.cmdUpload(VK_NULL_HANDLE).error().code, ErrorCode::NotReady);
}

VkResult VKAPI_PTR lostSubmit(VkQueue, std::uint32_t, const VkSubmitInfo2*, VkFence) {
    return VK_ERROR_DEVICE_LOST;
}

TEST_F(BadInputTest, ALostDeviceStaysLost) {
    Interception loader(gpu().instance.getInstanceProcAddr());
    loader.replace("vkQueueSubmit2", &lostSubmit);
    ContextDesc desc = gpu().device.contextDesc();
    desc.getInstanceProcAddr = Interception::getInstanceProcAddr();
    const Context context = take(Context::create(desc));
    const MeshData square = makeFlat(0, 1, 0, 1, 0.5);
    const Result<Mesh> mesh = Mesh::upload(context, queue(), square.view());
    ASSERT_FALSE(mesh.ok());
    EXPECT_EQ(mesh.error().code, ErrorCode::DeviceLost);
    EXPECT_EQ(mesh.error().vkResult, VK_ERROR_DEVICE_LOST);
    EXPECT_TRUE(context.deviceLost());
    EXPECT_EQ(Mesh::create(context, square.view()).error().code, ErrorCode::DeviceLost);
    EXPECT_EQ(Detector::raster(context, {}).error().code, ErrorCode::DeviceLost);
    EXPECT_FALSE(this->context().deviceLost()) << "another context on the same device is not told";
}

VkResult VKAPI_PTR noMemory(VkDevice, const VkMemoryAllocateInfo*, const VkAllocationCallbacks*, VkDeviceMemory*) {
    return VK_ERROR_OUT_OF_DEVICE_MEMORY;
}

TEST_F(BadInputTest, OutOfMemoryLeavesNothingBehind) {
    Interception loader(gpu().instance.getInstanceProcAddr());
    loader.replace("vkAllocateMemory", &noMemory);
    ContextDesc desc = gpu().device.contextDesc();
    desc.getInstanceProcAddr = Interception::getInstanceProcAddr();
    const Context context = take(Context::create(desc));
    const VolumeData data = makeBytes(unitGrid(4), [](auto...) { return 0.0; });
    const Result<Volume> volume = Volume::create(context, data.view());
    ASSERT_FALSE(volume.ok());
    EXPECT_EQ(volume.error().code, ErrorCode::OutOfMemory);
    EXPECT_THAT(volume.error().text, HasSubstr("bytes for the volume"));
    EXPECT_FALSE(context.deviceLost());
}

TEST_F(BadInputTest, AMissingFunctionIsNamed) {
    Interception loader(gpu().instance.getInstanceProcAddr());
    loader.replace("vkCmdBeginRendering", static_cast<PFN_vkVoidFunction>(nullptr));
    ContextDesc desc = gpu().device.contextDesc();
    desc.getInstanceProcAddr = Interception::getInstanceProcAddr();
    EXPECT_THAT(Context::create(desc).error().text, HasSubstr("vkCmdBeginRendering"));
}

PFN_vkCmdUpdateBuffer realUpdateBuffer = nullptr;

/// Lets every counter start just below 2^32.
void VKAPI_PTR nearlyFull(VkCommandBuffer commandBuffer, VkBuffer buffer, VkDeviceSize offset, VkDeviceSize size,
                          const void* data) {
    PairResult result{};
    if (size == sizeof result) {
        std::memcpy(&result, data, sizeof result);
        result.countLow = UINT32_MAX - 9;
        data = &result;
    }
    realUpdateBuffer(commandBuffer, buffer, offset, size, data);
}

TEST_F(BadInputTest, AnAtomicCounterCarriesBeyond32Bits) {
    Interception loader(gpu().instance.getInstanceProcAddr());
    loader.replace("vkCmdUpdateBuffer", &nearlyFull);
    ContextDesc desc = gpu().device.contextDesc();
    desc.getInstanceProcAddr = Interception::getInstanceProcAddr();
    const Context context = take(Context::create(desc));
    realUpdateBuffer = loader.realDevice<PFN_vkCmdUpdateBuffer>(gpu().device.handle(), "vkCmdUpdateBuffer");
    const Volume volume =
        take(Volume::upload(context, queue(), makeBytes(unitGrid(4), [](auto...) { return 255.0; }).view()));
    const TransferFunction function = take(TransferFunction::upload(context, queue(), {byteRamp(), {0, 255}, 256}));
    const std::uint64_t pixels = std::uint64_t{4096} * 4096;
    for (const Projection projection : {Projection::View, Projection::TwoView}) {
        // One visible square, edge-on from the side, and so many degenerate triangles that 2^32 fragments cannot be
        // ruled out.
        MeshData data = makeFlat(0, 1.0 / 128, 0, 1.0 / 128, 0.5);
        const std::uint64_t views = projection == Projection::TwoView ? 2 : 1;
        data.indices.resize(3 * (std::uint64_t{1} << 32U) / pixels / views, 0);
        const Mesh mesh = take(Mesh::upload(context, queue(), data.view()));
        const BatchItem item{&mesh, &volume, &function, std::span(&pose_, 1)};
        BlockingDetector atomic = take(BlockingDetector::create(
            context, RasterDesc{.method = CountingMethod::Atomic, .projection = projection}, queue()));
        const BatchAnswer answer = take(atomic.detect({std::span(&item, 1), flatView(0, 1, 4096, 4096), 0.5}));
        EXPECT_EQ(answer.pairs[0].count, UINT32_MAX - 9 + std::uint64_t{32} * 32) << toString(projection);
    }
}

} // namespace
} // namespace voxtact::test
