// SPDX-License-Identifier: MIT
// Questions, facts and settings of the C interface: the list of questions, their facts, and refused calls.
#include "both_interfaces.h"

#include <gmock/gmock.h>

#include <cmath>
#include <limits>
#include <sstream>

namespace voxtact::test {
namespace {

using testing::HasSubstr;

TEST(CQuestionList, NamesTheQuestionsInOrder) {
    EXPECT_THAT(questionNames(),
                testing::ElementsAre(testing::StrEq("touch"), testing::StrEq("count"), testing::StrEq("distance"),
                                     testing::StrEq("area"), testing::StrEq("overlap"), testing::StrEq("motion")));
    vxt_question question = sized<vxt_question>();
    for (std::size_t i = 0; i < vxt_question_count(); ++i) {
        need(vxt_question_get(i, &question));
        const std::string name = question.name;
        EXPECT_STRNE(question.text, "");
        EXPECT_EQ(question.measures != 0, name == "distance" || name == "area" || name == "overlap");
        EXPECT_EQ(question.least_worst != 0, name == "distance");
    }
    EXPECT_EQ(vxt_question_get(vxt_question_count(), &question), VXT_ERROR_NOT_READY);
    EXPECT_EQ(vxt_question_get(0, nullptr), VXT_ERROR_INVALID_ARGUMENT);
}

/// A scene for all questions, and calls that leave the answer as it was.
class CRefusals : public testing::Test {
  protected:
    CRefusals() { both_.fill(c_, scene_); }
    static RandomScene makeScene() {
        RandomScene scene = plainScene();
        scene.mesh = closedCube(0, 2);
        return scene;
    }
    std::string refused(const char* question, const Settings& settings = {}) {
        return refused(question, settings, c_.pairs);
    }
    std::string refused(const char* question, const Settings& settings, const vxt_pairs& pairs) {
        EXPECT_EQ(askC(engine_.get(), question, settings, &pairs, answer_.get()), VXT_ERROR_INVALID_ARGUMENT);
        EXPECT_EQ(vxt_answer_columns(answer_.get()), 0U);
        EXPECT_EQ(std::string(vxt_last_error(nullptr)).find('\n'), std::string::npos);
        return vxt_last_error(nullptr);
    }

