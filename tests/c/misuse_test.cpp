// SPDX-License-Identifier: MIT
// Null for every argument of every function, ends of nothing, numbers that are none, and the texts of refusals. None of
// it needs a device.
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

/// A refusal with a text of one line that names what is null.
#define EXPECT_NULL_REFUSED(call)                                                                                      \
    EXPECT_EQ(call, VXT_ERROR_INVALID_ARGUMENT) << vxt_last_error(nullptr);                                            \
    EXPECT_THAT(vxt_last_error(nullptr), HasSubstr("null"));                                                           \
    EXPECT_EQ(std::string(vxt_last_error(nullptr)).find('\n'), std::string::npos)

/// A pointer that a failure must overwrite.
template <class T> T* stale() {
    static char memory[64];
    return reinterpret_cast<T*>(memory);
}

TEST(CMisuse, EndingNothingIsNothing) {
    vxt_answer_destroy(nullptr);
    vxt_areas_destroy(nullptr);
    vxt_blocking_detector_destroy(nullptr);
    vxt_box_pairs_destroy(nullptr);
    vxt_clearances_destroy(nullptr);
    vxt_context_destroy(nullptr);
    vxt_control_points_destroy(nullptr);
    vxt_detector_destroy(nullptr);
    vxt_features_destroy(nullptr);
    vxt_host_area_meter_destroy(nullptr);
    vxt_host_clearance_meter_destroy(nullptr);
    vxt_host_clearance_tracker_destroy(nullptr);
    vxt_host_detector_destroy(nullptr);
    vxt_host_mesh_destroy(nullptr);
    vxt_host_motion_checker_destroy(nullptr);
    vxt_host_transfer_function_destroy(nullptr);
    vxt_host_volume_destroy(nullptr);
    vxt_label_map_destroy(nullptr);
    vxt_label_map_release_staging(nullptr);
    vxt_label_names_destroy(nullptr);
    vxt_points_destroy(nullptr);
    vxt_labels_destroy(nullptr);
    vxt_mesh_data_destroy(nullptr);
    vxt_mesh_destroy(nullptr);
    vxt_pose_buffer_destroy(nullptr);
    vxt_mesh_release_staging(nullptr);
    vxt_motions_destroy(nullptr);
    vxt_poses_destroy(nullptr);
    vxt_report_destroy(nullptr);
    vxt_result_ring_destroy(nullptr);
    vxt_results_destroy(nullptr);
    vxt_transfer_function_destroy(nullptr);
    vxt_transfer_function_release_staging(nullptr);
    vxt_volume_data_destroy(nullptr);
    vxt_volume_destroy(nullptr);
    vxt_volume_release_staging(nullptr);
}

TEST(CMisuse, WhatIsAskedOfNothingIsNothing) {
    std::size_t count = 7;
    EXPECT_EQ(vxt_box_pairs_get(nullptr, &count), nullptr);
    EXPECT_EQ(count, 0U);
    count = 7;
    EXPECT_EQ(vxt_labels_values(nullptr, &count), nullptr);
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
    EXPECT_EQ(vxt_host_detector_threads(nullptr), 0U);
    EXPECT_EQ(vxt_mesh_triangles(nullptr), 0U);
    EXPECT_EQ(vxt_pose_buffer_count(nullptr), 0U);
    EXPECT_EQ(vxt_features_chain(nullptr), nullptr);
    EXPECT_EQ(vxt_context_supports(nullptr, VXT_METHOD_QUERY, VXT_PROJECTION_VIEW), 0U);
    EXPECT_EQ(vxt_context_default_method(nullptr), VXT_METHOD_CPU);
    EXPECT_EQ(vxt_context_max_viewport(nullptr).width, 0U);
    EXPECT_EQ(vxt_context_device_lost(nullptr), 0U);
}

