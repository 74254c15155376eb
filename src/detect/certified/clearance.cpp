// SPDX-License-Identifier: MIT
#include "detect/certified/clearance.h"
#include "core/base/refuse.h"
#include "core/base/try.h"
#include "core/method/certified_constants.h"
#include "core/volume/label_grid.h"
#include "detect/batch.h"
#include "detect/certified/certified_queues.h"
#include "detect/certified/certified_rounds.h"
#include "detect/outputs/outputs.h"
#include "gpu/barriers.h"
#include "gpu/scene_impl.h"

#include "voxtact_shaders/certified_clearance_search_comp.h"

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

/// Of the steps, which begin with 1.
constexpr bool hasBoxesOnly(std::uint32_t step) noexcept {
    return step == 1;
}

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
    search.pairWords = VOXTACT_CLEARANCE_WORDS;
    search.allWord = VOXTACT_NO_WORD;
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
    ClearancePass pass(context, desc);
    Result<ClearancePipelines> pipelines = makeClearancePipelines(context, desc.counters, desc.closest);
    VOXTACT_TRY(pipelines);
    pass.pipelines_ = *pipelines;
    const Result<VkPipeline> search =
        computePipeline(context, spirv::certified_clearance_search_comp, {}, context.computeLayout, "clearance search");
    VOXTACT_TRY(search);
    pass.search_ = *search;
    if (desc.labelClearances) {
        const Result<VkPipelineLayout> layout = labelSearchLayout(context);
        VOXTACT_TRY(layout);
        Result<ClearancePipelines> made = makeLabelPipelines(context, desc.counters, *layout);
        VOXTACT_TRY(made);
        pass.labelLayout_ = *layout;
        pass.ofLabels_ = *made;
    }
    if (desc.closest) {
        Result<ClosestPass> made = ClosestPass::create(context);
        VOXTACT_TRY(made);
        pass.closest_ = *made;
    }
    return pass;
}

void ClearancePass::recordSearch(RoundRecorder& recorder, VkPipelineLayout layout,
                                 const shader::ClearanceConstants& constants) const {
    const DeviceFunctions& vk = context_->vk;
    const VkCommandBuffer commandBuffer = recorder.commandBuffer();
    vk.CmdBindPipeline(commandBuffer, VK_PIPELINE_BIND_POINT_COMPUTE, search_);
    const std::uint32_t most = context_->limits.maxComputeWorkGroupCount[0];
    shader::ClearanceConstants part = constants;
    for (std::uint32_t done = 0; done < constants.pairs; done += part.pairs) {
        part.firstPair = constants.firstPair + done;
        part.open.before = done;
        part.pairs = static_cast<std::uint32_t>(
            std::min<std::uint64_t>(constants.pairs - done, std::uint64_t{most} * VOXTACT_COMPUTE_GROUP));
        vk.CmdPushConstants(commandBuffer, layout, VK_SHADER_STAGE_COMPUTE_BIT, 0, sizeof part, &part);
        vk.CmdDispatch(commandBuffer, (part.pairs + VOXTACT_COMPUTE_GROUP - 1) / VOXTACT_COMPUTE_GROUP, 1, 1);
    }
}

void ClearancePass::recordBegin(RoundRecorder& recorder, const OpenPairs& open,
                                const std::optional<std::array<std::uint32_t, 4>>& label) const {
    const ResultsImpl& results = recorder.results();
    const VkCommandBuffer commandBuffer = recorder.commandBuffer();
    barrier(*context_, commandBuffer, VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT, VK_ACCESS_2_SHADER_STORAGE_WRITE_BIT,
            VK_PIPELINE_STAGE_2_ALL_TRANSFER_BIT, VK_ACCESS_2_TRANSFER_WRITE_BIT);
    context_->vk.CmdFillBuffer(commandBuffer, results.transforms.get(), bitsByte(results),
                               VkDeviceSize{VOXTACT_ROOM_BITS(results.queueRoom)} * sizeof(std::uint32_t), 0);
    open.recordNone(*context_, commandBuffer);
    if (label) {
        cmdUpdateBuffer(*context_, commandBuffer, results.transforms.get(), labelByte(results),
                        std::as_bytes(std::span(*label)));
    }
    barrier(*context_, commandBuffer, VK_PIPELINE_STAGE_2_ALL_TRANSFER_BIT, VK_ACCESS_2_TRANSFER_WRITE_BIT,
            VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT,
            VK_ACCESS_2_SHADER_STORAGE_READ_BIT | VK_ACCESS_2_SHADER_STORAGE_WRITE_BIT);
}

RoundCut ClearancePass::cutOf(const Search& of, std::uint32_t step) const noexcept {
    // What a round looks at is bounded on the device: the host does not know how far a pair will look.
    const std::uint32_t room = of.constants.queueRoom;
    return {{.pairs = of.search.pairs, .clusters = groupsOf(*of.item.mesh)},
            {.clusters = hasBoxesOnly(step) ? room : room / kRoomOfCluster,
             .pairs = context_->limits.maxComputeWorkGroupCount[1],
             .looks = 0}};
}

