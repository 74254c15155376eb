// SPDX-License-Identifier: MIT
#include "core/boundary.h"
#include "core/guard.h"
#include "gpu/barriers.h"
#include "gpu/debug.h"
#include "gpu/image_limits.h"
#include "gpu/scene_impl.h"
#include "gpu/submit.h"
#include "shared.h"

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

/// int16 is kept with its sign bit flipped, as uint16: SNORM would make -32768 and -32767 the same.
constexpr double kInt16Bias = 32768;
constexpr std::uint16_t kInt16SignBit = 0x8000;

TexelFormat texelFormat(ScalarType type) {
    switch (type) {
    case ScalarType::UInt8:
        return {VK_FORMAT_R8_UNORM, 255, 0};
    case ScalarType::Int16:
        return {VK_FORMAT_R16_UNORM, 65535, -kInt16Bias};
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

Result<void> checkFormat(const ContextImpl& context, VkFormat format, const char* type) {
    constexpr VkFormatFeatureFlags kNeeded = VK_FORMAT_FEATURE_SAMPLED_IMAGE_FILTER_LINEAR_BIT;
    VkFormatProperties properties{};
    context.vk.GetPhysicalDeviceFormatProperties(context.physicalDevice, format, &properties);
    if ((properties.optimalTilingFeatures & kNeeded) != kNeeded) {
        return Error{ErrorCode::Unsupported, 0,
                     std::string("the device cannot filter the format of ") + type + " voxels (VkFormat " +
                         std::to_string(format) + ") linearly"};
    }
    return {};
}

void fillStaging(const VolumeView& data, void* to) {
    if (data.type != ScalarType::Int16) {
        std::memcpy(to, data.voxels.data(), data.voxels.size());
        return;
    }
    const auto* from = reinterpret_cast<const std::uint16_t*>(data.voxels.data());
    auto* out = static_cast<std::uint16_t*>(to);
    const std::size_t count = data.voxels.size() / sizeof(std::uint16_t);
    for (std::size_t i = 0; i < count; ++i) {
        out[i] = static_cast<std::uint16_t>(from[i] ^ kInt16SignBit);
    }
}

VkExtent3D extentOf(const Grid& grid) {
    return {grid.size[0], grid.size[1], grid.size[2]};
}

Result<void> describe(VolumeImpl& volume, VkImageLayout layout, const char* name) {
    const VkDescriptorPoolSize size{VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER, 1};
    Result<DescriptorSet> set =
        makeDescriptorSet(volume.context, volume.context.setLayouts[VOXTACT_SET_VOLUME], {&size, 1}, name);
    if (!set.ok()) {
        return set.error();
    }
    volume.descriptors = std::move(*set);
    writeImage(volume.context, volume.descriptors.set, volume.view, layout);
    return {};
}

Result<void> fillVolume(VolumeImpl& volume, const VolumeView& data, const char* name) {
    ContextImpl& context = volume.context;
    const TexelFormat texel = texelFormat(data.type);
    volume.format = texel.format;
    volume.valueSlope = texel.slope;
    volume.valueIntercept = texel.intercept;
    volume.storedUnit = storedUnitOf(texel.format);
    ImageDesc desc;
    desc.format = texel.format;
    desc.extent = extentOf(data.grid);
    Result<Image> image = makeImage(context, desc, "the volume", name);
    if (!image.ok()) {
        return image.error();
    }
    volume.image = std::move(*image);
    volume.view = volume.image.view.get();
    Result<Buffer> staging =
        makeBuffer(context, data.voxels.size(), VK_BUFFER_USAGE_TRANSFER_SRC_BIT, MemoryUse::Upload, "volume staging");
    if (!staging.ok()) {
        return staging.error();
    }
    volume.staging = std::move(*staging);
    fillStaging(data, volume.staging.mapped);
    if (Result<void> flushed = flush(context, volume.staging); !flushed.ok()) {
        return flushed;
    }
    return describe(volume, VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL, name);
}

Result<void> checkWrapped(const WrappedVolume& wrapped) {
    if (wrapped.view == VK_NULL_HANDLE) {
        return Error{ErrorCode::InvalidArgument, 0, "WrappedVolume::view is null"};
    }
    if (unitOf(wrapped.format) == 0) {
        return Error{ErrorCode::InvalidArgument, 0,
                     "WrappedVolume::format (VkFormat " + std::to_string(wrapped.format) +
                         ") is none of R8_UNORM, R16_UNORM, R16_SNORM, R16_SFLOAT and R32_SFLOAT"};
    }
    if (!std::isfinite(wrapped.slope) || wrapped.slope == 0 || !std::isfinite(wrapped.intercept)) {
        return Error{ErrorCode::InvalidArgument, 0,
                     "WrappedVolume::slope and intercept must be finite, the slope not zero"};
    }
    return checkGrid(wrapped.grid);
}

} // namespace

Volume::Volume(std::unique_ptr<VolumeImpl> impl) noexcept : impl_(std::move(impl)) {}
Volume::Volume(Volume&&) noexcept = default;
Volume& Volume::operator=(Volume&&) noexcept = default;
Volume::~Volume() = default;

Result<Volume> Volume::create(const Context& context, const VolumeView& data, const char* name) {
    return guard([&]() -> Result<Volume> {
        ContextImpl& c = context.impl();
        if (Result<void> alive = c.alive(); !alive.ok()) {
            return alive.error();
        }
        const Result<Mat4> texture_from_world = textureFromWorld(data.grid);
        if (!texture_from_world.ok()) {
            return texture_from_world.error();
        }
        const VkFormat format = texelFormat(data.type).format;
        if (Result<void> checked = checkFormat(c, format, toString(data.type)); !checked.ok()) {
            return checked.error();
        }
        if (Result<void> limits = checkImageLimits(c, data.grid, format, bytesPerVoxel(data.type), "the volume");
            !limits.ok()) {
            return limits.error();
        }
        const Result<ValueRange> range = checkVolume(data);
        if (!range.ok()) {
            return range.error();
        }
        auto impl = std::make_unique<VolumeImpl>(VolumeImpl{.context = c, .grid = data.grid});
        impl->texture_from_world = *texture_from_world;
        impl->valueRange = *range;
        impl->boundary = boundaryRanges(data);
        if (Result<void> filled = fillVolume(*impl, data, name == nullptr ? "volume" : name); !filled.ok()) {
            return filled.error();
        }
        return Volume(std::move(impl));
    });
}

Result<Volume> Volume::wrap(const Context& context, const WrappedVolume& wrapped) {
    return guard([&]() -> Result<Volume> {
        ContextImpl& c = context.impl();
        if (Result<void> checked = checkWrapped(wrapped); !checked.ok()) {
            return checked.error();
        }
        if (Result<void> format = checkFormat(c, wrapped.format, "the caller's"); !format.ok()) {
            return format.error();
        }
        auto impl = std::make_unique<VolumeImpl>(VolumeImpl{.context = c, .grid = wrapped.grid});
        impl->texture_from_world = textureFromWorld(wrapped.grid).value();
        impl->format = wrapped.format;
        impl->valueSlope = wrapped.slope * unitOf(wrapped.format);
        impl->valueIntercept = wrapped.intercept;
        impl->storedUnit = storedUnitOf(wrapped.format);
        if (wrapped.boundaryValues) {
            impl->boundary = {*wrapped.boundaryValues};
        }
        impl->view = wrapped.view;
        if (Result<void> described = describe(*impl, wrapped.layout, "wrapped volume"); !described.ok()) {
            return described.error();
        }
        return Volume(std::move(impl));
    });
}

Result<Volume> Volume::upload(const Context& context, const QueueAccess& queue, const VolumeView& data,
                              const char* name) {
    return guard([&] { return uploaded(context.impl(), queue, create(context, data, name)); });
}

Result<void> Volume::cmdUpload(VkCommandBuffer commandBuffer) {
    return guard([&]() -> Result<void> {
        if (!impl_->staging.buffer) {
            return notUploadable("volume");
        }
        const Label label(impl_->context, commandBuffer, "voxtact volume upload");
        cmdFillImage(impl_->context, commandBuffer, impl_->staging.get(), impl_->image.image.get(),
                     extentOf(impl_->grid));
        return {};
    });
}

void Volume::releaseStaging() noexcept {
    impl_->staging = {};
}

const Grid& Volume::grid() const noexcept {
    return impl_->grid;
}

std::optional<ValueRange> Volume::valueRange() const noexcept {
    return impl_->valueRange;
}

VkImageView Volume::view() const noexcept {
    return impl_->view;
}

VkFormat Volume::format() const noexcept {
    return impl_->format;
}

} // namespace voxtact
