// SPDX-License-Identifier: MIT
#include "core/base/guard.h"
#include "core/base/live.h"
#include "core/base/refuse.h"
#include "core/base/try.h"
#include "core/geometry/domain.h"
#include "core/transfer/table_points.h"
#include "device/scene/scene_impl.h"
#include "exact/shared.h"
#include "vulkan/barriers.h"
#include "vulkan/debug.h"
#include "vulkan/image_limits.h"
#include "vulkan/submit.h"

#include <algorithm>
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
    return {};
}

Result<void> describe(TransferFunctionImpl& function, VkImageView view, VkImageLayout layout, const char* name) {
    ContextImpl& context = function.context;
    constexpr VkDescriptorPoolSize kSizes[] = {{VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER, 1}};
    Result<DescriptorSet> set =
        makeDescriptorSet(context, context.setLayouts[VOXTACT_SET_TRANSFER_FUNCTION], kSizes, name);
    VOXTACT_TRY(set);
    function.descriptors = std::move(*set);
    writeImage(context, function.descriptors.set, 0, VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER, view, layout,
               context.samplerOf(function.filtered));
    return {};
}

/// Makes the image, and a buffer on the device that it is filled from; the staging buffer has the table.
Result<void> fillTable(TransferFunctionImpl& function, const char* name) {
    ContextImpl& context = function.context;
    ImageDesc desc;
    desc.type = VK_IMAGE_TYPE_1D;
    desc.viewType = VK_IMAGE_VIEW_TYPE_1D;
    desc.format = kTableFormat;
    desc.extent = {static_cast<std::uint32_t>(function.table.size()), 1, 1};
    Result<Image> image = makeImage(context, desc, "the transfer function", name);
    VOXTACT_TRY(image);
    function.image = std::move(*image);
    const VkDeviceSize bytes = std::span(function.table).size_bytes();
    Result<Buffer> texels =
        makeBuffer(context, bytes, VK_BUFFER_USAGE_TRANSFER_DST_BIT | VK_BUFFER_USAGE_TRANSFER_SRC_BIT,
                   MemoryUse::Device, "transfer function texels");
    VOXTACT_TRY(texels);
    function.texels = std::move(*texels);
    Result<Buffer> staging =
        makeBuffer(context, bytes, VK_BUFFER_USAGE_TRANSFER_SRC_BIT, MemoryUse::Upload, "transfer function staging");
    VOXTACT_TRY(staging);
    function.staging = std::move(*staging);
    std::memcpy(function.staging.mapped, function.table.data(), bytes);
    VOXTACT_TRY(flush(context, function.staging));
    return describe(function, function.image.view.get(), VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL, name);
}

/// Until cmdFilled(), the texels may be written by transfers.
void cmdBeginFilling(const TransferFunctionImpl& function, VkCommandBuffer commandBuffer) {
    barrier(function.context, commandBuffer, VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT, VK_ACCESS_2_MEMORY_WRITE_BIT,
            VK_PIPELINE_STAGE_2_ALL_TRANSFER_BIT, VK_ACCESS_2_TRANSFER_WRITE_BIT);
}

/// Takes the table from the texels, and leaves it readable.
void cmdFilled(TransferFunctionImpl& function, VkCommandBuffer commandBuffer) {
    function.uploaded = true;
    barrier(function.context, commandBuffer, VK_PIPELINE_STAGE_2_ALL_TRANSFER_BIT, VK_ACCESS_2_TRANSFER_WRITE_BIT,
            VK_PIPELINE_STAGE_2_ALL_TRANSFER_BIT, VK_ACCESS_2_TRANSFER_READ_BIT);
    cmdFillImage(function.context, commandBuffer, function.texels.get(), function.image.image.get(),
                 {static_cast<std::uint32_t>(function.table.size()), 1, 1});
}

TransferFunctionKnown knownOf(const TransferFunctionDesc& desc) {
    return {{desc.points.begin(), desc.points.end()}, tableDomain(desc)};
}

