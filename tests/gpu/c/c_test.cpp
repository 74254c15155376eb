// SPDX-License-Identifier: MIT
// The Vulkan half of the C interface, on the device: the C++ interface's answers by every method and projection, and
// each function that records.
#include "c_fixture.h"

#include "raw_vulkan.h"
#include "support/contact_scenes.h"
#include "voxtact/cpu.h"

#include <gmock/gmock.h>

#include <cstring>
#include <iostream>

namespace voxtact::test {
namespace {

using testing::HasSubstr;

constexpr Outputs kAll{.triangles = true, .contacts = true, .bounds = true, .labels = true, .maxDepth = 3};

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
    const auto report = made(vxt_report_destroy, vxt_check, &desc);
    vxt_report_view view = sized<vxt_report_view>();
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
    cpu::HostEngine host = take(cpu::HostEngine::create());
    for (int tries = 0; tries < 500; ++tries) {
        RandomScene scene = makeRandomSceneForC(random, 4);
        scene.view.width = std::min(scene.view.width, 64U);
        scene.view.height = std::min(scene.view.height, 64U);
        const cpu::Mesh mesh = take(cpu::Mesh::create(scene.mesh.view()));
        const cpu::Volume volume = take(cpu::Volume::create(scene.volume.view()));
        const auto function = take(cpu::TransferFunction::create(scene.transferFunction()));
        const cpu::BatchItem item{&mesh, &volume, &function, scene.poses};
        std::uint64_t survivors = 0;
        const cpu::Batch batch{.items = {&item, 1}, .view = scene.view, .threshold = scene.threshold};
        for (const PairAnswer& pair : take(host.ask(Count{.projection = projection}, batch)).pairs) {
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
        // lavapipe takes half a minute for a random scene in the projection certified.
        RandomScene scene = halfOpaque();
        if (projection == Projection::Certified) {
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
            const bool outputs = method == CountingMethod::Query || projection == Projection::Certified;
            const Outputs wanted = outputs ? kAll : Outputs{};
            vxt_certified_desc certified = sized<vxt_certified_desc>();
            certified.outputs = cOutputs(wanted);
            certified.max_depth = wanted.maxDepth;
            certified.resolution = 1.0 / 8;
            vxt_raster_desc raster = sized<vxt_raster_desc>();
            raster.method = static_cast<vxt_method>(method);
            raster.projection = static_cast<vxt_projection>(projection);
            raster.filter = vxt_default_filter(raster.method);
            raster.boundary = VXT_BOUNDARY_RANGE;
            raster.outputs = cOutputs(wanted);
            raster.max_depth = wanted.maxDepth;
            BlockingDetector cpp = take(BlockingDetector::create(context(),
                                                                 AnyDesc{.method = method,
                                                                         .projection = projection,
                                                                         .filter = defaultFilter(method),
                                                                         .boundary = Boundary::Range,
                                                                         .outputs = wanted,
                                                                         .resolution = 1.0 / 8},
                                                                 queue(), kMany));
            const BatchAnswer answer =
                ask(*(projection == Projection::Certified ? newBlocking(certified) : newBlocking(raster)), cItem);
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

TEST_F(CGpuTest, CountsWhatThePassesOfCertifiedDo) {
    if (!context().supports(CountingMethod::Compute, Projection::Certified)) {
        GTEST_SKIP() << "no certified by compute on this device";
    }
    RandomScene scene = halfOpaque();
    scene.poses.push_back(translation({0.3, 0.1, 0.2}));
    const CScene sides(context_.get(), queue_, scene, twoLabels());
    const COneItem item(sides, scene);
    vxt_certified_desc desc = sized<vxt_certified_desc>();
    const Owned<vxt_answer> answer = newAnswer();
    vxt_certified_counters counters = sized<vxt_certified_counters>();
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
    EXPECT_EQ(counters.peak_tests, counters.bricks_seen + counters.cells_seen);
}

TEST_F(CGpuTest, ResultsHaveTheQueuesThatAreAskedFor) {
    if (!context().supports(CountingMethod::Compute, Projection::Certified)) {
        GTEST_SKIP() << "no certified by compute on this device";
    }
    const RandomScene scene = halfOpaque();
    const CScene sides(context_.get(), queue_, scene, twoLabels());
    const COneItem item(sides, scene);
    RawVulkan raw(gpu().device);
    vxt_certified_desc desc = sized<vxt_certified_desc>();
    desc.counters = 1;
    const Owned<vxt_detector> detector = newDetector(desc);
    vxt_results_desc resultsDesc = sized<vxt_results_desc>();
    vxt_results* none = nullptr;
    resultsDesc.clusters_at_once = 15;
    EXPECT_EQ(vxt_results_create(detector.get(), &resultsDesc, &none), VXT_ERROR_INVALID_ARGUMENT);
    const Owned<vxt_detector> raster = newDetector(sized<vxt_raster_desc>());
    const Owned<vxt_results> without = newResults(*raster, sized<vxt_results_desc>());
    resultsDesc.clusters_at_once = 32;
    const Owned<vxt_results> with = newResults(*detector, resultsDesc);
    const VkCommandBuffer commands = raw.begin();
    EXPECT_EQ(vxt_detector_cmd_detect(detector.get(), commands, &item.batch, without.get()),
              VXT_ERROR_INVALID_ARGUMENT);
    need(vxt_detector_cmd_detect(detector.get(), commands, &item.batch, with.get()));
    need(vxt_results_cmd_read_back(with.get(), commands));
    raw.submitAndWait(commands);
    const Owned<vxt_answer> answer = newAnswer();
    need(vxt_results_read(with.get(), answer.get()));
    vxt_certified_counters counters = sized<vxt_certified_counters>();
    need(vxt_answer_counters(answer.get(), &counters));
    EXPECT_EQ(counters.room, 32U);
}

TEST_F(CGpuTest, RecordsIntoTheCallersCommandBuffer) {
    const RandomScene scene = halfOpaque();
    RawVulkan raw(gpu().device);
    // Made and uploaded in two steps.
    const auto volume = made(vxt_volume_destroy, vxt_volume_create, context_.get(), at(cVolume(scene.volume)), nullptr);
    const auto function = made(vxt_transfer_function_destroy, vxt_transfer_function_create, context_.get(),
                               at(cFunction(cPoints(scene.points), scene.domain, scene.tableSize)), nullptr);
    const auto mesh = made(vxt_mesh_destroy, vxt_mesh_create, context_.get(), at(cMesh(scene.mesh)), nullptr);
    const auto labels = made(vxt_labels_destroy, vxt_labels_create, at(cVolume(twoLabels())));
    const auto map = made(vxt_label_map_destroy, vxt_label_map_create, context_.get(), labels.get(), "map");
    vxt_raster_desc desc = sized<vxt_raster_desc>();
    desc.outputs = cOutputs(kAll);
    const Owned<vxt_detector> detector = newDetector(desc);
    vxt_results_desc resultsDesc = sized<vxt_results_desc>();
    resultsDesc.triangle_room = 2;
    resultsDesc.label_room = 2;
    resultsDesc.timestamps = 1;
    resultsDesc.queue_family = queue_.family;
    const Owned<vxt_results> results = newResults(*detector, resultsDesc);

    const VkCommandBuffer commands = raw.begin();
    need(vxt_volume_cmd_upload(volume.get(), commands));
    need(vxt_transfer_function_cmd_upload(function.get(), commands));
    need(vxt_mesh_cmd_upload(mesh.get(), commands));
    need(vxt_label_map_cmd_upload(map.get(), commands));
    const COneItem of(mesh.get(), volume.get(), function.get(), map.get(), scene);
    need(vxt_detector_cmd_detect(detector.get(), commands, &of.batch, results.get()));
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
    EXPECT_EQ(vxt_results_on_device(results.get(), VXT_DEVICE_MAX, &range), VXT_ERROR_INVALID_ARGUMENT);
}

TEST_F(CGpuTest, AnswersGoIntoTheCallersBuffer) {
    EXPECT_EQ(vxt_result_bytes(11), resultBytes(11));
    const RandomScene scene = halfOpaque();
    const CScene sides(context_.get(), queue_, scene, twoLabels());
    COneItem of(sides, scene);
    const Owned<vxt_detector> detector = newDetector(sized<vxt_raster_desc>());
    RawVulkan raw(gpu().device);
    const std::vector<std::byte> untouched(1024, std::byte{0xcd});
    const RawVulkan::HostBuffer mine =
        raw.makeBuffer(std::span(untouched), VK_BUFFER_USAGE_STORAGE_BUFFER_BIT | VK_BUFFER_USAGE_TRANSFER_SRC_BIT |
                                                 VK_BUFFER_USAGE_TRANSFER_DST_BIT);
    vxt_results_desc desc = sized<vxt_results_desc>();
    desc.into = {mine.buffer, 512, sizeof(PairResult) - 1};
    vxt_results* none = nullptr;
    EXPECT_EQ(vxt_results_create(detector.get(), &desc, &none), VXT_ERROR_INVALID_ARGUMENT);
    EXPECT_STREQ(vxt_last_error(context_.get()), "ResultsDesc::into has 23 bytes, 1 pairs need 24");
    desc.into.size = 512;
    const Owned<vxt_results> results = newResults(*detector, desc);
    vxt_buffer_range range{};
    need(vxt_results_on_device(results.get(), VXT_DEVICE_PAIRS, &range));
    EXPECT_EQ(range.buffer, mine.buffer);
    EXPECT_EQ(range.offset, 512U);
    EXPECT_EQ(range.size, sizeof(PairResult));
    const VkCommandBuffer commands = raw.begin();
    need(vxt_detector_cmd_detect(detector.get(), commands, &of.batch, results.get()));
    raw.submitAndWait(commands);
    const std::vector<std::byte> bytes = raw.readBuffer(mine.buffer, 1024);
    PairResult pair{};
    std::memcpy(&pair, bytes.data() + range.offset, sizeof pair);
    EXPECT_EQ(unpack(pair).count, 128U);
    EXPECT_TRUE(std::equal(bytes.begin(), bytes.begin() + 512, untouched.begin()));
    EXPECT_TRUE(std::equal(bytes.begin() + 512 + sizeof pair, bytes.end(), untouched.begin()));
}

TEST_F(CGpuTest, ItemsOfALaterHeaderStandFartherApart) {
    struct Newer {
        vxt_item known = sized<vxt_item>();
        std::uint64_t added = 0;
    };
    const RandomScene scene = halfOpaque();
    const CScene sides(context_.get(), queue_, scene, twoLabels());
    COneItem of(sides, scene);
    const Mat4 poses[] = {identity(), translation({100, 0, 0})};
    Newer items[2];
    for (std::size_t i = 0; i < 2; ++i) {
        items[i].known = of.item;
        items[i].known.struct_size = sizeof items[i];
        items[i].known.world_from_object = poses[i].data();
    }
    of.batch.items = &items[0].known;
    of.batch.item_count = 2;
    const Owned<vxt_blocking_detector> detector = newBlocking(sized<vxt_raster_desc>());
    const BatchAnswer both = ask(*detector, of);
    ASSERT_EQ(both.pairs.size(), 2U);
    EXPECT_EQ(both.pairs[0].count, 128U);
    EXPECT_EQ(both.pairs[1].count, 0U); // 100 mm beside it
    const Owned<vxt_answer> answer = newAnswer();
    const auto refused = [&](vxt_result expected) {
        EXPECT_EQ(vxt_blocking_detector_detect(detector.get(), &of.batch, answer.get()), expected);
        return std::string(vxt_last_error(nullptr));
    };
    items[1].known.struct_size = sizeof(vxt_item);
    EXPECT_THAT(refused(VXT_ERROR_INVALID_ARGUMENT), HasSubstr("item 1: struct_size"));
    items[1].known.struct_size = sizeof items[1];
    items[1].added = 1;
    EXPECT_THAT(refused(VXT_ERROR_UNSUPPORTED), HasSubstr("item 1 has members that are set"));
}

TEST_F(CGpuTest, ARingHasASlotForEachFrame) {
    const RandomScene scene = halfOpaque();
    const CScene sides(context_.get(), queue_, scene, twoLabels());
    COneItem of(sides, scene);
    const Owned<vxt_detector> detector = newDetector(sized<vxt_raster_desc>());
    const auto ring = made(vxt_result_ring_destroy, vxt_result_ring_create, detector.get(), 2, nullptr);
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

} // namespace
} // namespace voxtact::test
