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
    vxt_detector_desc desc = vxt_detector_desc_init();
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
    const vxt_voxel_box right{{2, 0, 0}, {2, 4, 4}};
    EXPECT_EQ(edited([&](auto commands) { need(vxt_volume_cmd_set_box(sides.volume.get(), commands, &right, 255)); }),
              256U);
    const double centre[3] = {0.5, 0.5, 0.5};
    EXPECT_EQ(edited([&](auto commands) { need(vxt_volume_cmd_set_ball(sides.volume.get(), commands, centre, 9, 0)); }),
              0U);
    const std::vector<std::byte> opaque(32, std::byte{255});
    EXPECT_EQ(edited([&](auto commands) {
                  need(vxt_volume_cmd_write(sides.volume.get(), commands, &right, opaque.data(), opaque.size()));
              }),
              128U);
    const RawVulkan::HostBuffer source =
        raw.makeBuffer(std::span<const std::byte>(opaque), VK_BUFFER_USAGE_TRANSFER_SRC_BIT);
    const vxt_voxel_box left{{0, 0, 0}, {2, 4, 4}};
    EXPECT_EQ(edited([&](auto commands) {
                  need(vxt_volume_cmd_copy(sides.volume.get(), commands, &left, source.buffer, 0));
              }),
              256U);
    // A table under which nothing is opaque, and its domain.
    const vxt_control_point none[] = {{0, 0}, {1, 0}};
    vxt_transfer_function_desc table = vxt_transfer_function_desc_init();
    table.points = none;
    table.point_count = 2;
    table.domain = {0, 300};
    EXPECT_EQ(
        edited([&](auto commands) { need(vxt_transfer_function_cmd_update(sides.function.get(), commands, &table)); }),
        0U);
    vxt_range domain{};
    need(vxt_transfer_function_domain(sides.function.get(), &domain));
    EXPECT_EQ(domain.hi, 300);
}

