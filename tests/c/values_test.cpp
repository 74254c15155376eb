// SPDX-License-Identifier: MIT
// Small functions on values, files in memory and poses some at a time: what the C++ interface answers.
#include "both_interfaces.h"
#include "support/scenes.h"

#include <gmock/gmock.h>

#include <atomic>
#include <chrono>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <thread>

namespace voxtact::test {
namespace {

using testing::ElementsAreArray;
using testing::HasSubstr;

Grid obliqueGrid() {
    Grid grid;
    grid.size = {9, 7, 5};
    grid.spacing = {0.5, 0.75, 2};
    grid.origin = {-10, 20, 3};
    grid.direction = {0.8, 0.6, 0, -0.6, 0.8, 0, 0, 0, 1};
    return grid;
}

TEST(CValues, MatricesAndPoints) {
    std::mt19937_64 random(11);
    const Mat4 a = randomMotion(random);
    const Mat4 b = randomMotion(random);
    Mat4 out{};
    need(vxt_multiply(a.data(), b.data(), out.data()));
    EXPECT_THAT(out, ElementsAreArray(multiply(a, b)));
    out = b;
    need(vxt_multiply(a.data(), out.data(), out.data()));
    EXPECT_THAT(out, ElementsAreArray(multiply(a, b))) << "into one of the two";
    Vec3 point{1, 2, 3};
    const Vec3 expected = transformPoint(a, point);
    need(vxt_transform_point(a.data(), point.data(), point.data()));
    EXPECT_THAT(point, ElementsAreArray(expected));
    const Grid grid = obliqueGrid();
    const Mat4 camera = framingCamera(grid, 64, 32);
    need(vxt_side_view(camera.data(), out.data()));
    EXPECT_THAT(out, ElementsAreArray(sideView(camera)));
    const vxt_grid given = cGrid(grid);
    need(vxt_texture_from_world(&given, out.data()));
    EXPECT_THAT(out, ElementsAreArray(take(textureFromWorld(grid))));
}

TEST(CValues, Checks) {
    vxt_grid grid = cGrid(obliqueGrid());
    EXPECT_EQ(vxt_check_grid(&grid), VXT_OK);
    grid.spacing[1] = 0;
    EXPECT_EQ(vxt_check_grid(&grid), VXT_ERROR_INVALID_ARGUMENT);
    EXPECT_THAT(vxt_last_error(nullptr), HasSubstr("spacing"));
    Mat4 pose = identity();
    EXPECT_EQ(vxt_check_affine(pose.data()), VXT_OK);
    pose[3] = 1;
    EXPECT_EQ(vxt_check_affine(pose.data()), VXT_ERROR_INVALID_ARGUMENT);
    EXPECT_STREQ(vxt_scalar_type_name(VXT_SCALAR_UINT16), toString(ScalarType::UInt16));
    EXPECT_STREQ(vxt_scalar_type_name(static_cast<vxt_scalar_type>(9)), "unknown");
    for (const Projection projection : projections()) {
        EXPECT_EQ(vxt_projection_uses_view(static_cast<vxt_projection>(projection)) != 0, usesView(projection));
    }
    for (const CountingMethod method : countingMethods()) {
        EXPECT_EQ(vxt_method_exactness(static_cast<vxt_method>(method)), static_cast<vxt_exactness>(exactness(method)));
    }
}

TEST(CValues, ABallsVoxels) {
    const Grid grid = obliqueGrid();
    const vxt_grid given = cGrid(grid);
    const Vec3 centre = transformPoint(worldFromIndex(grid), {4, 3, 2});
    vxt_voxel_box box{};
    need(vxt_ball_voxels(&given, centre.data(), 0.9, &box));
    const VoxelBox expected = take(voxelBounds(Ball{centre, 0.9}, grid));
    EXPECT_THAT(box.first, ElementsAreArray(expected.first));
    EXPECT_THAT(box.size, ElementsAreArray(expected.size));
    EXPECT_GT(box.size[0], 1U);
    EXPECT_EQ(vxt_ball_voxels(&given, centre.data(), -1, &box), VXT_ERROR_INVALID_ARGUMENT);
}

TEST(CValues, ATable) {
    const std::vector<ControlPoint> points{{10, 0}, {20, 1}};
    const std::vector<vxt_control_point> given = cPoints(points);
    const vxt_transfer_function_desc desc = cFunction(given, {0, 40}, 32);
    std::vector<float> table(33, -1);
    need(vxt_sample_table(&desc, table.data(), table.size()));
    const std::vector<float> expected = take(sampleTable({points, {0, 40}, 32}));
    EXPECT_THAT(std::span(table).first(32), ElementsAreArray(expected));
    EXPECT_EQ(table[32], -1);
    EXPECT_EQ(vxt_sample_table(&desc, table.data(), 31), VXT_ERROR_INVALID_ARGUMENT);
    EXPECT_THAT(vxt_last_error(nullptr), HasSubstr("room for 31 entries, there are 32"));
}

TEST(CValues, WhatIsOpaque) {
    // Entries 132 apart, which pass over two of three peaks.
    const std::vector<ControlPoint> points{{0, 0},    {150, 0},  {160, 1},  {170, 0},  {1000, 0},
                                           {1010, 1}, {1020, 0}, {2000, 0}, {20000, 1}};
    const std::vector<vxt_control_point> given = cPoints(points);
    const ValueRange all{-1000, 32767};
    const vxt_transfer_function_desc desc = cFunction(given, all, 256);
    const OpacityFacts expected = take(checkOpacity({points, all, 256}, all, 0.1));
    ASSERT_EQ(expected.lost.size(), 2U);
    const vxt_range data{all.lo, all.hi};
    vxt_range lost[] = {{}, {}, {-7, -7}};
    vxt_opacity_facts facts{};
    need(vxt_check_opacity(&desc, &data, 0.1, lost, 3, &facts));
    EXPECT_EQ(facts.spacing, expected.spacing);
    EXPECT_EQ(facts.lost, 2U);
    EXPECT_EQ(facts.reaches, 1U);
    EXPECT_EQ(facts.any, 1U);
    for (std::size_t i = 0; i < 2; ++i) {
        EXPECT_EQ(lost[i].lo, expected.lost[i].lo);
        EXPECT_EQ(lost[i].hi, expected.lost[i].hi);
    }
    EXPECT_EQ(lost[2].lo, -7);
    lost[1] = lost[2];
    need(vxt_check_opacity(&desc, &data, 0.1, lost, 1, &facts));
    EXPECT_EQ(facts.lost, 2U);
    EXPECT_EQ(lost[1].lo, -7);
    const vxt_range below{-1000, -500};
    need(vxt_check_opacity(&desc, &below, 0.1, nullptr, 0, &facts));
    EXPECT_EQ(facts.reaches, 1U);
    EXPECT_EQ(facts.any, 0U);
    EXPECT_EQ(vxt_check_opacity(&desc, &data, 2, nullptr, 0, &facts), VXT_ERROR_INVALID_ARGUMENT);
    EXPECT_EQ(vxt_check_opacity(&desc, &data, 0.1, nullptr, 2, &facts), VXT_ERROR_INVALID_ARGUMENT);
}

TEST(CValues, GridsOfLabelsAndVolumes) {
    const Grid grid = obliqueGrid();
    const VolumeData image = makeBytes(grid, [](auto x, auto, auto) { return static_cast<double>(x); });
    const vxt_volume_view view = cVolume(image);
    const auto labels = made<vxt_labels>(vxt_labels_destroy, [&](auto out) { return vxt_labels_create(&view, out); });
    const auto volume =
        made<vxt_host_volume>(vxt_host_volume_destroy, [&](auto out) { return vxt_host_volume_create(&view, out); });
    const vxt_grid expected = cGrid(grid);
    vxt_grid found{};
    need(vxt_labels_grid(labels.get(), &found));
    EXPECT_EQ(std::memcmp(&found, &expected, sizeof found), 0);
    found = {};
    need(vxt_host_volume_grid(volume.get(), &found));
    EXPECT_EQ(std::memcmp(&found, &expected, sizeof found), 0);
}

TEST(CValues, AnAnswerOfTheDevice) {
    // By the method compute in the projection conservative: many survivors; then none, and fragments undecided.
    constexpr std::uint32_t kHow = 4U | 3U << 8U;
    for (const PairResult& packed :
         {PairResult{5, 1, 7, 2, 3, kHow}, PairResult{0, 0, 7, 2, 3, kHow | 1U << 16U | VOXTACT_HOW_UNDECIDED_BIT}}) {
        const PairAnswer expected = unpack(packed);
        vxt_device_pair given{};
        static_assert(sizeof given == sizeof packed);
        std::memcpy(&given, &packed, sizeof given);
        vxt_pair pair{};
        need(vxt_unpack(&given, &pair));
        EXPECT_EQ(pair.count, packed.countLow == 0 ? 0 : (std::uint64_t{1} << 32U) + 5);
        EXPECT_EQ(pair.pair, 7U);
        EXPECT_EQ(pair.item, 2U);
        EXPECT_EQ(pair.pose, 3U);
        EXPECT_EQ(pair.method, VXT_METHOD_COMPUTE);
        EXPECT_EQ(pair.projection, VXT_PROJECTION_CONSERVATIVE);
        EXPECT_EQ(pair.exactness, packed.countLow == 0 ? VXT_EXACTNESS_LOWER_BOUND : VXT_EXACTNESS_EXACT);
        EXPECT_EQ(pair.hit != 0, packed.countLow != 0);
        EXPECT_EQ(pair.possible != 0, expected.possible);
    }
}

TEST(CValues, NullIsRefused) {
    const Mat4 matrix = identity();
    const vxt_grid grid = cGrid(obliqueGrid());
    const std::vector<vxt_control_point> points{{0, 0}, {1, 1}};
    const vxt_transfer_function_desc desc = cFunction(points, {0, 1}, 2);
    vxt_volume_data* volume = nullptr;
    vxt_mesh_data* mesh = nullptr;
    std::size_t count = 0;
    for (const vxt_result result : {vxt_multiply(nullptr, matrix.data(), nullptr),
                                    vxt_multiply(matrix.data(), matrix.data(), nullptr),
                                    vxt_transform_point(matrix.data(), nullptr, nullptr),
                                    vxt_side_view(nullptr, nullptr),
                                    vxt_texture_from_world(nullptr, nullptr),
                                    vxt_texture_from_world(&grid, nullptr),
                                    vxt_check_grid(nullptr),
                                    vxt_check_affine(nullptr),
                                    vxt_sample_table(nullptr, nullptr, 0),
                                    vxt_check_opacity(&desc, nullptr, 0.5, nullptr, 0, nullptr),
                                    vxt_sample_table(&desc, nullptr, 2),
                                    vxt_ball_voxels(&grid, nullptr, 1, nullptr),
                                    vxt_ball_voxels(&grid, matrix.data(), 1, nullptr),
                                    vxt_labels_grid(nullptr, nullptr),
                                    vxt_host_volume_grid(nullptr, nullptr),
                                    vxt_unpack(nullptr, nullptr),
                                    vxt_cancel_create(nullptr),
                                    vxt_read_volume_bytes(nullptr, nullptr, 0, nullptr, &volume),
                                    vxt_read_mesh_bytes("a.stl", nullptr, 1, nullptr, &mesh),
                                    vxt_pose_reader_open(nullptr, nullptr),
                                    vxt_pose_reader_read(nullptr, nullptr, 1, &count),
                                    vxt_read_colours(nullptr, nullptr),
                                    vxt_write_png(nullptr, 1, 1, matrix.data(), 4)}) {
        EXPECT_EQ(result, VXT_ERROR_INVALID_ARGUMENT);
    }
    EXPECT_THAT(vxt_last_error(nullptr), HasSubstr("null"));
    vxt_cancel_set(nullptr, 1);
    vxt_cancel_destroy(nullptr);
    vxt_pose_reader_destroy(nullptr);
    vxt_colour_points_destroy(nullptr);
    EXPECT_EQ(vxt_colour_points_get(nullptr, &count), nullptr);
}

TEST(CValues, ACallThatIsCancelled) {
    std::mt19937_64 random(5);
    const VolumeData volume = makeBytes(unitGrid(16), [&](auto...) { return uniform(random, 0, 255); });
    const MeshData cube = makeCube(0.1, 0.9);
    const vxt_volume_view view = cVolume(volume);
    const vxt_mesh_view mesh = cMesh(cube);
    const std::vector<vxt_control_point> points{{0, 0}, {255, 1}};
    const vxt_transfer_function_desc desc = cFunction(points, {0, 255}, 256);
    const auto onHost =
        made<vxt_host_volume>(vxt_host_volume_destroy, [&](auto out) { return vxt_host_volume_create(&view, out); });
    const auto function = made<vxt_host_transfer_function>(
        vxt_host_transfer_function_destroy, [&](auto out) { return vxt_host_transfer_function_create(&desc, out); });
    const auto shape =
        made<vxt_host_mesh>(vxt_host_mesh_destroy, [&](auto out) { return vxt_host_mesh_create(&mesh, out); });
    const auto detector = made<vxt_host_detector>(vxt_host_detector_destroy, [&](auto out) {
        vxt_host_detector_desc how = vxt_host_detector_desc_init();
        how.projection = VXT_PROJECTION_CONSERVATIVE;
        return vxt_host_detector_create(&how, out);
    });
    const auto cancel = made<vxt_cancel>(vxt_cancel_destroy, [](auto out) { return vxt_cancel_create(out); });
    const std::vector<Mat4> poses(2000000, identity());
    vxt_host_item item = vxt_host_item_init();
    item.mesh = shape.get();
    item.volume = onHost.get();
    item.transfer_function = function.get();
    item.world_from_object = poses.data()->data();
    item.pose_count = poses.size();
    vxt_host_batch batch = vxt_host_batch_init();
    batch.items = &item;
    batch.item_count = 1;
    batch.cancel = cancel.get();
    const Owned<vxt_answer> answer = newAnswer();
    std::thread other([&] {
        std::this_thread::sleep_for(std::chrono::milliseconds(100));
        vxt_cancel_set(cancel.get(), 1);
    });
    EXPECT_EQ(vxt_host_detector_detect(detector.get(), &batch, answer.get()), VXT_ERROR_CANCELLED);
    other.join();
    EXPECT_THAT(vxt_last_error(nullptr), HasSubstr("cancelled"));
    EXPECT_TRUE(answerOf(*answer).pairs.empty()) << "the answer holds what it held";
    vxt_cancel_set(cancel.get(), 0);
    std::thread hasty([&] { // asks, and makes it ready again at once
        for (const uint32_t set : {1, 0}) {
            std::this_thread::sleep_for(std::chrono::milliseconds(100));
            vxt_cancel_set(cancel.get(), set);
        }
    });
    EXPECT_EQ(vxt_host_detector_detect(detector.get(), &batch, answer.get()), VXT_ERROR_CANCELLED);
    hasty.join();
    item.pose_count = 3;
    need(vxt_host_detector_detect(detector.get(), &batch, answer.get()));
    EXPECT_EQ(answerOf(*answer).pairs.size(), 3U);
}

/// A folder that ends with the test.
class CFilesInParts : public testing::Test {
  protected:
    CFilesInParts() : folder_(std::filesystem::temp_directory_path() / ("voxtact-c-" + std::to_string(getpid()))) {
        std::filesystem::create_directories(folder_);
    }
    ~CFilesInParts() override { std::filesystem::remove_all(folder_); }
    [[nodiscard]] std::string at(const char* name) const { return (folder_ / name).string(); }
    [[nodiscard]] std::string write(const char* name, const std::string& text) const {
        std::ofstream(at(name)) << text;
        return at(name);
    }
    [[nodiscard]] static std::string content(const std::string& path) {
        std::ifstream file(path, std::ios::binary);
        return {std::istreambuf_iterator<char>(file), {}};
    }

