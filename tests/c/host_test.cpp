// SPDX-License-Identifier: MIT
// The host engine through the C interface: the C++ interface's answers, every one of them.
#include "both_interfaces.h"
#include "cpu/scenes/random_scene.h"
#include "support/c_calls.h"
#include "support/contact_scenes.h"
#include "support/scenes.h"
#include "voxtact/cpu.h"

#include <gmock/gmock.h>

#include <cstdint>
#include <cstring>
#include <iostream>
#include <thread>

namespace voxtact::test {
namespace {

Owned<vxt_host_detector> detectorOf(const vxt_host_detector_desc& desc) {
    return made<vxt_host_detector>(vxt_host_detector_destroy,
                                   [&](auto out) { return vxt_host_detector_create(&desc, out); });
}

constexpr Outputs kAll{.triangles = true, .contacts = true, .bounds = true, .labels = true, .maxDepth = 3};

/// Detectors for a projection, with outputs or without.
struct Detectors {
    cpu::Detector cpp;
    Owned<vxt_host_detector> c;

    Detectors(Projection projection, bool outputs)
        : cpp(take(cpu::Detector::create({.boundary = Boundary::Range,
                                          .projection = projection,
                                          .outputs = outputs ? kAll : Outputs{},
                                          .samplesPerVoxel = 2,
                                          .resolution = 1.0 / 8,
                                          .mostContacts = 500}))),
          c(detectorOf(desc(projection, outputs))) {}

    static vxt_host_detector_desc desc(Projection projection, bool outputs) {
        vxt_host_detector_desc out = vxt_host_detector_desc_init();
        out.boundary = VXT_BOUNDARY_RANGE;
        out.projection = static_cast<vxt_projection>(projection);
        out.outputs = outputs ? cOutputs(kAll) : 0;
        out.max_depth = outputs ? kAll.maxDepth : kDefaultMaxDepth;
        out.samples_per_voxel = 2;
        out.resolution = 1.0 / 8;
        out.most_contacts = 500;
        return out;
    }
};

TEST(CHost, AnswersAsTheCppInterfaceDoesInEveryProjection) {
    std::mt19937_64 random(testSeed());
    for (const Projection projection : projections()) {
        Detectors counts(projection, false);
        Detectors outputs(projection, true);
        std::uint64_t survivors = 0;
        std::size_t contacts = 0;
        for (int round = 0; (round < 6 || contacts < 300) && round < 100 && !HasFailure(); ++round) {
            const std::uint64_t seed = random();
            std::mt19937_64 local(seed);
            RandomScene scene = makeRandomScene(local, 4);
            scene.view.width = std::min(scene.view.width, 100U);
            scene.view.height = std::min(scene.view.height, 100U);
            const BothInterfaces both(scene, makeLabelImage(local, scene.volume.grid));
            const BatchAnswer plain = both.byC(*counts.c, scene);
            EXPECT_EQ(wholeDifferenceOf(plain, both.byCpp(counts.cpp, scene)), "") << "scene " << seed;
            const BatchAnswer whole = both.byC(*outputs.c, scene);
            const BatchAnswer expected = both.byCpp(outputs.cpp, scene);
            // A list that is cut is cut arbitrarily.
            if (expected.contactsFound <= 500) {
                EXPECT_EQ(wholeDifferenceOf(whole, expected), "") << "scene " << seed;
            } else {
                EXPECT_EQ(whole.contactsFound, expected.contactsFound);
                EXPECT_EQ(whole.contacts.size(), 500U);
            }
            contacts += whole.contacts.size();
            for (const PairAnswer& pair : plain.pairs) {
                survivors += pair.count;
            }
        }
        std::cout << toString(projection) << ": " << survivors << " survivors, " << contacts << " contacts\n";
        EXPECT_GE(contacts, 300U);
    }
}

/// The scene of embed.c's plate: 32 by 16 pixels of a square at z = 0.5, in a volume that is opaque up to x = 0.5.
class CHostEdit : public testing::Test {
  protected:
    CHostEdit() {
        scene_.volume = makeBytes(unitGrid(4), [](std::uint32_t x, auto, auto) { return x < 2 ? 255.0 : 0.0; });
        scene_.points = {{127, 0}, {127, 1}};
        scene_.domain = {0, 255};
        scene_.tableSize = 2;
        scene_.mesh = makeFlat(0, 1, 0, 1, 0.5);
        scene_.view = flatView(0, 1, 16, 16);
        scene_.poses = {identity()};
        scene_.threshold = 0.5;
        both_.emplace(scene_, makeLabelImage(random_, scene_.volume.grid));
    }
    [[nodiscard]] BatchAnswer byC() { return both_->byC(*detector_, scene_); }
    [[nodiscard]] BatchAnswer byCpp() { return both_->byCpp(cpp_, scene_); }

