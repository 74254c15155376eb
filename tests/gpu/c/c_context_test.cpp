// SPDX-License-Identifier: MIT
// Contexts of the C interface: errors, lifetimes, the caller's allocator and lock, and what is known of the methods.
#include "c_fixture.h"

#include <gmock/gmock.h>

#include <atomic>
#include <cstdlib>
#include <cstring>
#include <malloc.h>
#include <thread>

namespace voxtact::test {
namespace {

using testing::HasSubstr;

TEST_F(CGpuTest, AContextHasErrorsOfItsOwn) {
    context_ = newContext();
    const Owned<vxt_context> other = newContext();
    const RandomScene scene = halfOpaque();
    const CScene sides(context_.get(), queue_, scene, twoLabels());
    EXPECT_STREQ(vxt_last_error(context_.get()), "");
    std::thread elsewhere([&] {
        vxt_raster_desc desc = sized<vxt_raster_desc>();
        desc.method = VXT_METHOD_CPU;
        vxt_detector* detector = nullptr;
        EXPECT_EQ(vxt_detector_create_raster(context_.get(), &desc, &detector), VXT_ERROR_INVALID_ARGUMENT);
    });
    elsewhere.join();
    EXPECT_THAT(vxt_last_error(context_.get()), HasSubstr("cpu"));
    EXPECT_STREQ(vxt_last_error(other.get()), "");
    // Of an object: its context's, which has ended here.
    vxt_volume* volume = nullptr;
    const vxt_volume_view empty = sized<vxt_volume_view>();
    EXPECT_NE(vxt_volume_create(other.get(), &empty, nullptr, &volume), VXT_OK);
    EXPECT_THAT(vxt_last_error(other.get()), HasSubstr("voxel"));
    EXPECT_THAT(vxt_last_error(context_.get()), HasSubstr("cpu"));
    const vxt_voxel_box outside{{3, 0, 0}, {4, 4, 4}};
    EXPECT_EQ(vxt_volume_cmd_set_box(sides.volume.get(), VK_NULL_HANDLE, &outside, 0), VXT_ERROR_INVALID_ARGUMENT);
    const std::string text = vxt_last_error(context_.get());
    EXPECT_EQ(text, vxt_last_error(nullptr));
    EXPECT_NE(text, "");
}

TEST_F(CGpuTest, ObjectsOutliveTheContextThatMadeThem) {
    context_ = newContext();
    const RandomScene scene = halfOpaque();
    const CScene sides(context_.get(), queue_, scene, twoLabels());
    const COneItem of(sides, scene);
    const Owned<vxt_blocking_detector> detector = newBlocking(sized<vxt_raster_desc>());
    context_.reset();
    EXPECT_EQ(ask(*detector, of).pairs.at(0).count, 128U);
    vxt_batch none = of.batch;
    none.threshold = 2;
    const Owned<vxt_answer> answer = newAnswer();
    EXPECT_EQ(vxt_blocking_detector_detect(detector.get(), &none, answer.get()), VXT_ERROR_INVALID_ARGUMENT);
    EXPECT_THAT(vxt_last_error(nullptr), HasSubstr("threshold"));
}

/// An allocator of the caller's that counts what it gave out and got back.
struct CountingAllocator {
    std::atomic<int> given = 0;
    std::atomic<int> returned = 0;

