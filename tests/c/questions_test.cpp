// SPDX-License-Identifier: MIT
// Questions through the C interface: the C++ interface's answers, every column of every table.
#include "both_interfaces.h"
#include "columns.h"
#include "support/contact_scenes.h"
#include "support/scenes.h"

#include <gmock/gmock.h>

#include <cmath>
#include <iostream>
#include <map>

namespace voxtact::test {
namespace {

using testing::HasSubstr;

void expectSame(const vxt_answer& c, const TouchAnswer& cpp) {
    Columns columns(c);
    const auto& pairs = cpp.pairs;
    columns.expect("pairs", "item", pairs, &PairTouch::item);
    columns.expect("pairs", "pose", pairs, &PairTouch::pose);
    columns.expect("pairs", "touch", pairs, &PairTouch::touch);
    columns.expect("pairs", "witness", pairs, [](const PairTouch& pair) { return pair.witness.has_value(); });
    columns.expect("pairs", "triangle", pairs, ofOptional(&PairTouch::witness, &WitnessPoint::triangle));
    columns.expect("pairs", "point", pairs, ofOptional(&PairTouch::witness, &WitnessPoint::position));
    columns.expectTime();
}

void expectSame(const vxt_answer& c, const DistanceAnswer& cpp) {
    Columns columns(c);
    const auto& pairs = cpp.pairs;
    const auto closest = [](auto member) { return ofOptional(&PairDistance::closest, member); };
    columns.expectBounds("pairs", pairs);
    columns.expect("pairs", "witness", pairs, [](const PairDistance& pair) { return pair.closest.has_value(); });
    columns.expect("pairs", "triangle", pairs, closest(&WitnessPoints::triangle));
    columns.expect("pairs", "on_mesh", pairs, closest(&WitnessPoints::mesh));
    columns.expect("pairs", "in_volume", pairs, closest(&WitnessPoints::volume));
    columns.expect("pairs", "per_translation", pairs, closest(&WitnessPoints::perTranslation));
    columns.expect("pairs", "per_rotation", pairs, closest(&WitnessPoints::perRotation));
    columns.expectBounds("labels", cpp.labels);
    columns.expect("labels", "pair", cpp.labels, &LabelDistance::pair);
    columns.expect("labels", "label", cpp.labels, &LabelDistance::label);
    columns.expectTime();
}

void expectSame(const vxt_answer& c, const AreaAnswer& cpp) {
    Columns columns(c);
    columns.expectBounds("pairs", cpp.pairs);
    columns.expect("triangles", "pair", cpp.triangles, &TriangleArea::pair);
    columns.expect("triangles", "triangle", cpp.triangles, &TriangleArea::triangle);
    columns.expect("triangles", "whole", cpp.triangles, &TriangleArea::whole);
    columns.expect("triangles", "lower", cpp.triangles, [](const TriangleArea& row) { return row.bounds.lower; });
    columns.expect("triangles", "upper", cpp.triangles, [](const TriangleArea& row) { return row.bounds.upper; });
    columns.expectBounds("labels", cpp.labels);
    columns.expect("labels", "pair", cpp.labels, &LabelArea::pair);
    columns.expect("labels", "label", cpp.labels, &LabelArea::label);
    columns.expectTime();
}

void expectSame(const vxt_answer& c, const MotionAnswer& cpp) {
    Columns columns(c);
    const auto& segments = cpp.segments;
    columns.expect("segments", "item", segments, &SegmentMotion::item);
    columns.expect("segments", "pose", segments, &SegmentMotion::pose);
    columns.expect("segments", "touch", segments, [](const SegmentMotion& segment) {
        return segment.touch ? Verdict::Yes : segment.possible ? Verdict::Undecided : Verdict::No;
    });
    columns.expect("segments", "end", segments, &SegmentMotion::end);
    columns.expect("segments", "toi_lower", segments, &SegmentMotion::freeUntil);
    columns.expect("segments", "toi_upper", segments,
                   ofOptional(&SegmentMotion::touch, &MotionTouch::at, std::numeric_limits<double>::quiet_NaN()));
    columns.expect("segments", "triangle", segments, ofOptional(&SegmentMotion::touch, &MotionTouch::triangle));
    columns.expect("segments", "point", segments, ofOptional(&SegmentMotion::touch, &MotionTouch::position));
    columns.expect("segments", "world_from_object", segments,
                   ofOptional(&SegmentMotion::touch, &MotionTouch::world_from_object));
    columns.expectTime();
}

void expectSame(const vxt_answer& c, const BatchAnswer& cpp) {
    EXPECT_EQ(wholeDifferenceOf(answerOf(c), cpp), "");
}

/// Poses of a random scene may be of different scales, which no motion joins.
void makeRigid(RandomScene& scene, std::mt19937_64& random) {
    for (Mat4& pose : scene.poses) {
        pose = randomMotion(random);
        for (std::size_t axis = 0; axis < 3; ++axis) {
            pose[12 + axis] *= 0.3;
        }
    }
}

/// Engines of both interfaces.
class CQuestions : public testing::Test {
  protected:
    /// Asks both.
    template <class Given, class Question>
    auto compare(const BothInterfaces& both, const RandomScene& scene, const Given& given, const Question& question) {
        const Owned<vxt_answer> answer = both.byC(*c_, given, scene);
        const auto expected = both.byCpp(cpp_, question, scene);
        expectSame(*answer, expected);
        return expected;
    }
    void see(const char* what, bool isSeen) { seen_[what] += isSeen ? 1 : 0; }

