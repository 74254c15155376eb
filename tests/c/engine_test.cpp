// SPDX-License-Identifier: MIT
// The host engine through the C interface: edits, threads, cancelled calls, and the columns of its answers.
#include "both_interfaces.h"
#include "core/facts/facts.h"
#include "support/contact_scenes.h"
#include "support/scenes.h"
#include "voxtact/plan.h"

#include <gmock/gmock.h>

#include <map>
#include <set>
#include <thread>

namespace voxtact::test {
namespace {

using testing::HasSubstr;

/// A square at z = 0.5 on 16 by 16 pixels, in a volume that is opaque up to x = 0.5.
class CEngine : public testing::Test {
  protected:
    CEngine() {
        scene_.volume = makeBytes(unitGrid(4), [](std::uint32_t x, auto, auto) { return x < 2 ? 255.0 : 0.0; });
        scene_.points = {{127, 0}, {127, 1}};
        scene_.domain = {0, 255};
        scene_.tableSize = 2;
        scene_.mesh = makeFlat(0, 1, 0, 1, 0.5);
        scene_.view = flatView(0, 1, 16, 16);
        scene_.poses = {identity()};
        scene_.threshold = 0.5;
        both_.emplace(scene_, makeLabelImage(random_, scene_.volume.grid));
        both_->fill(c_, scene_);
    }
    [[nodiscard]] BatchAnswer byC() const { return answerOf(*both_->byC(*engine_, "count", {}, scene_)); }
    [[nodiscard]] BatchAnswer byCpp() { return both_->byCpp(cpp_, Count{}, scene_); }
    [[nodiscard]] std::uint64_t count() const { return byC().pairs.at(0).count; }