TEST(CMisuse, NullIsRefusedByTheHost) {
    const double matrix[16] = {};
    double out[16];
    const vxt_box box{};
    const vxt_grid grid = vxt_grid_init();
    vxt_box_pairs* pairs = nullptr;
    EXPECT_NULL_REFUSED(vxt_method_from_name(nullptr, nullptr));
    EXPECT_NULL_REFUSED(vxt_method_from_name("query", nullptr));
    EXPECT_NULL_REFUSED(vxt_projection_from_name(nullptr, nullptr));
    EXPECT_NULL_REFUSED(vxt_projection_from_name("view", nullptr));
    EXPECT_NULL_REFUSED(vxt_check_volume(nullptr, nullptr));
    EXPECT_NULL_REFUSED(vxt_check_mesh(nullptr, nullptr));
    EXPECT_NULL_REFUSED(vxt_world_from_index(nullptr, out));
    EXPECT_NULL_REFUSED(vxt_world_from_texture(nullptr, out));
    EXPECT_NULL_REFUSED(vxt_framing_view(nullptr, 1, 1, nullptr));
    EXPECT_NULL_REFUSED(vxt_inverse(nullptr, out));
    EXPECT_NULL_REFUSED(vxt_transform_box(nullptr, &box, nullptr));
    EXPECT_NULL_REFUSED(vxt_transform_box(matrix, nullptr, nullptr));
    EXPECT_NULL_REFUSED(vxt_transform_box(matrix, &box, nullptr));
    EXPECT_NULL_REFUSED(vxt_overlapping_pairs(nullptr, 1, nullptr, 0, &pairs));
    EXPECT_NULL_REFUSED(vxt_overlapping_pairs(&box, 1, nullptr, 1, &pairs));
    EXPECT_NULL_REFUSED(vxt_overlapping_pairs(nullptr, 0, nullptr, 0, nullptr));
    EXPECT_NULL_REFUSED(vxt_labels_create(nullptr, nullptr));
    EXPECT_NULL_REFUSED(vxt_labels_at(nullptr, matrix, nullptr));
    EXPECT_NULL_REFUSED(vxt_builtin_volume(nullptr, nullptr));
    EXPECT_NULL_REFUSED(vxt_builtin_mesh("scalpel", nullptr));
    EXPECT_NULL_REFUSED(vxt_answer_create(nullptr));
    EXPECT_NULL_REFUSED(vxt_answer_get(nullptr, nullptr));
    EXPECT_NULL_REFUSED(vxt_answer_get(newAnswer().get(), nullptr));
    vxt_volume_view volume = vxt_volume_view_init();
    EXPECT_NULL_REFUSED(vxt_volume_data_view(nullptr, &volume));
    vxt_mesh_view mesh = vxt_mesh_view_init();
    EXPECT_NULL_REFUSED(vxt_mesh_data_view(nullptr, &mesh));
    EXPECT_NULL_REFUSED(vxt_host_volume_create(nullptr, nullptr));
    EXPECT_NULL_REFUSED(vxt_host_volume_set_box(nullptr, nullptr, 0));
    EXPECT_NULL_REFUSED(vxt_host_volume_set_ball(nullptr, nullptr, 0, 0));
    EXPECT_NULL_REFUSED(vxt_host_volume_write(nullptr, nullptr, nullptr, 0));
    EXPECT_NULL_REFUSED(vxt_host_transfer_function_create(nullptr, nullptr));
    EXPECT_NULL_REFUSED(vxt_host_mesh_create(nullptr, nullptr));
    EXPECT_NULL_REFUSED(vxt_host_mesh_facts(nullptr, nullptr));
    EXPECT_NULL_REFUSED(vxt_host_detector_create(nullptr, nullptr));
    EXPECT_NULL_REFUSED(vxt_host_detector_detect(nullptr, nullptr, nullptr));
    vxt_grid sized = grid;
    sized.size[0] = sized.size[1] = sized.size[2] = 1;
    EXPECT_NULL_REFUSED(vxt_world_from_index(&sized, nullptr));
    EXPECT_NULL_REFUSED(vxt_framing_view(&sized, 1, 1, nullptr));
}

TEST(CMisuse, NullIsRefusedByFiles) {
    vxt_volume_data* volume = stale<vxt_volume_data>();
    EXPECT_NULL_REFUSED(vxt_read_volume(nullptr, nullptr, &volume));
    EXPECT_EQ(volume, nullptr);
    EXPECT_NULL_REFUSED(vxt_read_volume("x.nii", nullptr, nullptr));
    EXPECT_NULL_REFUSED(vxt_write_volume(nullptr, nullptr));
    EXPECT_NULL_REFUSED(vxt_write_volume("x.nii", nullptr));
    vxt_mesh_data* mesh = stale<vxt_mesh_data>();
    EXPECT_NULL_REFUSED(vxt_read_mesh(nullptr, nullptr, &mesh));
    EXPECT_EQ(mesh, nullptr);
    EXPECT_NULL_REFUSED(vxt_write_mesh(nullptr, nullptr));
    EXPECT_NULL_REFUSED(vxt_write_mesh("x.stl", nullptr));
    EXPECT_NULL_REFUSED(vxt_read_camera(nullptr, nullptr));
    EXPECT_NULL_REFUSED(vxt_read_poses(nullptr, nullptr));
    EXPECT_NULL_REFUSED(vxt_read_transfer_function(nullptr, nullptr));
    EXPECT_NULL_REFUSED(vxt_parse_opacity(nullptr, nullptr));
    EXPECT_NULL_REFUSED(vxt_read_label_names(nullptr, nullptr));
    EXPECT_NULL_REFUSED(vxt_read_points(nullptr, nullptr));
}