Result<void> checkUpdate(const TransferFunctionImpl& function, const TransferFunctionDesc& desc) {
    if (!function.image.image) {
        return refuse("the transfer function is wrapped: its table is the caller's");
    }
    if (desc.tableSize != function.table.size()) {
        return refuse("the new table has " + std::to_string(desc.tableSize) +
                      " entries, that of the transfer function " + std::to_string(function.table.size()));
    }
    return {};
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
        VOXTACT_TRY(c.alive());
        VOXTACT_TRY(checkDevice(c, desc.tableSize));
        const Result<bool> filtered = isFiltered(c, kTableFormat, "a transfer function");
        VOXTACT_TRY(filtered);
        Result<std::vector<float>> table = sampleTable(desc);
        VOXTACT_TRY(table);
        auto impl = std::make_unique<TransferFunctionImpl>(
            TransferFunctionImpl{.context = c, .known = knownOf(desc), .table = std::move(*table)});
        impl->filtered = *filtered;
        impl->staged = impl->known;
        VOXTACT_TRY(fillTable(*impl, name == nullptr ? "transfer function" : name));
        return TransferFunction(std::move(impl));
    });
}

Result<TransferFunction> TransferFunction::wrap(const Context& context, const WrappedTransferFunction& wrapped) {
    return guard([&]() -> Result<TransferFunction> {
        VOXTACT_TRY(context.impl().alive());
        if (wrapped.view == VK_NULL_HANDLE) {
            return refuse("WrappedTransferFunction::view is null");
        }
        VOXTACT_TRY(checkSampledLayout(wrapped.layout, "WrappedTransferFunction::layout"));
        VOXTACT_TRY(checkDomain(wrapped.domain, "WrappedTransferFunction::domain"));
        if (!std::ranges::all_of(wrapped.table, [](float opacity) { return opacity >= 0 && opacity <= 1; })) {
            return refuse("WrappedTransferFunction::table has an opacity that is not from 0 to 1");
        }
        auto impl = std::make_unique<TransferFunctionImpl>(
            TransferFunctionImpl{.context = context.impl(),
                                 .known = {pointsOf(wrapped.table, wrapped.domain), wrapped.domain},
                                 .table = std::vector<float>(wrapped.table.begin(), wrapped.table.end())});
        impl->uploaded = true;
        VOXTACT_TRY(describe(*impl, wrapped.view, wrapped.layout, "wrapped transfer function"));
        return TransferFunction(std::move(impl));
    });
}

Result<TransferFunction> TransferFunction::upload(const Context& context, const QueueAccess& queue,
                                                  const TransferFunctionDesc& desc, const char* name) {
    return guard([&] { return uploaded(context.impl(), queue, create(context, desc, name)); });
}

Result<void> TransferFunction::cmdUpload(VkCommandBuffer commandBuffer) {
    return guard([&]() -> Result<void> {
        if (!live(impl_).staging.buffer) {
            return notUploadable("transfer function");
        }
        VOXTACT_TRY(live(impl_).context.recordable(commandBuffer));
        const Label label(live(impl_).context, commandBuffer, "voxtact transfer function upload");
        cmdBeginFilling(live(impl_), commandBuffer);
        const VkBufferCopy whole{0, 0, live(impl_).texels.size};
        live(impl_).context.vk.CmdCopyBuffer(commandBuffer, live(impl_).staging.get(), live(impl_).texels.get(), 1,
                                             &whole);
        cmdFilled(live(impl_), commandBuffer);
        live(impl_).known = live(impl_).staged; // an update may have changed it
        const auto* const first = static_cast<const float*>(live(impl_).staging.mapped);
        std::copy_n(first, live(impl_).table.size(), live(impl_).table.begin());
        return {};
    });
}

Result<void> TransferFunction::cmdUpdate(VkCommandBuffer commandBuffer, const TransferFunctionDesc& desc) {
    return guard([&]() -> Result<void> {
        VOXTACT_TRY(checkUpdate(live(impl_), desc));
        VOXTACT_TRY(live(impl_).context.recordable(commandBuffer));
        Result<std::vector<float>> table = sampleTable(desc);
        VOXTACT_TRY(table);
        TransferFunctionKnown known = knownOf(desc);
        const Label label(live(impl_).context, commandBuffer, "voxtact transfer function update");
        cmdBeginFilling(live(impl_), commandBuffer);
        cmdUpdateBuffer(live(impl_).context, commandBuffer, live(impl_).texels.get(), 0,
                        std::as_bytes(std::span(*table)));
        cmdFilled(live(impl_), commandBuffer);
        live(impl_).known = std::move(known);
        live(impl_).table = std::move(*table);
        return {};
    });
}

void TransferFunction::releaseStaging() noexcept {
    live(impl_).staging = {};
}

ValueRange TransferFunction::domain() const noexcept {
    return live(impl_).known.domain;
}

std::uint32_t TransferFunction::tableSize() const noexcept {
    return static_cast<std::uint32_t>(live(impl_).table.size());
}

} // namespace voxtact
