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
    return made(vxt_volume_data_destroy, vxt_builtin_volume, name);
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
    const auto mesh = made(vxt_mesh_data_destroy, vxt_builtin_mesh, "scalpel");
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
    EXPECT_EQ(facts.rounding, 0);

    MeshData far = mesh;
    for (double& coordinate : far.positions) {
        coordinate += 4500000.2;
    }
    const vxt_mesh_view farView = cMesh(far);
    need(vxt_check_mesh(&farView, &facts));
    EXPECT_EQ(facts.bounds.lo[0], 4499999.2);
    EXPECT_GT(facts.rounding, 0);
    EXPECT_LT(facts.rounding, 1e-6);
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
    const vxt_grid empty = vxt_grid{};
    EXPECT_EQ(vxt_world_from_index(&empty, matrix.data()), VXT_ERROR_INVALID_ARGUMENT);
}

TEST(CData, BoxesOverlapAsTheyDoInCpp) {
    const Mat4 pose = translation({1, 0, 0});
    vxt_box box{{0, 0, 0}, {1, 1, 1}};
    need(vxt_transform_box(pose.data(), &box, &box));
    EXPECT_EQ(box.lo[0], 1);
    EXPECT_EQ(box.hi[0], 2);
    const vxt_box boxes[] = {{{0, 0, 0}, {1, 1, 1}}, box, {{5, 5, 5}, {6, 6, 6}}};
    const auto within = made(vxt_box_pairs_destroy, vxt_overlapping_pairs, boxes, 3, nullptr, 0);
    std::size_t count = 0;
    const vxt_box_pair* pairs = vxt_box_pairs_get(within.get(), &count);
    ASSERT_EQ(count, 1U); // the first two share a face
    EXPECT_EQ(pairs[0].first, 0U);
    EXPECT_EQ(pairs[0].second, 1U);
    const auto between = made(vxt_box_pairs_destroy, vxt_overlapping_pairs, boxes, 3, boxes + 2, 1);
    pairs = vxt_box_pairs_get(between.get(), &count);
    ASSERT_EQ(count, 1U);
    EXPECT_EQ(pairs[0].first, 2U);
    EXPECT_EQ(pairs[0].second, 0U);
}

TEST(CData, LabelsAreFoundWhereTheyAre) {
    const VolumeData image = makeVolume<std::int16_t>(unitGrid(2), ScalarType::Int16,
                                                      [](std::uint32_t x, auto, auto) { return x == 0 ? -3 : 7; });
    const vxt_volume_view view = cVolume(image);
    const auto labels = made(vxt_labels_destroy, vxt_labels_create, &view);
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

    [[nodiscard]] static std::string content(const std::string& path) {
        std::ifstream file(path, std::ios::binary);
        return {std::istreambuf_iterator<char>(file), {}};
    }

    std::filesystem::path folder_ =
        std::filesystem::temp_directory_path() /
        ("voxtact-c-" + std::to_string(getpid()) + testing::UnitTest::GetInstance()->current_test_info()->name());
};

TEST_F(CFiles, VolumesAndMeshesComeBackAsTheyWere) {
    const VolumeData volume = take(makeBuiltinVolume("ct:12"));
    const vxt_volume_view view = cVolume(volume);
    need(vxt_write_volume(path("ct.nrrd").c_str(), &view));
    const auto read = made(vxt_volume_data_destroy, vxt_read_volume, path("ct.nrrd").c_str(), nullptr);
    const vxt_volume_view back = dataView(read);
    ASSERT_EQ(back.bytes, view.bytes);
    EXPECT_EQ(std::memcmp(back.voxels, view.voxels, view.bytes), 0);
    EXPECT_STREQ(vxt_volume_data_name(read.get()), "ct.nrrd");

    const MeshData mesh = makeCube(0, 1);
    const vxt_mesh_view meshView = cMesh(mesh);
    need(vxt_write_mesh(path("cube.obj").c_str(), &meshView));
    vxt_mesh_read_options options = sized<vxt_mesh_read_options>();
    options.ras = 1;
    options.scale = 10;
    const auto cube = made(vxt_mesh_data_destroy, vxt_read_mesh, path("cube.obj").c_str(), &options);
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
    vxt_volume_read_options options = sized<vxt_volume_read_options>();
    options.choose_frame = 1;
    options.frame = 2;
    const std::string file = path("one.nii");
    const VolumeData one = makeBytes(unitGrid(2), [](auto...) { return 1.0; });
    const vxt_volume_view view = cVolume(one);
    need(vxt_write_volume(file.c_str(), &view));
    EXPECT_EQ(vxt_read_volume(file.c_str(), &options, &volume), VXT_ERROR_FORMAT);
    EXPECT_THAT(vxt_last_error(nullptr), HasSubstr("frame"));
    options.choose_frame = 0; // `frame` then says nothing
    need(vxt_read_volume(file.c_str(), &options, &volume));
    vxt_volume_data_destroy(volume);
}