    static void* VKAPI_CALL allocate(void* user, std::size_t size, std::size_t alignment, VkSystemAllocationScope) {
        ++static_cast<CountingAllocator*>(user)->given;
        return std::aligned_alloc(alignment, (size + alignment - 1) / alignment * alignment);
    }
    static void* VKAPI_CALL reallocate(void* user, void* old, std::size_t size, std::size_t alignment,
                                       VkSystemAllocationScope scope) {
        void* const fresh = allocate(user, size, alignment, scope);
        if (old != nullptr && fresh != nullptr) {
            std::memcpy(fresh, old, std::min(size, malloc_usable_size(old)));
            release(user, old);
        }
        return fresh;
    }
    static void VKAPI_CALL release(void* user, void* memory) {
        static_cast<CountingAllocator*>(user)->returned += memory == nullptr ? 0 : 1;
        std::free(memory);
    }
};

TEST_F(CGpuTest, AllocatesByTheCallersCallbacks) {
    CountingAllocator counting;
    VkAllocationCallbacks callbacks{};
    callbacks.pUserData = &counting;
    callbacks.pfnAllocation = CountingAllocator::allocate;
    callbacks.pfnReallocation = CountingAllocator::reallocate;
    callbacks.pfnFree = CountingAllocator::release;
    const ContextDesc cpp = gpu().device.contextDesc();
    vxt_context_desc desc = cDesc(cpp);
    desc.allocator = &callbacks;
    {
        const auto own = made(vxt_context_destroy, vxt_context_create, &desc);
        const CScene sides(own.get(), queue_, halfOpaque(), twoLabels());
        EXPECT_GT(counting.given, 0);
    }
    EXPECT_EQ(counting.given, counting.returned);
}

TEST_F(CGpuTest, AsksTheCallersAllocatorForDeviceMemory) {
    std::string asked;
    vxt_context_desc desc = cDesc(gpu().device.contextDesc());
    desc.memory = {[](void* user, const vxt_memory_request* request, vxt_device_memory*) {
                       *static_cast<std::string*>(user) = request->name;
                       return VK_ERROR_OUT_OF_DEVICE_MEMORY;
                   },
                   [](void*, const vxt_device_memory*) { FAIL() << "nothing was given"; }, &asked};
    const auto own = made(vxt_context_destroy, vxt_context_create, &desc);
    const auto scene = halfOpaque();
    const vxt_mesh_view mesh = cMesh(scene.mesh);
    vxt_mesh* none = nullptr;
    EXPECT_EQ(vxt_mesh_create(own.get(), &mesh, nullptr, &none), VXT_ERROR_OUT_OF_MEMORY);
    EXPECT_EQ(asked, "mesh");
}

TEST_F(CGpuTest, LocksTheCallersQueue) {
    struct Calls {
        int locked = 0;
        int unlocked = 0;
    } calls;
    queue_.lock = [](void* user) { ++static_cast<Calls*>(user)->locked; };
    queue_.unlock = [](void* user) { ++static_cast<Calls*>(user)->unlocked; };
    queue_.user = &calls;
    const CScene sides(context_.get(), queue_, halfOpaque(), twoLabels());
    EXPECT_EQ(calls.locked, 4); // four uploads
    EXPECT_EQ(calls.unlocked, 4);
}

TEST_F(CGpuTest, TestsAndMeasuresTheMethods) {
    vxt_report_view view = sized<vxt_report_view>();
    const auto known = made(vxt_report_destroy, vxt_context_methods, context_.get());
    need(vxt_report_get(known.get(), &view));
    const std::span<const MethodSupport> methods = context().methods();
    ASSERT_EQ(view.method_count, methods.size());
    EXPECT_EQ(view.missing_count, 0U);
    EXPECT_EQ(view.usable, 1U);
    for (std::size_t i = 0; i < methods.size(); ++i) {
        EXPECT_EQ(view.methods[i].method, static_cast<vxt_method>(methods[i].method));
        EXPECT_EQ(view.methods[i].available != 0, methods[i].available);
        EXPECT_EQ(view.methods[i].text, methods[i].reason);
    }
    const auto tested = made(vxt_report_destroy, vxt_self_test, context_.get(), &queue_);
    need(vxt_report_get(tested.get(), &view));
    const std::vector<SelfTestVerdict> expected = take(selfTest(context(), queue()));
    ASSERT_EQ(view.method_count, expected.size());
    for (std::size_t i = 0; i < expected.size(); ++i) {
        EXPECT_EQ(view.methods[i].text, expected[i].text);
        EXPECT_EQ(view.methods[i].trusted != 0, expected[i].trusted);
        EXPECT_EQ(view.methods[i].available != 0, expected[i].available);
    }
}

} // namespace
} // namespace voxtact::test
