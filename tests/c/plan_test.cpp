// SPDX-License-Identifier: MIT
// Plans through the C interface: the C++ interface's answers, every column of every table.
#include "both_interfaces.h"
#include "columns.h"
#include "support/scenes.h"

#include <gmock/gmock.h>

#include <cmath>
#include <iostream>

namespace voxtact::test {
namespace {

using testing::HasSubstr;

constexpr std::uint32_t kSide = 24;

/// How often each was seen.
struct PlanTally {
    std::size_t safe = 0;
    std::size_t unsafe = 0;
    std::size_t safeTriangles = 0;
    std::size_t clearTriangles = 0;
    std::size_t leftOut = 0;

    void add(const PlanAnswer& answer) {
        for (const PlannedPath& path : answer.paths) {
            safe += path.safety == Safety::Safe ? 1 : 0;
            unsafe += path.safety == Safety::Unsafe ? 1 : 0;
        }
        for (const EntryTriangle& triangle : answer.triangles) {
            safeTriangles += triangle.safe ? 1 : 0;
            clearTriangles += triangle.clearance > 0 ? 1 : 0;
        }
        leftOut += answer.noSurface + answer.onBorder + answer.tooLong + answer.tooOblique;
    }
};

void expectSame(const vxt_answer& c, const PlanAnswer& cpp) {
    Columns columns(c);
    const auto& paths = cpp.paths;
    const auto nearest = [](auto member) { return ofOptional(&PlannedPath::nearest, member); };
    columns.expect("paths", "entry", paths, &PlannedPath::entry);
    columns.expect("paths", "safe", paths, &PlannedPath::safety);
    columns.expect("paths", "lower", paths, [](const PlannedPath& path) { return path.clearance.lower; });
    columns.expect("paths", "upper", paths, [](const PlannedPath& path) { return path.clearance.upper; });
    columns.expect("paths", "end", paths, &PlannedPath::end);
    columns.expect("paths", "length", paths, &PlannedPath::length);
    columns.expect("paths", "angle", paths, [](const PlannedPath& path) {
        return path.angle.value_or(std::numeric_limits<double>::quiet_NaN());
    });
    columns.expect("paths", "position", paths, &PlannedPath::position);
    columns.expect("paths", "near", paths, [](const PlannedPath& path) { return path.nearest.has_value(); });
    columns.expect("paths", "obstacle", paths, nearest(&NearestObstacle::obstacle));
    columns.expect("paths", "label", paths, nearest(&NearestObstacle::label));
    columns.expect("paths", "nearest", paths, nearest(&NearestObstacle::position));
    columns.expect("paths", "on_path", paths, nearest(&NearestObstacle::onPath));
    columns.expect("triangles", "paths", cpp.triangles, &EntryTriangle::paths);
    columns.expect("triangles", "safe", cpp.triangles, &EntryTriangle::safe);
    columns.expect("triangles", "distance", cpp.triangles, &EntryTriangle::clearance);
    columns.expectTotal("directions", cpp, &PlanAnswer::directions);
    columns.expectTotal("no_surface", cpp, &PlanAnswer::noSurface);
    columns.expectTotal("on_border", cpp, &PlanAnswer::onBorder);
    columns.expectTotal("too_long", cpp, &PlanAnswer::tooLong);
    columns.expectTotal("too_oblique", cpp, &PlanAnswer::tooOblique);
    columns.expectTotal("area", cpp, &PlanAnswer::area);
    columns.expectTotal("safe_area", cpp, &PlanAnswer::safeArea);
    columns.expectTime();
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
        const std::vector<vxt_control_point> points{{199, 0}, {201, 1}};
        const vxt_transfer_function_desc desc = cFunction(points, {0, 255}, 0);
        cDense_ = made(vxt_host_transfer_function_destroy, vxt_host_transfer_function_create, &desc);
        cObstacles_[0].volume = cObstacles_[1].volume = both_.cVolumeHandle.get();
        cObstacles_[0].labels = both_.cLabels.get();
        cObstacles_[0].avoid = &kAvoided;
        cObstacles_[0].avoid_count = 1;
        cObstacles_[1].transfer_function = cDense_.get();
        cObstacles_[1].opacity_threshold = 0.5;
        cpp_.obstacles = obstacles_;
        c_.obstacles = cObstacles_;
        c_.obstacle_count = 2;
        cpp_.maximum = c_.max = 4;
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
    [[nodiscard]] vxt_result ask() const { return vxt_ask_plan(engine_.get(), &c_, answer_.get()); }
    void expectTheSame(PlanTally& tally) {
        need(ask());
        const PlanAnswer expected = take(cppEngine_.ask(cpp_));
        expectSame(*answer_, expected);
        tally.add(expected);
    }
    [[nodiscard]] std::string refused() const {
        EXPECT_EQ(ask(), VXT_ERROR_INVALID_ARGUMENT);
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
    vxt_obstacle cObstacles_[2]{};
    cpu::Plan cpp_;
    vxt_plan c_ = sized<vxt_plan>();
    cpu::HostEngine cppEngine_ = take(cpu::HostEngine::create(1));
    Owned<vxt_host_engine> engine_ = newEngine();
    Owned<vxt_answer> answer_ = newAnswer();
};

TEST_F(Plans, AnswerAsTheCppInterfaceDoes) {
    PlanTally tally;
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
    c_.limit_angle = 1;
    expectTheSame(tally);
    cpp_.steepest.reset();
    c_.limit_angle = 0;
    EXPECT_GT(tally.safe, 20U);
    EXPECT_GT(tally.unsafe, 5U);
    EXPECT_GT(tally.safeTriangles, 0U);
    EXPECT_GT(tally.leftOut, 0U);
    EXPECT_EQ(tally.clearTriangles, 0U) << "nobody asked";
    cpp_.triangleDistances = true;
    c_.triangle_distances = 1;
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
    c_.mesh_axis[0] = c_.mesh_axis[2] = 1;
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
        const vxt_plan before = c_;
        change(c_);
        std::string text = refused();
        c_ = before;
        return text;
    };
    const double nan = std::nan("");
    EXPECT_THAT(with([&](auto& plan) { plan.target[1] = nan; }), HasSubstr("the target"));
    EXPECT_THAT(with([&](auto& plan) { plan.margin = nan; }), HasSubstr("the margin nan mm"));
    EXPECT_THAT(with([&](auto& plan) { plan.needle_diameter = -1; }), HasSubstr("the needle"));
    EXPECT_THAT(with([&](auto& plan) { plan.max_length = nan; }), HasSubstr("the max length nan"));
    EXPECT_THAT(with([&](auto& plan) { plan.limit_angle = 1, plan.max_angle = nan; }), HasSubstr("the max angle nan"));
    EXPECT_THAT(with([&](auto& plan) { plan.max = -1; }), HasSubstr("-1"));
    EXPECT_THAT(with([&](auto& plan) { plan.tolerance = nan; }), HasSubstr("the tolerance nan mm"));
    EXPECT_THAT(with([&](auto& plan) { plan.entry_transfer_function = nullptr; }), HasSubstr("is null"));
    EXPECT_THAT(with([&](auto& plan) { plan.entry_volume = nullptr; }), HasSubstr("neither volume nor labels"));
    EXPECT_THAT(with([&](auto& plan) { plan.obstacle_count = 0; }), HasSubstr("there are no obstacles"));
    EXPECT_THAT(with([&](auto& plan) { plan.obstacles = nullptr; }), HasSubstr("obstacles is null"));
    EXPECT_THAT(with([&](auto& plan) { plan.mesh = both_.cMeshHandle.get(), plan.mesh_axis[2] = nan; }),
                HasSubstr("axis"));
    EXPECT_THAT(with([&](auto& plan) { plan.struct_size = 3; }), HasSubstr("question: struct_size is 3"));
    c_.entries = kMaxEntries + 1;
    EXPECT_EQ(ask(), VXT_ERROR_LIMIT_EXCEEDED);
    c_.entries = 0;
    cObstacles_[0].avoid = nullptr;
    EXPECT_EQ(refused(), "obstacle: avoid is null");
    cObstacles_[0].avoid_count = 0;
    EXPECT_THAT(refused(), HasSubstr("obstacle 0: there is a label map, and none of its labels is to be avoided"));
    cObstacles_[0].labels = nullptr;
    EXPECT_THAT(refused(), HasSubstr("obstacle 0: transferFunction and labels are both null"));
    EXPECT_EQ(vxt_ask_plan(nullptr, &c_, answer_.get()), VXT_ERROR_INVALID_ARGUMENT);
    EXPECT_STREQ(vxt_last_error(nullptr), "engine is null");
    EXPECT_EQ(vxt_ask_plan(engine_.get(), nullptr, answer_.get()), VXT_ERROR_INVALID_ARGUMENT);
    EXPECT_STREQ(vxt_last_error(nullptr), "question is null");
    EXPECT_EQ(vxt_ask_plan(engine_.get(), &c_, nullptr), VXT_ERROR_INVALID_ARGUMENT);
    EXPECT_STREQ(vxt_last_error(nullptr), "answer is null");
    EXPECT_EQ(vxt_answer_columns(answer_.get()), 0U);
}

TEST_F(Plans, HaveTheCppInterfacesDefaults) {
    // All that may be 0 is.
    cpp_.surface.entries = cpu::EntrySurface{}.entries;
    cpp_.surface.threshold = kDefaultThreshold;
    cpp_.maximum = cpu::Plan{}.maximum;
    obstacles_[1].threshold = kDefaultThreshold;
    c_.entries = 0;
    c_.entry_threshold = c_.max = 0;
    cObstacles_[1].opacity_threshold = 0;
    PlanTally tally;
    expectTheSame(tally);
    cpp_.mesh = cpu::PlanMesh{.mesh = &both_.mesh};
    c_.mesh = both_.cMeshHandle.get();
    expectTheSame(tally);
}

TEST_F(Plans, AreCancelledAndHoldWhatTheyHeld) {
    need(ask());
    const std::size_t paths = findColumn(*answer_, "paths", "entry").rows;
    EXPECT_GT(paths, 0U);
    const Owned<vxt_cancel> cancel = newCancel();
    vxt_cancel_set(cancel.get(), 1);
    c_.cancel = cancel.get();
    EXPECT_EQ(ask(), VXT_ERROR_CANCELLED);
    EXPECT_EQ(findColumn(*answer_, "paths", "entry").rows, paths);
    vxt_cancel_set(cancel.get(), 0);
    need(ask());
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
