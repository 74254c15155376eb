// SPDX-License-Identifier: MIT
#include "detect/certified/closest.h"
#include "clearance_words.h"
#include "core/base/try.h"
#include "detect/batch.h"
#include "gpu/scene_impl.h"

#include "voxtact_shaders/certified_clearance_place_comp.h"
#include "voxtact_shaders/certified_clearance_points_comp.h"

#include <algorithm>
#include <iterator>

namespace voxtact {

namespace {

shader::ClosestConstants pointsOf(const shader::CertifiedConstants& of, const BatchItem& item, std::uint32_t maxPairs) {
    shader::ClosestConstants points{};
    points.mesh = of.mesh;
    std::copy_n(std::begin(of.item.scale), std::size(points.toFlat), std::begin(points.toFlat));
    const Mat4 world_from_voxel = worldFromIndex(item.volume->impl().grid);
    for (std::size_t row = 0; row < 3; ++row) {
        for (std::size_t column = 0; column < 3; ++column) {
            points.rows[3 * row + column] = static_cast<float>(world_from_voxel[4 * column + row]);
        }
        points.origin[row] = static_cast<float>(world_from_voxel[12 + row]);
    }
    points.clearanceWord = of.queueWord + VOXTACT_WORD_CLEARANCES(of.queueRoom);
    points.closestWord = of.queueWord + VOXTACT_WORD_CLOSEST(of.queueRoom, maxPairs);
    return points;
}

/// Calls `record` with the first of so many pairs that a dispatch has, a lane each, and with how many these are.
template <class Record> void eachDispatch(const ContextImpl& context, std::uint32_t pairs, const Record& record) {
    const std::uint64_t most = std::uint64_t{context.limits.maxComputeWorkGroupCount[0]} * VOXTACT_COMPUTE_GROUP;
    for (std::uint32_t first = 0, count = 0; first < pairs; first += count) {
        count = static_cast<std::uint32_t>(std::min<std::uint64_t>(pairs - first, most));
        record(first, count);
    }
}

} // namespace

Result<ClosestPass> ClosestPass::create(ContextImpl& context) {
    ClosestPass pass(context);
    const Result<VkPipeline> place =
        computePipeline(context, spirv::certified_clearance_place_comp, {}, context.computeLayout, "closest place");
    VOXTACT_TRY(place);
    pass.place_ = *place;
    const Result<VkPipeline> points =
        computePipeline(context, spirv::certified_clearance_points_comp, {}, context.computeLayout, "closest points");
    VOXTACT_TRY(points);
    pass.points_ = *points;
    return pass;
}

void ClosestPass::record(RoundRecorder& recorder, VkPipelineLayout layout, const BatchItem& item,
                         const shader::CertifiedConstants& constants) const {
    const DeviceFunctions& vk = context_->vk;
    const VkCommandBuffer commandBuffer = recorder.commandBuffer();
    const auto pairs = static_cast<std::uint32_t>(item.pairs());
    const auto dispatch = [&](const auto& part, std::uint32_t count) {
        vk.CmdPushConstants(commandBuffer, layout, VK_SHADER_STAGE_COMPUTE_BIT, 0, sizeof part, &part);
        vk.CmdDispatch(commandBuffer, (count + VOXTACT_COMPUTE_GROUP - 1) / VOXTACT_COMPUTE_GROUP, 1, 1);
    };
    queuesBarrier(*context_, commandBuffer);
    vk.CmdBindPipeline(commandBuffer, VK_PIPELINE_BIND_POINT_COMPUTE, place_);
    eachDispatch(*context_, pairs, [&](std::uint32_t first, std::uint32_t count) {
        shader::CertifiedConstants part = constants;
        part.firstPair += first;
        part.endCluster = count;
        dispatch(part, count);
    });
    queuesBarrier(*context_, commandBuffer);
    vk.CmdBindPipeline(commandBuffer, VK_PIPELINE_BIND_POINT_COMPUTE, points_);
    eachDispatch(*context_, pairs, [&](std::uint32_t first, std::uint32_t count) {
        shader::ClosestConstants part = pointsOf(constants, item, recorder.results().maxPairs);
        part.firstPair = constants.firstPair + first;
        part.pairs = count;
        dispatch(part, count);
    });
}

} // namespace voxtact
