// SPDX-License-Identifier: MIT
// What is near, by the Vulkan half of the C interface.
#include "c_fixture.h"

#include <gtest/gtest.h>

#include <iterator>
#include <limits>

namespace voxtact::test {
namespace {

/// What the projection `conservative` says of what is near.
class CNearTest : public CGpuTest {
  protected:
    void SetUp() override {
        CGpuTest::SetUp();
        if (!IsSkipped() && !HasFatalFailure() &&
            !context().supports(CountingMethod::Compute, Projection::Conservative)) {
            GTEST_SKIP() << "no conservative by compute on this device";
        }
    }
    static vxt_detector_desc yesOrNo() {
        vxt_detector_desc desc = vxt_detector_desc_init();
        desc.method = VXT_METHOD_COMPUTE;
        desc.projection = VXT_PROJECTION_CONSERVATIVE;
        desc.stop_at_first = 1;
        return desc;
    }
    /// What is opaque ends at x = 0.5, and at z = 1: one touches, the others are 0.2 and 0.4 away.
    static RandomScene threePoses() {
        RandomScene scene = halfOpaque();
        scene.poses = {identity(), translation({0.7, 0, 0}), translation({0, 0, 0.9})};
        return scene;
    }
};

TEST_F(CNearTest, DecidesWhatIsWithinAMargin) {
    const RandomScene scene = threePoses();
    const CScene sides(context_.get(), queue_, scene, twoLabels());
    const COneItem item(sides, scene);
    vxt_detector_desc desc = yesOrNo();
    EXPECT_EQ(desc.margin, 0);
    desc.margin = 0.3;
    const BatchAnswer answer = ask(*newBlocking(desc), item);
    ASSERT_EQ(answer.pairs.size(), 3U);
    EXPECT_TRUE(answer.pairs[0].hit);
    EXPECT_TRUE(answer.pairs[1].hit);                              // 0.2 away
    EXPECT_FALSE(answer.pairs[2].hit || answer.pairs[2].possible); // 0.4
    desc.stop_at_first = 0;
    vxt_detector* none = nullptr;
    EXPECT_EQ(vxt_detector_create(context_.get(), &desc, &none), VXT_ERROR_INVALID_ARGUMENT);
    EXPECT_EQ(none, nullptr);
}

TEST_F(CNearTest, DecidesWhatATolerancePermits) {
    const RandomScene scene = threePoses();
    const CScene sides(context_.get(), queue_, scene, twoLabels());
    const COneItem item(sides, scene);
    vxt_detector_desc desc = yesOrNo();
    EXPECT_EQ(desc.pose_angle, 0);
    EXPECT_EQ(desc.pose_distance, 0);
    for (const double angle : {0.0, 0.01}) { // of what is less than 2 away: less than 0.001
        desc.pose_distance = 0.3;
        desc.pose_angle = angle;
        const BatchAnswer answer = ask(*newBlocking(desc), item);
        ASSERT_EQ(answer.pairs.size(), 3U);
        EXPECT_TRUE(answer.pairs[0].hit);
        EXPECT_TRUE(answer.pairs[1].hit);                              // 0.2 away
        EXPECT_FALSE(answer.pairs[2].hit || answer.pairs[2].possible); // 0.4
    }
    desc.pose_distance = 0;
    desc.pose_angle = 180; // every pose is as near as anything of the mesh can be
    EXPECT_TRUE(ask(*newBlocking(desc), item).pairs[0].hit);
    vxt_detector* none = nullptr;
    desc.pose_angle = 181;
    EXPECT_EQ(vxt_detector_create(context_.get(), &desc, &none), VXT_ERROR_INVALID_ARGUMENT);
    desc.pose_angle = -1;
    EXPECT_EQ(vxt_detector_create(context_.get(), &desc, &none), VXT_ERROR_INVALID_ARGUMENT);
    EXPECT_EQ(none, nullptr);
}

TEST_F(CNearTest, LooksAlongTheWay) {
    RandomScene scene = halfOpaque(); // up to x = 0.5
    scene.poses = {translation({0.9, 0, 0}), translation({0.3, 0, 0}), translation({0.8, 0, 0})};
    const CScene sides(context_.get(), queue_, scene, twoLabels());
    const COneItem item(sides, scene);
    vxt_detector_desc desc = yesOrNo();
    EXPECT_EQ(desc.motion_resolution, 0);
    const Owned<vxt_answer> answer = newAnswer();
    const auto motions = made<vxt_motions>(vxt_motions_destroy, vxt_motions_create);
    vxt_motion_view view = vxt_motion_view_init();
    need(vxt_blocking_detector_detect(newBlocking(desc).get(), &item.batch, answer.get()));
    need(vxt_answer_motions(answer.get(), motions.get()));
    need(vxt_motions_get(motions.get(), &view));
    EXPECT_EQ(view.segment_count, 0U); // not asked
    desc.motion_resolution = 0.004;
    desc.motion_interpolation = VXT_INTERPOLATION_SLERP;
    need(vxt_blocking_detector_detect(newBlocking(desc).get(), &item.batch, answer.get()));
    need(vxt_answer_motions(answer.get(), motions.get()));
    need(vxt_motions_get(motions.get(), &view));
    ASSERT_EQ(view.segment_count, 2U);
    const double wanted = (0.9 - 0.5) / (0.9 - 0.3);
    EXPECT_LE(view.segments[0].free_until, wanted + 0.002); // an entry of the table is a part of a voxel
    EXPECT_GE(view.segments[0].touch_at, wanted - 0.002);
    EXPECT_LE(view.segments[0].touch_at - view.segments[0].free_until, 0.004 / 0.6);
    EXPECT_EQ(view.segments[0].end, VXT_MOTION_DECIDED);
    EXPECT_EQ(view.segments[0].touches, 1U);
    EXPECT_NEAR(view.segments[0].position[0], 0.5, 0.01);
    EXPECT_NEAR(view.segments[0].world_from_object[12], 0.9 - 0.6 * view.segments[0].touch_at, 1e-12);
    EXPECT_EQ(view.segments[1].pose, 1U);
    EXPECT_EQ(view.segments[1].touch_at, 0);
    vxt_detector* none = nullptr;
    desc.motion_resolution = -1;
    EXPECT_EQ(vxt_detector_create(context_.get(), &desc, &none), VXT_ERROR_INVALID_ARGUMENT);
    EXPECT_EQ(none, nullptr);
    vxt_results_desc room = vxt_results_desc_init();
    room.max_pairs = 3;
    for (const std::uint32_t some : {0U, 1U}) {
        room.motions = some;
        const Owned<vxt_results> results = newResults(room);
        vxt_buffer_range range{};
        need(vxt_results_on_device(results.get(), VXT_DEVICE_MOTIONS, &range));
        EXPECT_EQ(range.size, some * 96U);
    }
}

TEST_F(CNearTest, MeasuresHowNear) {
    const RandomScene scene = threePoses();
    const CScene sides(context_.get(), queue_, scene, twoLabels());
    const COneItem item(sides, scene);
    vxt_detector_desc desc = yesOrNo();
    EXPECT_EQ(desc.clearance_tolerance, 0);
    const Owned<vxt_answer> answer = newAnswer();
    const auto clearances = made<vxt_clearances>(vxt_clearances_destroy, vxt_clearances_create);
    need(vxt_blocking_detector_detect(newBlocking(desc).get(), &item.batch, answer.get()));
    EXPECT_EQ(vxt_answer_clearances(answer.get(), clearances.get()), VXT_ERROR_NOT_READY);
    desc.clearance_tolerance = 0.002;
    desc.max_clearance = 0.3;
    need(vxt_blocking_detector_detect(newBlocking(desc).get(), &item.batch, answer.get()));
    need(vxt_answer_clearances(answer.get(), clearances.get()));
    vxt_clearance_view view = vxt_clearance_view_init();
    need(vxt_clearances_get(clearances.get(), &view));
    ASSERT_EQ(view.pair_count, 3U);
    EXPECT_EQ(view.label_count, 0U);
    EXPECT_EQ(view.pairs[0].hi, 0);
    EXPECT_LE(view.pairs[1].lo, 0.2 + 0.001); // an entry of the table is a part of a voxel
    EXPECT_GE(view.pairs[1].hi, 0.2 - 0.001);
    EXPECT_LE(view.pairs[1].hi - view.pairs[1].lo, 0.002);
    EXPECT_EQ(view.pairs[1].end, VXT_CLEARANCE_CLOSED);
    EXPECT_EQ(view.pairs[1].has_closest, 0U);
    EXPECT_EQ(view.pairs[2].lo, 0.3); // 0.4 away
    EXPECT_EQ(view.pairs[2].end, VXT_CLEARANCE_BEYOND);
    EXPECT_EQ(view.pairs[2].pose, 2U);
    desc.closest = 1;
    need(vxt_blocking_detector_detect(newBlocking(desc).get(), &item.batch, answer.get()));
    need(vxt_answer_clearances(answer.get(), clearances.get()));
    need(vxt_clearances_get(clearances.get(), &view));
    EXPECT_EQ(view.pairs[0].has_closest, 1U); // it touches
    EXPECT_EQ(view.pairs[0].mesh[0], view.pairs[0].volume[0]);
    ASSERT_EQ(view.pairs[1].has_closest, 1U);
    EXPECT_NEAR(view.pairs[1].mesh[0] - view.pairs[1].volume[0], 0.2, 0.003);
    EXPECT_NEAR(view.pairs[1].volume[0], 0.5, 0.003);
    EXPECT_GT(view.pairs[1].per_translation[0], 0.98);
    EXPECT_EQ(view.pairs[2].has_closest, 0U);
    desc.clearance_tolerance = 0;
    desc.max_clearance = 0;
    vxt_detector* none = nullptr;
    EXPECT_EQ(vxt_detector_create(context_.get(), &desc, &none), VXT_ERROR_INVALID_ARGUMENT)
        << "closest points of none";
    desc.closest = 0;
    desc.max_clearance = 0.3;
    EXPECT_EQ(vxt_detector_create(context_.get(), &desc, &none), VXT_ERROR_INVALID_ARGUMENT);
    EXPECT_EQ(none, nullptr);

    vxt_results_desc room = vxt_results_desc_init();
    room.max_pairs = 3;
    for (const std::uint32_t wanted : {0U, 1U}) {
        room.clearances = wanted;
        const Owned<vxt_results> results = newResults(room);
        vxt_buffer_range range{};
        need(vxt_results_on_device(results.get(), VXT_DEVICE_CLEARANCES, &range));
        EXPECT_EQ(range.size, wanted * 48U);
        room.closest = wanted;
        const Owned<vxt_results> both = newResults(room);
        need(vxt_results_on_device(both.get(), VXT_DEVICE_CLOSEST, &range));
        EXPECT_EQ(range.size, wanted * 3 * 48U);
    }
}

TEST_F(CNearTest, MeasuresHowNearLabelsAre) {
    RandomScene scene = halfOpaque(); // up to x = 0.5; the map has the label 0 up to there, and 3 beyond
    scene.poses = {translation({0.7, 0, 0})};
    const CScene sides(context_.get(), queue_, scene,
                       makeBytes(scene.volume.grid, [](std::uint32_t x, auto, auto) { return x < 3 ? 0.0 : 3.0; }));
    COneItem item(sides, scene);
    const std::int32_t labels[] = {3, 0, 5};
    item.batch.labels = labels;
    item.batch.label_count = std::size(labels);
    vxt_detector_desc desc = yesOrNo();
    EXPECT_EQ(desc.label_clearances, 0U);
    desc.label_clearances = 1;
    vxt_detector* none = nullptr;
    EXPECT_EQ(vxt_detector_create(context_.get(), &desc, &none), VXT_ERROR_INVALID_ARGUMENT);
    EXPECT_EQ(none, nullptr);
    desc.clearance_tolerance = 0.002;
    const Owned<vxt_answer> answer = newAnswer();
    const auto clearances = made<vxt_clearances>(vxt_clearances_destroy, vxt_clearances_create);
    vxt_clearance_view view = vxt_clearance_view_init();
    for (const bool any : {false, true}) {
        desc.labels_at_any_opacity = any ? 1 : 0;
        need(vxt_blocking_detector_detect(newBlocking(desc).get(), &item.batch, answer.get()));
        need(vxt_answer_clearances(answer.get(), clearances.get()));
        need(vxt_clearances_get(clearances.get(), &view));
        EXPECT_EQ(view.pair_count, 1U);
        ASSERT_EQ(view.label_count, 3U);
        EXPECT_EQ(view.labels[0].label, 3);
        // What of it is opaque is the border at 0.5; all of it is touched.
        EXPECT_LE(view.labels[0].lo, any ? 0 : 0.201);
        EXPECT_LE(view.labels[0].hi, any ? 0.001 : std::numeric_limits<double>::infinity());
        EXPECT_LE(view.labels[1].lo, 0.201);
        EXPECT_GE(view.labels[1].hi, 0.199);
        EXPECT_LE(view.labels[1].hi - view.labels[1].lo, 0.002);
        EXPECT_EQ(view.labels[1].end, VXT_CLEARANCE_CLOSED);
        EXPECT_EQ(view.labels[2].label, 5);
        EXPECT_EQ(view.labels[2].lo, std::numeric_limits<double>::infinity());
    }
    item.batch.labels = nullptr;
    EXPECT_EQ(vxt_blocking_detector_detect(newBlocking(desc).get(), &item.batch, answer.get()),
              VXT_ERROR_INVALID_ARGUMENT);

    vxt_results_desc room = vxt_results_desc_init();
    room.max_pairs = 3;
    room.clearances = 1;
    room.label_clearances = 2;
    vxt_buffer_range range{};
    need(vxt_results_on_device(newResults(room).get(), VXT_DEVICE_LABEL_CLEARANCES, &range));
    EXPECT_EQ(range.size, 3U * 2 * 16);
}

} // namespace
} // namespace voxtact::test
