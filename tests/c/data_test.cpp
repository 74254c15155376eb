// SPDX-License-Identifier: MIT
// Host data, builtins and files through the C interface: what the C++ interface gives.
#include "support/c_calls.h"
#include "support/scenes.h"
#include "support/take.h"
#include "voxtact/samples.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <unistd.h>

namespace voxtact::test {
namespace {

using testing::HasSubstr;

Owned<vxt_volume_data> builtinVolume(const char* name) {
    return made<vxt_volume_data>(vxt_volume_data_destroy, [&](auto out) { return vxt_builtin_volume(name, out); });
}

void expectSame(const vxt_volume_view& view, const VolumeData& volume) {
    const vxt_volume_view expected = cVolume(volume);
    EXPECT_TRUE(std::ranges::equal(view.grid.size, expected.grid.size));
    EXPECT_TRUE(std::ranges::equal(view.grid.spacing, expected.grid.spacing));
    EXPECT_TRUE(std::ranges::equal(view.grid.origin, expected.grid.origin));
    EXPECT_TRUE(std::ranges::equal(view.grid.direction, expected.grid.direction));
    EXPECT_EQ(view.type, expected.type);
    ASSERT_EQ(view.bytes, volume.voxels.size());
    EXPECT_EQ(std::memcmp(view.voxels, volume.voxels.data(), view.bytes), 0);
}

void expectSame(const vxt_mesh_view& view, const MeshData& mesh) {
    EXPECT_TRUE(std::equal(mesh.positions.begin(), mesh.positions.end(), view.positions,
                           view.positions + 3 * view.vertex_count));
    EXPECT_TRUE(
        std::equal(mesh.indices.begin(), mesh.indices.end(), view.indices, view.indices + 3 * view.triangle_count));
}

TEST(CData, BuiltinsAreTheCppInterfaces) {
    const auto volume = builtinVolume("ct:12");
    expectSame(dataView(volume), take(makeBuiltinVolume("ct:12")));
    EXPECT_EQ(vxt_volume_data_name(volume.get()), take(makeBuiltinVolume("ct:12")).name);
    EXPECT_EQ(vxt_volume_data_note(volume.get(), 0), nullptr);
    const auto mesh =
        made<vxt_mesh_data>(vxt_mesh_data_destroy, [](auto out) { return vxt_builtin_mesh("scalpel", out); });
    expectSame(dataView(mesh), take(makeBuiltinMesh("scalpel")));
    vxt_volume_data* none = nullptr;
    EXPECT_EQ(vxt_builtin_volume("nothing", &none), VXT_ERROR_INVALID_ARGUMENT);
    EXPECT_THAT(vxt_last_error(nullptr), HasSubstr("nothing"));
}

TEST(CData, ChecksFindWhatTheCppInterfaceFinds) {
    const VolumeData volume = take(makeBuiltinVolume("ct:12"));
    const vxt_volume_view view = cVolume(volume);
    vxt_range range{};
    need(vxt_check_volume(&view, &range));
    const ValueRange expected = take(checkVolume(volume.view()));
    EXPECT_EQ(range.lo, expected.lo);
    EXPECT_EQ(range.hi, expected.hi);

    const MeshData mesh = makeCube(-1, 2);
    const vxt_mesh_view meshView = cMesh(mesh);
    vxt_mesh_facts facts{};
    need(vxt_check_mesh(&meshView, &facts));
    EXPECT_EQ(facts.vertices, mesh.positions.size() / 3);
    EXPECT_EQ(facts.triangles, 12U);
    EXPECT_EQ(facts.degenerate, 0U);
    EXPECT_EQ(facts.bounds.lo[1], -1);
    EXPECT_EQ(facts.bounds.hi[2], 2);
}

TEST(CData, SpacesAreTheCppInterfaces) {
    const VolumeData volume = take(makeBuiltinVolume("ct:12")); // oblique and anisotropic
    const vxt_grid grid = cGrid(volume.grid);
    Mat4 matrix{};
    need(vxt_world_from_index(&grid, matrix.data()));
    EXPECT_EQ(matrix, worldFromIndex(volume.grid));
    need(vxt_world_from_texture(&grid, matrix.data()));
    EXPECT_EQ(matrix, worldFromTexture(volume.grid));
    need(vxt_inverse(matrix.data(), matrix.data()));
    EXPECT_EQ(matrix, take(textureFromWorld(volume.grid)));
    vxt_view view{};
    need(vxt_framing_view(&grid, 100, 50, &view));
    EXPECT_TRUE(std::ranges::equal(view.clip_from_world, framingCamera(volume.grid, 100, 50)));
    EXPECT_EQ(view.height, 50U);
    EXPECT_EQ(vxt_framing_view(&grid, 0, 50, &view), VXT_ERROR_INVALID_ARGUMENT);
    const Mat4 singular{};
    EXPECT_EQ(vxt_inverse(singular.data(), matrix.data()), VXT_ERROR_INVALID_ARGUMENT);
    const vxt_grid empty = vxt_grid_init();
    EXPECT_EQ(vxt_world_from_index(&empty, matrix.data()), VXT_ERROR_INVALID_ARGUMENT);
}

TEST(CData, BoxesOverlapAsTheyDoInCpp) {
    const Mat4 pose = translation({1, 0, 0});
    vxt_box box{{0, 0, 0}, {1, 1, 1}};
    need(vxt_transform_box(pose.data(), &box, &box));
    EXPECT_EQ(box.lo[0], 1);
    EXPECT_EQ(box.hi[0], 2);
    const vxt_box boxes[] = {{{0, 0, 0}, {1, 1, 1}}, box, {{5, 5, 5}, {6, 6, 6}}};
    const auto within = made<vxt_box_pairs>(vxt_box_pairs_destroy,
                                            [&](auto out) { return vxt_overlapping_pairs(boxes, 3, nullptr, 0, out); });
    std::size_t count = 0;
    const vxt_box_pair* pairs = vxt_box_pairs_get(within.get(), &count);
    ASSERT_EQ(count, 1U); // the first two share a face
    EXPECT_EQ(pairs[0].first, 0U);
    EXPECT_EQ(pairs[0].second, 1U);
    const auto between = made<vxt_box_pairs>(
        vxt_box_pairs_destroy, [&](auto out) { return vxt_overlapping_pairs(boxes, 3, boxes + 2, 1, out); });
    pairs = vxt_box_pairs_get(between.get(), &count);
    ASSERT_EQ(count, 1U);
    EXPECT_EQ(pairs[0].first, 2U);
    EXPECT_EQ(pairs[0].second, 0U);
}

TEST(CData, LabelsAreFoundWhereTheyAre) {
    const VolumeData image = makeVolume<std::int16_t>(unitGrid(2), ScalarType::Int16,
                                                      [](std::uint32_t x, auto, auto) { return x == 0 ? -3 : 7; });
    const vxt_volume_view view = cVolume(image);
    const auto labels = made<vxt_labels>(vxt_labels_destroy, [&](auto out) { return vxt_labels_create(&view, out); });
    std::size_t count = 0;
    const std::int32_t* values = vxt_labels_values(labels.get(), &count);
    EXPECT_EQ(std::vector(values, values + count), (std::vector<std::int32_t>{-3, 0, 7}));
    std::int32_t label = 0;
    const double left[3] = {0.2, 0.5, 0.5};
    need(vxt_labels_at(labels.get(), left, &label));
    EXPECT_EQ(label, -3);
    const double outside[3] = {2, 0.5, 0.5};
    need(vxt_labels_at(labels.get(), outside, &label));
    EXPECT_EQ(label, 0);
}

TEST(CData, NamesAndNumbersGoBothWays) {
    for (const CountingMethod method : countingMethods()) {
        vxt_method number = VXT_METHOD_MAX;
        need(vxt_method_from_name(toString(method), &number));
        EXPECT_STREQ(vxt_method_name(number), toString(method));
        EXPECT_EQ(static_cast<Filter>(vxt_default_filter(number)), defaultFilter(method));
    }
    for (const Projection projection : projections()) {
        vxt_projection number = VXT_PROJECTION_MAX;
        need(vxt_projection_from_name(toString(projection), &number));
        EXPECT_STREQ(vxt_projection_name(number), toString(projection));
    }
    vxt_method method = VXT_METHOD_MAX;
    EXPECT_EQ(vxt_method_from_name("magic", &method), VXT_ERROR_INVALID_ARGUMENT);
    EXPECT_THAT(vxt_last_error(nullptr), HasSubstr("'magic'"));
    EXPECT_EQ(method, VXT_METHOD_MAX);
    EXPECT_STREQ(vxt_filter_name(VXT_FILTER_EXACT), "exact");
    EXPECT_STREQ(vxt_boundary_name(VXT_BOUNDARY_CLAMP), "clamp");
    EXPECT_STREQ(vxt_exactness_name(VXT_EXACTNESS_LOWER_BOUND), "lower-bound");
}

/// A folder that ends with the test.
class CFiles : public testing::Test {
  protected:
    CFiles() { std::filesystem::create_directories(folder_); }
    ~CFiles() override { std::filesystem::remove_all(folder_); }
    [[nodiscard]] std::string path(const std::string& name) const { return (folder_ / name).string(); }
    [[nodiscard]] std::string write(const std::string& name, const std::string& text) const {
        std::ofstream(path(name)) << text;
        return path(name);
    }