TEST(CMisuse, NullIsRefusedByTheDevice) {
    vxt_context* context = stale<vxt_context>();
    EXPECT_NULL_REFUSED(vxt_context_create(nullptr, &context));
    EXPECT_EQ(context, nullptr);
    EXPECT_NULL_REFUSED(vxt_check(nullptr, nullptr));
    EXPECT_NULL_REFUSED(vxt_report_get(nullptr, nullptr));
    EXPECT_NULL_REFUSED(vxt_self_test(nullptr, nullptr, nullptr));
    EXPECT_NULL_REFUSED(vxt_measure_methods(nullptr, nullptr, nullptr));
    EXPECT_NULL_REFUSED(vxt_requirement_get(0, nullptr));
    EXPECT_NULL_REFUSED(vxt_features_create(nullptr, nullptr));
    vxt_volume* volume = stale<vxt_volume>();
    EXPECT_NULL_REFUSED(vxt_volume_create(nullptr, nullptr, nullptr, &volume));
    EXPECT_EQ(volume, nullptr);
    EXPECT_NULL_REFUSED(vxt_volume_wrap(nullptr, nullptr, nullptr));
    EXPECT_NULL_REFUSED(vxt_volume_upload(nullptr, nullptr, nullptr, nullptr, nullptr));
    EXPECT_NULL_REFUSED(vxt_volume_cmd_upload(nullptr, VK_NULL_HANDLE));
    EXPECT_NULL_REFUSED(vxt_volume_cmd_update_bricks(nullptr, VK_NULL_HANDLE, nullptr));
    EXPECT_NULL_REFUSED(vxt_volume_cmd_set_box(nullptr, VK_NULL_HANDLE, nullptr, 0));
    EXPECT_NULL_REFUSED(vxt_volume_cmd_set_ball(nullptr, VK_NULL_HANDLE, nullptr, 0, 0));
    EXPECT_NULL_REFUSED(vxt_volume_cmd_write(nullptr, VK_NULL_HANDLE, nullptr, nullptr, 0));
    EXPECT_NULL_REFUSED(vxt_volume_cmd_copy(nullptr, VK_NULL_HANDLE, nullptr, VK_NULL_HANDLE, 0));
    EXPECT_NULL_REFUSED(vxt_volume_get_info(nullptr, nullptr));
    EXPECT_NULL_REFUSED(vxt_transfer_function_create(nullptr, nullptr, nullptr, nullptr));
    EXPECT_NULL_REFUSED(vxt_transfer_function_wrap(nullptr, nullptr, nullptr));
    EXPECT_NULL_REFUSED(vxt_transfer_function_upload(nullptr, nullptr, nullptr, nullptr, nullptr));
    EXPECT_NULL_REFUSED(vxt_transfer_function_cmd_upload(nullptr, VK_NULL_HANDLE));
    EXPECT_NULL_REFUSED(vxt_transfer_function_cmd_update(nullptr, VK_NULL_HANDLE, nullptr));
    EXPECT_NULL_REFUSED(vxt_transfer_function_domain(nullptr, nullptr));
    EXPECT_NULL_REFUSED(vxt_mesh_create(nullptr, nullptr, nullptr, nullptr));
    EXPECT_NULL_REFUSED(vxt_mesh_wrap(nullptr, nullptr, nullptr));
    EXPECT_NULL_REFUSED(vxt_mesh_upload(nullptr, nullptr, nullptr, nullptr, nullptr));
    EXPECT_NULL_REFUSED(vxt_mesh_cmd_upload(nullptr, VK_NULL_HANDLE));
    EXPECT_NULL_REFUSED(vxt_mesh_cmd_update(nullptr, VK_NULL_HANDLE, nullptr, 0));
    EXPECT_NULL_REFUSED(vxt_mesh_cmd_copy(nullptr, VK_NULL_HANDLE, VK_NULL_HANDLE, 0));
    EXPECT_NULL_REFUSED(vxt_mesh_cmd_refit(nullptr, VK_NULL_HANDLE));
    EXPECT_NULL_REFUSED(vxt_mesh_get_facts(nullptr, nullptr));
    EXPECT_NULL_REFUSED(vxt_pose_buffer_wrap(nullptr, nullptr, nullptr, nullptr));
    EXPECT_NULL_REFUSED(vxt_label_map_create(nullptr, nullptr, nullptr, nullptr));
    EXPECT_NULL_REFUSED(vxt_label_map_upload(nullptr, nullptr, nullptr, nullptr, nullptr));
    EXPECT_NULL_REFUSED(vxt_label_map_cmd_upload(nullptr, VK_NULL_HANDLE));
    EXPECT_NULL_REFUSED(vxt_detector_create(nullptr, nullptr, nullptr));
    EXPECT_NULL_REFUSED(vxt_detector_cmd_detect(nullptr, VK_NULL_HANDLE, nullptr, nullptr));
    EXPECT_NULL_REFUSED(vxt_detector_boundary_for(nullptr, nullptr, 0, nullptr));
    EXPECT_NULL_REFUSED(vxt_blocking_detector_create(nullptr, nullptr, nullptr, 0, nullptr));
    EXPECT_NULL_REFUSED(vxt_blocking_detector_detect(nullptr, nullptr, nullptr));
    EXPECT_NULL_REFUSED(vxt_results_create(nullptr, nullptr, nullptr));
    EXPECT_NULL_REFUSED(vxt_results_on_device(nullptr, VXT_DEVICE_PAIRS, nullptr));
    EXPECT_NULL_REFUSED(vxt_results_cmd_read_back(nullptr, VK_NULL_HANDLE));
    EXPECT_NULL_REFUSED(vxt_results_read(nullptr, nullptr));
    EXPECT_NULL_REFUSED(vxt_result_ring_create(nullptr, 1, nullptr, nullptr));
    EXPECT_NULL_REFUSED(vxt_result_ring_begin(nullptr, 0, nullptr));
    EXPECT_NULL_REFUSED(vxt_result_ring_read(nullptr, 0, nullptr));
}

