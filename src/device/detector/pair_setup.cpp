// SPDX-License-Identifier: MIT
#include "device/detector/pair_setup.h"
#include "core/base/try.h"
#include "core/geometry/projection.h"
#include "core/geometry/recentre.h"
#include "core/geometry/wide_matrix.h"
#include "core/method/method_table.h"
#include "device/detector/buffer_update.h"
#include "device/detector/many_poses.h"
#include "device/scene/scene_impl.h"
#include "device/touch/certified_queues.h"
#include "vulkan/barriers.h"
#include "vulkan/layouts.h"
#include "vulkan/pipeline.h"

#include "voxtact_shaders/pair_setup_certified_comp.h"
#include "voxtact_shaders/pair_setup_certified_host_comp.h"
#include "voxtact_shaders/pair_setup_comp.h"
#include "voxtact_shaders/pair_setup_host_comp.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
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
constexpr std::size_t kOriginByte = VOXTACT_SETUP_ORIGIN * sizeof(std::uint32_t);
static_assert(sizeof(ViewItem) <= kOriginByte && sizeof(shader::PairGrid) <= kOriginByte &&
              kOriginByte + sizeof(shader::PairOrigin) <= sizeof(ItemWords));
static_assert(sizeof(Mat4) == VOXTACT_HOST_POSE_WORDS * sizeof(std::uint32_t));
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

/// Whether no product of three elements, and of a grid's, is a denormal, which a device may lose.
bool staysNormal(const Mat4& pose) noexcept {
    constexpr double kLeast = 0x1p-200;
    bool normal = true;
    for (const double element : pose) {
        normal &= element == 0 || std::abs(element) >= kLeast;
    }
    return normal;
}

template <class Item> ItemWords wordsOf(const Item& item, const Mesh& mesh) {
    ItemWords words{};
    std::memcpy(words.data(), &item, sizeof item);
    const shader::PairOrigin origin = toPairOrigin(mesh.impl().known.origin);
    std::memcpy(words.data() + VOXTACT_SETUP_ORIGIN, &origin, sizeof origin);
    return words;
}

ItemWords viewItem(const BatchItem& item, const Cameras& cameras) {
    ViewItem out{toWide(item.volume->impl().texture_from_world), {}};
    std::ranges::transform(cameras.clip_from_world(), out.clip_from_world.begin(), toWide);
    return wordsOf(out, *item.mesh);
}

} // namespace

bool hasDevicePoses(const Batch& batch) noexcept {
    return std::ranges::any_of(batch.items, [](const BatchItem& item) { return item.poses != nullptr; });
}

namespace {

Result<void> makeStagedPoses(ResultsImpl& results) {
    ContextImpl& context = results.context;
    const Result<VkDescriptorSetLayout> layout = poseSetLayout(context);
    VOXTACT_TRY(layout);
    constexpr VkDescriptorPoolSize kSize{VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, 1};
    Result<DescriptorSet> set = makeDescriptorSet(context, *layout, {&kSize, 1}, "staged poses");
    VOXTACT_TRY(set);
    results.stagedPoses = std::move(*set);
    results.stagedPoseRoom = static_cast<std::uint32_t>(
        std::min<VkDeviceSize>(results.maxPairs, context.limits.maxStorageBufferRange / sizeof(Mat4)));
    writeBuffer(context, results.stagedPoses.set, 0, results.staging.get(), results.stagedPoseRoom * sizeof(Mat4));
    return {};
}

} // namespace

Result<void> makeSetupSets(ResultsImpl& results) {
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
    return results.staging.buffer ? makeStagedPoses(results) : Result<void>();
}

Result<PairSetup> PairSetup::create(ContextImpl& context, const PassDesc& desc) {
    if (const char* missing = context.floatControls.missingForDoubles; missing != nullptr) {
        return Error{ErrorCode::Unsupported, 0,
                     std::string("poses on the device (devicePoses) need doubles that round as the "
                                 "host's, and the device lacks ") +
                         missing};
    }
    const Result<VkPipelineLayout> layout = setupLayout(context);
    VOXTACT_TRY(layout);
    using Words = std::span<const std::uint32_t>;
    const bool certified = rowOf(desc.projection).certified;
    PairSetup setup(context, desc);
    const Result<VkPipeline> pipeline =
        computePipeline(context, certified ? Words(spirv::pair_setup_certified_comp) : spirv::pair_setup_comp, {},
                        *layout, "pair set-up");
    VOXTACT_TRY(pipeline);
    setup.pipeline_ = *pipeline;
    const Result<VkPipeline> ofHost =
        computePipeline(context, certified ? Words(spirv::pair_setup_certified_host_comp) : spirv::pair_setup_host_comp,
                        {}, *layout, "pair set-up of host poses");
    VOXTACT_TRY(ofHost);
    setup.hostPipeline_ = *ofHost;
    return setup;
}