TEST_F(CGpuTest, WrapsTheCallersObjects) {
    const RandomScene scene = halfOpaque();
    const CScene sides(context_.get(), queue_, scene, twoLabels());
    RawVulkan raw(gpu().device);
    vxt_wrapped_volume wrapped = vxt_wrapped_volume_init();
    wrapped.view = raw.makeImage(VK_IMAGE_TYPE_3D, VK_FORMAT_R8_UNORM, {4, 4, 4}, scene.volume.voxels,
                                 VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL);
    wrapped.format = VK_FORMAT_R8_UNORM;
    wrapped.grid = cGrid(scene.volume.grid);
    wrapped.bricks = 1;
    const auto volume =
        made<vxt_volume>(vxt_volume_destroy, [&](auto out) { return vxt_volume_wrap(context_.get(), &wrapped, out); });
    const std::vector<float> table = take(sampleTable(scene.transferFunction()));
    vxt_wrapped_transfer_function wrappedTable = vxt_wrapped_transfer_function_init();
    wrappedTable.view =
        raw.makeImage(VK_IMAGE_TYPE_1D, VK_FORMAT_R32_SFLOAT, {static_cast<std::uint32_t>(table.size()), 1, 1},
                      std::as_bytes(std::span(table)), VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL);
    wrappedTable.table = table.data();
    wrappedTable.table_size = table.size();
    const auto function = made<vxt_transfer_function>(vxt_transfer_function_destroy, [&](auto out) {
        return vxt_transfer_function_wrap(context_.get(), &wrappedTable, out);
    });
    vxt_wrapped_mesh wrappedMesh = vxt_wrapped_mesh_init();
    wrappedMesh.vertices =
        raw.makeBuffer(std::span<const float>(scene.mesh.positions), VK_BUFFER_USAGE_VERTEX_BUFFER_BIT).buffer;
    wrappedMesh.vertex_count = static_cast<std::uint32_t>(scene.mesh.positions.size() / 3);
    wrappedMesh.indices =
        raw.makeBuffer(std::span<const std::uint32_t>(scene.mesh.indices), VK_BUFFER_USAGE_INDEX_BUFFER_BIT).buffer;
    wrappedMesh.triangle_count = static_cast<std::uint32_t>(scene.mesh.indices.size() / 3);
    const auto mesh =
        made<vxt_mesh>(vxt_mesh_destroy, [&](auto out) { return vxt_mesh_wrap(context_.get(), &wrappedMesh, out); });
    const VkCommandBuffer commands = raw.begin();
    const vxt_voxel_box whole{{0, 0, 0}, {4, 4, 4}};
    need(vxt_volume_cmd_update_bricks(volume.get(), commands, &whole));
    raw.submitAndWait(commands);

    COneItem of(sides, scene);
    of.item.volume = volume.get();
    of.item.transfer_function = function.get();
    of.item.mesh = mesh.get();
    EXPECT_EQ(ask(*newBlocking(vxt_detector_desc_init()), of).pairs.at(0).count, 128U);
    EXPECT_EQ(vxt_mesh_triangles(mesh.get()), 2U);

    const std::array<float, 32> matrices{1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1,
                                         1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 9, 0, 0, 1};
    vxt_wrapped_poses wrappedPoses = vxt_wrapped_poses_init();
    wrappedPoses.buffer = raw.makeBuffer(std::span<const float>(matrices), VK_BUFFER_USAGE_STORAGE_BUFFER_BIT).buffer;
    wrappedPoses.count = 2;
    const auto poses = made<vxt_pose_buffer>(vxt_pose_buffer_destroy, [&](auto out) {
        return vxt_pose_buffer_wrap(context_.get(), &wrappedPoses, "two poses", out);
    });
    EXPECT_EQ(vxt_pose_buffer_count(poses.get()), 2U);
    COneItem moving(sides, scene);
    moving.item = of.item;
    moving.item.poses = poses.get();
    moving.item.pose_count = 2;
    vxt_detector_desc withPoses = vxt_detector_desc_init();
    withPoses.device_poses = 1;
    const auto byPoses = newBlocking(withPoses);
    const auto answer = made<vxt_answer>(vxt_answer_destroy, [](auto out) { return vxt_answer_create(out); });
    EXPECT_EQ(vxt_blocking_detector_detect(byPoses.get(), &moving.batch, answer.get()), VXT_ERROR_INVALID_ARGUMENT)
        << "poses and world_from_object";
    moving.item.world_from_object = nullptr;
    EXPECT_EQ(ask(*byPoses, moving).pairs.at(0).count, 128U);
    EXPECT_EQ(ask(*byPoses, moving).pairs.at(1).count, 0U);
    moving.item.pose_count = 3;
    EXPECT_EQ(vxt_blocking_detector_detect(byPoses.get(), &moving.batch, answer.get()), VXT_ERROR_INVALID_ARGUMENT);
    vxt_mesh_facts facts{};
    EXPECT_EQ(vxt_mesh_get_facts(mesh.get(), &facts), VXT_ERROR_NOT_READY);
    vxt_volume_info info = vxt_volume_info_init();
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
    EXPECT_EQ(info.grid.size[2], 4U);
    std::size_t count = 0;
    const std::int32_t* labels = vxt_label_map_values(sides.labelMap.get(), &count);
    EXPECT_EQ(std::vector(labels, labels + count), (std::vector<std::int32_t>{0, 3}));
    // Voxels on the faces are opaque: clamping would count what is outside.
    vxt_boundary boundary = VXT_BOUNDARY_MAX;
    const Owned<vxt_detector> detector = newDetector(vxt_detector_desc_init());
    need(vxt_detector_boundary_for(detector.get(), &of.item, 0.5, &boundary));
    EXPECT_EQ(boundary, VXT_BOUNDARY_RANGE);
    of.item.volume = nullptr;
    EXPECT_EQ(vxt_detector_boundary_for(detector.get(), &of.item, 0.5, &boundary), VXT_ERROR_INVALID_ARGUMENT);
}

} // namespace
} // namespace voxtact::test
