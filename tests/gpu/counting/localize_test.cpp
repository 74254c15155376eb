// SPDX-License-Identifier: MIT
// The paper's two ways to say which triangles touch, against each other and against the fragments themselves.
#include "gpu_fixture.h"

#include "bench/engines/localize.h"
#include "cpu/scenes/random_scene.h"
#include "few_kinds.h"
#include "host/touch/cells/brick_occupancy.h"
#include "oracle/oracle.h"
#include "support/scenes.h"
#include "voxtact/io.h"
#include "voxtact/samples.h"

#include <algorithm>
#include <iostream>
#include <map>

namespace voxtact::test {
namespace {

using Counts = std::map<std::uint32_t, std::uint64_t>;

Counts countsOf(const lab::Pass& found) {
    Counts counts;
    for (const TouchedTriangle& triangle : found.triangles) {
        counts[triangle.triangle] += triangle.count;
    }
    return counts;
}

class LocalizeTest : public GpuTest {
  protected:
    void SetUp() override {
        GpuTest::SetUp();
        if (!IsSkipped() && !HasFatalFailure()) {
            localizer_.emplace(take(Localizer::create(context(), Filter::Hardware, queue())));
        }
    }

    [[nodiscard]] lab::Pass find(const Batch& batch, Localization way, const LocalizeAids& aids = {}) {
        lab::Pass found = take(localizer_->triangles(batch, way, aids));
        EXPECT_TRUE(std::ranges::is_sorted(found.triangles, {}, &TouchedTriangle::triangle));
        EXPECT_GT(found.wallMilliseconds, 0);
        return found;
    }

    /// All ways find the same triangles with the same counts as the fragments say, on every pose. Adds up what it took.
    void expectTheSame(const RandomScene& scene, const std::string& which) {
        const Volume volume = upload(scene.volume);
        const Mesh mesh = upload(scene.mesh);
        const TransferFunction function = take(TransferFunction::upload(context(), queue(), scene.transferFunction()));
        const cpu::BrickOccupancy bricks(take(cpu::Volume::create(scene.volume.view())),
                                         take(cpu::TransferFunction::create(scene.transferFunction())), scene.threshold,
                                         scene.volume.type == ScalarType::UInt8 ? oracle::kEightBitFilterError : 0);
        const ObbTree tree = makeObbTree(scene.mesh.view());
        const LocalizeAids aids{&tree, [&bricks](const Box& box) { return bricks.mayBeOpaque(box); }};
        FragmentTrace trace = take(FragmentTrace::create(context(), Filter::Hardware, queue()));
        for (std::size_t pose = 0; pose < scene.poses.size(); ++pose) {
            const BatchItem item{&mesh, &volume, &function, std::span(&scene.poses[pose], 1)};
            const Batch batch{std::span(&item, 1), scene.view, scene.threshold};
            Counts fragments;
            for (const shader::TracedFragment& fragment : take(trace.survivors(batch))) {
                ++fragments[fragment.triangle];
            }
            std::uint64_t before = mesh.triangles();
            for (const Localization way : {Localization::Polygon, Localization::Leaf, Localization::LeafBricks}) {
                const lab::Pass found = find(batch, way, aids);
                EXPECT_EQ(countsOf(found), fragments)
                    << which << ", pose " << pose << ", " << toString(way) << ", " << *found.queries << " queries";
                EXPECT_LE(*found.queries, before) << which << ", pose " << pose << ", " << toString(way);
                before = *found.queries;
                queries_[way] += *found.queries;
            }
            triangles_ += fragments.size();
        }
    }

    void report() {
        std::cout << "triangles: " << triangles_;
        for (const auto& [way, queries] : queries_) {
            std::cout << ", queries by " << toString(way) << ": " << queries;
        }
        std::cout << "\n";
    }

