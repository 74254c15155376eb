// SPDX-License-Identifier: MIT
#include "detect/clearance.h"
#include "core/base/try.h"
#include "core/method/certified_constants.h"
#include "detect/batch.h"
#include "detect/certified_queues.h"
#include "detect/certified_rounds.h"
#include "gpu/barriers.h"
#include "gpu/scene_impl.h"

#include "voxtact_shaders/certified_clearance_again_comp.h"
#include "voxtact_shaders/certified_clearance_bits_comp.h"
#include "voxtact_shaders/certified_clearance_cull_comp.h"
#include "voxtact_shaders/certified_clearance_decide_comp.h"
#include "voxtact_shaders/certified_clearance_expand_comp.h"
#include "voxtact_shaders/certified_clearance_finish_comp.h"
#include "voxtact_shaders/certified_clearance_large_comp.h"
#include "voxtact_shaders/certified_clearance_narrow_comp.h"
#include "voxtact_shaders/certified_clearance_near_comp.h"
#include "voxtact_shaders/certified_clearance_nearest_comp.h"
#include "voxtact_shaders/certified_clearance_probe_comp.h"
#include "voxtact_shaders/certified_clearance_probes_comp.h"
#include "voxtact_shaders/certified_clearance_refine_comp.h"
#include "voxtact_shaders/certified_clearance_scout_comp.h"
#include "voxtact_shaders/certified_clearance_search_comp.h"
#include "voxtact_shaders/certified_clearance_sift_comp.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace voxtact {

namespace {

static_assert(VOXTACT_CLEARANCE_CLOSED == static_cast<std::uint32_t>(ClearanceEnd::Closed) &&
              VOXTACT_CLEARANCE_BEYOND == static_cast<std::uint32_t>(ClearanceEnd::Beyond) &&
              VOXTACT_CLEARANCE_ROUNDED == static_cast<std::uint32_t>(ClearanceEnd::Rounding) &&
              VOXTACT_CLEARANCE_BUDGET == static_cast<std::uint32_t>(ClearanceEnd::Budget) &&
              VOXTACT_CLEARANCE_BUDGET < VOXTACT_CLEARANCE_ENDS);
static_assert(VOXTACT_EXACTNESS_REFUSED == static_cast<std::uint32_t>(Exactness::Refused));

/// Flat: how far the first step looks beyond where boxes say that something may be.
constexpr float kFirst = 2;
/// Of a step but the first, how much of the room a cluster has: far away it is near many times the bricks that it
/// touches.
constexpr std::uint32_t kRoomOfCluster = 16;
/// Steps that look again at what was left undecided, or at less where it was too much.
constexpr std::uint32_t kStepsAgain = 6;

float below(double value) {
    const auto nearest = static_cast<float>(value);
    return static_cast<double>(nearest) <= value ? nearest : std::nextafter(nearest, 0.0F);
}

float above(double value) {
    const auto nearest = static_cast<float>(value);
    return static_cast<double>(nearest) >= value ? nearest
                                                 : std::nextafter(nearest, std::numeric_limits<float>::infinity());
}

/// The most that a search of this volume looks farther, step by step, than it looked before.
double farthest(const Grid& grid, float most) {
    double sides = 0;
    for (const std::uint32_t size : grid.size) {
        sides += size;
    }
    return std::min<double>(sides, most);
}

shader::ClearanceConstants searchOf(const shader::CertifiedConstants& of, const BatchItem& item,
                                    const ClearanceSearch& desc) {
    constexpr double kOutward = 1 + 0x1p-16; // more than what is taken from `lo` for rounding
    const Grid& grid = item.volume->impl().grid;
    const double side = longestSide(grid);
    const auto flat = [&](std::size_t i) { return std::abs(static_cast<double>(of.item.scale[i])); };
    // Flat space from voxel space, as clearanceSpace() has it.
    const double size = std::hypot(flat(0) + flat(1) + flat(2), flat(3) + flat(4), flat(5));
    shader::ClearanceConstants search{};
    search.clearanceWord = of.queueWord + VOXTACT_WORD_CLEARANCES(of.queueRoom);
    search.firstPair = of.firstPair;
    search.pairs = static_cast<std::uint32_t>(item.pairs());
    search.first = kFirst;
    search.most = desc.maximum / side * kOutward < VOXTACT_CLEARANCE_FAR ? above(desc.maximum / side * kOutward)
                                                                         : VOXTACT_CLEARANCE_FAR;
    search.lastStep =
        2 + static_cast<std::uint32_t>(std::max(std::ceil(std::log2(farthest(grid, search.most) / kFirst)), 0.0));
    search.steps = search.lastStep + kStepsAgain;
    search.tolerance = of.item.resolution;
    search.rounding = above(size * VOXTACT_CLEARANCE_ROUNDING * kOutward);
    search.side = static_cast<float>(side);
    search.closed = below(desc.tolerance);
    search.maximum = above(desc.maximum);
    return search;
}

} // namespace