TEST_F(CFiles, TextsBecomeArrays) {
    const std::string file = write("poses.txt", "1 0 0 5  0 1 0 6  0 0 1 7  0 0 0 1\n");
    const auto poses = made(vxt_poses_destroy, vxt_read_poses, file.c_str(), nullptr);
    std::size_t count = 0;
    const double* matrices = vxt_poses_get(poses.get(), &count);
    ASSERT_EQ(count, 1U);
    EXPECT_EQ(matrices[12], 5); // column by column
    EXPECT_EQ(matrices[14], 7);
    const std::string rigid = write("rigid.txt", "1 0 0 0 5 6 7\n");
    const auto turned = made(vxt_poses_destroy, vxt_read_poses, rigid.c_str(), "wxyz-t");
    EXPECT_TRUE(std::equal(matrices, matrices + 16, vxt_poses_get(turned.get(), &count)));
    vxt_poses* none = nullptr;
    EXPECT_EQ(vxt_read_poses(rigid.c_str(), "wxyz", &none), VXT_ERROR_INVALID_ARGUMENT);
    EXPECT_THAT(vxt_last_error(nullptr), HasSubstr("format 'wxyz' is unknown; choose from: matrix, t-xyzw"));
    double camera[16] = {};
    need(vxt_read_camera(file.c_str(), camera));
    EXPECT_EQ(camera[13], 6);

    const auto parsed = made(vxt_control_points_destroy, vxt_parse_opacity, "40:0,80:1");
    const vxt_control_point* points = vxt_control_points_get(parsed.get(), &count);
    ASSERT_EQ(count, 2U);
    EXPECT_EQ(points[1].value, 80);
    const auto written = write("tf.txt", "40 0\n80 1\n90 0.5\n");
    const auto read = made(vxt_control_points_destroy, vxt_read_transfer_function, written.c_str());
    points = vxt_control_points_get(read.get(), &count);
    ASSERT_EQ(count, 3U);
    EXPECT_EQ(points[2].opacity, 0.5);

    const auto names =
        made(vxt_label_names_destroy, vxt_read_label_names, write("labels.txt", "3 left\n-4 right\n").c_str());
    std::int32_t label = 0;
    EXPECT_STREQ(vxt_label_names_get(names.get(), 1, &label), "right");
    EXPECT_EQ(label, -4);
    EXPECT_STREQ(vxt_label_names_get(names.get(), 0, nullptr), "left");
    EXPECT_EQ(vxt_label_names_get(names.get(), 2, &label), nullptr);

    const auto list =
        made(vxt_points_destroy, vxt_read_points, write("points.txt", "# targets\n1 2 3\n-4.5 5 6 tip\n").c_str());
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

TEST_F(CFiles, FromMemoryAsFromFiles) {
    const VolumeData volume =
        makeBytes(unitGrid(9, 7, 5), [](auto x, auto y, auto z) { return static_cast<double>(x + 10 * y + z); });
    const vxt_volume_view view = cVolume(volume);
    const std::string nrrd = path("volume.nrrd");
    need(vxt_write_volume(nrrd.c_str(), &view));
    const std::string bytes = content(nrrd);
    const auto data =
        made(vxt_volume_data_destroy, vxt_read_volume_bytes, "some.nrrd", bytes.data(), bytes.size(), nullptr);
    const vxt_volume_view read = dataView(data);
    ASSERT_EQ(read.bytes, volume.voxels.size());
    EXPECT_EQ(std::memcmp(read.voxels, volume.voxels.data(), read.bytes), 0);

    const MeshData cube = makeCube(-1, 1);
    const vxt_mesh_view mesh = cMesh(cube);
    const std::string ply = path("cube.ply");
    need(vxt_write_mesh(ply.c_str(), &mesh));
    const std::string meshBytes = content(ply);
    vxt_mesh_read_options options = sized<vxt_mesh_read_options>();
    options.scale = 10;
    const auto readMesh =
        made(vxt_mesh_data_destroy, vxt_read_mesh_bytes, "cube.ply", meshBytes.data(), meshBytes.size(), &options);
    EXPECT_EQ(dataView(readMesh).triangle_count, 12U);
    EXPECT_EQ(std::abs(dataView(readMesh).positions[0]), 10);
    vxt_mesh_data* none = nullptr;
    EXPECT_EQ(vxt_read_mesh_bytes("cube.stl", meshBytes.data(), 7, nullptr, &none), VXT_ERROR_FORMAT);
}

TEST_F(CFiles, PosesSomeAtATime) {
    std::string text = "# five poses\n";
    for (int i = 0; i < 5; ++i) {
        text += "1 0 0 " + std::to_string(i) + "  0 1 0 0  0 0 1 0  0 0 0 1\n";
    }
    const std::string cut = write("poses.txt", text + "1 2 3\n");
    const auto reader = made(vxt_pose_reader_destroy, vxt_pose_reader_open, cut.c_str(), nullptr);
    Mat4 poses[2];
    std::size_t count = 9;
    for (const double first : {0.0, 2.0}) {
        need(vxt_pose_reader_read(reader.get(), poses[0].data(), 2, &count));
        ASSERT_EQ(count, 2U);
        EXPECT_EQ(poses[0][12], first);
        EXPECT_EQ(poses[1][12], first + 1);
    }
    EXPECT_EQ(vxt_pose_reader_read(reader.get(), poses[0].data(), 2, &count), VXT_ERROR_FORMAT);
    EXPECT_THAT(vxt_last_error(nullptr), HasSubstr("line 7"));
    EXPECT_EQ(count, 0U);
    const std::string good = write("good.txt", text);
    const auto all = made(vxt_pose_reader_destroy, vxt_pose_reader_open, good.c_str(), "matrix");
    std::vector<Mat4> room(9);
    need(vxt_pose_reader_read(all.get(), room.data()->data(), room.size(), &count));
    EXPECT_EQ(count, 5U);
    need(vxt_pose_reader_read(all.get(), room.data()->data(), room.size(), &count));
    EXPECT_EQ(count, 0U);
}

TEST_F(CFiles, ColoursAndPictures) {
    const std::string look =
        write("look.json", R"({"points": [[0, 0], [9, 1]], "colours": [[0, 0.1, 0.2, 0.3], [5, 1, 0.5, 0]]})");
    const auto colours = made(vxt_colour_points_destroy, vxt_read_colours, look.c_str());
    std::size_t count = 0;
    const vxt_colour_point* points = vxt_colour_points_get(colours.get(), &count);
    ASSERT_EQ(count, 2U);
    EXPECT_EQ(points[1].value, 5);
    EXPECT_THAT(points[0].colour, testing::ElementsAre(0.1, 0.2, 0.3));
    const std::vector<std::uint8_t> rgba(2 * 3 * 4, 200);
    const std::string c = path("c.png");
    need(vxt_write_png(c.c_str(), 2, 3, rgba.data(), rgba.size()));
    const std::string png = content(c);
    ASSERT_GT(png.size(), 24U);
    EXPECT_EQ(png.substr(1, 3), "PNG");
    EXPECT_EQ(png[19], 2) << "the width";
    EXPECT_EQ(png[23], 3) << "the height";
    EXPECT_EQ(vxt_write_png(c.c_str(), 2, 3, rgba.data(), rgba.size() - 1), VXT_ERROR_INVALID_ARGUMENT);
}

} // namespace
} // namespace voxtact::test
