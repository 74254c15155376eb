// SPDX-License-Identifier: MIT
#include "lab/engines/trace.h"
#include "core/base/guard.h"
#include "core/base/refuse.h"
#include "core/base/try.h"
#include "detect/batch.h"
#include "detect/recording.h"
#include "detect/view.h"
#include "gpu/barriers.h"
#include "gpu/debug.h"
#include "gpu/layouts.h"
#include "gpu/submit.h"

#include <algorithm>
#include <cstddef>
#include <cstring>
#include <span>
#include <tuple>

namespace voxtact {

struct FragmentTrace::State {
    ContextImpl& context;
    std::shared_ptr<ContextImpl> owner = context.shared_from_this();
    Owned<VkDescriptorSetLayout> setLayout{};
    Owned<VkPipelineLayout> layout{};
    std::optional<ViewPass> pass{};
    std::optional<Results> results{};
    Buffer list{};
    Buffer readBack{};
    DescriptorSet descriptors{};
    Submitter submitter;
};

namespace {

constexpr std::uint32_t kFirstCapacity = 1U << 16U;
/// The list is a counter, then records.
constexpr VkDeviceSize kHeader = sizeof(std::uint32_t);
/// What prepareResults() and publishResults() are to do: nothing about queries.
constexpr DetectorDesc kDesc{.method = CountingMethod::Atomic, .boundary = Boundary::Range};

Result<void> makeLayouts(FragmentTrace::State& trace) {
    ContextImpl& context = trace.context;
    const VkDescriptorSetLayoutBinding binding{0, VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, 1, VK_SHADER_STAGE_FRAGMENT_BIT,
                                               nullptr};
    VOXTACT_TRY(makeSetLayout(context, trace.setLayout, {&binding, 1}, "trace set layout"));
    const VkDescriptorSetLayout sets[] = {context.setLayouts[0], context.setLayouts[1], context.setLayouts[2],
                                          trace.setLayout.get()};
    static_assert(std::size(sets) == VOXTACT_SET_TRACE + 1);
    const VkPushConstantRange constants{VK_SHADER_STAGE_FRAGMENT_BIT, 0, sizeof(shader::RasterConstants)};
    return makePipelineLayout(context, trace.layout, sets, {&constants, 1}, "trace pipeline layout");
}

/// Makes room for a list of `capacity` fragments.
Result<void> reserve(FragmentTrace::State& trace, std::uint32_t capacity) {
    ContextImpl& context = trace.context;
    const VkDeviceSize bytes = kHeader + VkDeviceSize{capacity} * sizeof(shader::TracedFragment);
    if (bytes > context.limits.maxStorageBufferRange) {
        return Error{ErrorCode::OutOfMemory, 0,
                     "a list of " + std::to_string(capacity) +
                         " fragments is beyond the device's maxStorageBufferRange, " +
                         std::to_string(context.limits.maxStorageBufferRange)};
    }
    Result<Buffer> list = makeBuffer(context, bytes,
                                     VK_BUFFER_USAGE_STORAGE_BUFFER_BIT | VK_BUFFER_USAGE_TRANSFER_SRC_BIT |
                                         VK_BUFFER_USAGE_TRANSFER_DST_BIT,
                                     MemoryUse::Device, "fragment list");
    VOXTACT_TRY(list);
    Result<Buffer> readBack =
        makeBuffer(context, bytes, VK_BUFFER_USAGE_TRANSFER_DST_BIT, MemoryUse::ReadBack, "fragment list on the host");
    VOXTACT_TRY(readBack);
    const VkDescriptorPoolSize size{VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, 1};
    Result<DescriptorSet> set = makeDescriptorSet(context, trace.setLayout.get(), {&size, 1}, "fragment list");
    VOXTACT_TRY(set);
    trace.list = std::move(*list);
    trace.readBack = std::move(*readBack);
    trace.descriptors = std::move(*set);
    writeBuffer(context, trace.descriptors.set, 0, trace.list.get());
    return {};
}

Result<void> record(FragmentTrace::State& trace, VkCommandBuffer commandBuffer, const Batch& batch) {
    ContextImpl& context = trace.context;
    ResultsImpl& results = trace.results->impl();
    const Label label(context, commandBuffer, "voxtact fragment trace");
    results.pairs = 1;
    const std::uint32_t zero = 0;
    context.vk.CmdUpdateBuffer(commandBuffer, trace.list.get(), 0, sizeof zero, &zero);
    VOXTACT_TRY(prepareResults(context, commandBuffer, batch, results, kDesc));
    context.vk.CmdBindDescriptorSets(commandBuffer, VK_PIPELINE_BIND_POINT_GRAPHICS, trace.layout.get(),
                                     VOXTACT_SET_TRACE, 1, &trace.descriptors.set, 0, nullptr);
    trace.pass->record(commandBuffer, batch, results, [](const BatchItem&) { return Boundary::Range; });
    publishResults(context, commandBuffer, results, kDesc);
    const VkBufferCopy whole{0, 0, trace.list.size};
    context.vk.CmdCopyBuffer(commandBuffer, trace.list.get(), trace.readBack.get(), 1, &whole);
    barrier(context, commandBuffer, VK_PIPELINE_STAGE_2_COPY_BIT, VK_ACCESS_2_TRANSFER_WRITE_BIT,
            VK_PIPELINE_STAGE_2_HOST_BIT, VK_ACCESS_2_HOST_READ_BIT);
    return {};
}

/// One try: the number of survivors, of which the list may hold fewer.
Result<std::uint32_t> run(FragmentTrace::State& trace, const Batch& batch) {
    const Result<VkCommandBuffer> commandBuffer = trace.submitter.begin();
    VOXTACT_TRY(commandBuffer);
    VOXTACT_TRY(record(trace, *commandBuffer, batch));
    VOXTACT_TRY(trace.submitter.submitAndWait());
    VOXTACT_TRY(invalidate(trace.context, trace.readBack));
    std::uint32_t count = 0;
    std::memcpy(&count, trace.readBack.mapped, sizeof count);
    return count;
}

Result<void> checkFeatures(const ContextImpl& context) {
    if (!context.features.geometryShader || !context.features.fragmentStoresAndAtomics) {
        return Error{ErrorCode::Unsupported, 0,
                     "a list of fragments needs geometryShader and fragmentStoresAndAtomics to be enabled"};
    }
    return {};
}

} // namespace

Result<FragmentTrace> FragmentTrace::create(const Context& context, Filter filter, const QueueAccess& queue) {
    return guard([&]() -> Result<FragmentTrace> {
        ContextImpl& c = context.impl();
        VOXTACT_TRY(checkFeatures(c));
        Result<Submitter> submitter = Submitter::create(c, queue);
        VOXTACT_TRY(submitter);
        const auto state = std::make_shared<State>(State{.context = c, .submitter = std::move(*submitter)});
        VOXTACT_TRY(makeLayouts(*state));
        Result<ViewPass> pass = ViewPass::createTrace(c, filter, state->layout.get());
        VOXTACT_TRY(pass);
        state->pass.emplace(std::move(*pass));
        Result<Results> results = Results::create(context, {.maxPairs = 1, .readBack = false});
        VOXTACT_TRY(results);
        state->results.emplace(std::move(*results));
        VOXTACT_TRY(reserve(*state, kFirstCapacity));
        return FragmentTrace(state);
    });
}

Result<std::vector<shader::TracedFragment>> FragmentTrace::survivors(const Batch& batch) {
    return guard([&]() -> Result<std::vector<shader::TracedFragment>> {
        const Result<std::uint32_t> pairs = checkBatch(state_->context, kDesc, batch);
        VOXTACT_TRY(pairs);
        if (*pairs != 1) {
            return refuse("a trace is of one pair, the batch has " + std::to_string(*pairs));
        }
        Result<std::uint32_t> count = run(*state_, batch);
        if (count.ok() && kHeader + VkDeviceSize{*count} * sizeof(shader::TracedFragment) > state_->list.size) {
            VOXTACT_TRY(reserve(*state_, *count));
            count = run(*state_, batch);
        }
        VOXTACT_TRY(count);
        std::vector<shader::TracedFragment> out(*count);
        std::ranges::copy_n(static_cast<const std::byte*>(state_->readBack.mapped) + kHeader,
                            static_cast<std::ptrdiff_t>(out.size() * sizeof out[0]),
                            std::as_writable_bytes(std::span(out)).begin());
        std::ranges::sort(out, {}, [](const shader::TracedFragment& f) { return std::tuple(f.triangle, f.y, f.x); });
        return out;
    });
}

} // namespace voxtact
