// SPDX-License-Identifier: MIT
// Draws and dispatches of the projections with fragments are as large as ContextDesc::fragmentsAtOnce says, and no
// answer depends on it. Nor does one on how many work groups the device has.
#include "gpu_fixture.h"
#include "interception.h"
#include "support/scenes.h"
#include "voxtact/samples.h"

#include <algorithm>

namespace voxtact::test {
namespace {

/// What the interposed functions saw: triangles in views, of each draw and dispatch. One test at a time.
struct Seen {
    std::vector<std::uint64_t> draws;
    std::vector<std::uint64_t> groups;
    std::uint32_t mostGroups = 0; ///< along x, that the device says it has; 0: as many as it has

    PFN_vkCmdDraw realDraw = nullptr;
    PFN_vkCmdDrawIndexed realDrawIndexed = nullptr;
    PFN_vkCmdDispatch realDispatch = nullptr;
    PFN_vkGetPhysicalDeviceProperties2 realProperties = nullptr;
};
Seen seen;

void VKAPI_PTR draw(VkCommandBuffer commands, std::uint32_t vertices, std::uint32_t instances, std::uint32_t first,
                    std::uint32_t firstInstance) {
    seen.draws.push_back(std::uint64_t{vertices} / 3 * instances);
    seen.realDraw(commands, vertices, instances, first, firstInstance);
}

void VKAPI_PTR drawIndexed(VkCommandBuffer commands, std::uint32_t indices, std::uint32_t instances,
                           std::uint32_t first, std::int32_t offset, std::uint32_t firstInstance) {
    seen.draws.push_back(std::uint64_t{indices} / 3 * instances);
    seen.realDrawIndexed(commands, indices, instances, first, offset, firstInstance);
}

void VKAPI_PTR dispatch(VkCommandBuffer commands, std::uint32_t x, std::uint32_t y, std::uint32_t z) {
    seen.groups.push_back(std::uint64_t{x} * y * z);
    if (seen.mostGroups != 0) {
        EXPECT_LE(x, seen.mostGroups);
    }
    seen.realDispatch(commands, x, y, z);
}

void VKAPI_PTR properties(VkPhysicalDevice device, VkPhysicalDeviceProperties2* out) {
    seen.realProperties(device, out);
    if (seen.mostGroups != 0) {
        out->properties.limits.maxComputeWorkGroupCount[0] = seen.mostGroups;
    }
}

class DrawSizeTest : public GpuTest {
  protected:
    void SetUp() override {
        GpuTest::SetUp();
        if (IsSkipped() || HasFatalFailure()) {
            return;
        }
        seen = {};
        const PFN_vkGetInstanceProcAddr real = gpu().instance.getInstanceProcAddr();
        const ContextDesc desc = gpu().device.contextDesc();
        const auto getDevice = reinterpret_cast<PFN_vkGetDeviceProcAddr>(real(desc.instance, "vkGetDeviceProcAddr"));
        seen.realDraw = reinterpret_cast<PFN_vkCmdDraw>(getDevice(desc.device, "vkCmdDraw"));
        seen.realDrawIndexed = reinterpret_cast<PFN_vkCmdDrawIndexed>(getDevice(desc.device, "vkCmdDrawIndexed"));
        seen.realDispatch = reinterpret_cast<PFN_vkCmdDispatch>(getDevice(desc.device, "vkCmdDispatch"));
        seen.realProperties =
            reinterpret_cast<PFN_vkGetPhysicalDeviceProperties2>(real(desc.instance, "vkGetPhysicalDeviceProperties2"));
        loader_.emplace(real);
        loader_->replace("vkCmdDraw", &draw);
        loader_->replace("vkCmdDrawIndexed", &drawIndexed);
        loader_->replace("vkCmdDispatch", &dispatch);
        loader_->replace("vkGetPhysicalDeviceProperties2", &properties);
    }

