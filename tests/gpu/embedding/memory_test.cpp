// SPDX-License-Identifier: MIT
// Device memory: the pool of a context, and the caller's own allocator.
#include "interception.h"
#include "raw_fixture.h"
#include "support/scenes.h"
#include "voxtact/render.h"

#include <gmock/gmock.h>

#include <atomic>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <set>
#include <thread>

namespace voxtact::test {
namespace {

using testing::AllOf;
using testing::HasSubstr;

/// What a context asks the driver for. One at a time.
struct Counted {
    PFN_vkAllocateMemory allocate = nullptr;
    PFN_vkFreeMemory free = nullptr;
    std::mutex mutex;
    VkDeviceSize limit = VK_WHOLE_SIZE; ///< larger allocations fail
    std::uint32_t calls = 0;
    std::uint32_t dedicated = 0;
    std::map<VkDeviceMemory, VkDeviceSize> alive;
};
Counted* counted = nullptr;

VkResult VKAPI_PTR allocateAndCount(VkDevice device, const VkMemoryAllocateInfo* info,
                                    const VkAllocationCallbacks* callbacks, VkDeviceMemory* out) {
    const std::lock_guard lock(counted->mutex);
    ++counted->calls;
    if (info->allocationSize > counted->limit) {
        return VK_ERROR_OUT_OF_DEVICE_MEMORY;
    }
    const VkResult result = counted->allocate(device, info, callbacks, out);
    if (result == VK_SUCCESS) {
        counted->alive[*out] = info->allocationSize;
        counted->dedicated += info->pNext != nullptr ? 1 : 0;
    }
    return result;
}

void VKAPI_PTR freeAndCount(VkDevice device, VkDeviceMemory memory, const VkAllocationCallbacks* callbacks) {
    const std::lock_guard lock(counted->mutex);
    counted->alive.erase(memory);
    counted->free(device, memory, callbacks);
}

/// An allocator of the caller's that gives each buffer or image an allocation of its own, some bytes after its
/// beginning.
class OwnAllocator {
  public:
    explicit OwnAllocator(const device::VulkanDevice& device) : device_(device) {}
    OwnAllocator(const OwnAllocator&) = delete;
    OwnAllocator& operator=(const OwnAllocator&) = delete;
    ~OwnAllocator() { EXPECT_TRUE(alive.empty()) << alive.size() << " pieces of memory were not given back"; }

    [[nodiscard]] MemoryCallbacks callbacks() { return {&allocate, &release, this}; }

    std::set<const void*> alive; ///< handles
    std::vector<MemoryRequest> requests;
    std::set<std::string> names;
    VkResult result = VK_SUCCESS;             ///< of the next calls
    std::function<void(DeviceMemory&)> spoil; ///< changes what is given

  private:
    static VkResult allocate(void* user, const MemoryRequest* request, DeviceMemory* out) {
        auto& self = *static_cast<OwnAllocator*>(user);
        const std::lock_guard lock(self.mutex_);
        self.requests.push_back(*request);
        self.names.insert(request->name);
        return self.result == VK_SUCCESS ? self.give(*request, *out) : self.result;
    }
    static void release(void* user, const DeviceMemory* memory) {
        auto& self = *static_cast<OwnAllocator*>(user);
        const std::lock_guard lock(self.mutex_);
        const std::unique_ptr<VkDeviceMemory> taken(static_cast<VkDeviceMemory*>(memory->handle));
        EXPECT_EQ(self.alive.erase(taken.get()), 1U) << "given back that was not taken";
        self.device_.table().vkFreeMemory(self.device_.handle(), *taken, nullptr);
    }
    VkResult give(const MemoryRequest& request, DeviceMemory& out) {
        const VkDeviceSize before = request.requirements.alignment;
        VkMemoryAllocateInfo info{};
        info.sType = VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_INFO;
        info.allocationSize = before + request.requirements.size;
        info.memoryTypeIndex = typeFor(request);
        auto taken = std::make_unique<VkDeviceMemory>();
        const VolkDeviceTable& vk = device_.table();
        EXPECT_EQ(vk.vkAllocateMemory(device_.handle(), &info, nullptr, taken.get()), VK_SUCCESS);
        out.memory = *taken;
        out.offset = before;
        if ((request.required & VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT) != 0) {
            EXPECT_EQ(vk.vkMapMemory(device_.handle(), *taken, before, VK_WHOLE_SIZE, 0, &out.mapped), VK_SUCCESS);
        }
        if (spoil) {
            spoil(out);
        }
        out.handle = taken.get();
        alive.insert(taken.release());
        return VK_SUCCESS;
    }
    [[nodiscard]] std::uint32_t typeFor(const MemoryRequest& request) const {
        VkPhysicalDeviceMemoryProperties properties{};
        vkGetPhysicalDeviceMemoryProperties(device_.physical().handle, &properties);
        std::uint32_t type = 0;
        while ((request.requirements.memoryTypeBits & (1U << type)) == 0 ||
               (properties.memoryTypes[type].propertyFlags & request.required) != request.required) {
            ++type;
        }
        return type;
    }

