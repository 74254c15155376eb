// SPDX-License-Identifier: MIT
// voxtact inside somebody else's renderer: their device, their objects, their command buffer.
#include "gpu_fixture.h"
#include "raw_vulkan.h"
#include "support/scenes.h"

#include <atomic>
#include <cstdlib>
#include <thread>

namespace voxtact::test {
namespace {

class EmbeddingTest : public GpuTest {
  protected:
    /// A device of its own, as an embedder has.
    device::VulkanDevice makeDevice() {
        const auto devices = take(gpu().instance.devices());
        return take(device::VulkanDevice::create(gpu().instance, take(device::chooseDevice(devices, {}))));
    }
};

// Storage is what the compute path needs beside.
constexpr VkBufferUsageFlags kVertexUsage = VK_BUFFER_USAGE_VERTEX_BUFFER_BIT | VK_BUFFER_USAGE_STORAGE_BUFFER_BIT;
constexpr VkBufferUsageFlags kIndexUsage = VK_BUFFER_USAGE_INDEX_BUFFER_BIT | VK_BUFFER_USAGE_STORAGE_BUFFER_BIT;

VolumeData halfOpaque() {
    return makeBytes(unitGrid(8), [](std::uint32_t x, auto...) { return x < 4 ? 255.0 : 0.0; });
}

/// Volume, transfer function and mesh, not yet uploaded.
struct UploadedLater {
    Volume volume;
    TransferFunction function;
    Mesh mesh;
    Mat4 pose = identity();

