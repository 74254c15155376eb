// SPDX-License-Identifier: MIT
// The Vulkan half of the C interface, on the device: the C++ interface's answers by every method and projection, and
// each function that records.
#include "gpu_fixture.h"

#include "cpu/random_scene.h"
#include "raw_vulkan.h"
#include "support/c_calls.h"
#include "support/contact_scenes.h"
#include "support/scenes.h"
#include "voxtact/cpu.h"
#include "voxtact/voxtact_vulkan.h"

#include <gmock/gmock.h>

#include <atomic>
#include <cstdlib>
#include <cstring>
#include <iostream>
#include <malloc.h>
#include <thread>

namespace voxtact::test {
namespace {

using testing::HasSubstr;

constexpr Outputs kAll{.triangles = true, .contacts = true, .bounds = true, .labels = true, .maxDepth = 3};
constexpr std::uint32_t kMany = 1U << 19U;

vxt_context_desc cDesc(const ContextDesc& desc) {
    vxt_context_desc out = vxt_context_desc_init();
    out.get_instance_proc_addr = desc.getInstanceProcAddr;
    out.instance = desc.instance;
    out.physical_device = desc.physicalDevice;
    out.device = desc.device;
    out.api_version = desc.apiVersion;
    out.enabled_features = desc.enabledFeatures;
    out.enabled_instance_extensions = desc.enabledInstanceExtensions.data();
    out.enabled_instance_extension_count = desc.enabledInstanceExtensions.size();
    out.enabled_device_extensions = desc.enabledDeviceExtensions.data();
    out.enabled_device_extension_count = desc.enabledDeviceExtensions.size();
    out.pipeline_cache = desc.pipelineCache;
    return out;
}

/// A scene on the device through the C interface, uploaded in one go.
struct CScene {
    Owned<vxt_volume> volume;
    Owned<vxt_transfer_function> function;
    Owned<vxt_mesh> mesh;
    Owned<vxt_labels> labels;
    Owned<vxt_label_map> labelMap;

    CScene(const vxt_context* context, const vxt_queue& queue, const RandomScene& scene, const VolumeData& labelImage)
        : volume(made<vxt_volume>(vxt_volume_destroy,
                                  [&](auto out) {
                                      vxt_volume_options options = vxt_volume_options_init();
                                      options.bricks = 1;
                                      options.editable = 1;
                                      const vxt_volume_view view = cVolume(scene.volume);
                                      return vxt_volume_upload(context, &queue, &view, &options, out);
                                  })),
          function(made<vxt_transfer_function>(vxt_transfer_function_destroy,
                                               [&](auto out) {
                                                   const auto points = cPoints(scene.points);
                                                   const auto desc = cFunction(points, scene.domain, scene.tableSize);
                                                   return vxt_transfer_function_upload(context, &queue, &desc, "table",
                                                                                       out);
                                               })),
          mesh(made<vxt_mesh>(vxt_mesh_destroy,
                              [&](auto out) {
                                  vxt_mesh_options options = vxt_mesh_options_init();
                                  options.clusters = 1;
                                  const vxt_mesh_view view = cMesh(scene.mesh);
                                  return vxt_mesh_upload(context, &queue, &view, &options, out);
                              })),
          labels(made<vxt_labels>(vxt_labels_destroy,
                                  [&](auto out) {
                                      const vxt_volume_view view = cVolume(labelImage);
                                      return vxt_labels_create(&view, out);
                                  })),
          labelMap(made<vxt_label_map>(vxt_label_map_destroy, [&](auto out) {
              return vxt_label_map_upload(context, &queue, labels.get(), nullptr, out);
          })) {}
};

/// A batch of one item, with all that it looks at. Stays where it is.
struct COneItem {
    vxt_item item = vxt_item_init();
    vxt_view view{};
    vxt_batch batch = vxt_batch_init();

