// SPDX-License-Identifier: MIT
#include "detect/certified/tolerance.h"
#include "certified_turn.h"
#include "core/base/try.h"
#include "core/method/certified_constants.h"
#include "detect/batch.h"
#include "detect/certified/certified_queues.h"
#include "gpu/scene_impl.h"

#include "voxtact_shaders/certified_margin_cull_comp.h"
#include "voxtact_shaders/certified_margin_decide_comp.h"
#include "voxtact_shaders/certified_margin_expand_comp.h"
#include "voxtact_shaders/certified_margin_finish_comp.h"
#include "voxtact_shaders/certified_margin_large_comp.h"
#include "voxtact_shaders/certified_margin_refine_comp.h"
#include "voxtact_shaders/certified_tolerance_cull_comp.h"
#include "voxtact_shaders/certified_tolerance_decide_comp.h"
#include "voxtact_shaders/certified_tolerance_expand_comp.h"
#include "voxtact_shaders/certified_tolerance_finish_comp.h"
#include "voxtact_shaders/certified_tolerance_large_comp.h"
#include "voxtact_shaders/certified_tolerance_refine_comp.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <span>

namespace voxtact {

namespace {

double radians(const PoseTolerance& tolerance) {
    return tolerance.angle * std::numbers::pi / 180;
}

/// Of what is turned, over its distance from the origin.
double chordOf(const PoseTolerance& tolerance) {
    return 2 * std::sin(radians(tolerance) / 2);
}

/// No pose makes more mm of a unit of object space.
double scaleOf(const BatchItem& item) {
    if (item.poses != nullptr) {
        return item.poses->impl().mostScale;
    }
    double most = 0;
    for (const Mat4& pose : item.world_from_object) {
        double squares = 0;
        for (std::size_t column = 0; column < 3; ++column) {
            for (std::size_t row = 0; row < 3; ++row) {
                squares += pose[4 * column + row] * pose[4 * column + row];
            }
        }
        most = std::max(most, squares);
    }
    return std::sqrt(most);
}

/// mm that a point of the mesh may be brought; of a mesh that the host does not know, rounds have no bound by it.
double reachOf(const BatchItem& item, const PoseTolerance& tolerance) {
    double squares = 0;
    if (const std::optional<MeshFacts>& facts = item.mesh->impl().known.facts) {
        for (std::size_t axis = 0; axis < 3; ++axis) {
            const double farthest = std::max(std::abs(facts->bounds.lo[axis]), std::abs(facts->bounds.hi[axis]));
            squares += farthest * farthest;
        }
    }
    const double reach = tolerance.distance + chordOf(tolerance) * scaleOf(item) * std::sqrt(squares);
    return std::max(reach, std::numeric_limits<double>::min());
}

static_assert(sizeof(shader::TurnLimit) == VOXTACT_TURN_WORDS * sizeof(std::uint32_t));

} // namespace

Result<TolerancePass> TolerancePass::create(ContextImpl& context, const DetectorDesc& desc) {
    const MarginPasses::Programs turned{spirv::certified_tolerance_cull_comp,   spirv::certified_tolerance_refine_comp,
                                        spirv::certified_tolerance_expand_comp, spirv::certified_tolerance_large_comp,
                                        spirv::certified_tolerance_decide_comp, spirv::certified_tolerance_finish_comp};
    const MarginPasses::Programs moved{spirv::certified_margin_cull_comp,   spirv::certified_margin_refine_comp,
                                       spirv::certified_margin_expand_comp, spirv::certified_margin_large_comp,
                                       spirv::certified_margin_decide_comp, spirv::certified_margin_finish_comp};
    const PoseTolerance& tolerance = *desc.poseTolerance;
    const ShaderConstant constants[] = {{VOXTACT_CONSTANT_STOP_AT_FIRST, 1},
                                        {VOXTACT_CONSTANT_COUNTERS, desc.counters ? 1U : 0U}};
    Result<MarginPasses> passes =
        MarginPasses::create(context, tolerance.angle > 0 ? turned : moved, constants, "tolerance");
    VOXTACT_TRY(passes);
    return TolerancePass(*passes, tolerance);
}

void recordTurnLimit(const ContextImpl& context, VkCommandBuffer commandBuffer, const ResultsImpl& results,
                     const PoseTolerance& tolerance) {
    constexpr double kOutward = 1 + 0x1p-22; // more than rounding to float
    const double angle = radians(tolerance);
    const shader::TurnLimit limit{static_cast<float>(std::cos(angle)), static_cast<float>(std::sin(angle)),
                                  static_cast<float>(chordOf(tolerance) * kOutward)};
    cmdUpdateBuffer(context, commandBuffer, results.transforms.get(), turnByte(results),
                    std::as_bytes(std::span(&limit, 1)));
}

void TolerancePass::record(RoundRecorder& recorder, VkPipelineLayout layout, const BatchItem& item,
                           const shader::CertifiedConstants& given) const {
    shader::CertifiedConstants constants = given;
    const Grid& grid = item.volume->impl().grid;
    constants.item = tolerance_.angle > 0 ? withTolerance(given.item, grid, tolerance_.distance)
                                          : withMargin(given.item, grid, tolerance_.distance);
    passes_.record(recorder, layout, constants, passes_.cutOf(item, constants.queueRoom, reachOf(item, tolerance_)));
}

} // namespace voxtact
