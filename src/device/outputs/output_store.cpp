// SPDX-License-Identifier: MIT
#include "device/outputs/output_store.h"
#include "core/base/refuse.h"
#include "core/base/try.h"
#include "device/scene/scene_impl.h"
#include "vulkan/context_impl.h"

namespace voxtact {

namespace {

/// Bytes; no device has a larger minStorageBufferOffsetAlignment.
constexpr std::uint64_t kAlignment = 256;

std::uint64_t aligned(std::uint64_t word) {
    constexpr std::uint64_t kWords = kAlignment / kOutputWord;
    return (word + kWords - 1) / kWords * kWords;
}

OutputLayout layoutOf(const OutputRoom& room, const Outputs& outputs, std::uint64_t pairs) {
    OutputLayout layout{};
    const std::size_t parts = outputParts().size();
    for (std::size_t part = 0; part < parts; ++part) {
        const OutputPartRow& row = outputParts()[part];
        const std::uint64_t end = layout[part] + (outputs.*row.output ? row.room(room, pairs) : 0);
        layout[part + 1] = part + 1 < parts ? aligned(end) : end;
    }
    return layout;
}

std::uint64_t wordsOf(const OutputLayout& layout) {
    return layout[outputParts().size()];
}

Result<void> checkRoom(const ContextImpl& context, const ResultsDesc& desc, const Outputs& outputs) {
    const std::uint64_t most = context.limits.maxStorageBufferRange;
    const struct {
        bool needed;
        std::uint64_t room;
        const char* name;
    } rooms[] = {{outputs.triangles, desc.room.triangles, "triangles"},
                 {outputs.labels, desc.room.labels, "labels"},
                 {outputs.contacts, desc.room.contacts, "contacts"}};
    bool huge = false; // sums could overflow
    for (const auto& each : rooms) {
        if (each.needed && each.room == 0) {
            return refuse(std::string("ResultsDesc::room.") + each.name + " is 0; the detector has the output " +
                          each.name);
        }
        huge |= each.needed && each.room > most;
    }
    if (huge || wordsOf(layoutOf(desc.room, outputs, desc.maxPairs)) * kOutputWord > most) {
        return Error{ErrorCode::LimitExceeded, 0,
                     "the outputs of " + std::to_string(desc.maxPairs) + " pairs with room for " +
                         std::to_string(desc.room.triangles) + " triangles, " + std::to_string(desc.room.labels) +
                         " labels and " + std::to_string(desc.room.contacts) +
                         " contacts are beyond the device's maxStorageBufferRange, " + std::to_string(most)};
    }
    if (std::uint64_t{desc.maxPairs} * sizeof(shader::OutputPair) > most) {
        return Error{ErrorCode::LimitExceeded, 0,
                     "the outputs of " + std::to_string(desc.maxPairs) + " pairs need a buffer of " +
                         std::to_string(std::uint64_t{desc.maxPairs} * sizeof(shader::OutputPair)) +
                         " bytes, the device's maxStorageBufferRange is " + std::to_string(most)};
    }
    return {};
}

Result<void> makeBuffers(ContextImpl& context, const ResultsDesc& desc, OutputStore& out) {
    const VkDeviceSize bytes = wordsOf(out.layout) * kOutputWord;
    constexpr VkBufferUsageFlags kTo = VK_BUFFER_USAGE_STORAGE_BUFFER_BIT | VK_BUFFER_USAGE_TRANSFER_DST_BIT;
    Result<Buffer> pairs = makeBuffer(context, VkDeviceSize{desc.maxPairs} * sizeof(shader::OutputPair), kTo,
                                      MemoryUse::Device, "output pairs");
    VOXTACT_TRY(pairs);
    out.pairs = std::move(*pairs);
    Result<Buffer> words =
        makeBuffer(context, bytes, kTo | VK_BUFFER_USAGE_TRANSFER_SRC_BIT, MemoryUse::Device, "outputs");
    VOXTACT_TRY(words);
    out.words = std::move(*words);
    if (desc.readBack) {
        Result<Buffer> readBack =
            makeBuffer(context, bytes, VK_BUFFER_USAGE_TRANSFER_DST_BIT, MemoryUse::ReadBack, "outputs on the host");
        VOXTACT_TRY(readBack);
        out.readBack = std::move(*readBack);
    }
    return {};
}

Result<void> makeNoLabels(ContextImpl& context, OutputStore& out) {
    ImageDesc desc;
    desc.format = kLabelFormat;
    Result<Image> image = makeImage(context, desc, "the place of a label map", "no label map");
    VOXTACT_TRY(image);
    out.noLabels = std::move(*image);
    Result<DescriptorSet> set = makeLabelSet(context, out.noLabels.view.get(), "no label map");
    VOXTACT_TRY(set);
    out.noLabelsSet = std::move(*set);
    return {};
}

Result<void> makeDescriptors(ContextImpl& context, OutputStore& out, VkBuffer transforms, const BufferRange& results) {
    const VkDescriptorPoolSize size{VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, 4};
    Result<DescriptorSet> set = makeDescriptorSet(context, context.outputSetLayout, {&size, 1}, "pairs with outputs");
    VOXTACT_TRY(set);
    out.descriptors = std::move(*set);
    writeBuffer(context, out.descriptors.set, VOXTACT_BINDING_TRANSFORMS, transforms);
    writeBuffer(context, out.descriptors.set, VOXTACT_BINDING_RESULTS, results.buffer, results.size, results.offset);
    writeBuffer(context, out.descriptors.set, VOXTACT_BINDING_OUTPUT_PAIRS, out.pairs.get());
    writeBuffer(context, out.descriptors.set, VOXTACT_BINDING_OUTPUTS, out.words.get());
    return {};
}

} // namespace

Result<std::unique_ptr<OutputStore>> makeOutputStore(ContextImpl& context, const ResultsDesc& desc,
                                                     const Outputs& outputs, VkBuffer transforms,
                                                     const BufferRange& results) {
    VOXTACT_TRY(checkRoom(context, desc, outputs));
    auto out = std::make_unique<OutputStore>();
    out->maxPairs = desc.maxPairs;
    out->room = desc.room;
    out->outputs = outputs;
    out->layout = layoutOf(desc.room, outputs, desc.maxPairs);
    VOXTACT_TRY(makeBuffers(context, desc, *out));
    VOXTACT_TRY(makeNoLabels(context, *out));
    VOXTACT_TRY(makeDescriptors(context, *out, transforms, results));
    return out;
}

OutputRoom roomFor(const Batch& batch, const Outputs& outputs) noexcept {
    OutputRoom room{.contacts = 0};
    for (const BatchItem& item : batch.items) {
        const std::uint64_t pairs = item.pairs();
        room.triangles += !outputs.triangles || item.mesh == nullptr ? 0 : pairs * item.mesh->triangles();
        room.labels += !outputs.labels || item.labels == nullptr ? 0 : pairs * item.labels->values().size();
    }
    return room;
}

VkDescriptorSet labelSetOf(const BatchItem& item, const OutputStore& store) noexcept {
    return item.labels == nullptr ? store.noLabelsSet.set : item.labels->impl().descriptors.set;
}

BufferRange rangeOf(const OutputStore* store, std::size_t part) noexcept {
    const OutputPartRow& row = outputParts()[part];
    const std::uint64_t words =
        store == nullptr || !(store->outputs.*row.output) ? 0 : row.room(store->room, store->maxPairs);
    return words == 0 ? BufferRange{}
                      : BufferRange{store->words.get(), store->layout[part] * kOutputWord, words * kOutputWord};
}

} // namespace voxtact
