// SPDX-License-Identifier: MIT
// Draws and dispatches of the projections with fragments are as large as ContextDesc::fragmentsAtOnce says, and no
// answer depends on it. Nor does one on how many work groups the device has.
#include "core/geometry/pair_transform.h"
#include "device/count/pixel_slices.h"
#include "device/scene/scene_impl.h"
#include "exact/exact.h"
#include "gpu_fixture.h"
#include "interception.h"
#include "support/host_meters.h"
#include "support/scenes.h"
#include "voxtact/cpu.h"
#include "voxtact/samples.h"

#include <algorithm>
#include <iostream>

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
    BatchAnswer detect(const AnyDesc& desc, std::uint64_t fragmentsAtOnce) {
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
                const AnyDesc desc{.method = method,
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

/// A work group of huge triangles by `compute`: more pixels than llvmpipe lets one invocation do (docs/facts.md).
TEST_F(DrawSizeTest, TrianglesAsLargeAsTheViewportAreCountedWhole) {
    const std::uint64_t seed = testSeed();
    std::mt19937_64 random(seed);
    const VolumeData ball = take(makeBuiltinVolume("sphere:64"));
    MeshData data;
    for (std::uint32_t corner = 0; corner < 3 * 64; ++corner) {
        const double turn = 2.0943951 * (corner % 3) + uniform(random, -0.2, 0.2);
        for (const double place : {120 * std::cos(turn), 120 * std::sin(turn), uniform(random, -15, 15)}) {
            data.positions.push_back(static_cast<float>(place));
        }
        data.indices.push_back(corner);
    }
    const TransferFunctionDesc table{points_, {0, 255}, kDefaultTableSize};
    const Mesh mesh = upload(data);
    const Volume volume = upload(ball);
    const TransferFunction function = upload(points_, {0, 255});
    const cpu::Volume hostVolume = take(cpu::Volume::create(ball.view()));
    const cpu::TransferFunction hostFunction = take(cpu::TransferFunction::create(table));
    const cpu::Mesh hostMesh = take(cpu::Mesh::create(data.view()));
    // The same triangles in the caller's own buffers: nothing is known of them.
    WrappedMesh buffers;
    buffers.vertices = buffers.indices = mesh.impl().vertices;
    buffers.vertexCount = 3 * 64;
    buffers.indexOffset = mesh.impl().indexOffset;
    buffers.triangleCount = 64;
    buffers.storage = true;
    const Mesh wrapped = take(Mesh::wrap(context(), buffers));
    // From 60 mm above: some triangles are behind the eye in the second pose.
    const Mat4 perspective =
        multiply({2, 0, 0, 0, 0, 2, 0, 0, 0, 0, -1.001, -1, 0, 0, -1, 0}, translation({0, 0, -60}));
    const Mat4 framing = framingCamera(ball.grid, 700, 700);
    struct Look {
        const Mesh& mesh;
        Projection projection;
        std::uint32_t samples;
        const Mat4& clip_from_world;
    };
    const std::array poses{identity(), translation({0, 0, 50})};
    for (const Look& look :
         {Look{mesh, Projection::View, 1, framing}, Look{mesh, Projection::View, 1, perspective},
          Look{wrapped, Projection::View, 1, perspective}, Look{mesh, Projection::DominantAxis, 8, framing}}) {
        const BatchItem item{&look.mesh, &volume, &function, poses};
        const cpu::BatchItem hostItem{&hostMesh, &hostVolume, &hostFunction, poses};
        const View view{look.clip_from_world, 700, 700};
        const BatchAnswer onHost =
            take(take(cpu::Detector::create({.projection = look.projection, .samplesPerVoxel = look.samples}))
                     .detect({{&hostItem, 1}, view, 0.05}));
        const BatchAnswer onDevice = take(detector({.method = CountingMethod::Compute,
                                                    .projection = look.projection,
                                                    .filter = Filter::Exact,
                                                    .samplesPerVoxel = look.samples})
                                              .detect({{&item, 1}, view, 0.05}));
        SCOPED_TRACE(std::string(toString(look.projection)) + ", seed " + std::to_string(seed));
        EXPECT_GT(onHost.pairs[0].count, 1000000U);
        expectSame(onDevice, onHost);
    }
}

/// What PixelSlices expects is no less than what the boxes of triangles have, of any size, in any view.
TEST_F(DrawSizeTest, NoLaneHasMorePixelsThanItShould) {
    const std::uint64_t seed = testSeed();
    std::mt19937_64 random(seed);
    const Volume volume = upload(makeBytes(unitGrid(8), [](auto...) { return 255.0; }));
    const TransferFunction function = upload(byteRamp(), {0, 255});
    double fullest = 0;
    std::uint32_t sliced = 0;
    for (int turn = 0; turn < 400; ++turn) {
        MeshData data;
        const double size = std::exp2(uniform(random, -6, 4));
        for (std::uint32_t corner = 0; corner < 3 * 64; ++corner) {
            for (int axis = 0; axis < 3; ++axis) {
                data.positions.push_back(static_cast<float>(size * uniform(random, -1, 1)));
            }
            data.indices.push_back(corner);
        }
        const Mesh mesh = take(Mesh::create(context(), data.view()));
        const auto side = static_cast<std::uint32_t>(std::exp2(uniform(random, 4, 14)));
        const double depth = turn % 2 == 0 ? 0 : -1; // w = 1, or the distance from the eye
        View view{{uniform(random, 0.3, 3), 0, 0, 0, 0, uniform(random, 0.3, 3), 0, 0, 0, 0, depth == 0 ? -0.01 : -1.01,
                   depth, 0, 0, depth == 0 ? 0.5 : -0.1, depth == 0 ? 1.0 : 0.0},
                  side,
                  side};
        const Mat4 pose =
            translation({uniform(random, -2, 2), uniform(random, -2, 2), -size * uniform(random, 0.5, 8)});
        const BatchItem item{&mesh, &volume, &function, {&pose, 1}};
        const PixelSlices slices(context().impl(), passDesc(RasterDesc{}), {{&item, 1}, view, 0.5}, item, {side, side});
        const shader::PairTransform transform = pairTransform(view.clip_from_world, pose, identity());
        const float guard = shader::exactGuard(side);
        double rounds = 0; // of the lanes of each slice
        for (std::size_t triangle = 0; triangle < 64; ++triangle) {
            shader::ExactCorner corners[EXACT_MAX_CORNERS];
            for (std::size_t corner = 0; corner < 3; ++corner) {
                const double* at = &data.positions[9 * triangle + 3 * corner];
                corners[corner] = shader::exactVertex(transform, static_cast<float>(at[0]), static_cast<float>(at[1]),
                                                      static_cast<float>(at[2]));
            }
            const int count = shader::exactClip(3, corners, guard, guard);
            for (int i = 1; i + 1 < count; ++i) {
                shader::ExactTriangle piece;
                if (shader::exactSetUp(corners[0], corners[i], corners[i + 1], static_cast<int>(side),
                                       static_cast<int>(side), piece)) {
                    const double pixels =
                        static_cast<double>(piece.maxX - piece.minX + 1) * (piece.maxY - piece.minY + 1);
                    rounds += pixels <= 64 ? 0 : std::ceil(pixels / (64.0 * slices.of(0)));
                }
            }
        }
        // A slice has one round more of each piece than its share.
        EXPECT_LE(rounds, kMostPixelRounds + 64 * 7) << "turn " << turn << ", seed " << seed;
        fullest = std::max(fullest, rounds / kMostPixelRounds);
        sliced += slices.of(0) > 1 ? 1U : 0U;
    }
    std::cout << "at most " << fullest << " of it, " << sliced << " of 400 in slices\n";
    EXPECT_GT(fullest, 0.02);
    EXPECT_GT(sliced, 20U);
    EXPECT_LT(sliced, 380U);
}

/// A device of few work groups takes a mesh of any size.
TEST_F(DrawSizeTest, AMeshMayNeedMoreWorkGroupsThanThereAre) {
    if (!context().supports(CountingMethod::Compute)) {
        GTEST_SKIP() << "no compute on this device";
    }
    for (const bool triangles : {false, true}) {
        const AnyDesc desc{.method = CountingMethod::Compute, .outputs = {.triangles = triangles}};
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