    std::mt19937_64 random_{testSeed()};
    RandomScene scene_;
    std::optional<BothInterfaces> both_;
    Owned<vxt_host_detector> detector_ = detectorOf(vxt_host_detector_desc_init());
    cpu::Detector cpp_ = take(cpu::Detector::create());
};

TEST_F(CHostEdit, EditsAreSeenByTheNextAnswer) {
    const std::uint64_t before = byC().pairs[0].count;
    EXPECT_EQ(before, byCpp().pairs[0].count);
    EXPECT_GT(before, 0U);

    const vxt_voxel_box box{{2, 0, 0}, {2, 4, 4}};
    need(vxt_host_volume_set_box(both_->cVolumeHandle.get(), &box, 255));
    EXPECT_EQ(byC().pairs[0].count, 256U); // all opaque: every pixel
    take(both_->volume.set(VoxelBox{{2, 0, 0}, {2, 4, 4}}, 255));
    EXPECT_EQ(wholeDifferenceOf(byC(), byCpp()), "");

    const double centre[3] = {0.5, 0.5, 0.5};
    need(vxt_host_volume_set_ball(both_->cVolumeHandle.get(), centre, 0.3, 0));
    take(both_->volume.set(Ball{{0.5, 0.5, 0.5}, 0.3}, 0));
    EXPECT_LT(byC().pairs[0].count, 256U);
    EXPECT_EQ(wholeDifferenceOf(byC(), byCpp()), "");

    const std::vector<std::byte> none(64, std::byte{0});
    const vxt_voxel_box whole{{0, 0, 0}, {4, 4, 4}};
    need(vxt_host_volume_write(both_->cVolumeHandle.get(), &whole, none.data(), none.size()));
    EXPECT_EQ(byC().pairs[0].count, 0U);
    EXPECT_EQ(vxt_host_volume_write(both_->cVolumeHandle.get(), &whole, none.data(), 63), VXT_ERROR_INVALID_ARGUMENT);
    EXPECT_EQ(vxt_host_volume_set_box(both_->cVolumeHandle.get(), &box, 256), VXT_ERROR_INVALID_ARGUMENT);
}

TEST_F(CHostEdit, ABentMeshIsSeenByTheNextAnswer) {
    std::vector<float> positions = scene_.mesh.positions;
    for (std::size_t at = 0; at < positions.size(); at += 3) {
        positions[at] *= 0.3F;
    }
    const std::uint64_t before = byC().pairs[0].count;
    need(vxt_host_mesh_update(both_->cMeshHandle.get(), positions.data(), positions.size() / 3));
    take(both_->mesh.update(positions));
    EXPECT_NE(byC().pairs[0].count, before);
    EXPECT_EQ(wholeDifferenceOf(byC(), byCpp()), "");
    EXPECT_EQ(vxt_host_mesh_update(both_->cMeshHandle.get(), positions.data(), 3), VXT_ERROR_INVALID_ARGUMENT);
    EXPECT_EQ(vxt_host_mesh_update(both_->cMeshHandle.get(), nullptr, 4), VXT_ERROR_INVALID_ARGUMENT);
    EXPECT_EQ(vxt_host_mesh_update(both_->cMeshHandle.get(), positions.data(), SIZE_MAX / 3 + 2),
              VXT_ERROR_INVALID_ARGUMENT);
    EXPECT_THAT(vxt_last_error(nullptr), testing::HasSubstr("are too many"));
    EXPECT_EQ(vxt_host_mesh_update(nullptr, positions.data(), 4), VXT_ERROR_INVALID_ARGUMENT);
    EXPECT_EQ(wholeDifferenceOf(byC(), byCpp()), "");
}

TEST_F(CHostEdit, AFailureLeavesTheAnswerAsItWas) {
    const Owned<vxt_answer> answer = newAnswer();
    vxt_host_item item = vxt_host_item_init();
    item.mesh = both_->cMeshHandle.get();
    item.volume = both_->cVolumeHandle.get();
    item.transfer_function = both_->cFunctionHandle.get();
    item.world_from_object = scene_.poses[0].data();
    item.pose_count = 1;
    const vxt_view view = cView(scene_.view);
    vxt_host_batch batch = vxt_host_batch_init();
    batch.items = &item;
    batch.item_count = 1;
    batch.view = &view;
    need(vxt_host_detector_detect(detector_.get(), &batch, answer.get()));
    const BatchAnswer before = answerOf(*answer);
    item.mesh = nullptr;
    EXPECT_EQ(vxt_host_detector_detect(detector_.get(), &batch, answer.get()), VXT_ERROR_INVALID_ARGUMENT);
    EXPECT_NE(std::string(vxt_last_error(nullptr)).find("mesh"), std::string::npos) << vxt_last_error(nullptr);
    EXPECT_EQ(wholeDifferenceOf(answerOf(*answer), before), "");
    // No camera where the projection has one.
    item.mesh = both_->cMeshHandle.get();
    batch.view = nullptr;
    EXPECT_EQ(vxt_host_detector_detect(detector_.get(), &batch, answer.get()), VXT_ERROR_INVALID_ARGUMENT);
    // And none is needed where it has not.
    vxt_host_detector_desc desc = vxt_host_detector_desc_init();
    desc.projection = VXT_PROJECTION_CONSERVATIVE;
    need(vxt_host_detector_detect(detectorOf(desc).get(), &batch, answer.get()));
    EXPECT_EQ(answerOf(*answer).pairs.size(), 1U);
}

TEST_F(CHostEdit, ThreadsHaveErrorsOfTheirOwn) {
    ASSERT_NE(vxt_host_mesh_create(nullptr, nullptr), VXT_OK);
    const std::string here = vxt_last_error(nullptr);
    std::string before;
    std::string after;
    std::thread other([&] {
        before = vxt_last_error(nullptr);
        vxt_volume_data* data = nullptr;
        if (vxt_builtin_volume("nothing", &data) != VXT_OK) {
            after = vxt_last_error(nullptr);
        }
    });
    other.join();
    EXPECT_EQ(before, "");
    EXPECT_NE(after.find("nothing"), std::string::npos) << after;
    EXPECT_EQ(vxt_last_error(nullptr), here);
    EXPECT_EQ(vxt_last_vk_result(nullptr), 0);
}

TEST_F(CHostEdit, DetectorsRunSideBySide) {
    const BatchAnswer expected = byC();
    std::vector<std::thread> threads;
    std::vector<std::string> differences(4, "not run");
    for (std::string& difference : differences) {
        threads.emplace_back([&] {
            vxt_host_detector_desc desc = vxt_host_detector_desc_init();
            desc.threads = 1;
            const Owned<vxt_host_detector> own = detectorOf(desc);
            difference = "";
            for (int i = 0; i < 50; ++i) {
                difference += wholeDifferenceOf(both_->byC(*own, scene_), expected);
            }
        });
    }
    for (std::thread& thread : threads) {
        thread.join();
    }
    for (const std::string& difference : differences) {
        EXPECT_EQ(difference, "");
    }
}

TEST(CHost, ADetectorSaysHowManyThreadsItHas) {
    vxt_host_detector_desc desc = vxt_host_detector_desc_init();
    desc.threads = 3;
    EXPECT_EQ(vxt_host_detector_threads(detectorOf(desc).get()), 3U);
}

} // namespace
} // namespace voxtact::test
