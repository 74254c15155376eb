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
    // As far as `domain`: the domain and the size of the table are those of the initialiser, not what lies behind.
    const vxt_control_point points[] = {{0, 0}, {1, 1}};
    vxt_transfer_function_desc desc = vxt_transfer_function_desc_init();
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

TEST_F(CStructs, OfAViewOnlyWhatTheCallerKnowsIsWritten) {
    const Owned<vxt_answer> answer = newAnswer();
    vxt_answer_view view = vxt_answer_view_init();
    view.struct_size = offsetof(vxt_answer_view, triangles);
    view.pair_count = 7;
    view.triangle_count = 7;
    need(vxt_answer_get(answer.get(), &view));
    EXPECT_EQ(view.struct_size, offsetof(vxt_answer_view, triangles));
    EXPECT_EQ(view.pair_count, 0U);
    EXPECT_EQ(view.triangle_count, 7U);

    Newer<vxt_answer_view> newer{vxt_answer_view_init(), 9};
    newer.known.struct_size = sizeof newer;
    need(vxt_answer_get(answer.get(), &newer.known));
    EXPECT_EQ(newer.known.struct_size, sizeof newer);
    EXPECT_EQ(newer.added, 0U);
    view.struct_size = 0;
    EXPECT_EQ(vxt_answer_get(answer.get(), &view), VXT_ERROR_INVALID_ARGUMENT);
}

TEST_F(CStructs, ReservedMembersAreZero) {
    vxt_host_detector_desc desc = vxt_host_detector_desc_init();
    desc.reserved = 1;
    vxt_host_detector* detector = nullptr;
    EXPECT_EQ(vxt_host_detector_create(&desc, &detector), VXT_ERROR_UNSUPPORTED);
    EXPECT_EQ(detector, nullptr);
    EXPECT_THAT(vxt_last_error(nullptr), HasSubstr("reserved"));
    // Of a struct in another one, too.
    const VolumeData volume = makeBytes(unitGrid(4), [](auto...) { return 255.0; });
    vxt_volume_view view = cVolume(volume);
    view.grid.reserved = 1;
    vxt_host_volume* made = nullptr;
    EXPECT_EQ(vxt_host_volume_create(&view, &made), VXT_ERROR_UNSUPPORTED);
    EXPECT_EQ(made, nullptr);
    EXPECT_THAT(vxt_last_error(nullptr), HasSubstr("grid: reserved"));
    EXPECT_EQ(vxt_check_grid(&view.grid), VXT_ERROR_UNSUPPORTED);
}

TEST_F(CStructs, ItemsOfALaterHeaderStandFartherApart) {
    const VolumeData volume = makeBytes(unitGrid(4), [](auto...) { return 255.0; });
    const auto on = made<vxt_host_volume>(vxt_host_volume_destroy, [&](auto out) {
        const vxt_volume_view view = cVolume(volume);
        return vxt_host_volume_create(&view, out);
    });
    const auto function = made<vxt_host_transfer_function>(vxt_host_transfer_function_destroy, [&](auto out) {
        const vxt_control_point points[] = {{0, 0}, {255, 1}};
        vxt_transfer_function_desc desc = vxt_transfer_function_desc_init();
        desc.points = points;
        desc.point_count = 2;
        return vxt_host_transfer_function_create(&desc, out);
    });
    const auto mesh =
        made<vxt_host_mesh>(vxt_host_mesh_destroy, [&](auto out) { return vxt_host_mesh_create(&view_.known, out); });
    const auto detector = made<vxt_host_detector>(vxt_host_detector_destroy, [&](auto out) {
        vxt_host_detector_desc desc = vxt_host_detector_desc_init();
        desc.projection = VXT_PROJECTION_CONSERVATIVE;
        return vxt_host_detector_create(&desc, out);
    });
    const Mat4 poses[] = {identity(), translation({100, 0, 0})};
    Newer<vxt_host_item> items[2];
    for (int i = 0; i < 2; ++i) {
        items[i].known = {sizeof items[i], mesh.get(), on.get(), function.get(), poses[i].data(), 1, nullptr};
    }
    vxt_host_batch batch = vxt_host_batch_init();
    batch.items = &items[0].known;
    batch.item_count = 2;
    const Owned<vxt_answer> answer = newAnswer();
    need(vxt_host_detector_detect(detector.get(), &batch, answer.get()));
    const BatchAnswer both = answerOf(*answer);
    ASSERT_EQ(both.pairs.size(), 2U);
    EXPECT_TRUE(both.pairs[0].hit);
    EXPECT_FALSE(both.pairs[1].hit); // 100 mm beside it
    items[1].known.struct_size = sizeof(vxt_host_item);
    EXPECT_EQ(vxt_host_detector_detect(detector.get(), &batch, answer.get()), VXT_ERROR_INVALID_ARGUMENT);
    EXPECT_THAT(vxt_last_error(nullptr), HasSubstr("item 1: struct_size"));
}

} // namespace
} // namespace voxtact::test