TEST(CMisuse, NumbersThatAreNoneAreRefusedByName) {
    const auto refusal = [](auto change) {
        vxt_host_detector_desc desc = vxt_host_detector_desc_init();
        change(desc);
        vxt_host_detector* detector = stale<vxt_host_detector>();
        EXPECT_NE(vxt_host_detector_create(&desc, &detector), VXT_OK);
        EXPECT_EQ(detector, nullptr);
        return std::string(vxt_last_error(nullptr));
    };
    EXPECT_THAT(refusal([](auto& desc) { desc.projection = static_cast<vxt_projection>(4); }), HasSubstr("projection"));
    EXPECT_THAT(refusal([](auto& desc) { desc.boundary = static_cast<vxt_boundary>(77); }), HasSubstr("boundary"));
    EXPECT_THAT(refusal([](auto& desc) { desc.outputs = 16; }), HasSubstr("outputs"));
    EXPECT_THAT(refusal([](auto& desc) { desc.samples_per_voxel = 17; }), HasSubstr("samples"));
    vxt_volume_view view = vxt_volume_view_init();
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
    EXPECT_STREQ(vxt_area_end_name(static_cast<vxt_area_end>(99)), "unknown");
    EXPECT_STREQ(vxt_clearance_end_name(static_cast<vxt_clearance_end>(99)), "unknown");
    EXPECT_STREQ(vxt_interpolation_name(static_cast<vxt_interpolation>(99)), "unknown");
    EXPECT_STREQ(vxt_motion_end_name(static_cast<vxt_motion_end>(99)), "unknown");
}

TEST(CMisuse, LengthsBeyondWhatMemoryHasAreRefused) {
    const float position = 0;
    const std::uint32_t index = 0;
    vxt_mesh_view mesh = vxt_mesh_view_init();
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
    vxt_context_desc desc = vxt_context_desc_init();
    desc.enabled_device_extensions = &extension;
    desc.enabled_device_extension_count = SIZE_MAX;
    vxt_context* context = nullptr;
    EXPECT_EQ(vxt_context_create(&desc, &context), VXT_ERROR_INVALID_ARGUMENT);
    EXPECT_THAT(vxt_last_error(nullptr), HasSubstr("are too many"));
}

TEST(CMisuse, AContextOfNothingNamesEverythingThatIsMissing) {
    const vxt_context_desc desc = vxt_context_desc_init();
    vxt_context* context = nullptr;
    EXPECT_NE(vxt_context_create(&desc, &context), VXT_OK);
    EXPECT_THAT(vxt_last_error(nullptr), HasSubstr("getInstanceProcAddr"));
    const auto report = made<vxt_report>(vxt_report_destroy, [&](auto out) { return vxt_check(&desc, out); });
    vxt_report_view view = vxt_report_view_init();
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
    const auto features =
        made<vxt_features>(vxt_features_destroy, [](auto out) { return vxt_features_create(nullptr, out); });
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
