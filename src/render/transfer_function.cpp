// SPDX-License-Identifier: MIT
#include "core/base/guard.h"
#include "core/base/live.h"
#include "core/base/refuse.h"
#include "core/base/text.h"
#include "core/base/try.h"
#include "render/render_impl.h"
#include "vulkan/barriers.h"
#include "vulkan/debug.h"
#include "vulkan/submit.h"

#include <algorithm>
#include <cmath>
#include <iterator>

namespace voxtact {

namespace {

constexpr std::uint32_t kMaxEntries = 1024;

/// Like tableDomain(): around the points of opacity and colours.
ValueRange domainOf(const RenderTransferFunctionDesc& desc) {
    std::vector<double> values;
    std::ranges::transform(desc.opacity.points, std::back_inserter(values), &ControlPoint::value);
    std::ranges::transform(desc.colours, std::back_inserter(values), &ColourPoint::value);
    if (values.empty()) {
        return desc.opacity.domain;
    }
    const auto [lo, hi] = std::ranges::minmax(values);
    const ControlPoint ends[] = {{lo, 0}, {hi, 0}};
    return tableDomain({ends, desc.opacity.domain, desc.opacity.tableSize});
}

/// Samples one channel of the colours like the opacity.
Result<std::vector<float>> sampleChannel(const RenderTransferFunctionDesc& desc, const ValueRange& domain,
                                         std::size_t channel) {
    if (desc.colours.empty()) {
        return std::vector<float>(desc.opacity.tableSize, 1.0F);
    }
    std::vector<ControlPoint> points;
    for (const ColourPoint& point : desc.colours) {
        if (!(point.colour[channel] >= 0 && point.colour[channel] <= 1)) {
            return refuse("the colour " + number(point.colour[channel]) + " at value " + number(point.value) +
                          " of the transfer function is outside [0, 1]");
        }
        points.push_back({point.value, point.colour[channel]});
    }
    Result<std::vector<float>> table = sampleTable({points, domain, desc.opacity.tableSize});
    return table.ok() ? table : refuse("the transfer function's colours: " + table.error().text);
}

Result<void> setFunction(RenderTransferFunctionImpl& function, const RenderTransferFunctionDesc& desc) {
    VOXTACT_TRY(checkPositive(desc.step, "the step"));
    VOXTACT_TRY(checkPositive(desc.opacityUnit, "the opacity unit"));
    if (desc.opacity.tableSize > kMaxEntries) {
        return refuse("the transfer function's table has " + std::to_string(desc.opacity.tableSize) +
                      " entries, for pictures it may have " + std::to_string(kMaxEntries));
    }
    std::array<std::vector<float>, 4> channels;
    TransferFunctionDesc given = desc.opacity;
    given.domain = domainOf(desc);
    Result<std::vector<float>> opacity = sampleTable(given);
    VOXTACT_TRY(opacity);
    channels[3] = std::move(*opacity);
    for (std::size_t channel = 0; channel < 3; ++channel) {
        Result<std::vector<float>> table = sampleChannel(desc, given.domain, channel);
        VOXTACT_TRY(table);
        channels[channel] = std::move(*table);
    }
    function.integrals = extinctionIntegrals(channels, desc.opacityUnit);
    function.table = std::move(channels[3]);
    function.domain = given.domain;
    function.step = desc.step;
    return {};
}

/// Returns a sparse table: [k * N + i] is the maximum of entries i to i + 2^k - 1 of a table of N, so two look-ups give
/// the maximum of any run (Bender and Farach-Colton, "The LCA problem revisited", 2000). Runs are cut at the table's
/// end.
std::vector<float> runMaxima(const std::vector<float>& table) {
    std::vector<float> out = table;
    for (std::size_t run = 1; 2 * run <= table.size(); run *= 2) {
        const std::size_t below = out.size() - table.size();
        for (std::size_t i = 0; i < table.size(); ++i) {
            out.push_back(std::max(out[below + i], out[below + std::min(i + run, table.size() - 1)]));
        }
    }
    return out;
}

Result<void> makeBuffers(RenderTransferFunctionImpl& function) {
    ContextImpl& context = function.renderer.context;
    constexpr VkBufferUsageFlags kUsage = VK_BUFFER_USAGE_STORAGE_BUFFER_BIT | VK_BUFFER_USAGE_TRANSFER_DST_BIT;
    Result<Buffer> integrals = makeBuffer(context, function.integrals.size() * sizeof(float), kUsage, MemoryUse::Device,
                                          "transfer function integrals");
    VOXTACT_TRY(integrals);
    function.integralBuffer = std::move(*integrals);
    Result<Buffer> extremes = makeBuffer(context, runMaxima(function.table).size() * sizeof(float), kUsage,
                                         MemoryUse::Device, "transfer function opacities");
    VOXTACT_TRY(extremes);
    function.extremes = std::move(*extremes);
    return {};
}

Result<void> makeTable(RenderTransferFunctionImpl& function) {
    ContextImpl& context = function.renderer.context;
    const auto entries = static_cast<std::uint32_t>(function.table.size());
    ImageDesc desc;
    desc.type = VK_IMAGE_TYPE_2D;
    desc.viewType = VK_IMAGE_VIEW_TYPE_2D;
    desc.format = kRenderTableFormat;
    desc.extent = {entries, entries, 1};
    desc.usage = VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_STORAGE_BIT;
    Result<Image> image = makeImage(context, desc, "the pre-integrated table", "pre-integrated table");
    VOXTACT_TRY(image);
    function.image = std::move(*image);
    return {};
}

Result<void> describe(RenderTransferFunctionImpl& function) {
    ContextImpl& context = function.renderer.context;
    constexpr VkDescriptorPoolSize kMaking[] = {{VK_DESCRIPTOR_TYPE_STORAGE_IMAGE, 1},
                                                {VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, 1}};
    Result<DescriptorSet> making =
        makeDescriptorSet(context, function.renderer.makingLayout.get(), kMaking, "pre-integration");
    VOXTACT_TRY(making);
    function.making = std::move(*making);
    writeImage(context, function.making.set, 0, VK_DESCRIPTOR_TYPE_STORAGE_IMAGE, function.image.view.get(),
               VK_IMAGE_LAYOUT_GENERAL);
    writeBuffer(context, function.making.set, 1, function.integralBuffer.get());
    constexpr VkDescriptorPoolSize kReading[] = {{VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER, 1},
                                                 {VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, 1}};
    Result<DescriptorSet> reading =
        makeDescriptorSet(context, function.renderer.functionLayout.get(), kReading, "render transfer function");
    VOXTACT_TRY(reading);
    function.reading = std::move(*reading);
    writeImage(context, function.reading.set, PICTURE_BINDING_TABLE, VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER,
               function.image.view.get());
    writeBuffer(context, function.reading.set, PICTURE_BINDING_OPACITY, function.extremes.get());
    return {};
}

void cmdMake(const RenderTransferFunctionImpl& function, VkCommandBuffer commandBuffer) {
    const RendererImpl& renderer = function.renderer;
    const ContextImpl& context = renderer.context;
    const DeviceFunctions& vk = context.vk;
    barrier(context, commandBuffer, VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT, 0, VK_PIPELINE_STAGE_2_ALL_TRANSFER_BIT,
            VK_ACCESS_2_TRANSFER_WRITE_BIT);
    cmdUpdateBuffer(context, commandBuffer, function.integralBuffer.get(), 0,
                    std::as_bytes(std::span(function.integrals)));
    cmdUpdateBuffer(context, commandBuffer, function.extremes.get(), 0,
                    std::as_bytes(std::span<const float>(runMaxima(function.table))));
    barrier(context, commandBuffer, VK_PIPELINE_STAGE_2_ALL_TRANSFER_BIT, VK_ACCESS_2_TRANSFER_WRITE_BIT,
            VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT, VK_ACCESS_2_SHADER_STORAGE_READ_BIT);
    constexpr ImageUse kWritten{VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT, VK_ACCESS_2_SHADER_STORAGE_WRITE_BIT,
                                VK_IMAGE_LAYOUT_GENERAL};
    const VkImage image = function.image.image.get();
    barrier(context, commandBuffer, image, {VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT, 0, VK_IMAGE_LAYOUT_UNDEFINED},
            kWritten);
    const VkPipelineLayout layout = renderer.makingPipelineLayout.get();
    vk.CmdBindPipeline(commandBuffer, VK_PIPELINE_BIND_POINT_COMPUTE, renderer.makingPipeline.get());
    vk.CmdBindDescriptorSets(commandBuffer, VK_PIPELINE_BIND_POINT_COMPUTE, layout, 0, 1, &function.making.set, 0,
                             nullptr);
    const auto entries = static_cast<std::uint32_t>(function.table.size());
    const shader::PreintegrateConstants constants{static_cast<int>(entries), static_cast<float>(function.step)};
    vk.CmdPushConstants(commandBuffer, layout, VK_SHADER_STAGE_COMPUTE_BIT, 0, sizeof constants, &constants);
    const std::uint32_t groups = (entries + PREINTEGRATE_SIDE - 1) / PREINTEGRATE_SIDE;
    vk.CmdDispatch(commandBuffer, groups, groups, 1);
    barrier(context, commandBuffer, image, kWritten, kReadByShaders);
}

} // namespace

RenderTransferFunction::RenderTransferFunction(std::unique_ptr<RenderTransferFunctionImpl> impl) noexcept
    : impl_(std::move(impl)) {}
RenderTransferFunction::RenderTransferFunction(RenderTransferFunction&&) noexcept = default;
RenderTransferFunction& RenderTransferFunction::operator=(RenderTransferFunction&&) noexcept = default;
RenderTransferFunction::~RenderTransferFunction() = default;

Result<RenderTransferFunction> RenderTransferFunction::create(const Renderer& renderer,
                                                              const RenderTransferFunctionDesc& desc) {
    return guard([&]() -> Result<RenderTransferFunction> {
        VOXTACT_TRY(renderer.impl().context.alive());
        auto impl =
            std::make_unique<RenderTransferFunctionImpl>(RenderTransferFunctionImpl{.renderer = renderer.impl()});
        VOXTACT_TRY(setFunction(*impl, desc));
        for (const auto make : {makeBuffers, makeTable, describe}) {
            VOXTACT_TRY(make(*impl));
        }
        return RenderTransferFunction(std::move(impl));
    });
}

Result<RenderTransferFunction> RenderTransferFunction::upload(const Renderer& renderer, const QueueAccess& queue,
                                                              const RenderTransferFunctionDesc& desc) {
    return guard([&] { return uploaded(renderer.impl().context, queue, create(renderer, desc)); });
}

Result<void> RenderTransferFunction::cmdUpload(VkCommandBuffer commandBuffer) {
    return guard([&]() -> Result<void> {
        VOXTACT_TRY(live(impl_).renderer.context.recordable(commandBuffer));
        const Label label(live(impl_).renderer.context, commandBuffer, "voxtact pre-integration");
        cmdMake(live(impl_), commandBuffer);
        live(impl_).uploaded = true;
        return {};
    });
}

Result<void> RenderTransferFunction::cmdUpdate(VkCommandBuffer commandBuffer, const RenderTransferFunctionDesc& desc) {
    return guard([&]() -> Result<void> {
        if (desc.opacity.tableSize != live(impl_).table.size()) {
            return refuse("the new table has " + std::to_string(desc.opacity.tableSize) +
                          " entries, that of the transfer function " + std::to_string(live(impl_).table.size()));
        }
        VOXTACT_TRY(live(impl_).renderer.context.recordable(commandBuffer));
        VOXTACT_TRY(setFunction(live(impl_), desc));
        return cmdUpload(commandBuffer);
    });
}

bool RenderTransferFunction::visible() const noexcept {
    return std::ranges::any_of(live(impl_).table, [](float opacity) { return opacity > 0; });
}

} // namespace voxtact
