// SPDX-License-Identifier: MIT
#include "detect/pair_setup.h"
#include "core/base/try.h"
#include "core/geometry/projection.h"
#include "core/geometry/wide_matrix.h"
#include "core/method/method_table.h"
#include "detect/buffer_update.h"
#include "detect/certified/certified_queues.h"
#include "gpu/barriers.h"
#include "gpu/layouts.h"
#include "gpu/pipeline.h"
#include "gpu/scene_impl.h"
#include "pair_setup.h"

#include "voxtact_shaders/pair_setup_certified_comp.h"
#include "voxtact_shaders/pair_setup_certified_doubles_comp.h"
#include "voxtact_shaders/pair_setup_comp.h"
#include "voxtact_shaders/pair_setup_doubles_comp.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cstring>

namespace voxtact {

namespace {

/// What is the same for all pairs of an item, as the pass reads it.
using ItemWords = std::array<std::uint32_t, VOXTACT_SETUP_WORDS>;

/// For the projections with fragments: texture_from_world, and the cameras.
struct ViewItem {
    shader::WideMatrix texture_from_world;
    std::array<shader::WideMatrix, 2> clip_from_world;
};

static_assert(VOXTACT_SETUP_ITEMS * sizeof(ItemWords) == kSetupBytes);
static_assert(sizeof(ViewItem) <= sizeof(ItemWords) && sizeof(shader::PairGrid) <= sizeof(ItemWords));
static_assert(std::endian::native == std::endian::little, "a double's low word comes first");
static_assert(offsetof(shader::PairGrid, size) == 32 * 4 && offsetof(shader::PairGrid, sign) == 38 * 4 &&
                  offsetof(shader::PairGrid, lessOrigin) == 44 * 4 &&
                  offsetof(shader::PairGrid, halfSpacing) == 50 * 4 && offsetof(shader::PairGrid, share) == 56 * 4 &&
                  offsetof(shader::PairGrid, axis) == 80 * 4 && offsetof(shader::PairGrid, aligned) == 83 * 4,
              "as pair_setup.comp reads it");

/// Of VOXTACT_SET_SETUP, made for the first who asks.
Result<VkDescriptorSetLayout> setupSetLayout(ContextImpl& context) {
    const std::lock_guard lock(context.onDemandMutex);
    if (!context.setupSetLayout) {
        std::array<VkDescriptorSetLayoutBinding, 3> bindings{};
        for (std::uint32_t binding = 0; binding < bindings.size(); ++binding) {
            bindings[binding] = {binding, VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, 1, VK_SHADER_STAGE_COMPUTE_BIT, nullptr};
        }
        VOXTACT_TRY(makeSetLayout(context, context.setupSetLayout, bindings, "pair set-up"));
    }
    return context.setupSetLayout.get();
}

/// The same.
Result<VkPipelineLayout> setupLayout(ContextImpl& context) {
    const Result<VkDescriptorSetLayout> poses = poseSetLayout(context);
    VOXTACT_TRY(poses);
    const Result<VkDescriptorSetLayout> results = setupSetLayout(context);
    VOXTACT_TRY(results);
    const std::lock_guard lock(context.onDemandMutex);
    if (!context.setupLayout) {
        static_assert(VOXTACT_SET_SETUP == 0 && VOXTACT_SET_SETUP_POSES == 1);
        const VkDescriptorSetLayout sets[] = {*results, *poses};
        constexpr VkPushConstantRange kConstants{VK_SHADER_STAGE_COMPUTE_BIT, 0, sizeof(shader::PairSetupConstants)};
        VOXTACT_TRY(makePipelineLayout(context, context.setupLayout, sets, {&kConstants, 1}, "pair set-up layout"));
    }
    return context.setupLayout.get();
}

template <class Item> ItemWords wordsOf(const Item& item) {
    ItemWords words{};
    std::memcpy(words.data(), &item, sizeof item);
    return words;
}

ItemWords viewItem(const BatchItem& item, const Cameras& cameras) {
    ViewItem out{toWide(item.volume->impl().texture_from_world), {}};
    std::ranges::transform(cameras.clip_from_world(), out.clip_from_world.begin(), toWide);
    return wordsOf(out);
}

} // namespace

bool hasDevicePoses(const Batch& batch) noexcept {
    return std::ranges::any_of(batch.items, [](const BatchItem& item) { return item.poses != nullptr; });
}

Result<void> makeSetupSet(ResultsImpl& results) {
    ContextImpl& context = results.context;
    const Result<VkDescriptorSetLayout> layout = setupSetLayout(context);
    VOXTACT_TRY(layout);
    constexpr VkDescriptorPoolSize kSize{VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, 3};
    Result<DescriptorSet> set = makeDescriptorSet(context, *layout, {&kSize, 1}, "pair set-up");
    VOXTACT_TRY(set);
    results.setup = std::move(*set);
    const VkDescriptorSet handle = results.setup.set;
    writeBuffer(context, handle, VOXTACT_BINDING_SETUP_TRANSFORMS, results.transforms.get(), setupByte(results));
    writeBuffer(context, handle, VOXTACT_BINDING_SETUP_RESULTS, results.results.buffer, results.results.size,
                results.results.offset);
    writeBuffer(context, handle, VOXTACT_BINDING_SETUP_ITEMS, results.transforms.get(), kSetupBytes,
                setupByte(results));
    return {};
}

Result<PairSetup> PairSetup::create(ContextImpl& context, const DetectorDesc& desc) {
    const Result<VkPipelineLayout> layout = setupLayout(context);
    VOXTACT_TRY(layout);
    using Words = std::span<const std::uint32_t>;
    const bool doubles = context.floatControls.doubles;
    const Words certified =
        doubles ? Words(spirv::pair_setup_certified_doubles_comp) : Words(spirv::pair_setup_certified_comp);
    const Words others = doubles ? Words(spirv::pair_setup_doubles_comp) : Words(spirv::pair_setup_comp);
    const Result<VkPipeline> pipeline =
        computePipeline(context, rowOf(desc.projection).certified ? certified : others, {}, *layout, "pair set-up");
    VOXTACT_TRY(pipeline);
    return PairSetup(context, desc, *pipeline);
}

void PairSetup::recordItems(VkCommandBuffer commandBuffer, const Batch& batch, const ResultsImpl& results) const {
    recordItems(commandBuffer, batch, results, 0);
}

void PairSetup::recordItems(VkCommandBuffer commandBuffer, const Batch& batch, const ResultsImpl& results,
                            std::size_t firstItem) const {
    const std::size_t end = std::min<std::size_t>(batch.items.size(), firstItem + VOXTACT_SETUP_ITEMS);
    const bool certified = rowOf(desc_.projection).certified;
    const Cameras cameras(desc_.projection, batch.view);
    BufferUpdate<ItemWords> update(*context_, commandBuffer, results.transforms.get(), setupByte(results));
    for (const BatchItem& item : batch.items.subspan(firstItem, end - firstItem)) {
        if (item.poses == nullptr) {
            update.skip(1);
        } else {
            update.add(certified ? wordsOf(item.volume->impl().pairGrid) : viewItem(item, cameras));
        }
    }
    update.finish();
}

void PairSetup::record(VkCommandBuffer commandBuffer, const Batch& batch, const ResultsImpl& results,
                       std::uint32_t how) const {
    const DeviceFunctions& vk = context_->vk;
    vk.CmdBindPipeline(commandBuffer, VK_PIPELINE_BIND_POINT_COMPUTE, pipeline_);
    vk.CmdBindDescriptorSets(commandBuffer, VK_PIPELINE_BIND_POINT_COMPUTE, context_->setupLayout.get(),
                             VOXTACT_SET_SETUP, 1, &results.setup.set, 0, nullptr);
    const ProjectionRow& row = rowOf(desc_.projection);
    shader::PairSetupConstants constants{};
    constants.how = how;
    constants.refused = (how & 0xffffU) | static_cast<std::uint32_t>(Exactness::Refused) << 16U |
                        (row.certified ? VOXTACT_HOW_UNDECIDED_BIT : 0);
    constants.views = row.certified ? 0 : viewsPerPair(desc_.projection);
    for (std::size_t i = 0; i < batch.items.size(); ++i) {
        if (i > 0 && i % VOXTACT_SETUP_ITEMS == 0) {
            barrier(*context_, commandBuffer, VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT, 0,
                    VK_PIPELINE_STAGE_2_ALL_TRANSFER_BIT, VK_ACCESS_2_TRANSFER_WRITE_BIT);
            recordItems(commandBuffer, batch, results, i);
            barrier(*context_, commandBuffer, VK_PIPELINE_STAGE_2_ALL_TRANSFER_BIT, VK_ACCESS_2_TRANSFER_WRITE_BIT,
                    VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT, VK_ACCESS_2_SHADER_STORAGE_READ_BIT);
        }
        const BatchItem& item = batch.items[i];
        constants.item = static_cast<std::uint32_t>(i);
        constants.setupWord = static_cast<std::uint32_t>(i % VOXTACT_SETUP_ITEMS * VOXTACT_SETUP_WORDS);
        if (item.poses != nullptr) {
            recordItem(commandBuffer, item, constants);
        }
        constants.firstPair += static_cast<std::uint32_t>(item.pairs());
    }
}

void PairSetup::recordItem(VkCommandBuffer commandBuffer, const BatchItem& item,
                           shader::PairSetupConstants constants) const {
    const DeviceFunctions& vk = context_->vk;
    const PoseBufferImpl& poses = item.poses->impl();
    vk.CmdBindDescriptorSets(commandBuffer, VK_PIPELINE_BIND_POINT_COMPUTE, context_->setupLayout.get(),
                             VOXTACT_SET_SETUP_POSES, 1, &poses.descriptors.set, 0, nullptr);
    constants.poseWords = poses.words;
    const auto pairs = static_cast<std::uint32_t>(item.pairs());
    const std::uint32_t most =
        std::min(context_->limits.maxComputeWorkGroupCount[0], UINT32_MAX / VOXTACT_COMPUTE_GROUP);
    for (std::uint32_t done = 0; done < pairs; done += constants.pairs) {
        constants.pairs = std::min(pairs - done, most * VOXTACT_COMPUTE_GROUP);
        constants.firstPose = done;
        constants.poseWord = poses.firstWord + done * poses.words;
        vk.CmdPushConstants(commandBuffer, context_->setupLayout.get(), VK_SHADER_STAGE_COMPUTE_BIT, 0,
                            sizeof constants, &constants);
        vk.CmdDispatch(commandBuffer, (constants.pairs + VOXTACT_COMPUTE_GROUP - 1) / VOXTACT_COMPUTE_GROUP, 1, 1);
        constants.firstPair += constants.pairs;
    }
}

} // namespace voxtact