    /// A batch of two items, one of a mesh without indices, in a context of the interposed functions.
    BatchAnswer detect(const DetectorDesc& desc, std::uint64_t fragmentsAtOnce) {
        ContextDesc given = gpu().device.contextDesc();
        given.getInstanceProcAddr = Interception::getInstanceProcAddr();
        given.fragmentsAtOnce = fragmentsAtOnce;
        const Context context = take(Context::create(given));
        const VolumeData head = take(makeBuiltinVolume("head:32"));
        const Volume volume = take(Volume::upload(context, queue(), head.view()));
        const TransferFunction function =
            take(TransferFunction::upload(context, queue(), {points_, {0, 255}, kDefaultTableSize}));
        const Mesh scalpel = take(Mesh::upload(context, queue(), take(makeBuiltinMesh("scalpel:300")).view()));
        const Mesh ellipsoid = take(Mesh::upload(context, queue(), take(makeBuiltinMesh("ellipsoid:200")).view()));
        std::mt19937_64 random(7);
        const std::vector<Mat4> poses = randomPoses(head.grid, 5, 0.7, random);
        const BatchItem items[] = {{&scalpel, &volume, &function, poses},
                                   {&ellipsoid, &volume, &function, std::span(poses).first(2)}};
        const View view{framingCamera(head.grid, kSide, kSide), kSide, kSide};
        BlockingDetector blocking = take(BlockingDetector::create(context, desc, queue()));
        seen.draws.clear();
        seen.groups.clear();
        return take(blocking.detect({items, view, kDefaultThreshold}));
    }

    static constexpr std::uint32_t kSide = 64;
    std::array<ControlPoint, 2> points_{ControlPoint{40, 0}, ControlPoint{80, 1}};
    std::optional<Interception> loader_;
};

void expectSame(const BatchAnswer& a, const BatchAnswer& b) {
    ASSERT_EQ(a.pairs.size(), b.pairs.size());
    for (std::size_t i = 0; i < a.pairs.size(); ++i) {
        EXPECT_EQ(a.pairs[i].count, b.pairs[i].count) << "pair " << i;
    }
    ASSERT_EQ(a.triangles.size(), b.triangles.size());
    for (std::size_t i = 0; i < a.triangles.size(); ++i) {
        EXPECT_EQ(a.triangles[i].pair, b.triangles[i].pair);
        EXPECT_EQ(a.triangles[i].triangle, b.triangles[i].triangle);
        EXPECT_EQ(a.triangles[i].count, b.triangles[i].count);
    }
}

TEST_F(DrawSizeTest, NoAnswerDependsOnIt) {
    for (const CountingMethod method :
         {CountingMethod::Query, CountingMethod::Atomic, CountingMethod::Subgroup, CountingMethod::Compute}) {
        for (const Projection projection : {Projection::View, Projection::TwoView, Projection::DominantAxis}) {
            for (const bool triangles : {false, true}) {
                // Pipelines with outputs take seconds on lavapipe.
                if (!context().supports(method) || (triangles && projection != Projection::View)) {
                    continue;
                }
                SCOPED_TRACE(std::string(toString(method)) + " " + toString(projection) +
                             (triangles ? " outputs" : ""));
                const DetectorDesc desc{.method = method,
                                        .projection = projection,
                                        .filter = Filter::Exact,
                                        .outputs = {.triangles = triangles}};
                const std::uint64_t pixels =
                    projection == Projection::DominantAxis ? 32U * 32U : std::uint64_t{kSide} * kSide;
                const BatchAnswer whole = detect(desc, 0);
                const std::size_t fewest = seen.draws.size() + seen.groups.size();
                // Some whole meshes, a part of a mesh, less than a triangle.
                for (const std::uint64_t most : {700U, 130U, 0U}) {
                    expectSame(detect(desc, most * pixels + 1), whole);
                    if (most > 300 && method == CountingMethod::Query) { // a mesh a draw already
                        EXPECT_EQ(seen.draws.size(), fewest);
                    } else {
                        EXPECT_GT(seen.draws.size() + seen.groups.size(), fewest);
                    }
                    if (method == CountingMethod::Compute) {
                        EXPECT_TRUE(seen.draws.empty());
                        // A work group has 64 triangles; the last of a mesh are fewer.
                        const std::uint64_t mostGroups = std::max<std::uint64_t>(most / 64 + 2, 1);
                        EXPECT_LE(std::ranges::max(seen.groups), mostGroups);
                    } else {
                        EXPECT_LE(std::ranges::max(seen.draws), std::max<std::uint64_t>(most, 1));
                    }
                }
            }
        }
    }
}

/// A device of few work groups takes a mesh of any size.
TEST_F(DrawSizeTest, AMeshMayNeedMoreWorkGroupsThanThereAre) {
    if (!context().supports(CountingMethod::Compute)) {
        GTEST_SKIP() << "no compute on this device";
    }
    for (const bool triangles : {false, true}) {
        const DetectorDesc desc{.method = CountingMethod::Compute, .outputs = {.triangles = triangles}};
        seen.mostGroups = 0;
        const BatchAnswer whole = detect(desc, 0);
        seen.mostGroups = 2;
        const BatchAnswer few = detect(desc, 0);
        seen.mostGroups = 0;
        expectSame(few, whole);
    }
}

} // namespace
} // namespace voxtact::test