    explicit UploadedLater(const Context& context)
        : volume(take(Volume::create(context, halfOpaque().view()))),
          function(take(TransferFunction::create(context, {byteRamp(), kBytes}))),
          mesh(take(Mesh::create(context, makeFlat(0, 1, 0, 1, 0.5).view()))) {}
    void cmdUpload(VkCommandBuffer commands) {
        take(volume.cmdUpload(commands));
        take(function.cmdUpload(commands));
        take(mesh.cmdUpload(commands));
    }
    void releaseStaging() {
        volume.releaseStaging();
        function.releaseStaging();
        mesh.releaseStaging();
    }
    [[nodiscard]] BatchItem item() const { return {&mesh, &volume, &function, std::span(&pose, 1)}; }
};

TEST_F(EmbeddingTest, ACommandBufferThatAlreadyHoldsOtherWork) {
    const device::VulkanDevice device = makeDevice();
    const Context context = take(Context::create(device.contextDesc()));
    RawVulkan raw(device);
    for (const MethodSupport& support : context.methods()) {
        const CountingMethod method = support.method;
        UploadedLater scene(context);
        const Detector detector = take(Detector::raster(context, {.method = method}));
        Results results = take(Results::create(detector, {.maxPairs = 2, .readBack = false}));
        const RawVulkan::HostBuffer others =
            raw.makeBuffer(64, VK_BUFFER_USAGE_TRANSFER_DST_BIT | VK_BUFFER_USAGE_TRANSFER_SRC_BIT);
        const RawVulkan::HostBuffer mine = raw.makeBuffer(sizeof(PairResult), VK_BUFFER_USAGE_TRANSFER_DST_BIT);

        const VkCommandBuffer commands = raw.begin();
        raw.vk().vkCmdFillBuffer(commands, others.buffer, 0, 32, 0x11111111);
        scene.cmdUpload(commands);
        const BatchItem item = scene.item();
        take(detector.cmdDetect(commands, {std::span(&item, 1), flatView(0, 1, 64, 64), 0.5}, results));
        // The results are ready for the next command: no barrier of ours.
        const VkBufferCopy region{0, 0, sizeof(PairResult)};
        raw.vk().vkCmdCopyBuffer(commands, results.buffer(), mine.buffer, 1, &region);
        raw.vk().vkCmdFillBuffer(commands, others.buffer, 32, 32, 0x22222222);
        raw.submitAndWait(commands);

        const PairAnswer answer = unpack(*static_cast<const PairResult*>(mine.mapped));
        EXPECT_TRUE(answer.hit);
        EXPECT_EQ(answer.count, method == CountingMethod::QueryAny ? 1U : 64U * 32U) << toString(method);
        EXPECT_EQ(static_cast<const std::uint32_t*>(others.mapped)[7], 0x11111111U);
        EXPECT_EQ(static_cast<const std::uint32_t*>(others.mapped)[8], 0x22222222U);
        EXPECT_EQ(results.cmdReadBack(commands).error().code, ErrorCode::InvalidArgument);
    }
}

TEST_F(EmbeddingTest, OneCommandBufferSubmittedTwice) {
    const device::VulkanDevice device = makeDevice();
    const Context context = take(Context::create(device.contextDesc()));
    RawVulkan raw(device);
    UploadedLater scene(context);
    const VkCommandBuffer uploads = raw.begin();
    scene.cmdUpload(uploads);
    raw.submitAndWait(uploads);
    scene.releaseStaging();
    const Detector detector = take(Detector::raster(context, {.method = CountingMethod::Atomic}));
    Results results = take(Results::create(detector, {.maxPairs = 1}));
    const BatchItem item = scene.item();
    const VkCommandBuffer commands = raw.begin();
    take(detector.cmdDetect(commands, {std::span(&item, 1), flatView(0, 1, 64, 64), 0.5}, results));
    take(results.cmdReadBack(commands));
    raw.submitAndWait(commands);
    raw.submitAndWait(commands, false);
    EXPECT_EQ(unpack(take(results.read())[0]).count, 64U * 32U);
}

TEST_F(EmbeddingTest, WrappedObjectsOfTheCaller) {
    const device::VulkanDevice device = makeDevice();
    const Context context = take(Context::create(device.contextDesc()));
    RawVulkan raw(device);

    const VolumeData bytes = halfOpaque();
    WrappedVolume wrappedVolume;
    wrappedVolume.view =
        raw.makeImage(VK_IMAGE_TYPE_3D, VK_FORMAT_R8_UNORM, {8, 8, 8}, bytes.voxels, VK_IMAGE_LAYOUT_GENERAL);
    wrappedVolume.format = VK_FORMAT_R8_UNORM;
    wrappedVolume.layout = VK_IMAGE_LAYOUT_GENERAL;
    wrappedVolume.grid = bytes.grid;
    wrappedVolume.slope = 10; // rescaled units: 0..2550, less 1000
    wrappedVolume.intercept = -1000;
    const Volume volume = take(Volume::wrap(context, wrappedVolume));

    const std::vector<float> table = take(sampleTable({byteRamp(), kBytes, 64}));
    WrappedTransferFunction wrappedTable;
    wrappedTable.view = raw.makeImage(VK_IMAGE_TYPE_1D, VK_FORMAT_R32_SFLOAT, {64, 1, 1},
                                      std::as_bytes(std::span(table)), VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL);
    wrappedTable.domain = {-1000, 1550};
    const TransferFunction function = take(TransferFunction::wrap(context, wrappedTable));

    // Two floats before the first position, three floats of something else after each; 16-bit indices after one.
    constexpr float kInterleaved[] = {9, 9, 0, 0,    0.5F, 7, 7, 7, 1, 0,    0.5F, 7, 7,
                                      7, 1, 1, 0.5F, 7,    7, 7, 0, 1, 0.5F, 7,    7, 7};
    constexpr std::uint16_t kIndices[] = {99, 0, 1, 2, 0, 2, 3, 99};
    WrappedMesh wrappedMesh;
    wrappedMesh.vertices = raw.makeBuffer(std::span<const float>(kInterleaved), kVertexUsage).buffer;
    wrappedMesh.vertexOffset = 8;
    wrappedMesh.vertexStride = 24;
    wrappedMesh.vertexCount = 4;
    wrappedMesh.indices = raw.makeBuffer(std::span<const std::uint16_t>(kIndices), kIndexUsage).buffer;
    wrappedMesh.indexOffset = 2;
    wrappedMesh.indexType = VK_INDEX_TYPE_UINT16;
    wrappedMesh.triangleCount = 2;
    wrappedMesh.storage = true;
    const Mesh indexed = take(Mesh::wrap(context, wrappedMesh));

    constexpr float kLoose[] = {0, 0, 0.5F, 1, 0, 0.5F, 1, 1, 0.5F, 0, 0, 0.5F, 1, 1, 0.5F, 0, 1, 0.5F};
    WrappedMesh wrappedLoose;
    wrappedLoose.vertices = raw.makeBuffer(std::span<const float>(kLoose), kVertexUsage).buffer;
    wrappedLoose.vertexCount = 6;
    wrappedLoose.triangleCount = 2;
    wrappedLoose.storage = true;
    const Mesh loose = take(Mesh::wrap(context, wrappedLoose));

    const Mat4 pose = identity();
    const BatchItem items[] = {{&indexed, &volume, &function, std::span(&pose, 1)},
                               {&loose, &volume, &function, std::span(&pose, 1)}};
    for (const CountingMethod method : {CountingMethod::Query, CountingMethod::Atomic, CountingMethod::Compute}) {
        BlockingDetector detector =
            take(BlockingDetector::create(context, RasterDesc{.method = method}, device.queueAccess()));
        const BatchAnswer answer = take(detector.detect({items, flatView(0, 1, 64, 64), 0.5}));
        EXPECT_EQ(answer.pairs[0].count, 64U * 32U);
        EXPECT_EQ(answer.pairs[1].count, 64U * 32U);
        // Nothing is known of a wrapped volume's boundary, so nothing is proven.
        EXPECT_EQ(detector.detector().boundaryFor(items[0], 0.5), Boundary::Range);
        // Without a camera: 8 x 4 voxels. The rasteriser reads the buffers as compute does.
        BlockingDetector dominant = take(BlockingDetector::create(
            context, RasterDesc{.method = method, .projection = Projection::DominantAxis}, device.queueAccess()));
        const BatchAnswer voxels = take(dominant.detect({items, {}, 0.5}));
        EXPECT_EQ(voxels.pairs[0].count, 8U * 4U);
        EXPECT_EQ(voxels.pairs[1].count, 8U * 4U);
    }
    wrappedVolume.boundaryValues = ValueRange{-1000, -900};
    const Volume vouched = take(Volume::wrap(context, wrappedVolume));
    wrappedTable.table = table;
    const TransferFunction known = take(TransferFunction::wrap(context, wrappedTable));
    const Detector detector = take(Detector::raster(context, {}));
    EXPECT_EQ(detector.boundaryFor({&indexed, &vouched, &known, {}}, 0.5), Boundary::Clamp);

    // Entries that are the threshold in single precision reach it, certainly.
    const std::vector<float> level(64, 0.7F);
    wrappedTable.view = raw.makeImage(VK_IMAGE_TYPE_1D, VK_FORMAT_R32_SFLOAT, {64, 1, 1},
                                      std::as_bytes(std::span(level)), VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL);
    wrappedTable.table = level;
    const TransferFunction flat = take(TransferFunction::wrap(context, wrappedTable));
    const Volume own = take(Volume::upload(context, device.queueAccess(), bytes.view(), {.bricks = true}));
    const BatchItem item{&indexed, &own, &flat, std::span(&pose, 1)};
    BlockingDetector certified = take(BlockingDetector::create(context, CertifiedDesc{}, device.queueAccess()));
    EXPECT_TRUE(take(certified.detect({{&item, 1}, {}, 0.7})).pairs.at(0).hit);
}

TEST_F(EmbeddingTest, FramesInFlightAreReadWithoutAStall) {
    constexpr std::uint32_t kFrames = 3;
    constexpr std::uint64_t kTotal = 12;
    const device::VulkanDevice device = makeDevice();
    const Context context = take(Context::create(device.contextDesc()));
    RawVulkan raw(device);
    UploadedLater scene(context);
    const VkCommandBuffer uploads = raw.begin();
    scene.cmdUpload(uploads);
    raw.submitAndWait(uploads);
    const Detector detector = take(Detector::raster(context, {.method = CountingMethod::Query}));
    ResultRing ring = take(ResultRing::create(
        detector, kFrames,
        {.maxPairs = 16, .timestamps = device.hasTimestamps(), .queueFamily = device.queueAccess().family}));
    // Frame n moves the square n/64 along x: n columns of the opaque half are left behind.
    const auto posesOf = [](std::uint64_t frame) {
        return std::vector<Mat4>(frame + 1, translation({static_cast<double>(frame) / 64, 0, 0}));
    };
    const auto check = [&](std::uint64_t frame) {
        const auto results = take(ring.read(frame));
        ASSERT_EQ(results.size(), frame + 1);
        for (const PairResult& result : results) {
            EXPECT_EQ(unpack(result).count, (32 - frame) * 64) << "frame " << frame;
        }
    };
    VkFence fences[kTotal] = {};
    for (std::uint64_t frame = 0; frame < kTotal; ++frame) {
        if (frame >= kFrames) {
            raw.wait(fences[frame - kFrames]);
            check(frame - kFrames);
        }
        Results& results = *take(ring.begin(frame));
        const std::vector<Mat4> poses = posesOf(frame);
        BatchItem item = scene.item();
        item.world_from_object = poses;
        const VkCommandBuffer commands = raw.begin();
        take(detector.cmdDetect(commands, {std::span(&item, 1), flatView(0, 1, 64, 64), 0.5}, results));
        take(results.cmdReadBack(commands));
        fences[frame] = raw.makeFence();
        raw.submit(commands, fences[frame]);
    }
    for (std::uint64_t frame = kTotal - kFrames; frame < kTotal; ++frame) {
        raw.wait(fences[frame]);
        check(frame);
        if (device.hasTimestamps()) {
            EXPECT_GE(take(take(ring.begin(frame))->gpuMilliseconds()), 0.0);
        }
    }
}

TEST_F(EmbeddingTest, TwoContextsInOneProcess) {
    // Two instances, two devices, used in turn.
    const device::VulkanInstance instance = take(device::VulkanInstance::create({.validate = true}));
    const auto devices = take(instance.devices());
    const device::VulkanDevice other =
        take(device::VulkanDevice::create(instance, take(device::chooseDevice(devices, {}))));
    const Context otherContext = take(Context::create(other.contextDesc()));
    const Context* contexts[] = {&context(), &otherContext};
    const QueueAccess queues[] = {queue(), other.queueAccess()};
    std::vector<Volume> volumes;
    std::vector<TransferFunction> functions;
    std::vector<Mesh> meshes;
    std::vector<BlockingDetector> detectors;
    for (std::size_t i = 0; i < 2; ++i) {
        volumes.push_back(take(Volume::upload(*contexts[i], queues[i], halfOpaque().view())));
        functions.push_back(take(TransferFunction::upload(*contexts[i], queues[i], {byteRamp(), kBytes})));
        meshes.push_back(take(Mesh::upload(*contexts[i], queues[i], makeFlat(0, 1, 0, 1, 0.5).view())));
        detectors.push_back(
            take(BlockingDetector::create(*contexts[i], RasterDesc{.method = CountingMethod::Atomic}, queues[i])));
    }
    const Mat4 pose = identity();
    for (int turn = 0; turn < 3; ++turn) {
        for (std::size_t i = 0; i < 2; ++i) {
            const BatchItem item{&meshes[i], &volumes[i], &functions[i], std::span(&pose, 1)};
            const BatchAnswer answer = take(detectors[i].detect({std::span(&item, 1), flatView(0, 1, 64, 64), 0.5}));
            EXPECT_EQ(answer.pairs[0].count, 64U * 32U);
        }
    }
    // Objects of one context are refused by the other.
    const BatchItem mixed{&meshes[0], &volumes[1], &functions[0], std::span(&pose, 1)};
    const Result<BatchAnswer> refused = detectors[0].detect({std::span(&mixed, 1), flatView(0, 1, 64, 64), 0.5});
    ASSERT_FALSE(refused.ok());
    EXPECT_NE(refused.error().text.find("another Context"), std::string::npos);
    for (const std::string& message : instance.messages()->all()) {
        ADD_FAILURE() << "validation: " << message;
    }
}

TEST_F(EmbeddingTest, ThreadsShareAContextAndAQueue) {
    // Four threads make objects, record and submit at once; the queue is shared under the caller's lock.
    struct Lock {
        std::mutex mutex;
        int locked = 0;
    } lock;
    QueueAccess shared = queue();
    shared.user = &lock;
    shared.lock = [](void* user) {
        static_cast<Lock*>(user)->mutex.lock();
        ++static_cast<Lock*>(user)->locked;
    };
    shared.unlock = [](void* user) { static_cast<Lock*>(user)->mutex.unlock(); };
    std::atomic<int> right{0};
    std::vector<std::thread> threads;
    for (int i = 0; i < 4; ++i) {
        threads.emplace_back([&] {
            const Volume volume = take(Volume::upload(context(), shared, halfOpaque().view()));
            const TransferFunction function = take(TransferFunction::upload(context(), shared, {byteRamp(), kBytes}));
            const Mesh mesh = take(Mesh::upload(context(), shared, makeFlat(0, 1, 0, 1, 0.5).view()));
            BlockingDetector one = take(BlockingDetector::create(context(), RasterDesc{}, shared));
            const Mat4 pose = identity();
            const BatchItem item{&mesh, &volume, &function, std::span(&pose, 1)};
            for (int turn = 0; turn < 5; ++turn) {
                const BatchAnswer answer = take(one.detect({std::span(&item, 1), flatView(0, 1, 64, 64), 0.5}));
                right += answer.pairs[0].count == 64U * 32U ? 1 : 0;
            }
        });
    }
    for (std::thread& thread : threads) {
        thread.join();
    }
    EXPECT_EQ(right, 4 * 5);
    EXPECT_EQ(lock.locked, 4 * (3 + 5));
}

struct Allocations {
    std::atomic<int> made{0};
    std::atomic<int> freed{0};
};

void* VKAPI_PTR countedAllocate(void* user, std::size_t size, std::size_t alignment, VkSystemAllocationScope) {
    ++static_cast<Allocations*>(user)->made;
    return std::aligned_alloc(alignment, (size + alignment - 1) / alignment * alignment);
}
void* VKAPI_PTR countedReallocate(void*, void*, std::size_t, std::size_t, VkSystemAllocationScope) {
    return nullptr;
}
void VKAPI_PTR countedFree(void* user, void* memory) {
    static_cast<Allocations*>(user)->freed += memory != nullptr ? 1 : 0;
    std::free(memory);
}

TEST_F(EmbeddingTest, TheCallersAllocatorAndLogAreUsed) {
    Allocations allocations;
    VkAllocationCallbacks callbacks{};
    callbacks.pUserData = &allocations;
    callbacks.pfnAllocation = &countedAllocate;
    callbacks.pfnReallocation = &countedReallocate;
    callbacks.pfnFree = &countedFree;
    std::vector<std::string> lines;
    {
        const device::VulkanDevice device = makeDevice();
        ContextDesc desc = device.contextDesc();
        desc.allocator = &callbacks;
        desc.logUser = &lines;
        desc.log = [](void* user, const char* text) { static_cast<std::vector<std::string>*>(user)->push_back(text); };
        const Context context = take(Context::create(desc));
        EXPECT_GT(allocations.made, 0);
        for (const SelfTestVerdict& verdict : take(selfTest(context, device.queueAccess()))) {
            EXPECT_TRUE(verdict.trusted) << verdict.text;
        }
        MeshData mesh = makeFlat(0, 1, 0, 1, 0.5);
        mesh.indices.insert(mesh.indices.end(), {0, 0, 0});
        take(Mesh::create(context, mesh.view()));
    }
    EXPECT_EQ(allocations.made, allocations.freed);
    ASSERT_EQ(lines.size(), 1U);
    EXPECT_NE(lines[0].find("1 degenerate"), std::string::npos);
}

} // namespace
} // namespace voxtact::test