    COneItem(const CScene& scene, const RandomScene& of) {
        item.mesh = scene.mesh.get();
        item.volume = scene.volume.get();
        item.transfer_function = scene.function.get();
        item.world_from_object = of.poses.data()->data();
        item.pose_count = of.poses.size();
        item.labels = scene.labelMap.get();
        view = cView(of.view);
        batch.items = &item;
        batch.item_count = 1;
        batch.view = &view;
        batch.threshold = of.threshold;
    }
    COneItem(const COneItem&) = delete;
    COneItem& operator=(const COneItem&) = delete;
};

class CGpuTest : public GpuTest {
  protected:
    void SetUp() override {
        GpuTest::SetUp();
        if (IsSkipped() || HasFatalFailure()) {
            return;
        }
        queue_ = vxt_queue_init();
        queue_.queue = queue().queue;
        queue_.family = queue().family;
        queue_.lock = queue().lock;
        queue_.unlock = queue().unlock;
        queue_.user = queue().user;
        context_ = newContext();
    }
    [[nodiscard]] Owned<vxt_context> newContext() const {
        const ContextDesc cpp = gpu().device.contextDesc();
        const vxt_context_desc desc = cDesc(cpp);
        return made<vxt_context>(vxt_context_destroy, [&](auto out) { return vxt_context_create(&desc, out); });
    }
    [[nodiscard]] Owned<vxt_detector> newDetector(const vxt_detector_desc& desc) const {
        return made<vxt_detector>(vxt_detector_destroy,
                                  [&](auto out) { return vxt_detector_create(context_.get(), &desc, out); });
    }
    [[nodiscard]] Owned<vxt_results> newResults(const vxt_results_desc& desc) const {
        return made<vxt_results>(vxt_results_destroy,
                                 [&](auto out) { return vxt_results_create(context_.get(), &desc, out); });
    }
    [[nodiscard]] Owned<vxt_blocking_detector> newBlocking(const vxt_detector_desc& desc) const {
        return made<vxt_blocking_detector>(vxt_blocking_detector_destroy, [&](auto out) {
            return vxt_blocking_detector_create(context_.get(), &desc, &queue_, kMany, out);
        });
    }
    [[nodiscard]] static BatchAnswer ask(vxt_blocking_detector& detector, const COneItem& of) {
        const Owned<vxt_answer> answer = newAnswer();
        need(vxt_blocking_detector_detect(&detector, &of.batch, answer.get()));
        return answerOf(*answer);
    }

    /// 4x4x4 voxels over the unit cube, opaque where x < 0.5, and a square across it on 16x16 pixels.
    [[nodiscard]] static RandomScene halfOpaque() {
        RandomScene scene;
        scene.volume = makeBytes(unitGrid(4), [](std::uint32_t x, auto, auto) { return x < 2 ? 255.0 : 0.0; });
        scene.points = {{0, 0}, {255, 1}};
        scene.domain = {0, 255};
        scene.mesh = makeFlat(0, 1, 0, 1, 0.5);
        scene.view = flatView(0, 1, 16, 16);
        scene.poses = {identity()};
        scene.threshold = 0.5;
        return scene;
    }
    [[nodiscard]] static VolumeData twoLabels() {
        return makeBytes(unitGrid(2), [](std::uint32_t x, auto, auto) { return x == 0 ? 0.0 : 3.0; });
    }

