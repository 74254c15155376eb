// SPDX-License-Identifier: MIT
#include "core/guard.h"
#include "core/text.h"
#include "gpu/barriers.h"
#include "gpu/debug.h"
#include "gpu/scene_impl.h"
#include "gpu/submit.h"
#include "shared.h"

#include <cmath>
#include <cstring>

namespace voxtact {

namespace {

constexpr VkFormat kTableFormat = VK_FORMAT_R32_SFLOAT;

Result<void> checkDevice(const ContextImpl& context, std::uint32_t tableSize) {
    if (tableSize > context.limits.maxImageDimension1D) {
        return Error{ErrorCode::LimitExceeded, 0,
                     "the transfer function's table has " + std::to_string(tableSize) +
                         " entries, the device's maxImageDimension1D is " +
                         std::to_string(context.limits.maxImageDimension1D)};
    }
    VkFormatProperties properties{};
    context.vk.GetPhysicalDeviceFormatProperties(context.physicalDevice, kTableFormat, &properties);
    if ((properties.optimalTilingFeatures & VK_FORMAT_FEATURE_SAMPLED_IMAGE_FILTER_LINEAR_BIT) == 0) {
        return Error{ErrorCode::Unsupported, 0,
                     "the device cannot filter R32_SFLOAT linearly, the format of the transfer function's table"};
    }
    return {};
}

Result<void> describe(TransferFunctionImpl& function, VkImageView view, VkImageLayout layout, const char* name) {
    const VkDescriptorPoolSize size{VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER, 1};
    Result<DescriptorSet> set = makeDescriptorSet(
        function.context, function.context.setLayouts[VOXTACT_SET_TRANSFER_FUNCTION], {&size, 1}, name);
    if (!set.ok()) {
        return set.error();
    }
    function.descriptors = std::move(*set);
    writeImage(function.context, function.descriptors.set, view, layout);
    return {};
}

Result<void> fillTable(TransferFunctionImpl& function, const char* name) {
    ContextImpl& context = function.context;
    ImageDesc desc;
    desc.type = VK_IMAGE_TYPE_1D;
    desc.viewType = VK_IMAGE_VIEW_TYPE_1D;
    desc.format = kTableFormat;
    desc.extent = {static_cast<std::uint32_t>(function.table.size()), 1, 1};
    Result<Image> image = makeImage(context, desc, "the transfer function", name);
    if (!image.ok()) {
        return image.error();
    }
    function.image = std::move(*image);
    const VkDeviceSize bytes = function.table.size() * sizeof(float);
    Result<Buffer> staging =
        makeBuffer(context, bytes, VK_BUFFER_USAGE_TRANSFER_SRC_BIT, MemoryUse::Upload, "transfer function staging");
    if (!staging.ok()) {
        return staging.error();
    }
    function.staging = std::move(*staging);
    std::memcpy(function.staging.mapped, function.table.data(), bytes);
    if (Result<void> flushed = flush(context, function.staging); !flushed.ok()) {
        return flushed;
    }
    return describe(function, function.image.view.get(), VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL, name);
}

} // namespace

TransferFunction::TransferFunction(std::unique_ptr<TransferFunctionImpl> impl) noexcept : impl_(std::move(impl)) {}
TransferFunction::TransferFunction(TransferFunction&&) noexcept = default;
TransferFunction& TransferFunction::operator=(TransferFunction&&) noexcept = default;
TransferFunction::~TransferFunction() = default;

Result<TransferFunction> TransferFunction::create(const Context& context, const TransferFunctionDesc& desc,
                                                  const char* name) {
    return guard([&]() -> Result<TransferFunction> {
        ContextImpl& c = context.impl();
        if (Result<void> alive = c.alive(); !alive.ok()) {
            return alive.error();
        }
        if (Result<void> device = checkDevice(c, desc.tableSize); !device.ok()) {
            return device.error();
        }
        Result<std::vector<float>> table = sampleTable(desc);
        if (!table.ok()) {
            return table.error();
        }
        auto impl = std::make_unique<TransferFunctionImpl>(
            TransferFunctionImpl{.context = c, .domain = desc.domain, .table = std::move(*table)});
        if (Result<void> filled = fillTable(*impl, name == nullptr ? "transfer function" : name); !filled.ok()) {
            return filled.error();
        }
        return TransferFunction(std::move(impl));
    });
}

Result<TransferFunction> TransferFunction::wrap(const Context& context, const WrappedTransferFunction& wrapped) {
    return guard([&]() -> Result<TransferFunction> {
        if (wrapped.view == VK_NULL_HANDLE) {
            return Error{ErrorCode::InvalidArgument, 0, "WrappedTransferFunction::view is null"};
        }
        const ValueRange& domain = wrapped.domain;
        if (!std::isfinite(domain.lo) || !std::isfinite(domain.hi) || !(domain.lo < domain.hi)) {
            return Error{ErrorCode::InvalidArgument, 0,
                         "WrappedTransferFunction::domain " + number(domain.lo) + ":" + number(domain.hi) +
                             " is empty, the lower end must be below the upper one"};
        }
        auto impl = std::make_unique<TransferFunctionImpl>(
            TransferFunctionImpl{.context = context.impl(),
                                 .domain = domain,
                                 .table = std::vector<float>(wrapped.table.begin(), wrapped.table.end())});
        if (Result<void> described = describe(*impl, wrapped.view, wrapped.layout, "wrapped transfer function");
            !described.ok()) {
            return described.error();
        }
        return TransferFunction(std::move(impl));
    });
}

Result<TransferFunction> TransferFunction::upload(const Context& context, const QueueAccess& queue,
                                                  const TransferFunctionDesc& desc, const char* name) {
    return guard([&] { return uploaded(context.impl(), queue, create(context, desc, name)); });
}

Result<void> TransferFunction::cmdUpload(VkCommandBuffer commandBuffer) {
    return guard([&]() -> Result<void> {
        if (!impl_->staging.buffer) {
            return notUploadable("transfer function");
        }
        const Label label(impl_->context, commandBuffer, "voxtact transfer function upload");
        cmdFillImage(impl_->context, commandBuffer, impl_->staging.get(), impl_->image.image.get(),
                     {static_cast<std::uint32_t>(impl_->table.size()), 1, 1});
        return {};
    });
}

void TransferFunction::releaseStaging() noexcept {
    impl_->staging = {};
}

ValueRange TransferFunction::domain() const noexcept {
    return impl_->domain;
}

std::uint32_t TransferFunction::tableSize() const noexcept {
    return static_cast<std::uint32_t>(impl_->table.size());
}

} // namespace voxtact
