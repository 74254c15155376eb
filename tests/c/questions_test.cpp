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

void expectSame(const vxt_answer& c, const OverlapAnswer& cpp) {
    Columns columns(c);
    columns.expectBounds("pairs", cpp.pairs);
    columns.expect("pairs", "inside", cpp.pairs, &PairOverlap::inside);
    columns.expect("pairs", "solid_lower", cpp.pairs, [](const PairOverlap& row) { return row.solid.lower; });
    columns.expect("pairs", "solid_upper", cpp.pairs, [](const PairOverlap& row) { return row.solid.upper; });
    columns.expectBounds("bands", cpp.bands);
    columns.expect("bands", "pair", cpp.bands, &BandOverlap::pair);
    columns.expect("bands", "band", cpp.bands, &BandOverlap::band);
    columns.expect("bands", "from", cpp.bands, &BandOverlap::from);
    columns.expect("bands", "below", cpp.bands, &BandOverlap::below);
    columns.expectBounds("labels", cpp.labels);
    columns.expect("labels", "pair", cpp.labels, &LabelOverlap::pair);
    columns.expect("labels", "label", cpp.labels, &LabelOverlap::label);
    columns.expect("labels", "inside", cpp.labels, &LabelOverlap::inside);
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

const char* nameOf(const Touch&) {
    return "touch";
}
const char* nameOf(const Count&) {
    return "count";
}
const char* nameOf(const Distance&) {
    return "distance";
}
const char* nameOf(const Area&) {
    return "area";
}
const char* nameOf(const Overlap&) {
    return "overlap";
}
const char* nameOf(const Motion&) {
    return "motion";
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
    /// Asks both. The settings are the members of the question that are not defaults.
    template <class Question>
    auto compare(const BothInterfaces& both, const RandomScene& scene, const Settings& settings,
                 const Question& question) {
        const Owned<vxt_answer> answer = both.byC(*c_, nameOf(question), settings, scene);
        const auto expected = both.byCpp(cpp_, question, scene);
        expectSame(*answer, expected);
        return expected;
    }
    void see(const char* what, bool isSeen) { seen_[what] += isSeen ? 1 : 0; }

    void compareTouch(const BothInterfaces& both, const RandomScene& scene) {
        Touch question{.margin = 1.5, .witness = true, .resolution = 1.0 / 8, .maxSteps = 300};
        const Settings given{{"margin", 1.5}, {"witness", 1}, {"resolution", 1.0 / 8}, {"max_steps", 300}};
        for (const PairTouch& pair : compare(both, scene, given, question).pairs) {
            see(toString(pair.touch), true);
            see("witness point", pair.witness.has_value());
        }
        question = {.uncertainty = PoseTolerance{1.5, 3}, .maxSteps = 300};
        compare(both, scene, {{"uncertainty_distance", 1.5}, {"uncertainty_angle", 3}, {"max_steps", 300}}, question);
        question.uncertainty->distance = 0;
        compare(both, scene, {{"uncertainty_angle", 3}, {"max_steps", 300}}, question);
        question.uncertainty = PoseTolerance{1.5, 0};
        compare(both, scene, {{"uncertainty_distance", 1.5}, {"max_steps", 300}}, question);
    }

    void compareDistance(const BothInterfaces& both, const RandomScene& scene) {
        Distance question{.tolerance = 0.1, .maximum = 20, .resolution = 1.0 / 8, .maxSteps = 500};
        const Settings given{{"tolerance", 0.1}, {"max", 20}, {"resolution", 1.0 / 8}, {"max_steps", 500}};
        for (const PairDistance& pair : compare(both, scene, given, question).pairs) {
            see("distance above 0", pair.bounds.lower > 0);
            see("closest points", pair.closest.has_value());
        }
        const std::vector<std::int32_t> labels{both.labels.values.back(), 0, 12345};
        question = {.tolerance = 0.1, .labels = labels, .maxSteps = 500};
        const Settings toLabels{{"tolerance", 0.1}, {"labels", labels}, {"max_steps", 500}};
        for (const LabelDistance& label : compare(both, scene, toLabels, question).labels) {
            see("distance to a label", std::isfinite(label.bounds.upper));
        }
        question.labelsAtAnyOpacity = true;
        compare(both, scene, {{"tolerance", 0.1}, {"labels", labels}, {"max_steps", 500}, {"any_opacity", 1}},
                question);
    }

    void compareArea(const BothInterfaces& both, const RandomScene& scene) {
        const Area question{.tolerance = 1e-3, .triangles = true, .resolution = 1.0 / 8, .maxSteps = 100};
        const Settings given{{"tolerance", 1e-3}, {"triangles", 1}, {"resolution", 1.0 / 8}, {"max_steps", 100}};
        const AreaAnswer answer = compare(both, scene, given, question);
        see("area of a triangle", !answer.triangles.empty());
        for (const PairArea& pair : answer.pairs) {
            see("area above 0", pair.bounds.lower > 0);
            see("too many steps", pair.end == StopReason::Budget);
        }
        const std::vector<std::int32_t> labels{2, 0, 12345};
        const Settings inLabels{{"tolerance", 1e-3}, {"labels", labels}, {"resolution", 1.0 / 8}, {"max_steps", 100}};
        const Area ofLabels{.tolerance = 1e-3, .labels = labels, .resolution = 1.0 / 8, .maxSteps = 100};
        for (const LabelArea& label : compare(both, scene, inLabels, ofLabels).labels) {
            see("area in a label", label.bounds.lower > 0);
        }
    }

    void compareMotion(const BothInterfaces& both, const RandomScene& scene) {
        const Motion question{
            .interpolation = Interpolation::Slerp, .resolution = 0.1, .touchResolution = 1.0 / 8, .maxSteps = 5000};
        const Settings given{
            {"interpolation", "slerp"}, {"resolution", 0.1}, {"touch_resolution", 1.0 / 8}, {"max_steps", 5000}};
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
        const char* const name = toString(projection);
        Count question{.projection = projection,
                       .boundary = Boundary::Range,
                       .samplesPerVoxel = 2,
                       .resolution = 1.0 / 8,
                       .maxContacts = 500};
        const NamedValue common[] = {{"projection", name},
                                     {"boundary", "range"},
                                     {"samples_per_voxel", 2},
                                     {"resolution", 1.0 / 8},
                                     {"max_contacts", 500}};
        const Settings outputs(
            common, {{"triangles", 1}, {"contacts", 1}, {"bounds", 1}, {"labels", 1}, {"max_depth", kAll.maxDepth}});
        std::size_t contacts = 0;
        for (int round = 0; (round < 6 || contacts < 300) && round < 100 && !HasFailure(); ++round) {
            const std::uint64_t seed = random();
            SCOPED_TRACE("scene " + std::to_string(seed));
            std::mt19937_64 local(seed);
            RandomScene scene = makeRandomSceneForC(local, 4);
            scene.view.width = std::min(scene.view.width, 100U);
            scene.view.height = std::min(scene.view.height, 100U);
            const BothInterfaces both(scene, makeLabelImage(local, scene.volume.grid));
            compare(both, scene, Settings(common), question);
            question.stopAtFirst = true;
            compare(both, scene, Settings(common, {{"stop_at_first", 1}}), question);
            question.stopAtFirst = false;
            question.outputs = kAll;
            const BatchAnswer expected = both.byCpp(cpp_, question, scene);
            const BatchAnswer found = answerOf(*both.byC(*c_, "count", outputs, scene));
            // A list that is cut is cut arbitrarily.
            if (expected.contactsFound <= 500) {
                EXPECT_EQ(wholeDifferenceOf(found, expected), "");
            } else {
                EXPECT_EQ(found.contactsFound, expected.contactsFound);
                EXPECT_EQ(found.contacts.size(), 500U);
            }
            contacts += found.contacts.size();
            question.outputs = {};
        }
        std::cout << toString(projection) << ": " << contacts << " contacts\n";
        EXPECT_GE(contacts, 300U);
    }
}

TEST_F(CQuestions, WithoutSettingsHaveTheDefaultsOfTheFacts) {
    RandomScene scene = plainScene();
    scene.mesh = closedCube(0, 2);
    scene.threshold = kDefaultThreshold;
    const BothInterfaces both(scene, plainLabels());
    const auto expectDefault = [&]<class Question>(const Question& question) {
        const auto expected = compare(both, scene, {}, question);
        BothInterfaces::CPairs c;
        both.fill(c, scene);
        c.pairs.opacity_threshold = 0;
        const Owned<vxt_answer> answer = newAnswer();
        need(vxt_ask(c_.get(), nameOf(question), nullptr, 0, &c.pairs, answer.get()));
        expectSame(*answer, expected);
        for (const vxt_fact& fact : factsOf(nameOf(question))) {
            SCOPED_TRACE(std::string(nameOf(question)) + " " + fact.name);
            const std::string choice = firstChoice(fact);
            if (fact.kind == VXT_FACT_CHOICE) {
                compare(both, scene, {{fact.name, choice.c_str()}}, question);
            } else if (fact.has_standard != 0) {
                compare(both, scene, {{fact.name, fact.standard}}, question);
            }
        }
    };
    expectDefault(Touch{});
    expectDefault(Count{});
    expectDefault(Distance{});
    expectDefault(Area{});
    expectDefault(Overlap{});
    expectDefault(Motion{});
}

TEST_F(CQuestions, SolidsHaveAPointInside) {
    RandomScene scene = plainScene();
    scene.mesh = closedCube(-20, 40);
    scene.poses = {identity(), translation({100, 0, 0})};
    const BothInterfaces both(scene, plainLabels());
    const TouchAnswer touched =
        compare(both, scene, {{"witness", 1}, {"solid", 1}}, Touch{.witness = true, .solid = true});
    EXPECT_EQ(touched.pairs.at(0).touch, Verdict::Yes);
    EXPECT_EQ(touched.pairs.at(1).touch, Verdict::No);
    ASSERT_TRUE(touched.pairs[0].witness.has_value());
    EXPECT_EQ(touched.pairs[0].witness->triangle, kInsideMesh);
    const DistanceAnswer measured = compare(both, scene, {{"solid", 1}}, Distance{.solid = true});
    EXPECT_EQ(measured.pairs.at(0).bounds.upper, 0);
    EXPECT_GT(measured.pairs.at(1).bounds.lower, 70);
    ASSERT_TRUE(measured.pairs[0].closest.has_value());
    EXPECT_EQ(measured.pairs[0].closest->triangle, kInsideMesh);
}

TEST_F(CQuestions, MeasureOverlapsByBandAndByLabel) {
    RandomScene scene = plainScene();
    scene.mesh = closedCube(0, 3);
    const BothInterfaces both(scene, plainLabels());
    const std::vector<double> bands{50, 150};
    const std::vector<std::int32_t> labels{0, 4, 12345};
    const OverlapAnswer answer =
        compare(both, scene, {{"tolerance", 0.1}, {"bands", bands}, {"labels", labels}, {"max_steps", 2000}},
                Overlap{.tolerance = 0.1, .bandLimits = bands, .labels = labels, .maxSteps = 2000});
    EXPECT_GT(answer.pairs.at(1).bounds.lower, 0);
    EXPECT_EQ(answer.bands.size(), 9U);
    EXPECT_EQ(answer.labels.size(), 9U);
}

TEST_F(CQuestions, MeasureALabelAtAnyOpacity) {
    RandomScene scene = plainScene();
    scene.poses.resize(1);
    const BothInterfaces both(scene, plainLabels());
    const std::vector<std::int32_t> label{4};
    const auto distance = [&](const Settings& settings) {
        const auto upper = readColumn<double>(*both.byC(*c_, "distance", settings, scene), "labels", "upper");
        EXPECT_EQ(upper.size(), 1U);
        return upper.at(0);
    };
    EXPECT_EQ(distance({{"labels", label}}), std::numeric_limits<double>::infinity());
    EXPECT_NEAR(distance({{"labels", label}, {"any_opacity", 1}}), 4.5, 0.01); // from 7, the end of the cube, to 11.5
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

} // namespace
} // namespace voxtact::test
