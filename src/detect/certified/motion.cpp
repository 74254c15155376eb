// SPDX-License-Identifier: MIT
#include "detect/certified/motion.h"
#include "core/base/refuse.h"
#include "core/base/try.h"
#include "core/geometry/glm_bridge.h"
#include "core/method/certified_constants.h"
#include "detect/batch.h"
#include "detect/buffer_update.h"
#include "detect/certified/certified_queues.h"
#include "detect/certified/open_pairs.h"
#include "gpu/barriers.h"
#include "gpu/scene_impl.h"
#include "motion_words.h"

#include "voxtact_shaders/certified_motion_cull_comp.h"
#include "voxtact_shaders/certified_motion_decide_comp.h"
#include "voxtact_shaders/certified_motion_expand_comp.h"
#include "voxtact_shaders/certified_motion_finish_comp.h"
#include "voxtact_shaders/certified_motion_large_comp.h"
#include "voxtact_shaders/certified_motion_refine_comp.h"
#include "voxtact_shaders/certified_motion_step_comp.h"
#include "voxtact_shaders/certified_motion_step_doubles_comp.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace voxtact {

namespace {

static_assert(VOXTACT_MOTION_DECIDED == static_cast<std::uint32_t>(MotionEnd::Decided) &&
              VOXTACT_MOTION_GRAZES == static_cast<std::uint32_t>(MotionEnd::Grazes) &&
              VOXTACT_MOTION_BUDGET == static_cast<std::uint32_t>(MotionEnd::Budget));
static_assert(sizeof(shader::PairGrid) <= kSetupBytes);

/// More than rounding to float, and of products of such.
constexpr double kOutward = 1 + 0x1p-20;

/// Steps of a search, but for those that the length of the way asks for: of each halving of it, and of each piece that
/// is looked at by boxes alone.
constexpr double kSteps = 24;
constexpr double kStepsOfHalving = 8;
constexpr double kStepsOfPiece = 4;
constexpr double kMostSteps = 1024;

Box boundsOf(const BatchItem& item) {
    return item.mesh->impl().known.facts->bounds;
}

/// Of the way that counts as the last piece; all of it where nothing moves.
double partOf(double length, double speed) {
    return speed > length ? length / speed : 1;
}

std::uint32_t stepsFor(const std::vector<std::optional<RigidMotion>>& motions, const BatchItem& item,
                       std::uint32_t firstPair, double resolution) {
    double longest = 0;
    for (std::size_t i = 0; i < item.pairs(); ++i) {
        if (const std::optional<RigidMotion>& motion = motions[firstPair + i]) {
            longest = std::max(longest, motion->speed(boundsOf(item)));
        }
    }
    const double longPiece = 2 * double{VOXTACT_MOTION_FARTHEST} * longestSide(item.volume->impl().grid);
    const double halvings = std::max(std::log2(longest / (double{VOXTACT_MOTION_LAST_PIECE} * resolution)), 0.0);
    const double steps = kSteps + kStepsOfHalving * halvings + kStepsOfPiece * (longest / longPiece);
    return static_cast<std::uint32_t>(std::min(std::ceil(steps), kMostSteps));
}

/// What a search begins with.
shader::MotionState stateOf(const BatchItem& item, const RigidMotion& motion, double resolution) {
    const VolumeImpl& volume = item.volume->impl();
    const double side = longestSide(volume.grid);
    const Box bounds = boundsOf(item);
    const RigidMotion::Tangent tangent = motion.tangent(0);
    const glm::dmat3 world_from_voxel(toGlm(worldFromIndex(volume.grid)));
    glm::dmat3 voxel_from_world(toGlm(volume.texture_from_world));
    for (int column = 0; column < 3; ++column) {
        for (int row = 0; row < 3; ++row) {
            voxel_from_world[column][row] *= volume.grid.size[static_cast<std::size_t>(row)];
        }
    }
    const glm::dmat3 turning = voxel_from_world * tangent.linear * world_from_voxel;
    const glm::dvec3 straight = voxel_from_world * tangent.straight;
    const double speed = motion.speed(bounds);
    shader::MotionState state{};
    state.phase = VOXTACT_MOTION_AT_FROM;
    state.way = motion.way();
    const Mat4 to = motion.at(1);
    for (std::size_t row = 0; row < 3; ++row) {
        for (std::size_t column = 0; column < 4; ++column) {
            state.to[3 * column + row] = to[4 * column + row];
        }
        for (std::size_t column = 0; column < 3; ++column) {
            state.turning[3 * row + column] =
                static_cast<float>(turning[static_cast<int>(column)][static_cast<int>(row)]);
        }
        state.straight[row] = static_cast<float>(straight[static_cast<int>(row)]);
    }
    state.bend = static_cast<float>(motion.angle() / 2 * kOutward);
    state.deformation = static_cast<float>(motion.deformation(bounds) / side * kOutward);
    state.rounding = static_cast<float>(motion.rounding(bounds) / side * kOutward);
    state.length = static_cast<float>(speed / side * kOutward);
    state.finest = static_cast<float>(partOf(double{VOXTACT_MOTION_LAST_PIECE} * resolution, speed));
    state.resolution = static_cast<float>(partOf(resolution, speed) / kOutward);
    return state;
}

shader::MotionConstants stepOf(const shader::CertifiedConstants& of, const BatchItem& item,
                               const ResultsImpl& results) {
    shader::MotionConstants step{};
    const Mat4 world_from_voxel = worldFromIndex(item.volume->impl().grid);
    for (std::size_t row = 0; row < 3; ++row) {
        for (std::size_t column = 0; column < 3; ++column) {
            step.rows[3 * row + column] = static_cast<float>(world_from_voxel[4 * column + row]);
        }
        step.origin[row] = static_cast<float>(world_from_voxel[12 + row]);
    }
    step.resultWord = of.queueWord + VOXTACT_WORD_MOTIONS(of.queueRoom, results.maxPairs);
    step.stateWord = of.queueWord + VOXTACT_WORD_MOTION_STATES(of.queueRoom, results.maxPairs);
    step.closestWord = of.queueWord + VOXTACT_WORD_CLOSEST(of.queueRoom, results.maxPairs);
    step.setupWord = static_cast<std::uint32_t>(setupByte(results) / sizeof(std::uint32_t));
    return step;
}

} // namespace