Result<ClearancePass> ClearancePass::create(ContextImpl& context, const DetectorDesc& desc) {
    struct Program {
        std::span<const std::uint32_t> spirv;
        const char* name;
    };
    const Program programs[Count] = {
        {spirv::certified_clearance_cull_comp, "clearance cull"},
        {spirv::certified_clearance_scout_comp, "clearance scout"},
        {spirv::certified_clearance_refine_comp, "clearance refine"},
        {spirv::certified_clearance_expand_comp, "clearance expand"},
        {spirv::certified_clearance_bits_comp, "clearance bits"},
        {spirv::certified_clearance_near_comp, "clearance near"},
        {spirv::certified_clearance_sift_comp, "clearance sift"},
        {spirv::certified_clearance_probes_comp, "clearance probes"},
        {spirv::certified_clearance_probe_comp, "clearance probe"},
        {spirv::certified_clearance_nearest_comp, "clearance nearest"},
        {spirv::certified_clearance_large_comp, "clearance large"},
        {spirv::certified_clearance_narrow_comp, "clearance narrow"},
        {spirv::certified_clearance_again_comp, "clearance again"},
        {spirv::certified_clearance_decide_comp, "clearance decide"},
        {spirv::certified_clearance_finish_comp, "clearance finish"},
        {spirv::certified_clearance_search_comp, "clearance search"},
    };
    const ShaderConstant constants[] = {{VOXTACT_CONSTANT_COUNTERS, desc.counters ? 1U : 0U},
                                        {VOXTACT_CONSTANT_CLOSEST, desc.closest ? 1U : 0U}};
    ClearancePass pass(context, *desc.clearance);
    for (std::size_t i = 0; i < Count; ++i) {
        Result<Owned<VkPipeline>> made =
            makeComputePipeline(context, programs[i].spirv, constants, context.computeLayout, programs[i].name);
        VOXTACT_TRY(made);
        pass.pipelines_[i] = std::move(*made);
    }
    if (desc.closest) {
        Result<ClosestPass> made = ClosestPass::create(context);
        VOXTACT_TRY(made);
        pass.closest_ = std::move(*made);
    }
    return pass;
}

void ClearancePass::recordSearch(RoundRecorder& recorder, VkPipelineLayout layout,
                                 const shader::ClearanceConstants& constants) const {
    const DeviceFunctions& vk = context_->vk;
    const VkCommandBuffer commandBuffer = recorder.commandBuffer();
    vk.CmdBindPipeline(commandBuffer, VK_PIPELINE_BIND_POINT_COMPUTE, pipelines_[Search].get());
    const std::uint32_t most = context_->limits.maxComputeWorkGroupCount[0];
    shader::ClearanceConstants part = constants;
    for (std::uint32_t done = 0; done < constants.pairs; done += part.pairs) {
        part.firstPair = constants.firstPair + done;
        part.pairs = static_cast<std::uint32_t>(
            std::min<std::uint64_t>(constants.pairs - done, std::uint64_t{most} * VOXTACT_COMPUTE_GROUP));
        vk.CmdPushConstants(commandBuffer, layout, VK_SHADER_STAGE_COMPUTE_BIT, 0, sizeof part, &part);
        vk.CmdDispatch(commandBuffer, (part.pairs + VOXTACT_COMPUTE_GROUP - 1) / VOXTACT_COMPUTE_GROUP, 1, 1);
    }
}

