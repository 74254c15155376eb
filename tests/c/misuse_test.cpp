// SPDX-License-Identifier: MIT
// Null for every argument of every function, ends of nothing, numbers that are none, and the texts of refusals. None of
// it needs a device.
#include "null_calls.h"
#include "support/c_calls.h"
#include "support/scenes.h"
#include "voxtact/error.h"
#include "voxtact/voxtact_vulkan.h"

#include <gmock/gmock.h>

#include <set>
#include <sys/mman.h>
#include <sys/resource.h>

namespace voxtact::test {
namespace {

using testing::HasSubstr;

/// A pointer that a failure must overwrite.
template <class T> T* stale() {
    static char memory[64];
    return reinterpret_cast<T*>(memory);
}

TEST(CMisuse, EndingNothingIsNothing) {
    endNothing(vxt_answer_destroy, vxt_blocking_detector_destroy, vxt_box_pairs_destroy, vxt_cancel_destroy,
               vxt_colour_points_destroy, vxt_context_destroy, vxt_control_points_destroy, vxt_detector_destroy,
               vxt_device_destroy, vxt_features_destroy, vxt_host_engine_destroy, vxt_host_mesh_destroy,
               vxt_host_transfer_function_destroy, vxt_host_volume_destroy, vxt_label_map_destroy,
               vxt_label_map_release_staging, vxt_label_names_destroy, vxt_labels_destroy, vxt_mesh_data_destroy,
               vxt_mesh_destroy, vxt_mesh_release_staging, vxt_points_destroy, vxt_pose_buffer_destroy,
               vxt_pose_reader_destroy, vxt_poses_destroy, vxt_report_destroy, vxt_result_ring_destroy,
               vxt_results_destroy, vxt_tracker_destroy, vxt_transfer_function_destroy,
               vxt_transfer_function_release_staging, vxt_volume_data_destroy, vxt_volume_destroy,
               vxt_volume_release_staging);
    vxt_cancel_set(nullptr, 1);
}

TEST(CMisuse, WhatIsAskedOfNothingIsNothing) {
    std::size_t count = 7;
    EXPECT_EQ(vxt_box_pairs_get(nullptr, &count), nullptr);
    EXPECT_EQ(count, 0U);
    count = 7;
    EXPECT_EQ(vxt_labels_values(nullptr, &count), nullptr);
    EXPECT_EQ(count, 0U);
    count = 7;
    EXPECT_EQ(vxt_colour_points_get(nullptr, &count), nullptr);
    EXPECT_EQ(count, 0U);
    EXPECT_EQ(vxt_label_map_values(nullptr, nullptr), nullptr);
    EXPECT_EQ(vxt_poses_get(nullptr, nullptr), nullptr);
    EXPECT_EQ(vxt_control_points_get(nullptr, nullptr), nullptr);
    EXPECT_EQ(vxt_label_names_get(nullptr, 0, nullptr), nullptr);
    EXPECT_EQ(vxt_points_get(nullptr, 0, nullptr, nullptr), nullptr);
    EXPECT_STREQ(vxt_volume_data_name(nullptr), "");
    EXPECT_STREQ(vxt_mesh_data_name(nullptr), "");
    EXPECT_EQ(vxt_volume_data_note(nullptr, 0), nullptr);
    EXPECT_EQ(vxt_mesh_data_note(nullptr, 0), nullptr);
    EXPECT_EQ(vxt_host_engine_threads(nullptr), 0U);
    EXPECT_EQ(vxt_answer_columns(nullptr), 0U);
    EXPECT_EQ(vxt_device_context(nullptr), nullptr);
    EXPECT_EQ(vxt_mesh_triangles(nullptr), 0U);
    EXPECT_EQ(vxt_pose_buffer_count(nullptr), 0U);
    EXPECT_EQ(vxt_features_chain(nullptr), nullptr);
    EXPECT_EQ(vxt_context_supports(nullptr, VXT_METHOD_QUERY, VXT_PROJECTION_VIEW), 0U);
    EXPECT_EQ(vxt_context_default_method(nullptr), VXT_METHOD_CPU);
    EXPECT_EQ(vxt_context_max_viewport(nullptr).width, 0U);
    EXPECT_EQ(vxt_context_device_lost(nullptr), 0U);
}

TEST(CMisuse, NullIsRefused) {
    expectAllNullRefused(
        vxt_method_from_name, vxt_projection_from_name, vxt_check_volume, vxt_check_mesh, vxt_world_from_index,
        vxt_world_from_texture, vxt_framing_view, vxt_inverse, vxt_transform_box, vxt_labels_create, vxt_labels_at,
        vxt_builtin_volume, vxt_builtin_mesh, vxt_answer_find, vxt_answer_column, vxt_fact_get, vxt_volume_data_view,
        vxt_mesh_data_view, vxt_host_volume_create, vxt_host_volume_set_box, vxt_host_volume_set_ball,
        vxt_host_volume_write, vxt_host_transfer_function_create, vxt_host_mesh_create, vxt_host_mesh_facts,
        vxt_host_volume_read, vxt_multiply, vxt_transform_point, vxt_side_view, vxt_texture_from_world, vxt_check_grid,
        vxt_check_affine, vxt_sample_table, vxt_check_opacity, vxt_ball_voxels, vxt_labels_grid, vxt_host_volume_grid,
        vxt_labels_on_grid, vxt_unpack, vxt_labels_along, vxt_pose_between, vxt_host_mesh_update, vxt_ask, vxt_ask_plan,
        vxt_tracker_track, vxt_question_get);
    expectAllNullRefused(vxt_read_volume, vxt_write_volume, vxt_read_mesh, vxt_write_mesh, vxt_read_camera,
                         vxt_read_poses, vxt_read_transfer_function, vxt_parse_opacity, vxt_read_label_names,
                         vxt_read_points, vxt_read_volume_bytes, vxt_read_mesh_bytes, vxt_pose_reader_open,
                         vxt_pose_reader_read, vxt_read_colours, vxt_write_png);
    expectAllNullRefused(
        vxt_context_create, vxt_check, vxt_context_methods, vxt_device_count, vxt_device_open, vxt_device_get_facts,
        vxt_device_queue, vxt_device_begin, vxt_device_submit, vxt_report_get, vxt_self_test, vxt_requirement_get,
        vxt_volume_create, vxt_volume_wrap, vxt_volume_upload, vxt_volume_cmd_upload, vxt_volume_cmd_update_bricks,
        vxt_volume_cmd_set_box, vxt_volume_cmd_set_ball, vxt_volume_cmd_write, vxt_volume_cmd_copy, vxt_volume_get_info,
        vxt_transfer_function_create, vxt_transfer_function_wrap, vxt_transfer_function_upload,
        vxt_transfer_function_cmd_upload, vxt_transfer_function_cmd_update, vxt_transfer_function_domain,
        vxt_mesh_create, vxt_mesh_wrap, vxt_mesh_upload, vxt_mesh_cmd_upload, vxt_mesh_cmd_update, vxt_mesh_cmd_copy,
        vxt_mesh_cmd_refit, vxt_mesh_get_facts, vxt_pose_buffer_wrap, vxt_label_map_create, vxt_label_map_upload,
        vxt_label_map_cmd_upload, vxt_detector_create_certified, vxt_detector_create_raster, vxt_detector_cmd_detect,
        vxt_detector_boundary_for, vxt_blocking_detector_create_certified, vxt_blocking_detector_create_raster,
        vxt_blocking_detector_detect, vxt_results_create, vxt_results_on_device, vxt_results_cmd_read_back,
        vxt_results_read, vxt_result_ring_create, vxt_result_ring_begin, vxt_result_ring_read, vxt_answer_counters);
    // These make an object of nothing else.
    for (const vxt_result result :
         {vxt_answer_create(nullptr), vxt_cancel_create(nullptr), vxt_features_create(nullptr, nullptr),
          vxt_host_engine_create(0, nullptr), vxt_tracker_create(0, 0, 0, nullptr),
          vxt_overlapping_pairs(nullptr, 0, nullptr, 0, nullptr)}) {
        EXPECT_EQ(result, VXT_ERROR_INVALID_ARGUMENT);
    }
}

TEST(CMisuse, NullIsRefusedBehindOthers) {
    const double matrix[16] = {};
    const vxt_box box{};
    vxt_box_pairs* pairs = nullptr;
    vxt_mesh_data* mesh = nullptr;
    vxt_grid grid{};
    grid.size[0] = grid.size[1] = grid.size[2] = 1;
    const std::vector<vxt_control_point> points{{0, 0}, {1, 1}};
    const vxt_transfer_function_desc desc = cFunction(points, {0, 1}, 2);
    expectNullRefused(vxt_method_from_name("query", nullptr));
    expectNullRefused(vxt_projection_from_name("view", nullptr));
    expectNullRefused(vxt_transform_box(matrix, nullptr, nullptr));
    expectNullRefused(vxt_transform_box(matrix, &box, nullptr));
    expectNullRefused(vxt_overlapping_pairs(nullptr, 1, nullptr, 0, &pairs));
    expectNullRefused(vxt_overlapping_pairs(&box, 1, nullptr, 1, &pairs));
    expectNullRefused(vxt_labels_at(nullptr, matrix, nullptr));
    expectNullRefused(vxt_builtin_mesh("scalpel", nullptr));
    expectNullRefused(vxt_world_from_index(&grid, nullptr));
    expectNullRefused(vxt_texture_from_world(&grid, nullptr));
    expectNullRefused(vxt_framing_view(&grid, 1, 1, nullptr));
    expectNullRefused(vxt_multiply(matrix, matrix, nullptr));
    expectNullRefused(vxt_transform_point(matrix, nullptr, nullptr));
    expectNullRefused(vxt_check_opacity(&desc, nullptr, 0.5, nullptr));
    expectNullRefused(vxt_sample_table(&desc, nullptr, 2));
    expectNullRefused(vxt_ball_voxels(&grid, nullptr, 1, nullptr));
    expectNullRefused(vxt_ball_voxels(&grid, matrix, 1, nullptr));
    expectNullRefused(vxt_read_volume("x.nii", nullptr, nullptr));
    expectNullRefused(vxt_write_volume("x.nii", nullptr));
    expectNullRefused(vxt_write_mesh("x.stl", nullptr));
    expectNullRefused(vxt_read_mesh_bytes("a.stl", nullptr, 1, nullptr, &mesh));
    expectNullRefused(vxt_write_png(nullptr, 1, 1, matrix, 4));
}

TEST(CMisuse, NumbersThatAreNoneAreRefusedByName) {
    vxt_volume_view view = sized<vxt_volume_view>();
    view.type = static_cast<vxt_scalar_type>(9);
    view.grid.size[0] = view.grid.size[1] = view.grid.size[2] = 1;
    vxt_range range{};
    EXPECT_EQ(vxt_check_volume(&view, &range), VXT_ERROR_INVALID_ARGUMENT);
    EXPECT_THAT(vxt_last_error(nullptr), HasSubstr("9"));
    EXPECT_STREQ(vxt_method_name(static_cast<vxt_method>(99)), "unknown");
    EXPECT_STREQ(vxt_projection_name(static_cast<vxt_projection>(99)), "unknown");
    EXPECT_STREQ(vxt_filter_name(static_cast<vxt_filter>(99)), "unknown");
    EXPECT_STREQ(vxt_boundary_name(static_cast<vxt_boundary>(99)), "unknown");
    EXPECT_STREQ(vxt_exactness_name(static_cast<vxt_exactness>(99)), "unknown");
}

TEST(CMisuse, LengthsBeyondWhatMemoryHasAreRefused) {
    const double position = 0;
    const std::uint32_t index = 0;
    vxt_mesh_view mesh = sized<vxt_mesh_view>();
    mesh.positions = &position;
    mesh.indices = &index;
    mesh.vertex_count = SIZE_MAX / 2;
    vxt_mesh_facts facts{};
    EXPECT_EQ(vxt_check_mesh(&mesh, &facts), VXT_ERROR_INVALID_ARGUMENT);
    EXPECT_THAT(vxt_last_error(nullptr), HasSubstr("vertices"));
    mesh.vertex_count = 0;
    mesh.triangle_count = SIZE_MAX;
    EXPECT_EQ(vxt_check_mesh(&mesh, &facts), VXT_ERROR_INVALID_ARGUMENT);
    EXPECT_THAT(vxt_last_error(nullptr), HasSubstr("triangles"));
    const vxt_box box{};
    vxt_box_pairs* pairs = nullptr;
    EXPECT_EQ(vxt_overlapping_pairs(&box, SIZE_MAX, nullptr, 0, &pairs), VXT_ERROR_INVALID_ARGUMENT);
    EXPECT_THAT(vxt_last_error(nullptr), HasSubstr("left: 18446744073709551615 are too many"));
    const char* extension = "VK_none";
    vxt_context_desc desc = sized<vxt_context_desc>();
    desc.enabled_device_extensions = &extension;
    desc.enabled_device_extension_count = SIZE_MAX;
    vxt_context* context = nullptr;
    EXPECT_EQ(vxt_context_create(&desc, &context), VXT_ERROR_INVALID_ARGUMENT);
    EXPECT_THAT(vxt_last_error(nullptr), HasSubstr("are too many"));
}

TEST(CMisuse, AContextOfNothingNamesEverythingThatIsMissing) {
    const vxt_context_desc desc = sized<vxt_context_desc>();
    vxt_context* context = nullptr;
    EXPECT_NE(vxt_context_create(&desc, &context), VXT_OK);
    EXPECT_THAT(vxt_last_error(nullptr), HasSubstr("getInstanceProcAddr"));
    const auto report = made(vxt_report_destroy, vxt_check, &desc);
    vxt_report_view view = sized<vxt_report_view>();
    need(vxt_report_get(report.get(), &view));
    EXPECT_EQ(view.usable, 0U);
    EXPECT_GE(view.missing_count, 5U);
    ASSERT_EQ(view.method_count, 5U);
    for (std::size_t i = 0; i < view.missing_count; ++i) {
        EXPECT_STRNE(view.missing[i], "");
    }
    for (std::size_t i = 0; i < view.method_count; ++i) {
        EXPECT_EQ(view.methods[i].method, static_cast<vxt_method>(i));
        // query-any needs no feature; whatever is not available says why.
        EXPECT_EQ(view.methods[i].available, i == VXT_METHOD_QUERY_ANY ? 1U : 0U);
        EXPECT_EQ(std::string(view.methods[i].text).empty(), i == VXT_METHOD_QUERY_ANY);
    }
}

TEST(CMisuse, RequirementsAreData) {
    std::set<std::string> required;
    for (std::size_t i = 0; i < vxt_requirement_count(); ++i) {
        vxt_requirement requirement{};
        need(vxt_requirement_get(i, &requirement));
        EXPECT_STRNE(requirement.structure, "");
        EXPECT_STRNE(requirement.without, "");
        if (requirement.required != 0) {
            required.insert(requirement.feature);
        }
    }
    EXPECT_EQ(required, (std::set<std::string>{"dynamicRendering", "synchronization2"}));
    vxt_requirement beyond{};
    EXPECT_EQ(vxt_requirement_get(vxt_requirement_count(), &beyond), VXT_ERROR_INVALID_ARGUMENT);
    std::size_t count = 0;
    const char* const* extensions = vxt_optional_device_extensions(&count);
    ASSERT_EQ(count, 1U);
    EXPECT_STREQ(extensions[0], "VK_EXT_conservative_rasterization");
}

TEST(CMisuse, FeaturesAreAChainThatTheCallerMayLengthen) {
    const auto features = made(vxt_features_destroy, vxt_features_create, nullptr);
    VkPhysicalDeviceFeatures2* chain = vxt_features_chain(features.get());
    ASSERT_NE(chain, nullptr);
    auto* vulkan12 = static_cast<VkPhysicalDeviceVulkan12Features*>(chain->pNext);
    ASSERT_EQ(vulkan12->sType, VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_2_FEATURES);
    auto* vulkan13 = static_cast<VkPhysicalDeviceVulkan13Features*>(vulkan12->pNext);
    ASSERT_EQ(vulkan13->sType, VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_3_FEATURES);
    EXPECT_EQ(vulkan13->dynamicRendering, VK_TRUE);
    EXPECT_EQ(vulkan13->synchronization2, VK_TRUE);
    EXPECT_EQ(vulkan13->pNext, nullptr);
}

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
constexpr bool kSanitized = true;
#elif defined(__has_feature)
constexpr bool kSanitized = __has_feature(address_sanitizer) || __has_feature(thread_sanitizer);
#else
constexpr bool kSanitized = false;
#endif

/// For a process of its own, which then ends: `call` with no more address space than a little.
template <class Call> [[noreturn]] void askWithoutMemory(Call call) {
    constexpr std::size_t kLittle = std::size_t{1200} << 20U;
    const rlimit limit{kLittle, kLittle};
    if (setrlimit(RLIMIT_AS, &limit) != 0) {
        std::exit(2);
    }
    const vxt_result result = call();
    std::fprintf(stderr, "result %d: %s\n", static_cast<int>(result), vxt_last_error(nullptr));
    std::exit(result == VXT_ERROR_OUT_OF_MEMORY ? 0 : 1);
}

TEST(CMisuseDeathTest, NoMemoryIsAResult) {
    if (kSanitized) {
        GTEST_SKIP() << "sanitizers need more address space than the test leaves";
    }
    // In the library: 2 GiB of voxels.
    vxt_volume_data* data = stale<vxt_volume_data>();
    EXPECT_EXIT(askWithoutMemory([&] { return vxt_builtin_volume("noise:1024", &data); }), testing::ExitedWithCode(0),
                "result 4: .*memory");
    // In the C interface: a copy of boxes that cost nothing, as nobody has written to them.
    constexpr std::size_t kMany = 18'000'000;
    void* const zeros = mmap(nullptr, kMany * sizeof(vxt_box), PROT_READ, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
    ASSERT_NE(zeros, MAP_FAILED);
    const auto* boxes = static_cast<const vxt_box*>(zeros);
    vxt_box_pairs* pairs = nullptr;
    EXPECT_EXIT(askWithoutMemory([&] { return vxt_overlapping_pairs(boxes, kMany, nullptr, 0, &pairs); }),
                testing::ExitedWithCode(0), "result 4: no host memory");
    munmap(zeros, kMany * sizeof(vxt_box));
}

} // namespace
} // namespace voxtact::test
