// SPDX-License-Identifier: MIT
// Plans through the C interface: the C++ interface's answers, every member of them.
#include "both_interfaces.h"
#include "support/scenes.h"

#include <gmock/gmock.h>

#include <cmath>
#include <iostream>

namespace voxtact::test {
namespace {

using testing::ElementsAreArray;
using testing::HasSubstr;

constexpr std::uint32_t kSide = 24;

Owned<vxt_plan> newPlan() {
    return made<vxt_plan>(vxt_plan_destroy, [](auto out) { return vxt_plan_create(out); });
}

vxt_plan_view viewOf(const vxt_plan& plan) {
    vxt_plan_view view = vxt_plan_view_init();
    need(vxt_plan_get(&plan, &view));
    return view;
}

void expectSame(const vxt_planned_path& c, const PlannedPath& cpp) {
    EXPECT_EQ(c.entry, cpp.entry);
    EXPECT_THAT(c.position, ElementsAreArray(cpp.position));
    EXPECT_EQ(c.length, cpp.length);
    EXPECT_EQ(c.has_angle != 0, cpp.angle.has_value());
    EXPECT_EQ(c.angle, cpp.angle.value_or(0));
    EXPECT_STREQ(vxt_safety_name(c.safety), toString(cpp.safety));
    EXPECT_EQ(c.lo, cpp.clearance.lo);
    EXPECT_EQ(c.hi, cpp.clearance.hi);
    EXPECT_STREQ(vxt_clearance_end_name(c.end), toString(cpp.end));
    EXPECT_EQ(c.has_nearest != 0, cpp.nearest.has_value());
    const NearestObstacle nearest = cpp.nearest.value_or(NearestObstacle());
    EXPECT_EQ(c.obstacle, nearest.obstacle);
    EXPECT_EQ(c.label, nearest.label);
    EXPECT_THAT(c.nearest, ElementsAreArray(nearest.position));
    EXPECT_THAT(c.on_path, ElementsAreArray(nearest.onPath));
    EXPECT_EQ(c.reserved, 0U);
}

/// How often each was seen.
struct PlanTally {
    std::size_t safe = 0;
    std::size_t unsafe = 0;
    std::size_t safeTriangles = 0;
    std::size_t clearTriangles = 0;
    std::size_t leftOut = 0;
};

void expectSame(const vxt_plan_view& c, const PlanAnswer& cpp, PlanTally& tally) {
    ASSERT_EQ(c.path_count, cpp.paths.size());
    for (std::size_t i = 0; i < cpp.paths.size(); ++i) {
        expectSame(c.paths[i], cpp.paths[i]);
        tally.safe += cpp.paths[i].safety == Safety::Safe ? 1 : 0;
        tally.unsafe += cpp.paths[i].safety == Safety::Unsafe ? 1 : 0;
    }
    ASSERT_EQ(c.triangle_count, cpp.triangles.size());
    for (std::size_t i = 0; i < cpp.triangles.size(); ++i) {
        EXPECT_THAT(c.triangles[i].paths, ElementsAreArray(cpp.triangles[i].paths));
        EXPECT_EQ(c.triangles[i].safe != 0, cpp.triangles[i].safe);
        tally.safeTriangles += c.triangles[i].safe;
        const double clearance = c.triangle_clearances == nullptr ? 0 : c.triangle_clearances[i];
        EXPECT_EQ(clearance, cpp.triangles[i].clearance);
        tally.clearTriangles += clearance > 0 ? 1 : 0;
    }
    EXPECT_EQ(c.area, cpp.area);
    EXPECT_EQ(c.safe_area, cpp.safeArea);
    EXPECT_EQ(c.directions, cpp.directions);
    EXPECT_EQ(c.no_surface, cpp.noSurface);
    EXPECT_EQ(c.on_border, cpp.onBorder);
    EXPECT_EQ(c.too_long, cpp.tooLong);
    EXPECT_EQ(c.too_oblique, cpp.tooOblique);
    EXPECT_GE(c.wall_milliseconds, 0);
    tally.leftOut += cpp.noSurface + cpp.onBorder + cpp.tooLong + cpp.tooOblique;
}

/// A ball of 10 mm around the middle of 24 mm, with a denser ball of 3 mm and a label of 4 mm in it.
RandomScene ballScene() {
    RandomScene scene;
    scene.volume = makeBytes(millimetreGrid(kSide), [](auto x, auto y, auto z) {
        const double r = std::hypot(x - 11.5, y - 11.5, z - 11.5);
        return std::hypot(x - 8.0, y - 12.0, z - 9.0) < 3 ? 220.0 : r < 10 ? 120.0 : 0.0;
    });
    scene.points = {{99, 0}, {101, 1}};
    scene.domain = {0, 255};
    scene.mesh = makeCube(0, 2);
    scene.poses = {identity()};
    return scene;
}

VolumeData ballLabels() {
    return makeBytes(millimetreGrid(kSide), [](auto x, auto y, auto z) {
        return std::hypot(x - 15.0, y - 13.0, z - 13.0) < 2   ? 7.0
               : std::hypot(x - 11.5, y - 11.5, z - 11.5) < 9 ? 1.0
                                                              : 0.0;
    });
}

/// The same task for both interfaces; stays where it is.
class Plans : public testing::Test {
  protected:
    Plans() {
        const vxt_control_point points[] = {{199, 0}, {201, 1}};
        vxt_transfer_function_desc desc = vxt_transfer_function_desc_init();
        desc.points = points;
        desc.point_count = 2;
        cDense_ = made<vxt_host_transfer_function>(vxt_host_transfer_function_destroy, [&](auto out) {
            return vxt_host_transfer_function_create(&desc, out);
        });
        for (vxt_plan_obstacle& obstacle : cObstacles_) {
            obstacle = vxt_plan_obstacle_init();
            obstacle.volume = both_.cVolumeHandle.get();
        }
        cObstacles_[0].labels = both_.cLabels.get();
        cObstacles_[0].avoid = &kAvoided;
        cObstacles_[0].avoid_count = 1;
        cObstacles_[1].transfer_function = cDense_.get();
        cObstacles_[1].threshold = 0.5;
        cpp_.obstacles = obstacles_;
        c_.obstacles = cObstacles_;
        c_.obstacle_count = 2;
        aim({12, 12, 11});
        overBall();
    }