    vxt_queue queue_ = vxt_queue_init();
    Owned<vxt_context> context_{nullptr, vxt_context_destroy};
};

TEST_F(CGpuTest, KnowsOfTheDeviceWhatTheCppInterfaceKnows) {
    for (const CountingMethod method : countingMethods()) {
        for (const Projection projection : projections()) {
            EXPECT_EQ(vxt_context_supports(context_.get(), static_cast<vxt_method>(method),
                                           static_cast<vxt_projection>(projection)) != 0,
                      context().supports(method, projection))
                << toString(method) << " " << toString(projection);
        }
    }
    EXPECT_EQ(vxt_context_supports(context_.get(), static_cast<vxt_method>(99), VXT_PROJECTION_VIEW), 0U);
    EXPECT_EQ(static_cast<CountingMethod>(vxt_context_default_method(context_.get())), context().defaultMethod());
    EXPECT_EQ(vxt_context_max_viewport(context_.get()).width, context().maxViewport().width);
    EXPECT_EQ(vxt_context_device_lost(context_.get()), 0U);

    const ContextDesc cpp = gpu().device.contextDesc();
    const vxt_context_desc desc = cDesc(cpp);
    const auto report = made<vxt_report>(vxt_report_destroy, [&](auto out) { return vxt_check(&desc, out); });
    vxt_report_view view = vxt_report_view_init();
    need(vxt_report_get(report.get(), &view));
    const CheckReport expected = check(cpp);
    EXPECT_EQ(view.usable, 1U);
    ASSERT_EQ(view.method_count, expected.methods.size());
    for (std::size_t i = 0; i < view.method_count; ++i) {
        EXPECT_EQ(view.methods[i].available != 0, expected.methods[i].available);
        EXPECT_EQ(view.methods[i].text, expected.methods[i].reason);
    }
    ASSERT_EQ(view.missing_count, expected.missing.size());
    for (std::size_t i = 0; i < view.missing_count; ++i) {
        EXPECT_EQ(view.missing[i], expected.missing[i]);
    }
}

/// A random scene in which something touches, and not too much.
RandomScene sceneWithSomeSurvivors(std::mt19937_64& random, Projection projection) {
    cpu::Detector host = take(cpu::Detector::create({.boundary = Boundary::Range, .projection = projection}));
    for (int tries = 0; tries < 500; ++tries) {
        RandomScene scene = makeRandomScene(random, 4);
        scene.view.width = std::min(scene.view.width, 64U);
        scene.view.height = std::min(scene.view.height, 64U);
        const cpu::Mesh mesh = take(cpu::Mesh::create(scene.mesh.view()));
        const cpu::Volume volume = take(cpu::Volume::create(scene.volume.view()));
        const auto function = take(cpu::TransferFunction::create(scene.transferFunction()));
        const cpu::BatchItem item{&mesh, &volume, &function, scene.poses};
        std::uint64_t survivors = 0;
        for (const PairAnswer& pair : take(host.detect({std::span(&item, 1), scene.view, scene.threshold})).pairs) {
            survivors += pair.count;
        }
        if (survivors > 0 && survivors < 1000) {
            return scene;
        }
    }
    throw std::runtime_error("no scene with some survivors");
}

TEST_F(CGpuTest, AnswersAsTheCppInterfaceDoesByEveryMethodAndProjection) {
    std::mt19937_64 random(testSeed());
    std::size_t ways = 0;
    std::size_t contacts = 0;
    for (const Projection projection : projections()) {
        // lavapipe takes half a minute for a random scene in the projection conservative.
        RandomScene scene = halfOpaque();
        if (projection == Projection::Conservative) {
            scene.poses.push_back(translation({0.3, 0.1, 0.2}));
        } else {
            scene = sceneWithSomeSurvivors(random, projection);
        }
        const VolumeData labelImage = makeLabelImage(random, scene.volume.grid);
        const CScene sides(context_.get(), queue_, scene, labelImage);
        const COneItem cItem(sides, scene);
        const Volume volume = take(Volume::upload(context(), queue(), scene.volume.view(), {.bricks = true}));
        const auto function = take(TransferFunction::upload(context(), queue(), scene.transferFunction()));
        const Mesh mesh = take(Mesh::upload(context(), queue(), scene.mesh.view(), {.clusters = true}));
        const LabelMap labels = take(LabelMap::upload(context(), queue(), take(makeLabels(labelImage.view()))));
        const BatchItem item{&mesh, &volume, &function, scene.poses, &labels};
        for (const CountingMethod method : countingMethods()) {
            if (!context().supports(method, projection)) {
                continue;
            }
            // Outputs by the cheapest method of each projection: pipelines with outputs take seconds on lavapipe.
            const bool outputs = method == CountingMethod::Query || projection == Projection::Conservative;
            const Outputs wanted = outputs ? kAll : Outputs{};
            vxt_detector_desc desc = vxt_detector_desc_init();
            desc.method = static_cast<vxt_method>(method);
            desc.projection = static_cast<vxt_projection>(projection);
            desc.filter = vxt_default_filter(desc.method);
            desc.boundary = VXT_BOUNDARY_RANGE;
            desc.outputs = cOutputs(wanted);
            desc.max_depth = wanted.maxDepth;
            desc.resolution = 1.0 / 8;
            BlockingDetector cpp = take(BlockingDetector::create(context(),
                                                                 {.method = method,
                                                                  .projection = projection,
                                                                  .filter = defaultFilter(method),
                                                                  .boundary = Boundary::Range,
                                                                  .outputs = wanted,
                                                                  .resolution = 1.0 / 8},
                                                                 queue(), kMany));
            const BatchAnswer answer = ask(*newBlocking(desc), cItem);
            EXPECT_EQ(wholeDifferenceOf(answer, take(cpp.detect({std::span(&item, 1), scene.view, scene.threshold}))),
                      "")
                << toString(method) << " " << toString(projection);
            contacts += answer.contacts.size();
            ++ways;
        }
    }
    std::cout << ways << " ways, " << contacts << " contacts\n";
    EXPECT_GE(ways, 8U);
    EXPECT_GT(contacts, 0U);
}

TEST_F(CGpuTest, CountsWhatThePassesOfConservativeDo) {
    if (!context().supports(CountingMethod::Compute, Projection::Conservative)) {
        GTEST_SKIP() << "no conservative by compute on this device";
    }
    RandomScene scene = halfOpaque();
    scene.poses.push_back(translation({0.3, 0.1, 0.2}));
    const CScene sides(context_.get(), queue_, scene, twoLabels());
    const COneItem item(sides, scene);
    vxt_detector_desc desc = vxt_detector_desc_init();
    desc.method = VXT_METHOD_COMPUTE;
    desc.projection = VXT_PROJECTION_CONSERVATIVE;
    const Owned<vxt_answer> answer = newAnswer();
    vxt_certified_counters counters = vxt_certified_counters_init();
    need(vxt_blocking_detector_detect(newBlocking(desc).get(), &item.batch, answer.get()));
    EXPECT_EQ(vxt_answer_counters(answer.get(), &counters), VXT_ERROR_NOT_READY);
    desc.counters = 1;
    need(vxt_blocking_detector_detect(newBlocking(desc).get(), &item.batch, answer.get()));
    need(vxt_answer_counters(answer.get(), &counters));
    EXPECT_EQ(counters.struct_size, sizeof counters);
    EXPECT_EQ(counters.clusters, scene.poses.size()); // a mesh of one
    EXPECT_EQ(counters.rounds, 1U);
    EXPECT_EQ(counters.room, 4096U); // of 64 pairs, the fewest that it makes results for
    EXPECT_GT(counters.cells_decided, 0U);
    EXPECT_EQ(counters.lanes % 64, 0U);
    EXPECT_EQ(counters.most_looks, counters.bricks_seen + counters.cells_seen);
}

TEST_F(CGpuTest, ResultsHaveTheQueuesThatAreAskedFor) {
    if (!context().supports(CountingMethod::Compute, Projection::Conservative)) {
        GTEST_SKIP() << "no conservative by compute on this device";
    }
    const RandomScene scene = halfOpaque();
    const CScene sides(context_.get(), queue_, scene, twoLabels());
    const COneItem item(sides, scene);
    RawVulkan raw(gpu().device);
    vxt_detector_desc desc = vxt_detector_desc_init();
    desc.method = VXT_METHOD_COMPUTE;
    desc.projection = VXT_PROJECTION_CONSERVATIVE;
    desc.counters = 1;
    const Owned<vxt_detector> detector = newDetector(desc);
    vxt_results_desc resultsDesc = vxt_results_desc_init();
    vxt_results* none = nullptr;
    resultsDesc.clusters_at_once = 15;
    EXPECT_EQ(vxt_results_create(context_.get(), &resultsDesc, &none), VXT_ERROR_INVALID_ARGUMENT);
    resultsDesc.clusters_at_once = VXT_NO_CLUSTERS;
    const Owned<vxt_results> without = newResults(resultsDesc);
    resultsDesc.clusters_at_once = 32;
    const Owned<vxt_results> with = newResults(resultsDesc);
    const VkCommandBuffer commands = raw.begin();
    EXPECT_EQ(vxt_detector_cmd_detect(detector.get(), commands, &item.batch, without.get()), VXT_ERROR_LIMIT_EXCEEDED);
    need(vxt_detector_cmd_detect(detector.get(), commands, &item.batch, with.get()));
    need(vxt_results_cmd_read_back(with.get(), commands));
    raw.submitAndWait(commands);
    const Owned<vxt_answer> answer = newAnswer();
    need(vxt_results_read(with.get(), answer.get()));
    vxt_certified_counters counters = vxt_certified_counters_init();
    need(vxt_answer_counters(answer.get(), &counters));
    EXPECT_EQ(counters.room, 32U);
}

TEST_F(CGpuTest, RecordsIntoTheCallersCommandBuffer) {
    const RandomScene scene = halfOpaque();
    RawVulkan raw(gpu().device);
    // Made and uploaded in two steps.
    const vxt_volume_view volumeView = cVolume(scene.volume);
    const vxt_mesh_view meshView = cMesh(scene.mesh);
    const auto points = cPoints(scene.points);
    const vxt_transfer_function_desc functionDesc = cFunction(points, scene.domain, scene.tableSize);
    const auto volume = made<vxt_volume>(
        vxt_volume_destroy, [&](auto out) { return vxt_volume_create(context_.get(), &volumeView, nullptr, out); });
    const auto function = made<vxt_transfer_function>(vxt_transfer_function_destroy, [&](auto out) {
        return vxt_transfer_function_create(context_.get(), &functionDesc, nullptr, out);
    });
    const auto mesh = made<vxt_mesh>(
        vxt_mesh_destroy, [&](auto out) { return vxt_mesh_create(context_.get(), &meshView, nullptr, out); });
    const auto labels = made<vxt_labels>(vxt_labels_destroy, [&](auto out) {
        const VolumeData image = twoLabels();
        const vxt_volume_view view = cVolume(image);
        return vxt_labels_create(&view, out);
    });
    const auto map = made<vxt_label_map>(vxt_label_map_destroy, [&](auto out) {
        return vxt_label_map_create(context_.get(), labels.get(), "map", out);
    });
    vxt_detector_desc desc = vxt_detector_desc_init();
    desc.outputs = cOutputs(kAll);
    const Owned<vxt_detector> detector = newDetector(desc);
    vxt_results_desc resultsDesc = vxt_results_desc_init();
    resultsDesc.outputs = desc.outputs;
    resultsDesc.triangle_room = 2;
    resultsDesc.label_room = 2;
    resultsDesc.timestamps = 1;
    resultsDesc.queue_family = queue_.family;
    const Owned<vxt_results> results = newResults(resultsDesc);

    const VkCommandBuffer commands = raw.begin();
    need(vxt_volume_cmd_upload(volume.get(), commands));
    need(vxt_transfer_function_cmd_upload(function.get(), commands));
    need(vxt_mesh_cmd_upload(mesh.get(), commands));
    need(vxt_label_map_cmd_upload(map.get(), commands));
    vxt_item item = vxt_item_init();
    item.mesh = mesh.get();
    item.volume = volume.get();
    item.transfer_function = function.get();
    item.world_from_object = scene.poses[0].data();
    item.pose_count = 1;
    item.labels = map.get();
    const vxt_view view = cView(scene.view);
    vxt_batch batch = vxt_batch_init();
    batch.items = &item;
    batch.item_count = 1;
    batch.view = &view;
    batch.threshold = scene.threshold;
    need(vxt_detector_cmd_detect(detector.get(), commands, &batch, results.get()));
    need(vxt_results_cmd_read_back(results.get(), commands));
    const Owned<vxt_answer> answer = newAnswer();
    EXPECT_EQ(vxt_results_read(results.get(), answer.get()), VXT_ERROR_NOT_READY);
    raw.submitAndWait(commands);
    vxt_volume_release_staging(volume.get());
    vxt_transfer_function_release_staging(function.get());
    vxt_mesh_release_staging(mesh.get());
    vxt_label_map_release_staging(map.get());
    need(vxt_results_read(results.get(), answer.get()));
    const BatchAnswer found = answerOf(*answer);
    ASSERT_EQ(found.pairs.size(), 1U);
    EXPECT_EQ(found.pairs[0].count, 128U); // half of 16x16 pixels
    EXPECT_EQ(inconsistencyOf(found), "");
    EXPECT_EQ(found.contacts.size(), 128U);
    EXPECT_GT(found.gpuMilliseconds, 0);

    // The next pass finds the same on the device.
    vxt_buffer_range range{};
    need(vxt_results_on_device(results.get(), VXT_DEVICE_PAIRS, &range));
    EXPECT_EQ(range.size, sizeof(PairResult));
    const std::vector<std::byte> bytes = raw.readBuffer(range.buffer, range.offset + range.size);
    PairResult pair{};
    std::memcpy(&pair, bytes.data() + range.offset, sizeof pair);
    EXPECT_EQ(unpack(pair).count, 128U);
    for (const vxt_device_part part : {VXT_DEVICE_TRIANGLE_COUNTS, VXT_DEVICE_TRIANGLE_MASK, VXT_DEVICE_CONTACTS,
                                       VXT_DEVICE_BOUNDS, VXT_DEVICE_LABEL_COUNTS}) {
        need(vxt_results_on_device(results.get(), part, &range));
        EXPECT_NE(range.buffer, VK_NULL_HANDLE);
        EXPECT_GT(range.size, 0U);
        EXPECT_EQ(range.offset % 256, 0U);
    }
    need(vxt_results_on_device(results.get(), VXT_DEVICE_TRIANGLE_COUNTS, &range));
    const std::vector<std::byte> counts = raw.readBuffer(range.buffer, range.offset + range.size);
    std::uint32_t ofTriangles[2] = {};
    std::memcpy(ofTriangles, counts.data() + range.offset, sizeof ofTriangles);
    EXPECT_EQ(ofTriangles[0] + ofTriangles[1], 128U);
    EXPECT_EQ(vxt_results_on_device(results.get(), static_cast<vxt_device_part>(6), &range),
              VXT_ERROR_INVALID_ARGUMENT);
}

TEST_F(CGpuTest, ARingHasASlotForEachFrame) {
    const RandomScene scene = halfOpaque();
    const CScene sides(context_.get(), queue_, scene, twoLabels());
    COneItem of(sides, scene);
    const Owned<vxt_detector> detector = newDetector(vxt_detector_desc_init());
    const auto ring = made<vxt_result_ring>(
        vxt_result_ring_destroy, [&](auto out) { return vxt_result_ring_create(context_.get(), 2, nullptr, out); });
    RawVulkan raw(gpu().device);
    const Owned<vxt_answer> answer = newAnswer();
    EXPECT_EQ(vxt_result_ring_read(ring.get(), 0, answer.get()), VXT_ERROR_NOT_READY);
    for (std::uint64_t frame = 0; frame < 3; ++frame) {
        const Mat4 pose = translation({0.25 * static_cast<double>(frame), 0, 0});
        of.item.world_from_object = pose.data();
        vxt_results* slot = nullptr;
        need(vxt_result_ring_begin(ring.get(), frame, &slot));
        const VkCommandBuffer commands = raw.begin();
        need(vxt_detector_cmd_detect(detector.get(), commands, &of.batch, slot));
        need(vxt_results_cmd_read_back(slot, commands));
        raw.submitAndWait(commands);
        vxt_results_destroy(slot); // the ring's: nothing happens
        need(vxt_result_ring_read(ring.get(), frame, answer.get()));
        // Moved by a quarter of the cube: 4 of the 8 opaque columns, then none.
        EXPECT_EQ(answerOf(*answer).pairs.at(0).count, 128U - 64U * frame);
    }
    EXPECT_EQ(vxt_result_ring_read(ring.get(), 0, answer.get()), VXT_ERROR_NOT_READY);
    EXPECT_THAT(vxt_last_error(context_.get()), HasSubstr("taken by frame 2"));
    need(vxt_result_ring_read(ring.get(), 1, answer.get()));
    EXPECT_EQ(answerOf(*answer).pairs.at(0).count, 64U);
}

TEST_F(CGpuTest, EditsTakeEffectInTheOrderOfTheCommands) {
    const RandomScene scene = halfOpaque();
    const CScene sides(context_.get(), queue_, scene, twoLabels());
    const COneItem of(sides, scene);
    vxt_detector_desc desc = vxt_detector_desc_init();
    desc.method = VXT_METHOD_COMPUTE;
    desc.filter = VXT_FILTER_EXACT;
    const Owned<vxt_blocking_detector> detector = newBlocking(desc);
    RawVulkan raw(gpu().device);
    const auto edited = [&](auto record) {
        const VkCommandBuffer commands = raw.begin();
        record(commands);
        raw.submitAndWait(commands);
        return ask(*detector, of).pairs.at(0).count;
    };
    const std::uint64_t before = ask(*detector, of).pairs.at(0).count;
    EXPECT_EQ(before, 128U);
    const vxt_voxel_box right{{2, 0, 0}, {2, 4, 4}};
    EXPECT_EQ(edited([&](auto commands) { need(vxt_volume_cmd_set_box(sides.volume.get(), commands, &right, 255)); }),
              256U);
    const double centre[3] = {0.5, 0.5, 0.5};
    EXPECT_EQ(edited([&](auto commands) { need(vxt_volume_cmd_set_ball(sides.volume.get(), commands, centre, 9, 0)); }),
              0U);
    const std::vector<std::byte> opaque(32, std::byte{255});
    EXPECT_EQ(edited([&](auto commands) {
                  need(vxt_volume_cmd_write(sides.volume.get(), commands, &right, opaque.data(), opaque.size()));
              }),
              128U);
    const RawVulkan::HostBuffer source =
        raw.makeBuffer(std::span<const std::byte>(opaque), VK_BUFFER_USAGE_TRANSFER_SRC_BIT);
    const vxt_voxel_box left{{0, 0, 0}, {2, 4, 4}};
    EXPECT_EQ(edited([&](auto commands) {
                  need(vxt_volume_cmd_copy(sides.volume.get(), commands, &left, source.buffer, 0));
              }),
              256U);
    // A table under which nothing is opaque, and its domain.
    const vxt_control_point none[] = {{0, 0}, {1, 0}};
    vxt_transfer_function_desc table = vxt_transfer_function_desc_init();
    table.points = none;
    table.point_count = 2;
    table.domain = {0, 300};
    EXPECT_EQ(
        edited([&](auto commands) { need(vxt_transfer_function_cmd_update(sides.function.get(), commands, &table)); }),
        0U);
    vxt_range domain{};
    need(vxt_transfer_function_domain(sides.function.get(), &domain));
    EXPECT_EQ(domain.hi, 300);
}

TEST_F(CGpuTest, WrapsTheCallersObjects) {
    const RandomScene scene = halfOpaque();
    const CScene sides(context_.get(), queue_, scene, twoLabels());
    RawVulkan raw(gpu().device);
    vxt_wrapped_volume wrapped = vxt_wrapped_volume_init();
    wrapped.view = raw.makeImage(VK_IMAGE_TYPE_3D, VK_FORMAT_R8_UNORM, {4, 4, 4}, scene.volume.voxels,
                                 VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL);
    wrapped.format = VK_FORMAT_R8_UNORM;
    wrapped.grid = cGrid(scene.volume.grid);
    wrapped.bricks = 1;
    const auto volume =
        made<vxt_volume>(vxt_volume_destroy, [&](auto out) { return vxt_volume_wrap(context_.get(), &wrapped, out); });
    const std::vector<float> table = take(sampleTable(scene.transferFunction()));
    vxt_wrapped_transfer_function wrappedTable = vxt_wrapped_transfer_function_init();
    wrappedTable.view =
        raw.makeImage(VK_IMAGE_TYPE_1D, VK_FORMAT_R32_SFLOAT, {static_cast<std::uint32_t>(table.size()), 1, 1},
                      std::as_bytes(std::span(table)), VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL);
    wrappedTable.table = table.data();
    wrappedTable.table_size = table.size();
    const auto function = made<vxt_transfer_function>(vxt_transfer_function_destroy, [&](auto out) {
        return vxt_transfer_function_wrap(context_.get(), &wrappedTable, out);
    });
    vxt_wrapped_mesh wrappedMesh = vxt_wrapped_mesh_init();
    wrappedMesh.vertices =
        raw.makeBuffer(std::span<const float>(scene.mesh.positions), VK_BUFFER_USAGE_VERTEX_BUFFER_BIT).buffer;
    wrappedMesh.vertex_count = static_cast<std::uint32_t>(scene.mesh.positions.size() / 3);
    wrappedMesh.indices =
        raw.makeBuffer(std::span<const std::uint32_t>(scene.mesh.indices), VK_BUFFER_USAGE_INDEX_BUFFER_BIT).buffer;
    wrappedMesh.triangle_count = static_cast<std::uint32_t>(scene.mesh.indices.size() / 3);
    const auto mesh =
        made<vxt_mesh>(vxt_mesh_destroy, [&](auto out) { return vxt_mesh_wrap(context_.get(), &wrappedMesh, out); });
    const VkCommandBuffer commands = raw.begin();
    const vxt_voxel_box whole{{0, 0, 0}, {4, 4, 4}};
    need(vxt_volume_cmd_update_bricks(volume.get(), commands, &whole));
    raw.submitAndWait(commands);

    COneItem of(sides, scene);
    of.item.volume = volume.get();
    of.item.transfer_function = function.get();
    of.item.mesh = mesh.get();
    EXPECT_EQ(ask(*newBlocking(vxt_detector_desc_init()), of).pairs.at(0).count, 128U);
    EXPECT_EQ(vxt_mesh_triangles(mesh.get()), 2U);
    vxt_mesh_facts facts{};
    EXPECT_EQ(vxt_mesh_get_facts(mesh.get(), &facts), VXT_ERROR_NOT_READY);
    vxt_volume_info info = vxt_volume_info_init();
    need(vxt_volume_get_info(volume.get(), &info));
    EXPECT_EQ(info.has_range, 0U);
    EXPECT_EQ(info.view, wrapped.view);

    // What was uploaded is known.
    need(vxt_mesh_get_facts(sides.mesh.get(), &facts));
    EXPECT_EQ(facts.triangles, 2U);
    need(vxt_volume_get_info(sides.volume.get(), &info));
    EXPECT_EQ(info.has_range, 1U);
    EXPECT_EQ(info.range.hi, 255);
    EXPECT_EQ(info.format, VK_FORMAT_R8_UNORM);
    EXPECT_EQ(info.grid.size[2], 4U);
    std::size_t count = 0;
    const std::int32_t* labels = vxt_label_map_values(sides.labelMap.get(), &count);
    EXPECT_EQ(std::vector(labels, labels + count), (std::vector<std::int32_t>{0, 3}));
    // Voxels on the faces are opaque: clamping would count what is outside.
    vxt_boundary boundary = VXT_BOUNDARY_MAX;
    const Owned<vxt_detector> detector = newDetector(vxt_detector_desc_init());
    need(vxt_detector_boundary_for(detector.get(), &of.item, 0.5, &boundary));
    EXPECT_EQ(boundary, VXT_BOUNDARY_RANGE);
    of.item.volume = nullptr;
    EXPECT_EQ(vxt_detector_boundary_for(detector.get(), &of.item, 0.5, &boundary), VXT_ERROR_INVALID_ARGUMENT);
}

TEST_F(CGpuTest, AContextHasErrorsOfItsOwn) {
    const Owned<vxt_context> other = newContext();
    const RandomScene scene = halfOpaque();
    const CScene sides(context_.get(), queue_, scene, twoLabels());
    EXPECT_STREQ(vxt_last_error(context_.get()), "");
    std::thread elsewhere([&] {
        vxt_detector_desc desc = vxt_detector_desc_init();
        desc.method = VXT_METHOD_CPU;
        vxt_detector* detector = nullptr;
        EXPECT_EQ(vxt_detector_create(context_.get(), &desc, &detector), VXT_ERROR_INVALID_ARGUMENT);
    });
    elsewhere.join();
    EXPECT_THAT(vxt_last_error(context_.get()), HasSubstr("cpu"));
    EXPECT_STREQ(vxt_last_error(other.get()), "");
    // Of an object: its context's, which has ended here.
    vxt_volume* volume = nullptr;
    const vxt_volume_view empty = vxt_volume_view_init();
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
    const RandomScene scene = halfOpaque();
    const CScene sides(context_.get(), queue_, scene, twoLabels());
    const COneItem of(sides, scene);
    const Owned<vxt_blocking_detector> detector = newBlocking(vxt_detector_desc_init());
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
        const auto own =
            made<vxt_context>(vxt_context_destroy, [&](auto out) { return vxt_context_create(&desc, out); });
        const CScene sides(own.get(), queue_, halfOpaque(), twoLabels());
        EXPECT_GT(counting.given, 0);
    }
    EXPECT_EQ(counting.given, counting.returned);
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
    const auto tested =
        made<vxt_report>(vxt_report_destroy, [&](auto out) { return vxt_self_test(context_.get(), &queue_, out); });
    vxt_report_view view = vxt_report_view_init();
    need(vxt_report_get(tested.get(), &view));
    const std::vector<SelfTestVerdict> expected = take(selfTest(context(), queue()));
    ASSERT_EQ(view.method_count, expected.size());
    for (std::size_t i = 0; i < expected.size(); ++i) {
        EXPECT_EQ(view.methods[i].text, expected[i].text);
        EXPECT_EQ(view.methods[i].trusted != 0, expected[i].trusted);
        EXPECT_EQ(view.methods[i].available != 0, expected[i].available);
    }
    const auto measured = made<vxt_report>(vxt_report_destroy,
                                           [&](auto out) { return vxt_measure_methods(context_.get(), &queue_, out); });
    need(vxt_report_get(measured.get(), &view));
    ASSERT_EQ(view.method_count, expected.size());
    for (std::size_t i = 0; i < expected.size(); ++i) {
        EXPECT_EQ(view.methods[i].pairs_per_second > 0, expected[i].trusted);
    }
}

} // namespace
} // namespace voxtact::test
