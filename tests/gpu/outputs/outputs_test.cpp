// SPDX-License-Identifier: MIT
// The outputs in addition to the counts, on the device: the methods against each other, compute against the host bit
// for bit, the rasteriser against its own trace, and solids whose normals and depths are known.
#include "outputs_fixture.h"

#include "bench/engines/localize.h"
#include "cpu/scenes/random_scene.h"
#include "device/results/results_impl.h"
#include "few_kinds.h"
#include "support/contact_scenes.h"
#include "support/host_meters.h"
#include "support/scenes.h"
#include "voxtact/cpu.h"
#include "vulkan/context_impl.h"
#include "vulkan/submit.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <bit>
#include <cstring>
#include <iostream>
#include <limits>
#include <map>

namespace voxtact::test {
namespace {

using testing::HasSubstr;

constexpr CountingMethod kRaster[] = {CountingMethod::Query, CountingMethod::QueryAny, CountingMethod::Atomic,
                                      CountingMethod::Subgroup};

/// A RandomScene on the device and on the host engine, with a label map.
struct BothSides {
    Volume volume;
    TransferFunction function;
    Mesh mesh;
    LabelData labels;
    LabelMap labelMap;
    cpu::Volume hostVolume;
    cpu::TransferFunction hostFunction;
    cpu::Mesh hostMesh;

    BothSides(const Context& context, const QueueAccess& queue, const RandomScene& scene, std::mt19937_64& random)
        : volume(take(Volume::upload(context, queue, scene.volume.view()))),
          function(take(TransferFunction::upload(context, queue, scene.transferFunction()))),
          mesh(take(Mesh::upload(context, queue, scene.mesh.view()))),
          labels(take(makeLabels(makeLabelImage(random, scene.volume.grid).view()))),
          labelMap(take(LabelMap::upload(context, queue, labels))),
          hostVolume(take(cpu::Volume::create(scene.volume.view()))),
          hostFunction(take(cpu::TransferFunction::create(scene.transferFunction()))),
          hostMesh(take(cpu::Mesh::create(scene.mesh.view()))) {}

    [[nodiscard]] BatchItem item(const RandomScene& scene) const {
        return {&mesh, &volume, &function, scene.poses, &labelMap};
    }
    [[nodiscard]] cpu::BatchItem hostItem(const RandomScene& scene) const {
        return {&hostMesh, &hostVolume, &hostFunction, scene.poses, &labels};
    }
};

/// Small random scenes with few kinds of images.
class SmallScenes {
  public:
    explicit SmallScenes(std::size_t poses) : poses_(poses) {}

    /// From the first seed on that `random` gives and that makes such a scene; that one is `seed()` then.
    RandomScene next(std::mt19937_64& random) {
        RandomScene scene = few_.next([&] {
            seed_ = random();
            local_.seed(seed_);
            return makeRandomScene(local_, poses_);
        });
        scene.view.width = std::min(scene.view.width, 100U);
        scene.view.height = std::min(scene.view.height, 100U);
        scene.rangeTest = true;
        return scene;
    }
    [[nodiscard]] std::uint64_t seed() const { return seed_; }
    /// What the scene's own random numbers come from.
    [[nodiscard]] std::mt19937_64& random() { return local_; }