    std::mt19937_64 random_{testSeed()};
    RandomScene scene_;
    std::optional<BothInterfaces> both_;
    BothInterfaces::CPairs c_;
    Owned<vxt_host_engine> engine_ = newEngine(0);
    cpu::HostEngine cpp_ = take(cpu::HostEngine::create());
};

TEST_F(CEngine, SeesEdits) {
    vxt_host_volume* const volume = both_->cVolumeHandle.get();
    EXPECT_EQ(count(), byCpp().pairs[0].count);
    EXPECT_GT(count(), 0U);

    const vxt_voxel_box box{{2, 0, 0}, {2, 4, 4}};
    need(vxt_host_volume_set_box(volume, &box, 255));
    EXPECT_EQ(count(), 256U); // all opaque: every pixel
    take(both_->volume.set(VoxelBox{{2, 0, 0}, {2, 4, 4}}, 255));
    EXPECT_EQ(wholeDifferenceOf(byC(), byCpp()), "");

    const double centre[3] = {0.5, 0.5, 0.5};
    need(vxt_host_volume_set_ball(volume, centre, 0.3, 0));
    take(both_->volume.set(Ball{{0.5, 0.5, 0.5}, 0.3}, 0));
    EXPECT_LT(count(), 256U);
    EXPECT_EQ(wholeDifferenceOf(byC(), byCpp()), "");

    std::vector<std::byte> voxels(64, std::byte{7});
    std::vector<std::byte> expected = voxels;
    const vxt_voxel_box whole{{0, 0, 0}, {4, 4, 4}};
    need(vxt_host_volume_read(volume, &whole, voxels.data(), voxels.size()));
    take(both_->volume.read(VoxelBox{{0, 0, 0}, {4, 4, 4}}, expected));
    EXPECT_EQ(voxels, expected);
    EXPECT_EQ(vxt_host_volume_read(volume, &whole, voxels.data(), 63), VXT_ERROR_INVALID_ARGUMENT);
    EXPECT_EQ(vxt_host_volume_read(volume, &whole, nullptr, 64), VXT_ERROR_INVALID_ARGUMENT);
    const vxt_voxel_box outside{{1, 0, 0}, {4, 4, 4}};
    EXPECT_EQ(vxt_host_volume_read(volume, &outside, voxels.data(), 64), VXT_ERROR_INVALID_ARGUMENT);

    const std::vector<std::byte> none(64, std::byte{0});
    need(vxt_host_volume_write(volume, &whole, none.data(), none.size()));
    EXPECT_EQ(count(), 0U);
    EXPECT_EQ(vxt_host_volume_write(volume, &whole, none.data(), 63), VXT_ERROR_INVALID_ARGUMENT);
    EXPECT_EQ(vxt_host_volume_set_box(volume, &box, 256), VXT_ERROR_INVALID_ARGUMENT);
}

TEST_F(CEngine, SeesABentMesh) {
    std::vector<double> positions = scene_.mesh.positions;
    for (std::size_t at = 0; at < positions.size(); at += 3) {
        positions[at] *= 0.3F;
    }
    vxt_host_mesh* const mesh = both_->cMeshHandle.get();
    const std::uint64_t before = count();
    need(vxt_host_mesh_update(mesh, positions.data(), positions.size() / 3));
    take(both_->mesh.update(positions));
    EXPECT_NE(count(), before);
    EXPECT_EQ(wholeDifferenceOf(byC(), byCpp()), "");
    EXPECT_EQ(vxt_host_mesh_update(mesh, positions.data(), 3), VXT_ERROR_INVALID_ARGUMENT);
    EXPECT_EQ(vxt_host_mesh_update(mesh, nullptr, 4), VXT_ERROR_INVALID_ARGUMENT);
    EXPECT_EQ(vxt_host_mesh_update(mesh, positions.data(), SIZE_MAX / 3 + 2), VXT_ERROR_INVALID_ARGUMENT);
    EXPECT_THAT(vxt_last_error(nullptr), HasSubstr("are too many"));
    EXPECT_EQ(vxt_host_mesh_update(nullptr, positions.data(), 4), VXT_ERROR_INVALID_ARGUMENT);
    EXPECT_EQ(wholeDifferenceOf(byC(), byCpp()), "");
}

/// That of a struct that somebody has filled with zeros: not that everything is opaque.
TEST_F(CEngine, HasTheDefaultThresholdForZero) {
    scene_.threshold = 0;
    const BatchAnswer zero = byC();
    scene_.threshold = kDefaultThreshold;
    EXPECT_EQ(wholeDifferenceOf(zero, byCpp()), "");
    EXPECT_LT(zero.pairs[0].count, 256U);
    EXPECT_GT(zero.pairs[0].count, 0U);
}

TEST_F(CEngine, LeavesTheAnswerAsItWasAfterAFailure) {
    const Owned<vxt_answer> answer = newAnswer();
    need(askC(engine_.get(), "count", {}, &c_.pairs, answer.get()));
    const BatchAnswer before = answerOf(*answer);
    c_.item.mesh = nullptr;
    EXPECT_EQ(askC(engine_.get(), "count", {}, &c_.pairs, answer.get()), VXT_ERROR_INVALID_ARGUMENT);
    EXPECT_THAT(vxt_last_error(nullptr), HasSubstr("mesh"));
    EXPECT_EQ(wholeDifferenceOf(answerOf(*answer), before), "");
    // No camera is needed where the projection has none.
    c_.item.mesh = both_->cMeshHandle.get();
    c_.pairs.view = nullptr;
    need(askC(engine_.get(), "count", {{"projection", "certified"}}, &c_.pairs, answer.get()));
    EXPECT_EQ(answerOf(*answer).pairs.size(), 1U);
    // Another question has other columns.
    need(askC(engine_.get(), "area", {}, &c_.pairs, answer.get()));
    vxt_column column = sized<vxt_column>();
    EXPECT_EQ(vxt_answer_find(answer.get(), "pairs", "count", &column), VXT_ERROR_NOT_READY);
    EXPECT_EQ(readColumn<double>(*answer, "pairs", "lower").size(), 1U);
}

TEST_F(CEngine, IsCancelled) {
    const Owned<vxt_cancel> cancel = newCancel();
    const std::vector<Mat4> poses(200000, identity()); // seconds, where nobody ends it
    c_.item.world_from_object = poses.data()->data();
    c_.item.pose_count = poses.size();
    c_.pairs.cancel = cancel.get();
    const Owned<vxt_answer> answer = newAnswer();
    const auto ask = [&] { return askC(engine_.get(), "touch", {}, &c_.pairs, answer.get()); };
    std::thread other([&] { vxt_cancel_set(cancel.get(), 1); }); // before the call or in it
    EXPECT_EQ(ask(), VXT_ERROR_CANCELLED);
    other.join();
    EXPECT_THAT(vxt_last_error(nullptr), HasSubstr("cancelled"));
    EXPECT_EQ(vxt_answer_columns(answer.get()), 0U) << "the answer holds what it held";
    vxt_cancel_set(cancel.get(), 0);
    c_.item.pose_count = 3;
    need(ask());
    EXPECT_EQ(findColumn(*answer, "pairs", "touch").rows, 3U);
}

TEST_F(CEngine, ErrorsAreTheThreads) {
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
    EXPECT_THAT(after, HasSubstr("nothing"));
    EXPECT_EQ(vxt_last_error(nullptr), here);
    EXPECT_EQ(vxt_last_vk_result(nullptr), 0);
}

TEST_F(CEngine, RunsBesideOthers) {
    EXPECT_EQ(vxt_host_engine_threads(newEngine(3).get()), 3U);
    EXPECT_EQ(vxt_host_engine_threads(engine_.get()), cpp_.threads());
    const BatchAnswer expected = byC();
    std::vector<std::thread> threads;
    std::vector<std::string> differences(4, "not run");
    for (std::string& difference : differences) {
        threads.emplace_back([&] {
            const Owned<vxt_host_engine> own = newEngine();
            difference = "";
            for (int i = 0; i < 50; ++i) {
                difference += wholeDifferenceOf(answerOf(*both_->byC(*own, "count", {}, scene_)), expected);
            }
        });
    }
    for (std::thread& thread : threads) {
        thread.join();
    }
    EXPECT_EQ(differences, std::vector<std::string>(4));
}

/// The names of an enumeration from 0 on, as its column has them.
template <class Enum> std::string namesOf() {
    std::string all;
    for (std::uint32_t number = 0;; ++number) {
        const std::string name = toString(static_cast<Enum>(number));
        if (name == "unknown") {
            return all;
        }
        all += (number == 0 ? "" : ",") + name;
    }
}

TEST_F(CEngine, AnswersDescribeTheirColumns) {
    RandomScene scene = scene_;
    scene.mesh = closedCube(0.2, 0.8); // an overlap is that of a closed mesh
    const BothInterfaces both(scene, makeLabelImage(random_, scene.volume.grid));
    std::vector<std::pair<const char*, Owned<vxt_answer>>> answers;
    for (const char* const question : questionNames()) {
        answers.emplace_back(question, both.byC(*engine_, question, {}, scene));
    }
    vxt_obstacle obstacle{};
    obstacle.volume = c_.item.volume;
    obstacle.transfer_function = c_.item.transfer_function;
    vxt_plan plan = sized<vxt_plan>();
    plan.obstacles = &obstacle;
    plan.obstacle_count = 1;
    plan.entry_radius = 3;
    plan.entries = 12;
    answers.emplace_back("plan", newAnswer());
    need(vxt_ask_plan(engine_.get(), &plan, answers.back().second.get()));

    const std::map<std::string, std::string> ends{{"distance", namesOf<StopReason>()},
                                                  {"area", namesOf<StopReason>()},
                                                  {"overlap", namesOf<StopReason>()},
                                                  {"motion", namesOf<MotionEnd>()},
                                                  {"plan", namesOf<StopReason>()}};
    const std::map<std::string, std::string> choices{
        {"touch", namesOf<Verdict>()},         {"safe", namesOf<Safety>()},
        {"exactness", namesOf<Exactness>()},   {"method", namesOf<CountingMethod>()},
        {"projection", namesOf<Projection>()}, {"inside", namesOf<Containment>()},
    };
    const std::set<std::string> units{"", "mm", "mm^2", "mm^3", "ms", "degrees", "mm/mm", "mm/rad"};
    for (const auto& [question, answer] : answers) {
        std::set<std::pair<std::string, std::string>> names;
        const std::size_t count = vxt_answer_columns(answer.get());
        vxt_column column = sized<vxt_column>();
        for (std::size_t i = 0; i < count; ++i) {
            need(vxt_answer_column(answer.get(), i, &column));
            const std::string name = column.name;
            SCOPED_TRACE(std::string(question) + ": " + column.table + " " + name);
            EXPECT_TRUE(names.emplace(column.table, name).second) << "twice";
            EXPECT_NE(name, "");
            EXPECT_STRNE(column.table, "");
            EXPECT_STRNE(column.text, "");
            EXPECT_EQ(units.count(column.unit), 1U) << column.unit;
            EXPECT_LE(column.type, VXT_TYPE_DOUBLE);
            EXPECT_GE(column.elements, 1U);
            const bool isOfTriangles = question == std::string("plan") && column.table == std::string("triangles");
            EXPECT_EQ(column.choices, name == "end"                                ? ends.at(question)
                                      : choices.count(name) != 0 && !isOfTriangles ? choices.at(name)
                                                                                   : "");
            const vxt_column found = findColumn(*answer, column.table, column.name);
            EXPECT_EQ(std::memcmp(&found, &column, sizeof found), 0) << "found by name";
        }
        EXPECT_EQ(vxt_answer_column(answer.get(), count, &column), VXT_ERROR_NOT_READY);
        EXPECT_THAT(vxt_last_error(nullptr), HasSubstr("the answer has no column " + std::to_string(count)));
        EXPECT_EQ(vxt_answer_find(answer.get(), "pairs", "nothing", &column), VXT_ERROR_NOT_READY);
        EXPECT_THAT(vxt_last_error(nullptr), HasSubstr("no column 'nothing' in a table 'pairs'"));
        EXPECT_EQ(vxt_answer_find(answer.get(), nullptr, "item", &column), VXT_ERROR_INVALID_ARGUMENT);
        EXPECT_EQ(vxt_answer_find(answer.get(), "pairs", nullptr, &column), VXT_ERROR_INVALID_ARGUMENT);
        EXPECT_EQ(vxt_answer_find(answer.get(), "totals", "wall_milliseconds", nullptr), VXT_ERROR_INVALID_ARGUMENT);
        EXPECT_EQ(vxt_answer_column(answer.get(), 0, nullptr), VXT_ERROR_INVALID_ARGUMENT);
    }
}

TEST(CFacts, AreTheTable) {
    ASSERT_EQ(vxt_fact_count(), kFacts.size());
    vxt_fact fact = sized<vxt_fact>();
    for (std::size_t i = 0; i < kFacts.size(); ++i) {
        need(vxt_fact_get(i, &fact));
        const Fact& expected = kFacts.at(i);
        EXPECT_EQ(fact.question, expected.question);
        EXPECT_EQ(fact.name, expected.name);
        EXPECT_EQ(fact.unit, expected.unit);
        EXPECT_EQ(fact.text, expected.text);
        EXPECT_EQ(fact.range, rangeText(expected));
        EXPECT_EQ(fact.min, expected.min);
        EXPECT_EQ(fact.max, expected.max);
        EXPECT_EQ(fact.has_standard != 0, expected.standard.has_value());
        EXPECT_EQ(fact.standard, expected.standard.value_or(0));
        EXPECT_EQ(fact.kind, static_cast<vxt_fact_kind>(expected.kind));
        EXPECT_EQ(fact.choices, expected.choices);
    }
    EXPECT_EQ(vxt_fact_get(kFacts.size(), &fact), VXT_ERROR_NOT_READY);
    EXPECT_EQ(vxt_fact_get(0, nullptr), VXT_ERROR_INVALID_ARGUMENT);
}

} // namespace
} // namespace voxtact::test
