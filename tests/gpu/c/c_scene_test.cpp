// SPDX-License-Identifier: MIT
// The scene on the device through the C interface: edits, and the caller's own objects.
#include "c_fixture.h"

#include "raw_vulkan.h"

#include <gmock/gmock.h>

#include <cstring>

namespace voxtact::test {
namespace {

TEST_F(CGpuTest, EditsTakeEffectInTheOrderOfTheCommands) {
    const RandomScene scene = halfOpaque();
    const CScene sides(context_.get(), queue_, scene, twoLabels());
    const COneItem of(sides, scene);
    vxt_raster_desc desc = sized<vxt_raster_desc>();
    desc.method = VXT_METHOD_COMPUTE;
    desc.filter = VXT_FILTER_EXACT;
    const Owned<vxt_blocking_detector> detector = newBlocking(desc);
    RawVulkan raw(gpu().device);
    const auto edited = [&](auto record) {
        const VkCommandBuffer commands = raw.begin();
        record(commands);
        raw.submitAndWait(commands);
        return ask(*detector, of).pairs.at(0).count;
    };
    const std::uint64_t before = ask(*detector, of).pairs.at(0).count;
    EXPECT_EQ(before, 128U);
    const vxt_voxel_box right{{3, 0, 0}, {3, 6, 6}};
    EXPECT_EQ(edited([&](auto commands) { need(vxt_volume_cmd_set_box(sides.volume.get(), commands, &right, 255)); }),
              256U);
    const double centre[3] = {0.5, 0.5, 0.5};
    EXPECT_EQ(edited([&](auto commands) { need(vxt_volume_cmd_set_ball(sides.volume.get(), commands, centre, 9, 0)); }),
              0U);
    const std::vector<std::byte> opaque(108, std::byte{255});
    EXPECT_EQ(edited([&](auto commands) {
                  need(vxt_volume_cmd_write(sides.volume.get(), commands, &right, opaque.data(), opaque.size()));
              }),
              128U);
    const RawVulkan::HostBuffer source =
        raw.makeBuffer(std::span<const std::byte>(opaque), VK_BUFFER_USAGE_TRANSFER_SRC_BIT);
    const vxt_voxel_box left{{0, 0, 0}, {3, 6, 6}};
    EXPECT_EQ(edited([&](auto commands) {
                  need(vxt_volume_cmd_copy(sides.volume.get(), commands, &left, source.buffer, 0));
              }),
              256U);
    // A table under which nothing is opaque, and its domain.
    const std::vector<vxt_control_point> none{{0, 0}, {1, 0}};
    const vxt_transfer_function_desc table = cFunction(none, {0, 300}, 0);
    EXPECT_EQ(
        edited([&](auto commands) { need(vxt_transfer_function_cmd_update(sides.function.get(), commands, &table)); }),
        0U);
    vxt_range domain{};
    need(vxt_transfer_function_domain(sides.function.get(), &domain));
    EXPECT_EQ(domain.hi, 300);
}

TEST_F(CGpuTest, MeshesBend) {
    const RandomScene scene = halfOpaque();
    const CScene sides(context_.get(), queue_, scene, twoLabels());
    RawVulkan raw(gpu().device);
    const vxt_mesh_view view = cMesh(scene.mesh);
    vxt_mesh_options options = sized<vxt_mesh_options>();
    options.clusters = options.editable = 1;
    options.vertex_stride = 16;
    const auto mesh = made(vxt_mesh_destroy, vxt_mesh_upload, context_.get(), &queue_, &view, &options);
    COneItem of(sides, scene);
    of.item.mesh = mesh.get();
    const Owned<vxt_blocking_detector> detector = newBlocking(sized<vxt_raster_desc>());
    EXPECT_EQ(ask(*detector, of).pairs.at(0).count, 128U);
    // A quarter of the square: what of it is opaque is the whole quarter, then nothing.
    std::vector<double> quarter = scene.mesh.positions;
    std::vector<float> sixteen;
    for (std::size_t at = 0; at < quarter.size(); at += 3) {
        quarter[at] *= 0.5;
        quarter[at + 1] *= 0.5;
        for (const double each : {0.5 + quarter[at], quarter[at + 1], quarter[at + 2], 99.0}) {
            sixteen.push_back(static_cast<float>(each));
        }
    }
    VkCommandBuffer commands = raw.begin();
    need(vxt_mesh_cmd_update(mesh.get(), commands, quarter.data(), quarter.size() / 3));
    raw.submitAndWait(commands);
    EXPECT_EQ(ask(*detector, of).pairs.at(0).count, 64U);
    vxt_mesh_facts facts{};
    need(vxt_mesh_get_facts(mesh.get(), &facts));
    EXPECT_EQ(facts.bounds.hi[0], 0.5);
    const VkBuffer source = raw.makeBuffer(std::span<const float>(sixteen), VK_BUFFER_USAGE_TRANSFER_SRC_BIT).buffer;
    commands = raw.begin();
    need(vxt_mesh_cmd_copy(mesh.get(), commands, source, 0));
    raw.submitAndWait(commands);
    EXPECT_EQ(ask(*detector, of).pairs.at(0).count, 0U);
    EXPECT_EQ(vxt_mesh_get_facts(mesh.get(), &facts), VXT_ERROR_NOT_READY);
    EXPECT_EQ(vxt_mesh_cmd_update(mesh.get(), commands, quarter.data(), 3), VXT_ERROR_INVALID_ARGUMENT);
    EXPECT_EQ(vxt_mesh_cmd_refit(mesh.get(), commands), VXT_ERROR_INVALID_ARGUMENT);
}

TEST_F(CGpuTest, FitsTheClustersOfTheCallersMesh) {
    const RandomScene scene = halfOpaque();
    RawVulkan raw(gpu().device);
    constexpr VkBufferUsageFlags kUsage =
        VK_BUFFER_USAGE_VERTEX_BUFFER_BIT | VK_BUFFER_USAGE_INDEX_BUFFER_BIT | VK_BUFFER_USAGE_STORAGE_BUFFER_BIT;
    vxt_wrapped_mesh wrapped = sized<vxt_wrapped_mesh>();
    const RawVulkan::HostBuffer vertices =
        raw.makeBuffer(std::span<const float>(floatsOf(scene.mesh.positions)), kUsage);
    wrapped.vertices = vertices.buffer;
    wrapped.vertex_count = static_cast<std::uint32_t>(scene.mesh.positions.size() / 3);
    wrapped.indices = raw.makeBuffer(std::span<const std::uint32_t>(scene.mesh.indices), kUsage).buffer;
    wrapped.triangle_count = static_cast<std::uint32_t>(scene.mesh.indices.size() / 3);
    wrapped.index_type = VK_INDEX_TYPE_UINT32;
    wrapped.storage = wrapped.clusters = 1;
    const vxt_mesh_view view = cMesh(scene.mesh);
    wrapped.shape = &view;
    const auto mesh = made(vxt_mesh_destroy, vxt_mesh_wrap, context_.get(), &wrapped);
    EXPECT_EQ(vxt_mesh_cmd_refit(mesh.get(), raw.begin()), VXT_ERROR_NOT_READY);
    const CScene sides(context_.get(), queue_, scene, twoLabels());
    const Owned<vxt_blocking_detector> detector = newBlocking(sized<vxt_certified_desc>());
    COneItem of(sides, scene);
    of.item.mesh = mesh.get();
    const auto countAfter = [&](auto record) {
        const VkCommandBuffer commands = raw.begin();
        need(record(commands));
        raw.submitAndWait(commands);
        return ask(*detector, of).pairs.at(0).count;
    };
    EXPECT_GT(countAfter([&](VkCommandBuffer commands) { return vxt_mesh_cmd_upload(mesh.get(), commands); }), 0U);
    auto* positions = static_cast<float*>(vertices.mapped);
    const auto moveBy = [&](float x) {
        for (std::size_t at = 0; at < scene.mesh.positions.size(); at += 3) {
            positions[at] += x;
        }
    };
    const auto refit = [&](VkCommandBuffer commands) { return vxt_mesh_cmd_refit(mesh.get(), commands); };
    moveBy(5);
    EXPECT_EQ(countAfter(refit), 0U);
    moveBy(-5);
    EXPECT_GT(countAfter(refit), 0U);
}

TEST_F(CGpuTest, WrapsTheCallersObjects) {
    const RandomScene scene = halfOpaque();
    const CScene sides(context_.get(), queue_, scene, twoLabels());
    RawVulkan raw(gpu().device);
    vxt_wrapped_volume wrapped = sized<vxt_wrapped_volume>();
    wrapped.view = raw.makeImage(VK_IMAGE_TYPE_3D, VK_FORMAT_R8_UNORM, {6, 6, 6}, scene.volume.voxels,
                                 VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL);
    wrapped.format = VK_FORMAT_R8_UNORM;
    wrapped.grid = cGrid(scene.volume.grid);
    wrapped.bricks = 1;
    const auto volume = made(vxt_volume_destroy, vxt_volume_wrap, context_.get(), &wrapped);
    const std::vector<float> table = take(sampleTable(scene.transferFunction()));
    vxt_wrapped_transfer_function wrappedTable = sized<vxt_wrapped_transfer_function>();
    wrappedTable.view =
        raw.makeImage(VK_IMAGE_TYPE_1D, VK_FORMAT_R32_SFLOAT, {static_cast<std::uint32_t>(table.size()), 1, 1},
                      std::as_bytes(std::span(table)), VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL);
    wrappedTable.domain.hi = 255;
    wrappedTable.table = table.data();
    wrappedTable.table_size = table.size();
    const auto function =
        made(vxt_transfer_function_destroy, vxt_transfer_function_wrap, context_.get(), &wrappedTable);
    vxt_wrapped_mesh wrappedMesh = sized<vxt_wrapped_mesh>();
    wrappedMesh.vertices =
        raw.makeBuffer(std::span<const float>(floatsOf(scene.mesh.positions)), VK_BUFFER_USAGE_VERTEX_BUFFER_BIT)
            .buffer;
    wrappedMesh.vertex_count = static_cast<std::uint32_t>(scene.mesh.positions.size() / 3);
    wrappedMesh.indices =
        raw.makeBuffer(std::span<const std::uint32_t>(scene.mesh.indices), VK_BUFFER_USAGE_INDEX_BUFFER_BIT).buffer;
    wrappedMesh.index_type = VK_INDEX_TYPE_UINT32;
    wrappedMesh.triangle_count = static_cast<std::uint32_t>(scene.mesh.indices.size() / 3);
    const auto mesh = made(vxt_mesh_destroy, vxt_mesh_wrap, context_.get(), &wrappedMesh);
    const VkCommandBuffer commands = raw.begin();
    const vxt_voxel_box whole{{0, 0, 0}, {6, 6, 6}};
    need(vxt_volume_cmd_update_bricks(volume.get(), commands, &whole));
    raw.submitAndWait(commands);

    COneItem of(sides, scene);
    of.item.volume = volume.get();
    of.item.transfer_function = function.get();
    of.item.mesh = mesh.get();
    EXPECT_EQ(ask(*newBlocking(sized<vxt_raster_desc>()), of).pairs.at(0).count, 128U);
    EXPECT_EQ(vxt_mesh_triangles(mesh.get()), 2U);

    const std::array<float, 32> matrices{1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1,
                                         1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 9, 0, 0, 1};
    vxt_wrapped_poses wrappedPoses = sized<vxt_wrapped_poses>();
    wrappedPoses.buffer = raw.makeBuffer(std::span<const float>(matrices), VK_BUFFER_USAGE_STORAGE_BUFFER_BIT).buffer;
    wrappedPoses.count = 2;
    const auto poses = made(vxt_pose_buffer_destroy, vxt_pose_buffer_wrap, context_.get(), &wrappedPoses, "two poses");
    EXPECT_EQ(vxt_pose_buffer_count(poses.get()), 2U);
    COneItem moving(sides, scene);
    moving.item = of.item;
    moving.item.poses = poses.get();
    moving.item.pose_count = 2;
    vxt_raster_desc withPoses = sized<vxt_raster_desc>();
    withPoses.device_poses = 1;
    const auto byPoses = newBlocking(withPoses);
    const auto answer = made(vxt_answer_destroy, vxt_answer_create);
    EXPECT_EQ(vxt_blocking_detector_detect(byPoses.get(), &moving.batch, answer.get()), VXT_ERROR_INVALID_ARGUMENT)
        << "poses and world_from_object";
    moving.item.world_from_object = nullptr;
    EXPECT_EQ(ask(*byPoses, moving).pairs.at(0).count, 128U);
    EXPECT_EQ(ask(*byPoses, moving).pairs.at(1).count, 0U);
    moving.item.pose_count = 3;
    EXPECT_EQ(vxt_blocking_detector_detect(byPoses.get(), &moving.batch, answer.get()), VXT_ERROR_INVALID_ARGUMENT);
    vxt_mesh_facts facts{};
    EXPECT_EQ(vxt_mesh_get_facts(mesh.get(), &facts), VXT_ERROR_NOT_READY);
    vxt_volume_info info = sized<vxt_volume_info>();
    need(vxt_volume_get_info(volume.get(), &info));
    EXPECT_EQ(info.has_range, 0U);
    EXPECT_EQ(info.view, wrapped.view);

    // What was uploaded is known.
    need(vxt_mesh_get_facts(sides.mesh.get(), &facts));
    EXPECT_EQ(facts.triangles, 2U);
    need(vxt_volume_get_info(sides.volume.get(), &info));
    EXPECT_EQ(info.has_range, 1U);
    EXPECT_EQ(info.range.hi, 255);
    EXPECT_EQ(info.format, VK_FORMAT_R8_UNORM);
    EXPECT_EQ(info.grid.size[2], 6U);
    std::size_t count = 0;
    const std::int32_t* labels = vxt_label_map_values(sides.labelMap.get(), &count);
    EXPECT_EQ(std::vector(labels, labels + count), (std::vector<std::int32_t>{0, 3}));
    // Voxels on the faces are opaque: clamping would count what is outside.
    vxt_boundary boundary = VXT_BOUNDARY_MAX;
    const Owned<vxt_detector> detector = newDetector(sized<vxt_raster_desc>());
    need(vxt_detector_boundary_for(detector.get(), &of.item, 0.5, &boundary));
    EXPECT_EQ(boundary, VXT_BOUNDARY_RANGE);
    of.item.volume = nullptr;
    EXPECT_EQ(vxt_detector_boundary_for(detector.get(), &of.item, 0.5, &boundary), VXT_ERROR_INVALID_ARGUMENT);
}

} // namespace
} // namespace voxtact::test