    const device::VulkanDevice& device_;
    std::mutex mutex_;
};

class MemoryTest : public RawGpuTest {
  protected:
    void SetUp() override {
        RawGpuTest::SetUp();
        if (IsSkipped() || HasFatalFailure()) {
            return;
        }
        loader_.emplace(gpu().instance.getInstanceProcAddr());
        loader_->replace("vkAllocateMemory", &allocateAndCount);
        loader_->replace("vkFreeMemory", &freeAndCount);
        counted = &counted_;
        counted_.allocate = gpu().device.table().vkAllocateMemory;
        counted_.free = gpu().device.table().vkFreeMemory;
    }
    void TearDown() override {
        EXPECT_TRUE(counted_.alive.empty());
        RawGpuTest::TearDown();
    }

    [[nodiscard]] Context newContext(const MemoryCallbacks& memory = {}) const {
        ContextDesc desc = gpu().device.contextDesc();
        desc.getInstanceProcAddr = Interception::getInstanceProcAddr();
        desc.memory = memory;
        return take(Context::create(desc));
    }
    [[nodiscard]] VkDeviceSize bytes() {
        VkDeviceSize sum = 0;
        for (const auto& [memory, size] : counted_.alive) {
            sum += size;
        }
        return sum;
    }
    /// 16 x 16 squares of a plate, one pair each: so many of them are opaque.
    [[nodiscard]] std::uint64_t count(const Context& context, std::span<const Mesh> meshes) const {
        const Volume volume =
            take(Volume::upload(context, queue(), makeBytes(unitGrid(4), [](auto...) { return 255.0; }).view()));
        const TransferFunction function = take(TransferFunction::upload(context, queue(), {byteRamp(), {0, 255}}));
        BlockingDetector detector = take(BlockingDetector::create(context, RasterDesc{}, queue()));
        std::vector<BatchItem> items;
        for (const Mesh& mesh : meshes) {
            items.push_back({&mesh, &volume, &function, std::span(&pose_, 1)});
        }
        std::uint64_t fragments = 0;
        for (const PairAnswer& pair : take(detector.detect({items, flatView(0, 1, 16, 16), 0.5})).pairs) {
            fragments += pair.count;
        }
        return fragments;
    }

    const Mat4 pose_ = identity();
    Counted counted_;