    void compareTouch(const BothInterfaces& both, const RandomScene& scene) {
        vxt_touch given = sized<vxt_touch>();
        given.margin = 1.5;
        given.witness = 1;
        given.resolution = 1.0 / 8;
        given.max_steps = 300;
        Touch question{.margin = 1.5, .witness = true, .resolution = 1.0 / 8, .maxSteps = 300};
        for (const PairTouch& pair : compare(both, scene, given, question).pairs) {
            see(toString(pair.touch), true);
            see("witness point", pair.witness.has_value());
        }
        given.margin = 0;
        given.witness = 0;
        given.uncertainty_distance = 1.5;
        given.uncertainty_angle = 3;
        question.margin = 0;
        question.witness = false;
        question.uncertainty = PoseTolerance{1.5, 3};
        compare(both, scene, given, question);
        given.uncertainty_distance = 0;
        question.uncertainty->distance = 0;
        compare(both, scene, given, question);
    }

    void compareDistance(const BothInterfaces& both, const RandomScene& scene) {
        vxt_distance given = sized<vxt_distance>();
        given.tolerance = 0.1;
        given.max = 20;
        given.resolution = 1.0 / 8;
        given.max_steps = 500;
        Distance question{.tolerance = 0.1, .maximum = 20, .resolution = 1.0 / 8, .maxSteps = 500};
        for (const PairDistance& pair : compare(both, scene, given, question).pairs) {
            see("distance above 0", pair.bounds.lower > 0);
            see("closest points", pair.closest.has_value());
        }
        const std::vector<std::int32_t> labels{both.labels.values.back(), 0, 12345};
        given.labels = labels.data();
        given.label_count = labels.size();
        question.labels = labels;
        for (const LabelDistance& label : compare(both, scene, given, question).labels) {
            see("distance to a label", std::isfinite(label.bounds.upper));
        }
        given.any_opacity = 1;
        question.labelsAtAnyOpacity = true;
        compare(both, scene, given, question);
    }

    void compareArea(const BothInterfaces& both, const RandomScene& scene) {
        vxt_area given = sized<vxt_area>();
        given.tolerance = 1e-3;
        given.triangles = 1;
        given.resolution = 1.0 / 8;
        given.max_steps = 100;
        Area question{.tolerance = 1e-3, .triangles = true, .resolution = 1.0 / 8, .maxSteps = 100};
        const AreaAnswer answer = compare(both, scene, given, question);
        see("area of a triangle", !answer.triangles.empty());
        for (const PairArea& pair : answer.pairs) {
            see("area above 0", pair.bounds.lower > 0);
            see("too many steps", pair.end == StopReason::Budget);
        }
        const std::vector<std::int32_t> labels{2, 0, 12345};
        given.triangles = 0;
        given.labels = labels.data();
        given.label_count = labels.size();
        question.triangles = false;
        question.labels = labels;
        for (const LabelArea& label : compare(both, scene, given, question).labels) {
            see("area in a label", label.bounds.lower > 0);
        }
    }