Result<MotionPass> MotionPass::create(ContextImpl& context, const DetectorDesc& desc) {
    const MarginPasses::Programs programs{spirv::certified_motion_cull_comp,   spirv::certified_motion_refine_comp,
                                          spirv::certified_motion_expand_comp, spirv::certified_motion_large_comp,
                                          spirv::certified_motion_decide_comp, spirv::certified_motion_finish_comp};
    const ShaderConstant constants[] = {{VOXTACT_CONSTANT_STOP_AT_FIRST, 1},
                                        {VOXTACT_CONSTANT_COUNTERS, desc.counters ? 1U : 0U},
                                        {VOXTACT_CONSTANT_LISTED, 1}};
    Result<MarginPasses> look = MarginPasses::create(context, programs, constants, "motion");
    VOXTACT_TRY(look);
    const Result<VkPipeline> step =
        context.floatControls.doubles
            ? computePipeline(context, spirv::certified_motion_step_doubles_comp, {}, context.computeLayout,
                              "motion step")
            : computePipeline(context, spirv::certified_motion_step_comp, {}, context.computeLayout, "motion step");
    VOXTACT_TRY(step);
    return MotionPass(context, *desc.motion, *look, *step);
}

void MotionPass::recordStep(RoundRecorder& recorder, VkPipelineLayout layout, shader::MotionConstants step,
                            const BatchItem& item, std::uint32_t firstPair) const {
    const DeviceFunctions& vk = context_->vk;
    const VkCommandBuffer commandBuffer = recorder.commandBuffer();
    const std::uint64_t most = std::uint64_t{context_->limits.maxComputeWorkGroupCount[0]} * VOXTACT_COMPUTE_GROUP;
    queuesBarrier(*context_, commandBuffer);
    vk.CmdBindPipeline(commandBuffer, VK_PIPELINE_BIND_POINT_COMPUTE, step_);
    for (std::size_t done = 0; done < item.pairs(); done += step.pairs) {
        step.open.before = static_cast<std::uint32_t>(done);
        step.firstPair = firstPair + step.open.before;
        step.pairs = static_cast<std::uint32_t>(std::min<std::uint64_t>(item.pairs() - done, most));
        vk.CmdPushConstants(commandBuffer, layout, VK_SHADER_STAGE_COMPUTE_BIT, 0, sizeof step, &step);
        vk.CmdDispatch(commandBuffer, (step.pairs + VOXTACT_COMPUTE_GROUP - 1) / VOXTACT_COMPUTE_GROUP, 1, 1);
    }
}