    std::filesystem::path folder_;
};

TEST_F(CFilesInParts, FromMemoryAsFromFiles) {
    const VolumeData volume =
        makeBytes(obliqueGrid(), [](auto x, auto y, auto z) { return static_cast<double>(x + 10 * y + z); });
    const vxt_volume_view view = cVolume(volume);
    const std::string nrrd = at("volume.nrrd");
    need(vxt_write_volume(nrrd.c_str(), &view));
    const std::string bytes = content(nrrd);
    const auto data = made<vxt_volume_data>(vxt_volume_data_destroy, [&](auto out) {
        return vxt_read_volume_bytes("some.nrrd", bytes.data(), bytes.size(), nullptr, out);
    });
    const vxt_volume_view read = dataView(data);
    ASSERT_EQ(read.bytes, volume.voxels.size());
    EXPECT_EQ(std::memcmp(read.voxels, volume.voxels.data(), read.bytes), 0);

    const MeshData cube = makeCube(-1, 1);
    const vxt_mesh_view mesh = cMesh(cube);
    const std::string ply = at("cube.ply");
    need(vxt_write_mesh(ply.c_str(), &mesh));
    const std::string meshBytes = content(ply);
    vxt_mesh_read_options options = vxt_mesh_read_options_init();
    options.scale = 10;
    const auto readMesh = made<vxt_mesh_data>(vxt_mesh_data_destroy, [&](auto out) {
        return vxt_read_mesh_bytes("cube.ply", meshBytes.data(), meshBytes.size(), &options, out);
    });
    EXPECT_EQ(dataView(readMesh).triangle_count, 12U);
    EXPECT_EQ(std::abs(dataView(readMesh).positions[0]), 10);
    vxt_mesh_data* none = nullptr;
    EXPECT_EQ(vxt_read_mesh_bytes("cube.stl", meshBytes.data(), 7, nullptr, &none), VXT_ERROR_FORMAT);
}

TEST_F(CFilesInParts, PosesSomeAtATime) {
    std::string text = "# five poses\n";
    for (int i = 0; i < 5; ++i) {
        text += "1 0 0 " + std::to_string(i) + "  0 1 0 0  0 0 1 0  0 0 0 1\n";
    }
    const std::string path = write("poses.txt", text + "1 2 3\n");
    const auto reader = made<vxt_pose_reader>(vxt_pose_reader_destroy,
                                              [&](auto out) { return vxt_pose_reader_open(path.c_str(), out); });
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
    const auto all = made<vxt_pose_reader>(vxt_pose_reader_destroy,
                                           [&](auto out) { return vxt_pose_reader_open(good.c_str(), out); });
    std::vector<Mat4> room(9);
    need(vxt_pose_reader_read(all.get(), room.data()->data(), room.size(), &count));
    EXPECT_EQ(count, 5U);
    need(vxt_pose_reader_read(all.get(), room.data()->data(), room.size(), &count));
    EXPECT_EQ(count, 0U);
}

TEST_F(CFilesInParts, ColoursAndPictures) {
    const std::string path =
        write("look.json", R"({"points": [[0, 0], [9, 1]], "colours": [[0, 0.1, 0.2, 0.3], [5, 1, 0.5, 0]]})");
    const auto colours = made<vxt_colour_points>(vxt_colour_points_destroy,
                                                 [&](auto out) { return vxt_read_colours(path.c_str(), out); });
    std::size_t count = 0;
    const vxt_colour_point* points = vxt_colour_points_get(colours.get(), &count);
    ASSERT_EQ(count, 2U);
    EXPECT_EQ(points[1].value, 5);
    EXPECT_THAT(points[0].colour, testing::ElementsAre(0.1, 0.2, 0.3));
    const std::vector<std::uint8_t> rgba(2 * 3 * 4, 200);
    const std::string c = at("c.png");
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