    void compareMotion(const BothInterfaces& both, const RandomScene& scene) {
        vxt_motion given = sized<vxt_motion>();
        given.interpolation = VXT_INTERPOLATION_SLERP;
        given.resolution = 0.1;
        given.touch_resolution = 1.0 / 8;
        given.max_steps = 5000;
        const Motion question{
            .interpolation = Interpolation::Slerp, .resolution = 0.1, .touchResolution = 1.0 / 8, .maxSteps = 5000};
        for (const SegmentMotion& segment : compare(both, scene, given, question).segments) {
            see("touch on the way", segment.touch.has_value());
            see("free all the way", segment.freeUntil == 1);
        }
    }

    cpu::HostEngine cpp_ = take(cpu::HostEngine::create(1));
    Owned<vxt_host_engine> c_ = newEngine();
    std::map<std::string, std::size_t> seen_{
        {"no", 0}, {"yes", 0}, {"distance to a label", 0}, {"area in a label", 0}, {"too many steps", 0}};
};

TEST_F(CQuestions, HaveTheCppInterfacesAnswers) {
    std::mt19937_64 random(testSeed());
    const auto isAllSeen = [&] { return std::ranges::all_of(seen_, [](const auto& one) { return one.second > 0; }); };
    for (int round = 0; (round < 12 || (round < 300 && !isAllSeen())) && !HasFailure(); ++round) {
        const std::uint64_t seed = random();
        SCOPED_TRACE("scene " + std::to_string(seed));
        std::mt19937_64 local(seed);
        RandomScene scene = makeRandomSceneForC(local, 4);
        const bool isRigid = round % 2 == 0;
        if (isRigid) {
            makeRigid(scene, local);
        }
        const BothInterfaces both(
            scene, makeBytes(scene.volume.grid, [](auto x, auto y, auto z) { return (x / 3 + y / 3 + z / 3) % 3; }));
        compareTouch(both, scene);
        compareDistance(both, scene);
        compareArea(both, scene);
        if (isRigid) {
            compareMotion(both, scene);
        }
    }
    for (const auto& [what, count] : seen_) {
        std::cout << what << ": " << count << "\n";
        EXPECT_GT(count, 0U) << what;
    }
}

TEST_F(CQuestions, CountInEveryProjection) {
    constexpr Outputs kAll{.triangles = true, .contacts = true, .bounds = true, .labels = true, .maxDepth = 3};
    std::mt19937_64 random(testSeed());
    for (const Projection projection : projections()) {
        Count question{.projection = projection,
                       .boundary = Boundary::Range,
                       .samplesPerVoxel = 2,
                       .resolution = 1.0 / 8,
                       .maxContacts = 500};
        vxt_count given = sized<vxt_count>();
        given.projection = static_cast<vxt_projection>(projection);
        given.boundary = VXT_BOUNDARY_RANGE;
        given.samples_per_voxel = 2;
        given.resolution = 1.0 / 8;
        given.max_contacts = 500;
        std::size_t contacts = 0;
        for (int round = 0; (round < 6 || contacts < 300) && round < 100 && !HasFailure(); ++round) {
            const std::uint64_t seed = random();
            SCOPED_TRACE("scene " + std::to_string(seed));
            std::mt19937_64 local(seed);
            RandomScene scene = makeRandomSceneForC(local, 4);
            scene.view.width = std::min(scene.view.width, 100U);
            scene.view.height = std::min(scene.view.height, 100U);
            const BothInterfaces both(scene, makeLabelImage(local, scene.volume.grid));
            compare(both, scene, given, question);
            given.stop_at_first = 1;
            question.stopAtFirst = true;
            compare(both, scene, given, question);
            given.stop_at_first = 0;
            question.stopAtFirst = false;
            given.outputs = cOutputs(kAll);
            given.max_depth = kAll.maxDepth;
            question.outputs = kAll;
            const BatchAnswer expected = both.byCpp(cpp_, question, scene);
            const BatchAnswer found = answerOf(*both.byC(*c_, given, scene));
            // A list that is cut is cut arbitrarily.
            if (expected.contactsFound <= 500) {
                EXPECT_EQ(wholeDifferenceOf(found, expected), "");
            } else {
                EXPECT_EQ(found.contactsFound, expected.contactsFound);
                EXPECT_EQ(found.contacts.size(), 500U);
            }
            contacts += found.contacts.size();
            given.outputs = 0;
            question.outputs = {};
        }
        std::cout << toString(projection) << ": " << contacts << " contacts\n";
        EXPECT_GE(contacts, 300U);
    }
}

/// A mesh that touches, one that does not, and a small one on the way, with a label that is not opaque anywhere.
RandomScene plainScene() {
    RandomScene scene;
    scene.volume = makeBytes(millimetreGrid(16), [](auto x, auto...) { return x < 4 ? 255.0 : 0.0; });
    scene.points = {{100, 0}, {200, 1}};
    scene.domain = {0, 255};
    scene.mesh = makeCube(0, 2);
    scene.poses = {translation({5, 7, 7}), translation({2.3, 7, 7}), translation({9.2, 3, 4})};
    scene.view = {framingCamera(scene.volume.grid, 32, 32), 32, 32};
    return scene;
}
VolumeData plainLabels() {
    return makeBytes(millimetreGrid(16), [](auto x, auto...) { return x >= 12 ? 4.0 : 0.0; });
}

TEST_F(CQuestions, ThatAreZeroOrNullAreTheDefaults) {
    RandomScene scene = plainScene();
    const BothInterfaces both(scene, plainLabels());
    const auto expectDefault = [&]<class Given, class Question>(Given given, Question question) {
        compare(both, scene, given, question);
        BothInterfaces::CPairs c;
        both.fill(c, scene);
        c.pairs.opacity_threshold = 0;
        const Owned<vxt_answer> answer = newAnswer();
        need(askC(c_.get(), static_cast<const Given*>(nullptr), &c.pairs, answer.get()));
        expectSame(*answer, both.byCpp(cpp_, question, scene));
    };
    scene.threshold = kDefaultThreshold;
    expectDefault(sized<vxt_touch>(), Touch{});
    expectDefault(sized<vxt_count>(), Count{});
    expectDefault(sized<vxt_distance>(), Distance{});
    expectDefault(sized<vxt_area>(), Area{});
    expectDefault(sized<vxt_motion>(), Motion{});
}

TEST_F(CQuestions, SolidsHaveAPointInside) {
    RandomScene scene = plainScene();
    scene.mesh = makeCube(-20, 40);
    for (const std::size_t triangle : {0, 1, 4, 5, 8, 9}) { // of the lower sides, so that all normals are outward
        std::swap(scene.mesh.indices[3 * triangle + 1], scene.mesh.indices[3 * triangle + 2]);
    }
    scene.poses = {identity(), translation({100, 0, 0})};
    const BothInterfaces both(scene, plainLabels());
    vxt_touch touch = sized<vxt_touch>();
    touch.witness = 1;
    touch.solid = 1;
    const TouchAnswer touched = compare(both, scene, touch, Touch{.witness = true, .solid = true});
    EXPECT_EQ(touched.pairs.at(0).touch, Verdict::Yes);
    EXPECT_EQ(touched.pairs.at(1).touch, Verdict::No);
    ASSERT_TRUE(touched.pairs[0].witness.has_value());
    EXPECT_EQ(touched.pairs[0].witness->triangle, kInsideMesh);
    vxt_distance distance = sized<vxt_distance>();
    distance.solid = 1;
    const DistanceAnswer measured = compare(both, scene, distance, Distance{.solid = true});
    EXPECT_EQ(measured.pairs.at(0).bounds.upper, 0);
    EXPECT_GT(measured.pairs.at(1).bounds.lower, 70);
    ASSERT_TRUE(measured.pairs[0].closest.has_value());
    EXPECT_EQ(measured.pairs[0].closest->triangle, kInsideMesh);
}

TEST_F(CQuestions, MeasureALabelAtAnyOpacity) {
    RandomScene scene = plainScene();
    scene.poses.resize(1);
    const BothInterfaces both(scene, plainLabels());
    const std::int32_t label = 4;
    vxt_distance question = sized<vxt_distance>();
    question.labels = &label;
    question.label_count = 1;
    const auto distance = [&] {
        const auto upper = readColumn<double>(*both.byC(*c_, question, scene), "labels", "upper");
        EXPECT_EQ(upper.size(), 1U);
        return upper.at(0);
    };
    EXPECT_EQ(distance(), std::numeric_limits<double>::infinity());
    question.any_opacity = 1;
    EXPECT_NEAR(distance(), 4.5, 0.01); // voxel 12 begins at 11.5, the cube ends at 7
}

TEST_F(CQuestions, ATrackerFollowsAsTheCppInterfacesDoes) {
    // Down a random way through random voxels, in steps so small that most answers need no search.
    std::mt19937_64 random(testSeed());
    RandomScene scene = makeRandomSceneForC(random, 2);
    makeRigid(scene, random);
    const BothInterfaces both(scene, makeBytes(scene.volume.grid, [](auto...) { return 1.0; }));
    const auto tracker = made(vxt_tracker_destroy, vxt_tracker_create, 50, 1.0 / 8, 0);
    cpu::DistanceTracker cpp = take(cpu::DistanceTracker::create({.maximum = 50, .resolution = 1.0 / 8}));
    BothInterfaces::CPairs c;
    both.fill(c, scene);
    vxt_tracked found = sized<vxt_tracked>();
    std::size_t searches = 0;
    constexpr int kSteps = 2000;
    for (int step = 0; step <= kSteps; ++step) {
        const Mat4 pose = take(poseBetween(scene.poses[0], scene.poses[1], static_cast<double>(step) / kSteps));
        c.item.world_from_object = pose.data();
        c.item.pose_count = 1;
        need(vxt_tracker_track(tracker.get(), &c.item, scene.threshold, &found));
        const TrackedDistance expected =
            take(cpp.track({&both.mesh, &both.volume, &both.function, std::span(&pose, 1)}, scene.threshold));
        ASSERT_EQ(found.lower, expected.bounds.lower);
        ASSERT_EQ(found.upper, expected.bounds.upper);
        ASSERT_EQ(found.touch, expected.hit ? 1U : expected.possible ? 2U : 0U);
        ASSERT_EQ(found.searched != 0, expected.searched);
        searches += found.searched;
    }
    EXPECT_GT(searches, 0U);
    const auto refusal = [&](vxt_tracker* by, const vxt_host_item* item, vxt_tracked* to) {
        EXPECT_EQ(vxt_tracker_track(by, item, 0, to), VXT_ERROR_INVALID_ARGUMENT);
        return std::string(vxt_last_error(nullptr));
    };
    EXPECT_EQ(refusal(nullptr, &c.item, &found), "tracker is null");
    EXPECT_EQ(refusal(tracker.get(), nullptr, &found), "item is null");
    c.item.world_from_object = scene.poses.data()->data();
    EXPECT_EQ(refusal(tracker.get(), &c.item, nullptr), "tracked is null");
    c.item.pose_count = 2;
    EXPECT_THAT(refusal(tracker.get(), &c.item, &found), HasSubstr("one pose"));
    vxt_tracker* none = nullptr;
    EXPECT_EQ(vxt_tracker_create(-1, 0, 0, &none), VXT_ERROR_INVALID_ARGUMENT);
    EXPECT_EQ(vxt_tracker_create(0, 2, 0, &none), VXT_ERROR_INVALID_ARGUMENT);
    EXPECT_EQ(vxt_tracker_create(0, 0, 0, nullptr), VXT_ERROR_INVALID_ARGUMENT);
}

TEST(CPoseBetween, IsTheCppInterfaces) {
    std::mt19937_64 random(testSeed());
    const Mat4 from = randomMotion(random);
    const Mat4 to = randomMotion(random);
    const Vec3 centre{1, 2, 3};
    Mat4 pose{};
    need(vxt_pose_between(from.data(), to.data(), 0.3, VXT_INTERPOLATION_SCREW, nullptr, pose.data()));
    EXPECT_EQ(pose, take(poseBetween(from, to, 0.3)));
    need(vxt_pose_between(from.data(), to.data(), 0.3, VXT_INTERPOLATION_SLERP, centre.data(), pose.data()));
    EXPECT_EQ(pose, take(poseBetween(from, to, 0.3, Interpolation::Slerp, centre)));
    const auto refused = [&](const double* a, const double* b, double at, const double* c, double* out) {
        EXPECT_EQ(vxt_pose_between(a, b, at, VXT_INTERPOLATION_SLERP, c, out), VXT_ERROR_INVALID_ARGUMENT);
        return std::string(vxt_last_error(nullptr));
    };
    EXPECT_EQ(refused(nullptr, to.data(), 0, centre.data(), pose.data()), "from is null");
    EXPECT_EQ(refused(from.data(), nullptr, 0, centre.data(), pose.data()), "to is null");
    EXPECT_EQ(refused(from.data(), to.data(), 0, nullptr, pose.data()), "centre is null");
    EXPECT_EQ(refused(from.data(), to.data(), 0, centre.data(), nullptr), "world_from_object is null");
    EXPECT_EQ(refused(from.data(), to.data(), 2, centre.data(), pose.data()), "the parameter 2 is outside of 0 to 1");
    for (const int none : {-1, 2, 77}) {
        EXPECT_EQ(
            vxt_pose_between(from.data(), to.data(), 0.3, static_cast<vxt_interpolation>(none), nullptr, pose.data()),
            VXT_ERROR_INVALID_ARGUMENT);
        EXPECT_EQ(std::string(vxt_last_error(nullptr)),
                  "there is no interpolation number " + std::to_string(static_cast<std::uint32_t>(none)));
    }
}

/// What is refused, without a change of the answer.
class CRefusals : public testing::Test {
  protected:
    CRefusals() { both_.fill(c_, scene_); }
    template <class Question> std::string refused(const Question& question) { return refused(question, c_.pairs); }
    template <class Question> std::string refused(const Question& question, const vxt_pairs& pairs) {
        EXPECT_EQ(askC(engine_.get(), &question, &pairs, answer_.get()), VXT_ERROR_INVALID_ARGUMENT);
        EXPECT_EQ(vxt_answer_columns(answer_.get()), 0U);
        EXPECT_EQ(std::string(vxt_last_error(nullptr)).find('\n'), std::string::npos);
        return vxt_last_error(nullptr);
    }
    template <class Question> std::string refusedWith(auto member, auto value) {
        Question question = sized<Question>();
        question.*member = value;
        return refused(question);
    }

