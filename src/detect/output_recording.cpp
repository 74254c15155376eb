// SPDX-License-Identifier: MIT
#include "core/batch/output_pair.h"
#include "detect/batch.h"
#include "detect/buffer_update.h"
#include "detect/output_store.h"
#include "gpu/barriers.h"
#include "gpu/scene_impl.h"

namespace voxtact {

namespace {

constexpr VkDeviceSize kWord = sizeof(std::uint32_t);

/// Words that a batch uses of the parts of an outputs buffer.
struct Used {
    std::uint64_t bounds = 0;
    std::uint64_t triangles = 0;
    std::uint64_t mask = 0;
    std::uint64_t labels = 0;
};

Used usedBy(const OutputStore& store) {
    Used used;
    for (const OutputItem& item : store.items) {
        used.bounds += std::uint64_t{item.pairs} * OUTPUT_BOUND_WORDS;
        used.triangles += std::uint64_t{item.pairs} * item.triangles;
        used.mask += std::uint64_t{item.pairs} * ((std::uint64_t{item.triangles} + 31) / 32);
        used.labels += item.labels == nullptr ? 0 : std::uint64_t{item.pairs} * item.labels->size();
    }
    const Outputs& outputs = store.recorded;
    return {outputs.bounds ? used.bounds : 0, outputs.triangles ? used.triangles : 0, outputs.triangles ? used.mask : 0,
            outputs.labels ? used.labels : 0};
}

void clear(const ContextImpl& context, VkCommandBuffer commandBuffer, const OutputStore& store) {
    const auto fill = [&](std::uint64_t first, std::uint64_t words) {
        if (words > 0) {
            context.vk.CmdFillBuffer(commandBuffer, store.words.get(), first * kWord, words * kWord, 0);
        }
    };
    const Used used = usedBy(store);
    fill(store.layout.bounds, used.bounds);
    fill(store.layout.triangles, used.triangles);
    fill(store.layout.mask, used.mask);
    fill(store.layout.labels, used.labels);
    if (store.recorded.contacts) {
        const std::uint32_t header[OUTPUT_HEADER_WORDS] = {0, 0, store.room.contacts, 0};
        context.vk.CmdUpdateBuffer(commandBuffer, store.words.get(), store.layout.contacts * kWord, sizeof header,
                                   header);
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
    const auto word = [](std::uint64_t at) { return static_cast<std::uint32_t>(at); };
    for (const BatchItem& item : batch.items) {
        shader::OutputPair pair = pairOf(item, batch.threshold, store.recorded);
        pair.contacts = word(store.layout.contacts);
        pair.contactRoom = store.room.contacts;
        for (std::size_t pose = 0; pose < item.world_from_object.size(); ++pose) {
            pair.firstBound = word(next.bounds);
            pair.firstTriangle = word(next.triangles);
            pair.firstMask = word(next.mask);
            pair.firstLabel = word(next.labels);
            update.add(pair);
            next.bounds += OUTPUT_BOUND_WORDS;
            next.triangles += item.mesh->triangles();
            next.mask += (std::uint64_t{item.mesh->triangles()} + 31) / 32;
            next.labels += pair.labelCount;
        }
    }
    update.finish();
}

} // namespace

void recordOutputs(const ContextImpl& context, VkCommandBuffer commandBuffer, const Batch& batch, OutputStore& store) {
    store.items.clear();
    for (const BatchItem& item : batch.items) {
        store.items.push_back({static_cast<std::uint32_t>(item.world_from_object.size()), item.mesh->triangles(),
                               item.labels == nullptr ? nullptr : item.labels->impl().values});
    }
    clear(context, commandBuffer, store);
    recordPairs(context, commandBuffer, batch, store);
    makeReadable(context, commandBuffer, store.noLabels.image.get());
}

void copyOutputs(const ContextImpl& context, VkCommandBuffer commandBuffer, const OutputStore& store) {
    const auto copy = [&](std::uint64_t first, std::uint64_t words) {
        if (words > 0) {
            const VkBufferCopy region{first * kWord, first * kWord, words * kWord};
            context.vk.CmdCopyBuffer(commandBuffer, store.words.get(), store.readBack.get(), 1, &region);
        }
    };
    const Used used = usedBy(store);
    copy(store.layout.bounds, used.bounds);
    copy(store.layout.triangles, used.triangles);
    copy(store.layout.labels, used.labels);
    copy(store.layout.contacts, store.recorded.contacts ? store.layout.end - store.layout.contacts : 0);
}

} // namespace voxtact