    void aim(const Vec3& target) {
        cpp_.target = target;
        std::ranges::copy(target, c_.target);
    }
    void overBall() {
        cpp_.surface.entries = c_.entries = 362;
        cpp_.surface.volume = &both_.volume;
        cpp_.surface.transferFunction = &both_.function;
        cpp_.surface.threshold = c_.entry_threshold = 0.5;
        c_.entry_volume = both_.cVolumeHandle.get();
        c_.entry_transfer_function = both_.cFunctionHandle.get();
    }
    void noSurface() {
        cpp_.surface = {.entries = 362};
        c_.entry_volume = nullptr;
        c_.entry_transfer_function = nullptr;
    }
    vxt_result ask(vxt_plan& plan) const { return vxt_host_planner_plan(planner_.get(), &c_, &plan); }
    void expectTheSame(PlanTally& tally) {
        const Owned<vxt_plan> plan = newPlan();
        need(ask(*plan));
        expectSame(viewOf(*plan), take(cppPlanner_.plan(cpp_)), tally);
    }
    std::string refused() const {
        const Owned<vxt_plan> plan = newPlan();
        EXPECT_EQ(ask(*plan), VXT_ERROR_INVALID_ARGUMENT);
        return vxt_last_error(nullptr);
    }

    static constexpr std::int32_t kAvoided = 7;
    RandomScene scene_ = ballScene();
    BothInterfaces both_{scene_, ballLabels()};
    cpu::TransferFunction dense_ = take(cpu::TransferFunction::create(
        {std::array{ControlPoint{199, 0}, ControlPoint{201, 1}}, {0, 255}, kDefaultTableSize}));
    Owned<vxt_host_transfer_function> cDense_{nullptr, vxt_host_transfer_function_destroy};
    std::vector<cpu::PlanObstacle> obstacles_{{&both_.volume, nullptr, 0.1, &both_.labels, {kAvoided}},
                                              {&both_.volume, &dense_, 0.5, nullptr, {}}};
    vxt_plan_obstacle cObstacles_[2];
    cpu::PlanTask cpp_;
    vxt_plan_task c_ = vxt_plan_task_init();
    cpu::Planner cppPlanner_ = take(cpu::Planner::create({.threads = 1, .maximum = 4}));
    Owned<vxt_host_planner> planner_ = made<vxt_host_planner>(vxt_host_planner_destroy, [](auto out) {
        vxt_host_planner_desc desc = vxt_host_planner_desc_init();
        desc.threads = 1;
        desc.maximum = 4;
        return vxt_host_planner_create(&desc, out);
    });
};

TEST_F(Plans, AnswerAsTheCppInterfaceDoes) {
    PlanTally tally;
    EXPECT_EQ(vxt_host_planner_threads(planner_.get()), 1U);
    expectTheSame(tally);
    cpp_.needle = {1, 60};
    c_.needle_diameter = 1;
    c_.needle_length = 60;
    cpp_.margin = c_.margin = 0.5;
    expectTheSame(tally);
    cpp_.longest = c_.max_length = 9.5;
    expectTheSame(tally);
    cpp_.longest.reset();
    c_.max_length = 0;
    cpp_.steepest = c_.max_angle = 20;
    c_.has_max_angle = 1;
    expectTheSame(tally);
    cpp_.steepest.reset();
    c_.has_max_angle = 0;
    EXPECT_GT(tally.safe, 20U);
    EXPECT_GT(tally.unsafe, 5U);
    EXPECT_GT(tally.safeTriangles, 0U);
    EXPECT_GT(tally.leftOut, 0U);
    EXPECT_EQ(tally.clearTriangles, 0U) << "nobody asked";
    cpp_.triangleClearances = true;
    c_.triangle_clearances = 1;
    expectTheSame(tally);
    EXPECT_GT(tally.clearTriangles, 0U);
    std::cout << tally.safe << " safe, " << tally.unsafe << " not, " << tally.safeTriangles << " triangles safe, "
              << tally.leftOut << " left out\n";
}

TEST_F(Plans, EntriesOfALabelAndOfABallAndAMeshAreTheCppInterfaces) {
    PlanTally tally;
    noSurface();
    cpp_.surface.labels = &both_.labels;
    cpp_.surface.label = c_.entry_label = 1;
    c_.entry_labels = both_.cLabels.get();
    expectTheSame(tally);
    noSurface();
    c_.entry_labels = nullptr;
    cpp_.surface.radius = c_.entry_radius = 9;
    expectTheSame(tally);
    cpp_.mesh = cpu::PlanMesh{&both_.mesh, {0.5, 0.5, 0}, {1, 0, 1}};
    c_.mesh = both_.cMeshHandle.get();
    c_.mesh_tip[0] = c_.mesh_tip[1] = 0.5;
    c_.mesh_axis[0] = 1;
    expectTheSame(tally);
    EXPECT_GT(tally.safe, 0U);
    EXPECT_GT(tally.unsafe, 0U);
}

TEST_F(Plans, EntriesWhereTheImageEndsAreTheCppInterfaces) {
    // What has no label is cut by the image all around.
    noSurface();
    cpp_.surface.labels = &both_.labels;
    cpp_.surface.label = c_.entry_label = 0;
    c_.entry_labels = both_.cLabels.get();
    EXPECT_THAT(refused(), HasSubstr("362 enter where the image ends"));
    cpp_.surface.borderEntries = true;
    c_.border_entries = 1;
    PlanTally tally;
    expectTheSame(tally);
    EXPECT_EQ(tally.leftOut, 0U);
}

TEST_F(Plans, RefuseWhatTheCppInterfaceRefuses) {
    const auto with = [this](auto change) {
        const vxt_plan_task before = c_;
        change(c_);
        std::string text = refused();
        c_ = before;
        return text;
    };
    const double nan = std::nan("");
    EXPECT_THAT(with([&](auto& task) { task.target[1] = nan; }), HasSubstr("the target"));
    EXPECT_THAT(with([&](auto& task) { task.margin = nan; }), HasSubstr("the margin nan mm"));
    EXPECT_THAT(with([&](auto& task) { task.needle_diameter = -1; }), HasSubstr("the needle"));
    EXPECT_THAT(with([&](auto& task) { task.max_length = nan; }), HasSubstr("the largest length nan"));
    EXPECT_THAT(with([&](auto& task) { task.has_max_angle = 1, task.max_angle = nan; }),
                HasSubstr("the largest angle nan"));
    EXPECT_THAT(with([&](auto& task) { task.entries = 0; }), HasSubstr("entries is 0"));
    EXPECT_THAT(with([&](auto& task) { task.entry_transfer_function = nullptr; }), HasSubstr("is null"));
    EXPECT_THAT(with([&](auto& task) { task.entry_volume = nullptr; }), HasSubstr("neither volume nor labels"));
    EXPECT_THAT(with([&](auto& task) { task.obstacle_count = 0; }), HasSubstr("there are no obstacles"));
    EXPECT_THAT(with([&](auto& task) { task.obstacles = nullptr; }), HasSubstr("obstacle is null"));
    EXPECT_THAT(with([&](auto& task) { task.mesh = both_.cMeshHandle.get(), task.mesh_axis[2] = 0; }),
                HasSubstr("its axis has no length"));
    EXPECT_THAT(with([&](auto& task) { task.struct_size = 3; }), HasSubstr("task: struct_size is 3"));
    cObstacles_[0].avoid = nullptr;
    EXPECT_EQ(refused(), "obstacle: avoid is null");
    cObstacles_[0].avoid_count = 0;
    EXPECT_THAT(refused(), HasSubstr("obstacle 0: there is a label map, and none of its labels is to be avoided"));
    cObstacles_[0].labels = nullptr;
    EXPECT_THAT(refused(), HasSubstr("obstacle 0: transferFunction and labels are both null"));
    cObstacles_[1].struct_size = 0;
    EXPECT_THAT(refused(), HasSubstr("obstacle 1: struct_size is 0"));
    EXPECT_STREQ(vxt_safety_name(static_cast<vxt_safety>(9)), "unknown");
}

TEST_F(Plans, RefuseNullAndDescsOutOfRange) {
    const auto text = [](vxt_result result) {
        EXPECT_EQ(result, VXT_ERROR_INVALID_ARGUMENT);
        return std::string(vxt_last_error(nullptr));
    };
    const Owned<vxt_plan> plan = newPlan();
    EXPECT_EQ(text(vxt_host_planner_plan(nullptr, &c_, plan.get())), "planner is null");
    EXPECT_EQ(text(vxt_host_planner_plan(planner_.get(), nullptr, plan.get())), "task is null");
    EXPECT_EQ(text(vxt_host_planner_plan(planner_.get(), &c_, nullptr)), "plan is null");
    EXPECT_EQ(text(vxt_plan_get(nullptr, nullptr)), "plan is null");
    EXPECT_EQ(text(vxt_plan_get(plan.get(), nullptr)), "view is null");
    EXPECT_EQ(text(vxt_plan_create(nullptr)), "the place for the new object is null");
    EXPECT_EQ(vxt_host_planner_threads(nullptr), 0U);
    EXPECT_EQ(viewOf(*plan).path_count, 0U);
    vxt_plan_destroy(nullptr);
    vxt_host_planner_destroy(nullptr);
    vxt_host_planner* planner = nullptr;
    vxt_host_planner_desc desc = vxt_host_planner_desc_init();
    desc.tolerance = std::nan("");
    EXPECT_THAT(text(vxt_host_planner_create(&desc, &planner)), HasSubstr("the tolerance nan mm"));
    desc = vxt_host_planner_desc_init();
    desc.most_steps = 0;
    EXPECT_THAT(text(vxt_host_planner_create(&desc, &planner)), HasSubstr("at most 0 steps are allowed"));
    EXPECT_EQ(planner, nullptr);
}

TEST_F(Plans, AreCancelledAndHoldWhatTheyHeld) {
    const Owned<vxt_plan> plan = newPlan();
    need(ask(*plan));
    const std::size_t paths = viewOf(*plan).path_count;
    EXPECT_GT(paths, 0U);
    const auto cancel = made<vxt_cancel>(vxt_cancel_destroy, [](auto out) { return vxt_cancel_create(out); });
    vxt_cancel_set(cancel.get(), 1);
    c_.cancel = cancel.get();
    EXPECT_EQ(ask(*plan), VXT_ERROR_CANCELLED);
    EXPECT_EQ(viewOf(*plan).path_count, paths);
    vxt_cancel_set(cancel.get(), 0);
    need(ask(*plan));
}

TEST_F(Plans, LabelsAlongALineGoAsFarAsThereIsRoom) {
    const double from[] = {-5, 13, 13};
    const double to[] = {30, 13, 13};
    const std::vector<std::int32_t> all = take(labelsAlong(both_.labels, {-5, 13, 13}, {30, 13, 13}));
    ASSERT_EQ(all, (std::vector<std::int32_t>{1, 7}));
    std::int32_t found[3] = {-1, -1, -1};
    std::size_t count = 9;
    need(vxt_labels_along(both_.cLabels.get(), from, to, found, 3, &count));
    EXPECT_EQ(count, 2U);
    EXPECT_THAT(found, testing::ElementsAre(1, 7, -1));
    found[0] = found[1] = -1;
    need(vxt_labels_along(both_.cLabels.get(), from, to, found, 1, &count));
    EXPECT_EQ(count, 2U);
    EXPECT_THAT(found, testing::ElementsAre(1, -1, -1));
    need(vxt_labels_along(both_.cLabels.get(), from, to, nullptr, 0, &count));
    EXPECT_EQ(count, 2U);
    EXPECT_EQ(vxt_labels_along(both_.cLabels.get(), from, to, nullptr, 1, &count), VXT_ERROR_INVALID_ARGUMENT);
    EXPECT_EQ(vxt_labels_along(nullptr, from, to, found, 3, &count), VXT_ERROR_INVALID_ARGUMENT);
    EXPECT_EQ(vxt_labels_along(both_.cLabels.get(), nullptr, to, found, 3, &count), VXT_ERROR_INVALID_ARGUMENT);
    EXPECT_EQ(vxt_labels_along(both_.cLabels.get(), from, to, found, 3, nullptr), VXT_ERROR_INVALID_ARGUMENT);
    const double nowhere[] = {std::nan(""), 0, 0};
    EXPECT_EQ(vxt_labels_along(both_.cLabels.get(), from, nowhere, found, 3, &count), VXT_ERROR_INVALID_ARGUMENT);
    EXPECT_STREQ(vxt_last_error(nullptr), "an end of the line is not finite");
}

} // namespace
} // namespace voxtact::test