  private:
    std::optional<Interception> loader_;
};

TEST_F(MemoryTest, AThousandMeshesTakeAFewAllocations) {
    constexpr std::size_t kMeshes = 1000;
    std::optional<Context> context = newContext();
    const MeshData cube = makeCube(0.2, 0.8);
    std::vector<Mesh> meshes;
    for (std::size_t i = 0; i < kMeshes; ++i) {
        meshes.push_back(take(Mesh::upload(*context, queue(), cube.view(), {.clusters = true})));
    }
    EXPECT_LE(counted_.calls, 4U);
    const std::size_t blocks = counted_.alive.size();
    const std::uint32_t before = counted_.calls;

    // Each second one ends, and others come in its place.
    for (std::size_t i = 0; i < kMeshes; i += 2) {
        meshes[i] = take(Mesh::upload(*context, queue(), makeFlat(0, 1, 0, 1, 0.5).view(), {.clusters = true}));
    }
    EXPECT_EQ(counted_.alive.size(), blocks);
    EXPECT_EQ(counted_.calls, before);
    EXPECT_EQ(count(*context, {meshes.data(), 1}), 256U);
    EXPECT_EQ(count(*context, meshes), kMeshes / 2 * (256 + count(*context, {&meshes[1], 1})));

    meshes.clear();
    EXPECT_LE(bytes(), VkDeviceSize{3} << 20U) << "a small block of buffers, mapped ones and images stays";
    context.reset();
    EXPECT_TRUE(counted_.alive.empty());
}

TEST_F(MemoryTest, OneSmallObjectAfterAnotherAllocatesOnce) {
    const Context context = newContext();
    const VolumeData data = makeBytes(unitGrid(8), [](auto...) { return 1.0; });
    for (int i = 0; i < 50; ++i) {
        const Volume volume = take(Volume::upload(context, queue(), data.view()));
        EXPECT_LE(counted_.calls, 3U) << "for images, staging, and the buffer in the place of bricks";
    }
}

TEST_F(MemoryTest, ALargeObjectHasAnAllocationThatEndsWithIt) {
    const Context context = newContext();
    const Volume small =
        take(Volume::upload(context, queue(), makeBytes(unitGrid(4), [](auto...) { return 1.0; }).view()));
    const std::size_t before = counted_.alive.size();
    {
        Volume volume = take(Volume::create(context, makeBytes(unitGrid(260), [](auto...) { return 1.0; }).view()));
        EXPECT_EQ(counted_.alive.size(), before + 2);
        EXPECT_GE(counted_.dedicated, 1U);
        volume.releaseStaging();
        EXPECT_EQ(counted_.alive.size(), before + 1);
    }
    EXPECT_EQ(counted_.alive.size(), before);
}

TEST_F(MemoryTest, WhereABlockHasNoRoomLessIsAskedFor) {
    counted_.limit = 256 << 10U;
    const Context context = newContext();
    const Mesh mesh = take(Mesh::upload(context, queue(), makeFlat(0, 1, 0, 1, 0.5).view()));
    EXPECT_EQ(count(context, {&mesh, 1}), 256U);
    const std::size_t blocks = counted_.alive.size();
    const Result<Volume> large = Volume::create(context, makeBytes(unitGrid(128), [](auto...) { return 1.0; }).view());
    ASSERT_FALSE(large.ok());
    EXPECT_EQ(large.error().code, ErrorCode::OutOfMemory);
    EXPECT_THAT(large.error().text, HasSubstr("bytes for the volume"));
    EXPECT_EQ(counted_.alive.size(), blocks);
}

TEST_F(MemoryTest, ThreadsShareThePool) {
    const Context context = newContext();
    const MeshData cube = makeCube(0.2, 0.8);
    std::atomic<std::uint32_t> failed{0};
    std::vector<std::thread> threads;
    for (int thread = 0; thread < 4; ++thread) {
        threads.emplace_back([&] {
            std::vector<Mesh> meshes;
            for (int i = 0; i < 200; ++i) {
                Result<Mesh> mesh = Mesh::create(context, cube.view());
                failed += mesh.ok() ? 0 : 1;
                if (mesh.ok()) {
                    meshes.push_back(std::move(*mesh));
                }
                if (meshes.size() > 10) {
                    meshes.erase(meshes.begin(), meshes.begin() + 5);
                }
            }
        });
    }
    for (std::thread& thread : threads) {
        thread.join();
    }
    EXPECT_EQ(failed, 0U);
}

TEST_F(MemoryTest, TheCallersAllocatorServesEverything) {
    OwnAllocator own(gpu().device);
    std::optional<Context> context = newContext(own.callbacks());
    {
        const VolumeData voxels = makeBytes(unitGrid(4), [](auto...) { return 255.0; });
        const Volume volume =
            take(Volume::upload(*context, queue(), voxels.view(), {.bricks = true, .editable = true}));
        const TransferFunction function = take(TransferFunction::upload(*context, queue(), {byteRamp(), {0, 255}}));
        const Mesh mesh = take(Mesh::upload(*context, queue(), makeFlat(0, 1, 0, 1, 0.5).view(), {.clusters = true}));
        const LabelMap labels = take(LabelMap::upload(*context, queue(), take(makeLabels(voxels.view()))));
        BlockingDetector blocking = take(BlockingDetector::create(
            *context, RasterDesc{.outputs = {.triangles = true, .contacts = true, .bounds = true, .labels = true}},
            queue()));
        const ResultRing ring =
            take(ResultRing::create(blocking.detector(), 2, {.room = {.triangles = 2, .labels = 9}, .staged = true}));
        BlockingRenderer renderer = take(BlockingRenderer::create(*context, queue()));
        const RenderTransferFunction colours = take(RenderTransferFunction::upload(
            renderer.renderer(), queue(), {.opacity = {byteRamp(), {0, 255}, 16}, .step = 0.1}));
        context.reset(); // objects release their memory without it
        const BatchItem item{&mesh, &volume, &function, std::span(&pose_, 1), &labels};
        EXPECT_EQ(take(blocking.detect({std::span(&item, 1), flatView(0, 1, 16, 16), 0.5})).contacts.size(), 256U);
        Scene scene;
        scene.volume = &volume;
        scene.transferFunction = &colours;
        scene.mesh = &mesh;
        scene.clip_from_world = flatView(0, 1, 8, 8).clip_from_world;
        EXPECT_EQ(take(renderer.render(scene, {8, 8})).rgba.size(), 256U);
        EXPECT_GT(own.alive.size(), 10U);
    }
    EXPECT_TRUE(own.alive.empty());
    EXPECT_EQ(counted_.calls, 0U) << "voxtact allocates nothing itself";
    EXPECT_THAT(own.names, testing::IsSupersetOf({"volume", "volume staging", "mesh", "label map", "outputs"}));
    for (const MemoryRequest& request : own.requests) {
        EXPECT_NE(request.buffer == VK_NULL_HANDLE, request.image == VK_NULL_HANDLE);
    }
}

TEST_F(MemoryTest, WhatTheCallersAllocatorRefusesIsAnError) {
    OwnAllocator own(gpu().device);
    const Context context = newContext(own.callbacks());
    const MeshData square = makeFlat(0, 1, 0, 1, 0.5);
    const auto error = [&] { return Mesh::create(context, square.view()).error(); };

    own.result = VK_ERROR_OUT_OF_DEVICE_MEMORY;
    EXPECT_EQ(error().code, ErrorCode::OutOfMemory);
    EXPECT_THAT(error().text, HasSubstr("bytes for mesh"));
    own.result = VK_ERROR_TOO_MANY_OBJECTS;
    EXPECT_EQ(error().vkResult, VK_ERROR_TOO_MANY_OBJECTS);
    own.result = VK_SUCCESS;
    own.spoil = [](DeviceMemory& memory) { memory.memory = VK_NULL_HANDLE; };
    EXPECT_THAT(error().text, AllOf(HasSubstr("allocate gave no VkDeviceMemory"), HasSubstr("mesh")));
    own.spoil = [](DeviceMemory& memory) { memory.offset += 1; };
    EXPECT_THAT(error().text, HasSubstr("not aligned"));
    own.spoil = [](DeviceMemory& memory) { memory.mapped = nullptr; };
    EXPECT_THAT(error().text, HasSubstr("no host address for mesh staging"));
    EXPECT_TRUE(own.alive.empty()) << "what was refused is given back";
    own.spoil = nullptr;
    EXPECT_TRUE(Mesh::upload(context, queue(), square.view()).ok());
}

TEST_F(MemoryTest, OneFunctionAloneIsRefused) {
    for (const MemoryCallbacks half : {MemoryCallbacks{[](auto...) { return VK_SUCCESS; }, nullptr, nullptr},
                                       MemoryCallbacks{nullptr, [](auto...) {}, nullptr}}) {
        ContextDesc desc = gpu().device.contextDesc();
        desc.memory = half;
        EXPECT_EQ(Context::create(desc).error().code, ErrorCode::InvalidArgument);
    }
}

} // namespace
} // namespace voxtact::test