bool PairSetup::stagePoses(const Batch& batch, const ResultsImpl& results) const noexcept {
    if (results.pairs < kFewestHostPoses || results.pairs > results.stagedPoseRoom) {
        return false;
    }
    auto* to = static_cast<std::byte*>(results.staging.mapped);
    for (const BatchItem& item : batch.items) {
        if (!std::ranges::all_of(item.world_from_object, staysNormal)) {
            return false;
        }
        if (!item.world_from_object.empty()) {
            std::memcpy(to, item.world_from_object.data(), item.world_from_object.size_bytes());
        }
        to += item.pairs() * sizeof(Mat4);
    }
    return true;
}

PairSetup::Source PairSetup::sourceOf(const BatchItem& item, const ResultsImpl& results,
                                      std::uint32_t firstPair) const {
    if (item.poses == nullptr) {
        return {hostPipeline_, results.stagedPoses.set, firstPair * VOXTACT_HOST_POSE_WORDS, VOXTACT_HOST_POSE_WORDS};
    }
    const PoseBufferImpl& poses = item.poses->impl();
    return {pipeline_, poses.descriptors.set, poses.firstWord, poses.words};
}

void PairSetup::recordItems(VkCommandBuffer commandBuffer, const Batch& batch, const ResultsImpl& results,
                            bool staged) const {
    recordItems(commandBuffer, batch, results, staged, 0);
}

void PairSetup::recordItems(VkCommandBuffer commandBuffer, const Batch& batch, const ResultsImpl& results, bool staged,
                            std::size_t firstItem) const {
    const std::size_t end = std::min<std::size_t>(batch.items.size(), firstItem + VOXTACT_SETUP_ITEMS);
    const bool certified = rowOf(desc_.projection).certified;
    const Cameras cameras(desc_.projection, batch.view);
    BufferUpdate<ItemWords> update(*context_, commandBuffer, results.transforms.get(), setupByte(results));
    for (const BatchItem& item : batch.items.subspan(firstItem, end - firstItem)) {
        if (item.poses == nullptr && !staged) {
            update.skip(1);
        } else {
            update.add(certified ? wordsOf(item.volume->impl().pairGrid, *item.mesh) : viewItem(item, cameras));
        }
    }
    update.finish();
}

void PairSetup::record(VkCommandBuffer commandBuffer, const Batch& batch, const ResultsImpl& results, bool staged,
                       std::uint32_t how) const {
    context_->vk.CmdBindDescriptorSets(commandBuffer, VK_PIPELINE_BIND_POINT_COMPUTE, context_->setupLayout.get(),
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
            recordItems(commandBuffer, batch, results, staged, i);
            barrier(*context_, commandBuffer, VK_PIPELINE_STAGE_2_ALL_TRANSFER_BIT, VK_ACCESS_2_TRANSFER_WRITE_BIT,
                    VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT, VK_ACCESS_2_SHADER_STORAGE_READ_BIT);
        }
        const BatchItem& item = batch.items[i];
        constants.item = static_cast<std::uint32_t>(i);
        constants.setupWord = static_cast<std::uint32_t>(i % VOXTACT_SETUP_ITEMS * VOXTACT_SETUP_WORDS);
        const auto pairs = static_cast<std::uint32_t>(item.pairs());
        if (item.poses != nullptr || staged) {
            recordItem(commandBuffer, sourceOf(item, results, constants.firstPair), pairs, constants);
        }
        constants.firstPair += pairs;
    }
}

void PairSetup::recordItem(VkCommandBuffer commandBuffer, const Source& source, std::uint32_t pairs,
                           shader::PairSetupConstants constants) const {
    const DeviceFunctions& vk = context_->vk;
    vk.CmdBindPipeline(commandBuffer, VK_PIPELINE_BIND_POINT_COMPUTE, source.pipeline);
    vk.CmdBindDescriptorSets(commandBuffer, VK_PIPELINE_BIND_POINT_COMPUTE, context_->setupLayout.get(),
                             VOXTACT_SET_SETUP_POSES, 1, &source.poses, 0, nullptr);
    constants.poseWords = source.words;
    const std::uint32_t most =
        std::min(context_->limits.maxComputeWorkGroupCount[0], UINT32_MAX / VOXTACT_COMPUTE_GROUP);
    for (std::uint32_t done = 0; done < pairs; done += constants.pairs) {
        constants.pairs = std::min(pairs - done, most * VOXTACT_COMPUTE_GROUP);
        constants.firstPose = done;
        constants.poseWord = source.firstWord + done * source.words;
        vk.CmdPushConstants(commandBuffer, context_->setupLayout.get(), VK_SHADER_STAGE_COMPUTE_BIT, 0,
                            sizeof constants, &constants);
        vk.CmdDispatch(commandBuffer, (constants.pairs + VOXTACT_COMPUTE_GROUP - 1) / VOXTACT_COMPUTE_GROUP, 1, 1);
        constants.firstPair += constants.pairs;
    }
}

} // namespace voxtact