    RandomScene scene_ = makeScene();
    BothInterfaces both_{scene_, plainLabels()};
    Owned<vxt_host_engine> engine_ = newEngine();
    Owned<vxt_answer> answer_ = newAnswer();
    BothInterfaces::CPairs c_;
};

TEST_F(CRefusals, OfNull) {
    const auto expectRefused = [&](const char* question) {
        SCOPED_TRACE(question);
        const auto text = [&](vxt_host_engine* engine, const vxt_pairs* pairs, vxt_answer* answer) {
            EXPECT_EQ(askC(engine, question, {}, pairs, answer), VXT_ERROR_INVALID_ARGUMENT);
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
        need(askC(engine_.get(), question, {}, &pairs, empty.get()));
        vxt_column column = sized<vxt_column>();
        need(vxt_answer_column(empty.get(), 0, &column));
        EXPECT_EQ(column.rows, 0U);
        EXPECT_EQ(column.data, nullptr);
        pairs = c_.pairs;
        pairs.struct_size = 0;
        EXPECT_THAT(refused(question, {}, pairs), HasSubstr("pairs: struct_size is 0"));
    };
    for (const char* const question : questionNames()) {
        expectRefused(question);
    }
    EXPECT_EQ(refused(nullptr), "question is null");
    EXPECT_EQ(vxt_ask(engine_.get(), "touch", nullptr, 1, &c_.pairs, answer_.get()), VXT_ERROR_INVALID_ARGUMENT);
    EXPECT_STREQ(vxt_last_error(nullptr), "settings is null");
    const vxt_host_item item = c_.item;
    const auto refusedWithout = [&](auto member) {
        c_.item.*member = nullptr;
        const std::string text = refused("touch");
        c_.item = item;
        return text;
    };
    EXPECT_THAT(refusedWithout(&vxt_host_item::mesh), HasSubstr("item 0: mesh"));
    EXPECT_THAT(refusedWithout(&vxt_host_item::volume), HasSubstr("item 0: mesh, volume"));
    EXPECT_THAT(refusedWithout(&vxt_host_item::transfer_function), HasSubstr("is null"));
    EXPECT_EQ(refusedWithout(&vxt_host_item::world_from_object), "item 0: world_from_object is null");
}

TEST_F(CRefusals, OfNamesThatAreNone) {
    EXPECT_EQ(refused("plan"), "there is no question 'plan'; there are touch, count, distance, area, overlap, motion");
    EXPECT_THAT(refused(""), HasSubstr("there is no question ''"));
    EXPECT_EQ(refused("motion", {{"speed", 1}}),
              "motion has no setting 'speed'; it has interpolation, resolution, touch_resolution, max_steps");
    EXPECT_THAT(refused("touch", {{"Margin", 1}}), HasSubstr("touch has no setting 'Margin'"));
    EXPECT_THAT(refused("touch", {{nullptr, 1}}), HasSubstr("the name of a setting is null"));
    EXPECT_THAT(refused("count", {{"projection", "sideways"}}),
                HasSubstr("'sideways'; it is one of view,two-view,dominant-axis,certified"));
    EXPECT_THAT(refused("count", {{"boundary", "cla"}}), HasSubstr("'cla'; it is one of auto,range,clamp"));
    EXPECT_THAT(refused("motion", {{"interpolation", ""}}), HasSubstr("''; it is one of screw,slerp"));
}

TEST_F(CRefusals, OfValuesOfAnotherKind) {
    const std::vector<double> numbers{1};
    const std::vector<std::int32_t> labels{4};
    const char* const other = "has a value of another kind";
    EXPECT_THAT(refused("distance", {{"tolerance", "0.1"}}), HasSubstr(other));
    EXPECT_THAT(refused("distance", {{"tolerance", numbers}}), HasSubstr(other));
    EXPECT_THAT(refused("distance", {{"max_steps", "many"}}), HasSubstr(other));
    EXPECT_THAT(refused("distance", {{"solid", "yes"}}), HasSubstr("the setting 'solid' has a value of another kind"));
    EXPECT_THAT(refused("distance", {{"labels", numbers}}), HasSubstr(other));
    EXPECT_THAT(refused("distance", {{"labels", 4}}), HasSubstr("it takes a list"));
    EXPECT_THAT(refused("overlap", {{"bands", labels}}), HasSubstr(other));
    EXPECT_THAT(refused("count", {{"projection", 3}}), HasSubstr(other));
    EXPECT_THAT(refused("distance", {{"max", 1}, {"tolerance", 1}, {"max", 1}}),
                HasSubstr("the setting 'max' is given twice"));
    EXPECT_THAT(refused("touch", {{"witness", 2}}), HasSubstr("the witness 2 is not 0 or 1"));
    EXPECT_THAT(refused("touch", {{"witness", std::nan("")}}), HasSubstr("is not 0 or 1"));
    for (const double none : {0.5, -1.0, std::nan(""), std::numeric_limits<double>::infinity()}) {
        EXPECT_THAT(refused("touch", {{"max_steps", none}}), HasSubstr("is not a whole number from 1"));
        EXPECT_THAT(refused("count", {{"max_contacts", none}}), HasSubstr("is not a whole number from 1"));
    }
    EXPECT_THAT(refused("count", {{"max_contacts", 0x1p32}}), HasSubstr("is not a whole number from 1 to 4294967295"));
    NamedValue both("projection", "view");
    both.setting.numbers = numbers.data();
    both.setting.count = 1;
    EXPECT_THAT(refused("count", {both}), HasSubstr("more than one of text, numbers and labels"));
    NamedValue missing("labels", labels);
    missing.setting.labels = nullptr;
    EXPECT_THAT(refused("distance", {missing}), HasSubstr(other));
}

TEST_F(CRefusals, OfNumbersOutsideTheirRanges) {
    EXPECT_THAT(refused("touch", {{"margin", -1}}), HasSubstr("margin"));
    EXPECT_THAT(refused("touch", {{"uncertainty_distance", -1}}), HasSubstr("distance"));
    EXPECT_THAT(refused("touch", {{"uncertainty_angle", 181}}), HasSubstr("angle"));
    EXPECT_THAT(refused("touch", {{"margin", 1}, {"uncertainty_distance", 1}}),
                HasSubstr("margin and an uncertain pose"));
    EXPECT_THAT(refused("touch", {{"resolution", 2}}), HasSubstr("resolution"));
    EXPECT_THAT(refused("count", {{"samples_per_voxel", 17}}), HasSubstr("samples"));
    EXPECT_THAT(refused("distance", {{"tolerance", -1}}), HasSubstr("tolerance"));
    EXPECT_THAT(refused("distance", {{"max", std::nan("")}}), HasSubstr("max"));
    EXPECT_THAT(refused("area", {{"tolerance", std::nan("")}}), HasSubstr("tolerance"));
    EXPECT_THAT(refused("motion", {{"resolution", 1e-9}}), HasSubstr("resolution"));
    // 0 is a number like others, not the default.
    EXPECT_THAT(refused("distance", {{"tolerance", 0}}), HasSubstr("the tolerance 0 mm is not a number"));
    EXPECT_THAT(refused("distance", {{"max", 0}}), HasSubstr("the max 0 mm is not a number above 0 mm"));
    EXPECT_THAT(refused("count", {{"samples_per_voxel", 0}}), HasSubstr("samples"));
    EXPECT_THAT(refused("motion", {{"touch_resolution", 0}}), HasSubstr("resolution"));
    for (const char* const question : {"touch", "distance", "area", "overlap", "motion"}) {
        EXPECT_THAT(refused(question, {{"max_steps", 0}}),
                    HasSubstr("the max steps 0 is not a whole number from 1 on"));
    }
    vxt_pairs pairs = c_.pairs;
    pairs.opacity_threshold = 2;
    EXPECT_THAT(refused("touch", {}, pairs), HasSubstr("threshold"));
    pairs = c_.pairs;
    pairs.view = nullptr; // the projection VIEW has a camera
    refused("count", {}, pairs);
    vxt_host_engine* none = nullptr;
    EXPECT_EQ(vxt_host_engine_create(cpu::kMaxThreads + 1, &none), VXT_ERROR_LIMIT_EXCEEDED);
    EXPECT_EQ(none, nullptr);
}

/// A list that is empty selects its rows: none.
TEST_F(CRefusals, AreNotThoseOfAnEmptyList) {
    const std::int32_t label = 4;
    const std::span<const std::int32_t> none(&label, 0);
    for (const char* const question : {"distance", "area", "overlap"}) {
        need(askC(engine_.get(), question, {{"labels", none}}, &c_.pairs, answer_.get()));
        EXPECT_EQ(findColumn(*answer_, "labels", "lower").rows, 0U) << question;
    }
    const double limit = 0;
    need(askC(engine_.get(), "overlap", {{"bands", std::span(&limit, 0)}}, &c_.pairs, answer_.get()));
    EXPECT_EQ(findColumn(*answer_, "bands", "lower").rows, 0U);
    EXPECT_EQ(findColumn(*answer_, "pairs", "lower").rows, 3U);
}

/// The table of facts and the questions have the same settings, of the same kinds.
TEST_F(CRefusals, AreNotThoseOfAFact) {
    const std::vector<double> numbers{100};
    const std::vector<std::int32_t> labels{4};
    for (const char* const question : questionNames()) {
        std::vector<std::string> names;
        for (const vxt_fact& fact : factsOf(question)) {
            SCOPED_TRACE(std::string(question) + " " + fact.name);
            const std::string choice = firstChoice(fact);
            NamedValue value(fact.name, fact.has_standard != 0 ? fact.standard : 1);
            if (fact.kind == VXT_FACT_CHOICE) {
                value = {fact.name, choice.c_str()};
            } else if (fact.kind == VXT_FACT_NUMBERS) {
                value = {fact.name, numbers};
            } else if (fact.kind == VXT_FACT_LABELS) {
                value = {fact.name, labels};
            }
            const Owned<vxt_answer> answer = newAnswer();
            EXPECT_EQ(askC(engine_.get(), question, {value}, &c_.pairs, answer.get()), VXT_OK)
                << vxt_last_error(nullptr);
            names.emplace_back(fact.name);
        }
        std::vector<std::string> listed;
        const std::string text = refused(question, {{"nothing", 1}});
        const std::string start = std::string(question) + " has no setting 'nothing'; it has ";
        ASSERT_EQ(text.substr(0, start.size()), start);
        std::istringstream list(text.substr(start.size()));
        for (std::string name; std::getline(list >> std::ws, name, ',');) {
            listed.push_back(name);
        }
        EXPECT_THAT(listed, testing::UnorderedElementsAreArray(names)) << question;
    }
}

} // namespace
} // namespace voxtact::test