  private:
    std::size_t poses_;
    std::uint64_t seed_ = 0;
    std::mt19937_64 local_;
    FewKindsOfImage few_;
};

TEST_F(OutputsTest, ComputeIsTheHostBitForBit) {
    std::mt19937_64 random(testSeed());
    BlockingDetector compute = detectorOf(CountingMethod::Compute, kAllOutputs);
    cpu::Detector host = take(cpu::Detector::create({.boundary = Boundary::Range, .outputs = kAllOutputs}));
    std::uint64_t contacts = 0;
    SmallScenes scenes(3);
    const std::size_t least = randomCases(20, 3);
    for (std::size_t round = 0; (round < least || contacts < 2000) && round < 200 && !HasFailure(); ++round) {
        const RandomScene scene = scenes.next(random);
        SCOPED_TRACE("scene " + std::to_string(scenes.seed()));
        const BothSides sides(context(), queue(), scene, scenes.random());
        const BatchItem item = sides.item(scene);
        const cpu::BatchItem hostItem = sides.hostItem(scene);
        const BatchAnswer device = take(compute.detect({std::span(&item, 1), scene.view, scene.threshold}));
        const BatchAnswer expected = take(host.detect({std::span(&hostItem, 1), scene.view, scene.threshold}));
        EXPECT_EQ(differenceOf(device, expected), "");
        EXPECT_EQ(inconsistencyOf(device), "");
        contacts += device.contacts.size();
    }
    std::cout << contacts << " contacts\n";
    EXPECT_GE(contacts, 2000U);
}

TEST_F(OutputsTest, TheRasterMethodsAgreeWithEachOtherAndTheTrace) {
    std::mt19937_64 random(testSeed());
    std::vector<BlockingDetector> detectors;
    for (const CountingMethod method : kRaster) {
        detectors.push_back(detectorOf(method, kAllOutputs));
    }
    FragmentTrace trace = take(FragmentTrace::create(context(), Filter::Hardware, queue()));
    std::uint64_t contacts = 0;
    SmallScenes scenes(3);
    for (int round = 0; (round < 40 || contacts < 2000) && round < 200 && !HasFailure(); ++round) {
        const RandomScene scene = scenes.next(random);
        SCOPED_TRACE("scene " + std::to_string(scenes.seed()));
        const BothSides sides(context(), queue(), scene, scenes.random());
        const BatchItem item = sides.item(scene);
        const Batch batch{std::span(&item, 1), scene.view, scene.threshold};
        const BatchAnswer query = take(detectors[0].detect(batch));
        EXPECT_EQ(inconsistencyOf(query), "");
        for (std::size_t i = 1; i < detectors.size(); ++i) {
            BatchAnswer other = take(detectors[i].detect(batch));
            if (kRaster[i] == CountingMethod::QueryAny) {
                other.pairs = query.pairs; // which are not exact
            }
            EXPECT_EQ(differenceOf(other, query), "") << toString(kRaster[i]);
        }
        for (std::uint32_t pose = 0; pose < scene.poses.size(); ++pose) {
            BatchItem one = item;
            one.world_from_object = std::span(&scene.poses[pose], 1);
            std::map<std::uint32_t, std::uint32_t> traced;
            for (const shader::TracedFragment& fragment :
                 take(trace.survivors({std::span(&one, 1), scene.view, scene.threshold}))) {
                ++traced[fragment.triangle];
            }
            std::map<std::uint32_t, std::uint32_t> listed;
            for (const TouchedTriangle& triangle : query.triangles) {
                if (triangle.pair == pose) {
                    listed[triangle.triangle] = triangle.count;
                }
            }
            EXPECT_EQ(listed, traced) << "pose " << pose;
        }
        contacts += query.contacts.size();
    }
    std::cout << contacts << " contacts\n";
    EXPECT_GE(contacts, 2000U);
}

TEST_F(OutputsTest, NormalsAndDepthsOfKnownSolids) {
    std::mt19937_64 random(testSeed());
    std::vector<BlockingDetector> detectors;
    for (const CountingMethod method : {CountingMethod::Query, CountingMethod::Atomic, CountingMethod::Compute}) {
        detectors.push_back(detectorOf(method, {.contacts = true}));
    }
    double raster = 0;
    double exact = 0;
    for (const ContactScene& scene : makeContactScenes(random)) {
        const Volume volume = upload(scene.volume);
        const TransferFunction function = upload(scene.points, scene.domain);
        const Mesh mesh = upload(scene.mesh);
        const BatchItem item{&mesh, &volume, &function, std::span(&scene.world_from_object, 1)};
        for (BlockingDetector& one : detectors) {
            const BatchAnswer answer = take(one.detect({std::span(&item, 1), scene.view, scene.threshold}));
            EXPECT_EQ(answer.contacts.size(), answer.pairs[0].count);
            const ContactErrors errors = contactErrors(scene, answer.contacts);
            EXPECT_GT(errors.compared, 100U) << scene.name;
            EXPECT_LT(errors.degrees, scene.degrees) << scene.name;
            const bool compute = &one == &detectors.back();
            // Weights of 8 bits let a fragment survive that is a 256th of a voxel outside, where the depth is 0.
            const double filtered = compute ? 0 : std::ranges::max(scene.volume.grid.spacing) / 256;
            EXPECT_LT(errors.mm, scene.mm + filtered) << scene.name;
            EXPECT_LT(errors.value, 1e-5) << scene.name;
            // A rasteriser interpolates with what errors it likes, most of all on triangles that are nearly edge-on.
            EXPECT_LT(errors.fromTriangle, compute ? 2e-4 : 0.5) << scene.name;
            (compute ? exact : raster) = std::max(compute ? exact : raster, errors.fromTriangle);
        }
    }
    std::cout << "positions off their triangles by " << raster << " mm at most, of compute by " << exact << " mm\n";
}

TEST_F(OutputsTest, LabelsAreThoseOfTheMap) {
    std::mt19937_64 random(testSeed());
    BlockingDetector query = detectorOf(CountingMethod::Query, kAllOutputs);
    std::uint64_t compared = 0;
    SmallScenes scenes(2);
    for (int round = 0; round < 200 && compared < 5000; ++round) {
        const RandomScene scene = scenes.next(random);
        const BothSides sides(context(), queue(), scene, scenes.random());
        const BatchItem item = sides.item(scene);
        for (const Contact& contact : take(query.detect({std::span(&item, 1), scene.view, scene.threshold})).contacts) {
            if (!labelIsDoubtful(sides.labels, contact.position)) {
                ASSERT_EQ(contact.label, sides.labels.values[labelAt(sides.labels, contact.position)]);
                ++compared;
            }
        }
    }
    EXPECT_GE(compared, 5000U);
}

TEST_F(OutputsTest, ItemsWithAndWithoutLabelMaps) {
    const Simple scene = simple();
    const Mesh cube = upload(makeCube(0.25, 0.75));
    const Mat4 poses[] = {identity(), translation({0, 0, 5}), identity()};
    BatchItem items[] = {scene.item(), scene.item(), scene.item(), scene.item()};
    items[0].labels = nullptr;
    items[1].mesh = &cube;
    items[1].world_from_object = poses;
    items[2].world_from_object = {};
    for (const CountingMethod method : {CountingMethod::Query, CountingMethod::Atomic, CountingMethod::Compute}) {
        BlockingDetector one = detectorOf(method, {.triangles = true, .contacts = true, .bounds = true});
        const BatchAnswer answer = take(one.detect({items, sixteen(), 0.5}));
        ASSERT_EQ(answer.pairs.size(), 5U);
        std::map<std::uint32_t, std::map<std::int32_t, std::uint32_t>> labels;
        for (const Contact& contact : answer.contacts) {
            ++labels[contact.pair][contact.label];
        }
        // The upper and the lower face of the cube, 64 pixels each; x below and above 0.5 are 0 and 3.
        const std::map<std::uint32_t, std::map<std::int32_t, std::uint32_t>> expected{
            {0, {{0, 256}}}, {1, {{0, 64}, {3, 64}}}, {3, {{0, 64}, {3, 64}}}, {4, {{0, 128}, {3, 128}}}};
        EXPECT_EQ(labels, expected) << toString(method);
        EXPECT_FALSE(answer.bounds[2].has_value());
        EXPECT_NEAR(answer.bounds[4]->lo[0], 0.5 / 16, 1e-6);
        EXPECT_NEAR(answer.bounds[4]->hi[1], 15.5 / 16, 1e-6);
        std::map<std::uint32_t, std::uint64_t> triangles;
        for (const TouchedTriangle& triangle : answer.triangles) {
            triangles[triangle.pair] += triangle.count;
        }
        EXPECT_EQ(triangles, (std::map<std::uint32_t, std::uint64_t>{{0, 256}, {1, 128}, {3, 128}, {4, 256}}));
    }
    BlockingDetector histogram = detectorOf(CountingMethod::Atomic, {.labels = true});
    EXPECT_THAT(histogram.detect({items, sixteen(), 0.5}).error().text,
                HasSubstr("batch item 0 has no label map, which the output labels needs"));
    const BatchAnswer answer = take(histogram.detect({std::span(items).subspan(1), sixteen(), 0.5}));
    ASSERT_EQ(answer.labels.size(), 6U);
    EXPECT_EQ(answer.labels[1].label, 3);
    EXPECT_EQ(answer.labels[1].count, 64U);
    EXPECT_EQ(answer.labels[5].pair, 3U);
    EXPECT_EQ(answer.labels[5].count, 128U);
}

TEST_F(OutputsTest, AListIsCutAndTheTotalIsNot) {
    const Simple scene = simple();
    const BatchItem item = scene.item();
    for (const std::uint32_t most : {1U, 100U, 256U, 300U}) {
        for (const CountingMethod method : {CountingMethod::Atomic, CountingMethod::Query, CountingMethod::Compute}) {
            BlockingDetector one = detectorOf(method, {.contacts = true}, most);
            for (int turn = 0; turn < 2; ++turn) {
                const BatchAnswer answer = take(one.detect({std::span(&item, 1), sixteen(), 0.5}));
                EXPECT_EQ(answer.contactsFound, 256U);
                EXPECT_EQ(answer.contacts.size(), std::min(most, 256U));
            }
        }
    }
}

TEST_F(OutputsTest, EachOutputAlone) {
    const Simple scene = simple();
    const BatchItem item = scene.item();
    const Outputs each[] = {{.triangles = true}, {.contacts = true}, {.bounds = true}, {.labels = true}};
    for (const CountingMethod method : {CountingMethod::Query, CountingMethod::Subgroup, CountingMethod::Compute}) {
        BlockingDetector all = detectorOf(method, kAllOutputs);
        const BatchAnswer whole = take(all.detect({std::span(&item, 1), sixteen(), 0.5}));
        for (const Outputs& outputs : each) {
            BlockingDetector one = detectorOf(method, outputs);
            BatchAnswer expected = whole;
            if (!outputs.triangles) {
                expected.triangles.clear();
            }
            if (!outputs.contacts) {
                expected.contacts.clear();
                expected.contactsFound = 0;
            }
            if (!outputs.bounds) {
                expected.bounds.clear();
            }
            if (!outputs.labels) {
                expected.labels.clear();
            }
            EXPECT_EQ(differenceOf(take(one.detect({std::span(&item, 1), sixteen(), 0.5})), expected), "")
                << toString(method);
        }
    }
}

TEST_F(OutputsTest, WhatIsOffHasNoBuffers) {
    const Results without = take(Results::create(take(Detector::raster(context(), {})), {.maxPairs = 4}));
    EXPECT_EQ(without.impl().outputs, nullptr);
    for (const BufferRange& range : {without.triangleCounts(), without.triangleMask(), without.contacts(),
                                     without.bounds(), without.labelCounts()}) {
        EXPECT_EQ(range.buffer, VkBuffer{VK_NULL_HANDLE});
        EXPECT_EQ(range.size, 0U);
    }
    const Results with = take(Results::create(take(Detector::raster(context(), {.outputs = kAllOutputs})),
                                              {.maxPairs = 4, .room = {100, 7, 9}}));
    EXPECT_EQ(with.triangleCounts().size, 400U);
    EXPECT_EQ(with.triangleMask().size, 4U * (100 / 32 + 4));
    EXPECT_EQ(with.contacts().size, 16 + 9 * sizeof(ContactResult));
    EXPECT_EQ(with.bounds().size, 96U);
    EXPECT_EQ(with.labelCounts().size, 28U);
    for (const BufferRange& range :
         {with.triangleCounts(), with.triangleMask(), with.contacts(), with.bounds(), with.labelCounts()}) {
        EXPECT_EQ(range.offset % 256, 0U);
        EXPECT_NE(range.buffer, VkBuffer{VK_NULL_HANDLE});
    }
    const Results bounds = take(Results::create(take(Detector::raster(context(), {.outputs = {.bounds = true}})), {}));
    EXPECT_EQ(bounds.bounds().size, 24U);
    EXPECT_EQ(bounds.contacts().size, 0U);
}

TEST_F(OutputsTest, BadDepthsAndLabelMaps) {
    const double nan = std::numeric_limits<double>::quiet_NaN();
    for (const double depth : {0.0, -1.0, nan, std::numeric_limits<double>::infinity()}) {
        const auto refused = Detector::raster(context(), {.outputs = {.contacts = true, .maxDepth = depth}});
        ASSERT_FALSE(refused.ok()) << depth;
        EXPECT_EQ(refused.error().code, ErrorCode::InvalidArgument);
        EXPECT_THAT(refused.error().text, HasSubstr("the largest depth of contacts is"));
    }
    EXPECT_TRUE(Detector::raster(context(), {.outputs = {.bounds = true, .maxDepth = nan}}).ok());
    EXPECT_THAT(Detector::certified(context(), {.outputs = {.triangles = true}, .stopAtFirst = true}).error().text,
                HasSubstr("a yes or no ends at the first survivor"));
    LabelData labels{unitGrid(2), std::vector<std::uint16_t>(8), {0, 3}};
    EXPECT_TRUE(LabelMap::create(context(), labels).ok());
    labels.indices[5] = 2;
    EXPECT_THAT(LabelMap::create(context(), labels).error().text, HasSubstr("voxel 5 has the index 2"));
    labels.indices.pop_back();
    EXPECT_THAT(LabelMap::create(context(), labels).error().text, HasSubstr("7 indices"));
    labels = {unitGrid(2), std::vector<std::uint16_t>(8), {}};
    EXPECT_THAT(LabelMap::create(context(), labels).error().text, HasSubstr("do not hold 0"));
    labels = {{}, {}, {0}};
    EXPECT_THAT(LabelMap::create(context(), labels).error().text, HasSubstr("0 voxels along x"));
    labels.grid.size = {1, 1, 1U << 20U};
    labels.indices.resize(1U << 20U);
    EXPECT_EQ(LabelMap::create(context(), labels).error().code, ErrorCode::LimitExceeded);
}

TEST_F(OutputsTest, LabelMapsKeepWhatTheyWereMadeFrom) {
    const LabelData labels{unitGrid(2, 1, 3), std::vector<std::uint16_t>(6), {-4, 0, 8}};
    LabelMap map = take(LabelMap::upload(context(), queue(), labels, "atlas"));
    EXPECT_EQ(map.grid().size, labels.grid.size);
    EXPECT_TRUE(std::ranges::equal(map.values(), labels.values));
    Submitter submitter = take(Submitter::create(context().impl(), queue()));
    EXPECT_EQ(map.cmdUpload(take(submitter.begin())).error().code, ErrorCode::NotReady);
}

TEST_F(OutputsTest, LabelMapsOfAnotherContext) {
    const Simple scene = simple();
    const Context other = take(Context::create(gpu().device.contextDesc()));
    const LabelMap foreign =
        take(LabelMap::upload(other, queue(), {unitGrid(2), std::vector<std::uint16_t>(8), {0, 3}}));
    BatchItem item = scene.item();
    item.labels = &foreign;
    BlockingDetector one = detectorOf(CountingMethod::Query, {.contacts = true});
    EXPECT_THAT(one.detect({std::span(&item, 1), sixteen(), 0.5}).error().text,
                HasSubstr("the label map belongs to another Context"));
}

TEST_F(OutputsTest, TheRasterMethodsNeedTheirFeatures) {
    const auto devices = take(gpu().instance.devices());
    const auto chosen = take(device::chooseDevice(devices, {}));
    const auto expectRefused = [&](const std::function<void(FeatureRequest&)>& adjust, const char* feature) {
        const device::VulkanDevice device =
            take(device::VulkanDevice::create(gpu().instance, chosen, {.adjustFeatures = adjust}));
        const Context context = take(Context::create(device.contextDesc()));
        const Result<Detector> query =
            Detector::raster(context, {.method = CountingMethod::Query, .outputs = {.triangles = true}});
        ASSERT_FALSE(query.ok());
        EXPECT_EQ(query.error().code, ErrorCode::Unsupported);
        EXPECT_THAT(query.error().text, HasSubstr(feature));
        EXPECT_TRUE(
            Detector::raster(context, {.method = CountingMethod::Compute, .outputs = {.triangles = true}}).ok());
        EXPECT_TRUE(Detector::raster(context, {.method = CountingMethod::Query}).ok());
    };
    expectRefused([](FeatureRequest& request) { request.features2.features.fragmentStoresAndAtomics = VK_FALSE; },
                  "fragmentStoresAndAtomics");
    expectRefused([](FeatureRequest& request) { request.features2.features.geometryShader = VK_FALSE; },
                  "geometryShader");
}

TEST_F(OutputsTest, LimitsAreNamed) {
    ContextImpl& impl = context().impl();
    const VkPhysicalDeviceLimits limits = impl.limits;
    impl.limits.maxBoundDescriptorSets = 4;
    EXPECT_THAT(Detector::raster(context(), {.outputs = {.bounds = true}}).error().text,
                HasSubstr("maxBoundDescriptorSets is 4, 5 are needed"));
    impl.limits = limits;
    impl.limits.maxPerStageDescriptorStorageBuffers = 4;
    EXPECT_THAT(Detector::raster(context(), {.outputs = {.bounds = true}}).error().text,
                HasSubstr("maxPerStageDescriptorStorageBuffers is 4"));
    impl.limits = limits;
}

} // namespace
} // namespace voxtact::test