    RandomScene scene_ = plainScene();
    BothInterfaces both_{scene_, plainLabels()};
    Owned<vxt_host_engine> engine_ = newEngine();
    Owned<vxt_answer> answer_ = newAnswer();
    BothInterfaces::CPairs c_;
};

TEST_F(CRefusals, OfNull) {
    const auto expectRefused = [&]<class Question>(const Question& question) {
        const auto text = [&](vxt_host_engine* engine, const vxt_pairs* pairs, vxt_answer* answer) {
            EXPECT_EQ(askC(engine, &question, pairs, answer), VXT_ERROR_INVALID_ARGUMENT);
            return std::string(vxt_last_error(nullptr));
        };
        EXPECT_EQ(text(nullptr, &c_.pairs, answer_.get()), "engine is null");
        EXPECT_EQ(text(engine_.get(), nullptr, answer_.get()), "pairs is null");
        EXPECT_EQ(text(engine_.get(), &c_.pairs, nullptr), "answer is null");
        vxt_pairs pairs = c_.pairs;
        pairs.items = nullptr;
        EXPECT_EQ(text(engine_.get(), &pairs, answer_.get()), "items is null");
        // Nothing to do is done.
        pairs.item_count = 0;
        const Owned<vxt_answer> empty = newAnswer();
        need(askC(engine_.get(), &question, &pairs, empty.get()));
        vxt_column column = sized<vxt_column>();
        need(vxt_answer_column(empty.get(), 0, &column));
        EXPECT_EQ(column.rows, 0U);
        EXPECT_EQ(column.data, nullptr);
        Question unsized = question;
        unsized.struct_size = 3;
        EXPECT_THAT(refused(unsized), HasSubstr("question: struct_size is 3"));
        pairs = c_.pairs;
        pairs.struct_size = 0;
        EXPECT_THAT(refused(question, pairs), HasSubstr("pairs: struct_size is 0"));
    };
    expectRefused(sized<vxt_touch>());
    expectRefused(sized<vxt_count>());
    expectRefused(sized<vxt_distance>());
    expectRefused(sized<vxt_area>());
    expectRefused(sized<vxt_motion>());
    const vxt_host_item item = c_.item;
    const auto refusedWithout = [&](auto member) {
        c_.item.*member = nullptr;
        const std::string text = refused(sized<vxt_touch>());
        c_.item = item;
        return text;
    };
    EXPECT_THAT(refusedWithout(&vxt_host_item::mesh), HasSubstr("item 0: mesh"));
    EXPECT_THAT(refusedWithout(&vxt_host_item::volume), HasSubstr("item 0: mesh, volume"));
    EXPECT_THAT(refusedWithout(&vxt_host_item::transfer_function), HasSubstr("is null"));
    EXPECT_EQ(refusedWithout(&vxt_host_item::world_from_object), "item 0: world_from_object is null");
}

TEST_F(CRefusals, OfNumbersOutsideTheirRanges) {
    const double nan = std::nan("");
    EXPECT_THAT(refusedWith<vxt_touch>(&vxt_touch::margin, -1), HasSubstr("margin"));
    EXPECT_THAT(refusedWith<vxt_touch>(&vxt_touch::uncertainty_distance, -1), HasSubstr("distance"));
    EXPECT_THAT(refusedWith<vxt_touch>(&vxt_touch::uncertainty_angle, 181), HasSubstr("angle"));
    vxt_touch both = sized<vxt_touch>();
    both.margin = both.uncertainty_distance = 1;
    EXPECT_THAT(refused(both), HasSubstr("margin and an uncertain pose"));
    EXPECT_THAT(refusedWith<vxt_touch>(&vxt_touch::resolution, 2), HasSubstr("resolution"));
    EXPECT_THAT(refusedWith<vxt_count>(&vxt_count::projection, static_cast<vxt_projection>(4)),
                HasSubstr("projection"));
    EXPECT_THAT(refusedWith<vxt_count>(&vxt_count::boundary, static_cast<vxt_boundary>(77)), HasSubstr("boundary"));
    EXPECT_THAT(refusedWith<vxt_count>(&vxt_count::samples_per_voxel, 17), HasSubstr("samples"));
    EXPECT_THAT(refusedWith<vxt_distance>(&vxt_distance::tolerance, -1), HasSubstr("tolerance"));
    EXPECT_THAT(refusedWith<vxt_distance>(&vxt_distance::max, nan), HasSubstr("max"));
    EXPECT_EQ(refusedWith<vxt_distance>(&vxt_distance::label_count, 1), "labels is null");
    EXPECT_THAT(refusedWith<vxt_area>(&vxt_area::tolerance, nan), HasSubstr("tolerance"));
    EXPECT_EQ(refusedWith<vxt_area>(&vxt_area::label_count, 1), "labels is null");
    EXPECT_THAT(refusedWith<vxt_motion>(&vxt_motion::resolution, 1e-9), HasSubstr("resolution"));
    EXPECT_THAT(refusedWith<vxt_motion>(&vxt_motion::interpolation, static_cast<vxt_interpolation>(9)),
                HasSubstr("interpolation"));
    vxt_pairs pairs = c_.pairs;
    pairs.opacity_threshold = 2;
    EXPECT_THAT(refused(sized<vxt_touch>(), pairs), HasSubstr("threshold"));
    pairs = c_.pairs;
    pairs.view = nullptr; // the projection VIEW has a camera
    refused(sized<vxt_count>(), pairs);
    vxt_count outputs = sized<vxt_count>();
    outputs.outputs = 16;
    EXPECT_EQ(vxt_ask_count(engine_.get(), &outputs, &c_.pairs, answer_.get()), VXT_ERROR_UNSUPPORTED);
    EXPECT_THAT(vxt_last_error(nullptr), HasSubstr("outputs"));
    vxt_host_engine* none = nullptr;
    EXPECT_EQ(vxt_host_engine_create(cpu::kMaxThreads + 1, &none), VXT_ERROR_LIMIT_EXCEEDED);
    EXPECT_EQ(none, nullptr);
}

} // namespace
} // namespace voxtact::test