void MotionPass::record(RoundRecorder& recorder, VkPipelineLayout layout, const BatchItem& item,
                        const shader::CertifiedConstants& constants, const Touch& touch) const {
    constexpr double kBent = 2; // more than how far bent ways get, over how far they go: 1 + pi / 4
    if (item.pairs() == 0) {
        return;
    }
    const ResultsImpl& results = recorder.results();
    const VkCommandBuffer commandBuffer = recorder.commandBuffer();
    const OpenPairs open(results, item);
    barrier(*context_, commandBuffer, VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT, VK_ACCESS_2_SHADER_STORAGE_WRITE_BIT,
            VK_PIPELINE_STAGE_2_ALL_TRANSFER_BIT, VK_ACCESS_2_TRANSFER_WRITE_BIT);
    cmdUpdateBuffer(*context_, commandBuffer, results.transforms.get(), setupByte(results),
                    std::as_bytes(std::span(&item.volume->impl().pairGrid, 1)));
    open.recordNone(*context_, commandBuffer);
    barrier(*context_, commandBuffer, VK_PIPELINE_STAGE_2_ALL_TRANSFER_BIT, VK_ACCESS_2_TRANSFER_WRITE_BIT,
            VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT,
            VK_ACCESS_2_SHADER_STORAGE_READ_BIT | VK_ACCESS_2_SHADER_STORAGE_WRITE_BIT);
    const Grid& grid = item.volume->impl().grid;
    const RoundCut cut =
        look_.cutOf(item, results.queueRoom, kBent * double{VOXTACT_MOTION_FARTHEST} * longestSide(grid));
    shader::CertifiedConstants look = constants;
    look.item = withTolerance(constants.item, grid, 0);
    shader::MotionConstants between = stepOf(constants, item, results);
    const std::uint32_t steps = stepsFor(*results.motions, item, constants.firstPair, search_.resolution);
    for (std::uint32_t step = 0; step <= steps; ++step) { // of which the first is the touch at the first poses
        between.what = step == 0 ? VOXTACT_MOTION_FIRST_STEP : VOXTACT_MOTION_NEXT_STEP;
        between.open = open.listing(step, &touch.cut, cut);
        recordStep(recorder, layout, between, item, constants.firstPair);
        recorder.record(touch.passes, layout, constants, touch.cut, open.touches(step));
        if (step > 0) {
            look_.record(recorder, layout, look, cut, open.looks(step));
        }
    }
    between.what = VOXTACT_MOTION_LAST_STEP;
    recordStep(recorder, layout, between, item, constants.firstPair);
}

Result<std::vector<std::optional<RigidMotion>>> motionsOf(const Batch& batch, const MotionSearch& search,
                                                          const ResultsImpl& results) {
    if (!results.motionRoom) {
        return refuse("the Results have no room for motions: ResultsDesc::motions is false");
    }
    std::vector<std::optional<RigidMotion>> motions;
    for (std::size_t i = 0; i < batch.items.size(); ++i) {
        const BatchItem& item = batch.items[i];
        const std::string which = "batch item " + std::to_string(i);
        if (item.poses != nullptr) {
            return refuse(which + ": motions are between poses that the host has, not between those of a PoseBuffer");
        }
        if (!item.mesh->impl().known.facts) {
            return refuse(which + ": motions need a mesh whose vertices the host knows");
        }
        for (std::size_t pose = 0; pose < item.pairs(); ++pose) {
            if (pose + 1 == item.pairs()) {
                motions.emplace_back();
                continue;
            }
            Result<RigidMotion> motion =
                RigidMotion::between(item.world_from_object, pose, search.interpolation, boundsOf(item), i);
            VOXTACT_TRY(motion);
            motions.emplace_back(*motion);
        }
    }
    return motions;
}

void recordMotions(const ContextImpl& context, VkCommandBuffer commandBuffer, const Batch& batch,
                   const ResultsImpl& results, const MotionSearch& search) {
    BufferUpdate<MotionResult> found(context, commandBuffer, results.transforms.get(), motionsByte(results));
    BufferUpdate<shader::MotionState> states(context, commandBuffer, results.transforms.get(),
                                             motionStatesByte(results));
    std::size_t pair = 0;
    for (const BatchItem& item : batch.items) {
        for (std::size_t end = pair + item.pairs(); pair < end; ++pair) {
            const std::optional<RigidMotion>& motion = (*results.motions)[pair];
            shader::MotionState state{};
            state.phase = VOXTACT_MOTION_DONE;
            states.add(motion ? stateOf(item, *motion, search.resolution) : state);
            MotionResult begin{};
            begin.freeUntil = motion ? 0 : 1;
            begin.touchAt = std::numeric_limits<float>::infinity();
            found.add(begin);
        }
    }
    found.finish();
    states.finish();
}

} // namespace voxtact
