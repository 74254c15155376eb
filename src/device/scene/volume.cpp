// SPDX-License-Identifier: MIT
#include "core/base/enum_check.h"
#include "core/base/guard.h"
#include "core/base/live.h"
#include "core/base/refuse.h"
#include "core/base/text.h"
#include "core/base/try.h"
#include "core/method/certified_constants.h"
#include "core/volume/boundary.h"
#include "device/scene/bricks.h"
#include "device/scene/edit_pass.h"
#include "device/scene/scene_impl.h"
#include "exact/shared.h"
#include "vulkan/barriers.h"
#include "vulkan/debug.h"
#include "vulkan/image_limits.h"
#include "vulkan/submit.h"
#include "vulkan/texels.h"

#include <cmath>
#include <cstring>

namespace voxtact {

namespace {

/// How a voxel type is kept in a texel: value = slope * texel + intercept.
struct TexelFormat {
    VkFormat format;
    double slope;
    double intercept;
};

TexelFormat texelFormat(ScalarType type) {
    switch (type) {
    case ScalarType::UInt8:
        return {VK_FORMAT_R8_UNORM, 255, 0};
    case ScalarType::Int16:
        return {VK_FORMAT_R16_UNORM, 65535, -double{kInt16SignBit}};
    case ScalarType::UInt16:
        return {VK_FORMAT_R16_UNORM, 65535, 0};
    case ScalarType::Float32:
        break;
    }
    return {VK_FORMAT_R32_SFLOAT, 1, 0};
}

/// The integer behind 1.0 of a format; 1 for floats, 0 for a format that cannot be used.
double unitOf(VkFormat format) {
    switch (format) {
    case VK_FORMAT_R8_UNORM:
        return 255;
    case VK_FORMAT_R16_UNORM:
        return 65535;
    case VK_FORMAT_R16_SNORM:
        return 32767;
    case VK_FORMAT_R16_SFLOAT:
    case VK_FORMAT_R32_SFLOAT:
        return 1;
    default:
        return 0;
    }
}

double storedUnitOf(VkFormat format) {
    return unitOf(format) > 1 ? unitOf(format) : 0;
}

VkExtent3D extentOf(const Grid& grid) {
    return {grid.size[0], grid.size[1], grid.size[2]};
}

VkImageUsageFlags usageOf(const VolumeOptions& options) {
    const VkImageUsageFlags usage = ImageDesc{}.usage;
    return options.editable ? usage | VK_IMAGE_USAGE_TRANSFER_SRC_BIT : usage;
}

Result<void> describe(VolumeImpl& volume, VkImageLayout layout, const char* name) {
    ContextImpl& context = volume.context;
    const Result<VkBuffer> bricks = volume.bricks.buffer ? Result<VkBuffer>(volume.bricks.get()) : emptyBuffer(context);
    VOXTACT_TRY(bricks);
    constexpr VkDescriptorPoolSize kSizes[] = {{VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER, 1},
                                               {VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, 1}};
    Result<DescriptorSet> set = makeDescriptorSet(context, context.setLayouts[VOXTACT_SET_VOLUME], kSizes, name);
    VOXTACT_TRY(set);
    volume.descriptors = std::move(*set);
    writeImage(context, volume.descriptors.set, 0, VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER, volume.view, layout,
               context.samplerOf(volume.filtered));
    writeBuffer(context, volume.descriptors.set, VOXTACT_BINDING_BRICKS, *bricks);
    return {};
}

Result<void> fillVolume(VolumeImpl& volume, const VolumeView& data, const VolumeOptions& options, const char* name) {
    ContextImpl& context = volume.context;
    const TexelFormat texel = texelFormat(data.type);
    volume.format = texel.format;
    volume.valueSlope = texel.slope;
    volume.valueIntercept = texel.intercept;
    volume.storedUnit = storedUnitOf(texel.format);
    ImageDesc desc;
    desc.format = texel.format;
    desc.extent = extentOf(data.grid);
    desc.usage = usageOf(options);
    Result<Image> image = makeImage(context, desc, "the volume", name);
    VOXTACT_TRY(image);
    volume.image = std::move(*image);
    volume.view = volume.image.view.get();
    Result<Buffer> staging =
        makeBuffer(context, data.voxels.size(), VK_BUFFER_USAGE_TRANSFER_SRC_BIT, MemoryUse::Upload, "volume staging");
    VOXTACT_TRY(staging);
    volume.staging = std::move(*staging);
    fillTexels(data.type, data.voxels, static_cast<std::byte*>(volume.staging.mapped));
    VOXTACT_TRY(flush(context, volume.staging));
    if (options.editable) {
        VOXTACT_TRY(makeEditPass(volume));
    }
    if (options.bricks) {
        VOXTACT_TRY(makeBricks(volume, name));
    }
    return describe(volume, VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL, name);
}

Result<void> checkWrapped(const ContextImpl& context, const WrappedVolume& wrapped) {
    if (wrapped.view == VK_NULL_HANDLE) {
        return refuse("WrappedVolume::view is null");
    }
    if (unitOf(wrapped.format) == 0) {
        return refuse("WrappedVolume::format (VkFormat " + std::to_string(wrapped.format) +
                      ") is none of R8_UNORM, R16_UNORM, R16_SNORM, R16_SFLOAT and R32_SFLOAT");
    }
    if (!std::isfinite(wrapped.slope) || wrapped.slope == 0 || !std::isfinite(wrapped.intercept)) {
        return refuse("WrappedVolume::slope and intercept must be finite, the slope not zero");
    }
    if (wrapped.boundaryValues && !(wrapped.boundaryValues->lo <= wrapped.boundaryValues->hi)) {
        return refuse("WrappedVolume::boundaryValues " + number(wrapped.boundaryValues->lo) + ":" +
                      number(wrapped.boundaryValues->hi) + " are no range: the lower end is not the lower one");
    }
    VOXTACT_TRY(checkSampledLayout(wrapped.layout, "WrappedVolume::layout"));
    VOXTACT_TRY(checkGrid(wrapped.grid));
    return checkSides(context, wrapped.grid, "WrappedVolume::grid");
}

} // namespace

Volume::Volume(std::unique_ptr<VolumeImpl> impl) noexcept : impl_(std::move(impl)) {}
Volume::Volume(Volume&&) noexcept = default;
Volume& Volume::operator=(Volume&&) noexcept = default;
Volume::~Volume() = default;

Result<Volume> Volume::create(const Context& context, const VolumeView& data, const VolumeOptions& options) {
    return guard([&]() -> Result<Volume> {
        ContextImpl& c = context.impl();
        VOXTACT_TRY(c.alive());
        VOXTACT_TRY(checkScalarType(data.type));
        const Result<Mat4> texture_from_world = textureFromWorld(data.grid);
        VOXTACT_TRY(texture_from_world);
        const VkFormat format = texelFormat(data.type).format;
        const Result<bool> filtered = isFiltered(c, format, std::string("a volume of ") + toString(data.type));
        VOXTACT_TRY(filtered);
        if (Result<void> limits =
                checkImageLimits(c, data.grid, format, usageOf(options), bytesPerVoxel(data.type), "the volume");
            !limits.ok()) {
            return limits.error();
        }
        const Result<ValueRange> range = checkVolume(data);
        VOXTACT_TRY(range);
        auto impl = std::make_unique<VolumeImpl>(VolumeImpl{.context = c, .grid = data.grid});
        impl->texture_from_world = *texture_from_world;
        impl->pairGrid = pairGrid(data.grid, *texture_from_world);
        impl->filtered = *filtered;
        impl->type = data.type;
        impl->valueRange = *range;
        impl->boundary = boundaryRanges(data);
        const char* name = options.name == nullptr ? "volume" : options.name;
        VOXTACT_TRY(fillVolume(*impl, data, options, name));
        return Volume(std::move(impl));
    });
}

Result<Volume> Volume::wrap(const Context& context, const WrappedVolume& wrapped) {
    return guard([&]() -> Result<Volume> {
        ContextImpl& c = context.impl();
        VOXTACT_TRY(c.alive());
        VOXTACT_TRY(checkWrapped(c, wrapped));
        const Result<bool> filtered = isFiltered(c, wrapped.format, "the wrapped volume");
        VOXTACT_TRY(filtered);
        auto impl = std::make_unique<VolumeImpl>(VolumeImpl{.context = c, .grid = wrapped.grid});
        impl->texture_from_world = textureFromWorld(wrapped.grid).value();
        impl->pairGrid = pairGrid(wrapped.grid, impl->texture_from_world);
        impl->filtered = *filtered;
        impl->format = wrapped.format;
        impl->valueSlope = wrapped.slope * unitOf(wrapped.format);
        impl->valueIntercept = wrapped.intercept;
        impl->storedUnit = storedUnitOf(wrapped.format);
        if (wrapped.boundaryValues) {
            impl->boundary = {*wrapped.boundaryValues};
        }
        impl->view = wrapped.view;
        impl->uploaded = true;
        if (wrapped.bricks) {
            VOXTACT_TRY(makeBricks(*impl, "wrapped volume"));
        }
        VOXTACT_TRY(describe(*impl, wrapped.layout, "wrapped volume"));
        return Volume(std::move(impl));
    });
}

Result<Volume> Volume::upload(const Context& context, const QueueAccess& queue, const VolumeView& data,
                              const VolumeOptions& options) {
    return guard([&] { return uploaded(context.impl(), queue, create(context, data, options)); });
}

Result<void> Volume::cmdUpload(VkCommandBuffer commandBuffer) {
    return guard([&]() -> Result<void> {
        if (!live(impl_).staging.buffer) {
            return notUploadable("volume");
        }
        VOXTACT_TRY(live(impl_).context.recordable(commandBuffer));
        const Label label(live(impl_).context, commandBuffer, "voxtact volume upload");
        cmdFillImage(live(impl_).context, commandBuffer, live(impl_).staging.get(), live(impl_).image.image.get(),
                     extentOf(live(impl_).grid));
        if (live(impl_).bricks.buffer) {
            cmdBricks(live(impl_), commandBuffer, wholeBox(live(impl_).grid));
        }
        live(impl_).uploaded = true;
        return {};
    });
}

Result<void> Volume::cmdUpdateBricks(VkCommandBuffer commandBuffer, const VoxelBox& changed) {
    return guard([&]() -> Result<void> {
        if (!live(impl_).bricks.buffer) {
            return refuse("the volume has no bricks");
        }
        if (!live(impl_).uploaded) {
            return neverUploaded("the volume");
        }
        VOXTACT_TRY(live(impl_).context.recordable(commandBuffer));
        const Result<VoxelBox> box = voxelBounds(changed, live(impl_).grid);
        VOXTACT_TRY(box);
        if (!isEmpty(*box)) {
            cmdBricks(live(impl_), commandBuffer, *box);
        }
        return {};
    });
}

void Volume::releaseStaging() noexcept {
    live(impl_).staging = {};
}

const Grid& Volume::grid() const noexcept {
    return live(impl_).grid;
}

std::optional<ValueRange> Volume::valueRange() const noexcept {
    return live(impl_).valueRange;
}

VkImageView Volume::view() const noexcept {
    return live(impl_).view;
}

VkFormat Volume::format() const noexcept {
    return live(impl_).format;
}

} // namespace voxtact
