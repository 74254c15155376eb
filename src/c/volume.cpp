// SPDX-License-Identifier: MIT
// Volumes on the device.
#include "c/convert_vulkan.h"

using namespace voxtact;
using namespace voxtact::c;

namespace {

VolumeOptions toOptions(const vxt_volume_options* given) {
    const vxt_volume_options options = readOptions(given, zero<vxt_volume_options>(), "options");
    return {.name = options.name, .bricks = options.bricks != 0, .editable = options.editable != 0};
}

WrappedVolume toWrapped(const vxt_wrapped_volume* given) {
    const vxt_wrapped_volume wrapped = readStruct(given, zero<vxt_wrapped_volume>(), "wrapped volume");
    WrappedVolume out{.view = wrapped.view,
                      .format = wrapped.format,
                      .layout = layoutOf(wrapped.layout),
                      .grid = toGrid(wrapped.grid),
                      .slope = orDefault(wrapped.slope, 1.0),
                      .intercept = wrapped.intercept,
                      .boundaryValues = std::nullopt,
                      .bricks = wrapped.bricks != 0};
    if (wrapped.has_boundary != 0) {
        out.boundaryValues = toRange(wrapped.boundary);
    }
    return out;
}

} // namespace

vxt_result vxt_volume_create(const vxt_context* context, const vxt_volume_view* view, const vxt_volume_options* options,
                             vxt_volume** volume) {
    return create(context, "context", volume,
                  [&](const Context& on) { return take(Volume::create(on, toVolumeView(view), toOptions(options))); });
}

vxt_result vxt_volume_wrap(const vxt_context* context, const vxt_wrapped_volume* wrapped, vxt_volume** volume) {
    return create(context, "context", volume,
                  [&](const Context& on) { return take(Volume::wrap(on, toWrapped(wrapped))); });
}

vxt_result vxt_volume_upload(const vxt_context* context, const vxt_queue* queue, const vxt_volume_view* view,
                             const vxt_volume_options* options, vxt_volume** volume) {
    return create(context, "context", volume, [&](const Context& on) {
        return take(Volume::upload(on, toQueue(queue), toVolumeView(view), toOptions(options)));
    });
}

vxt_result vxt_volume_cmd_upload(vxt_volume* volume, VkCommandBuffer commands) {
    return call(volume, [&] { take(need(volume, "volume").object.cmdUpload(commands)); });
}

void vxt_volume_release_staging(vxt_volume* volume) {
    if (volume != nullptr) {
        volume->object.releaseStaging();
    }
}

vxt_result vxt_volume_cmd_update_bricks(vxt_volume* volume, VkCommandBuffer commands, const vxt_voxel_box* changed) {
    return call(volume, [&] { take(need(volume, "volume").object.cmdUpdateBricks(commands, toVoxelBox(changed))); });
}

vxt_result vxt_volume_cmd_set_box(vxt_volume* volume, VkCommandBuffer commands, const vxt_voxel_box* box,
                                  double value) {
    return call(volume, [&] { take(need(volume, "volume").object.cmdSet(commands, toVoxelBox(box), value)); });
}

vxt_result vxt_volume_cmd_set_ball(vxt_volume* volume, VkCommandBuffer commands, const double centre[3], double radius,
                                   double value) {
    return call(volume, [&] { take(need(volume, "volume").object.cmdSet(commands, toBall(centre, radius), value)); });
}

vxt_result vxt_volume_cmd_write(vxt_volume* volume, VkCommandBuffer commands, const vxt_voxel_box* box,
                                const void* voxels, size_t bytes) {
    return call(volume, [&] {
        take(need(volume, "volume").object.cmdWrite(commands, toVoxelBox(box), toBytes(voxels, bytes, "voxels")));
    });
}

vxt_result vxt_volume_cmd_copy(vxt_volume* volume, VkCommandBuffer commands, const vxt_voxel_box* box, VkBuffer source,
                               VkDeviceSize offset) {
    return call(volume,
                [&] { take(need(volume, "volume").object.cmdCopy(commands, toVoxelBox(box), source, offset)); });
}

vxt_result vxt_volume_get_info(const vxt_volume* volume, vxt_volume_info* info) {
    return call(volume, [&] {
        const Volume& from = need(volume, "volume").object;
        vxt_volume_info out = zero<vxt_volume_info>();
        out.view = from.view();
        out.grid = fromGrid(from.grid());
        if (const std::optional<ValueRange> range = from.valueRange()) {
            out.range = fromRange(*range);
            out.has_range = 1;
        }
        out.format = from.format();
        writeStruct(info, out, "info");
    });
}

void vxt_volume_destroy(vxt_volume* volume) {
    delete volume;
}