void ClearancePass::recordStep(RoundRecorder& recorder, const Search& of, std::uint32_t step) const {
    using enum ClearanceProgram;
    const auto pass = [&](ClearanceProgram program, std::uint32_t queue) {
        return RoundPass{of.pipelines[static_cast<std::size_t>(program)], queue};
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
    const bool boxesOnly = hasBoxesOnly(step);
    recorder.record(boxesOnly ? std::span<const RoundPass>(boxes) : std::span<const RoundPass>(all), of.layout,
                    of.constants, cutOf(of, step), of.open.looks(step));
}

void ClearancePass::recordAll(RoundRecorder& recorder, const Search& of) const {
    shader::ClearanceConstants search = of.search;
    for (search.step = 0; search.step <= search.steps; ++search.step) {
        if (search.step > 0) {
            recordStep(recorder, of, search.step);
        }
        search.open = of.open.listing(search.step + 1, nullptr, cutOf(of, search.step + 1));
        queuesBarrier(*context_, recorder.commandBuffer());
        recordSearch(recorder, of.layout, search);
    }
}

void ClearancePass::recordLabels(RoundRecorder& recorder, const Search& all,
                                 std::span<const std::int32_t> labels) const {
    const LabelMapImpl& map = all.item.labels->impl();
    const std::vector<std::int32_t>& values = *map.values;
    context_->vk.CmdBindDescriptorSets(recorder.commandBuffer(), VK_PIPELINE_BIND_POINT_COMPUTE, labelLayout_,
                                       VOXTACT_SET_LABELS, 1, &map.searched.set, 0, nullptr);
    Search of{*ofLabels_, labelLayout_, all.item, all.constants, all.search, all.open};
    of.constants.item = anyOpacity_ ? withAnyOpacity(of.constants.item) : of.constants.item;
    of.search.ofLabel = 1;
    of.search.allWord = anyOpacity_ ? VOXTACT_NO_WORD : all.search.clearanceWord;
    of.search.pairWords = VOXTACT_CLEARANCE_WORDS * static_cast<std::uint32_t>(labels.size());
    const auto first = static_cast<std::uint32_t>(labelClearancesByte(recorder.results()) / sizeof(std::uint32_t));
    for (std::size_t i = 0; i < labels.size(); ++i) {
        const auto found = std::lower_bound(values.begin(), values.end(), labels[i]);
        const bool has = found != values.end() && *found == labels[i];
        of.search.clearanceWord = first + VOXTACT_CLEARANCE_WORDS * static_cast<std::uint32_t>(i);
        of.search.steps = has ? all.search.steps : 0;
        std::array<std::uint32_t, 4> label{};
        label[VOXTACT_LABEL_FIRST] = of.search.clearanceWord;
        label[VOXTACT_LABEL_STRIDE] = of.search.pairWords;
        label[VOXTACT_LABEL_NUMBER] = static_cast<std::uint32_t>(found - values.begin());
        label[VOXTACT_LABEL_CERTAIN] = values.size() <= VOXTACT_LABEL_BITS ? 1 : 0;
        recordBegin(recorder, of.open, label);
        recordAll(recorder, of);
    }
}

void ClearancePass::record(RoundRecorder& recorder, VkPipelineLayout layout, const BatchItem& item,
                           const shader::CertifiedConstants& constants, std::span<const std::int32_t> labels) const {
    if (item.pairs() == 0) {
        return;
    }
    Search all{pipelines_, layout, item, constants, {}, OpenPairs(recorder.results(), item)};
    all.constants.item = withClearance(all.constants.item, item.volume->impl().grid, desc_.tolerance);
    all.search = searchOf(all.constants, item, desc_);
    recordBegin(recorder, all.open, std::nullopt);
    recordAll(recorder, all);
    if (closest_) {
        closest_->record(recorder, layout, item, all.constants);
    }
    if (ofLabels_) {
        recordLabels(recorder, all, labels);
    }
}

Result<void> checkLabelClearances(const ContextImpl& context, const Batch& batch, const ResultsImpl& results) {
    VOXTACT_TRY(checkMeasuredLabels(batch.labels));
    if (batch.labels.size() > results.labelRoom) {
        return refuse("the batch has " + std::to_string(batch.labels.size()) +
                      " labels, the Results have room for the clearances to " + std::to_string(results.labelRoom) +
                      " (ResultsDesc::labelClearances)");
    }
    for (std::size_t i = 0; i < batch.items.size(); ++i) {
        const BatchItem& item = batch.items[i];
        const std::string which = "batch item " + std::to_string(i);
        if (item.labels == nullptr) {
            return noLabelsToMeasure(which);
        }
        VOXTACT_TRY(checkLabelMap(context, *item.labels, which));
        VOXTACT_TRY(checkLabelGrid(item.labels->grid(), item.volume->grid(), which));
        if (!item.labels->impl().nodes.buffer) {
            return Error{ErrorCode::LimitExceeded, 0,
                         which +
                             ": the label map is too large for clearances: what is known of its bricks is beyond "
                             "the device's maxStorageBufferRange, " +
                             std::to_string(context.limits.maxStorageBufferRange)};
        }
    }
    return {};
}

} // namespace voxtact