    std::filesystem::path folder_ =
        std::filesystem::temp_directory_path() /
        ("voxtact-c-" + std::to_string(getpid()) + testing::UnitTest::GetInstance()->current_test_info()->name());
};

TEST_F(CFiles, VolumesAndMeshesComeBackAsTheyWere) {
    const VolumeData volume = take(makeBuiltinVolume("ct:12"));
    const vxt_volume_view view = cVolume(volume);
    need(vxt_write_volume(path("ct.nrrd").c_str(), &view));
    const auto read = made<vxt_volume_data>(
        vxt_volume_data_destroy, [&](auto out) { return vxt_read_volume(path("ct.nrrd").c_str(), nullptr, out); });
    const vxt_volume_view back = dataView(read);
    ASSERT_EQ(back.bytes, view.bytes);
    EXPECT_EQ(std::memcmp(back.voxels, view.voxels, view.bytes), 0);
    EXPECT_STREQ(vxt_volume_data_name(read.get()), "ct.nrrd");

    const MeshData mesh = makeCube(0, 1);
    const vxt_mesh_view meshView = cMesh(mesh);
    need(vxt_write_mesh(path("cube.obj").c_str(), &meshView));
    vxt_mesh_read_options options = vxt_mesh_read_options_init();
    options.ras = 1;
    options.scale = 10;
    const auto cube = made<vxt_mesh_data>(
        vxt_mesh_data_destroy, [&](auto out) { return vxt_read_mesh(path("cube.obj").c_str(), &options, out); });
    vxt_mesh_facts facts{};
    const vxt_mesh_view readView = dataView(cube);
    need(vxt_check_mesh(&readView, &facts));
    EXPECT_EQ(facts.bounds.lo[0], -10); // x and y are negated
    EXPECT_EQ(facts.bounds.hi[2], 10);
}

TEST_F(CFiles, RefusalsAreTheReaders) {
    vxt_volume_data* volume = nullptr;
    EXPECT_EQ(vxt_read_volume(path("none.nii").c_str(), nullptr, &volume), VXT_ERROR_FILE);
    EXPECT_THAT(vxt_last_error(nullptr), HasSubstr("none.nii"));
    EXPECT_EQ(vxt_read_volume(write("bad.nii", "no image").c_str(), nullptr, &volume), VXT_ERROR_FORMAT);
    vxt_volume_read_options options = vxt_volume_read_options_init();
    options.frame = -2;
    EXPECT_EQ(vxt_read_volume(path("none.nii").c_str(), &options, &volume), VXT_ERROR_INVALID_ARGUMENT);
    EXPECT_THAT(vxt_last_error(nullptr), HasSubstr("frame is -2"));
}

TEST_F(CFiles, TextsBecomeArrays) {
    const std::string file = write("poses.txt", "1 0 0 5  0 1 0 6  0 0 1 7  0 0 0 1\n");
    const auto poses = made<vxt_poses>(vxt_poses_destroy, [&](auto out) { return vxt_read_poses(file.c_str(), out); });
    std::size_t count = 0;
    const double* matrices = vxt_poses_get(poses.get(), &count);
    ASSERT_EQ(count, 1U);
    EXPECT_EQ(matrices[12], 5); // column by column
    EXPECT_EQ(matrices[14], 7);
    double camera[16] = {};
    need(vxt_read_camera(file.c_str(), camera));
    EXPECT_EQ(camera[13], 6);

    const auto parsed = made<vxt_control_points>(vxt_control_points_destroy,
                                                 [](auto out) { return vxt_parse_opacity("40:0,80:1", out); });
    const vxt_control_point* points = vxt_control_points_get(parsed.get(), &count);
    ASSERT_EQ(count, 2U);
    EXPECT_EQ(points[1].value, 80);
    const auto written = write("tf.txt", "40 0\n80 1\n90 0.5\n");
    const auto read = made<vxt_control_points>(
        vxt_control_points_destroy, [&](auto out) { return vxt_read_transfer_function(written.c_str(), out); });
    points = vxt_control_points_get(read.get(), &count);
    ASSERT_EQ(count, 3U);
    EXPECT_EQ(points[2].opacity, 0.5);

    const auto names = made<vxt_label_names>(vxt_label_names_destroy, [&](auto out) {
        return vxt_read_label_names(write("labels.txt", "3 left\n-4 right\n").c_str(), out);
    });
    std::int32_t label = 0;
    EXPECT_STREQ(vxt_label_names_get(names.get(), 1, &label), "right");
    EXPECT_EQ(label, -4);
    EXPECT_STREQ(vxt_label_names_get(names.get(), 0, nullptr), "left");
    EXPECT_EQ(vxt_label_names_get(names.get(), 2, &label), nullptr);

    const auto list = made<vxt_points>(vxt_points_destroy, [&](auto out) {
        return vxt_read_points(write("points.txt", "# targets\n1 2 3\n-4.5 5 6 tip\n").c_str(), out);
    });
    double position[3] = {};
    std::uint64_t line = 0;
    EXPECT_STREQ(vxt_points_get(list.get(), 0, position, &line), "");
    EXPECT_THAT(position, testing::ElementsAre(1, 2, 3));
    EXPECT_EQ(line, 2U);
    EXPECT_STREQ(vxt_points_get(list.get(), 1, position, nullptr), "tip");
    EXPECT_THAT(position, testing::ElementsAre(-4.5, 5, 6));
    EXPECT_NE(vxt_points_get(list.get(), 1, nullptr, nullptr), nullptr);
    EXPECT_EQ(vxt_points_get(list.get(), 2, position, &line), nullptr);
}

} // namespace
} // namespace voxtact::test
