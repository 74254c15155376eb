// SPDX-License-Identifier: MIT
#include "core/base/try.h"
#include "core/batch/output_pair.h"
#include "device/detector/batch.h"
#include "device/detector/buffer_update.h"
#include "device/outputs/output_store.h"
#include "device/scene/scene_impl.h"
#include "vulkan/barriers.h"

namespace voxtact {

namespace {

/// Words that the batch recorded last uses of a part; of a list, all that it has room for.
std::uint64_t usedOf(const OutputStore& store, const OutputPartRow& part) {
    if (!(store.recorded.*part.output)) {
        return 0;
    }
    if (part.ofPair == nullptr) {
        return part.room(store.room, store.maxPairs);
    }
    std::uint64_t words = 0;
    for (const OutputItem& item : store.items) {
        words += item.pairs * part.ofPair(item);
    }
    return words;
}

void clear(const ContextImpl& context, VkCommandBuffer commandBuffer, const OutputStore& store) {
    for (std::size_t i = 0; i < outputParts().size(); ++i) {
        const OutputPartRow& part = outputParts()[i];
        const std::uint64_t words = usedOf(store, part);
        if (words > 0 && part.ofPair != nullptr) {
            context.vk.CmdFillBuffer(commandBuffer, store.words.get(), store.layout[i] * kOutputWord,
                                     words * kOutputWord, 0);
        } else if (words > 0) {
            const std::uint32_t header[OUTPUT_HEADER_WORDS] = {0, 0, store.room.contacts, 0};
            context.vk.CmdUpdateBuffer(commandBuffer, store.words.get(), store.layout[i] * kOutputWord, sizeof header,
                                       header);
        }
    }
}

/// The stand-in for a label map becomes something that a set may be bound to.
void makeReadable(const ContextImpl& context, VkCommandBuffer commandBuffer, VkImage image) {
    // Whatever the queue has: it may be one that only computes.
    constexpr VkPipelineStageFlags2 kStages = VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT;
    barrier(context, commandBuffer, image, {kStages, 0, VK_IMAGE_LAYOUT_UNDEFINED},
            {kStages, VK_ACCESS_2_SHADER_SAMPLED_READ_BIT, VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL});
}

shader::OutputPair pairOf(const BatchItem& item, double threshold, const Outputs& outputs) {
    const VolumeImpl& volume = item.volume->impl();
    const double unit = volume.storedUnit > 0 ? volume.storedUnit : 1;
    shader::OutputPair pair =
        outputPair(volume.grid, volume.texture_from_world, itemConstants(item, Filter::Exact, threshold),
                   volume.valueSlope / unit, volume.valueIntercept, outputs);
    if (item.labels != nullptr) {
        addLabelMap(pair, volume.grid, item.labels->grid(), item.labels->values());
    }
    return pair;
}

void recordPairs(const ContextImpl& context, VkCommandBuffer commandBuffer, const Batch& batch,
                 const OutputStore& store) {
    BufferUpdate<shader::OutputPair> update(context, commandBuffer, store.pairs.get());
    OutputLayout next = store.layout;
    for (std::size_t i = 0; i < batch.items.size(); ++i) {
        shader::OutputPair pair = pairOf(batch.items[i], batch.threshold, store.recorded);
        pair.contactRoom = store.room.contacts;
        for (std::uint32_t pose = 0; pose < store.items[i].pairs; ++pose) {
            for (std::size_t part = 0; part < outputParts().size(); ++part) {
                const OutputPartRow& row = outputParts()[part];
                pair.*row.first = static_cast<std::uint32_t>(next[part]);
                next[part] += row.ofPair == nullptr ? 0 : row.ofPair(store.items[i]);
            }
            update.add(pair);
        }
    }
    update.finish();
}

} // namespace

void recordOutputs(const ContextImpl& context, VkCommandBuffer commandBuffer, const Batch& batch, OutputStore& store) {
    store.items.clear();
    for (const BatchItem& item : batch.items) {
        store.items.push_back({static_cast<std::uint32_t>(item.pairs()), item.mesh->triangles(),
                               item.labels == nullptr ? nullptr : item.labels->impl().values});
    }
    clear(context, commandBuffer, store);
    recordPairs(context, commandBuffer, batch, store);
    makeReadable(context, commandBuffer, store.noLabels.image.get());
}

void copyOutputs(const ContextImpl& context, VkCommandBuffer commandBuffer, const OutputStore& store) {
    for (std::size_t i = 0; i < outputParts().size(); ++i) {
        const OutputPartRow& part = outputParts()[i];
        const std::uint64_t words = part.unpack == nullptr ? 0 : usedOf(store, part);
        if (words > 0) {
            const VkBufferCopy region{store.layout[i] * kOutputWord, store.layout[i] * kOutputWord,
                                      words * kOutputWord};
            context.vk.CmdCopyBuffer(commandBuffer, store.words.get(), store.readBack.get(), 1, &region);
        }
    }
}

Result<void> unpackOutputs(const OutputStore& store, BatchAnswer& answer) {
    const auto* const words = static_cast<const std::uint32_t*>(store.readBack.mapped);
    for (std::size_t i = 0; i < outputParts().size(); ++i) {
        const OutputPartRow& part = outputParts()[i];
        if (part.unpack != nullptr && store.recorded.*part.output) {
            VOXTACT_TRY(part.unpack({words + store.layout[i], store.items, store.room}, answer));
        }
    }
    return {};
}

} // namespace voxtact
