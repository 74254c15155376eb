// SPDX-License-Identifier: MIT
// Structs that begin with their size: older headers' and newer ones'.
#include "support/c_calls.h"
#include "support/scenes.h"

#include <gmock/gmock.h>

#include <cstddef>
#include <cstring>

namespace voxtact::test {
namespace {

using testing::HasSubstr;

/// What a later header might make of a struct.
template <class T> struct Newer {
    T known;
    std::uint64_t added = 0;
};

vxt_result check(const vxt_mesh_view* view) {
    vxt_mesh_facts facts{};
    return vxt_check_mesh(view, &facts);
}

class CStructs : public testing::Test {
  protected:
    MeshData mesh_ = makeCube(0, 1);
    Newer<vxt_mesh_view> view_{cMesh(mesh_)};
};

TEST_F(CStructs, ALargerOneIsAcceptedWhereTheRestIsZero) {
    view_.known.struct_size = sizeof view_;
    EXPECT_EQ(check(&view_.known), VXT_OK);
    view_.added = 1;
    EXPECT_EQ(check(&view_.known), VXT_ERROR_UNSUPPORTED);
    EXPECT_THAT(vxt_last_error(nullptr), HasSubstr("mesh has members that are set and that voxtact"));
}

TEST_F(CStructs, ASizeThatIsNoneIsRefused) {
    for (const std::size_t size : {std::size_t{0}, std::size_t{4}, sizeof(vxt_mesh_view) - 1, std::size_t{1} << 40}) {
        view_.known.struct_size = size;
        EXPECT_EQ(check(&view_.known), VXT_ERROR_INVALID_ARGUMENT);
        EXPECT_THAT(vxt_last_error(nullptr), HasSubstr("mesh: struct_size is " + std::to_string(size)));
    }
}

TEST_F(CStructs, ASmallerOneHasTheDefaultsOfWhatItLacks) {
    // As far as `domain`: the domain and the size of the table are the defaults, not what lies behind.
    const vxt_control_point points[] = {{0, 0}, {1, 1}};
    vxt_transfer_function_desc desc = sized<vxt_transfer_function_desc>();
    desc.points = points;
    desc.point_count = 2;
    desc.domain = {1, 0}; // refused where it is read
    desc.table_size = 0;
    const auto create = [&] {
        vxt_host_transfer_function* function = nullptr;
        const vxt_result result = vxt_host_transfer_function_create(&desc, &function);
        vxt_host_transfer_function_destroy(function);
        return result;
    };
    EXPECT_EQ(create(), VXT_ERROR_INVALID_ARGUMENT);
    desc.struct_size = offsetof(vxt_transfer_function_desc, domain);
    EXPECT_EQ(create(), VXT_OK);
}

TEST_F(CStructs, OnlyWhatTheCallerKnowsIsWritten) {
    vxt_fact fact = sized<vxt_fact>();
    fact.struct_size = offsetof(vxt_fact, text);
    fact.text = "mine";
    need(vxt_fact_get(0, &fact));
    EXPECT_EQ(fact.struct_size, offsetof(vxt_fact, text));
    EXPECT_STREQ(fact.question, "scene");
    EXPECT_STREQ(fact.text, "mine");

    Newer<vxt_fact> newer{sized<vxt_fact>(), 9};
    newer.known.struct_size = sizeof newer;
    need(vxt_fact_get(0, &newer.known));
    EXPECT_EQ(newer.known.struct_size, sizeof newer);
    EXPECT_EQ(newer.added, 0U);
    fact.struct_size = 0;
    EXPECT_EQ(vxt_fact_get(0, &fact), VXT_ERROR_INVALID_ARGUMENT);
}

TEST_F(CStructs, PairsOfALaterHeaderAreAnsweredOrRefused) {
    const auto engine = made(vxt_host_engine_destroy, vxt_host_engine_create, 1);
    const Owned<vxt_answer> answer = newAnswer();
    Newer<vxt_pairs> pairs{sized<vxt_pairs>()};
    pairs.known.struct_size = sizeof pairs;
    const auto ask = [&] { return vxt_ask(engine.get(), "touch", nullptr, 0, &pairs.known, answer.get()); };
    EXPECT_EQ(ask(), VXT_OK);
    pairs.added = 1;
    EXPECT_EQ(ask(), VXT_ERROR_UNSUPPORTED);
    EXPECT_THAT(vxt_last_error(nullptr), HasSubstr("pairs has members that are set"));
    // An earlier header's, which ends before `opacity_threshold`.
    pairs.known.opacity_threshold = 2;
    pairs.known.struct_size = offsetof(vxt_pairs, opacity_threshold);
    EXPECT_EQ(ask(), VXT_OK);
}

TEST_F(CStructs, QuestionsAreDescribedToEveryHeader) {
    Newer<vxt_question> newer{sized<vxt_question>(), 9};
    newer.known.struct_size = sizeof newer;
    need(vxt_question_get(0, &newer.known));
    EXPECT_EQ(newer.known.struct_size, sizeof newer);
    EXPECT_EQ(newer.added, 0U);
    vxt_question older = sized<vxt_question>();
    older.struct_size = offsetof(vxt_question, text);
    older.text = "mine";
    need(vxt_question_get(0, &older));
    EXPECT_STREQ(older.name, "touch");
    EXPECT_STREQ(older.text, "mine");
}

} // namespace
} // namespace voxtact::test