void ClearancePass::recordNoBits(RoundRecorder& recorder) const {
    const ResultsImpl& results = recorder.results();
    const VkCommandBuffer commandBuffer = recorder.commandBuffer();
    barrier(*context_, commandBuffer, VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT, VK_ACCESS_2_SHADER_STORAGE_WRITE_BIT,
            VK_PIPELINE_STAGE_2_ALL_TRANSFER_BIT, VK_ACCESS_2_TRANSFER_WRITE_BIT);
    context_->vk.CmdFillBuffer(commandBuffer, results.transforms.get(), bitsByte(results),
                               VkDeviceSize{VOXTACT_ROOM_BITS(results.queueRoom)} * sizeof(std::uint32_t), 0);
    barrier(*context_, commandBuffer, VK_PIPELINE_STAGE_2_ALL_TRANSFER_BIT, VK_ACCESS_2_TRANSFER_WRITE_BIT,
            VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT,
            VK_ACCESS_2_SHADER_STORAGE_READ_BIT | VK_ACCESS_2_SHADER_STORAGE_WRITE_BIT);
}

void ClearancePass::recordStep(RoundRecorder& recorder, VkPipelineLayout layout, const BatchItem& item,
                               const shader::CertifiedConstants& given, bool boxesOnly) const {
    const auto pass = [&](Pipeline pipeline, std::uint32_t queue) {
        return RoundPass{pipelines_[pipeline].get(), queue};
    };
    const RoundPass boxes[] = {pass(Cull, kNoQueue), pass(Scout, VOXTACT_QUEUE_CLUSTERS)};
    const RoundPass all[] = {pass(Cull, kNoQueue),
                             pass(Refine, VOXTACT_QUEUE_CLUSTERS),
                             pass(Expand, VOXTACT_QUEUE_RUNS),
                             pass(Bits, VOXTACT_QUEUE_BITS),
                             pass(Near, VOXTACT_QUEUE_LARGE),
                             pass(Sift, VOXTACT_QUEUE_NEAR),
                             pass(Probes, VOXTACT_QUEUE_NEAR),
                             pass(Probe, VOXTACT_QUEUE_PROBES),
                             pass(Nearest, VOXTACT_QUEUE_NEAR),
                             pass(Large, VOXTACT_QUEUE_NEAREST),
                             pass(Narrow, VOXTACT_QUEUE_CELLS),
                             pass(Again, VOXTACT_QUEUE_CELLS),
                             pass(Decide, VOXTACT_QUEUE_OPEN),
                             pass(Finish, VOXTACT_QUEUE_LEFT)};
    // What a round looks at is bounded on the device: the host does not know how far a pair will look.
    const MeshLooks mesh{.pairs = static_cast<std::uint32_t>(item.pairs()), .clusters = groupsOf(*item.mesh)};
    const RoundLimits limits{.clusters = boxesOnly ? given.queueRoom : given.queueRoom / kRoomOfCluster,
                             .pairs = context_->limits.maxComputeWorkGroupCount[1],
                             .looks = 0};
    eachRound(mesh, limits, [&](const Round& round) {
        shader::CertifiedConstants constants = given;
        constants.firstPair += round.firstPair;
        constants.firstCluster = round.firstCluster;
        constants.endCluster = round.endCluster;
        recorder.record(boxesOnly ? std::span<const RoundPass>(boxes) : std::span<const RoundPass>(all), layout,
                        constants, round.pairs);
    });
}

void ClearancePass::record(RoundRecorder& recorder, VkPipelineLayout layout, const BatchItem& item,
                           const shader::CertifiedConstants& constants) const {
    if (item.pairs() == 0) {
        return;
    }
    shader::CertifiedConstants of = constants;
    of.item = withClearance(of.item, item.volume->impl().grid, desc_.tolerance);
    shader::ClearanceConstants search = searchOf(of, item, desc_);
    recordNoBits(recorder);
    queuesBarrier(*context_, recorder.commandBuffer());
    recordSearch(recorder, layout, search);
    for (search.step = 1; search.step <= search.steps; ++search.step) {
        recordStep(recorder, layout, item, of, search.step == 1);
        queuesBarrier(*context_, recorder.commandBuffer());
        recordSearch(recorder, layout, search);
    }
    if (closest_) {
        closest_->record(recorder, layout, item, of);
    }
}

} // namespace voxtact