    std::optional<Localizer> localizer_;
    std::map<Localization, std::uint64_t> queries_;
    std::uint64_t triangles_ = 0;
};

TEST_F(LocalizeTest, AllWaysAgreeOnRandomScenes) {
    constexpr double kWidest = 1e37; // a sampler may take the difference of two voxels, which must not overflow
    std::mt19937_64 random(testSeed());
    FewKindsOfImage few;
    // Many scenes have no triangle that touches, and in many every brick is opaque somewhere.
    const auto enough = [&] {
        return triangles_ > 100 && queries_[Localization::LeafBricks] < queries_[Localization::Leaf];
    };
    for (std::size_t i = 0; (i < randomCases(40, 3) || !enough()) && i < 400 && !HasFailure(); ++i) {
        const RandomScene scene = few.next([&] { return makeRandomScene(random, 2); });
        if (scene.domain.hi - scene.domain.lo < kWidest) {
            expectTheSame(scene, "scene " + std::to_string(i));
        }
    }
    report();
    EXPECT_GT(triangles_, 100U);
    EXPECT_LT(queries_[Localization::LeafBricks], queries_[Localization::Leaf]);
    EXPECT_LT(queries_[Localization::Leaf], queries_[Localization::Polygon]);
}

TEST_F(LocalizeTest, AllWaysAgreeOnTheHead) {
    std::mt19937_64 random(testSeed());
    RandomScene scene;
    scene.volume = take(makeBuiltinVolume("head:128"));
    scene.points = {{40, 0}, {80, 1}};
    scene.domain = {0, 255};
    scene.mesh = take(makeScalpel());
    scene.view = {framingCamera(scene.volume.grid, 512, 512), 512, 512};
    scene.poses = randomPoses(scene.volume.grid, 2, 0.8, random);
    expectTheSame(scene, "scalpel");
    scene.mesh = take(makeEllipsoid(5000)); // more than a submission has queries
    expectTheSame(scene, "ellipsoid");
    report();
    EXPECT_GT(triangles_, 100U);
}

TEST_F(LocalizeTest, ATransparentVolumeNeedsNoQuery) {
    const MeshData data = makeCube(0.2, 0.8);
    const Mesh mesh = upload(data);
    const Volume volume = upload(makeBytes(unitGrid(8), [](auto, auto, auto) { return 0; }));
    const TransferFunction function = upload(byteRamp(), {0, 255});
    const Mat4 pose = identity();
    const BatchItem item{&mesh, &volume, &function, std::span(&pose, 1)};
    const ObbTree tree = makeObbTree(data.view());
    const LocalizeAids aids{&tree, [](const Box&) { return false; }};
    const lab::Pass found = find({std::span(&item, 1), flatView(0, 1, 32, 32), 0.5}, Localization::LeafBricks, aids);
    EXPECT_EQ(found.queries, 0U);
    EXPECT_EQ(found.boxes, 1U);
    EXPECT_TRUE(found.triangles.empty());
}

TEST_F(LocalizeTest, WithoutItsAidsAWayIsRefused) {
    const MeshData data = makeCube(0.2, 0.8);
    const Mesh mesh = upload(data);
    const Volume volume = upload(makeBytes(unitGrid(8), [](auto, auto, auto) { return 255; }));
    const TransferFunction function = upload(byteRamp(), {0, 255});
    const std::array<Mat4, 2> poses{identity(), identity()};
    BatchItem item{&mesh, &volume, &function, std::span(poses).first(1)};
    const Batch batch{std::span(&item, 1), flatView(0, 1, 32, 32), 0.5};
    const auto refusal = [&](Localization way, const LocalizeAids& aids) {
        const Result<lab::Pass> found = localizer_->triangles(batch, way, aids);
        EXPECT_FALSE(found.ok());
        return found.ok() ? std::string() : found.error().text;
    };
    const ObbTree tree = makeObbTree(data.view());
    const ObbTree other = makeObbTree(makeFlat(0, 1, 0, 1, 0).view());
    EXPECT_EQ(refusal(Localization::Leaf, {}),
              "LocalizeAids::tree must be the tree of the mesh, which has 12 triangles; it has none");
    EXPECT_EQ(refusal(Localization::Leaf, {&other, {}}),
              "LocalizeAids::tree must be the tree of the mesh, which has 12 triangles; it has 2");
    EXPECT_EQ(refusal(Localization::LeafBricks, {&tree, {}}),
              "LocalizeAids::mayBeOpaque is empty, leaf-bricks asks it");
    item.world_from_object = poses;
    EXPECT_EQ(refusal(Localization::Polygon, {}), "triangles are found for one pair, the batch has 2");
}

} // namespace
} // namespace voxtact::test
